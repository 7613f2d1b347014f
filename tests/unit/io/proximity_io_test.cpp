// Proves that files of close pairs hold every pair with its vertices, in all formats. Pairs that do not belong to the
// given meshes are refused.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/geometry/primitives.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/proximity_io.hpp"
#include "io/archive/numpy.hpp"
#include "io/bytes/byte_source.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

/// `low` has a triangle, a segment and a point; `high` has a triangle above them.
const TriangleMesh low{
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 0, 0}, {4, 0, 0}, {9, 9, 9}}, {{2, 0, 1}}, {{{4, 3}}}, {5}};
const TriangleMesh high{{{3.5, 0, 1}, {3.5, 5, 1}, {4.5, 5, 1}}, {{0, 1, 2}}, {}, {}};

class ProximityFiles : public testing::Test {
 protected:
  ProximityFiles() {
    ObjectOptions options;
    options.self = true;
    scene_.add(low, options);
    scene_.add(high);
    pairs_ = scene_.closest_primitives().pairs;
  }
  std::filesystem::path written(const char* name) {
    write_proximity_pairs(folder_ / name, pairs_, meshes_, {{"source", "test"}});
    return folder_ / name;
  }

  std::array<MeshView, 2> meshes_{low, high};
  ProximityScene scene_;
  std::vector<PrimitivePair> pairs_;
  test::TemporaryFolder folder_;
};

const std::vector<std::int32_t> objects{0, 0, 0, 1, 0, 1, 1, 0};
const std::vector<std::int32_t> primitives{0, 1, 1, 0, 2, 0, 0, 1};

template <class T>
std::vector<T> array_of(volume_io::NpzReader& npz, const std::string& name, const std::vector<std::uint64_t>& shape) {
  return npz.read(name, [&](volume_io::ByteStream& stream, const volume_io::NpyHeader& header) {
    EXPECT_EQ(header.shape, shape) << name;
    return std::get<std::vector<T>>(read_npy_values(stream, header));
  });
}

TEST_F(ProximityFiles, ArraysHoldEveryPair) {
  ASSERT_EQ(pairs_.size(), 4U);
  const volume_io::FileSource source(written("p.npz"));
  volume_io::NpzReader npz(source);
  EXPECT_EQ(array_of<std::int32_t>(npz, "object", {4, 2}), objects);
  EXPECT_EQ(array_of<std::int32_t>(npz, "primitive", {4, 2}), primitives);
  const auto distance = array_of<double>(npz, "distance", {4});
  const auto point = array_of<double>(npz, "closest", {4, 2, 3});
  EXPECT_EQ(distance[0], 2);
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_EQ(distance[n], pairs_[n].between.distance);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(point[6 * n + k], pairs_[n].between.first_point[k]);
      EXPECT_EQ(point[6 * n + 3 + k], pairs_[n].between.second_point[k]);
    }
  }
  const auto feature = array_of<std::int32_t>(npz, "feature", {4, 2, 3});
  const std::vector<std::int32_t> first(feature.begin(), feature.begin() + 12);
  EXPECT_EQ(first, (std::vector<std::int32_t>{1, -1, -1, 3, -1, -1, 3, 4, -1, 0, -1, -1}));
  EXPECT_EQ(npz.text("metadata"), "{\"source\": \"test\"}");
}

TEST_F(ProximityFiles, JsonAndRowsHoldTheSame) {
  const auto json = nlohmann::json::parse(test::file_content(written("p.json")));
  EXPECT_EQ(json["metadata"]["source"], "test");
  EXPECT_EQ(json["object"], nlohmann::json::parse("[[0,0],[0,1],[0,1],[1,0]]"));
  EXPECT_EQ(json["feature"][1], nlohmann::json::parse("[[3,4,-1],[0,-1,-1]]"));
  EXPECT_EQ(json["closest"][0], nlohmann::json::parse("[[1,0,0],[3,0,0]]"));
  const std::string rows = test::file_content(written("p.csv"));
  EXPECT_EQ(rows.substr(rows.find('\n') + 1, rows.find('\n', rows.find('\n') + 1) - rows.find('\n') - 1),
            "0,0,0,1,2,1,0,0,3,0,0,1,-1,-1,3,-1,-1");
}

TEST_F(ProximityFiles, LinesAreAComplex) {
  const ComplexFile file = read_complex(written("p.vtp"));
  const Complex& lines = file.complex;
  ASSERT_EQ(lines.edges.size(), 4U);
  const auto object = lines.edge_columns.get<std::int32_t>("object", 2);
  EXPECT_EQ(std::vector(object.begin(), object.end()), objects);
  const auto distance = lines.edge_columns.get<double>("distance");
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_EQ(distance[n], pairs_[n].between.distance);
    EXPECT_EQ(lines.positions[lines.edges[n][0]], pairs_[n].between.first_point);
    EXPECT_EQ(lines.positions[lines.edges[n][1]], pairs_[n].between.second_point);
  }
  EXPECT_EQ(lines.edge_columns.get<std::int32_t>("feature", 6)[7], 4);
  EXPECT_EQ(file.metadata, (FileMetadata{{"source", "test"}}));
}

TEST_F(ProximityFiles, FurtherColumnsAreInAllFormats) {
  Columns more(pairs_.size());
  more.add<double>("depth_bound", 1, 0.5)[3] = std::numeric_limits<double>::infinity();
  more.add<std::int32_t>("two", 2)[7] = -8;
  const auto put = [&](const char* name) {
    write_proximity_pairs(folder_ / name, pairs_, meshes_, {}, more);
    return folder_ / name;
  };
  const volume_io::FileSource source(put("p.npz"));
  volume_io::NpzReader npz(source);
  EXPECT_EQ(array_of<double>(npz, "depth_bound", {4})[0], 0.5);
  EXPECT_EQ(array_of<std::int32_t>(npz, "two", {4, 2})[7], -8);
  const auto json = nlohmann::json::parse(test::file_content(put("p.json")));
  EXPECT_EQ(json["depth_bound"], nlohmann::json::parse("[0.5, 0.5, 0.5, null]"));
  EXPECT_EQ(json["two"][3], nlohmann::json::parse("[0, -8]"));
  const std::string rows = test::file_content(put("p.csv"));
  EXPECT_NE(rows.find("second_feature_2,depth_bound,two_0,two_1\n"), std::string::npos) << rows;
  EXPECT_TRUE(rows.ends_with(",inf,0,-8\n")) << rows;
  const Complex lines = read_complex(put("p.vtp")).complex;
  EXPECT_EQ(lines.edge_columns.get<std::int32_t>("two", 2)[7], -8);
}

TEST_F(ProximityFiles, InvalidFurtherColumnsAreRefused) {
  Columns three(3);
  three.add<double>("depth_bound");
  EXPECT_THROW(write_proximity_pairs(folder_ / "p.csv", pairs_, meshes_, {}, three), InvalidOption);
  Columns same(pairs_.size());
  same.add<double>("distance");
  EXPECT_THROW(write_proximity_pairs(folder_ / "p.csv", pairs_, meshes_, {}, same), InvalidOption);
  EXPECT_EQ(folder_.entries(), 0);
}

TEST_F(ProximityFiles, EmptyListsOfPairsAreWritten) {
  pairs_.clear();
  for (const std::string& extension : file_extensions(FileContent::pairs, FileAccess::write)) {
    EXPECT_GT(std::filesystem::file_size(written(("p" + extension).c_str())), 10U) << extension;
  }
}

TEST_F(ProximityFiles, ForeignPairsAreRefused) {
  const auto refused = [&](const char* name, std::span<const MeshView> meshes, const std::string& reason) {
    try {
      write_proximity_pairs(folder_ / name, pairs_, meshes);
      ADD_FAILURE() << "it was written";
    } catch (const InvalidOption& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  };
  refused("p.txt", meshes_, "use one of these extensions");
  refused("p.npz", std::span(meshes_).first(1), "a pair uses object 1, but meshes of 1 objects are given");
  pairs_[2].second = 1;
  refused("p.npz", meshes_, "a pair uses primitive 1 of object 1, whose mesh has only 1");
  EXPECT_EQ(folder_.entries(), 0);
}

TEST_F(ProximityFiles, ACancelledFileLeavesTheOldOne) {
  std::stop_source stop;
  stop.request_stop();
  Context context;
  context.cancel = stop.get_token();
  for (const std::string& extension : file_extensions(FileContent::pairs, FileAccess::write)) {
    const std::filesystem::path path = folder_ / ("p" + extension);
    test::put_file(path, "old");
    EXPECT_THROW(write_proximity_pairs(path, pairs_, meshes_, {}, {}, context), Cancelled);
    EXPECT_EQ(test::file_content(path), "old");
  }
  EXPECT_EQ(folder_.entries(), 4);
}

TEST(FeatureVertices, NameEachVertexOnce) {
  using Vertices = std::array<std::int32_t, 3>;
  constexpr Triangle triangle{7, 3, 5};
  EXPECT_EQ(feature_vertices(triangle, {SiteKind::vertex, 2}), (Vertices{5, -1, -1}));
  EXPECT_EQ(feature_vertices(triangle, {SiteKind::edge, 0}), (Vertices{3, 7, -1}));
  EXPECT_EQ(feature_vertices(triangle, {SiteKind::edge, 2}), (Vertices{5, 7, -1}));
  EXPECT_EQ(feature_vertices(triangle, {SiteKind::face, 0}), (Vertices{7, 3, 5}));
  const Triangle segment = primitive_vertices(low, 1);
  EXPECT_EQ(segment, (Triangle{4, 3, 3}));
  EXPECT_EQ(feature_vertices(segment, {SiteKind::edge, 0}), (Vertices{3, 4, -1}));
  EXPECT_EQ(feature_vertices(segment, {SiteKind::edge, 1}), (Vertices{3, -1, -1}));
  EXPECT_EQ(primitive_vertices(low, 2), (Triangle{5, 5, 5}));
  EXPECT_EQ(primitive_count(low), 3U);
}

}  // namespace
}  // namespace blum
