// Proves that .vtp, .ply and .npz files give back any complex and its columns exactly, with names, types and order. The
// .obj format refuses content that it would lose. Files of other programs are read with wider types. Files cannot
// request much more memory than their length.
#include "blum/io/complex_io.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "blum/io/file_content.hpp"
#include "support/image_bytes.hpp"
#include "support/zip_bytes.hpp"
#include "unit/io/medial_text.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

using namespace test;

Complex two_triangles() {
  Complex complex;
  complex.positions = {{0.1, 1.0 / 3.0, -1e-7}, {1, 0, 0}, {0, 1, -0.0}, {1, 1, 0}, {5, 5, 5}, {1e300, 0, 0}};
  complex.edges = {{1, 0}, {2, 3}, {3, 4}};
  complex.triangles = {{0, 1, 2}, {3, 2, 1}};
  complex.vertex_columns = Columns(6);
  complex.edge_columns = Columns(3);
  complex.triangle_columns = Columns(2);
  return complex;
}

/// A column of different numbers, long in decimal and binary. Floating-point columns include infinity and NaN.
template <ColumnNumber T>
void add(Columns& columns, const std::string& name, std::size_t components = 1) {
  const std::span<T> values = columns.add<T>(name, components);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if constexpr (std::is_floating_point_v<T>) {
      values[i] = static_cast<T>(std::sin(1.0 + static_cast<double>(i)) * 1e20);
    } else {
      values[i] = static_cast<T>(std::numeric_limits<T>::max() / static_cast<T>(i + 1) * (i % 2 == 0 ? 1 : -1));
    }
  }
  if constexpr (std::is_floating_point_v<T>) {
    if (!values.empty()) values[0] = std::numeric_limits<T>::infinity();
    if (values.size() > 1) values[1] = std::numeric_limits<T>::quiet_NaN();
  }
}

/// Columns of every type and of several component counts, with names that formats use for other purposes.
Complex with_columns() {
  Complex complex = two_triangles();
  for (Columns* columns : {&complex.vertex_columns, &complex.edge_columns, &complex.triangle_columns}) {
    add<double>(*columns, "radius");
    add<std::int32_t>(*columns, "x");
    add<float>(*columns, "quality");
    add<double>(*columns, "v", 3);
    add<double>(*columns, "p_x");  // three columns, not one
    add<double>(*columns, "p_y");
    add<double>(*columns, "p_z");
    add<std::int32_t>(*columns, "v_x");  // the name of the first component of v
    add<std::int64_t>(*columns, "n", 2);
    add<float>(*columns, "n_0");
    add<float>(*columns, "many", 11);
    add<std::int64_t>(*columns, "vertices");
    add<std::int64_t>(*columns, "edges");
    add<float>(*columns, "metadata");
    add<float>(*columns, "distance");
    add<float>(*columns, "vertex_a");
    add<float>(*columns, "edge_a");
    add<float>(*columns, "triangle_a");
    add<std::int32_t>(*columns, "my_vertices");
    add<std::int32_t>(*columns, "nested_a");
    add<std::int32_t>(*columns, "vertex_indices");
    add<std::int32_t>(*columns, "vertex1");
    add<std::int32_t>(*columns, "Points");
    add<std::int32_t>(*columns, "-.9");
  }
  // The same name has different types.
  add<float>(complex.edge_columns, "both");
  add<double>(complex.triangle_columns, "both");
  add<float>(complex.triangle_columns, "triangle_both");
  add<float>(complex.edge_columns, "size", 2);
  add<float>(complex.triangle_columns, "size", 3);
  return complex;
}

bool is_same(const Column& a, const Column& b) {
  if (a.name != b.name || a.components != b.components || a.values.index() != b.values.index()) return false;
  return std::visit(
      [&]<class T>(const std::vector<T>& values) {
        const auto& others = std::get<std::vector<T>>(b.values);
        if (values.size() != others.size()) return false;
        // data() of an empty vector may be null, which memcmp refuses.
        return values.empty() || std::memcmp(values.data(), others.data(), sizeof(T) * values.size()) == 0;
      },
      a.values);
}

void expect_same(const Columns& a, const Columns& b, const char* what) {
  EXPECT_EQ(a.rows(), b.rows()) << what;
  ASSERT_EQ(a.size(), b.size()) << what;
  auto other = b.begin();
  for (const Column& column : a) {
    EXPECT_TRUE(is_same(column, *other)) << what << " " << column.name << " " << other->name;
    ++other;
  }
}

void expect_same(const Complex& a, const Complex& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.edges, b.edges);
  EXPECT_EQ(a.triangles, b.triangles);
  expect_same(a.vertex_columns, b.vertex_columns, "vertices");
  expect_same(a.edge_columns, b.edge_columns, "edges");
  expect_same(a.triangle_columns, b.triangle_columns, "triangles");
}

/// The first vertices of a complex without its edges and triangles. All columns remain, also those without rows.
Complex first_vertices(Complex complex, std::size_t vertices) {
  complex.positions.resize(vertices);
  complex.edges.clear();
  complex.triangles.clear();
  complex.vertex_columns.resize(vertices);
  complex.edge_columns.resize(0);
  complex.triangle_columns.resize(0);
  return complex;
}

const FileMetadata sample_pairs{{"b", "1"}, {"a", "\"caf\xC3\xA9\" \\ <&>\n"}, {"empty", ""}};

class ComplexFiles : public testing::TestWithParam<const char*> {
 protected:
  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / (std::string("out") + GetParam());
};
INSTANTIATE_TEST_SUITE_P(Formats, ComplexFiles, testing::Values(".vtp", ".ply", ".npz"),
                         [](const auto& info) { return std::string(info.param + 1); });

TEST_P(ComplexFiles, ReadBackAsWritten) {
  for (const Complex& complex : {two_triangles(), with_columns(), first_vertices(with_columns(), 4),
                                 first_vertices(with_columns(), 0), Complex{}}) {
    write_complex(path, complex, sample_pairs);
    const ComplexFile file = read_complex(path);
    expect_same(file.complex, complex);
    EXPECT_EQ(file.metadata, sample_pairs);
    EXPECT_TRUE(file.further.empty());
  }
  write_complex(path, two_triangles());
  EXPECT_TRUE(read_complex(path).metadata.empty());
}

TEST_P(ComplexFiles, KeepAQualityBesideAnEqualRadius) {
  Complex complex = two_triangles();
  complex.vertex_columns.add<float>("quality", 1, 0.5F);
  complex.vertex_columns.add<double>("radius", 1, 0.5);
  write_complex(path, complex);
  expect_same(read_complex(path).complex, complex);
  complex.vertex_columns.erase("quality");
  write_complex(path, complex);
  expect_same(read_complex(path).complex, complex);
}

TEST_P(ComplexFiles, RefuseUnwritableContent) {
  const auto refuses = [&](const Complex& complex, const FileMetadata& metadata = {}) {
    EXPECT_THROW(write_complex(path, complex, metadata), InvalidOption);
  };
  for (const char* name : {"two words", "a\"b", "a<b", "caf\xC3\xA9", "a/b", "a\n"}) {
    Complex complex = two_triangles();
    complex.edge_columns.add<float>(name);
    refuses(complex);
  }
  Complex wide = two_triangles();
  wide.vertex_columns.add<float>("wide", max_file_columns + 1);
  refuses(wide);
  Complex many = two_triangles();
  for (std::size_t i = 0; i <= max_file_columns; ++i) many.edge_columns.add<float>("c" + std::to_string(i));
  refuses(many);
  refuses(two_triangles(), {{"", "text"}});
  refuses(two_triangles(), {{"key", "1"}, {"key", "2"}});
  Complex broken = two_triangles();
  broken.edges[0][1] = 6;
  EXPECT_THROW(write_complex(path, broken), InvalidMesh);
  EXPECT_EQ(folder.entries(), 0);
}

TEST_P(ComplexFiles, HoldTheMaximumOfColumnsAndComponents) {
  Complex complex = two_triangles();
  add<float>(complex.vertex_columns, "wide", max_file_columns);
  for (std::size_t i = 0; i < max_file_columns; ++i) complex.edge_columns.add<float>("c" + std::to_string(i));
  write_complex(path, complex);
  expect_same(read_complex(path).complex, complex);
}

TEST_P(ComplexFiles, HoldTheMaximumOfColumnsOfEachKind) {
  Complex complex = two_triangles();
  add<double>(complex.vertex_columns, "radius");  // which .ply files hold twice if there is room
  const std::string longest(max_file_name - 4, 'n');
  for (std::size_t i = 1; i < max_file_columns; ++i) {
    complex.vertex_columns.add<float>("v" + std::to_string(i));
    complex.edge_columns.add<float>("e" + std::to_string(i));
    complex.triangle_columns.add<float>(longest + std::to_string(i));
  }
  write_complex(path, complex);
  expect_same(read_complex(path).complex, complex);
  complex.edge_columns = Columns(complex.edges.size());
  complex.edge_columns.add<float>(std::string(max_file_name + 1, 'n'));
  EXPECT_THROW(write_complex(path, complex), InvalidOption);
}

TEST(ComplexPly, RefusesRowsThatAreTooLong) {
  const TemporaryFolder folder;
  Complex complex = two_triangles();
  for (int i = 0; i < 100; ++i) complex.edge_columns.add<float>("wide" + std::to_string(i), max_file_columns);
  EXPECT_THROW(write_complex(folder / "a.ply", complex), InvalidOption);
  EXPECT_EQ(folder.entries(), 0);
}

/// Names that files cannot hold are accepted if the columns are lost anyway.
TEST(ComplexObj, LosesColumnsOfAnyName) {
  const TemporaryFolder folder;
  Complex complex = two_triangles();
  complex.vertex_columns.add<double>("radius");
  complex.vertex_columns.add<double>("two words");
  ComplexWriteOptions options;
  options.allow_loss = true;
  for (const char* name : {"a.obj", "a.ma"}) EXPECT_NO_THROW(write_complex(folder / name, complex, {}, options));
}

/// The directory is long, and some names end like those of fields.
TEST(ComplexNpz, ContentIsKnownByTheNamesOfArrays) {
  const TemporaryFolder folder;
  const auto path = folder / "out.npz";
  for (const char* name : {"distance", "mydistance", "heat"}) {
    Complex complex = two_triangles();
    complex.vertex_columns.add<float>(name);
    complex.edge_columns.add<float>("distance");
    for (std::size_t i = 0; i < 500; ++i) complex.edge_columns.add<float>("column" + std::to_string(i));
    write_complex(path, complex);
    EXPECT_EQ(content_of(path), FileContent::complex) << name;
    EXPECT_TRUE(holds_complex(path));
  }
}

TEST(ComplexObj, HoldsPositionsAndCellsOnly) {
  const TemporaryFolder folder;
  const auto path = folder / "out.obj";
  const Complex plain = two_triangles();
  write_complex(path, plain);
  const Complex read = read_complex(path).complex;
  EXPECT_EQ(read.positions, plain.positions);
  EXPECT_EQ(read.edges, plain.edges);
  EXPECT_EQ(read.triangles, plain.triangles);

  Complex complex = plain;
  complex.vertex_columns.add<float>("heat");
  complex.triangle_columns.add<float>("part");
  try {
    write_complex(path, complex, sample_pairs);
    FAIL();
  } catch (const InvalidOption& error) {
    for (const char* lost : {"vertices (heat)", "triangles (part)", "metadata"}) {
      EXPECT_NE(std::string(error.what()).find(lost), std::string::npos) << error.what();
    }
  }
  write_complex(path, complex, sample_pairs, {.allow_loss = true});
  EXPECT_EQ(read_complex(path).complex.triangles, plain.triangles);
}

TEST(ComplexNpz, HoldsFurtherComplexes) {
  const TemporaryFolder folder;
  const Complex first = with_columns();
  const Complex second = first_vertices(with_columns(), 3);
  const Complex third = two_triangles();
  ComplexWriteOptions options{.further = {{"nested", &second}, {"my", &third}}};
  write_complex(folder / "a.npz", first, sample_pairs, options);
  const ComplexFile file = read_complex(folder / "a.npz");
  expect_same(file.complex, first);
  ASSERT_EQ(file.further.size(), 2U);
  EXPECT_EQ(file.further[0].name, "nested");
  expect_same(file.further[0].complex, second);
  EXPECT_EQ(file.further[1].name, "my");
  expect_same(file.further[1].complex, third);

  for (const char* name : {"a.vtp", "a.ply", "a.obj"}) {
    EXPECT_THROW(write_complex(folder / name, third, {}, options), InvalidOption) << name;
  }
  for (const char* name : {"", "a_b", "vertex", "edge", "triangle", "my"}) {
    options.further[0].name = name;
    EXPECT_THROW(write_complex(folder / "b.npz", third, {}, options), InvalidOption) << name;
  }
}

/// The numbers of an array of a .vtp file.
template <class T>
std::vector<T> array_of(const std::string& bytes, const std::string& section, const std::string& name) {
  const std::size_t tag = bytes.find("Name=\"" + name + "\"", bytes.find("<" + section));
  const std::size_t offset = bytes.find("offset=\"", tag) + 8;
  const std::size_t start = bytes.find('_', bytes.find("encoding=\"raw\"")) + 1 + std::stoul(bytes.substr(offset));
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data() + start, sizeof(length));
  std::vector<T> out(length / sizeof(T));
  std::memcpy(out.data(), bytes.data() + start + sizeof(length), length);
  return out;
}

TEST(ComplexVtp, FillsCellsWithoutTheColumn) {
  const TemporaryFolder folder;
  Complex complex = two_triangles();  // vertex 5 belongs to no cell
  complex.vertex_columns.add<std::int32_t>("role", 1, 7);
  complex.edge_columns.add<std::int32_t>("role", 1, 8);
  complex.triangle_columns.add<std::int32_t>("sheet", 1, 9);
  complex.triangle_columns.add<float>("angle", 1, 1.5F);
  write_complex(folder / "a.vtp", complex);
  const std::string bytes = file_content(folder / "a.vtp");
  EXPECT_EQ(array_of<std::int32_t>(bytes, "CellData", "role"), (std::vector<std::int32_t>{7, 8, 8, 8, -1, -1}));
  EXPECT_EQ(array_of<std::int32_t>(bytes, "CellData", "sheet"), (std::vector<std::int32_t>{-1, -1, -1, -1, 9, 9}));
  const auto angle = array_of<float>(bytes, "CellData", "angle");
  ASSERT_EQ(angle.size(), 6U);
  EXPECT_TRUE(std::isnan(angle[0]) && std::isnan(angle[3]) && angle[4] == 1.5F);
  expect_same(read_complex(folder / "a.vtp").complex, complex);
  // Without the strings that assign columns to cells, all arrays are columns of edges and of triangles.
  std::string foreign = bytes;
  for (const char* name : {"\"edge_columns\"", "\"triangle_columns\""}) foreign = replaced(foreign, name, "\"what\"");
  const Complex read = read_complex(std::as_bytes(std::span(foreign)), ComplexFormat("VTP")).complex;
  EXPECT_EQ(read.edge_columns.size(), 3U);
  EXPECT_EQ(read.triangle_columns.get<std::int32_t>("role")[1], -1);
}

ComplexFile parse(const std::string& content, ComplexFormat format) {
  return read_complex(std::as_bytes(std::span(content)), format, "test");
}
std::string refusal(const std::string& content, ComplexFormat format) {
  try {
    (void)parse(content, format);
  } catch (const FormatError& error) {
    return error.what();
  }
  return "read";
}

TEST(ComplexOthers, PlyOfOtherPrograms) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar "
      "red\nproperty uint id\nproperty list uchar int around\nproperty float n_x\nproperty float n_y\nproperty float "
      "n_z\nelement face 2\nproperty short part\nproperty list uchar uint vertex_indices\nend_header\n"
      "0 0 0 255 4294967295 2 1 2 1 2 3\n1 0 0 1 0 0 nan 0 0\n1 1 0 1 0 0 inf 0 0\n0 1 0 1 0 0 0 0 0\n"
      "-7 4 0 1 2 3\n8 3 0 1 2\n";
  const Complex complex = parse(text, ComplexFormat("PLY")).complex;
  EXPECT_EQ(complex.vertex_columns.get<std::int32_t>("red")[0], 255);
  EXPECT_EQ(complex.vertex_columns.get<std::int64_t>("id")[0], 4294967295);
  EXPECT_EQ(complex.vertex_columns.get<float>("n", 3)[2], 3.0F);
  EXPECT_TRUE(std::isnan(complex.vertex_columns.get<float>("n", 3)[3]));
  EXPECT_EQ(complex.vertex_columns.size(), 3U);  // the list is skipped
  const auto part = complex.triangle_columns.get<std::int32_t>("part");
  EXPECT_EQ(std::vector(part.begin(), part.end()), (std::vector<std::int32_t>{-7, -7, 8}));
  // Comments that match no property are ignored.
  for (const char* comment :
       {"vertex red 2 pair", "vertex red 0 none", "vertex nothing 1 a", "vertex red x a", "face"}) {
    const std::string told = replaced(text, "1.0\n", "1.0\ncomment blum_column " + std::string(comment) + "\n");
    EXPECT_EQ(parse(told, ComplexFormat("PLY")).complex.vertex_columns.size(), 3U) << comment;
  }
  EXPECT_NE(refusal(replaced(text, "uchar red", "int64 n_x"), ComplexFormat("PLY")).find("occurs twice"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(text, "1.0\n", "1.0\ncomment blum_column vertex red 1 id\n"), ComplexFormat("PLY"))
                .find("a column 'id' exists already"),
            std::string::npos);
}

TEST(ComplexHostile, PolygonsOfManyAttributes) {
  constexpr std::size_t corners = 3000;
  constexpr std::size_t attributes = 900;
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list ushort int vertex_indices\n";
  for (std::size_t i = 0; i < attributes; ++i) text += "property int a" + std::to_string(i) + "\n";
  text += "end_header\n0 0 0\n1 0 0\n0 1 0\n" + std::to_string(corners);
  for (std::size_t i = 0; i < corners; ++i) text += " " + std::to_string(i % 3);
  for (std::size_t i = 0; i < attributes; ++i) text += " 1";
  EXPECT_NE(refusal(text + "\n", ComplexFormat("PLY")).find("save single edges and triangles"), std::string::npos);
}

TEST(ComplexHostile, OverlappingVtpArrays) {
  const TemporaryFolder folder;
  Complex complex = two_triangles();
  add<double>(complex.vertex_columns, "a", 100);
  complex.edge_columns.add<double>("b");
  complex.edge_columns.add<double>("c");
  write_complex(folder / "a.vtp", complex);
  const std::string good = file_content(folder / "a.vtp");
  const std::string tag =
      "<DataArray type=\"Float64\" Name=\"a\" NumberOfComponents=\"100\" format=\"appended\" offset=\"0\"/>";
  std::string more = tag;
  for (int i = 0; i < 3; ++i) more += replaced(tag, "\"a\"", "\"a" + std::to_string(i) + "\"");
  EXPECT_NE(refusal(replaced(good, tag, more), ComplexFormat("VTP")).find("more bytes than the file has"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(good, "=\"100\"", "=\"1001\""), ComplexFormat("VTP")).find("1001 components; 1 to 1000"),
            std::string::npos);
  EXPECT_NE(refusal(replaced(good, "=\"100\"", "=\"0\""), ComplexFormat("VTP")).find("0 components"),
            std::string::npos);
  // VTK's strings are lists of bytes. The second column becomes array "b", then "a"; the first one is "b".
  EXPECT_NE(
      refusal(replaced(good, "99 34 125", "98 34 125"), ComplexFormat("VTP")).find("two columns are the array 'b'"),
      std::string::npos);
  EXPECT_NE(refusal(replaced(good, "99 34 125", "97 34 125"), ComplexFormat("VTP")).find("'CellData/a' is missing"),
            std::string::npos);
}

TEST(ComplexHostile, NpzColumnsOfWrongShapes) {
  const auto order = std::endian::little;
  const auto with = [&](const std::string& name, const std::string& shape, std::size_t numbers) {
    return zip_bytes({{"vertices.npy", npy_bytes("<f8", "(1, 3)", false, bytes_of<double>({1, 2, 3}, order))},
                      {name + ".npy", npy_bytes("<f8", shape, false, bytes_of(std::vector<double>(numbers), order))}});
  };
  EXPECT_EQ(refusal(with("a", "(1, 2, 3)", 6), ComplexFormat("NPZ")), "read");
  EXPECT_NE(refusal(with("a", "(2,)", 2), ComplexFormat("NPZ")).find("its shape is [2], but should be [1]"),
            std::string::npos);
  EXPECT_NE(refusal(with("a", "()", 1), ComplexFormat("NPZ")).find("its shape is []"), std::string::npos);
  EXPECT_NE(refusal(with("a", "(1, 0)", 0), ComplexFormat("NPZ")).find("1 to 1000 numbers a row"), std::string::npos);
  EXPECT_NE(refusal(with("a", "(1, 40, 40)", 1600), ComplexFormat("NPZ")).find("1 to 1000"), std::string::npos);
  EXPECT_NE(refusal(with("edge_a", "(1,)", 1), ComplexFormat("NPZ")).find("should be [0]"), std::string::npos);
  EXPECT_NE(refusal(with("edge_a", "(0, 18446744073709551615, 2)", 0), ComplexFormat("NPZ")).find("1 to 1000"),
            std::string::npos);
  EXPECT_NE(refusal(with("vertex_", "(1,)", 1), ComplexFormat("NPZ")).find("needs a name"), std::string::npos);
  EXPECT_EQ(refusal(with("caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80", "(1,)", 1), ComplexFormat("NPZ")), "read");
  using namespace std::string_literals;
  for (const std::string& name : {"a\0b"s, "\xFF"s, "caf\xE9"s, "\xC0\x80"s, "\xED\xA0\x80"s, "\xC3"s}) {
    EXPECT_NE(refusal(with(name, "(1,)", 1), ComplexFormat("NPZ")).find("is not UTF-8"), std::string::npos) << name;
  }
  EXPECT_NE(refusal(with("distance", "(1,)", 1), ComplexFormat("NPZ")).find("not a complex"), std::string::npos);
}

}  // namespace
}  // namespace blum
