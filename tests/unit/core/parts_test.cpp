// Proves that each part runs once, that large parts run on all threads, and that cancellation and errors reach the
// caller.
#include "blum/core/parts.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <stop_token>
#include <vector>

#include "blum/core/error.hpp"

namespace blum {
namespace {

/// The number of threads for each part.
std::vector<int> threads_of(const std::vector<std::size_t>& sizes, int threads) {
  std::vector<std::atomic<int>> given(sizes.size());
  detail::for_each_part({.threads = threads}, sizes, "", [&](std::size_t part, const Context& own) {
    EXPECT_EQ(given[part], 0) << "part " << part << " was run twice";
    given[part] = own.threads;
  });
  return {given.begin(), given.end()};
}

TEST(Parts, LargeOnesTakeAllThreadsAndTheOthersOneEach) {
  EXPECT_EQ(threads_of({3, 100, 3, 4}, 2), (std::vector{1, 2, 1, 1}));
  EXPECT_EQ(threads_of({10, 10, 10, 10}, 2), (std::vector{1, 1, 1, 1}));
  EXPECT_EQ(threads_of({5}, 2), (std::vector{2}));
  EXPECT_EQ(threads_of({0, 0}, 7).size(), 2);
  EXPECT_TRUE(threads_of({}, 7).empty());
}

TEST(Parts, AreNotBegunAfterCancellation) {
  std::stop_source source;
  std::atomic<int> begun{0};
  const std::vector<std::size_t> sizes(100, 1);
  const auto run = [&](std::size_t, const Context& own) {
    if (++begun == 10) source.request_stop();
    throw_if_cancelled(own);
  };
  EXPECT_THROW(detail::for_each_part({.threads = 2, .cancel = source.get_token()}, sizes, "", run), Cancelled);
  EXPECT_LT(begun, 100);
}

}  // namespace
}  // namespace blum
