// Proves that medial axes read back from every format as exactly as the format allows, and that files have the promised
// cells and lines. Axes of other programs are read. A failed write leaves nothing behind.
#include "blum/io/medial_io.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "support/medial_rows.hpp"
#include "support/medial_sample.hpp"
#include "unit/io/medial_text.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

using namespace test;

void expect_same(const AxisRows& a, const AxisRows& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.edges, b.edges);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.sheet_count, b.sheet_count);
}

void expect_same(const MedialMetadata& a, const MedialMetadata& b) {
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.version, b.version);
  EXPECT_EQ(a.site_ids, b.site_ids);
  EXPECT_EQ(a.theta, b.theta);
  EXPECT_EQ(a.lambda, b.lambda);
  EXPECT_EQ(a.spacing, b.spacing);
  EXPECT_EQ(a.solid_rule, b.solid_rule);
  EXPECT_EQ(a.grid, b.grid);
  EXPECT_EQ(a.label, b.label);
  EXPECT_EQ(a.threshold, b.threshold);
  EXPECT_EQ(a.weld, b.weld);
  EXPECT_EQ(a.smooth, b.smooth);
}

/// The part that an .obj file keeps: positions, triangles and curves. A .ma file also keeps radii.
AxisRows without_attributes(const AxisRows& complex, bool radii) {
  AxisRows out;
  for (const VertexRow& v : complex.vertices) {
    out.vertices.emplace_back().position = v.position;
    if (radii) out.vertices.back().radius = v.radius;
  }
  for (const EdgeRow& e : complex.edges) {
    if (e.role == MedialRole::curve) out.edges.push_back({.vertices = e.vertices});
  }
  for (const TriangleRow& t : complex.triangles) out.triangles.push_back({.vertices = t.vertices});
  out.sheet_count = out.triangles.empty() ? 0 : 1;
  return out;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

class MedialFiles : public testing::TestWithParam<std::string> {
 protected:
  std::string extension = GetParam();
  ComplexFormat format = ComplexFormat(extension);
  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / ("out" + extension);
  [[nodiscard]] bool keeps_all() const { return extension != ".obj" && extension != ".ma"; }
  [[nodiscard]] AxisRows kept(const AxisRows& complex) const {
    return keeps_all() ? complex : without_attributes(complex, extension == ".ma");
  }
};
INSTANTIATE_TEST_SUITE_P(Formats, MedialFiles,
                         testing::ValuesIn(file_extensions(FileContent::complex, FileAccess::both)),
                         [](const auto& info) { return info.param.substr(1); });

TEST_P(MedialFiles, ReadBackAsWritten) {
  AxisRows complex = sample_complex();
  if (extension == ".ma") std::swap(complex.edges[7].vertices[0], complex.edges[7].vertices[1]);  // rising in .ma
  write_medial(path, complex, sample_metadata());
  const MedialFile file = read_medial(path);
  expect_same(file.complex, kept(complex));
  expect_same(file.metadata, keeps_all() ? sample_metadata() : MedialMetadata{});
  EXPECT_EQ(file.has_radii, extension != ".obj");
  EXPECT_EQ(file.has_footprints, keeps_all());
  EXPECT_EQ(file.has_angles, keeps_all());
  EXPECT_EQ(file.has_labels, keeps_all());
}

TEST_P(MedialFiles, WriteTheSameColumnsAgain) {
  write_medial(path, sample_complex(), sample_metadata());
  const MedialFile file = read_medial(path);
  write_medial(folder / "again.vtp", file.complex, sample_metadata());
  const MedialFile again = read_medial(folder / "again.vtp");
  EXPECT_EQ(again.complex.vertex_columns, file.complex.vertex_columns);
  EXPECT_EQ(again.complex.edge_columns, file.complex.edge_columns);
  EXPECT_EQ(again.complex.triangle_columns, file.complex.triangle_columns);
  EXPECT_EQ(again.has_radii, extension != ".obj");
  EXPECT_EQ(again.has_footprints || again.has_sites || again.has_angles || again.has_labels, keeps_all());
  EXPECT_EQ(again.metadata.version.empty(), !keeps_all()) << "verify() wants all columns in what Blum wrote";
  const auto to_ma = [&] { write_medial(folder / "again.ma", file.complex); };
  if (extension == ".obj") {
    EXPECT_THROW(to_ma(), InvalidOption);
  } else {
    EXPECT_NO_THROW(to_ma());
  }
}

/// The columns of levels in axes of all angles are ordinary columns in an axis of one angle.
TEST_P(MedialFiles, MayHaveColumnsNamedLikeLevels) {
  if (!keeps_all()) return;
  Complex axis = sample_complex();
  axis.vertex_columns.add<std::int32_t>("until", 1, 7);
  write_medial(path, axis);
  EXPECT_EQ(read_medial(path).complex.vertex_columns.get<std::int32_t>("until").front(), 7);
}

TEST_P(MedialFiles, EveryKindOfSiteAndNoMetadata) {
  MedialMetadata metadata;
  for (const SiteIds ids : {SiteIds::features, SiteIds::triangles, SiteIds::voxels}) {
    metadata.site_ids = ids;
    write_medial(path, sample_complex(), metadata);
    if (keeps_all()) expect_same(read_medial(path).metadata, metadata);
  }
}

TEST_P(MedialFiles, KeepAThreshold) {
  MedialMetadata metadata;
  metadata.threshold = -1.0 / 3.0;
  metadata.weld = 0;
  metadata.smooth = 60;
  write_medial(path, sample_complex(), metadata);
  expect_same(read_medial(path).metadata, keeps_all() ? metadata : MedialMetadata{});
}

TEST_P(MedialFiles, EmptyAndPartlyEmpty) {
  write_medial(path, AxisRows{}, sample_metadata());
  const MedialFile empty = read_medial(path);
  expect_same(empty.complex, AxisRows{});
  expect_same(empty.metadata, keeps_all() ? sample_metadata() : MedialMetadata{});

  AxisRows vertices = sample_complex();
  vertices.edges.clear();
  vertices.triangles.clear();
  vertices.sheet_count = 0;
  write_medial(path, vertices);
  expect_same(read_medial(path).complex, kept(vertices));

  AxisRows curves = sample_complex();
  curves.edges.erase(curves.edges.begin(), curves.edges.begin() + 8);
  curves.triangles.clear();
  curves.sheet_count = 0;
  write_medial(path, curves);
  expect_same(read_medial(path).complex, kept(curves));

  AxisRows sheets = sample_complex();
  sheets.edges.clear();
  write_medial(path, sheets);
  expect_same(read_medial(path).complex, kept(sheets));
}

TEST_P(MedialFiles, ExtremeNumbersKeepEveryBit) {
  AxisRows complex = sample_complex();
  complex.vertices[0].position = {std::numeric_limits<double>::max(), -std::numeric_limits<double>::denorm_min(), -0.0};
  complex.vertices[0].radius = std::nextafter(0.1, 1.0);
  write_medial(path, complex);
  const VertexRow v = AxisRows(read_medial(path).complex).vertices[0];
  EXPECT_EQ(v.position, complex.vertices[0].position);
  EXPECT_TRUE(std::signbit(v.position.z));
  EXPECT_EQ(v.radius, extension == ".obj" ? 0 : complex.vertices[0].radius);
}

/// A strip of triangles, longer than any buffer of the writers.
AxisRows long_strip(std::uint32_t count) {
  AxisRows complex;
  for (std::uint32_t i = 0; i < count + 2; ++i) {
    VertexRow v;
    v.position = {std::sqrt(i), static_cast<double>(i % 2), std::sin(i)};
    v.radius = std::numbers::sqrt2 * i;
    complex.vertices.push_back(v);
  }
  for (std::uint32_t i = 0; i < count; ++i) complex.triangles.push_back({{i, i + 1, i + 2}, 1.0F, 0});
  complex.edges.push_back({{0, 1}, 3.0F, MedialRole::rim});
  complex.sheet_count = 1;
  return complex;
}

TEST_P(MedialFiles, LargerThanAnyBuffer) {
  const AxisRows complex = long_strip(150000);
  write_medial(path, complex);
  expect_same(read_medial(path).complex, kept(complex));
}

TEST_P(MedialFiles, AreTheSameForAnyNumberOfThreads) {
  Context context;
  context.threads = 1;
  write_medial(path, long_strip(150000), {}, context);
  const std::string one = file_content(path);
  context.threads = 3;
  write_medial(path, long_strip(150000), {}, context);
  EXPECT_TRUE(file_content(path) == one);
}

TEST_P(MedialFiles, ReportProgress) {
  std::vector<double> fractions;
  Context context;
  context.progress = [&](double fraction, std::string_view) { fractions.push_back(fraction); };
  write_medial(path, long_strip(150000), {}, context);
  ASSERT_GE(fractions.size(), 3U);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST_P(MedialFiles, CancelledWriteLeavesTheOldFile) {
  write_medial(path, sample_complex());
  const std::string old = file_content(path);
  std::stop_source stop;
  Context context;
  context.cancel = stop.get_token();
  context.progress = [&](double fraction, std::string_view) {
    if (fraction > 0.3) stop.request_stop();
  };
  EXPECT_THROW(write_medial(path, long_strip(150000), {}, context), Cancelled);
  EXPECT_TRUE(file_content(path) == old);
  EXPECT_EQ(folder.entries(), 1);
}

TEST_P(MedialFiles, FailedWriteLeavesNothing) {
  EXPECT_THROW(write_medial(folder / "absent" / path.filename(), sample_complex()), FileError);
  std::vector<AxisRows> broken(8, sample_complex());
  broken[0].edges[0].vertices[1] = 8;
  broken[1].triangles[2].vertices[0] = 8;
  broken[2].vertices[1].position.y = std::numeric_limits<double>::quiet_NaN();
  broken[3].vertices[1].radius = -1;
  broken[4].triangles[0].sheet = 3;
  broken[5].edges[2].vertices[0] = 1;
  broken[6].edges[2].separation_angle = std::numeric_limits<float>::infinity();
  broken[7].vertices[3].sites[1] = SiteId(0x80000000U);
  for (const AxisRows& complex : broken) EXPECT_THROW(write_medial(path, complex), InvalidMesh);
  MedialMetadata metadata;
  metadata.theta = std::numeric_limits<double>::infinity();
  EXPECT_THROW(write_medial(path, sample_complex(), metadata), InvalidOption);
  metadata.theta.reset();
  metadata.weld = -1;
  EXPECT_THROW(write_medial(path, sample_complex(), metadata), InvalidOption);
  metadata.weld.reset();
  metadata.smooth = 1001;
  EXPECT_THROW(write_medial(path, sample_complex(), metadata), InvalidOption);
  metadata.smooth.reset();
  metadata.label = 1;
  metadata.threshold = 1;
  EXPECT_THROW(write_medial(path, sample_complex(), metadata), InvalidOption);
  metadata.label.reset();
  metadata.grid = GridSpec{};
  EXPECT_THROW(write_medial(path, sample_complex(), metadata), InvalidGrid);
  EXPECT_EQ(folder.entries(), 0);
  EXPECT_THROW((void)read_medial(path), FileError);
}

TEST_P(MedialFiles, CutAnywhereAreRefused) {
  write_medial(path, sample_complex(), sample_metadata());
  const std::string bytes = file_content(path);
  EXPECT_EQ(medial_refusal(bytes, format), "read");
  // The closing tags of a .vtp file hold no needed data. An .obj file does not state its length. The last number of a
  // .ma file may look whole after a cut.
  const std::size_t needed = extension == ".vtp"   ? bytes.rfind("\n  </AppendedData>")
                             : extension == ".ma"  ? bytes.rfind(' ') + 1
                             : extension == ".obj" ? 0
                                                   : bytes.size();
  for (std::size_t length = 0; length < needed; ++length) {
    EXPECT_NE(medial_refusal(bytes.substr(0, length), format), "read") << length;
  }
}

TEST_P(MedialFiles, DamagedAnywhereNeverCrash) {
  write_medial(path, sample_complex(), sample_metadata());
  const std::string bytes = file_content(path);
  std::size_t refused = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const char c : {'\0', '9', '-', '\xff'}) {
      std::string changed = bytes;
      changed[at] = c;
      refused += medial_refusal(changed, format) == "read" ? 0 : 1;
    }
  }
  EXPECT_GT(refused, 100U);
}

TEST(MedialObj, HasLinesForCurvesAndPointsForTheRest) {
  const TemporaryFolder folder;
  write_medial(folder / "a.obj", sample_complex());
  const std::vector<std::string> lines = lines_of(file_content(folder / "a.obj"));
  ASSERT_EQ(lines.size(), 8U + 3 + 2 + 1);
  EXPECT_EQ(lines[0], "v 0.1 0.3333333333333333 -1e-07");
  EXPECT_EQ(std::vector<std::string>(lines.begin() + 8, lines.end()),
            (std::vector<std::string>{"f 1 3 2", "f 4 1 2", "f 2 1 5", "l 6 2", "l 6 7", "p 8"}));
}

TEST(MedialMa, HasAllEdgesOnce) {
  const TemporaryFolder folder;
  write_medial(folder / "a.ma", sample_complex());
  const std::vector<std::string> lines = lines_of(file_content(folder / "a.ma"));
  ASSERT_EQ(lines.size(), 1U + 8 + 9 + 3);
  EXPECT_EQ(lines[0], "8 9 3");
  EXPECT_EQ(lines[1], "v 0.1 0.3333333333333333 -1e-07 0.3333333333333333");
  EXPECT_EQ(std::vector<std::string>(lines.begin() + 9, lines.end()),
            (std::vector<std::string>{"e 0 1", "e 0 2", "e 0 3", "e 0 4", "e 1 2", "e 1 3", "e 1 4", "e 1 5", "e 5 6",
                                      "f 0 2 1", "f 3 0 1", "f 1 0 4"}));
}

TEST(MedialOthers, MaWithCommentsTagsAndEdgesThatAreSides) {
  const MedialFile file = parse_medial(
      "# made elsewhere\n4 3 1\nv 0 0 0 1 7\n\nv 1 0 0 1\nv 0 1 0 1\nv 0 0 1 .5\ne 1 0 0 2\ne 3 2\ne 2 1\nf 2 1 0 0\n",
      ComplexFormat("MA"));
  ASSERT_EQ(AxisRows(file.complex).edges.size(), 1U);
  EXPECT_EQ(AxisRows(file.complex).edges[0].vertices, (std::array<std::uint32_t, 2>{3, 2}));
  EXPECT_EQ(AxisRows(file.complex).edges[0].role, MedialRole::curve);
  EXPECT_EQ(AxisRows(file.complex).vertices[3].radius, 0.5);
  EXPECT_TRUE(file.has_radii);
}

TEST(MedialOthers, ObjWithPolygonsAndLines) {
  const MedialFile file =
      parse_medial("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nf 1 2 3 4\nl 1 5 2 1\n", ComplexFormat("OBJ"));
  EXPECT_EQ(AxisRows(file.complex).triangles.size(), 2U);
  EXPECT_EQ(AxisRows(file.complex).edges.size(), 2U);  // the third step of the line is a side of the polygon
  EXPECT_FALSE(file.has_radii);
}

TEST(MedialOthers, PlainPlyAsText) {
  const MedialFile file = parse_medial(
      "ply\nformat ascii 1.0\ncomment made elsewhere\nelement vertex 5\nproperty float x\nproperty float y\nproperty "
      "float z\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_index\nproperty float quality\n"
      "element edge 3\nproperty int vertex1\nproperty int vertex2\nelement material 1\nproperty int shade\nend_header\n"
      "0 0 0 1\n1 0 0 1\n1 1 0 1\n0 1 0 1\n0 0 1 1\n4 0 1 2 3 0.5\n0 1\n4 0\n4 1\n9\n",
      ComplexFormat("PLY"));
  EXPECT_EQ(AxisRows(file.complex).vertices.size(), 5U);
  EXPECT_EQ(AxisRows(file.complex).triangles.size(), 2U);
  ASSERT_EQ(AxisRows(file.complex).edges.size(), 2U);
  EXPECT_EQ(AxisRows(file.complex).edges[0].vertices, (std::array<std::uint32_t, 2>{4, 0}));
  EXPECT_EQ(AxisRows(file.complex).sheet_count, 1U);
  EXPECT_FALSE(file.has_radii || file.has_footprints || file.has_angles || file.has_labels);
}

/// Attributes of edges lie beside the corners, as Blum wrote them first, or in an element of their own.
TEST(MedialOthers, PlyWithAttributesInTheEdges) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float "
      "separation_angle\nproperty uchar role\n";
  const std::string points = "0 0 0 10 4\n1 0 0 20 3\n1 1 0 30 3\n";
  for (const std::string& edges :
       {"element edge 2\nproperty int vertex1\nproperty int vertex2\nproperty float separation_angle\nproperty uchar "
        "role\nend_header\n" +
            points + "0 1 40.5 3\n2 1 50.5 1\n",
        "element edge 2\nproperty int vertex1\nproperty int vertex2\nelement edge_attributes 2\nproperty uchar role\n"
        "property float separation_angle\nend_header\n" +
            points + "0 1\n2 1\n3 40.5\n1 50.5\n"}) {
    const MedialFile file = parse_medial(head + edges, ComplexFormat("PLY"));
    ASSERT_EQ(AxisRows(file.complex).edges.size(), 2U);
    EXPECT_EQ(AxisRows(file.complex).edges[1].vertices, (std::array<std::uint32_t, 2>{2, 1}));
    EXPECT_EQ(AxisRows(file.complex).edges[1].separation_angle, 50.5F);
    EXPECT_EQ(AxisRows(file.complex).edges[0].role, MedialRole::curve);
    EXPECT_EQ(AxisRows(file.complex).edges[1].role, MedialRole::rim);
    EXPECT_TRUE(file.has_angles && file.has_labels);
  }
}

TEST(MedialOthers, BigEndianPly) {
  std::string data;
  for (const double value : {0.0, 0.0, 1.5, 2.0, 0.0, 0.0, -1.0, 0.25}) {
    const char* const raw = reinterpret_cast<const char*>(&value);
    data.append(std::make_reverse_iterator(raw + 8), std::make_reverse_iterator(raw));
  }
  const MedialFile file = parse_medial(
      "ply\nformat binary_big_endian 1.0\nelement vertex 2\nproperty double x\nproperty double y\nproperty double z\n"
      "property double radius\nend_header\n" +
          data,
      ComplexFormat("PLY"));
  EXPECT_EQ(AxisRows(file.complex).vertices[0].position.z, 1.5);
  EXPECT_EQ(AxisRows(file.complex).vertices[1].radius, 0.25);
  EXPECT_TRUE(file.has_radii);
}

/// Poly data with a line of three points and a triangle, in big-endian floats and short lengths, without attributes.
TEST(MedialOthers, VtpWithPolylinesOtherTypesAndOrders) {
  std::string data;
  std::string arrays;
  const auto add = [&](const char* type, const char* name, int components, const auto& values) {
    using T = typename std::decay_t<decltype(values)>::value_type;
    arrays += "<DataArray type='" + std::string(type) + "' Name='" + name + "' NumberOfComponents='" +
              std::to_string(components) + "' format='appended' offset='" + std::to_string(data.size()) + "'/>";
    const auto put = [&](auto value) {
      const char* const raw = reinterpret_cast<const char*>(&value);
      data.append(std::make_reverse_iterator(raw + sizeof(value)), std::make_reverse_iterator(raw));
    };
    put(static_cast<std::uint32_t>(sizeof(T) * values.size()));
    for (const T value : values) put(value);
  };
  arrays += "<Points>";
  add("Float32", "coordinates", 3, std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1.5F});
  arrays += "</Points><Lines>";
  add("Int32", "connectivity", 1, std::vector<std::int32_t>{0, 1, 3});
  add("UInt8", "offsets", 1, std::vector<std::uint8_t>{3});
  arrays += "</Lines><Polys>";
  add("UInt64", "connectivity", 1, std::vector<std::uint64_t>{2, 1, 0});
  add("Int64", "offsets", 1, std::vector<std::int64_t>{3});
  arrays += "</Polys>";
  const MedialFile file = parse_medial(
      "<VTKFile type='PolyData' byte_order='BigEndian'><PolyData><Piece NumberOfPoints='4' NumberOfLines='1' "
      "NumberOfPolys='1'>" +
          arrays + "</Piece></PolyData><AppendedData encoding='raw'>_" + data,
      ComplexFormat("VTP"));
  EXPECT_EQ(AxisRows(file.complex).vertices[3].position.z, 1.5);
  ASSERT_EQ(AxisRows(file.complex).edges.size(), 1U);  // the first step is a side of the triangle
  EXPECT_EQ(AxisRows(file.complex).edges[0].vertices, (std::array<std::uint32_t, 2>{1, 3}));
  EXPECT_EQ(AxisRows(file.complex).triangles[0].vertices, (std::array<std::uint32_t, 3>{2, 1, 0}));
  EXPECT_FALSE(file.has_radii || file.has_footprints || file.has_angles || file.has_labels);
}

TEST(MedialNames, OtherExtensionsAreRefused) {
  EXPECT_THROW(write_medial("a.stl", sample_complex()), InvalidOption);
  EXPECT_THROW((void)read_medial("a"), InvalidOption);
}

TEST(MedialNames, ExtensionsInCapitalsAreKnown) {
  const TemporaryFolder folder;
  write_medial(folder / "a.VTP", sample_complex());
  expect_same(read_medial(folder / "a.VTP").complex, sample_complex());
}

}  // namespace
}  // namespace blum
