#include "blum/core/context.hpp"

#include <algorithm>
#include <string>
#include <thread>

#if defined(__linux__)
#include <sched.h>
#endif

#include "blum/core/error.hpp"

namespace blum {
namespace {

/// Returns the number of cores that this process may use. A container or taskset may allow fewer than the machine has.
int usable_cores() {
#if defined(__linux__)
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof(set), &set) == 0) return std::max(1, CPU_COUNT(&set));
#endif
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace

int thread_count(const Context& context) {
  if (context.threads < 0 || context.threads > 1024) {
    throw InvalidOption("threads is " + std::to_string(context.threads) + ", but must be 0 (all cores) to 1024");
  }
  if (context.threads > 0) return context.threads;
  static const int cores = std::min(usable_cores(), 1024);
  return cores;
}

void throw_if_cancelled(const Context& context) {
  if (context.cancel.stop_requested()) throw Cancelled();
}

}  // namespace blum
