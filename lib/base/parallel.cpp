#include <sloper/base/parallel.hpp>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#if !defined(__SANITIZE_THREAD__)
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#endif

namespace sloper {

static int g_threads = 1;

void set_thread_count(int n) {
  g_threads = n > 0 ? n : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}
int thread_count() {
  return g_threads;
}

namespace {

#if defined(__SANITIZE_THREAD__) // the thread sanitizer does not see how TBB's threads wait for
                                 // each other

/// Calls work(0) to work(chunks - 1), each on some thread.
template<class Work> void spread(std::size_t chunks, const Work& work) {
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> threads;
  for (int k = 0; k < g_threads; ++k)
    threads.emplace_back([&] {
      for (std::size_t c; (c = next++) < chunks;)
        work(c);
    });
  for (std::thread& t : threads)
    t.join();
}

#else

/// So many threads, also where there are fewer processors.
struct Arena {
  explicit Arena(int n)
      : threads(n),
        allowed(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(n)),
        arena(n) {}
  int threads;
  tbb::global_control allowed;
  tbb::task_arena arena;
};

/// Calls work(0) to work(chunks - 1), each on some thread. TBB and not OpenMP: on a machine with
/// other work, the end of an OpenMP loop waits for threads that got no processor; TBB's waits only
/// for those that took a chunk.
template<class Work> void spread(std::size_t chunks, const Work& work) {
  static std::unique_ptr<Arena> arena;
  if (!arena || arena->threads != g_threads) {
    arena.reset(); // one control at a time
    arena = std::make_unique<Arena>(g_threads);
  }
  arena->arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, chunks, std::size_t{1}, work, tbb::simple_partitioner());
  });
}

#endif

} // namespace

void spread_chunks(std::size_t n, std::size_t grain, ChunkWork work, const void* capture) {
  const std::size_t chunks = (n + grain - 1) / grain;
  std::exception_ptr failure; // the one of the lowest chunk is passed on, as with one thread
  std::size_t failed_chunk = chunks;
  std::mutex failing;
  spread(chunks, [&](std::size_t c) {
    try {
      work(capture, c * grain, std::min(n, (c + 1) * grain));
    } catch (...) {
      const std::lock_guard lock(failing);
      if (c < failed_chunk) {
        failed_chunk = c;
        failure = std::current_exception();
      }
    }
  });
  if (failure)
    std::rethrow_exception(failure);
}

void run_alone(std::size_t n, const std::function<void(std::size_t)>& work) {
  const int threads = thread_count();
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> failure(n);
  const auto take = [&] {
    for (std::size_t k; (k = next++) < n;) {
      try {
        work(k);
      } catch (...) {
        failure[k] = std::current_exception();
      }
    }
  };
  set_thread_count(1);
  std::vector<std::thread> others;
  for (int t = 1; t < threads && t < static_cast<int>(n); ++t)
    others.emplace_back(take);
  take();
  for (std::thread& t : others)
    t.join();
  set_thread_count(threads);
  for (const std::exception_ptr& f : failure)
    if (f)
      std::rethrow_exception(f);
}

} // namespace sloper
