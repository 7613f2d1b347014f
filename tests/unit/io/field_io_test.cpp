// Proves that fields read back bit for bit from every format, and that the files hold the promised content. Failed and
// cancelled writes leave nothing behind. Damaged files are refused with a reason.
#include "blum/io/field_io.hpp"
#include "blum/io/file_content.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "support/image_bytes.hpp"
#include "support/zip_bytes.hpp"

namespace blum {
namespace {

using namespace test;

/// A tetrahedron with a loose segment.
TriangleMesh sample_mesh() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.2, 1.0 / 3.0}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  mesh.segments = {{0, 4}};
  return mesh;
}

Field sample_field(const std::array<std::int64_t, 3>& size = {4, 3, 2}) {
  Field field;
  field.grid.size = size;
  field.grid.spacing = {0.1, 1.0 / 3.0, 1e-7};
  field.grid.origin = {1e6, -2.5, 1.0 / 7.0};
  field.grid.direction.columns[0] = {0, 1, 0};
  field.grid.direction.columns[1] = {0.6, 0, -0.8};
  field.grid.direction.columns[2] = {-0.8, 0, -0.6};
  const std::size_t count = field.grid.node_count();
  field.distance = Buffer<float>(count);
  field.site = Buffer<SiteId>(count);
  for (std::size_t i = 0; i < count; ++i) {
    field.distance[i] = std::sin(static_cast<float>(i)) * 1e-3F;
    field.site[i] = i % 5 == 0 ? SiteId::none() : SiteId(static_cast<std::uint32_t>(i % 16));
  }
  field.band = 0.7;
  field.sign_rule = SignRule::winding;
  field.sign_reason = "3 edges are open: \"winding\" \\ \xC3\xA9 \xF0\x9F\x98\x80\nis used";
  return field;
}

void expect_same(const Field& a, const Field& b) {
  EXPECT_EQ(a.grid.size, b.grid.size);
  EXPECT_EQ(a.grid.origin, b.grid.origin);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // NRRD keeps the product of spacing and direction. The reader separates the two up to rounding.
    EXPECT_NEAR(a.grid.spacing[axis], b.grid.spacing[axis], 4e-16 * b.grid.spacing[axis]);
    for (std::size_t row = 0; row < 3; ++row) {
      EXPECT_NEAR(a.grid.direction.columns[axis][row], b.grid.direction.columns[axis][row], 4e-16);
    }
  }
  ASSERT_EQ(a.distance.size(), b.distance.size());
  EXPECT_EQ(std::memcmp(a.distance.data(), b.distance.data(), 4 * a.distance.size()), 0);
  ASSERT_EQ(a.site.size(), b.site.size());
  EXPECT_TRUE(std::equal(a.site.begin(), a.site.end(), b.site.begin()));
  ASSERT_EQ(a.distance2.size(), b.distance2.size());
  EXPECT_TRUE(std::equal(a.distance2.begin(), a.distance2.end(), b.distance2.begin()));
  ASSERT_EQ(a.site2.size(), b.site2.size());
  EXPECT_TRUE(std::equal(a.site2.begin(), a.site2.end(), b.site2.begin()));
  EXPECT_EQ(a.second, b.second);
  EXPECT_EQ(a.band, b.band);
  EXPECT_EQ(a.sign_rule, b.sign_rule);
  EXPECT_EQ(a.sign_reason, b.sign_reason);
  EXPECT_EQ(a.site_ids, b.site_ids);
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

class FieldFiles : public testing::TestWithParam<const char*> {
 protected:
  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / (std::string("out") + GetParam());
};
INSTANTIATE_TEST_SUITE_P(Formats, FieldFiles, testing::Values(".nrrd", ".npz", ".vti"),
                         [](const auto& info) { return std::string(info.param + 1); });

TEST_P(FieldFiles, ReadBackAsWritten) {
  const TriangleMesh mesh = sample_mesh();
  const MeshView view = mesh;
  const SiteTable sites(view);
  for (const SiteIds ids : {SiteIds::features, SiteIds::triangles, SiteIds::voxels}) {
    Field field = sample_field();
    field.site_ids = ids;
    const std::size_t count = ids == SiteIds::features ? sites.size() : mesh.triangles.size();
    for (SiteId& site : field.site) {
      // The sites belong to this mesh, because files list the vertices of each site. Voxels belong to no mesh.
      if (ids != SiteIds::voxels && site.has_value()) site = SiteId(static_cast<std::uint32_t>(site.value % count));
    }
    write_field(path, field, {&view, &sites, "models/\xC3\xA9t\xC3\xA9.obj", "1.2.3"});
    expect_same(read_field(path), field);
  }
}

TEST_P(FieldFiles, WithForeignSitesAreRefusedIfFilesHoldTheMesh) {
  const TriangleMesh mesh = sample_mesh();
  const MeshView view = mesh;
  Field field = sample_field();
  field.site_ids = SiteIds::triangles;
  field.site[0] = SiteId(static_cast<std::uint32_t>(mesh.triangles.size()));
  const auto write = [&] { write_field(path, field, {&view, nullptr, "mesh.obj", "1.2.3"}); };
  if (std::string(GetParam()) != ".npz") return write();
  EXPECT_THROW(write(), InvalidMesh);
  TriangleMesh broken = mesh;
  broken.triangles[0][0] = 1000000000;
  const MeshView broken_view = broken;
  field.site[0] = SiteId(0);
  EXPECT_THROW(write_field(path, field, {&broken_view, nullptr, "mesh.obj", "1.2.3"}), InvalidMesh);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_P(FieldFiles, OneLayerOneNodeAndNoBand) {
  for (const std::array<std::int64_t, 3> size : {std::array<std::int64_t, 3>{5, 7, 1}, {1, 5, 7}, {1, 1, 1}}) {
    Field field = sample_field(size);
    field.band.reset();
    field.sign_rule = SignRule::none;
    field.sign_reason.clear();
    write_field(path, field);
    expect_same(read_field(path), field);
  }
}

TEST_P(FieldFiles, WithoutSites) {
  Field field = sample_field();
  write_field(path, field);  // for .nrrd, leaves a file of sites that the next field must not take
  field.site = {};
  const TriangleMesh mesh = sample_mesh();
  const MeshView view = mesh;
  write_field(path, field, {&view, nullptr, "mesh.obj", "1.2.3"});
  expect_same(read_field(path), field);
}

TEST_P(FieldFiles, LargerThanAnyBuffer) {
  const Field field = sample_field({150, 140, 130});
  write_field(path, field);
  expect_same(read_field(path), field);
}

TEST_P(FieldFiles, AreTheSameForAnyNumberOfThreads) {
  const Field field = sample_field({150, 140, 130});
  Context context;
  context.threads = 1;
  write_field(path, field, {}, context);
  const std::string one = file_content(path);
  context.threads = 3;
  write_field(path, field, {}, context);
  EXPECT_EQ(file_content(path) == one, true);
}

TEST_P(FieldFiles, ReportProgress) {
  std::vector<double> fractions;
  Context context;
  context.progress = [&](double fraction, std::string_view) { fractions.push_back(fraction); };
  write_field(path, sample_field({150, 140, 130}), {}, context);
  ASSERT_GE(fractions.size(), 3U);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST_P(FieldFiles, CancelledWriteLeavesTheOldFiles) {
  const Field old = sample_field();
  write_field(path, old);
  const auto names = names_in(folder.path());
  std::stop_source stop;
  Context context;
  context.cancel = stop.get_token();
  context.progress = [&](double fraction, std::string_view) {
    if (fraction > 0.5) stop.request_stop();
  };
  EXPECT_THROW(write_field(path, sample_field({150, 140, 130}), {}, context), Cancelled);
  EXPECT_EQ(names_in(folder.path()), names);
  expect_same(read_field(path), old);
}

TEST_P(FieldFiles, FailedWriteLeavesNothing) {
  EXPECT_THROW(write_field(folder / "absent" / path.filename(), sample_field()), FileError);
  Field field = sample_field();
  field.grid.size[0] = 5;
  EXPECT_THROW(write_field(path, field), InvalidGrid);
  EXPECT_TRUE(names_in(folder.path()).empty());
  EXPECT_THROW((void)read_field(path), FileError);
}

TEST_P(FieldFiles, CutAnywhereGiveAnError) {
  write_field(path, sample_field());
  const std::string bytes = file_content(path);
  const std::string extension = GetParam();
  const FieldFormat format = extension == ".nrrd"  ? FieldFormat("NRRD")
                             : extension == ".npz" ? FieldFormat("NPZ")
                                                   : FieldFormat("VTI");
  // The closing tags of a .vti file hold no needed data.
  const std::size_t needed = format == FieldFormat("VTI") ? bytes.rfind("\n  </AppendedData>") : bytes.size();
  EXPECT_NO_THROW((void)read_field(std::as_bytes(std::span(bytes)), format));
  for (std::size_t length = 0; length < needed; ++length) {
    const auto part = std::as_bytes(std::span(bytes)).first(length);
    EXPECT_THROW((void)read_field(part, format), FormatError) << length;
  }
}

TEST_P(FieldFiles, DamagedAnywhereNeverCrash) {
  write_field(path, sample_field());
  const std::string bytes = file_content(path);
  const FieldFormat format = GetParam() == std::string(".nrrd")  ? FieldFormat("NRRD")
                             : GetParam() == std::string(".npz") ? FieldFormat("NPZ")
                                                                 : FieldFormat("VTI");
  std::size_t refused = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const char c : {'\0', '9', '\xff'}) {
      std::string changed = bytes;
      changed[at] = c;
      try {
        (void)read_field(std::as_bytes(std::span(changed)), format);
      } catch (const FormatError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 100U);
}

TEST(Fields, OfOrderTwoReadBackFromEveryFormat) {
  Field field = sample_field();
  const std::size_t count = field.grid.node_count();
  field.distance2 = Buffer<float>(count);
  field.site2 = Buffer<SiteId>(count);
  field.second = SecondRule::other_object;
  for (std::size_t i = 0; i < count; ++i) {
    field.distance2[i] = i % 3 == 0 ? HUGE_VALF : 0.25F * static_cast<float>(i);
    field.site2[i] = i % 3 == 0 ? SiteId::none() : SiteId(static_cast<std::uint32_t>(i % 16));
  }
  for (const char* name : {"a.nrrd", "a.npz", "a.vti"}) {
    SCOPED_TRACE(name);
    const TemporaryFolder folder;
    write_field(folder / name, field);
    expect_same(read_field(folder / name), field);
    Field without_sites = read_field(folder / name);
    without_sites.site = {};
    without_sites.site2 = {};
    write_field(folder / name, without_sites);
    expect_same(read_field(folder / name), without_sites);
    write_field(folder / name, sample_field());
    expect_same(read_field(folder / name), sample_field());
    EXPECT_EQ(names_in(folder.path()).size(), std::string(name) == "a.nrrd" ? 2U : 1U);
  }
  field.distance2 = {};
  const TemporaryFolder folder;
  EXPECT_THROW(write_field(folder / "b.npz", field), InvalidGrid);
}

TEST(NrrdFields, FilesOfTheSecondOrderAreNotTakenForDistances) {
  const TemporaryFolder folder;
  Field field = sample_field();
  field.distance2 = Buffer<float>(field.grid.node_count(), 1.0F);
  write_field(folder / "a.nrrd", field);
  EXPECT_THROW((void)read_field(folder / "a.distance2.nrrd"), FormatError);
  EXPECT_EQ(second_of_replaced_field(folder / "a.nrrd"),
            (std::vector<std::filesystem::path>{folder / "a.distance2.nrrd"}));
  // Second distances of another grid beside the distances are an error.
  Field other = sample_field({3, 4, 2});
  other.distance2 = Buffer<float>(other.grid.node_count(), 1.0F);
  write_field(folder / "c.nrrd", other);
  std::filesystem::copy_file(folder / "c.distance2.nrrd", folder / "a.distance2.nrrd",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THROW((void)read_field(folder / "a.nrrd"), FormatError);
}

TEST(NrrdFields, SitesLieBesideTheDistances) {
  const TemporaryFolder folder;
  const Field field = sample_field();
  write_field(folder / "a.b.nrrd", field, {nullptr, nullptr, "shape.obj", "1.2.3"});
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"a.b.nrrd", "a.b.site.nrrd"}));
  const std::string head = file_content(folder / "a.b.nrrd");
  for (const char* line : {"blum_version:=1.2.3\n", "source:=shape.obj\n", "band:=0.7\n", "sign_rule:=winding\n",
                           "distance:=negative inside, units of the mesh\n", "site_ids:=features\n"}) {
    EXPECT_PRED2(contains, head, line);
  }
  // Sites of another grid beside the distances are an error. If the file of sites is missing, the field has no sites.
  write_field(folder / "c.nrrd", sample_field({3, 4, 2}));
  std::filesystem::copy_file(folder / "c.site.nrrd", folder / "a.b.site.nrrd",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THROW((void)read_field(folder / "a.b.nrrd"), FormatError);
  std::filesystem::remove(folder / "a.b.site.nrrd");
  EXPECT_TRUE(read_field(folder / "a.b.nrrd").site.empty());
}

TEST(NrrdFields, TheFileOfSitesIsNotTakenForDistances) {
  const TemporaryFolder folder;
  write_field(folder / "a.nrrd", sample_field());
  try {
    (void)read_field(folder / "a.site.nrrd");
    FAIL() << "the sites were read as distances";
  } catch (const FormatError& error) {
    EXPECT_PRED2(contains, std::string(error.what()), "'a.nrrd'");
  }
}

TEST(NrrdFields, WithoutSitesReplaceOnlySitesOfTheOldField) {
  const TemporaryFolder folder;
  Field bare = sample_field();
  bare.site = {};
  write_field(folder / "a.nrrd", sample_field());
  EXPECT_EQ(sites_of_replaced_field(folder / "a.nrrd"), folder / "a.site.nrrd");
  write_field(folder / "a.nrrd", bare);
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"a.nrrd"}));
  EXPECT_FALSE(sites_of_replaced_field(folder / "a.nrrd"));
  write_field(folder / "b.nrrd", sample_field());
  std::filesystem::rename(folder / "b.site.nrrd", folder / "a.site.nrrd");  // it names b.nrrd as its field
  put_in(folder, "b.site.nrrd", "none of Blum's");
  for (const char* name : {"a.nrrd", "b.nrrd", "c.nrrd"}) write_field(folder / name, bare);
  EXPECT_TRUE(std::filesystem::exists(folder / "a.site.nrrd"));
  EXPECT_EQ(file_content(folder / "b.site.nrrd"), "none of Blum's");
}

TEST(NrrdFields, NameTheSpaceOfTheirImage) {
  const TemporaryFolder folder;
  write_field(folder / "a.nrrd", sample_field(), {.space = "right-anterior-superior"});
  for (const char* name : {"a.nrrd", "a.site.nrrd"}) {
    const std::string head = file_content(folder / name);
    EXPECT_PRED2(contains, head, "\nspace: right-anterior-superior\n");
    EXPECT_FALSE(contains(head, "space dimension"));
  }
  EXPECT_EQ(read_field(folder / "a.nrrd").grid.origin, sample_field().grid.origin);
  write_field(folder / "b.nrrd", sample_field(), {.space = "on the moon"});
  EXPECT_PRED2(contains, file_content(folder / "b.nrrd"), "\nspace dimension: 3\n");
}

TEST(NrrdFields, SitesThatCannotBeWrittenLeaveTheOldDistances) {
  const TemporaryFolder folder;
  put_in(folder, "a.nrrd", "old");
  std::filesystem::create_directory(folder / "a.site.nrrd");
  EXPECT_THROW(write_field(folder / "a.nrrd", sample_field()), FileError);
  EXPECT_EQ(file_content(folder / "a.nrrd"), "old");
}

TEST(NrrdFields, AnyScalarTypeIsRead) {
  const TemporaryFolder folder;
  const auto path = put_in(folder, "a.nrrd",
                           "NRRD0004\ntype: short\nendian: big\ndimension: 2\nsizes: 2 1\n"
                           "encoding: raw\n\n" +
                               std::string("\0\2\xff\xff", 4));
  const Field field = read_field(path);
  EXPECT_EQ(field.distance[0], 2.0F);
  EXPECT_EQ(field.distance[1], -1.0F);
  EXPECT_EQ(field.sign_rule, SignRule::none);
}

Field read_npz_bytes(const std::string& bytes) {
  return read_field(std::as_bytes(std::span(bytes)), FieldFormat("NPZ"), "sample");
}

std::string distances(const std::string& shape = "(1, 2, 3)", const std::string& type = "<f4", int bytes = 24) {
  return npy_bytes(type, shape, false, std::string(static_cast<std::size_t>(bytes), '\0'));
}

TEST(NpzFields, CompressedAndFortranOrderedArraysAreRead) {
  const std::vector<std::int64_t> sites{-1, 3, 1, 4, 0, 5};  // z, y, x = 1, 2, 3 with y faster than x
  const Field field = read_npz_bytes(zip_bytes(
      {{"distance.npy", npy_bytes(">f8", "(1, 2, 3)", false, bytes_of<double>({1, 2, 3, 4, 5, -6}, std::endian::big)),
        true},
       {"site.npy", npy_bytes("<i8", "(1, 2, 3)", true, bytes_of(sites, std::endian::little)), true},
       {"spacing.npy", npy_bytes("<f4", "(3,)", false, bytes_of<float>({1, 2, 0.5F}, std::endian::little)), false},
       {"other.npy", "whatever", false}}));
  EXPECT_EQ(field.grid.size, (std::array<std::int64_t, 3>{3, 2, 1}));
  EXPECT_EQ(field.grid.spacing, (Vec3d{1, 2, 0.5}));
  EXPECT_EQ(field.distance[5], -6.0F);
  const std::vector<std::int32_t> expected{-1, 1, 0, 3, 4, 5};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(field.site[i].to_file(), expected[i]);
}

TEST(NpzFields, HostileFilesAreRefusedWithAReason) {
  const ZipPart good{"distance.npy", distances()};
  std::string wrong_crc = zip_bytes({good});
  wrong_crc[wrong_crc.find("PK\1\2") - 1] = 'x';
  std::string far = zip_bytes({good});
  far.replace(far.size() - 6, 4, little<std::uint32_t>(0x7fffffff));
  std::string encrypted = zip_bytes({good});
  encrypted[encrypted.find("PK\1\2") + 8] = 1;
  std::string method = zip_bytes({good});
  method[method.find("PK\1\2") + 10] = 12;
  std::string size = zip_bytes({good});
  size[size.find("PK\1\2") + 24] = 1;
  const std::vector<std::pair<std::string, const char*>> table{
      {"", "not a zip archive"},
      {std::string(1000, 'x'), "not a zip archive"},
      {zip_bytes({}), "no array 'distance'"},
      {zip_bytes({{"site.npy", distances()}}), "no array 'distance'"},
      {wrong_crc, "checksum"},
      {far, "beyond the end"},
      {encrypted, "encrypted"},
      {method, "method 12"},
      {size, "two sizes"},
      {zip_bytes({{"distance.npy", "rubbish here"}}), "does not begin as a NumPy array"},
      {zip_bytes({{"distance.npy", distances("(1, 2, 4)")}}), "cut short"},
      {zip_bytes({{"distance.npy", distances("(1, 2, 2)")}}), "8 more bytes"},
      {zip_bytes({{"distance.npy", distances("(100000, 100000, 50)"), true}}), "cut short"},
      {zip_bytes({{"distance.npy", distances("(1, 1, 2, 3)")}}), "4 axes"},
      {zip_bytes({{"distance.npy", distances("(1, 2, 3)", "<f2")}}), "'<f2'"},
      {zip_bytes({good, {"site.npy", distances("(1, 3, 2)", "<i4")}}), "not that of 'distance'"},
      {zip_bytes({good, {"site.npy", distances("(1, 2, 3)", "<f4")}}), "whole numbers"},
      {zip_bytes({good,
                  {"site.npy", npy_bytes("<i4", "(1, 2, 3)", false,
                                         bytes_of<std::int32_t>({0, 0, 0, 0, -2, 0}, std::endian::little))}}),
       "site id of node 4"},
      {zip_bytes({good, {"spacing.npy", npy_bytes("<f8", "(3,)", false, std::string(24, '\0'))}}), "spacing along x"},
      {zip_bytes({good, {"origin.npy", npy_bytes("<f8", "(4,)", false, std::string(32, '\0'))}}), "3 numbers"},
      {zip_bytes({good, {"direction.npy", npy_bytes("<f8", "(3, 3)", false, std::string(72, '\0'))}}), "unit vector"},
      {zip_bytes({good, {"metadata.npy", npy_bytes("<U2", "()", false, std::string("{\0\0\0!\0\0\0", 8))}}), "JSON"},
  };
  for (const auto& [bytes, message] : table) {
    try {
      (void)read_npz_bytes(bytes);
      ADD_FAILURE() << "accepted, but should say: " << message;
    } catch (const FormatError& error) {
      EXPECT_PRED2(contains, error.what(), message);
      EXPECT_TRUE(std::string(error.what()).starts_with("sample")) << error.what();
    }
  }
}

std::string vti_bytes(const std::map<std::string, std::string>& changes = {}) {
  std::string out =
      "<?xml version=\"1.0\"?>\n<!-- a < comment > -->\n<VTKFile type='ImageData' version=\"1.0\" "
      "byte_order=\"BigEndian\" header_type=\"UInt32\">\n<ImageData WholeExtent=\"2 4 -1 0 0 0\" Origin=\"1 2 3\" "
      "Spacing=\"1 2 4\">\n<Piece Extent=\"2 4 -1 0 0 0\">\n<PointData>\n<DataArray type=\"Float64\" "
      "Name=\"distance\" format=\"appended\" offset=\"0\"/>\n<DataArray type=\"Int8\" Name=\"site\" "
      "format=\"appended\" offset=\"52\"/>\n</PointData></Piece></ImageData>\n<AppendedData encoding=\"raw\">\n_";
  out += bytes_of<std::uint32_t>({48}, std::endian::big) + bytes_of<double>({1, 2, 3, 4, 5, 6}, std::endian::big) +
         bytes_of<std::uint32_t>({6}, std::endian::big) + std::string("\xff\0\1\2\3\4", 6);
  for (const auto& [from, to] : changes) out.replace(out.find(from), from.size(), to);
  return out;
}

Field read_vti_bytes(const std::string& bytes) {
  return read_field(std::as_bytes(std::span(bytes)), FieldFormat("VTI"), "sample");
}

TEST(VtiFields, OtherTypesOrdersAndExtentsAreRead) {
  const Field field = read_vti_bytes(vti_bytes());
  EXPECT_EQ(field.grid.size, (std::array<std::int64_t, 3>{3, 2, 1}));
  EXPECT_EQ(field.grid.origin, (Vec3d{3, 0, 3}));
  EXPECT_EQ(field.distance[4], 5.0F);
  EXPECT_EQ(field.site[0], SiteId::none());
  EXPECT_EQ(field.site[5], SiteId(4));
}

TEST(VtiFields, HostileFilesAreRefusedWithAReason) {
  const std::vector<std::pair<std::string, const char*>> table{
      {"", "no appended data"},
      {"<", "no appended data"},
      {"<VTKFile", "XML is damaged"},
      {"<VTKFile type=\"ImageData", "XML is damaged"},
      {"<VTKFile type>", "XML is damaged"},
      {"<VTKFile type=\"ImageData\"><AppendedData encoding=\"raw\">_", "no ImageData"},
      {vti_bytes({{"'ImageData'", "'PolyData'"}}), "another type"},
      {vti_bytes({{"type='ImageData'", "type='ImageData' compressor='x'"}}), "compressed"},
      {vti_bytes({{"WholeExtent=\"2 4", "WholeExtent=\"5 4"}}), "extent is empty"},
      {vti_bytes({{"WholeExtent=\"2 4", "WholeExtent=\"0 99999999999999"}}), "extent is empty or too large"},
      {vti_bytes({{"2 4 -1 0 0 0", "0 99999999 0 99999999 0 99999999"}}), "more than"},
      {vti_bytes({{"2 4 -1 0 0 0", "2 4 -1 0"}}), "must be 6 numbers"},
      {vti_bytes({{"Piece Extent=\"2 4", "Piece Extent=\"2 3"}}), "several pieces"},
      {vti_bytes({{"Spacing=\"1 2", "Spacing=\"1 0"}}), "spacing along y is 0"},
      {vti_bytes({{"Origin=\"1", "Origin=\"inf"}}), "origin is not finite"},
      {vti_bytes({{"Spacing=\"1 2 4\"", "Direction=\"1 0 0 0 1 1 0 0 1\""}}), "not"},
      {vti_bytes({{"\"distance\"", "\"elsewhere\""}}), "no point data 'distance'"},
      {vti_bytes({{"format=\"appended\"", "format=\"binary\""}}), "not appended"},
      {vti_bytes({{"Float64", "Float16"}}), "unknown type 'Float16'"},
      {vti_bytes({{"Float64", "Float32"}}), "48 bytes, but the extent needs 24"},
      {vti_bytes({{"offset=\"52\"", "offset=\"5200\""}}), "beyond the end"},
      {vti_bytes({{"offset=\"52\"", "offset=\"18446744073709551615\""}}), "beyond the end"},
      {vti_bytes({{"offset=\"52\"", "offset=\"-1\""}}), "offset of 'site'"},
      {vti_bytes({{"encoding=\"raw\"", "encoding=\"base64\""}}), "not raw"},
      {vti_bytes({{"\n_", "\nx_"}}), "begin with '_'"},
      {vti_bytes().substr(0, vti_bytes().size() - 1), "cut short"},
  };
  for (const auto& [bytes, message] : table) {
    try {
      (void)read_vti_bytes(bytes);
      ADD_FAILURE() << "accepted, but should say: " << message;
    } catch (const FormatError& error) {
      EXPECT_PRED2(contains, error.what(), message);
      EXPECT_TRUE(std::string(error.what()).starts_with("sample")) << error.what();
    }
  }
}

TEST(FieldNames, OtherExtensionsAreRefused) {
  EXPECT_THROW(write_field("a.png", sample_field()), InvalidOption);
  EXPECT_THROW((void)read_field("a"), InvalidOption);
}

}  // namespace
}  // namespace blum
