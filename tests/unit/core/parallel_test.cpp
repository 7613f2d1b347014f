// Proves that parallel loops visit every item once, stop when asked, and pass errors on.
#include "blum/core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
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
  for (const int threads : {1, 2, 7}) {
    std::vector<std::atomic<int>> visits(1003);
    parallel_for({.threads = threads}, visits.size(), 10, "", [&](const WorkRange& range) {
      EXPECT_LT(range.worker, threads);
      for (std::size_t i = range.begin; i < range.end; ++i) ++visits[i];
    });
    for (const auto& count : visits) EXPECT_EQ(count, 1);
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
  EXPECT_THROW(parallel_for({.threads = 2}, 100, 1, "", [](const WorkRange&) { throw std::bad_alloc(); }),
               std::bad_alloc);
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
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
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
    for (int n = 0; n < count; ++n) parallel_for({.threads = 2}, 2, 1, "", [](const WorkRange&) {});
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
        parallel_for({.threads = 2}, 4, 1, "", [&](const WorkRange&) {
          parallel_for({.threads = 2}, 3, 1, "", [&](const WorkRange&) { ++visits; });
        });
      }
    });
  }
  callers.clear();
  EXPECT_EQ(visits, 4 * 50 * 4 * 3);
}

TEST(ThreadCount, RefusesNonsense) {
  EXPECT_THROW((void)thread_count({.threads = -1}), InvalidOption);
  EXPECT_EQ(thread_count({.threads = 3}), 3);
  EXPECT_GE(thread_count({}), 1);
}

}  // namespace
}  // namespace blum
