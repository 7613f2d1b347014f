// Proves that parallel loops visit every item once, stop when asked, and pass errors on.
#include "blum/core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <fstream>
#include <new>
#include <stop_token>
#include <string_view>
#include <thread>
#include <vector>

#include "blum/core/error.hpp"

namespace blum {
namespace {

TEST(ParallelFor, VisitsEveryItemOnceOnAnyNumberOfThreads) {
  for (const Start start : {Start::measured, Start::at_once}) {
    for (const int threads : {1, 2, 7}) {
      std::vector<std::atomic<int>> visits(1003);
      const auto visit = [&](const WorkRange& range) {
        EXPECT_LT(range.worker, threads);
        for (std::size_t i = range.begin; i < range.end; ++i) ++visits[i];
      };
      parallel_for({.threads = threads}, visits.size(), 10, "", visit, start);
      for (const auto& count : visits) EXPECT_EQ(count, 1);
    }
  }
}

TEST(ParallelFor, StopsWhenAsked) {
  std::stop_source source;
  const Context context{.threads = 2, .cancel = source.get_token()};
  std::atomic<int> ranges{0};
  EXPECT_THROW(parallel_for(context, 1000, 1, "",
                            [&](const WorkRange&) {
                              if (++ranges == 10) source.request_stop();
                            }),
               Cancelled);
  EXPECT_LT(ranges, 1000);
}

TEST(ParallelFor, RethrowsTheFirstFailure) {
  const auto fail = [](const WorkRange&) { throw std::bad_alloc(); };
  EXPECT_THROW(parallel_for({.threads = 2}, 100, 1, "", fail), std::bad_alloc);
  EXPECT_THROW(parallel_for({.threads = 2}, 100, 1, "", fail, Start::at_once), std::bad_alloc);
}

TEST(ParallelFor, ReportsRisingProgressThatEndsAtOne) {
  double last = -1;
  Context context;
  context.progress = [&](double fraction, std::string_view phase) {
    EXPECT_EQ(phase, "work");
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  parallel_for(context, 100, 1, "work", [](const WorkRange&) {});
  EXPECT_EQ(last, 1.0);
}

// The smallest case of a leak: each loop had an arena of oneTBB, 7 KB of which stayed.
TEST(ParallelFor, KeepsNoMemoryFromLoopToLoop) {
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define BLUM_TEST_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(BLUM_TEST_SANITIZED)
  GTEST_SKIP() << "sanitizers keep memory of their own";
#endif
  if (!std::ifstream("/proc/self/statm")) GTEST_SKIP() << "no /proc/self/statm here";
  const auto resident_pages = [] {
    std::ifstream file("/proc/self/statm");
    long size = 0;
    long resident = 0;
    file >> size >> resident;
    return resident;
  };
  const auto loops = [](int count) {
    for (int n = 0; n < count; ++n) parallel_for({.threads = 2}, 2, 1, "", [](const WorkRange&) {}, Start::at_once);
  };
  loops(100);
  const long before = resident_pages();
  loops(2000);
  EXPECT_LT(resident_pages() - before, 1000) << "pages; 2000 arenas would be 3500";
}

TEST(ParallelFor, MayRunInManyThreadsAtOnceAndWithinItself) {
  std::atomic<int> visits{0};
  std::vector<std::jthread> callers;
  for (int caller = 0; caller < 4; ++caller) {
    callers.emplace_back([&] {
      for (int n = 0; n < 50; ++n) {
        const auto inner = [&](const WorkRange&) {
          parallel_for({.threads = 2}, 3, 1, "", [&](const WorkRange&) { ++visits; }, Start::at_once);
        };
        parallel_for({.threads = 2}, 4, 1, "", inner, Start::at_once);
      }
    });
  }
  callers.clear();
  EXPECT_EQ(visits, 4 * 50 * 4 * 3);
}

// A short loop must not wake other threads, which takes longer than the loop. A preempted loop may still do so.
TEST(ParallelFor, RunsShortLoopsOnTheCallingThread) {
  constexpr int loops = 1000;
  int alone = 0;
  for (int n = 0; n < loops; ++n) {
    std::atomic<bool> is_alone{true};
    parallel_for({.threads = 4}, 8, 1, "", [&, caller = std::this_thread::get_id()](const WorkRange&) {
      if (std::this_thread::get_id() != caller) is_alone = false;
    });
    if (is_alone) ++alone;
  }
  EXPECT_GT(alone, loops / 2);
}

/// Returns true if another thread ran a range of a loop while the calling thread waited for it, for at most ten
/// seconds.
bool has_company(std::size_t ranges_before, Start start) {
  std::atomic<bool> is_joined{false};
  const std::thread::id caller = std::this_thread::get_id();
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  const auto body = [&](const WorkRange& range) {
    if (std::this_thread::get_id() != caller) {
      is_joined = true;
    } else if (range.begin < ranges_before) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } else {
      while (!is_joined && std::chrono::steady_clock::now() < limit) std::this_thread::yield();
    }
  };
  parallel_for({.threads = 2}, ranges_before + 2, 1, "", body, start);
  return is_joined;
}

TEST(ParallelFor, GetsHelpersAtOnceOrWhenTheLoopProvesLong) {
  if (thread_backend() == "serial" || thread_count({}) < 2) GTEST_SKIP() << "one thread only";
  EXPECT_TRUE(has_company(0, Start::at_once));
  EXPECT_TRUE(has_company(3, Start::measured));
}

// All other threads are busy, so the inner loops must not wait for them.
TEST(ParallelFor, DoesNotWaitForBusyThreads) {
  std::atomic<bool> is_over{false};
  std::atomic<int> visits{0};
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  const auto body = [&](const WorkRange& range) {
    if (range.begin > 0) {
      while (!is_over && std::chrono::steady_clock::now() < limit) std::this_thread::yield();
      return;
    }
    for (int n = 0; n < 1000; ++n) {
      parallel_for({.threads = 4}, 4, 1, "", [&](const WorkRange&) { ++visits; }, Start::at_once);
    }
    is_over = true;
  };
  parallel_for({}, static_cast<std::size_t>(thread_count({})), 1, "", body, Start::at_once);
  EXPECT_TRUE(is_over);
  EXPECT_EQ(visits, 4000);
  EXPECT_LT(std::chrono::steady_clock::now(), limit);
}

TEST(ThreadCount, RefusesNonsense) {
  EXPECT_THROW((void)thread_count({.threads = -1}), InvalidOption);
  EXPECT_EQ(thread_count({.threads = 3}), 3);
  EXPECT_GE(thread_count({}), 1);
}

}  // namespace
}  // namespace blum
