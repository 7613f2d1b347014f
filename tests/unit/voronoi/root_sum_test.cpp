// Proves that signs of sums of square roots are exact. Sums of 0 are known, and doubles cannot decide some others.
// Random sums are compared with slow ones of many digits.
#include "voronoi/planes/root_sum.hpp"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstdint>
#include <utility>
#include <vector>

#include "blum/core/random.hpp"

namespace blum::voronoi {
namespace {

using Float = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<400>>;

struct Term {
  std::int64_t factor = 0;
  std::int64_t square = 0;
};

int sign_of(const std::vector<Term>& given) {
  std::vector<Root> roots;
  for (const Term& term : given) roots.emplace_back(detail::Integer(term.square));
  std::vector<RootTerm> terms;
  for (std::size_t k = 0; k < given.size(); ++k) terms.push_back({detail::Integer(given[k].factor), &roots[k]});
  return sign_of_root_sum(terms);
}

TEST(RootSums, AreZeroExactlyIfRootsCancel) {
  EXPECT_EQ(sign_of({}), 0);
  EXPECT_EQ(sign_of({{0, 5}, {7, 0}}), 0);
  EXPECT_EQ(sign_of({{1, 2}, {1, 8}, {-1, 18}}), 0);
  EXPECT_EQ(sign_of({{3, 12}, {-2, 27}, {1, 5}, {-1, 20}, {1, 5}}), 0);
  EXPECT_EQ(sign_of({{3, 12}, {-2, 27}, {1, 5}, {-1, 20}, {1, 6}}), 1);
  EXPECT_EQ(sign_of({{1, 4}, {-2, 1}}), 0);
}

TEST(RootSums, AreDecidedIfTheyAreTiny) {
  // sqrt(n + 1) + sqrt(n - 1) - 2 sqrt(n) is about -n^(-3/2) / 4.
  for (const std::int64_t n : {std::int64_t{1'000'000}, std::int64_t{1} << 40, std::int64_t{1} << 60}) {
    EXPECT_EQ(sign_of({{1, n + 1}, {1, n - 1}, {-2, n}}), -1);
    EXPECT_EQ(sign_of({{-1, n + 1}, {-1, n - 1}, {2, n}}), 1);
  }
}

TEST(RootSums, AgreeWithManyDigits) {
  Random random(47);
  for (int k = 0; k < 3000; ++k) {
    std::vector<Term> terms(1 + random.below(5));
    Float sum = 0;
    // Small numbers give sums of 0 now and then.
    const std::uint64_t most = k % 2 == 0 ? 8 : std::uint64_t{1} << 50;
    for (Term& term : terms) {
      term.factor = static_cast<std::int64_t>(random.below(2 * most)) - static_cast<std::int64_t>(most);
      term.square = static_cast<std::int64_t>(random.below(most));
      sum += Float(term.factor) * sqrt(Float(term.square));
    }
    const Float zero("1e-300");
    EXPECT_EQ(sign_of(terms), sum > zero ? 1 : sum < -zero ? -1 : 0);
  }
}

}  // namespace
}  // namespace blum::voronoi
