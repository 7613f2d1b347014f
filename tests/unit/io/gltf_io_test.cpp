// Proves that binary glTF files hold the given content in the layout of the specification, and that precision survives
// large offsets. Content that such files cannot hold is refused.
#include "blum/io/gltf_io.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cmath>
#include <limits>
#include <set>

#include "blum/io/complex_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/io/png_io.hpp"
#include "blum/shapes/generators.hpp"
#include "unit/io/glb_bytes.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

using test::ReadGlb;
using test::TemporaryFolder;

ReadGlb encoded(const GltfMesh& mesh) {
  const std::vector<std::byte> bytes = encode_gltf(mesh);
  return ReadGlb(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

/// A tetrahedron's four vertices and two of its faces.
struct Sample {
  std::vector<Vec3d> vertices{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 4}};
  std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
  [[nodiscard]] GltfMesh mesh() const {
    GltfMesh out;
    out.vertices = vertices;
    out.triangles = triangles;
    return out;
  }
};

/// Texture coordinates of faces side by side: vertices 0 and 2 have two places each or, with a common edge, one.
std::vector<std::array<std::array<float, 2>, 3>> places(bool common_edge) {
  const float other = common_edge ? 0.0F : 0.5F;
  return {{{{0, 0}, {0.25F, 0}, {0, 1}}}, {{{other, 0}, {other, 1}, {1, 0.5F}}}};
}

TEST(GltfIo, HoldsPositionsTrianglesAndTheirBox) {
  const Sample sample;
  const ReadGlb glb = encoded(sample.mesh());
  EXPECT_EQ(glb.json["asset"]["version"], "2.0");
  EXPECT_EQ(glb.attribute("POSITION"), (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 4}));
  EXPECT_EQ(glb.indices(), (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  const nlohmann::json& about = glb.json["accessors"][glb.part(0)["attributes"]["POSITION"].get<std::size_t>()];
  EXPECT_EQ(about["min"], (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(about["max"], (std::vector<double>{1, 2, 4}));
  EXPECT_FALSE(glb.json["nodes"][0].contains("translation"));
  EXPECT_FALSE(glb.json.contains("extensionsUsed"));
}

TEST(GltfIo, PrecisionSurvivesLargeOffsets) {
  Sample sample;
  const Vec3d offset{4.5e6, -1.2e6, 250};  // like geographic coordinates: floats are 0.5 apart there
  for (Vec3d& vertex : sample.vertices) vertex = vertex * 0.1 + offset;
  const ReadGlb glb = encoded(sample.mesh());
  const std::vector<float> positions = glb.attribute("POSITION");
  const auto translation = glb.json["nodes"][0]["translation"].get<std::vector<double>>();
  for (std::size_t v = 0; v < 4; ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(translation[axis] + positions[3 * v + axis], sample.vertices[v][axis], 1e-7);
    }
  }
}

TEST(GltfIo, VerticesAreSplitWhereTheirPlacesDiffer) {
  for (const bool common_edge : {false, true}) {
    const Sample sample;
    GltfMesh mesh = sample.mesh();
    const auto coordinates = places(common_edge);
    const std::vector<float> numbers{10, 11, 12, 13};
    mesh.texture_coordinates = coordinates;
    mesh.attributes.push_back({"NUMBER", 1, numbers});
    const ReadGlb glb = encoded(mesh);
    const std::vector<float> positions = glb.attribute("POSITION");
    EXPECT_EQ(positions.size(), common_edge ? 12U : 18U);
    const std::vector<float> uv = glb.attribute("TEXCOORD_0");
    const std::vector<float> number = glb.attribute("_NUMBER");
    const std::vector<std::uint32_t> corners = glb.indices();
    ASSERT_EQ(corners.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) {
      const std::uint32_t vertex = sample.triangles[i / 3][i % 3];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(positions[3 * corners[i] + axis], static_cast<float>(sample.vertices[vertex][axis]));
      }
      EXPECT_EQ(number[corners[i]], numbers[vertex]);
      EXPECT_EQ(uv[2 * corners[i]], coordinates[i / 3][i % 3][0]);
      EXPECT_EQ(uv[2 * corners[i] + 1], coordinates[i / 3][i % 3][1]);
    }
  }
}

TEST(GltfIo, TexturesAreEmbeddedUnchanged) {
  const Sample sample;
  GltfMesh mesh = sample.mesh();
  const auto coordinates = places(false);
  const std::vector<std::byte> png = encode_png(Picture(3, 2, {1, 0, 0}));
  mesh.texture_coordinates = coordinates;
  mesh.texture = png;
  mesh.name =
      "two \xff"
      "faces";
  mesh.extras = {{"units", "mm"}, {"largest", 1.5}, {"range", std::vector<double>{0, 2}}};
  const ReadGlb glb = encoded(mesh);
  EXPECT_EQ(glb.view(glb.json["images"][0]["bufferView"]),
            std::string(reinterpret_cast<const char*>(png.data()), png.size()));
  EXPECT_EQ(glb.json["images"][0]["mimeType"], "image/png");
  const nlohmann::json sampler = {{"magFilter", 9729}, {"minFilter", 9729}, {"wrapS", 33071}, {"wrapT", 33071}};
  EXPECT_EQ(glb.json["samplers"][0], sampler);
  EXPECT_EQ(glb.json["extensionsUsed"], (std::vector<std::string>{"KHR_materials_unlit"}));
  EXPECT_TRUE(glb.json["materials"][0]["extensions"]["KHR_materials_unlit"].is_object());
  EXPECT_EQ(glb.json["meshes"][0]["extras"]["units"], "mm");
  EXPECT_EQ(glb.json["meshes"][0]["extras"]["largest"], 1.5);
  EXPECT_EQ(glb.json["meshes"][0]["extras"]["range"], (std::vector<double>{0, 2}));
  EXPECT_EQ(glb.json["meshes"][0]["name"],
            "two \xef\xbf\xbd"
            "faces");
}

TEST(GltfIo, NonFiniteNumbersBecomeTheLargest) {
  const Sample sample;
  GltfMesh mesh = sample.mesh();
  const std::vector<float> numbers{1.5F, HUGE_VALF, -HUGE_VALF, std::nanf("")};
  const std::vector<Vec3f> normals{{0, 0, 5}, {1, 0, 0}, {0, -3, 4}, {1e-20F, 0, 0}};
  mesh.attributes.push_back({"A.b-1", 1, numbers});
  mesh.normals = normals;
  const ReadGlb glb = encoded(mesh);
  const float largest = std::numeric_limits<float>::max();
  EXPECT_EQ(glb.attribute("_A.b-1"), (std::vector<float>{1.5F, largest, -largest, largest}));
  EXPECT_EQ(glb.attribute("NORMAL"), (std::vector<float>{0, 0, 1, 1, 0, 0, 0, -0.6F, 0.8F, 1, 0, 0}));
}

TEST(GltfIo, LinesAndPointsAreParts) {
  const Sample sample;
  const std::vector<Segment> segments{{0, 1}, {1, 3}};
  const std::vector<std::uint32_t> points{2};
  GltfMesh mesh = sample.mesh();
  mesh.segments = segments;
  mesh.points = points;
  const ReadGlb glb = encoded(mesh);
  EXPECT_EQ(glb.part(1)["mode"], 1);
  EXPECT_EQ(glb.indices(1), (std::vector<std::uint32_t>{0, 1, 1, 3}));
  EXPECT_EQ(glb.part(2)["mode"], 0);
  EXPECT_EQ(glb.indices(2), points);
  // An empty mesh gives a scene without a mesh.
  const ReadGlb empty = encoded({});
  EXPECT_FALSE(empty.json.contains("meshes") || empty.json.contains("buffers"));
  EXPECT_TRUE(empty.json["nodes"][0].is_object());
  EXPECT_EQ(empty.json["scenes"][0]["nodes"], (std::vector<int>{0}));
}

TEST(GltfIo, FilesAreTheBytesOfMemory) {
  const TemporaryFolder folder;
  const TriangleMesh sphere = make_sphere({.frequency = 8});
  GltfMesh mesh;
  mesh.vertices = sphere.vertices;
  mesh.triangles = sphere.triangles;
  write_gltf(folder / "a.glb", mesh);
  const std::vector<std::byte> bytes = encode_gltf(mesh);
  EXPECT_EQ(test::file_content(folder / "a.glb"),
            std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  write_mesh(folder / "b.glb", sphere);
  EXPECT_EQ(test::file_content(folder / "a.glb"), test::file_content(folder / "b.glb"));
  EXPECT_THROW(write_gltf(folder / "absent" / "a.glb", mesh), FileError);
  EXPECT_THROW(write_gltf("/dev/full", mesh), FileError);  // exceptions of the writer pass through tinygltf
  std::stop_source stop;
  stop.request_stop();
  Context stopped;
  stopped.cancel = stop.get_token();
  EXPECT_THROW(write_gltf(folder / "c.glb", mesh, stopped), Cancelled);
  EXPECT_EQ(folder.entries(), 2);
}

TEST(GltfIo, RefusesUnwritableContent) {
  const Sample sample;
  const std::vector<float> four{1, 2, 3, 4};
  const auto refuses = [&]<class Error>(auto change, Error) {
    GltfMesh mesh = sample.mesh();
    EXPECT_NO_THROW((void)encode_gltf(mesh));
    change(mesh);
    EXPECT_THROW((void)encode_gltf(mesh), Error);
  };
  const InvalidOption option("");
  const InvalidMesh bad_mesh("");
  refuses([&](GltfMesh& mesh) { mesh.attributes.push_back({"a b", 1, four}); }, option);
  refuses([&](GltfMesh& mesh) { mesh.attributes.push_back({"", 1, four}); }, option);
  refuses([&](GltfMesh& mesh) { mesh.attributes.assign(2, {"a", 1, four}); }, option);
  refuses([&](GltfMesh& mesh) { mesh.attributes.push_back({"a", 2, four}); }, option);
  refuses([&](GltfMesh& mesh) { mesh.attributes.push_back({"a", 0, {}}); }, option);
  const std::vector<float> twenty(20);
  refuses([&](GltfMesh& mesh) { mesh.attributes.push_back({"a", 5, twenty}); }, option);
  refuses([&](GltfMesh& mesh) { mesh.extras = {{"a", HUGE_VAL}}; }, option);
  refuses([&](GltfMesh& mesh) { mesh.extras = {{"a", "1"}, {"a", "2"}}; }, option);
  const std::vector<std::byte> png = encode_png(Picture(1, 1, {}));
  refuses([&](GltfMesh& mesh) { mesh.texture = png; }, option);  // no coordinates
  auto coordinates = places(false);
  refuses([&](GltfMesh& mesh) { mesh.texture_coordinates = std::span(coordinates).first(1); }, option);
  const std::vector<std::byte> no_png(100);
  refuses([&](GltfMesh& mesh) { mesh.texture_coordinates = coordinates, mesh.texture = no_png; }, option);
  const std::vector<std::uint32_t> points{3};
  refuses([&](GltfMesh& mesh) { mesh.texture_coordinates = coordinates, mesh.points = points; }, option);
  coordinates[1][2][0] = HUGE_VALF;
  refuses([&](GltfMesh& mesh) { mesh.texture_coordinates = coordinates; }, option);
  const std::vector<Vec3f> normals(4);
  refuses([&](GltfMesh& mesh) { mesh.normals = normals; }, option);
  const std::vector<std::uint32_t> none{4};
  refuses([&](GltfMesh& mesh) { mesh.points = none; }, bad_mesh);
  const std::vector<Triangle> outside{{0, 1, 4}};
  refuses([&](GltfMesh& mesh) { mesh.triangles = outside; }, bad_mesh);
  for (const double bad : {HUGE_VAL, 1e39}) {
    std::vector<Vec3d> vertices = sample.vertices;
    vertices[0].x = bad;
    refuses([&](GltfMesh& mesh) { mesh.vertices = vertices; }, bad_mesh);
  }
}

TEST(GltfIo, RefusesFilesBeyondFourGigabytes) {
  const Sample sample;
  GltfMesh mesh = sample.mesh();
  const auto coordinates = places(false);
  mesh.texture_coordinates = coordinates;
  // The system provides this memory only when somebody reads it. encode_gltf() must not read it.
  constexpr std::size_t size = std::size_t{1} << 32;
  void* const memory = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  mesh.texture = {static_cast<const std::byte*>(memory), size};
  EXPECT_THROW((void)encode_gltf(mesh), FileError);
  ::munmap(memory, size);
}

Complex with_columns() {
  Complex complex;
  complex.positions = Sample().vertices;
  complex.triangles = {{0, 1, 2}};
  complex.vertex_columns = Columns(4);
  complex.edge_columns = Columns(0);
  complex.triangle_columns = Columns(1);
  complex.vertex_columns.add({"radius", 1, std::vector<double>{0.1, 0.2, 0.3, HUGE_VAL}});
  complex.vertex_columns.add({"id", 1, std::vector<std::int32_t>{1, 2, 1 << 24, -1}});
  complex.vertex_columns.add({"ID", 2, std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8}});
  return complex;
}

TEST(GltfIo, ColumnsOfComplexesAreAttributes) {
  const TemporaryFolder folder;
  write_complex(folder / "c.glb", with_columns(), {{"source", "here"}});
  const ReadGlb glb(test::file_content(folder / "c.glb"));
  EXPECT_EQ(glb.attribute("_RADIUS"), (std::vector<float>{0.1F, 0.2F, 0.3F, std::numeric_limits<float>::max()}));
  EXPECT_EQ(glb.attribute("_id"), (std::vector<float>{1, 2, 16777216, -1}));  // two names that agree in upper case
  EXPECT_EQ(glb.attribute("_ID"), (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(glb.json["meshes"][0]["extras"]["source"], "here");
  EXPECT_EQ(glb.indices(1), (std::vector<std::uint32_t>{3}));  // the vertex without a triangle
}

TEST(GltfIo, ColumnsThatFilesWouldLoseAreRefused) {
  const TemporaryFolder folder;
  const auto refused = [&](auto add) {
    Complex complex = with_columns();
    add(complex);
    EXPECT_THROW(write_complex(folder / "c.glb", complex), InvalidOption);
    EXPECT_NO_THROW(write_complex(folder / "c.glb", complex, {}, {.allow_loss = true}));
  };
  refused([](Complex& c) { c.triangle_columns.add({"a", 1, std::vector<float>{1}}); });
  refused([](Complex& c) { c.vertex_columns.add({"a", 5, std::vector<float>(20)}); });
  refused([](Complex& c) { c.vertex_columns.add({"a", 1, std::vector<std::int64_t>{0, 0, 0, (1 << 24) + 1}}); });
}

}  // namespace
}  // namespace blum
