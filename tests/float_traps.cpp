/// With SLOPER_FLOAT_TRAPS: linked into the tests, it makes them stop with a signal where a
/// division by zero or an invalid operation would go on as infinity or NaN. Threads inherit it.
/// Overflow is no mistake: empty nodes of trees have bounds whose squares are infinite.
#include <cfenv>

namespace {
[[maybe_unused]] const int TRAPS = feenableexcept(FE_DIVBYZERO | FE_INVALID);
} // namespace
