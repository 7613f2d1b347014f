#include "call.hpp"

#include <nanobind/stl/string.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

#include "blum/core/error.hpp"

namespace blum::python {
namespace {

namespace nb = nanobind;

constexpr std::chrono::milliseconds look_every{50};

/// What the worker and the calling thread tell each other.
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
  /// Whether the work has ended within the time between two looks.
  [[nodiscard]] bool wait() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, look_every, [&] { return is_done_; });
  }
  /// Calls tell(fraction, phase) if something new was reported.
  template <class Tell>
  void take_news(const Tell& tell) {
    std::unique_lock lock(mutex_);
    if (!std::exchange(is_news_, false)) return;
    const double fraction = fraction_;
    const std::string phase = phase_;
    lock.unlock();
    tell(fraction, phase);
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

}  // namespace

void run_call(const Call& call, const std::function<void(const Context&)>& work) {
  Shared shared;
  std::stop_source stop;
  Context context{call.threads, {}, stop.get_token()};
  const bool tells = !call.progress.is_none();
  if (tells) {
    context.progress = [&](double fraction, std::string_view phase) { shared.report(fraction, phase); };
  }
  std::jthread worker([&] {
    std::exception_ptr failure;
    try {
      work(context);
    } catch (...) {
      failure = std::current_exception();
    }
    shared.finish(std::move(failure));
  });

  std::exception_ptr raised;  // by Python code in this thread
  const auto look = [&] {
    if (raised) return;
    try {
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
      if (tells) shared.take_news([&](double fraction, const std::string& phase) { call.progress(fraction, phase); });
    } catch (...) {
      raised = std::current_exception();
      stop.request_stop();
    }
  };
  for (bool is_done = false; !is_done;) {
    {
      const nb::gil_scoped_release release;
      is_done = shared.wait();
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
