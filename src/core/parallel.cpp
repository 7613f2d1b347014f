#include "blum/core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"

#if defined(BLUM_THREADS_TBB)
#include <tbb/info.h>
#include <tbb/task_arena.h>
#elif defined(BLUM_THREADS_STD)
#include <thread>
#endif

namespace blum {
namespace {

#if defined(BLUM_THREADS_TBB)
/// Unused arenas, by number of slots. Arenas are reused, because oneTBB does not free all memory of a destroyed arena
/// (version 2021.8 keeps 7 KB). With several calls per frame, the loss would add up.
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

/// Admits helpers to a loop until the loop closes. Helpers that come later must not touch the loop, which has ended.
class Gate {
 public:
  /// Returns false if the gate is closed. After true, leave() must be called.
  [[nodiscard]] bool enter() {
    std::uint32_t state = state_.load();
    while ((state & closed) == 0) {
      if (state_.compare_exchange_weak(state, state + 1)) return true;
    }
    return false;
  }
  /// Opens a gate that nobody uses.
  void open() { state_ = 0; }
  void leave() {
    if (state_.fetch_sub(1) == closed + 1) state_.notify_one();
  }
  /// Closes the gate, and waits until everyone who entered has left.
  void close() {
    std::uint32_t state = state_.fetch_or(closed) | closed;
    for (; state != closed; state = state_.load()) state_.wait(state);
  }

 private:
  static constexpr std::uint32_t closed = std::uint32_t{1} << 31;
  std::atomic<std::uint32_t> state_{0};  ///< number of helpers inside, and `closed`
};

/// Gates that no loop and no helper uses. Helpers that have not started when the process ends keep their gates, so the
/// pool keeps all gates reachable, and is never destroyed.
class GatePool {
 public:
  struct Shared {
    Gate gate;
    std::atomic<int> owners{1};
  };

  static GatePool& instance() {
    static GatePool& pool = *new GatePool;
    return pool;
  }
  Shared* take() {
    const std::scoped_lock lock(mutex_);
    if (free_.empty()) {
      free_.reserve(all_.size() + 1);  // so give_back() allocates no memory
      all_.push_back(std::make_unique<Shared>());
      return all_.back().get();
    }
    Shared* const shared = free_.back();
    free_.pop_back();
    shared->gate.open();
    shared->owners = 1;
    return shared;
  }
  void give_back(Shared* shared) noexcept {
    const std::scoped_lock lock(mutex_);
    free_.push_back(shared);
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Shared>> all_;
  std::vector<Shared*> free_;
};

/// Gate that a loop and its helpers own together.
class SharedGate {
 public:
  SharedGate() : shared_(GatePool::instance().take()) {}
  SharedGate(const SharedGate& other) : shared_(other.shared_) { ++shared_->owners; }
  SharedGate& operator=(const SharedGate&) = delete;
  ~SharedGate() {
    if (--shared_->owners == 0) GatePool::instance().give_back(shared_);
  }
  Gate& operator*() const { return shared_->gate; }
  Gate* operator->() const { return &shared_->gate; }

 private:
  GatePool::Shared* shared_;
};

/// Closes a gate at the end of a scope, also if an invitation fails.
struct Closing {
  Gate& gate;
  ~Closing() { gate.close(); }
};

/// Number of helpers that any loop has invited, and that have not started yet.
std::atomic<int>& waiting_helpers() {
  static std::atomic<int> count{0};
  return count;
}

/// Runs `run` on the calling thread, and on helpers as far as threads of TBB are free. The loop does not wait for
/// helpers that have not started when its work is done. So a busy machine does not delay it.
/// @return  false if nothing was run, because too many helpers of other loops have not started yet.
bool run_workers(int workers, const std::function<void(int)>& run) {
  // An arena with more slots than TBB has threads would cause a warning. One slot belongs to the calling thread.
  const int slots = std::min(workers, tbb::info::default_concurrency());
  // While no thread of TBB is free, invitations would only use memory.
  constexpr int most_waiting = 4096;
  if (waiting_helpers() > most_waiting) return false;
  ArenaPool::Lease lease(ArenaPool::instance(), slots);
  const SharedGate gate;
  const Closing closing{*gate};
  for (int worker = 1; worker < slots; ++worker) {
    lease.arena().enqueue([gate, &run, worker] {
      --waiting_helpers();
      if (!gate->enter()) return;
      run(worker);
      gate->leave();
    });
    ++waiting_helpers();
  }
  run(0);
  return true;
}
#elif defined(BLUM_THREADS_STD)
/// Calls run(0) to run(workers - 1), concurrently, and waits until all calls have returned.
bool run_workers(int workers, const std::function<void(int)>& run) {
  std::vector<std::jthread> threads;
  threads.reserve(static_cast<std::size_t>(workers - 1));
  for (int worker = 1; worker < workers; ++worker) threads.emplace_back([&run, worker] { run(worker); });
  run(0);
  return true;
}
#else
bool run_workers(int /*workers*/, const std::function<void(int)>& run) {
  run(0);
  return true;
}
#endif

/// Decides if helpers would shorten a loop, from the time of the ranges that the calling thread has run.
class Trial {
 public:
  [[nodiscard]] bool needs_helpers(std::size_t done, std::size_t ranges) const {
    const Seconds spent = std::chrono::steady_clock::now() - begin_;
    return spent >= least_spent && spent * static_cast<double>(ranges - done) >= least_left * static_cast<double>(done);
  }

 private:
  using Seconds = std::chrono::duration<double>;
  /// Inviting a helper costs the caller some 5 us. The helper begins some 50 us later. So a helper saves time only if
  /// much work is left.
  static constexpr Seconds least_spent = std::chrono::microseconds(50);
  static constexpr Seconds least_left = std::chrono::microseconds(150);
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Reports the start, the end, and at most every 30 ms the progress in between. Two threads never report at the same
/// time.
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
                  const std::function<void(const WorkRange&)>& body, Start start) {
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

  /// Runs the next range. Returns false if none is left, or if the loop must stop.
  const auto run_one = [&](int worker) {
    if (failed.load(std::memory_order_relaxed) || context.cancel.stop_requested()) return false;
    const std::size_t range = next.fetch_add(1, std::memory_order_relaxed);
    if (range >= ranges) return false;
    try {
      const std::size_t begin = range * grain;
      const std::size_t end = std::min(begin + grain, count);
      body({begin, end, worker});
      reporter.advance(end - begin);
    } catch (...) {
      const std::scoped_lock lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      failed = true;
    }
    return true;
  };
  const auto run_all = [&](int worker) {
    while (run_one(worker)) {
    }
  };
  if (workers == 1) {
    run_all(0);
  } else if (start != Start::at_once || !run_workers(workers, run_all)) {
    const Trial trial;
    for (std::size_t done = 1; run_one(0) && done < ranges; ++done) {
      if (trial.needs_helpers(done, ranges) && run_workers(workers, run_all)) break;
    }
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
