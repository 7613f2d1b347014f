#include "common/progress.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "blum/core/error.hpp"

namespace blum::cli {
namespace {

using namespace std::chrono_literals;

// State that the signal handler may use: lock-free atomics, and a pipe to a thread, which may call any function.
std::atomic<int> signals_seen = 0;
std::atomic<int> last_signal = 0;
std::atomic<bool> unattended = false;
std::array<int, 2> wake_pipe = {-1, -1};

constexpr char message_signal = 's';
constexpr char message_quit = 'q';

void send(char message) {
  while (write(wake_pipe[1], &message, 1) < 0 && errno == EINTR) {
  }
}

/// Ends the process by a signal, so that its parent process sees the signal. A shell then also ends its loop.
[[noreturn]] void end_by(int number) {
  signal(number, SIG_DFL);
  sigset_t own;
  sigemptyset(&own);
  sigaddset(&own, number);
  pthread_sigmask(SIG_UNBLOCK, &own, nullptr);
  raise(number);
  _exit(128 + number);  // reached only if the signal is ignored
}

extern "C" void on_signal(int number) {
  const int saved = errno;
  last_signal = number;
  if (signals_seen.fetch_add(1) > 0 || unattended.load()) {
    constexpr std::string_view text = "\nblum: error: cancelled\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
    end_by(number);
  }
  send(message_signal);
  errno = saved;
}

void watch(std::stop_source& source) {
  while (true) {
    char message = 0;
    const ssize_t count = read(wake_pipe[0], &message, 1);
    if (count < 0 && errno == EINTR) continue;
    if (count != 1 || message == message_quit) return;
    source.request_stop();
  }
}

/// Sets a handler, except for signals that are ignored: shells ignore signals for background jobs of scripts.
void set_handler(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM}) {
    struct sigaction present = {};
    sigaction(number, nullptr, &present);
    if (present.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
  }
}

}  // namespace

Progress::Progress(bool wanted) : enabled_(wanted && isatty(STDERR_FILENO) == 1) {}

void Progress::update(double fraction, std::string_view phase) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (now - start_ < 400ms || (visible_ && now - last_ < 100ms)) return;
  last_ = now;
  visible_ = true;
  constexpr int width = 32;
  const double part = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(part * width);
  const std::string bar =
      std::string(static_cast<std::size_t>(filled), '=') + std::string(static_cast<std::size_t>(width - filled), ' ');
  std::fprintf(stderr, "\r\033[K[%s] %3d %%  %.*s", bar.c_str(), static_cast<int>(part * 100),
               static_cast<int>(phase.size()), phase.data());
  std::fflush(stderr);
}

void Progress::clear() {
  if (!visible_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  visible_ = false;
}

void end_by_last_signal() {
  if (const int number = last_signal; number != 0) end_by(number);
}

Interrupt::Interrupt() {
  if (pipe2(wake_pipe.data(), O_CLOEXEC) != 0) throw Error("cannot make a pipe");
  watcher_ = std::thread([this] { watch(source_); });
  set_handler(on_signal);
}

Interrupt::~Interrupt() {
  set_handler(SIG_DFL);
  send(message_quit);
  watcher_.join();
  close(wake_pipe[0]);
  close(wake_pipe[1]);
}

Unattended::Unattended() {
  unattended = true;
}

Unattended::~Unattended() {
  unattended = false;
}

Context make_context(int threads, Progress& progress, const Interrupt& interrupt) {
  Context context;
  context.threads = threads;
  context.progress = [&progress](double fraction, std::string_view phase) { progress.update(fraction, phase); };
  context.cancel = interrupt.token();
  return context;
}

}  // namespace blum::cli
