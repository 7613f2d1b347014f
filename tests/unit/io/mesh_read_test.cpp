// Proves that the mesh readers accept every variant of headers, numbers, indices, line ends, byte orders and types that
// their formats allow. The shape is neither reduced nor extended.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mesh_text.hpp"
#include "temporary_folder.hpp"

namespace blum {
namespace {

using test::binary_stl;
using test::Bytes;
using test::parse_mesh;

const std::vector<Vec3d> corner_vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TriangleMesh obj(std::string_view text) {
  return parse_mesh(text, MeshFormat("OBJ")).mesh;
}
TriangleMesh off(std::string_view text) {
  return parse_mesh(text, MeshFormat("OFF")).mesh;
}
TriangleMesh ply(std::string_view text) {
  return parse_mesh(text, MeshFormat("PLY")).mesh;
}

TEST(MeshObj, EveryFormOfFace) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n";
  for (const char* face :
       {"f 1 2 3", "f 1/1 2/1 3/1", "f 1//1 2//1 3//1", "f 1/1/1 2/1/1 3/1/1", "f -3 -2 -1",
        "f -3/-1/-1 -2/-1/-1 -1/-1/-1", "f\t1  2\t3 \t", "f 1 2 3 # comment", "f 1 \\\n2 \\\r\n 3"}) {
    const TriangleMesh mesh = obj(vertices + face);
    EXPECT_EQ(mesh.vertices, corner_vertices) << face;
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}})) << face;
    EXPECT_TRUE(mesh.points.empty() && mesh.segments.empty()) << face;
  }
}

TEST(MeshObj, LinesPointsAndEverythingElse) {
  const TriangleMesh mesh =
      obj("\xEF\xBB\xBF# comment\r\n\r\nmtllib a.mtl\r\no part\r\ng all\r\ns off\r\n"
          "v 0 0 0 1.0\r\nv 1 0 0 0.5 0.5 0.5\r\n  v 0 1 0\r\nusemtl red\r\nl 1 2 -1\r\np 2 3\r\nl 1/1 3/2\r\n# end");
  EXPECT_EQ(mesh.vertices, corner_vertices);
  EXPECT_EQ(mesh.segments, (std::vector<Segment>{{0, 1}, {1, 2}, {0, 2}}));
  EXPECT_EQ(mesh.points, (std::vector<std::uint32_t>{1, 2}));
}

TEST(MeshObj, FacesMayComeBeforeTheirVertices) {
  EXPECT_EQ(obj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(MeshObj, LineEndsOfEveryKindCountTheSame) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const std::string text = "v 0 0 0" + end + "v 1 0 0" + end + end + "v 0 1 0" + end + "f 1 2 3" + end;
    EXPECT_EQ(obj(text).triangles.size(), 1U);
    EXPECT_NE(test::refusal(text + "v 1 x 2" + end, MeshFormat("OBJ")).find("line 6:"), std::string::npos);
  }
}

TEST(MeshNumbers, KeepDoublePrecisionAndEveryNotation) {
  const TriangleMesh mesh =
      obj("v 0.1 +1.5 -2\nv 1e3 1E-3 .5\nv 5. 1e+2 0.30000000000000004\n"
          "v 4.9e-324 1e-400 -1e-999999999999\nv 1.7976931348623157e308 0.0000 -0");
  EXPECT_EQ(mesh.vertices[0], (Vec3d{0.1, 1.5, -2}));
  EXPECT_EQ(mesh.vertices[1], (Vec3d{1000, 0.001, 0.5}));
  EXPECT_EQ(mesh.vertices[2], (Vec3d{5, 100, 0.1 + 0.2}));
  EXPECT_EQ(mesh.vertices[3], (Vec3d{std::numeric_limits<double>::denorm_min(), 0, 0}));
  EXPECT_EQ(mesh.vertices[4].x, std::numeric_limits<double>::max());
  EXPECT_EQ(obj("v 0." + std::string(400, '0') + "1 1 1").vertices[0].x, 0.0);
  EXPECT_EQ(obj("v " + std::string(300, '0') + "1 1 1").vertices[0].x, 1.0);
}

TEST(MeshPointCloud, FilesOfVerticesOnlyHaveEveryVertexAsAPoint) {
  const std::vector<std::uint32_t> all = {0, 1, 2};
  EXPECT_EQ(obj("v 0 0 0\nv 1 0 0\nv 0 1 0\n").points, all);
  EXPECT_EQ(off("OFF 3 0 0\n0 0 0\n1 0 0\n0 1 0\n").points, all);
  EXPECT_EQ(ply("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                "end_header\n0 0 0\n1 0 0\n0 1 0\n")
                .points,
            all);
  EXPECT_TRUE(obj("v 0 0 0\nv 1 0 0\nl 1 2\n").points.empty());
}

TEST(MeshOff, HeadersAndColumnsOfEveryKind) {
  for (const char* head : {"OFF\n3 1 0\n", "OFF 3 1 3\n", "# made by hand\n\nOFF # kind\n# counts\n3 1 3 # V F E\n\n",
                           "3 1 3\n", "OFF\r\n3 1\r\n", "COFF\n3 1 0\n", "NOFF\n3 1 0\n", "CNOFF\n3 1 0\n",
                           "STCNOFF 3 1 0\n", "\xEF\xBB\xBFOFF\n3 1 0\n"}) {
    const TriangleMesh mesh =
        off(std::string(head) + "0 0 0 0.5 0.5 0.5 1\n1 0 0 255 0 0 # red\n\n0 1 0\n3 0 1 2 0.1 0.2 0.3\n");
    EXPECT_EQ(mesh.vertices, corner_vertices) << head;
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}})) << head;
  }
}

TEST(MeshOff, LongFacesMayGoOverSeveralLines) {
  EXPECT_EQ(off("OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1\n2 3\n").triangles,
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

constexpr std::string_view text_stl =
    "solid a part facet\nfacet normal nan 0 1\n outer loop\n  vertex 0 0 0\n  vertex 0.1 0 0\n  vertex 0 1e0 0\n"
    " endloop\nendfacet\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0.1 0 0\nVERTEX 1 1 0\nVERTEX 0 1 "
    "0\nENDLOOP\nENDFACET\n"
    "endsolid a part\nsolid\nendsolid\n";

TEST(MeshStl, TextIsReadWithDoublesAndWelded) {
  const MeshFile file = parse_mesh(text_stl, MeshFormat("STL"));
  EXPECT_EQ(file.mesh.vertices, (std::vector<Vec3d>{{0, 0, 0}, {0.1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_FALSE(file.info.binary);
  EXPECT_TRUE(file.info.welded);
  EXPECT_EQ(file.info.vertices, 6U);
  EXPECT_EQ(file.info.merged_vertices, 2U);
}

TEST(MeshStl, BinaryIsRecognizedWithAnyHeader) {
  for (const char* header :
       {"binary", "solid", "solid facet normal 0 0 0\nouter loop\nvertex 0 0 0\n", "", "  solid x"}) {
    for (const std::uint32_t count : {1U, 7U, 300U}) {
      const MeshFile file = parse_mesh(binary_stl(count, count, header), MeshFormat("STL"));
      EXPECT_TRUE(file.info.binary) << header;
      EXPECT_EQ(file.mesh.triangles.size(), count) << header;
      EXPECT_EQ(file.mesh.vertices.size(), 2 + count) << header;
    }
  }
}

TEST(MeshWeld, DefaultsAndTolerance) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 1e-7\nv 0 -1 0\nf 1 2 3\nf 4 6 5\n";
  EXPECT_EQ(parse_mesh(text, MeshFormat("OBJ")).mesh.vertices.size(), 6U);
  EXPECT_FALSE(parse_mesh(text, MeshFormat("OBJ")).info.welded);
  EXPECT_EQ(parse_mesh(text, MeshFormat("OBJ"), {.weld = 0.0}).mesh.vertices.size(), 5U);
  EXPECT_EQ(parse_mesh(text, MeshFormat("OBJ"), {.weld = 1e-6}).mesh.vertices.size(), 4U);
  EXPECT_EQ(parse_mesh(text, MeshFormat("OBJ"), {.weld = 1e-6}).info.merged_vertices, 2U);
  EXPECT_THROW((void)parse_mesh(text, MeshFormat("OBJ"), {.weld = -1.0}), InvalidOption);
}

TEST(MeshPly, TextWithOtherElementsAndProperties) {
  const TriangleMesh mesh = ply(
      "ply\r\nformat ascii 1.0\r\ncomment element vertex 9\r\nobj_info x\r\nelement camera 2\r\nproperty float a\r\n"
      "property list uchar float b\r\nelement nothing 1000000000000\r\nelement vertex 4\r\nproperty uchar red\r\n"
      "property double z\r\nproperty list int int used\r\nproperty float x\r\nproperty int y\r\n"
      "element face 2\r\nproperty float q\r\nproperty list uchar int vertex_index\r\nproperty list uchar float uv\r\n"
      "element edge 1\r\nproperty int vertex2\r\nproperty uchar c\r\nproperty int vertex1\r\nend_header\r\n"
      "1.5 2 7 7\r\n1.5 0\r\n1 0.25 0 0 0\r\n2 0 3 1 2 3 1 0\r\n3 0 0 1 1\r\n4 0 0 0 1\r\n"
      "0.5 4 0 1 2 3 2 0.5 0.5\r\n0.5 3 3 2 1 0\r\n3 9 1\r\n\r\n");
  EXPECT_EQ(mesh.vertices, (std::vector<Vec3d>{{0, 0, 0.25}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {3, 2, 1}}));
  EXPECT_EQ(mesh.segments, (std::vector<Segment>{{1, 3}}));
}

/// Adds a whole number as one of ten number types of PLY.
void add_as(Bytes& bytes, std::string_view type, std::int64_t value) {
  if (type == "char") bytes.add(static_cast<std::int8_t>(value));
  if (type == "uint8") bytes.add(static_cast<std::uint8_t>(value));
  if (type == "short") bytes.add(static_cast<std::int16_t>(value));
  if (type == "uint16") bytes.add(static_cast<std::uint16_t>(value));
  if (type == "int") bytes.add(static_cast<std::int32_t>(value));
  if (type == "uint32") bytes.add(static_cast<std::uint32_t>(value));
  if (type == "int64") bytes.add(value);
  if (type == "uint64") bytes.add(static_cast<std::uint64_t>(value));
  if (type == "float") bytes.add(static_cast<float>(value));
  if (type == "double") bytes.add(static_cast<double>(value));
}

TEST(MeshPly, BinaryOfEveryTypeAndByteOrder) {
  const std::vector<std::string> types = {"char",   "uint8", "short",  "uint16", "int",
                                          "uint32", "int64", "uint64", "float",  "double"};
  for (const bool big : {false, true}) {
    for (std::size_t count_type = 0; count_type < 8; ++count_type) {
      for (std::size_t type = 0; type < types.size(); ++type) {
        const std::string& index_type = types[type % 8];
        Bytes bytes(big);
        bytes.text(std::string("ply\nformat binary_") + (big ? "big" : "little") +
                   "_endian 1.0\nelement vertex 4\nproperty " + types[type] + " x\nproperty list " + types[count_type] +
                   " short skipped\nproperty double y\nproperty " + types[type] + " z\nelement face 2\nproperty list " +
                   types[count_type] + " " + index_type + " vertex_indices\nelement edge 1\nproperty " + index_type +
                   " vertex1\nproperty " + index_type + " vertex2\nend_header\n");
        for (int i = 0; i < 4; ++i) {
          add_as(bytes, types[type], 100 + i);
          add_as(bytes, types[count_type], i);
          for (int k = 0; k < i; ++k) bytes.add(std::int16_t{-7});
          bytes.add(i == 2 ? 0.1 : -1.0);
          add_as(bytes, types[type], i * i);
        }
        for (const int size : {3, 4}) {
          add_as(bytes, types[count_type], size);
          for (int k = 0; k < size; ++k) add_as(bytes, index_type, k);
        }
        add_as(bytes, index_type, 3);
        add_as(bytes, index_type, 1);
        const TriangleMesh mesh = ply(bytes.str());
        EXPECT_EQ(mesh.vertices, (std::vector<Vec3d>{{100, -1, 0}, {101, -1, 1}, {102, 0.1, 4}, {103, -1, 9}}));
        ASSERT_EQ(mesh.triangles.size(), 3U);
        EXPECT_EQ(mesh.triangles[0], (Triangle{0, 1, 2}));
        EXPECT_EQ(mesh.segments, (std::vector<Segment>{{3, 1}}));
      }
    }
  }
}

TEST(MeshPly, HeaderLineEndsDecideWhereBinaryDataBegins) {
  // The first byte of the data is a line feed. It is not a part of header lines that end in CR.
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    Bytes bytes;
    for (const char* line : {"ply", "format binary_little_endian 1.0", "element vertex 1", "property uchar x",
                             "property uchar y", "property uchar z", "end_header"}) {
      bytes.text(line + end);
    }
    bytes.text("\n\r\n");
    EXPECT_EQ(ply(bytes.str()).vertices, (std::vector<Vec3d>{{10, 13, 10}}));
  }
}

TEST(MeshPly, TriangleStrips) {
  const TriangleMesh mesh =
      ply("ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
          "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
          "0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 2 2\n10 0 1 2 3 -1 4 3 2 2 1\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {4, 3, 2}}));
}

TEST(MeshFormats, ExtensionsInAnyCase) {
  EXPECT_EQ(MeshFormat::by_name("a/b.OBJ"), MeshFormat("OBJ"));
  EXPECT_EQ(MeshFormat::by_name("x.y.Stl"), MeshFormat("STL"));
  EXPECT_EQ(MeshFormat::by_name("x.off"), MeshFormat("OFF"));
  EXPECT_EQ(MeshFormat::by_name("x.pLY"), MeshFormat("PLY"));
  EXPECT_FALSE(MeshFormat::by_name("x.gltf").has_value());
  EXPECT_FALSE(MeshFormat::by_name("obj").has_value());
  EXPECT_EQ(MeshFormat(".ply").name(), "PLY");
  EXPECT_THROW(MeshFormat("gltf"), InvalidOption);
}

TEST(MeshFormats, FilesOfAnySizeAreReadWhole) {
  const test::TemporaryFolder folder;
  for (const std::size_t lines : {1U, 511U, 512U, 513U, 5000U}) {  // 8 bytes each: around the first block of 4096
    std::string text;
    for (std::size_t i = 0; i < lines; ++i) text += "v 1 2 3\n";
    test::put_file(folder / "a.obj", text);
    EXPECT_EQ(read_mesh(folder / "a.obj").vertices.size(), lines);
  }
}

}  // namespace
}  // namespace blum
