// Proves that files of collisions in a scene name the colliding objects in all formats. Collisions that do not belong
// to the given meshes are refused.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/collision_io.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/formats.hpp"
#include "io/archive/numpy.hpp"
#include "io/bytes/byte_source.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

const TriangleMesh first{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {3, 2, 1}}, {}, {}};
const TriangleMesh second{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{2, 0, 1}}, {}, {}};

/// The second mesh at the end of its motion: one unit lower, through the first mesh.
const std::vector<Vec3d> lowered{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

class CollisionFiles : public testing::Test {
 protected:
  CollisionFiles() {
    found_.objects.push_back({ObjectId(0), ObjectId(0), {{3, TriangleId(0), 0.5}}, {}, {}});
    found_.objects.push_back(
        {ObjectId(0), ObjectId(1), {{3, TriangleId(0), 0.25}}, {{2, TriangleId(1), 0.75}}, {{{0, 1}, {1, 2}, 0.125}}});
  }
  std::filesystem::path written(const char* name) {
    write_collisions(folder_ / name, found_, meshes_, {{"source", "test"}});
    return folder_ / name;
  }

  std::array<MeshMotion, 2> meshes_{MeshMotion(first), MeshMotion(second, lowered)};
  SceneCollisions found_;
  test::TemporaryFolder folder_;
};

template <class T>
std::vector<T> array_of(volume_io::NpzReader& npz, const std::string& name, const std::vector<std::uint64_t>& shape) {
  return npz.read(name, [&](volume_io::ByteStream& stream, const volume_io::NpyHeader& header) {
    EXPECT_EQ(header.shape, shape) << name;
    return std::get<std::vector<T>>(read_npy_values(stream, header));
  });
}

TEST_F(CollisionFiles, ArraysNameTheObjectsOfEachPair) {
  const volume_io::FileSource source(written("c.npz"));
  volume_io::NpzReader npz(source);
  using Numbers = std::vector<std::int32_t>;
  EXPECT_EQ(array_of<std::int32_t>(npz, "vertex_face", {3, 4}), (Numbers{3, 0, 1, 2, 3, 2, 0, 1, 2, 3, 2, 1}));
  EXPECT_EQ(array_of<std::int32_t>(npz, "vertex_face_object", {3, 2}), (Numbers{0, 0, 0, 1, 1, 0}));
  EXPECT_EQ(array_of<std::int32_t>(npz, "face", {3}), (Numbers{0, 0, 1}));
  EXPECT_EQ(array_of<double>(npz, "vertex_face_time", {3}), (std::vector{0.5, 0.25, 0.75}));
  EXPECT_EQ(array_of<std::int32_t>(npz, "edge_edge", {1, 4}), (Numbers{0, 1, 1, 2}));
  EXPECT_EQ(array_of<std::int32_t>(npz, "edge_edge_object", {1, 2}), (Numbers{0, 1}));
  EXPECT_EQ(array_of<double>(npz, "edge_edge_time", {1}), (std::vector{0.125}));
  EXPECT_EQ(npz.text("metadata"), "{\"source\": \"test\"}");
}

TEST_F(CollisionFiles, RowsAndListsHoldTheSame) {
  EXPECT_EQ(test::file_content(written("c.csv")),
            "kind,first_object,second_object,a,b,c,d,time,face\n"
            "vertex_face,0,0,3,0,1,2,0.5,0\nvertex_face,0,1,3,2,0,1,0.25,0\nvertex_face,1,0,2,3,2,1,0.75,1\n"
            "edge_edge,0,1,0,1,1,2,0.125,\n");
  const auto json = nlohmann::json::parse(test::file_content(written("c.json")));
  EXPECT_EQ(json, nlohmann::json::parse(R"({"metadata": {"source": "test"}, "face": [0, 0, 1],
      "vertex_face": [[3, 0, 1, 2], [3, 2, 0, 1], [2, 3, 2, 1]], "vertex_face_object": [[0, 0], [0, 1], [1, 0]],
      "vertex_face_time": [0.5, 0.25, 0.75], "edge_edge": [[0, 1, 1, 2]], "edge_edge_object": [[0, 1]],
      "edge_edge_time": [0.125]})"));
}

TEST_F(CollisionFiles, FeaturesAreDrawnWhereTheyMeet) {
  const ComplexFile file = read_complex(written("c.vtp"));
  const Complex& all = file.complex;
  ASSERT_EQ(all.positions.size(), 16U);
  ASSERT_EQ(all.triangles.size(), 3U);
  ASSERT_EQ(all.edges.size(), 2U);
  // The face of the second pair has come down by 0.25 at time 0.25; the vertex rests.
  EXPECT_EQ(all.positions[4], (Vec3d{1, 1, 0}));
  EXPECT_EQ(all.triangles[1], (std::array<std::uint32_t, 3>{5, 6, 7}));
  EXPECT_EQ(all.positions[5], (Vec3d{0, 1, 0.75}));
  // The last pair has an edge of each object.
  EXPECT_EQ(all.edges[0], (std::array<std::uint32_t, 2>{12, 13}));
  EXPECT_EQ(all.positions[13], (Vec3d{1, 0, 0}));
  EXPECT_EQ(all.positions[14], (Vec3d{1, 0, 0.875}));
  const auto numbers = [](std::span<const std::int32_t> values) { return std::vector(values.begin(), values.end()); };
  EXPECT_EQ(numbers(all.vertex_columns.get<std::int32_t>("object")),
            (std::vector{0, 0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 0, 1, 1}));
  EXPECT_EQ(all.vertex_columns.get<std::int32_t>("vertex")[8], 2);
  EXPECT_EQ(numbers(all.edge_columns.get<std::int32_t>("pair")), (std::vector{3, 3}));
  EXPECT_EQ(all.edge_columns.get<double>("time")[1], 0.125);
  EXPECT_EQ(numbers(all.triangle_columns.get<std::int32_t>("pair")), (std::vector{0, 1, 2}));
  EXPECT_EQ(all.triangle_columns.get<double>("time")[2], 0.75);
  EXPECT_EQ(numbers(all.triangle_columns.get<std::int32_t>("face")), (std::vector{0, 0, 1}));
  EXPECT_EQ(file.metadata, (FileMetadata{{"source", "test"}}));
}

TEST_F(CollisionFiles, SingleMeshFilesNameNoObject) {
  ContinuousCollisions alone;
  alone.vertex_face = found_.objects[0].vertex_face;
  alone.edge_edge.push_back({{0, 1}, {2, 3}, 1});
  write_collisions(folder_ / "c.csv", alone, first);
  EXPECT_EQ(test::file_content(folder_ / "c.csv"),
            "kind,a,b,c,d,time,face\nvertex_face,3,0,1,2,0.5,0\nedge_edge,0,1,2,3,1,\n");
  write_collisions(folder_ / "c.json", alone, first);
  EXPECT_EQ(nlohmann::json::parse(test::file_content(folder_ / "c.json")),
            nlohmann::json::parse(R"({"metadata": {}, "vertex_face": [[3, 0, 1, 2]], "vertex_face_time": [0.5],
      "edge_edge": [[0, 1, 2, 3]], "edge_edge_time": [1], "face": [0]})"));
  write_collisions(folder_ / "c.vtp", alone, first);
  const Complex all = read_complex(folder_ / "c.vtp").complex;
  EXPECT_EQ(all.vertex_columns.find("object"), nullptr);
  EXPECT_EQ(all.positions[7], (Vec3d{1, 1, 0}));
}

TEST_F(CollisionFiles, EarliestTimeCoversAllKinds) {
  EXPECT_EQ(found_.objects[0].earliest(), 0.5);
  EXPECT_EQ(found_.objects[1].earliest(), 0.125);
  EXPECT_EQ(found_.earliest(), 0.125);
  found_.objects[1].edge_edge.clear();
  EXPECT_EQ(found_.earliest(), 0.25);
  EXPECT_EQ(ObjectCollisions().earliest(), std::nullopt);
}

TEST_F(CollisionFiles, ForeignCollisionsAreRefused) {
  const auto refused = [&](const char* name, std::span<const MeshMotion> meshes, const std::string& reason) {
    try {
      write_collisions(folder_ / name, found_, meshes);
      ADD_FAILURE() << "it was written";
    } catch (const InvalidOption& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  };
  refused("c.obj", meshes_, "use one of these extensions");
  refused("c.npz", std::span(meshes_).first(1), "a collision uses object 1, but meshes of 1 objects are given");
  found_.objects[1].vertex_face[0].face = TriangleId(1);
  refused("c.csv", meshes_, "a collision uses face 1 of object 1, but that mesh has only 1");
  found_.objects[1].vertex_face[0].face = TriangleId(0);
  found_.objects[1].vertex_face[0].vertex = 4;
  refused("c.vtp", meshes_, "a collision uses vertex 4 of a mesh that has only 4");
  found_.objects[1].vertex_face[0].vertex = 3;
  meshes_[1].end = meshes_[1].end.first(2);
  refused("c.vtp", meshes_, "a mesh has 3 vertices at the start, but 2 at the end");
  ContinuousCollisions alone;
  alone.vertex_face.push_back({3, TriangleId(2), 0.5});
  EXPECT_THROW(write_collisions(folder_ / "c.npz", alone, first), InvalidOption);
  EXPECT_EQ(folder_.entries(), 0);
}

TEST_F(CollisionFiles, ACancelledFileLeavesTheOldOne) {
  std::stop_source stop;
  stop.request_stop();
  Context context;
  context.cancel = stop.get_token();
  for (const std::string& extension : file_extensions(FileContent::collisions, FileAccess::write)) {
    const std::filesystem::path path = folder_ / ("c" + extension);
    test::put_file(path, "old");
    EXPECT_THROW(write_collisions(path, found_, meshes_, {}, context), Cancelled);
    EXPECT_EQ(test::file_content(path), "old");
  }
  EXPECT_EQ(folder_.entries(), 4);
}

}  // namespace
}  // namespace blum
