#include "call.hpp"

#include <nanobind/stl/string.h>
#include <pthread.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

#include "blum/core/error.hpp"

namespace blum::python {
namespace {

namespace nb = nanobind;

constexpr std::chrono::milliseconds look_every{50};
/// A brief call is stopped after this time, up to the time between two looks of the watcher.
constexpr std::chrono::milliseconds patience{20};
constexpr std::chrono::milliseconds watch_every{10};

/// State shared by the worker and the calling thread.
class Shared {
 public:
  void finish(std::exception_ptr failure) {
    const std::scoped_lock lock(mutex_);
    failure_ = std::move(failure);
    is_done_ = true;
    changed_.notify_one();
  }
  void report(double fraction, std::string_view phase) {
    const std::scoped_lock lock(mutex_);
    fraction_ = fraction;
    phase_ = phase;
    is_news_ = true;
  }
  /// Waits for at most `look_every`. Returns true if the work has ended.
  [[nodiscard]] bool wait() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, look_every, [&] { return is_done_; });
  }
  /// Calls the given function with (fraction, phase) if something new was reported.
  template <class Show>
  void take_news(const Show& show) {
    std::unique_lock lock(mutex_);
    if (!std::exchange(is_news_, false)) return;
    const double fraction = fraction_;
    const std::string phase = phase_;
    lock.unlock();
    show(fraction, phase);
  }
  [[nodiscard]] const std::exception_ptr& failure() const { return failure_; }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_done_ = false;
  bool is_news_ = false;
  double fraction_ = 0;
  std::string phase_;
  std::exception_ptr failure_;
};

/// Running calls, which must end before the interpreter does. While it ends, it kills every thread that waits for its
/// lock. This ends the whole process if C++ frames are on the stack of that thread.
class RunningCalls {
  using Clock = std::chrono::steady_clock;
  struct Running {
    std::stop_source* stop;
    std::optional<Clock::time_point> end;  ///< time at which a brief call is stopped
  };

 public:
  /// Registers a call for as long as the entry exists.
  class Entry {
   public:
    enum class Kind : std::uint8_t { any_time, brief };

    /// @param kind  a brief call is stopped after `patience`.
    Entry(RunningCalls& all, std::stop_source& stop, Kind kind = Kind::any_time) : all_(&all) {
      Running call{&stop, std::nullopt};
      if (kind == Kind::brief) call.end = Clock::now() + patience;
      const std::scoped_lock lock(all.mutex_);
      place_ = all.calls_.insert(all.calls_.end(), call);
      if (kind == Kind::brief) all.wake_watcher();
    }
    ~Entry() { leave(); }
    Entry(const Entry&) = delete;
    Entry& operator=(const Entry&) = delete;

    void leave() {
      if (all_ == nullptr) return;
      const std::scoped_lock lock(all_->mutex_);
      all_->calls_.erase(place_);
      all_->changed_.notify_all();
      all_ = nullptr;
    }

   private:
    RunningCalls* all_;
    std::list<Running>::iterator place_;
  };

  /// Returns true if this thread must not return to Python any more.
  [[nodiscard]] bool is_over() {
    const std::scoped_lock lock(mutex_);
    return exiting_ && *exiting_ != std::this_thread::get_id();
  }

  /// Stops the calls of all other threads, and waits until they have ended, at most for `longest_end`.
  void end() {
    std::unique_lock lock(mutex_);
    exiting_ = std::this_thread::get_id();
    for (const Running& call : calls_) call.stop->request_stop();
    changed_.wait_for(lock, longest_end, [&] { return calls_.empty(); });
  }

 private:
  /// A limit is needed because progress callbacks of Python may take any time.
  static constexpr std::chrono::seconds longest_end{10};

  /// Makes a thread look at brief calls, until none has run for a while. The mutex must be locked.
  void wake_watcher() {
    is_active_ = true;
    if (!has_watcher_) std::thread([this] { watch(); }).detach();
    has_watcher_ = true;
    if (std::exchange(is_idle_, false)) watcher_.notify_one();
  }

  [[noreturn]] void watch() {
    std::unique_lock lock(mutex_);
    for (;;) {
      if (!std::exchange(is_active_, false)) {
        is_idle_ = true;
        watcher_.wait(lock, [&] { return !is_idle_; });
      }
      watcher_.wait_for(lock, watch_every);
      const auto now = Clock::now();
      for (const Running& call : calls_) {
        if (!call.end) continue;
        is_active_ = true;
        if (now >= *call.end) call.stop->request_stop();
      }
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::condition_variable watcher_;
  bool has_watcher_ = false;
  bool is_active_ = false;  ///< true if a brief call ran since the watcher last looked
  bool is_idle_ = false;    ///< true if the watcher waits for the next brief call
  std::list<Running> calls_;
  std::optional<std::thread::id> exiting_;
};

/// Returns the only instance. It is never destroyed, because threads may use it until the process ends.
RunningCalls& running_calls() {
  static auto* const all = new RunningCalls;
  return *all;
}

/// Returns true if other threads run Python code. When Python ends, it stops them between two steps and never clears
/// their frames, so the objects that they hold leak.
bool other_threads_run() {
  const auto frames = nb::cast<nb::dict>(nb::module_::import_("sys").attr("_current_frames")());
  const auto own = nb::int_(PyThread_get_thread_ident());
  return nb::len(frames) > (frames.contains(own) ? 1U : 0U);
}

/// Blocks a thread that cannot return to Python any more.
[[noreturn]] void park() {
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

}  // namespace

void end_calls_at_exit() {
  // A forked child has none of its parent's threads, and one of them may hold the lock. So the child starts anew.
  pthread_atfork(nullptr, nullptr, [] { std::construct_at(&running_calls()); });
  nb::module_::import_("atexit").attr("register")(nb::cpp_function([] {
    if (other_threads_run()) nb::set_leak_warnings(false);
    const nb::gil_scoped_release release;
    running_calls().end();
  }));
}

void run_call(const Call& call, void (*work)(const void* subject, const Context& context), const void* subject) {
  Shared shared;
  RunningCalls& calls = running_calls();
  if (calls.is_over()) {
    const nb::gil_scoped_release release;
    park();
  }
  std::stop_source stop;
  RunningCalls::Entry entry(calls, stop);
  Context context{call.threads, {}, stop.get_token(), call.device};
  const bool sniffer = !call.progress.is_none();
  if (sniffer) {
    context.progress = [&](double fraction, std::string_view phase) { shared.report(fraction, phase); };
  }
  std::jthread worker([&] {
    std::exception_ptr failure;
    try {
      work(subject, context);
    } catch (...) {
      failure = std::current_exception();
    }
    shared.finish(std::move(failure));
  });

  std::exception_ptr raised;  // Thrown by Python code in this thread.
  const auto look = [&] {
    if (raised) return;
    try {
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
      if (sniffer) shared.take_news([&](double fraction, const std::string& phase) { call.progress(fraction, phase); });
    } catch (...) {
      raised = std::current_exception();
      stop.request_stop();
    }
  };
  for (bool is_done = false; !is_done;) {
    {
      const nb::gil_scoped_release release;
      is_done = shared.wait();
      if (calls.is_over()) {
        worker.join();
        entry.leave();
        park();
      }
    }
    look();
  }
  {
    const nb::gil_scoped_release release;
    worker.join();
  }
  if (raised) std::rethrow_exception(raised);
  if (shared.failure()) std::rethrow_exception(shared.failure());
}

bool run_brief_call(const Call& call, void (*work)(const void* subject, const Context& context), const void* subject) {
  RunningCalls& calls = running_calls();
  std::stop_source stop;
  std::exception_ptr failure;
  bool is_done = true;
  std::optional<RunningCalls::Entry> entry;
  {
    const nb::gil_scoped_release release;
    if (calls.is_over()) park();
    entry.emplace(calls, stop, RunningCalls::Entry::Kind::brief);
    try {
      work(subject, {call.threads, {}, stop.get_token(), call.device});
    } catch (const Cancelled&) {
      is_done = false;
    } catch (...) {
      failure = std::current_exception();
    }
    if (calls.is_over()) {
      entry->leave();
      park();
    }
  }
  if (failure) std::rethrow_exception(failure);
  return is_done;
}

}  // namespace blum::python
