#pragma once
/// Loops over threads whose result does not depend on the number of threads.
/// Test: tests/base/test_parallel.cpp
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>
namespace sloper {

/// Sets the number of threads that parallel loops may use; 1 by default, 0 means all
/// cores. State of the process: a tool sets it once (--threads).
void set_thread_count(int n);
/// Threads that parallel loops use, at least 1.
int thread_count();

/// Work on chunk [begin, end), with the data that it captured.
using ChunkWork = void (*)(const void* capture, std::size_t begin, std::size_t end);
/// Implementation of parallel_for() with more than one thread and chunk.
void spread_chunks(std::size_t n, std::size_t grain, ChunkWork work, const void* capture);

/// Calls body(begin, end) over [0, n) cut into fixed chunks of `grain`, in any order, on
/// thread_count() threads. Chunk borders do not depend on the thread count; write only to what
/// belongs to the chunk. Copies no capture. @param grain  items in a chunk, at least 1
template<class Body> void parallel_for(std::size_t n, std::size_t grain, const Body& body) {
  if (thread_count() == 1 || n <= grain) {
    for (std::size_t begin = 0; begin < n; begin += grain)
      body(begin, n - begin < grain ? n : begin + grain);
    return;
  }
  spread_chunks(
      n, grain,
      [](const void* capture, std::size_t begin, std::size_t end) {
        (*static_cast<const Body*>(capture))(begin, end);
      },
      std::addressof(body));
}

/// Sum of term(begin, end) over fixed chunks, added in chunk order: the same bits for any thread
/// count. term may write to what belongs to its chunk. @param part  work, of one number a chunk
/// @param n  items
/// @param grain  items in a chunk
template<class Term>
double parallel_sum(std::size_t n, std::size_t grain, std::vector<double>& part, const Term& term) {
  part.assign((n + grain - 1) / grain, 0);
  parallel_for(n, grain,
               [&](std::size_t begin, std::size_t end) { part[begin / grain] = term(begin, end); });
  double sum = 0;
  for (double p : part)
    sum += p;
  return sum;
}

/// Calls work(k) for each k below n, thread_count() at once, each on one thread alone:
/// parallel loops inside run serially. For long tasks that share nothing; not from within
/// a parallel loop. Rethrows the exception of the lowest k after all have ended.
void run_alone(std::size_t n, const std::function<void(std::size_t)>& work);

} // namespace sloper
