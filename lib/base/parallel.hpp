#pragma once
/// Loops over threads whose result does not depend on the number of threads.
#include <cstddef>
#include <functional>
#include <vector>
namespace sloper {

/// Threads that parallel_for may use; 1 by default. Set once by a tool (--threads). 0 means all cores.
void set_thread_count(int n);
int thread_count();

/// Calls body(begin, end) over [0, n) cut into fixed chunks of `grain`, in any order, on thread_count() threads.
/// Chunk borders do not depend on the thread count; write only to what belongs to the chunk.
void parallel_for(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

/// Sum of term(begin, end) over fixed chunks, added in chunk order: the same bits for any thread count.
double parallel_sum(std::size_t n, std::size_t grain, const std::function<double(std::size_t, std::size_t)>& term);

} // namespace sloper
