// Proves that damaged and hostile image files are refused with the reason, before memory is taken for the claimed size.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "support/image_bytes.hpp"

namespace blum {
namespace {

using namespace test;

struct Hostile {
  const char* what;
  ImageFormat format;
  std::string bytes;
  const char* message;
};

std::vector<Hostile> hostile_nrrds() {
  const auto f = ImageFormat("NRRD");
  const std::string n = "NRRD0005\n";
  const std::string sizes = "dimension: 3\nsizes: 4 3 2\n";
  return {
      {"empty", f, "", "does not begin with NRRD"},
      {"another format", f, "P5\n4 3 255\n\n" + data24, "does not begin with NRRD"},
      {"unknown version", f, "NRRD0009\n" + head8 + sizes + "\n" + data24, "not a known version"},
      {"only the magic", f, "NRRD0004\n", "'type' is missing"},
      {"line without a colon", f, n + head8 + "rubbish\n\n" + data24, "line 4"},
      {"field twice", f, n + head8 + sizes + "sizes: 1 1 1\n\n" + data24, "again"},
      {"block type", f, n + "type: block\nencoding: raw\n" + sizes + "\n" + data24, "type 'block'"},
      {"bzip2", f, n + "type: uchar\nencoding: bzip2\n" + sizes + "\n" + data24, "'bzip2'"},
      {"endian missing", f, n + "type: int\nencoding: raw\n" + sizes + "\n" + data24, "'endian' is missing"},
      {"17 axes", f, n + head8 + "dimension: 17\nsizes: 1\n\n" + data24, "dimension must be 1 to 16"},
      {"size zero", f, n + head8 + "dimension: 3\nsizes: 4 0 2\n\n" + data24, "not a positive whole number"},
      {"negative size", f, n + head8 + "dimension: 3\nsizes: 4 -3 2\n\n" + data24, "not a positive whole number"},
      {"too few sizes", f, n + head8 + "dimension: 3\nsizes: 4 3\n\n" + data24, "one number for each"},
      {"product overflows", f, n + head8 + "dimension: 3\nsizes: 4294967296 4294967296 4294967296\n\n" + data24,
       "more than"},
      {"10^9 voxels in a small file", f, n + head8 + "dimension: 3\nsizes: 1000 1000 1000\n\n" + data24, "cut short"},
      {"more voxels than ids", f, n + head8 + "dimension: 3\nsizes: 65536 65536 4\n\n" + data24, "2147483647"},
      {"data cut short", f, n + head8 + sizes + "\n" + data24.substr(1), "cut short"},
      {"text cut short", f, n + "type: uchar\nencoding: text\n" + sizes + "\n" + std::string(47, ' '), "ends after 0"},
      {"text out of range", f, n + "type: uchar\nencoding: text\ndimension: 1\nsizes: 2\n\n3 256",
       "not a number of its type"},
      {"gzip cut short", f,
       n + "type: uchar\nencoding: gzip\n" + sizes + "\n" + gzipped(data24).substr(0, gzipped(data24).size() - 5),
       "cut short"},
      {"gzip bomb", f, n + "type: uchar\nencoding: gzip\ndimension: 3\nsizes: 1000 1000 1000\n\n" + gzipped(data24),
       "cut short"},
      {"no gzip", f, n + "type: uchar\nencoding: gzip\n" + sizes + "\n" + data24, "damaged"},
      {"shear", f, n + head8 + sizes + "space dimension: 3\nspace directions: (1,0,0) (0.1,1,0) (0,0,1)\n\n" + data24,
       "must be perpendicular"},
      {"axes in a plane", f,
       n + head8 + sizes + "space dimension: 3\nspace directions: (1,0,0) (0,1,0) (1,1,0)\n\n" + data24,
       "must be perpendicular"},
      {"direction zero", f, n + head8 + sizes + "space directions: (0,0,0) (0,1,0) (0,0,1)\n\n" + data24, "zero"},
      {"direction NaN", f, n + head8 + sizes + "space directions: (nan,0,0) (0,1,0) (0,0,1)\n\n" + data24,
       "not finite"},
      {"vector cut short", f, n + head8 + sizes + "space directions: (1,0,0) (0,1,0) (0,0\n\n" + data24,
       "not a list of vectors"},
      {"spacing zero", f, n + head8 + sizes + "spacings: 1 0 1\n\n" + data24, "zero"},
      {"spacing infinite", f, n + head8 + sizes + "spacings: 1 inf 1\n\n" + data24, "not finite"},
      {"origin infinite", f, n + head8 + sizes + "space origin: (inf,0,0)\n\n" + data24, "origin is not finite"},
      {"colour image", f, n + head8 + "dimension: 3\nsizes: 3 4 2\nspace directions: none (1,0,0) (0,1,0)\n\n" + data24,
       "axis 0 has 3"},
      {"vector kind", f, n + head8 + "dimension: 3\nsizes: 3 4 2\nkinds: vector domain domain\n\n" + data24,
       "axis 0 has 3"},
      {"four axes", f, n + head8 + "dimension: 4\nsizes: 2 3 2 2\n\n" + data24, "4 axes"},
      {"data file list", f, n + head8 + sizes + "data file: LIST\na.raw\n\n" + data24, ""},
      {"line skip beyond the end", f, n + head8 + sizes + "line skip: 1000000000000\n\n" + data24, "fewer lines"},
      {"byte skip beyond the end", f, n + head8 + sizes + "byte skip: 1000000000000\n\n" + data24, "cut short"},
      {"byte skip -2", f, n + head8 + sizes + "byte skip: -2\n\n" + data24, "'byte skip'"},
  };
}

std::vector<Hostile> hostile_others() {
  const auto nifti = ImageFormat("NIfTI");
  const auto npy = ImageFormat("NPY");
  const auto vol = ImageFormat("Vol");
  const auto npy_of = [](const std::string& dtype, const std::string& shape, const std::string& data = data24) {
    return npy_bytes(dtype, shape, false, data);
  };
  std::string damaged = gzipped(Nifti(2).bytes + data24);
  damaged[damaged.size() - 6] = static_cast<char>(damaged[damaged.size() - 6] ^ 1);  // its checksum
  return {
      {"empty", nifti, "", "cut short"},
      {"not NIfTI", nifti, std::string(400, 'x'), "does not begin as a NIfTI"},
      {"Analyze", nifti, Nifti(2).set<char>(344, '\0').bytes + data24, "Analyze"},
      {"colour", nifti, Nifti(128).bytes + data24, "NIfTI type 128"},
      {"eight dimensions", nifti, Nifti(2).set<std::int16_t>(40, 8).bytes + data24, "number of dimensions"},
      {"time series", nifti, Nifti(2).set<std::int16_t>(40, 4).set<std::int16_t>(48, 5).bytes + data24,
       "5 images along dimension 4"},
      {"negative size", nifti, Nifti(2).set<std::int16_t>(42, -4).bytes + data24, "at least 1"},
      {"huge", nifti,
       Nifti(2).set<std::int16_t>(42, 32767).set<std::int16_t>(44, 32767).set<std::int16_t>(46, 2).bytes + data24,
       "cut short"},
      {"gzip bomb", nifti, gzipped(Nifti(2).set<std::int16_t>(42, 32767).set<std::int16_t>(44, 32767).bytes),
       "cut short"},
      {"checksum", nifti, damaged, "damaged"},
      {"offset in the header", nifti, Nifti(2).set<float>(108, 100.0F).bytes + data24, "cannot begin"},
      {"offset in the extension flags", nifti, Nifti(2).set<float>(108, 348.0F).bytes + data24, "byte 348"},
      {"offset NaN", nifti, Nifti(2).set<float>(108, std::numeric_limits<float>::quiet_NaN()).bytes + data24,
       "cannot begin"},
      {"offset beyond the end", nifti, Nifti(2).set<float>(108, 1e9F).bytes + data24, "cut short"},
      {"spacing zero", nifti, Nifti(2).set<float>(80, 0.0F).bytes + data24, "spacing along x is 0"},
      {"spacing NaN", nifti, Nifti(2).set<float>(84, std::numeric_limits<float>::quiet_NaN()).bytes + data24,
       "spacing along y"},
      {"quaternion too long", nifti, Nifti(2).set<std::int16_t>(252, 1).set<float>(256, 3.0F).bytes + data24,
       "quaternion"},
      {"sform zero", nifti, Nifti(2).set<std::int16_t>(254, 1).bytes + data24, "zero"},
      {"empty", npy, "", "cut short"},
      {"not NumPy", npy, std::string(100, 'x'), "does not begin as a NumPy array"},
      {"half precision", npy, npy_of("<f2", "(2, 3, 4)"), "'<f2'"},
      {"complex", npy, npy_of("<c8", "(2, 3, 4)"), "'<c8'"},
      {"objects", npy, npy_of("|O", "(2, 3, 4)"), "'|O'"},
      {"text", npy, npy_of("<U1", "(2, 3)"), "text, not numbers"},
      {"records", npy, std::string("\x93NUMPY\x01\x00\x18\x00{'descr': [('a', '<f4')],", 10 + 24), "records"},
      {"no axes", npy, npy_of("|u1", "()"), "0 axes"},
      {"four axes", npy, npy_of("|u1", "(1, 2, 3, 4)"), "4 axes"},
      {"empty array", npy, npy_of("|u1", "(0, 3, 4)"), "at least 1"},
      {"negative shape", npy, npy_of("|u1", "(-1, 3, 4)"), "not a tuple"},
      {"overflow", npy, npy_of("<f8", "(4294967296, 4294967296, 4294967296)"), "more than"},
      {"values cut short", npy, npy_of("<f8", "(2, 3, 4)"), "cut short"},
      {"header cut short", npy, npy_of("|u1", "(2, 3, 4)").substr(0, 30), "cut short"},
      {"shape missing", npy, std::string("\x93NUMPY\x01\x00\x12\x00{'descr': '<f4', }", 10 + 18), "it needs 'descr'"},
      {"empty", vol, "", "does not begin with lines"},
      {"no dot", vol, "X: 4\nY: 3\nZ: 2\n" + data24, "does not begin with lines"},
      {"size missing", vol, "X: 4\nY: 3\nVersion: 2\n.\n" + data24, "'Z' is missing"},
      {"size no number", vol, "X: 4\nY: 3\nZ: 2x\nVersion: 2\n.\n" + data24, "not a whole number"},
      {"negative size", vol, "X: 4\nY: 3\nZ: -2\nVersion: 2\n.\n" + data24, "at least 1"},
      {"huge", vol, "X: 1000\nY: 1000\nZ: 1000\nVersion: 3\n.\n" + compressed(data24, 15), "cut short"},
      {"data cut short", vol, vol_bytes("2", "abc"), "cut short"},
      {"not compressed", vol, vol_bytes("3", data24), "damaged"},
      {"version 7", vol, vol_bytes("7", data24), "versions 2 and 3"},
      {"wide voxels", vol, "X: 4\nY: 3\nZ: 2\nVoxel-Size: 2\nVersion: 2\n.\n" + data24, "one byte"},
  };
}

TEST(HostileImages, AreRefusedWithAReason) {
  for (const auto& table : {hostile_nrrds(), hostile_others()}) {
    for (const Hostile& h : table) {
      const std::string message = error_of(h.bytes, h.format);
      EXPECT_PRED2(contains, message, h.message) << h.what;
      EXPECT_TRUE(message.starts_with("sample")) << h.what << ": '" << message << "'";
    }
  }
}

TEST(HostileImages, CutAnywhereGiveAnError) {
  const std::array<std::pair<ImageFormat, std::string>, 4> files{
      std::pair{ImageFormat("NRRD"),
                "NRRD0005\ntype: uchar\nencoding: gzip\ndimension: 3\nsizes: 4 3 2\n\n" + gzipped(data24)},
      std::pair{ImageFormat("NIfTI"), gzipped(Nifti(2).bytes + data24)},
      std::pair{ImageFormat("NPY"), npy_bytes("|u1", "(2, 3, 4)", false, data24)},
      std::pair{ImageFormat("Vol"), vol_bytes("3", compressed(data24, 15))}};
  for (const auto& [format, bytes] : files) {
    EXPECT_EQ(error_of(bytes, format), "");
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      EXPECT_NE(error_of(bytes.substr(0, length), format), "") << length << " bytes of format " << format.name();
    }
  }
}

}  // namespace
}  // namespace blum
