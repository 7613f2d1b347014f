#include "blum/core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"

#if defined(BLUM_THREADS_TBB)
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>
#elif defined(BLUM_THREADS_STD)
#include <thread>
#endif

namespace blum {
namespace {

#if defined(BLUM_THREADS_TBB)
/// Unused arenas, by number of slots. Arenas are reused, because oneTBB does not free all memory of a destroyed arena
/// (it keeps 7 KB in 2021.8). With several calls per frame, the loss would add up.
class ArenaPool {
 public:
  /// An arena for the lifetime of the lease.
  class Lease {
   public:
    Lease(ArenaPool& pool, int slots) : pool_(pool), slots_(slots), arena_(pool.take(slots)) {}
    ~Lease() { pool_.give_back(slots_, std::move(arena_)); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    [[nodiscard]] tbb::task_arena& arena() { return *arena_; }

   private:
    ArenaPool& pool_;
    int slots_;
    std::unique_ptr<tbb::task_arena> arena_;
  };

  /// The pool is never destroyed, because oneTBB may be unloaded before static objects are destroyed.
  static ArenaPool& instance() {
    static ArenaPool& pool = *new ArenaPool;
    return pool;
  }

 private:
  struct Arenas {
    std::vector<std::unique_ptr<tbb::task_arena>> free;
    std::size_t made = 0;
  };

  std::unique_ptr<tbb::task_arena> take(int slots) {
    const std::scoped_lock lock(mutex_);
    Arenas& arenas = arenas_[slots];
    if (arenas.free.empty()) {
      arenas.free.reserve(++arenas.made);  // so give_back() allocates no memory
      return std::make_unique<tbb::task_arena>(slots);
    }
    std::unique_ptr<tbb::task_arena> arena = std::move(arenas.free.back());
    arenas.free.pop_back();
    return arena;
  }
  void give_back(int slots, std::unique_ptr<tbb::task_arena> arena) noexcept {
    const std::scoped_lock lock(mutex_);
    arenas_[slots].free.push_back(std::move(arena));
  }

  std::mutex mutex_;
  std::map<int, Arenas> arenas_;
};
#endif

/// Calls run(0) to run(workers - 1), concurrently if the back end can, and waits until all calls have returned.
void run_workers(int workers, const std::function<void(int)>& run) {
#if defined(BLUM_THREADS_TBB)
  // An arena with more slots than TBB has threads would cause a warning. Fewer slots suffice, because a thread runs
  // several workers one after the other.
  ArenaPool::Lease lease(ArenaPool::instance(), std::min(workers, tbb::info::default_concurrency()));
  lease.arena().execute(
      [&] { tbb::parallel_for(0, workers, [&](int worker) { run(worker); }, tbb::simple_partitioner()); });
#elif defined(BLUM_THREADS_STD)
  std::vector<std::jthread> threads;
  threads.reserve(static_cast<std::size_t>(workers - 1));
  for (int worker = 1; worker < workers; ++worker) threads.emplace_back([&run, worker] { run(worker); });
  run(0);
#else
  for (int worker = 0; worker < workers; ++worker) run(worker);
#endif
}

/// Reports the start, the end, and at most every 30 ms the progress in between. It never reports from two threads at
/// once.
class ProgressReporter {
 public:
  ProgressReporter(const Context& context, std::string_view phase, std::size_t total)
      : context_(context),
        phase_(phase),
        total_(static_cast<double>(total)),
        active_(context.progress && !phase.empty()) {
    if (active_) context_.progress(0.0, phase_);
  }

  void advance(std::size_t items) {
    if (!active_) return;
    const std::size_t done = done_.fetch_add(items) + items;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock()) return;
    const auto now = std::chrono::steady_clock::now();
    const double fraction = static_cast<double>(done) / total_;
    if (now - last_ < std::chrono::milliseconds(30) || fraction <= reported_) return;
    last_ = now;
    reported_ = fraction;
    context_.progress(fraction, phase_);
  }

  void finish() {
    if (active_) context_.progress(1.0, phase_);
  }

 private:
  const Context& context_;
  std::string_view phase_;
  double total_;
  bool active_;
  std::atomic<std::size_t> done_{0};
  std::mutex mutex_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  double reported_ = 0;
};

}  // namespace

void parallel_for(const Context& context, std::size_t count, std::size_t grain, std::string_view phase,
                  const std::function<void(const WorkRange&)>& body) {
  throw_if_cancelled(context);
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t ranges = (count - 1) / grain + 1;
  const int workers = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(thread_count(context)), ranges));

  ProgressReporter reporter(context, phase, count);
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  std::exception_ptr failure;
  std::mutex failure_mutex;

  const auto work = [&](int worker) {
    try {
      while (!failed.load(std::memory_order_relaxed) && !context.cancel.stop_requested()) {
        const std::size_t range = next.fetch_add(1, std::memory_order_relaxed);
        if (range >= ranges) return;
        const std::size_t begin = range * grain;
        const std::size_t end = std::min(begin + grain, count);
        body({begin, end, worker});
        reporter.advance(end - begin);
      }
    } catch (...) {
      const std::scoped_lock lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      failed = true;
    }
  };
  if (workers == 1) {
    work(0);
  } else {
    run_workers(workers, work);
  }
  if (failure) std::rethrow_exception(failure);
  throw_if_cancelled(context);
  reporter.finish();
}

std::string_view thread_backend() {
#if defined(BLUM_THREADS_TBB)
  return "tbb";
#elif defined(BLUM_THREADS_STD)
  return "std";
#else
  return "serial";
#endif
}

}  // namespace blum
