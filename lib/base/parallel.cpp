#include <base/parallel.hpp>

#include <omp.h>

#include <algorithm>
#include <exception>
#include <mutex>
#if defined(__SANITIZE_THREAD__)
#include <atomic>
#include <thread>
#endif

namespace sloper {

static int g_threads = 1;

void set_thread_count(int n) { g_threads = n > 0 ? n : std::max(1, omp_get_num_procs()); }
int thread_count() { return g_threads; }

namespace {

/// Calls work(0) to work(chunks - 1), each on some thread.
template<class Work> void spread(std::size_t chunks, const Work& work) {
#if defined(__SANITIZE_THREAD__) // the thread sanitizer does not see how OpenMP's threads wait for each other
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> threads;
  for (int k = 0; k < g_threads; ++k)
    threads.emplace_back([&] {
      for (std::size_t c; (c = next++) < chunks;) work(c);
    });
  for (std::thread& t : threads) t.join();
#else
#pragma omp parallel for schedule(dynamic, 1) num_threads(g_threads)
  for (long c = 0; c < static_cast<long>(chunks); ++c) work(static_cast<std::size_t>(c));
#endif
}

} // namespace

void parallel_for(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t chunks = (n + grain - 1) / grain;
  if (g_threads == 1 || chunks <= 1) {
    for (std::size_t c = 0; c < chunks; ++c) body(c * grain, std::min(n, (c + 1) * grain));
    return;
  }
  std::exception_ptr failure; // an exception must not leave a parallel region; the one of the lowest chunk is passed on, as with one thread
  std::size_t failed_chunk = chunks;
  std::mutex failing;
  spread(chunks, [&](std::size_t c) {
    try {
      body(c * grain, std::min(n, (c + 1) * grain));
    } catch (...) {
      const std::lock_guard lock(failing);
      if (c < failed_chunk) {
        failed_chunk = c;
        failure = std::current_exception();
      }
    }
  });
  if (failure) std::rethrow_exception(failure);
}

double parallel_sum(std::size_t n, std::size_t grain, const std::function<double(std::size_t, std::size_t)>& term) {
  const std::size_t chunks = (n + grain - 1) / grain;
  std::vector<double> part(chunks);
  parallel_for(n, grain, [&](std::size_t begin, std::size_t end) { part[begin / grain] = term(begin, end); });
  double sum = 0;
  for (double p : part) sum += p;
  return sum;
}

} // namespace sloper
