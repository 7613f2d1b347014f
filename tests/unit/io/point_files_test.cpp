// Proves that written files of points read back, that rows of text may have every form, and that invalid files are
// refused.
#include "blum/io/point_io.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

#include "blum/core/error.hpp"
#include "blum/io/formats.hpp"

namespace blum {
namespace {

namespace fs = std::filesystem;

std::vector<Vec3d> rows(std::string_view text) {
  return read_point_rows(std::as_bytes(std::span(text)));
}

/// The error message of the reader.
std::string complaint(std::string_view text) {
  try {
    (void)rows(text);
  } catch (const FormatError& error) {
    return error.what();
  }
  return {};
}

TEST(PointRows, HaveAnyForm) {
  const std::vector<Vec3d> expected{{1, 2, 3}, {-4e-3, 5, 6}};
  for (const std::string_view text :
       {"1 2 3\n-4e-3 5 6\n", "1,2,3\r\n-0.004,5,6", "x;y;z\n1;2;3\r-.004;5;6",
        "\xef\xbb\xbf# hello\n\n  1\t2 , 3 9 9\n\n-4e-3 ,5 ;6,x", "\"x\",y,z\n+1,+2,+3\n-4e-3,5,6"}) {
    EXPECT_EQ(rows(text), expected) << text;
  }
  EXPECT_TRUE(rows("").empty());
  EXPECT_TRUE(rows("x y z\n").empty());
}

TEST(PointRows, ReportTheLineOfAnError) {
  EXPECT_EQ(complaint("1,2,3\n4,5"), "points, line 2: there is no z: a row has three numbers or more");
  EXPECT_EQ(complaint("1,2,3\nx,y,z\n"), "points, line 2: x is not a number: 'x'");
  EXPECT_EQ(complaint("1,inf,3"), "points, line 1: y is not finite: 'inf'");
  EXPECT_EQ(complaint("\n1,,3"), "points, line 2: y is not a number: ''");
  EXPECT_EQ(complaint("1,2,3e999"), "points, line 1: z is not a number: '3e999'");
}

TEST(PointFiles, ReadBackAsWritten) {
  const fs::path folder = fs::temp_directory_path() / "blum_point_files_test";
  fs::create_directories(folder);
  Complex points;
  points.positions = {{0.1, 0.2, 0.3}, {1e-300, -1e300, 0}};
  points.vertex_columns = Columns(2);
  points.vertex_columns.add<double>("distance")[1] = std::numeric_limits<double>::infinity();
  points.vertex_columns.add<std::int32_t>("site")[0] = -1;
  points.vertex_columns.add<double>("gradient", 3);
  points.vertex_columns.add<float>("pair", 2);
  for (const std::string& extension : file_extensions(FileContent::points, FileAccess::write)) {
    const fs::path path = folder / ("points" + extension);
    write_points(path, points, {{"tool", "test"}});
    EXPECT_EQ(read_points(path), points.positions) << extension;
  }
  EXPECT_THROW(write_points(folder / "p.stl", points), InvalidOption);
  EXPECT_THROW((void)read_points(folder / "p.png"), InvalidOption);
  EXPECT_THROW((void)read_points(folder / "missing.npy"), FileError);
  points.edges = {{0, 1}};
  points.edge_columns = Columns(1);
  EXPECT_THROW(write_points(folder / "p.csv", points), InvalidMesh);
  points.edges.clear();
  points.edge_columns = Columns(0);
  points.vertex_columns.add<double>("points");
  EXPECT_THROW(write_points(folder / "p.npz", points), InvalidOption);
  EXPECT_FALSE(fs::exists(folder / "p.npz"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace blum
