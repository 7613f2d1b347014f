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
 public:
  /// Registers a call for as long as the entry exists.
  class Entry {
   public:
    Entry(RunningCalls& all, std::stop_source& stop) : all_(&all) {
      const std::scoped_lock lock(all.mutex_);
      place_ = all.stops_.insert(all.stops_.end(), &stop);
    }
    ~Entry() { leave(); }
    Entry(const Entry&) = delete;
    Entry& operator=(const Entry&) = delete;

    void leave() {
      if (all_ == nullptr) return;
      const std::scoped_lock lock(all_->mutex_);
      all_->stops_.erase(place_);
      all_->changed_.notify_all();
      all_ = nullptr;
    }

   private:
    RunningCalls* all_;
    std::list<std::stop_source*>::iterator place_;
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
    for (std::stop_source* stop : stops_) stop->request_stop();
    changed_.wait_for(lock, longest_end, [&] { return stops_.empty(); });
  }

 private:
  /// A limit is needed because progress callbacks of Python may take any time.
  static constexpr std::chrono::seconds longest_end{10};

  std::mutex mutex_;
  std::condition_variable changed_;
  std::list<std::stop_source*> stops_;
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

}  // namespace blum::python
