#include <sloper/base/progress.hpp>
namespace sloper {
Reporter& silent_reporter() {
  static Reporter silent;
  return silent;
}
} // namespace sloper
