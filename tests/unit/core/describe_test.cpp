// Proves that descriptions list all members of a struct in order, and that enumerations convert to names and back.
#include "blum/core/describe.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace blum {
namespace {

enum class Colour : std::uint8_t { red, green, blue };

struct Shape {
  Colour colour = Colour::green;
  std::optional<double> size = {};
  std::vector<int> parts = {};
  bool round = false;
  bool hollow = true;
  [[nodiscard]] std::size_t part_count() const { return parts.size(); }
};

}  // namespace

template <>
struct Description<Colour> {
  static constexpr std::string_view name = "Colour";
  static constexpr std::array values{NamedValue{Colour::red, "red"}, NamedValue{Colour::green, "green"},
                                     NamedValue{Colour::blue, "blue"}};
};
template <>
struct Description<Shape> {
  static constexpr std::string_view name = "Shape";
  static constexpr std::string_view doc = "A shape";
  static constexpr std::array warm{Colour::red};
  static constexpr std::tuple members{Member{"colour", &Shape::colour, "", "how it looks", Range{}, warm},
                                      Member{"size", &Shape::size, "mesh units", "how large", Range::positive()},
                                      Member{"parts", &Shape::parts, "", "of what"},
                                      Fact{"part_count", &Shape::part_count, "", "of how many"},
                                      Member{"round", &Shape::round, "", "whether it rolls"},
                                      Member{"hollow", &Shape::hollow, "", "whether it floats"}};
};

namespace {

TEST(Describe, MissingAndSwappedMembersAreDetected) {
  constexpr Member colour{"", &Shape::colour, "", ""};
  constexpr Member size{"", &Shape::size, "", ""};
  constexpr Member parts{"", &Shape::parts, "", ""};
  constexpr Member round{"", &Shape::round, "", ""};
  constexpr Member hollow{"", &Shape::hollow, "", ""};
  EXPECT_TRUE(detail::is_described_by<Shape>(Description<Shape>::members));
  EXPECT_FALSE(detail::is_described_by<Shape>(std::tuple{colour, size, parts, round})) << "the last one is missing";
  EXPECT_FALSE(detail::is_described_by<Shape>(std::tuple{colour, size, round, hollow})) << "one in the middle";
  EXPECT_FALSE(detail::is_described_by<Shape>(std::tuple{size, parts, round, hollow})) << "the first one";
  EXPECT_FALSE(detail::is_described_by<Shape>(std::tuple{size, colour, parts, round, hollow}));
  EXPECT_FALSE(detail::is_described_by<Shape>(std::tuple{colour, size, parts, round, hollow, hollow}));
}

TEST(Describe, MembersAreVisitedInTheirOrder) {
  EXPECT_EQ(Description<Shape>::name, "Shape");
  EXPECT_EQ(Description<Shape>::doc, "A shape");
  const Shape shape{.parts = {1, 2}};
  std::string told;
  for_each_member<Shape>([&](const auto& member) { told += std::string(member.name) + " "; });
  EXPECT_EQ(told, "colour size parts part_count round hollow ");
  EXPECT_EQ(std::get<3>(Description<Shape>::members).of(shape), 2U);
  EXPECT_TRUE(std::get<5>(Description<Shape>::members).of(shape));
}

TEST(Describe, EnumerationsHaveNamesBothWays) {
  static_assert(to_string(Colour::blue) == "blue");
  EXPECT_EQ(Description<Colour>::name, "Colour");
  EXPECT_EQ(parse_enum<Colour>("colour", "green"), Colour::green);
  EXPECT_EQ(to_string(static_cast<Colour>(7)), "unknown");
  try {
    (void)parse_enum<Colour>("--colour", "grey");
    FAIL();
  } catch (const InvalidOption& error) {
    EXPECT_STREQ(error.what(), "--colour is 'grey', but must be 'red', 'green' or 'blue'");
  }
  EXPECT_THROW((void)parse_enum<Colour>("colour", "blue", Description<Shape>::warm), InvalidOption);
}

TEST(Describe, ExclusiveOptionsAreRefused) {
  EXPECT_NO_THROW(exclude(true, "a", false, "b", ""));
  try {
    exclude(true, "--label", true, "--threshold", "each selects the voxels");
    FAIL();
  } catch (const InvalidOption& error) {
    EXPECT_STREQ(error.what(), "--label and --threshold exclude each other: each selects the voxels");
  }
}

}  // namespace
}  // namespace blum
