// Proves that .npz files of surface maps read back bit for bit, for all quantities. Any error in a file is refused with
// a message that names it. Cut or changed bytes cause nothing else.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include "blum/io/surface_map_io.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/surface_map/thickness.hpp"
#include "io/archive/numpy.hpp"
#include "io/text/json.hpp"
#include "support/surface_map_sample.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

using test::BoxMap;
using test::TemporaryFolder;

template <class A, class B>
void expect_same_bytes(const A& a, const B& b, const char* what) {
  const auto left = std::as_bytes(std::span(a.data(), a.size()));
  const auto right = std::as_bytes(std::span(b.data(), b.size()));
  ASSERT_EQ(left.size(), right.size()) << what;
  EXPECT_TRUE(std::equal(left.begin(), left.end(), right.begin())) << what;
}

void expect_same(const SurfaceMap& a, const SurfaceMap& b) {
  EXPECT_EQ(a.quantity, b.quantity);
  EXPECT_EQ(a.sign_rule, b.sign_rule);
  EXPECT_EQ(a.sign_reason, b.sign_reason);
  EXPECT_EQ(a.atlas->width, b.atlas->width);
  EXPECT_EQ(a.atlas->height, b.atlas->height);
  EXPECT_EQ(a.atlas->is_separate, b.atlas->is_separate);
  EXPECT_EQ(a.atlas->corners, b.atlas->corners);
  expect_same_bytes(a.atlas->triangle, b.atlas->triangle, "triangle");
  expect_same_bytes(a.distance, b.distance, "distance");
  expect_same_bytes(a.vector, b.vector, "vector");
  expect_same_bytes(a.site, b.site, "site");
  expect_same_bytes(a.error, b.error, "error");
  expect_same_bytes(a.vertex_distance, b.vertex_distance, "vertex_distance");
  expect_same_bytes(a.faces, b.faces, "faces");
}

void expect_round_trip(const TriangleMesh& mesh, const SurfaceMap& map) {
  const TemporaryFolder folder;
  write_surface_map(folder / "a.npz", mesh, map, {{"source", "here"}}, {.units = "mm"});
  ASSERT_TRUE(holds_surface_map(folder / "a.npz"));
  const SurfaceMapFile file = read_surface_map(folder / "a.npz");
  expect_same(file.map, map);
  expect_same_bytes(file.mesh.vertices, mesh.vertices, "vertices");
  EXPECT_EQ(file.mesh.triangles, mesh.triangles);
  EXPECT_EQ(find_value(file.metadata, "source"), "here");
  EXPECT_EQ(find_value(file.metadata, "units"), "mm");
  write_surface_map(folder / "b.npz", file.mesh, file.map, file.metadata);
  EXPECT_EQ(test::file_content(folder / "a.npz"), test::file_content(folder / "b.npz"));
}

TEST(SurfaceMapRead, GivesBackMapsOfAllQuantities) {
  const TriangleMesh ball = make_sphere({.frequency = 4});
  TriangleMesh box = make_box();
  for (Vec3d& v : box.vertices) v.x += 1.2;
  const SurfaceMapOptions coarse{.texel = 0.1};
  expect_round_trip(ball, surface_distance_map(ball, box, coarse));
  expect_round_trip(ball,
                    surface_distance_map(ball, box, {.texel = 0.1, .sign = SignMode::winding, .max_distance = 0.5}));
  expect_round_trip(box, self_distance_map(box, coarse));
  for (const ThicknessKind kind : {ThicknessKind::ray, ThicknessKind::ball}) {
    const SurfaceMap map = thickness_map(box, coarse, {.kind = kind});
    EXPECT_TRUE(map.error.empty());
    expect_round_trip(box, map);
  }
}

TEST(SurfaceMapRead, GivesBackJoinedChartsAndUnreferencedVertices) {
  BoxMap box(3, 5);
  expect_round_trip(box.mesh, box.map);
  box.mesh.vertices.push_back({std::nan(""), 0, HUGE_VAL});
  box.map.vertex_distance.push_back(std::nan(""));
  expect_round_trip(box.mesh, box.map);
}

/// The arrays of an .npz file. Tests change and rewrite them.
struct Arrays {
  struct Array {
    std::string name, dtype;
    std::vector<std::uint64_t> shape;
    std::vector<std::byte> bytes;
  };
  std::vector<Array> arrays;
  FileMetadata metadata;

  explicit Arrays(const std::filesystem::path& path) {
    const volume_io::FileSource source(path);
    volume_io::NpzReader npz(source);
    metadata = volume_io::from_json(npz.text("metadata"), "");
    for (const std::string& name : npz.arrays()) {
      if (name == "metadata") continue;
      arrays.push_back(npz.read(name, [&](volume_io::ByteStream& stream, const volume_io::NpyHeader& header) {
        Array out{name, std::string(volume_io::npy_dtype(header.type)), header.shape, {}};
        out.bytes.resize(header.count(name) * volume_io::scalar_size(header.type));
        volume_io::read_npy_raw(stream, header, out.bytes);
        return out;
      }));
    }
  }
  Array& operator[](const std::string& name) {
    return *std::find_if(arrays.begin(), arrays.end(), [&](const Array& one) { return one.name == name; });
  }
  template <class T>
  void put(const std::string& name, std::size_t place, T value) {
    std::memcpy((*this)[name].bytes.data() + place * sizeof(T), &value, sizeof(T));
  }
  template <class T>
  T get(const std::string& name, std::size_t place) {
    T value;
    std::memcpy(&value, (*this)[name].bytes.data() + place * sizeof(T), sizeof(T));
    return value;
  }
  void erase(const std::string& name) {
    std::erase_if(arrays, [&](const Array& one) { return one.name == name; });
  }
  void say(const std::string& key, const std::string& text) {
    std::erase_if(metadata, [&](const auto& pair) { return pair.first == key; });
    if (!text.empty()) metadata.emplace_back(key, text);
  }
  void write(const std::filesystem::path& path) const {
    const Context context;
    AtomicFile file(path);
    volume_io::FieldSink sink(1, context);
    volume_io::NpzWriter npz(file, sink, context);
    for (const Array& one : arrays) npz.add(one.name, one.dtype, one.shape, std::span<const std::byte>(one.bytes));
    npz.add_text("metadata", volume_io::to_json(metadata));
    npz.finish();
    file.commit();
  }
};

/// Changes the file of a box map and returns the message of its reader.
class SurfaceMapDamage : public ::testing::Test {
 protected:
  static constexpr std::size_t first_texel = std::size_t{BoxMap::gutter} * 3 * BoxMap::cell + BoxMap::gutter;
  TemporaryFolder folder_;

  std::string message_after(const std::function<void(Arrays&)>& change) {
    const BoxMap box(3);
    write_surface_map(folder_ / "good.npz", box.mesh, box.map);
    Arrays arrays(folder_ / "good.npz");
    change(arrays);
    arrays.write(folder_ / "bad.npz");
    try {
      (void)read_surface_map(folder_ / "bad.npz");
    } catch (const FormatError& error) {
      return error.what();
    }
    return "it was read";
  }
  void expect_refused(const char* words, const std::function<void(Arrays&)>& change) {
    const std::string message = message_after(change);
    EXPECT_NE(message.find(words), std::string::npos) << words << " is not in: " << message;
    EXPECT_NE(message.find("bad.npz"), std::string::npos) << message;
  }
};

TEST_F(SurfaceMapDamage, NoneMeansThatTheFileIsRead) {
  EXPECT_EQ(message_after([](Arrays&) {}), "it was read");
}

TEST_F(SurfaceMapDamage, OfArraysIsNamed) {
  for (const char* name : {"distance", "vertex_distance"}) {
    expect_refused("does not hold a surface map", [&](Arrays& a) { a.erase(name); });
  }
  for (const char* name : {"vector", "site", "triangle", "corners", "vertices", "triangles", "triangle_smallest",
                           "triangle_largest", "triangle_mean"}) {
    const std::string missing = std::string("no array '") + name + "'";
    expect_refused(missing.c_str(), [&](Arrays& a) { a.erase(name); });
  }
  for (const char* name : {"distance", "vector", "site", "triangle", "corners", "vertices", "triangles",
                           "vertex_distance", "triangle_error", "triangle_mean"}) {
    const std::string place = std::string("(") + name + ".npy)";
    expect_refused(place.c_str(), [&](Arrays& a) { a[name].shape.push_back(1); });
    expect_refused(place.c_str(), [&](Arrays& a) { a[name].shape[0] += 1; });
    expect_refused(place.c_str(), [&](Arrays& a) { a[name].dtype = a[name].dtype == "f4" ? "i4" : "f4"; });
    expect_refused(place.c_str(), [&](Arrays& a) {
      a[name].shape = {0};
      a[name].bytes.clear();
    });
  }
  expect_refused("(vector.npy): its shape is [96, 64, 3], but should be [64, 96, 3]",
                 [](Arrays& a) { std::swap(a["vector"].shape[0], a["vector"].shape[1]); });
  expect_refused("1 to 16384 texels a side", [](Arrays& a) {
    a["distance"].shape = {16385, 1};
    a["distance"].bytes.resize(std::size_t{4} * 16385);
  });
}

TEST_F(SurfaceMapDamage, OfNumbersIsNamed) {
  const double nan = std::nan("");
  expect_refused("texel in row 8, column 8: it is not a number",
                 [&](Arrays& a) { a.put("distance", first_texel, static_cast<float>(nan)); });
  expect_refused("row 0, column 1: it is a number, but", [](Arrays& a) { a.put("distance", 1, 2.0F); });
  expect_refused("(vector.npy): texel in row 0, column 2", [](Arrays& a) { a.put("vector", 7, HUGE_VALF); });
  expect_refused("(site.npy)", [](Arrays& a) { a.put("site", first_texel, std::int32_t{-2}); });
  expect_refused("triangle 12 is used, but there are only 12",
                 [](Arrays& a) { a.put("triangle", first_texel, std::int32_t{12}); });
  expect_refused("triangle -2 is used", [](Arrays& a) { a.put("triangle", first_texel, std::int32_t{-2}); });
  expect_refused("the chart of that triangle does not contain the texel",
                 [](Arrays& a) { a.put("triangle", first_texel, std::int32_t{11}); });
  expect_refused("the chart of that triangle has no area", [](Arrays& a) {
    for (const std::size_t c : {0U, 1U, 2U, 3U}) a.put("corners", 2 + c, a.get<double>("corners", c % 2));
  });
  for (const double place : {nan, -0.25, 96.25, HUGE_VAL}) {
    expect_refused("a corner of triangle 1 lies outside", [&](Arrays& a) { a.put("corners", 6, place); });
  }
  expect_refused("vertex", [&](Arrays& a) { a.put("vertices", 4, nan); });
  expect_refused("vertex", [](Arrays& a) { a.put("triangles", 3, std::int32_t{8}); });
  expect_refused("vertex", [](Arrays& a) { a.put("triangles", 3, std::int32_t{-1}); });
  expect_refused("triangle 2 is not a number of at least 0", [](Arrays& a) { a.put("triangle_error", 2, -1.0F); });
  expect_refused("triangle 2 is not a number of at least 0",
                 [&](Arrays& a) { a.put("triangle_error", 2, static_cast<float>(nan)); });
}

TEST_F(SurfaceMapDamage, OfMetadataIsNamed) {
  expect_refused("'quantity' is missing", [](Arrays& a) { a.say("quantity", ""); });
  expect_refused("'quantity' is not known: mine", [](Arrays& a) { a.say("quantity", "mine"); });
  expect_refused("'sign_rule' is not known", [](Arrays& a) { a.say("sign_rule", "mine"); });
}

TEST_F(SurfaceMapDamage, InfiniteDistancesAndMissingErrorsAreAccepted) {
  EXPECT_EQ(message_after([](Arrays& a) { a.put("distance", first_texel, -HUGE_VALF); }), "it was read");
  EXPECT_EQ(message_after([](Arrays& a) { a.erase("triangle_error"); }), "it was read");
  EXPECT_EQ(message_after([](Arrays& a) { a.say("separate_charts", ""); }), "it was read");
}

TEST(SurfaceMapRead, BytesThatAreCutOrChangedAreRefusedOrRead) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = make_box();
  write_surface_map(folder / "a.npz", mesh, self_distance_map(mesh, {.texel = 0.5}));
  const std::string good = test::file_content(folder / "a.npz");
  const auto feed = [](const std::string& bytes) {
    try {
      (void)read_surface_map(std::as_bytes(std::span(bytes)), "bytes");
      return true;
    } catch (const FormatError&) {
      return false;
    }
  };
  EXPECT_TRUE(feed(good));
  for (std::size_t size = 0; size < good.size(); size += 7) EXPECT_FALSE(feed(good.substr(0, size))) << size;
  std::mt19937 random(1);
  int refused = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string bytes = good;
    bytes[random() % bytes.size()] ^= static_cast<char>(1U << (random() % 8));
    if (!feed(bytes)) ++refused;
  }
  EXPECT_GT(refused, 2000);  // checksums detect changes in arrays
}

TEST(SurfaceMapRead, OtherFilesAreNotSurfaceMaps) {
  const TemporaryFolder folder;
  test::put_file(folder / "a.npz", "nonsense");
  const BoxMap box(3);
  write_surface_map(folder / "a.ply", box.mesh, box.map);
  EXPECT_FALSE(holds_surface_map(folder / "a.npz"));
  EXPECT_FALSE(holds_surface_map(folder / "a.ply"));
  EXPECT_FALSE(holds_surface_map(folder / "absent.npz"));
  EXPECT_THROW((void)read_surface_map(folder / "a.npz"), FormatError);
  EXPECT_THROW((void)read_surface_map(folder / "absent.npz"), FileError);
}

TEST(SurfaceMapRead, MetadataThatContradictTheMapAreRefused) {
  const TemporaryFolder folder;
  const BoxMap box(3);
  for (const char* key : {"quantity", "sign_rule", "separate_charts"}) {
    EXPECT_THROW(write_surface_map(folder / "a.npz", box.mesh, box.map, {{key, "mine"}}), InvalidOption) << key;
  }
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace blum
