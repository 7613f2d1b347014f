// Proves that files without a valid medial axis are refused for the right reason, at the right place. Readers compare
// the promises of a header with the file before they take memory.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "support/image_bytes.hpp"
#include "support/medial_sample.hpp"
#include "support/zip_bytes.hpp"
#include "unit/io/medial_text.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

using namespace test;

const ComplexFormat vtp = ComplexFormat("VTP");
const ComplexFormat ply = ComplexFormat("PLY");
const ComplexFormat obj = ComplexFormat("OBJ");
const ComplexFormat ma = ComplexFormat("MA");
const ComplexFormat npz = ComplexFormat("NPZ");

/// Content, and parts of the message with which it must be refused.
struct Hostile {
  std::string content, error, place;
};

void expect_refused(const std::vector<Hostile>& table, ComplexFormat format) {
  for (const Hostile& file : table) {
    const std::string message = medial_refusal(file.content, format);
    EXPECT_NE(message.find(file.error), std::string::npos) << message << "\nshould say: " << file.error;
    EXPECT_NE(message.find(file.place), std::string::npos) << message << "\nshould name: " << file.place;
    EXPECT_TRUE(message == "read" || message.starts_with("test.axis") || message.starts_with("'test.axis', "))
        << message;
  }
}

std::string sample_bytes(const char* name) {
  const TemporaryFolder folder;
  write_medial(folder / name, sample_complex(), sample_metadata());
  return file_content(folder / name);
}

TEST(MedialHostile, Ma) {
  const std::string four = "4 1 1\nv 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nv 0 0 1 1\n";
  expect_refused({{"", "must begin with the numbers of vertices", "line 1:"},
                  {"1 0\nv 0 0 0 1\n", "number of triangles is missing", "line 1:"},
                  {"four 1 1\n", "number of vertices is not a whole number", "line 1:"},
                  {"-1 1 1\n", "negative number of vertices", "line 1:"},
                  {"1000000000000 0 0\nv 0 0 0 1\n", "promises 1000000000000", "line 1:"},
                  {"1 1000000000000 0\nv 0 0 0 1\n", "as number of edges, but is too short", "line 1:"},
                  {"9223372036854775807 9223372036854775807 9223372036854775807\n", "too short", "line 1:"},
                  {"1 0 99\nv 0 0 0 1\n", "as number of triangles", "line 1:"},
                  {four + "e 0 4\nf 0 1 2\n", "vertex index 4 is out of range: there are 4", "line 6:"},
                  {four + "e 0 -1\nf 0 1 2\n", "vertex index -1 is out of range", "line 6:"},
                  {four + "e 0 0\nf 0 1 2\n", "vertex 0 is used twice", "line 6:"},
                  {four + "e 0 1\nf 0 1 1\n", "vertex 1 is used twice", "line 7:"},
                  {four + "e 0 1\nf 0 1\n", "vertex index is missing", "line 7:"},
                  {four + "e 0 1\n# no triangle\n", "promises 1 triangles, but has 0", "line 8:"},
                  {four + "e 0 1\ne 1 2\nf 0 1 2\n", "promises 1 edges, but has 2", "line 9:"},
                  {four + "f 0 1 2\nq 0 1\n", "not with 'q'", "line 7:"},
                  {"1 0 0\nv 0 nan 0 1\n", "y coordinate is not finite", "line 2:"},
                  {"1 0 0\nv 0 0 0 inf\n", "radius is not finite", "line 2:"},
                  {"1 0 0\nv 0 0 0 -1\n", "negative radius", "line 2:"},
                  {"1 0 0\nv 0 0 0     \n", "radius is missing", "line 2:"}},
                 ma);
}

TEST(MedialHostile, Obj) {
  expect_refused({{"", "ends without a vertex", "line 1:"},
                  {"# a comment\n", "ends without a vertex", "line 2:"},
                  {"v 0 0 0\nl 1 2\n", "vertex 2 is used, but the file has only 1", "line 2:"},
                  {"v 0 0 0\nv 0 0 1\nl 1 1\n", "edge 0 uses vertex 0 twice", ""},
                  {"v 0 0 0\nv 0 0 1\nf 1 2 1\n", "triangle 0 uses vertex 0 twice", ""},
                  {"v 0 0 inf\n", "not finite", "line 1:"}},
                 obj);
}

const std::string ply_head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n";
const std::string ply_xyz = ply_head + "property float z\n";
const std::string ply_three = "end_header\n0 0 0\n1 0 0\n0 1 0\n";

std::string ply_edges(const std::string& properties, const std::string& line) {
  return ply_xyz + "element edge 1\nproperty int vertex1\n" + properties + ply_three + line;
}
std::string ply_with(const std::string& property, const std::string& vertex) {
  return "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n" + property +
         "end_header\n" + vertex;
}

TEST(MedialHostile, Ply) {
  const std::string two = "property int vertex2\n";
  expect_refused(
      {{"", "must begin with the word 'ply'", "line 1:"},
       {"ply\nformat ascii 1.0\nend_header\n", "no element 'vertex'", "line 4:"},
       {"ply\nformat ascii 1.0\nelement vertex 1000000000\nend_header\n", "no element 'vertex'", "line 5:"},
       {ply_head + ply_three, "no property 'z'", "line 7:"},
       {ply_with("property float x\n", "0 0 0 0\n"), "property 'x' of element 'vertex' occurs twice", "line 9:"},
       {ply_edges("", "0\n"), "no property 'vertex2'", "line 12:"},
       {ply_edges("property float vertex2\n", "0 1\n"), "must be of a whole-number type", "line 13:"},
       {ply_edges("property list uchar int vertex2\n", "0 1 1\n"), "must not be a list", "line 13:"},
       {ply_edges(two, "0 3\n"), "vertex 3 is used, but the file has only 3", "line 14:"},
       {ply_edges(two, "0 -1\n"), "vertex index -1", "line 14:"},
       {ply_edges(two, "0 0\n"), "edge 0 uses vertex 0 twice", "test.axis:"},
       {ply_edges(two + "property uchar role\n", "0 1 5\n"), "row 0 is 5, but must be 0 to 4",
        "column 'role' of edges"},
       {ply_edges(two + "property double separation_angle\n", "0 1 1e300\n"), "an angle that is not finite", ""},
       {ply_with("property double radius\n", "0 0 0 -1\n"), "has a radius that is negative", "vertex 0"},
       {ply_with("property double radius\n", "0 0 0 nan\n"), "has a radius that is negative or not finite", "vertex 0"},
       {ply_with("property int site_0\n", "0 0 0 -2\n"), "row 0 is -2, but must be -1 to",
        "column 'site_0' of vertices"},
       {ply_with("property uint site_0\n", "0 0 0 4294967295\n"), "row 0 is 4294967295, but", "column 'site_0'"},
       {ply_with("property int site_0\n", "0 0 0     \n"), "site_0 is missing", "line 10:"},
       {ply_xyz + "element face 1\nproperty list uchar int vertex_indices\nproperty int sheet\n" + ply_three +
            "3 0 1 2 1\n",
        "there are 2 sheets, but only 1 triangles", ""},
       {ply_xyz + "element face 1\nproperty list uchar int vertex_indices\nproperty int sheet\n" + ply_three +
            "3 0 1 2 -1\n",
        "row 0 is -1, but must be 0 to", "column 'sheet' of triangles"},
       {ply_xyz + "element face 1\nproperty list uchar int vertex_indices\n" + ply_three + "2 0 1\n",
        "a face of 2 corners", "line 13:"},
       {ply_xyz + "element face 1000000000000\nproperty list uchar int vertex_indices\n" + ply_three,
        "promises 1000000000000 of element 'face'", "line 12:"},
       {replaced(ply_with("", "0 0 0\n"), "vertex 1", "vertex 1000000000000"), "promises 1000000000000", "line 8:"},
       {replaced(ply_with("", "0 0 0\n"), "1.0\n", "1.0\ncomment blum {\"theta\": 3}\n"), "not a JSON object", ""},
       {replaced(ply_with("", "0 0 0\n"), "1.0\n", "1.0\ncomment blum {\"theta\": \"x\"}\n"), "theta 'x'", ""},
       {replaced(ply_with("", "0 0 0\n"), "1.0\n", "1.0\ncomment blum {\"grid_origin\": \"0 0 0\"}\n"),
        "only some of the grid", ""},
       {replaced(ply_with("", "0 0 0\n"), "1.0\n", "1.0\ncomment blum {\"site_ids\": \"x\"}\n"), "not known", ""},
       {replaced(ply_with("", "0 0 0\n"), "1.0\n", "1.0\ncomment blum {\"weld\": \"-1\"}\n"), "weld '-1'", ""},
       {replaced(ply_with("", "0 0 0\n"), "1.0\n", "1.0\ncomment blum {\"smooth\": \"-1\"}\n"), "smooth '-1'", ""},
       {replaced(ply_with("", "0 0 0\n"), "1.0\n", "1.0\ncomment blum {\"label\": \"1.5\"}\n"), "label '1.5'", ""},
       {replaced(ply_with("", "0 0 0\n"), "1.0\n", "1.0\ncomment blum {\"label\": \"1\", \"threshold\": \"2\"}\n"),
        "a label and a threshold", ""},
       {replaced(ply_edges(two, "0 1\n"), "end_header", "element edge_attributes 2\nproperty uchar role\nend_header") +
            "1\n1\n",
        "2 of element 'edge_attributes', but 1 edges", ""}},
      ply);
  EXPECT_EQ(medial_refusal(ply_edges(two, "0 1\n"), ply), "read");
}

/// The tag of one array of the sample.
std::string tag(const char* type, const char* name, int components = 1) {
  return "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"appended\"";
}

/// The sample with another last value in an array.
template <class T>
std::string with_last(std::string bytes, const std::string& section, const std::string& name, T value) {
  const std::size_t tag = bytes.find("Name=\"" + name + "\"", bytes.find("<" + section));
  const std::size_t offset = bytes.find("offset=\"", tag) + 8;
  const std::size_t data = bytes.find('_', bytes.find("encoding=\"raw\"")) + 1;
  const std::size_t start = data + std::stoul(bytes.substr(offset));
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data() + start, sizeof(length));
  std::memcpy(bytes.data() + start + sizeof(length) + length - sizeof(T), &value, sizeof(T));
  return bytes;
}

TEST(MedialHostile, Vtp) {
  const std::string good = sample_bytes("a.vtp");
  ASSERT_EQ(medial_refusal(good, vtp), "read");
  const auto change = [&](const std::string& from, const std::string& to) { return replaced(good, from, to); };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused(
      {{"", "no appended data", ""},
       {"<VTKFile", "XML is damaged", "byte 1"},
       {"<VTKFile type='PolyData'><AppendedData encoding='raw'>_", "no piece of PolyData", ""},
       {change("\"PolyData\"", "\"ImageData\""), "another type than PolyData", ""},
       {change("byte_order=", "compressor='x' byte_order="), "compressed", ""},
       {change("<Piece", "<Piece></Piece><Piece"), "several pieces", ""},
       {change("NumberOfStrips=\"0\"", "NumberOfStrips=\"1\""), "strips", ""},
       {change("NumberOfPoints=\"8\"", "NumberOfPoints=\"9\""), "192 bytes, but the number of points needs 216", ""},
       {change("NumberOfPoints=\"8\"", "NumberOfPoints=\"2147483647\""), "the number of points needs", ""},
       {change("NumberOfPoints=\"8\"", "NumberOfPoints=\"2147483648\""), "2^31 - 1 are the most", ""},
       {change("NumberOfPoints=\"8\"", "NumberOfPoints=\"0\""), "64 bytes, but the number of points needs 0", ""},
       {change("NumberOfPoints=\"8\"", "NumberOfPoints=\"-8\""), "NumberOfPoints must be a number", ""},
       {change("NumberOfLines=\"9\"", "NumberOfLines=\"1000000000000\""), "the number of cells needs", ""},
       {change("NumberOfLines=\"9\"", "NumberOfLines=\"10000000000000\""), "at most 2^40", ""},
       {change("NumberOfVerts=\"1\"", "NumberOfVerts=\"2\""), "the number of cells needs", ""},
       {change("encoding=\"raw\"", "encoding=\"base64\""), "not raw", ""},
       {change("Name=\"Points\" NumberOfComponents=\"3\"", "Name=\"Points\" NumberOfComponents=\"1\""),
        "it has 1 components, not 3", "(Points/Points)"},
       {change(tag("Float64", "radius"), tag("Float64", "radius", 2)), "64 bytes, but the number of points needs 128",
        ""},
       {change(tag("Float64", "radius"), tag("Float16", "radius")), "unknown type 'Float16'", "'radius'"},
       {change(tag("Int32", "site_0"), tag("Float32", "site_0")), "must be whole numbers",
        "column 'site_0' of vertices"},
       {change(tag("Int32", "site_1"), tag("Int32", "site_0")), "occurs twice", "'PointData/site_0'"},
       {change("      <Points>\n", "      <Nothing>\n"), "array 'Points/Points' is missing", ""},
       {change("format=\"appended\"", "format=\"binary\""), "not appended", ""},
       {change("offset=\"0\"", "offset=\"18446744073709551615\""), "beyond the end", ""},
       {change("offset=\"0\"", "offset=\"x\""), "offset of 'radius' is not a number", ""},
       {good.substr(0, good.rfind("\n  </AppendedData>") - 1), "cut short", ""},
       {with_last(good, "Points", "Points", nan), "the position of vertex 7 is not finite", ""},
       {with_last(good, "PointData", "radius", -1.0), "vertex 7 (counted from 0) has a radius", ""},
       {with_last(good, "PointData", "footprint_1", nan), "vertex 7 (counted from 0) has a footprint", ""},
       {with_last(good, "PointData", "role", 255), "row 7 is 255, but must be 0 to 4", "column 'role' of vertices"},
       {with_last(good, "PointData", "site_1", -2), "row 7 is -2, but must be -1 to", "column 'site_1'"},
       {with_last(good, "CellData", "sheet", 3), "there are 4 sheets, but only 3", ""},
       {with_last(good, "CellData", "sheet", -1), "row 2 is -1, but must be 0 to", "column 'sheet' of triangles"},
       {with_last(good, "CellData", "separation_angle", std::numeric_limits<float>::infinity()),
        "triangle 2 (counted from 0) has an angle", ""},
       {with_last(good, "Verts", "connectivity", std::int64_t{8}), "vertex 8 is used", "(Verts/connectivity)"},
       {with_last(good, "Lines", "connectivity", std::int64_t{-1}), "vertex -1 is used", "(Lines/connectivity)"},
       {with_last(good, "Lines", "connectivity", std::int64_t{5}), "edge 8 uses vertex 5 twice", ""},
       {with_last(good, "Lines", "offsets", std::int64_t{15}), "the offsets do not rise", "(Lines/offsets)"},
       {with_last(good, "Lines", "offsets", std::int64_t{17}), "the last of the offsets needs", ""},
       {with_last(good, "Polys", "connectivity", std::int64_t{1} << 40), "there are only 8", "(Polys/connectivity)"},
       {with_last(good, "Polys", "offsets", std::int64_t{1} << 41), "the offsets do not rise", "(Polys/offsets)"},
       {with_last(good, "Polys", "offsets", std::int64_t{1} << 39), "the last of the offsets needs", ""}},
      vtp);
}

/// The arrays of a small axis. `changes` replaces, adds or, if empty, removes arrays.
std::string npz_with(const std::vector<std::pair<std::string, std::string>>& changes) {
  const auto order = std::endian::little;
  std::vector<std::pair<std::string, std::string>> arrays{
      {"vertices", npy_bytes("<f8", "(3, 3)", false, bytes_of<double>({0, 0, 0, 1, 0, 0, 0, 1, 0}, order))},
      {"edges", npy_bytes("<i4", "(1, 2)", false, bytes_of<std::int32_t>({0, 1}, order))},
      {"triangles", npy_bytes("<i8", "(1, 3)", false, bytes_of<std::int64_t>({0, 1, 2}, order))}};
  for (const auto& change : changes) {
    std::erase_if(arrays, [&](const auto& array) { return array.first == change.first; });
    if (!change.second.empty()) arrays.push_back(change);
  }
  std::vector<ZipPart> parts;
  for (const auto& [name, bytes] : arrays) parts.push_back({name + ".npy", bytes});
  return zip_bytes(parts);
}

std::string ints(const std::string& shape, const std::vector<std::int32_t>& values) {
  return npy_bytes("<i4", shape, false, bytes_of(values, std::endian::little));
}
std::string doubles(const std::string& shape, const std::vector<double>& values) {
  return npy_bytes("<f8", shape, false, bytes_of(values, std::endian::little));
}

TEST(MedialHostile, Npz) {
  ASSERT_EQ(medial_refusal(npz_with({}), npz), "read");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused(
      {{"", "not a zip archive", ""},
       {zip_bytes({}), "no array 'vertices'", ""},
       {npz_with({{"vertices", ""}}), "no array 'vertices'", ""},
       {npz_with({{"vertices", doubles("(9,)", std::vector<double>(9))}}), "its shape is [9], but should be [n, 3]",
        "(vertices.npy)"},
       {npz_with({{"vertices", doubles("(2, 3)", std::vector<double>(6))}}), "vertex 2 is used", "(triangles.npy)"},
       {npz_with({{"vertices", doubles("(3, 3)", {0, 0, 0, 0, 0, 0, 0, 0, nan})}}), "vertex 2", "test.axis:"},
       {npz_with({{"vertices", doubles("(100000000000, 3)", {0})}}), "cut short", "(vertices.npy)"},
       {npz_with({{"vertices", doubles("(3, 3)", {0})}}), "cut short", "(vertices.npy)"},
       {npz_with({{"radius", doubles("(2,)", {1, 1})}}), "its shape is [2], but should be [3]", "(radius.npy)"},
       {npz_with({{"radius", doubles("(3,)", {1, 1, -1})}}), "vertex 2 (counted from 0) has a radius", ""},
       {npz_with({{"role", ints("(3,)", {0, 4, 5})}}), "row 2 is 5, but must be 0 to 4", "column 'role' of vertices"},
       {npz_with({{"role", doubles("(3,)", {0, 1, 2})}}), "must be whole numbers", "column 'role' of vertices"},
       {npz_with({{"site_1", ints("(3,)", {0, 1, -2})}}), "row 2 is -2, but must be -1 to", "column 'site_1'"},
       {npz_with({{"footprint_0", doubles("(3, 2)", std::vector<double>(6))}}), "it has 2 components, not 3",
        "column 'footprint_0' of vertices"},
       {npz_with({{"edges", ints("(1, 2)", {0, 3})}}), "vertex 3 is used, but there are only 3", "(edges.npy)"},
       {npz_with({{"edges", ints("(1, 2)", {0, -1})}}), "vertex -1 is used", "(edges.npy)"},
       {npz_with({{"edges", ints("(1, 2)", {2, 2})}}), "edge 0 uses vertex 2 twice", ""},
       {npz_with({{"edges", doubles("(1, 2)", {0, 1})}}), "must be whole numbers", "(edges.npy)"},
       {npz_with({{"edge_role", ints("(1,)", {-1})}}), "row 0 is -1, but must be 0 to 4", "column 'role' of edges"},
       {npz_with({{"edge_separation_angle", doubles("(1,)", {nan})}, {"edge_role", ints("(1,)", {1})}}), "edge 0",
        "angle"},
       {npz_with({{"triangle_sheet", ints("(1,)", {1})}}), "there are 2 sheets, but only 1", ""},
       {npz_with({{"triangle_sheet", ints("(1,)", {-1})}}), "row 0 is -1, but must be 0 to",
        "column 'sheet' of triangles"},
       {npz_with({{"metadata", ints("(1,)", {-1})}}), "must be one string", "(metadata.npy)"}},
      npz);
}

}  // namespace
}  // namespace blum
