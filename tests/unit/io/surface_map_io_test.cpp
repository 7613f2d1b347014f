// Proves that surface map files hold colours at any point of the surface, values of texels, vertices and triangles, and
// metadata. Maps that do not match the mesh are refused.
#include "blum/io/surface_map_io.hpp"
#include "blum/io/formats.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "blum/io/complex_io.hpp"
#include "blum/io/field_io.hpp"
#include "io/archive/numpy.hpp"
#include "io/text/json.hpp"
#include "support/surface_map_sample.hpp"
#include "unit/io/glb_bytes.hpp"
#include "unit/io/png_bytes.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

using test::BoxMap;
using test::ReadPng;
using test::TemporaryFolder;

ReadPng png_of(const std::string& bytes) {
  return test::read_png(std::as_bytes(std::span(bytes)));
}

std::array<int, 3> bytes_of(const Color& color) {
  return {byte_of(color.r), byte_of(color.g), byte_of(color.b)};
}

/// The largest difference of a component.
template <class A, class B>
double difference(const A& a, const B& b) {
  double largest = 0;
  for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(double(a[c]) - double(b[c])));
  return largest;
}

/// Reads a texture like glTF viewers: bilinear between the middles of texels, clamped at the border.
std::array<double, 3> look_up(const ReadPng& png, double u, double v) {
  const double x = u * png.width - 0.5;
  const double y = v * png.height - 0.5;
  std::array<double, 3> out{};
  for (int dy = 0; dy < 2; ++dy) {
    for (int dx = 0; dx < 2; ++dx) {
      const double weight = (dx == 0 ? 1 - (x - std::floor(x)) : x - std::floor(x)) *
                            (dy == 0 ? 1 - (y - std::floor(y)) : y - std::floor(y));
      const auto at_x = static_cast<std::size_t>(std::clamp(std::floor(x) + dx, 0.0, png.width - 1.0));
      const auto at_y = static_cast<std::size_t>(std::clamp(std::floor(y) + dy, 0.0, png.height - 1.0));
      for (std::size_t c = 0; c < 3; ++c) out[c] += weight * png.at(at_x, at_y)[c];
    }
  }
  return out;
}

/// True if reading between texels may give a colour. The bounds are the colours of all values that differ by at most
/// one texel's step. Colours are not linear in values, and jump at the limits of a screen.
bool is_between(const std::array<double, 3>& color, const ColorScale& scale, double value) {
  constexpr double step = 0.25;  // along both axes of a chart
  std::array<int, 3> lowest{255, 255, 255};
  std::array<int, 3> highest{0, 0, 0};
  for (int i = -16; i <= 16; ++i) {
    const std::array<int, 3> one = bytes_of(scale.color(value + i * step / 16));
    for (std::size_t c = 0; c < 3; ++c) {
      lowest[c] = std::min(lowest[c], one[c]);
      highest[c] = std::max(highest[c], one[c]);
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    if (color[c] < lowest[c] - 1 || color[c] > highest[c] + 1) return false;
  }
  return true;
}

/// Compares the texture of a .glb file with the values at points of the surface.
void check_lookups(const test::ReadGlb& glb, const BoxMap& box, const ColorScale& scale) {
  constexpr int rounds = 5000;
  double sum = 0;
  const ReadPng png = png_of(glb.view(glb.json["images"][0]["bufferView"]));
  const std::vector<float> positions = glb.attribute("POSITION");
  const std::vector<float> uv = glb.attribute("TEXCOORD_0");
  const std::vector<std::uint32_t> corners = glb.indices();
  ASSERT_EQ(corners.size(), 36U);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0, 1);
  for (int round = 0; round < rounds; ++round) {
    const std::size_t t = std::uniform_int_distribution<std::size_t>(0, 11)(random);
    std::array<double, 3> weights{part(random), part(random), 0};
    if (weights[0] + weights[1] > 1) weights = {1 - weights[0], 1 - weights[1], 0};
    weights[2] = 1 - weights[0] - weights[1];
    Vec3d point;
    double u = 0;
    double v = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t corner = corners[3 * t + k];
      const Vec3d place{positions[3 * corner], positions[3 * corner + 1], positions[3 * corner + 2]};
      point += place * weights[k];
      u += weights[k] * uv[2 * corner];
      v += weights[k] * uv[2 * corner + 1];
    }
    const std::array<double, 3> color = look_up(png, u, v);
    ASSERT_TRUE(is_between(color, scale, box.value_at(point)))
        << t << " at " << point.x << " " << point.y << " " << point.z;
    sum += difference(color, bytes_of(scale.color(box.value_at(point))));
  }
  EXPECT_LT(sum / rounds, 1.5);  // of 255; reading half a texel off gives 4.9 and more
}

TEST(SurfaceMapIo, TexturesGiveBackTheColourOfEveryPoint) {
  const TemporaryFolder folder;
  for (const double first : {3.0, 0.5}) {
    const BoxMap box(first);
    write_surface_map(folder / "a.glb", box.mesh, box.map);
    const ColorScale scale = color_scale_of(box.map);
    EXPECT_EQ(scale.diverges(), first < 2);
    check_lookups(test::ReadGlb(test::file_content(folder / "a.glb")), box, scale);
  }
}

TEST(SurfaceMapIo, GlbHasDistancesAtVerticesAndDescribesThem) {
  const TemporaryFolder folder;
  const BoxMap box(3);
  write_surface_map(folder / "a.glb", box.mesh, box.map, {{"source", "here"}}, {.range = {{1, 5}}, .units = "mm"});
  const test::ReadGlb glb(test::file_content(folder / "a.glb"));
  const std::vector<float> positions = glb.attribute("POSITION");
  const std::vector<float> distance = glb.attribute("_DISTANCE");
  EXPECT_EQ(distance.size(), 24U);  // each corner of the box in three charts
  for (std::size_t v = 0; v < distance.size(); ++v) {
    const Vec3d place{positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]};
    EXPECT_EQ(distance[v], static_cast<float>(box.value_at(place)));
  }
  const nlohmann::json& extras = glb.json["meshes"][0]["extras"];
  EXPECT_EQ(extras["source"], "here");
  EXPECT_EQ(extras["quantity"], "distance");
  EXPECT_EQ(extras["units"], "mm");
  EXPECT_EQ(extras["color_range"], (std::vector<double>{1, 5}));
  EXPECT_EQ(extras["colors"], "sequential");
  const auto range = finite_range(box.map).value();
  EXPECT_EQ(extras["range"], (std::vector<double>{range.first, range.second}));
  EXPECT_EQ(extras["largest_error"], "5.625");
}

TEST(SurfaceMapIo, PicturesHaveTexelsAsPixelsAndABar) {
  const TemporaryFolder folder;
  const BoxMap box(3, 2);
  write_surface_map(folder / "a.png", box.mesh, box.map, {}, {.units = "mm"});
  const ReadPng png = png_of(test::file_content(folder / "a.png"));
  const SurfaceAtlas& atlas = *box.map.atlas;
  ASSERT_GT(png.width, atlas.width + 40);
  const ColorScale scale = color_scale_of(box.map);
  for (std::size_t i = 0; i < atlas.size(); ++i) {
    if (!atlas.triangle[i].has_value()) continue;
    const Color color = scale.color(box.map.distance[i]);  // grey on the side without distances
    ASSERT_LE(difference(png.at(i % atlas.width, i / atlas.width), bytes_of(color)), 1) << i;
  }
  const auto ink_in = [&](std::size_t y0, std::size_t y1) {
    int ink = 0;
    for (std::size_t y = y0; y < y1; ++y) {
      for (std::size_t x = atlas.width + 20; x < png.width; ++x) ink += png.at(x, y)[0] < 100 ? 1 : 0;
    }
    return ink;
  };
  EXPECT_GT(ink_in(20, 40), 50);                // the title
  EXPECT_GT(ink_in(44, 144), 50);               // the numbers
  EXPECT_GT(ink_in(150, png.height - 10), 30);  // "none"
  EXPECT_LE(difference(png.at(atlas.width + 30, 44), bytes_of(scale.color(scale.highest()))), 4);
  EXPECT_LE(difference(png.at(atlas.width + 30, 143), bytes_of(scale.color(scale.lowest()))), 4);
}

TEST(SurfaceMapIo, NothingGreyOrWhiteBleedsIntoCharts) {
  const BoxMap box(3);
  const SurfaceAtlas& atlas = *box.map.atlas;
  const ColorTexture texture = color_texture(box.map, color_scale_of(box.map));
  ASSERT_EQ(texture.pixels.size(), 3 * atlas.size());
  const auto at = [&](std::size_t x, std::size_t y) {
    const std::uint8_t* const pixel = &texture.pixels[3 * (y * atlas.width + x)];
    return std::array<int, 3>{pixel[0], pixel[1], pixel[2]};
  };
  // Left of the first chart, its texels begin a texel before the chart. Four more texels have their colour.
  const std::size_t middle = BoxMap::gutter + BoxMap::side / 2;
  const std::array<int, 3> border = at(BoxMap::gutter - 1, middle);
  for (std::size_t away = 2; away <= 5; ++away) EXPECT_LE(difference(at(BoxMap::gutter - away, middle), border), 3);
  EXPECT_EQ(at(BoxMap::gutter - 6, middle), (std::array{255, 255, 255}));
}

TEST(SurfaceMapIo, NpzHoldsEverything) {
  const TemporaryFolder folder;
  const BoxMap box(3, 5);
  const SurfaceMap& map = box.map;
  write_surface_map(folder / "a.npz", box.mesh, map, {{"source", "here"}});
  const volume_io::FileSource source(folder / "a.npz");
  volume_io::NpzReader npz(source);
  const auto same = [&](const std::string& name, const std::vector<std::uint64_t>& shape, const auto& wanted) {
    npz.read(name, [&](volume_io::ByteStream& stream, const volume_io::NpyHeader& header) {
      EXPECT_EQ(header.shape, shape) << name;
      const std::span<const std::byte> bytes = std::as_bytes(std::span(wanted));
      std::vector<std::byte> found(bytes.size());
      volume_io::read_npy_raw(stream, header, found);
      EXPECT_TRUE(std::equal(found.begin(), found.end(), bytes.begin())) << name;
      return 0;
    });
  };
  const std::uint64_t h = map.atlas->height;
  const std::uint64_t w = map.atlas->width;
  same("distance", {h, w}, map.distance);
  same("vector", {h, w, 3}, map.vector);
  same("site", {h, w}, map.site);
  same("triangle", {h, w}, map.atlas->triangle);
  same("corners", {12, 3, 2}, map.atlas->corners);
  same("vertices", {8, 3}, box.mesh.vertices);
  same("triangles", {12, 3}, box.mesh.triangles);
  same("vertex_distance", {8}, map.vertex_distance);
  same("triangle_error", {12}, map.error);
  std::vector<float> mean;
  for (const auto& face : map.faces) mean.push_back(face.mean);
  same("triangle_mean", {12}, mean);
  const FileMetadata metadata = volume_io::from_json(npz.text("metadata"), "a.npz");
  EXPECT_EQ(find_value(metadata, "source"), "here");
  EXPECT_EQ(find_value(metadata, "content"), "surface map");
  // The file is neither a field nor a complex, although its arrays look similar.
  EXPECT_THROW((void)read_field(folder / "a.npz"), FormatError);
  EXPECT_THROW((void)read_complex(folder / "a.npz"), FormatError);
}

TEST(SurfaceMapIo, PlyAndVtpHaveColumnsOfVerticesAndTriangles) {
  const TemporaryFolder folder;
  BoxMap box(0.5);
  box.map.vertex_distance[3] = HUGE_VAL;
  for (const char* name : {"a.ply", "a.vtp"}) {
    write_surface_map(folder / name, box.mesh, box.map, {{"quantity", "mine"}}, {.units = "mm"});
    const ComplexFile file = read_complex(folder / name);
    EXPECT_EQ(file.complex.triangles, box.mesh.triangles);
    const auto distance = file.complex.vertex_columns.get<double>("distance");
    EXPECT_TRUE(std::equal(distance.begin(), distance.end(), box.map.vertex_distance.begin()));
    const auto error = file.complex.triangle_columns.get<float>("error");
    EXPECT_TRUE(std::equal(error.begin(), error.end(), box.map.error.begin()));
    for (std::size_t t = 0; t < 12; ++t) {
      EXPECT_EQ(file.complex.triangle_columns.get<float>("smallest")[t], box.map.faces[t].smallest);
      EXPECT_EQ(file.complex.triangle_columns.get<float>("largest")[t], box.map.faces[t].largest);
      EXPECT_EQ(file.complex.triangle_columns.get<float>("mean")[t], box.map.faces[t].mean);
    }
    EXPECT_EQ(find_value(file.metadata, "quantity"), "mine");
    EXPECT_EQ(find_value(file.metadata, "sign_rule"), "winding");
  }
  box.map.error.clear();  // maps of thickness have no error
  write_surface_map(folder / "a.ply", box.mesh, box.map);
  EXPECT_EQ(read_complex(folder / "a.ply").complex.triangle_columns.find("error"), nullptr);
}

TEST(SurfaceMapIo, ColoursOfMapsWithoutDistances) {
  const TemporaryFolder folder;
  BoxMap box(3);
  std::fill(box.map.distance.begin(), box.map.distance.end(), std::numeric_limits<float>::infinity());
  std::fill(box.map.vertex_distance.begin(), box.map.vertex_distance.end(), HUGE_VAL);
  EXPECT_EQ(finite_range(box.map), std::nullopt);
  EXPECT_EQ(color_scale_of(box.map).highest(), 1);
  for (const std::string& end : file_extensions(FileContent::surface_map, FileAccess::write)) {
    EXPECT_NO_THROW(write_surface_map(folder / ("a" + end), box.mesh, box.map)) << end;
  }
  const BoxMap depths(-5);  // all inside
  EXPECT_LT(color_scale_of(depths.map).lowest(), -7);
}

TEST(SurfaceMapIo, UnreferencedVerticesMayBeAnything) {
  const TemporaryFolder folder;
  BoxMap box(3);
  box.mesh.vertices.push_back({std::nan(""), 0, 0});
  box.map.vertex_distance.push_back(std::nan(""));
  for (const char* name : {"a.npz", "a.png", "a.glb"}) {
    EXPECT_NO_THROW(write_surface_map(folder / name, box.mesh, box.map)) << name;
  }
  EXPECT_EQ(test::ReadGlb(test::file_content(folder / "a.glb")).attribute("_DISTANCE").size(), 24U);
  box.mesh.vertices.back() = {9, 9, 9};
  for (const std::string& end : file_extensions(FileContent::surface_map, FileAccess::write)) {
    EXPECT_NO_THROW(write_surface_map(folder / ("b" + end), box.mesh, box.map)) << end;
  }
}

TEST(SurfaceMapIo, TheSameBytesForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const BoxMap box(0.5);
  for (const std::string& end : file_extensions(FileContent::surface_map, FileAccess::write)) {
    for (const int threads : {1, 3}) {
      Context context;
      context.threads = threads;
      write_surface_map(folder / (std::to_string(threads) + end), box.mesh, box.map, {}, {}, context);
    }
    EXPECT_EQ(test::file_content(folder / ("1" + end)), test::file_content(folder / ("3" + end))) << end;
  }
}

TEST(SurfaceMapIo, RefusesInvalidMapsOfTheMesh) {
  const TemporaryFolder folder;
  for (const std::string& end : file_extensions(FileContent::surface_map, FileAccess::write)) {
    const auto path = folder / ("a" + end);
    const auto refuses = [&]<class Error>(auto change, Error) {
      BoxMap box(3);
      change(box);
      EXPECT_THROW(write_surface_map(path, box.mesh, box.map), Error) << end;
    };
    const InvalidMesh error("");
    refuses([](BoxMap& box) { box.map.atlas = nullptr; }, error);
    refuses([](BoxMap& box) { box.mesh.triangles.pop_back(); }, error);
    refuses([](BoxMap& box) { box.mesh.triangles[0][0] = 8; }, error);
    refuses([](BoxMap& box) { box.mesh.vertices.emplace_back(); }, error);
    refuses([](BoxMap& box) { box.map.faces.pop_back(); }, error);
    refuses([](BoxMap& box) { box.map.error.pop_back(); }, error);
    refuses([](BoxMap& box) { box.map.distance = Buffer<float>(5); }, error);
    refuses([](BoxMap& box) { box.map.vector = {}; }, error);
    refuses([](BoxMap& box) { box.map.site = {}; }, error);
    const BoxMap box(3);
    const auto range_refused = [&](double first, double second) {
      EXPECT_THROW(write_surface_map(path, box.mesh, box.map, {}, {.range = {{first, second}}}), InvalidOption);
    };
    range_refused(1, 1);
    range_refused(2, 1);
    range_refused(0, HUGE_VAL);
    range_refused(std::nan(""), 1);
    EXPECT_THROW(write_surface_map(path, box.mesh, box.map, {{"a", "1"}, {"a", "2"}}), InvalidOption) << end;
    EXPECT_THROW(write_surface_map(path, box.mesh, box.map, {{"", "1"}}), InvalidOption) << end;
    EXPECT_THROW(write_surface_map(folder / "absent" / ("a" + end), box.mesh, box.map), FileError) << end;
    std::stop_source stop;
    stop.request_stop();
    Context stopped;
    stopped.cancel = stop.get_token();
    EXPECT_THROW(write_surface_map(path, box.mesh, box.map, {}, {}, stopped), Cancelled) << end;
  }
  const BoxMap box(3);
  EXPECT_THROW(write_surface_map(folder / "a.obj", box.mesh, box.map), InvalidOption);
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace blum
