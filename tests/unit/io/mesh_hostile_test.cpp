// Proves that broken and hostile mesh files are refused with an error that names the reason and the place. Readers take
// no memory for sizes that a file only promises.
#include <gtest/gtest.h>

#include <chrono>
#include <limits>

#include "mesh_text.hpp"
#include "temporary_folder.hpp"

namespace blum {
namespace {

using test::binary_stl;
using test::refusal;

struct Hostile {
  const char* name;
  MeshFormat format;
  std::string content;
  const char* error;  ///< part of the message; "read" if the file is valid
  const char* place;  ///< "line N:" or "byte N:"
};

const MeshFormat obj = MeshFormat("OBJ"), off = MeshFormat("OFF"), stl = MeshFormat("STL"), ply = MeshFormat("PLY");

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string ply_vertices = "property float x\nproperty float y\nproperty float z\n";
const std::string ply_text = "ply\nformat ascii 1.0\nelement vertex 3\n" + ply_vertices;
const std::string ply_faces =
    ply_text + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
const std::string ply_binary = "ply\nformat binary_little_endian 1.0\n";

std::string binary_ply_vertex(float z) {
  return test::Bytes()
      .text(ply_binary + "element vertex 1\n" + ply_vertices + "end_header\n")
      .add(1.0F)
      .add(2.0F)
      .add(z)
      .str();
}

std::string nan_stl() {
  std::string bytes = binary_stl(2, 2);
  for (const std::size_t i : {84U + 50U + 14U, 84U + 50U + 15U}) bytes[i] = '\x7f';
  bytes[84 + 50 + 14] = '\x80';
  return bytes;
}

std::vector<Hostile> hostile_files() {
  return {
      {"obj empty", obj, "", "without a vertex", "line 1:"},
      {"obj garbage", obj, std::string("\x00\xff\x13\x37v\n\x01", 7), "without a vertex", "line 2:"},
      {"obj zero index", obj, triangle + "f 0 1 2\n", "vertex index 0", "line 4:"},
      {"obj index too large", obj, triangle + "f 1 2 4\n", "vertex 4 is used, but the file has only 3", "line 4:"},
      {"obj negative index too large", obj, triangle + "f -1 -2 -4\n", "vertex index -4", "line 4:"},
      {"obj index 10^12", obj, triangle + "f 1 2 1000000000000\n", "out of range", "line 4:"},
      {"obj index 10^30", obj, triangle + "f 1 2 1000000000000000000000000000000\n", "too large", "line 4:"},
      {"obj index 2^32 + 1", obj, triangle + "f 1 2 4294967297\n", "out of range", "line 4:"},
      {"obj polygon of 2", obj, triangle + "\nf 1 2\n", "a face of 2 corners", "line 5:"},
      {"obj polygon of 0", obj, triangle + "f\n", "a face of 0 corners", "line 4:"},
      {"obj line of 1", obj, triangle + "l 1\n", "a line of 1 points", "line 4:"},
      {"obj index of letters", obj, triangle + "f a b c\n", "vertex index is not a whole number: 'a'", "line 4:"},
      {"obj index with a dot", obj, triangle + "f 1.5 2 3\n", "not of the form", "line 4:"},
      {"obj nan", obj, "v 0 0 0\nv 1 nan 0\n", "not finite: 'nan'", "line 2:"},
      {"obj inf", obj, "v 0 0 0\nv -inf 1 0\n", "not finite: '-inf'", "line 2:"},
      {"obj nan of MSVC", obj, "v 0 0 1.#QNAN\n", "not a number: '1.#QNAN'", "line 1:"},
      {"obj 1e999", obj, "v 0 0 1e999\n", "too large for a double", "line 1:"},
      {"obj 10^400 in digits", obj, "v 0 0 1" + std::string(400, '0') + "\n", "too large for a double", "line 1:"},
      {"obj cut coordinates", obj, "v 0 0 0\nv 1 2", "z coordinate is missing: the file ends here", "line 2:"},
      {"obj decimal comma", obj, "v 0,5 0 0\n", "not a number: '0,5'", "line 1:"},
      {"off empty", off, "", "empty", "line 1:"},
      {"off other format", off, "ply\nformat ascii 1.0\n", "must begin with 'OFF'", "line 1:"},
      {"off binary", off, "OFF BINARY\n\x01\x02", "binary OFF is not supported", "line 1:"},
      {"off 4D", off, "4OFF\n1 0 0\n0 0 0 0\n", "more than 3 dimensions", "line 1:"},
      {"off nD", off, "nOFF\n5\n1 0 0\n0 0 0 0 0\n", "more than 3 dimensions", "line 1:"},
      {"off 10^12 vertices", off, "OFF\n1000000000000 1 0\n0 0 0\n", "promises 1000000000000 vertices", "line 3:"},
      {"off 10^12 faces", off, "OFF\n1 1000000000000 0\n0 0 0\n", "promises 1000000000000 faces", "line 4:"},
      {"off negative count", off, "OFF\n-3 1 0\n", "number of vertices is negative", "line 2:"},
      {"off too few vertices", off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n", "a face of 0 corners",
       "line 6:"},
      {"off too few faces", off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0\n", "goes on after", "line 7:"},
      {"off cut", off, "OFF\n3 1 0\n0 0 0\n1 0 0\n", "ends after 2 of 3 vertices", "line 5:"},
      {"off cut face", off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1", "vertex index is missing", "line 6:"},
      {"off index 3 of 3", off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "vertex index 3 is out of range",
       "line 6:"},
      {"off index -1", off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "vertex index -1 is out of range",
       "line 6:"},
      {"off polygon of 10^12", off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n1000000000000 0 1 2\n", "too short", "line 6:"},
      {"off polygon of 2", off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "a face of 2 corners", "line 6:"},
      {"off nan", off, "OFF\n1 0 0\n0 nan 0\n", "not finite", "line 3:"},
      {"off no vertices", off, "OFF\n0 0 0\n", "no vertices", "line 3:"},
      {"stl empty", stl, "", "neither text STL", "byte 0:"},
      {"stl short", stl, "hello world", "neither text STL", "byte 11:"},
      {"stl cut", stl, binary_stl(2, 3), "promises 3 triangles, so 234 bytes, but the file has 184", "byte 184:"},
      {"stl cut solid", stl, binary_stl(2, 3, std::string("solid\0", 6)), "promises 3 triangles", "byte 184:"},
      {"stl too long", stl, binary_stl(3, 2), "promises 2 triangles", "byte 234:"},
      {"stl 2^32 - 1 triangles", stl, binary_stl(1, 0xffffffffU), "promises 4294967295 triangles", "byte 134:"},
      {"stl no triangles", stl, binary_stl(0, 0), "no triangles", "byte 80:"},
      {"stl nan", stl, nan_stl(), "triangle 1 (counted from 0) is not finite", "byte 146:"},
      {"stl text without triangles", stl, "solid\nendsolid\n", "no triangles", "line 3:"},
      {"stl text cut", stl, "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0", "missing", "line 5:"},
      {"stl text without end", stl,
       "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n",
       "ends where 'facet' or 'endsolid'", "line 9:"},
      {"stl text of 4 corners", stl,
       "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 1 1 1\n",
       "expected 'endloop', found 'vertex'", "line 7:"},
      {"stl text nan", stl, "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 NaN\n", "not finite", "line 4:"},
      {"ply empty", ply, "", "must begin with the word 'ply'", "line 1:"},
      {"ply without end", ply, ply_text, "'end_header' is missing", "line 7:"},
      {"ply without format", ply, "ply\nelement vertex 1\nend_header\n", "no 'format' line", "line 3:"},
      {"ply format 2.0", ply, "ply\nformat ascii 2.0\n", "only version 1.0", "line 2:"},
      {"ply unknown format", ply, "ply\nformat binary 1.0\n", "unknown format 'binary'", "line 2:"},
      {"ply unknown type", ply, "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n", "unknown type 'half'",
       "line 4:"},
      {"ply unknown keyword", ply, "ply\nformat ascii 1.0\nvertices 3\n", "unknown keyword", "line 3:"},
      {"ply property first", ply, "ply\nformat ascii 1.0\nproperty float x\n", "before the first element", "line 3:"},
      {"ply negative count", ply, "ply\nformat ascii 1.0\nelement vertex -1\n", "negative count", "line 3:"},
      {"ply element twice", ply, "ply\nformat ascii 1.0\nelement a 1\nelement a 1\n", "occurs twice", "line 4:"},
      {"ply float list length", ply, "ply\nformat ascii 1.0\nelement face 1\nproperty list float int vertex_indices\n",
       "length of a list must be of a whole-number type", "line 4:"},
      {"ply float indices", ply,
       "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar float vertex_indices\nend_header\n3 0 1 2\n",
       "must be of a whole-number type", "line 6:"},
      {"ply without z", ply,
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
       "no property 'z'", "line 7:"},
      {"ply x twice", ply,
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n" + ply_vertices + "end_header\n0 0 0 0\n",
       "more than one property 'x'", "line 9:"},
      {"ply 10^12 vertices", ply,
       ply_binary + "element vertex 1000000000000\n" + ply_vertices + "end_header\n0123456789",
       "promises 1000000000000 of element 'vertex'", "byte 127:"},
      {"ply 10^12 faces", ply,
       ply_text +
           "element face 1000000000000\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n",
       "promises 1000000000000 of element 'face'", "line 12:"},
      {"ply list of 2^32 - 1", ply,
       test::Bytes()
           .text(ply_binary + "element face 1\nproperty list uint int vertex_indices\nend_header\n")
           .add(-1)
           .str(),
       "a list of 4294967295 entries", "byte 100:"},
      {"ply list of negative length", ply,
       test::Bytes()
           .text(ply_binary + "element face 1\nproperty list int int vertex_indices\nend_header\n")
           .add(-1)
           .str(),
       "a list of negative length", "byte 99:"},
      {"ply nan", ply, binary_ply_vertex(std::numeric_limits<float>::quiet_NaN()), "not finite", "byte 123:"},
      {"ply cut", ply, binary_ply_vertex(1).substr(0, 125), "promises 1 of element 'vertex'", "byte 115:"},
      {"ply more than promised", ply, binary_ply_vertex(1) + "x", "goes on after", "byte 127:"},
      {"ply padded", ply, binary_ply_vertex(1) + "\r\n", "read", ""},
      {"ply polygon of 2", ply, ply_faces + "2 0 1\n", "a face of 2 corners", "line 13:"},
      {"ply index out of range", ply, ply_faces + "3 0 1 3\n", "vertex 3 is used, but the file has only 3", "line 13:"},
      {"ply index negative", ply, ply_faces + "3 0 1 -2\n", "vertex index -2", "line 13:"},
      {"ply text cut", ply, ply_faces + "3 0 1", "vertex index is missing: the file ends here", "line 13:"},
      {"ply more text than promised", ply, ply_faces + "3 0 1 2\n3 0 1 2\n", "goes on after", "line 14:"},
      {"ply no vertices", ply, "ply\nformat ascii 1.0\nelement vertex 0\n" + ply_vertices + "end_header\n",
       "no vertices", "line 8:"},
  };
}

TEST(MeshHostile, EveryFileIsRefusedForItsReasonAtItsPlace) {
  for (const Hostile& file : hostile_files()) {
    const std::string message = refusal(file.content, file.format);
    EXPECT_NE(message.find(file.error), std::string::npos) << file.name << ": " << message;
    EXPECT_NE(message.find(file.place), std::string::npos) << file.name << ": " << message;
    EXPECT_TRUE(message == "read" || message.starts_with("'test.mesh', ")) << file.name << ": " << message;
  }
}

TEST(MeshHostile, EveryCutAndEveryChangedByteOfAGoodFileIsReadOrRefused) {
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  test::Bytes binary;
  binary.text(ply_binary + "element vertex 3\n" + ply_vertices + face);
  for (const int value : {0, 0, 0, 1, 0, 0, 0, 1, 0}) binary.add(static_cast<float>(value));
  binary.add(std::uint8_t{3}).add(0).add(1).add(2);
  const std::vector<std::pair<MeshFormat, std::string>> good = {
      {obj, triangle + "f 1/1 2/2 3/3\nl 1 2\n"},
      {off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {stl, binary_stl(2, 2)},
      {ply, ply_faces + "3 0 1 2\n"},
      {ply, binary.str()},
      {stl,
       "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid"}};
  for (const auto& [format, content] : good) {
    ASSERT_EQ(refusal(content, format), "read");
    for (std::size_t i = 0; i < content.size(); ++i) {
      (void)refusal(content.substr(0, i), format);  // any exception but FormatError ends the test
      for (const char c : {'\0', '\xff', '-', '9', '\n', ' '}) {
        std::string changed = content;
        changed[i] = c;
        (void)refusal(changed, format);
      }
    }
  }
  // A cut binary file is never read.
  for (std::size_t i = 0; i < binary.str().size(); ++i) EXPECT_NE(refusal(binary.str().substr(0, i), ply), "read") << i;
  for (std::size_t i = 0; i < binary_stl(2, 2).size(); ++i)
    EXPECT_NE(refusal(binary_stl(2, 2).substr(0, i), stl), "read");
}

TEST(MeshHostile, UnreadablePathsAreRefused) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "folder.obj");
  const auto error = [&](std::string_view name) -> std::string {
    try {
      (void)read_mesh(folder / name);
    } catch (const FormatError&) {
      return "format";
    } catch (const FileError& e) {
      return e.what();
    }
    return "read";
  };
  EXPECT_NE(error("folder.obj").find("Is a directory"), std::string::npos);
  EXPECT_NE(error("missing.ply").find("No such file or directory"), std::string::npos);
  EXPECT_NE(error("missing.ply").find("missing.ply'"), std::string::npos);
  EXPECT_NE(error("mesh.gltf").find("must end in .obj, .off, .stl"), std::string::npos);
}

TEST(MeshHostile, LongLinesAndManyErrorsCostNoMoreThanTheirLength) {
  const auto start = std::chrono::steady_clock::now();
  std::string text = triangle + "f";
  for (int i = 0; i < 1000000; ++i) text += " 1";
  EXPECT_EQ(refusal(text, obj), "read");  // a polygon whose corners coincide, cut as a fan
  std::string blanks = triangle;
  for (int i = 0; i < 1000000; ++i) blanks += "\\\n ";
  EXPECT_EQ(refusal(blanks, obj), "read");
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 20.0);
}

}  // namespace
}  // namespace blum
