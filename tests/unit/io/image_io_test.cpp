// Proves that image files of every format, type and byte order give their stated values and geometry. Images that Blum
// writes read back exactly.
#include "blum/io/image_io.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "support/data.hpp"
#include "support/image_bytes.hpp"

namespace blum {
namespace {

using namespace test;

/// 24 different values of a 4 x 3 x 2 image, which include the limits of the type.
template <class T>
std::vector<T> sample_values() {
  std::vector<T> out;
  for (int i = 0; i < 24; ++i) out.push_back(static_cast<T>(std::is_signed_v<T> ? 5 * i - 60 : 5 * i));
  out.front() = std::numeric_limits<T>::lowest();
  out.back() = std::numeric_limits<T>::max();
  return out;
}

template <class T>
void expect_values(const VoxelImage& image, const std::vector<T>& expected) {
  ASSERT_TRUE(std::holds_alternative<std::vector<T>>(image.values)) << "alternative " << image.values.index();
  EXPECT_EQ(std::get<std::vector<T>>(image.values), expected);
}

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance = 1e-12) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

const std::string nrrd_start = "NRRD0005\ndimension: 3\nsizes: 4 3 2\n";

template <class T>
class ImageOfType : public testing::Test {};
using Types = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t, std::int32_t,
                             std::uint64_t, std::int64_t, float, double>;
TYPED_TEST_SUITE(ImageOfType, Types);

template <class T>
std::string nrrd_type() {
  if constexpr (std::is_same_v<T, float>) return "float";
  if constexpr (std::is_same_v<T, double>) return "double";
  return (std::is_signed_v<T> ? "int" : "uint") + std::to_string(8 * sizeof(T));
}

TYPED_TEST(ImageOfType, ReadsNrrdOfEveryEncodingAndOrder) {
  const auto values = sample_values<TypeParam>();
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const std::string raw = bytes_of(values, order);
    const std::string head = nrrd_start + "type: " + nrrd_type<TypeParam>() +
                             "\nendian: " + (order == std::endian::little ? "little" : "big") + "\nencoding: ";
    expect_values(read_text(head + "raw\n\n" + raw, ImageFormat("NRRD")), values);
    expect_values(read_text(head + "gzip\n\n" + gzipped(raw), ImageFormat("NRRD")), values);
    expect_values(read_text(head + "raw\r\n\r\n" + raw, ImageFormat("NRRD")), values);
    expect_values(read_text(head + "raw\nbyte skip: -1\n\nrubbish" + raw, ImageFormat("NRRD")), values);
    expect_values(read_text(head + "raw\nline skip: 2\nbyte skip: 3\n\na\nb\nccc" + raw, ImageFormat("NRRD")), values);
  }
}

TYPED_TEST(ImageOfType, ReadsNrrdAsText) {
  const auto values = sample_values<TypeParam>();
  std::ostringstream text;
  text.precision(std::numeric_limits<TypeParam>::max_digits10);
  for (std::size_t i = 0; i < values.size(); ++i) text << +values[i] << (i % 4 == 3 ? "\n" : i % 4 == 1 ? ", " : " ");
  for (const std::string encoding : {"ascii", "text", "txt"}) {
    const std::string head = nrrd_start + "type: " + nrrd_type<TypeParam>() + "\nencoding: " + encoding + "\n\n";
    expect_values(read_text(head + text.str(), ImageFormat("NRRD")), values);
  }
}

TYPED_TEST(ImageOfType, ReadsNpyOfEitherOrder) {
  using T = TypeParam;
  const auto values = sample_values<T>();
  std::vector<T> transposed;  // z fastest
  for (std::size_t x = 0; x < 4; ++x) {
    for (std::size_t y = 0; y < 3; ++y) {
      for (std::size_t z = 0; z < 2; ++z) transposed.push_back(values[(z * 3 + y) * 4 + x]);
    }
  }
  const std::string code = (std::is_floating_point_v<T> ? "f"
                            : std::is_signed_v<T>       ? "i"
                                                        : "u") +
                           std::to_string(sizeof(T));
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const std::string dtype = (sizeof(T) == 1 ? "|" : order == std::endian::little ? "<" : ">") + code;
    const VoxelImage image =
        read_text(npy_bytes(dtype, "(2, 3, 4)", false, bytes_of(values, order)), ImageFormat("NPY"));
    EXPECT_EQ(image.grid.size, (std::array<std::int64_t, 3>{4, 3, 2}));
    expect_values(image, values);
    expect_values(read_text(npy_bytes(dtype, "(2, 3, 4)", true, bytes_of(transposed, order)), ImageFormat("NPY")),
                  values);
  }
}

template <class T>
constexpr std::int16_t nifti_type() {
  if (std::is_floating_point_v<T>) return sizeof(T) == 4 ? 16 : 64;
  constexpr std::array<std::int16_t, 4> with_sign{256, 4, 8, 1024};
  constexpr std::array<std::int16_t, 4> without{2, 512, 768, 1280};
  const std::size_t i = static_cast<std::size_t>(std::countr_zero(sizeof(T)));
  return std::is_signed_v<T> ? with_sign[i] : without[i];
}

TYPED_TEST(ImageOfType, ReadsNiftiOfEitherOrder) {
  const auto values = sample_values<TypeParam>();
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const Nifti nifti(nifti_type<TypeParam>(), order);
    const std::string file = nifti.bytes + bytes_of(values, order);
    const VoxelImage image = read_text(file, ImageFormat("NIfTI"));
    EXPECT_EQ(image.grid.size, (std::array<std::int64_t, 3>{4, 3, 2}));
    expect_values(image, values);
    expect_values(read_text(gzipped(file), ImageFormat("NIfTI")), values);
    // Several gzip members one after the other, as parallel compressors write them.
    expect_values(read_text(gzipped(file.substr(0, 360)) + gzipped(file.substr(360)), ImageFormat("NIfTI")), values);
  }
}

TYPED_TEST(ImageOfType, WrittenImagesReadBack) {
  const TemporaryFolder folder;
  VoxelImage image;
  image.grid.size = {4, 3, 2};
  image.grid.spacing = {0.1, 1.0 / 3.0, 1e-7};
  image.grid.origin = {1e6, -2.5, 1.0 / 7.0};
  image.grid.direction.columns[0] = {0, 1, 0};
  image.grid.direction.columns[1] = {0, 0, -1};
  image.grid.direction.columns[2] = {1, 0, 0};
  image.values = sample_values<TypeParam>();
  image.space = "left-posterior-superior";
  write_image(folder / "a.nrrd", image);
  const VoxelImage nrrd = read_image(folder / "a.nrrd");
  EXPECT_EQ(nrrd.grid, image.grid);
  EXPECT_EQ(nrrd.space, image.space);
  EXPECT_EQ(nrrd.values, image.values);
  write_image(folder / "a.npy", image);
  const VoxelImage npy = read_image(folder / "a.npy");
  EXPECT_EQ(npy.grid.size, image.grid.size);
  EXPECT_EQ(npy.grid.spacing, (Vec3d{1, 1, 1}));
  EXPECT_EQ(npy.values, image.values);
}

TEST(NrrdImages, KeepTheirSpace) {
  const auto space_of = [](const std::string& fields) {
    return read_text(nrrd_start + "type: uint8\nencoding: raw\n" + fields + "\n\n" + std::string(24, '\1'),
                     ImageFormat("NRRD"))
        .space;
  };
  const std::string directions = "\nspace directions: (1,0,0) (0,1,0) (0,0,1)";
  EXPECT_EQ(space_of("space: RAS" + directions), "right-anterior-superior");
  EXPECT_EQ(space_of("space: Left-Posterior-Superior" + directions), "left-posterior-superior");
  EXPECT_EQ(space_of("space: scanner-xyz" + directions), "scanner-xyz");
  EXPECT_EQ(space_of("space: elsewhere" + directions), "");
  EXPECT_EQ(space_of("space dimension: 3" + directions), "");
  EXPECT_EQ(space_of("space: RAS\nspacings: 1 1 1"), "") << "axes without directions lie in no space";
}

GridSpec nrrd_grid(const std::string& fields) {
  return read_text("NRRD0005\n" + head8 + fields + "\n\n" + std::string(1000, '\1'), ImageFormat("NRRD")).grid;
}

TEST(NrrdGeometry, SpaceDirectionsGiveSpacingAndDirection) {
  const GridSpec grid = nrrd_grid(
      "dimension: 3\nsizes: 4 3 2\nspace: left-posterior-superior\nspace directions: (0,0.5,0) ( -2 , 0,0 ) (0, 0,3)\n"
      "space origin: (1,-2,+3e1)\nkinds: domain domain domain\n# a comment\nkey:=value: with colon\ncontent: a:=b");
  EXPECT_EQ(grid.spacing, (Vec3d{0.5, 2, 3}));
  EXPECT_EQ(grid.origin, (Vec3d{1, -2, 30}));
  EXPECT_EQ(grid.direction.columns[0], (Vec3d{0, 1, 0}));
  EXPECT_EQ(grid.direction.columns[1], (Vec3d{-1, 0, 0}));
  EXPECT_EQ(grid.direction.columns[2], (Vec3d{0, 0, 1}));
}

TEST(NrrdGeometry, SpacingsWithUnknownAndNegativeEntriesAndAxisMins) {
  const GridSpec grid =
      nrrd_grid("Dimension: 3\nSizes: 4 3 2\nspacings: nan 0.5 -2\naxis mins: 10 20 nan\ncenterings: node cell cell");
  EXPECT_EQ(grid.spacing, (Vec3d{1, 0.5, 2}));
  EXPECT_EQ(grid.origin, (Vec3d{10, 20.25, 0}));
  EXPECT_EQ(grid.direction.columns[2], (Vec3d{0, 0, -1}));
}

TEST(NrrdGeometry, RoundedRotationIsMadeExactlyOrthonormal) {
  // 30 degrees about z, to six digits.
  const GridSpec grid = nrrd_grid(
      "dimension: 3\nsizes: 4 3 2\nspace dimension: 3\n"
      "space directions: (0.866025,0.5,0) (-0.5,0.866025,0) (0,0,1)\nspace origin: (0,0,0)");
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      EXPECT_NEAR(dot(grid.direction.columns[a], grid.direction.columns[b]), a == b ? 1 : 0, 1e-15);
    }
  }
  expect_near(grid.direction.columns[0], {std::sqrt(0.75), 0.5, 0}, 1e-6);
}

TEST(NrrdGeometry, ImagesOfOtherDimensions) {
  GridSpec grid = nrrd_grid(
      "dimension: 2\nsizes: 4 3\nspace dimension: 2\nspace directions: (0,2) (3,0)\n"
      "space origin: (5,6)");
  EXPECT_EQ(grid.size, (std::array<std::int64_t, 3>{4, 3, 1}));
  EXPECT_EQ(grid.spacing, (Vec3d{2, 3, 1}));
  EXPECT_EQ(grid.origin, (Vec3d{5, 6, 0}));
  EXPECT_EQ(grid.direction.columns[2], (Vec3d{0, 0, 1}));
  // An upright slice in space: the third direction is perpendicular to the slice.
  grid = nrrd_grid("dimension: 2\nsizes: 4 3\nspace dimension: 3\nspace directions: (0,0,2) (0,3,0)");
  EXPECT_EQ(std::abs(grid.direction.columns[2].x), 1.0);
  grid = nrrd_grid("dimension: 1\nsizes: 7\nspacings: 0.5");
  EXPECT_EQ(grid.size, (std::array<std::int64_t, 3>{7, 1, 1}));
  // A list axis of one entry, and a fourth axis of one entry without a kind.
  grid = nrrd_grid(
      "dimension: 4\nsizes: 1 4 3 2\nspace dimension: 3\n"
      "space directions: none (1,0,0) (0,1,0) (0,0,2)\nkinds: list domain domain domain");
  EXPECT_EQ(grid.size, (std::array<std::int64_t, 3>{4, 3, 2}));
  EXPECT_EQ(grid.spacing, (Vec3d{1, 1, 2}));
  grid = nrrd_grid("dimension: 4\nsizes: 4 3 2 1\nspacings: 1 2 3 nan");
  EXPECT_EQ(grid.size, (std::array<std::int64_t, 3>{4, 3, 2}));
}

TEST(NrrdFiles, ReadsDetachedData) {
  const TemporaryFolder folder;
  const auto values = sample_values<std::int16_t>();
  put_in(folder, "data.bin", "skip\n" + bytes_of(values, std::endian::big));
  const std::string fields = nrrd_start + "type: short\nendian: big\nencoding: raw\nline skip: 1\n";
  // A detached header needs no empty line at the end.
  expect_values(read_image(put_in(folder, "a.nhdr", fields + "data file: data.bin\n")), values);
  expect_values(read_image(put_in(folder, "b.nhdr", fields + "datafile: data.bin\n\n")), values);
  EXPECT_THROW((void)read_image(put_in(folder, "c.nhdr", fields + "data file: absent.bin\n")), FileError);
  EXPECT_PRED2(contains, error_of(fields + "data file: data.bin\n\n", ImageFormat("NRRD")), "in another file");
}

TEST(NiftiGeometry, SformGivesTheFrame) {
  Nifti nifti(2);
  nifti.sform({0, -2, 0, 10, 0.5F, 0, 0, -20, 0, 0, 3, 30});
  const GridSpec grid = read_text(nifti.bytes + data24, ImageFormat("NIfTI")).grid;
  EXPECT_EQ(grid.spacing, (Vec3d{0.5, 2, 3}));
  EXPECT_EQ(grid.origin, (Vec3d{10, -20, 30}));
  EXPECT_EQ(grid.direction.columns[0], (Vec3d{0, 1, 0}));
  EXPECT_EQ(grid.direction.columns[1], (Vec3d{-1, 0, 0}));
  EXPECT_EQ(grid.direction.columns[2], (Vec3d{0, 0, 1}));
}

/// A quarter turn about z. qfac reverses the z axis.
Nifti with_qform() {
  Nifti nifti(2);
  nifti.set<std::int16_t>(252, 1).set<float>(76, -1.0F).set<float>(80, 0.5F).set<float>(84, 2.0F).set<float>(88, 4.0F);
  nifti.set<float>(264, static_cast<float>(std::numbers::sqrt2 / 2));
  nifti.set<float>(268, 1.0F).set<float>(272, 2.0F).set<float>(276, 3.0F);
  return nifti;
}

void expect_qform(const GridSpec& grid) {
  EXPECT_EQ(grid.spacing, (Vec3d{0.5, 2, 4}));
  EXPECT_EQ(grid.origin, (Vec3d{1, 2, 3}));
  expect_near(grid.direction.columns[0], {0, 1, 0}, 1e-7);
  expect_near(grid.direction.columns[1], {-1, 0, 0}, 1e-7);
  expect_near(grid.direction.columns[2], {0, 0, -1}, 1e-7);
}

TEST(NiftiGeometry, QformGivesTheFrameWithoutAnSform) {
  expect_qform(read_text(with_qform().bytes + data24, ImageFormat("NIfTI")).grid);
}

TEST(NiftiGeometry, QformReplacesAShearedSform) {
  Nifti nifti = with_qform();
  nifti.sform({1, 0.2F, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
  expect_qform(read_text(nifti.bytes + data24, ImageFormat("NIfTI")).grid);
  nifti.set<std::int16_t>(252, 0);
  EXPECT_PRED2(contains, error_of(nifti.bytes + data24, ImageFormat("NIfTI")), "must be perpendicular");
}

TEST(NiftiGeometry, SpacingsAloneIfNoFormIsSet) {
  Nifti nifti(2);
  nifti.set<float>(80, 0.5F).set<float>(84, -2.0F);
  const GridSpec grid = read_text(nifti.bytes + data24, ImageFormat("NIfTI")).grid;
  EXPECT_EQ(grid.spacing, (Vec3d{0.5, 2, 1}));
  EXPECT_EQ(grid.origin, Vec3d{});
  EXPECT_EQ(grid.direction, Mat3{});
}

TEST(NiftiValues, ScaleGivesDoubles) {
  Nifti nifti(4);
  const auto values = sample_values<std::int16_t>();
  const std::string data = bytes_of(values, std::endian::little);
  const auto scaled = [&](float slope, float intercept) {
    nifti.set<float>(112, slope).set<float>(116, intercept);
    return read_text(nifti.bytes + data, ImageFormat("NIfTI"));
  };
  std::vector<double> expected;
  for (const auto v : values) expected.push_back(0.5 * v - 3);
  expect_values(scaled(0.5F, -3), expected);
  expect_values(scaled(1, 0), values);
  expect_values(scaled(0, 7), values);
  expect_values(scaled(std::numeric_limits<float>::quiet_NaN(), 7), values);
  expected.assign(values.begin(), values.end());
  for (double& v : expected) v += 7;
  expect_values(scaled(1, 7), expected);
}

TEST(NiftiFiles, ReadsPairsAndExtensionsAndUnsetOffsets) {
  const TemporaryFolder folder;
  const auto values = sample_values<std::uint8_t>();
  const std::string data = bytes_of(values, std::endian::little);
  Nifti nifti(2);
  expect_values(read_text(nifti.set<float>(108, 0.0F).bytes + data, ImageFormat("NIfTI")), values);
  expect_values(read_text(nifti.set<float>(108, 384.0F).bytes + std::string(32, 'x') + data, ImageFormat("NIfTI")),
                values);
  nifti.set<float>(108, 0.0F).bytes.replace(344, 3, "ni1");
  put_in(folder, "a.hdr", nifti.bytes.substr(0, 348));
  put_in(folder, "a.img", data);
  expect_values(read_image(folder / "a.hdr"), values);
  expect_values(read_image(folder / "a.img"), values);
  put_in(folder, "b.hdr.gz", gzipped(nifti.bytes));
  put_in(folder, "b.img.gz", gzipped(data));
  expect_values(read_image(folder / "b.img.gz"), values);
  EXPECT_PRED2(contains, error_of(nifti.bytes + data, ImageFormat("NIfTI")), "another file");
}

TEST(NiftiFiles, ReadsVersion2) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    Nifti nifti(2, order);
    nifti.bytes = std::string(544, '\0');
    nifti.set<std::int32_t>(0, 540).set<std::int16_t>(12, 4).set<std::int64_t>(168, 544);
    nifti.bytes.replace(4, 8, std::string("n+2\0\r\n\032\n", 8));
    const std::array<std::int64_t, 8> dim{3, 4, 3, 2, 1, 1, 1, 1};
    for (std::size_t i = 0; i < 8; ++i) nifti.set<std::int64_t>(16 + 8 * i, dim[i]).set<double>(104 + 8 * i, 0.25);
    nifti.set<std::int32_t>(344, 1).set<double>(376, 0.1).set<double>(384, 0.2).set<double>(392, 0.3);
    const auto values = sample_values<std::int16_t>();
    const VoxelImage image = read_text(nifti.bytes + bytes_of(values, order), ImageFormat("NIfTI"));
    expect_values(image, values);
    EXPECT_EQ(image.grid.spacing, (Vec3d{0.25, 0.25, 0.25}));
    EXPECT_EQ(image.grid.origin, (Vec3d{0.1, 0.2, 0.3}));
  }
}

TEST(NpyFiles, BoolAndFewerAxesAndOtherVersions) {
  const VoxelImage flat =
      read_text(npy_bytes("|b1", "(2, 3)", false, std::string("\1\0\1\0\1\1", 6)), ImageFormat("NPY"));
  EXPECT_EQ(flat.grid.size, (std::array<std::int64_t, 3>{3, 2, 1}));
  expect_values(flat, std::vector<std::uint8_t>{1, 0, 1, 0, 1, 1});
  std::string row = npy_bytes("|u1", "(6,)", false, "abcdef");
  EXPECT_EQ(read_text(row, ImageFormat("NPY")).grid.size, (std::array<std::int64_t, 3>{6, 1, 1}));
  row[6] = '\2';
  row.insert(10, 2, '\0');
  expect_values(read_text(row, ImageFormat("NPY")), std::vector<std::uint8_t>{'a', 'b', 'c', 'd', 'e', 'f'});
}

TEST(VolFiles, ReadsBothVersions) {
  const auto values = sample_values<std::uint8_t>();
  const std::string data = bytes_of(values, std::endian::little);
  expect_values(read_text(vol_bytes("2", data), ImageFormat("Vol")), values);
  const VoxelImage image = read_text(vol_bytes("3", compressed(data, 15)), ImageFormat("Vol"));
  expect_values(image, values);
  EXPECT_EQ(image.grid.size, (std::array<std::int64_t, 3>{4, 3, 2}));
}

std::size_t foreground(const VoxelImage& image) {
  return std::visit(
      [](const auto& v) { return v.size() - static_cast<std::size_t>(std::count(v.begin(), v.end(), 0)); },
      image.values);
}

TEST(RealImages, HaveTheirKnownSizesAndForeground) {
  struct Known {
    const char* name;
    std::array<std::int64_t, 3> size;
    std::size_t foreground;
  };
  // Counted with nibabel (lobster) and zlib in Python (the others).
  const std::array known{Known{"images/cat10.vol", {40, 40, 40}, 8043},
                         Known{"images/Al.100.vol", {100, 100, 100}, 70413},
                         Known{"images/lobsterCroped2.nii.gz", {101, 101, 41}, 416277}};
  for (const Known& k : known) {
    const auto path = test::data_file(k.name);
    if (!path) GTEST_SKIP() << test::no_data(k.name);
    const VoxelImage image = read_image(*path);
    EXPECT_EQ(image.grid.size, k.size) << k.name;
    EXPECT_EQ(foreground(image), k.foreground) << k.name;
  }
  const GridSpec lobster = read_image(*test::data_file("images/lobsterCroped2.nii.gz")).grid;
  EXPECT_EQ(lobster.origin, (Vec3d{-50, -50, 10}));
  expect_near(lobster.direction.columns[0], {-1, 0, 0});
}

TEST(ImageFiles, NamesThatCannotBeUsed) {
  const TemporaryFolder folder;
  EXPECT_THROW((void)read_image(folder / "absent.nrrd"), FileError);
  EXPECT_THROW((void)read_image(folder / "a.png"), InvalidOption);
  EXPECT_THROW((void)read_image(folder / "a.npy.gz"), InvalidOption);
  std::filesystem::create_directory(folder / "folder.vol");
  EXPECT_THROW((void)read_image(folder / "folder.vol"), FileError);
  VoxelImage image;
  image.grid.size = {2, 1, 1};
  image.values = std::vector<std::uint8_t>{1, 2};
  EXPECT_THROW(write_image(folder / "a.vol", image), InvalidOption);
  EXPECT_THROW(write_image(folder / "no" / "a.npy", image), FileError);
  image.values = std::vector<std::uint8_t>{1};
  EXPECT_THROW(write_image(folder / "a.npy", image), InvalidImage);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.npy"));
}

}  // namespace
}  // namespace blum
