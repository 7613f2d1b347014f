// Proves that axes of all angles read back from .npz files unchanged. Other formats refuse these axes, and broken ones
// are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "blum/core/error.hpp"
#include "blum/io/medial_io.hpp"
#include "support/medial_rows.hpp"
#include "support/medial_sample.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

using namespace test;

constexpr double least_theta = 12.5;

AxisRows sample_nested() {
  AxisRows nested = sample_complex();
  nested.has_levels = true;
  for (std::size_t v = 1; v < nested.vertices.size(); ++v) nested.vertices[v].until = 20.1F + static_cast<float>(v);
  for (EdgeRow& e : nested.edges) {
    e.from = 1.1F;
    e.until = 33.3F;
  }
  for (TriangleRow& t : nested.triangles) t.until = 77.7F;
  return nested;
}

TEST(MedialNested, ReadsBackAsWritten) {
  const TemporaryFolder folder;
  const auto path = folder / "axis.npz";
  const AxisRows nested = sample_nested();
  write_medial(path, sample_complex(), nested, least_theta, sample_metadata());
  const MedialFile file = read_medial(path);
  ASSERT_TRUE(file.nested.has_value());
  const AxisRows read = *file.nested;
  EXPECT_EQ(file.least_theta, least_theta);
  EXPECT_EQ(read.sheet_count, nested.sheet_count);
  EXPECT_EQ(read.vertices, nested.vertices);
  EXPECT_EQ(read.edges, nested.edges);
  EXPECT_EQ(read.triangles, nested.triangles);
  write_medial(path, sample_complex());
  EXPECT_FALSE(read_medial(path).nested.has_value());
}

TEST(MedialNested, OtherFormatsRefuseThem) {
  const TemporaryFolder folder;
  for (const char* name : {"axis.vtp", "axis.ply", "axis.obj", "axis.ma"}) {
    EXPECT_THROW(write_medial(folder / name, sample_complex(), sample_nested(), least_theta), InvalidOption) << name;
  }
}

TEST(MedialNested, BrokenAxesAreRefused) {
  const TemporaryFolder folder;
  const auto path = folder / "axis.npz";
  const auto refuses = [&](const char* what, const std::function<void(AxisRows&)>& spoil) {
    AxisRows nested = sample_nested();
    spoil(nested);
    EXPECT_THROW(write_medial(path, sample_complex(), nested, least_theta), InvalidMesh) << what;
  };
  EXPECT_THROW(write_medial(path, sample_complex(), sample_nested(), 181), InvalidMesh);
  EXPECT_THROW(write_medial(path, sample_complex(), sample_complex(), least_theta), InvalidOption) << "no levels";
  refuses("vertex angle", [](AxisRows& n) { n.vertices[1].until = std::nanf(""); });
  refuses("position", [](AxisRows& n) { n.vertices[1].position.x = std::nan(""); });
  refuses("edge's vertex", [](AxisRows& n) { n.edges[0].vertices[1] = 99; });
  refuses("edge's angle", [](AxisRows& n) { n.edges[0].from = std::nanf(""); });
  refuses("edge's role", [](AxisRows& n) { n.edges[0].role = MedialRole::junction; });
  refuses("triangle's vertex", [](AxisRows& n) { n.triangles[0].vertices[1] = 99; });
  refuses("triangle's angle", [](AxisRows& n) { n.triangles[0].until = std::nanf(""); });
  refuses("sheets", [](AxisRows& n) { n.triangles[0].sheet = 99; });
}

}  // namespace
}  // namespace blum
