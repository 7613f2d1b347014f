// Proves that columns keep names, types and rows in order, and reject invalid requests. A complex reports its own
// problem.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "blum/complex/columns.hpp"
#include "blum/complex/complex.hpp"

namespace blum {
namespace {

Columns two_columns() {
  Columns columns(3);
  columns.add({"radius", 1, std::vector<double>{1, 2, 3}});
  columns.add({"site", 2, std::vector<std::int32_t>{0, 1, 2, 3, 4, 5}});
  return columns;
}

TEST(Columns, AreFoundByNameAndType) {
  const Columns columns = two_columns();
  EXPECT_EQ(columns.size(), 2U);
  EXPECT_EQ(columns.get<double>("radius")[1], 2);
  EXPECT_EQ(columns.get<std::int32_t>("site", 2)[5], 5);
  EXPECT_EQ(columns.find("site")->rows(), 3U);
  EXPECT_EQ(columns.find("site")->type_name(), "int32");
  EXPECT_EQ(columns.find("depth"), nullptr);
  EXPECT_THROW((void)columns.get<double>("depth"), InvalidOption);
  EXPECT_THROW((void)columns.get<float>("radius"), InvalidOption);
  EXPECT_THROW((void)columns.get<std::int32_t>("site"), InvalidOption);
}

TEST(Columns, RejectInvalidColumns) {
  Columns columns = two_columns();
  EXPECT_THROW(columns.add({"radius", 1, std::vector<double>(3)}), InvalidOption);
  EXPECT_THROW(columns.add({"", 1, std::vector<double>(3)}), InvalidOption);
  EXPECT_THROW(columns.add({"a", 0, std::vector<double>{}}), InvalidOption);
  EXPECT_THROW(columns.add({"b", 2, std::vector<double>(3)}), InvalidOption);
  EXPECT_EQ(columns, two_columns());
}

TEST(Columns, RowsArePickedAppendedAndDropped) {
  Columns columns = two_columns();
  const Columns picked = columns.pick(std::vector<std::uint32_t>{2, 0, 2});
  EXPECT_EQ(std::get<std::vector<double>>(picked.find("radius")->values), (std::vector<double>{3, 1, 3}));
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(picked.find("site")->values),
            (std::vector<std::int32_t>{4, 5, 0, 1, 4, 5}));
  EXPECT_THROW((void)columns.pick(std::vector<std::uint32_t>{3}), InvalidOption);
  columns.append(columns);
  EXPECT_EQ(columns.rows(), 6U);
  EXPECT_EQ(columns.get<double>("radius")[5], 3);
  columns.resize(2);
  EXPECT_EQ(columns.get<std::int32_t>("site", 2).size(), 4U);
  EXPECT_THROW(columns.append(Columns(1)), InvalidOption);
  columns.edit<double>("radius")[0] = 7;
  EXPECT_EQ(columns.get<double>("radius")[0], 7);
  EXPECT_TRUE(columns.erase("radius"));
  EXPECT_FALSE(columns.erase("radius"));
  const auto depth = columns.add<float>("depth", 3, 0.5F);
  EXPECT_EQ(depth.size(), 6U);
  EXPECT_EQ(depth[5], 0.5F);
}

TEST(Complex, ReportsItsProblem) {
  Complex complex;
  complex.positions.resize(3);
  complex.edges = {{0, 1}};
  complex.triangles = {{0, 1, 2}};
  EXPECT_EQ(problem_of(complex), "");
  complex.vertex_columns = two_columns();
  EXPECT_EQ(problem_of(complex), "");
  complex.edge_columns = two_columns();
  EXPECT_NE(problem_of(complex).find("the columns of edges have 3 rows, but 1"), std::string::npos);
  complex.edge_columns = {};
  complex.triangles.push_back({0, 2, 0});
  EXPECT_NE(problem_of(complex).find("triangle 1 uses vertex 0 twice"), std::string::npos);
  complex.triangles.pop_back();
  complex.edges[0][1] = 3;
  EXPECT_NE(problem_of(complex).find("edge 0 uses vertex 3"), std::string::npos);
  complex.edges.clear();
  complex.positions[2].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(validate(complex), InvalidMesh);
}

}  // namespace
}  // namespace blum
