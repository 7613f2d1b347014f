#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/io/formats.hpp"
#include "io/archive/numpy.hpp"
#include "io/surface_map/surface_map_files.hpp"
#include "io/text/json.hpp"

namespace blum::surface_map_files {
namespace {

using volume_io::NpzWriter;

std::uint64_t data_size(const MeshView& mesh, const SurfaceMap& map) {
  return 24 * map.atlas->size() + 32 * mesh.vertices.size() + (48 + 12 + 16) * mesh.triangles.size();
}

void add_texels(NpzWriter& npz, const SurfaceMap& map) {
  const SurfaceAtlas& atlas = *map.atlas;
  const std::vector<std::uint64_t> shape{atlas.height, atlas.width};
  npz.add("distance", "f4", shape, map.distance.span());
  npz.add("vector", "f4", {atlas.height, atlas.width, 3}, map.vector.span());
  npz.add("site", "i4", shape, map.site.span());
  npz.add("triangle", "i4", shape, atlas.triangle.span());
}

void add_mesh(NpzWriter& npz, const MeshView& mesh, const SurfaceMap& map) {
  using Corners = std::array<TexturePlace, 3>;
  static_assert(sizeof(Corners) == 6 * sizeof(double) && sizeof(Vec3d) == 3 * sizeof(double));
  static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(SiteId) == 4 && sizeof(TriangleId) == 4);
  npz.add("corners", "f8", {map.atlas->corners.size(), 3, 2}, std::span<const Corners>(map.atlas->corners));
  npz.add("vertices", "f8", {mesh.vertices.size(), 3}, mesh.vertices);
  npz.add("triangles", "i4", {mesh.triangles.size(), 3}, mesh.triangles);
  npz.add("vertex_distance", "f8", {map.vertex_distance.size()}, std::span<const double>(map.vertex_distance));
}

void add_summaries(NpzWriter& npz, const SurfaceMap& map) {
  const auto add = [&](const std::string& name, float SurfaceMap::FaceSummary::* part) {
    std::vector<float> numbers;
    numbers.reserve(map.faces.size());
    for (const SurfaceMap::FaceSummary& face : map.faces) numbers.push_back(face.*part);
    npz.add("triangle_" + name, "f4", {numbers.size()}, std::span<const float>(numbers));
  };
  if (!map.error.empty()) npz.add("triangle_error", "f4", {map.error.size()}, std::span<const float>(map.error));
  add("smallest", &SurfaceMap::FaceSummary::smallest);
  add("largest", &SurfaceMap::FaceSummary::largest);
  add("mean", &SurfaceMap::FaceSummary::mean);
}

/// Returns the metadata of the file. The values that readers use are taken from the map.
FileMetadata own_metadata(const Request& request) {
  FileMetadata out = request.metadata;
  const auto keep = [&](std::string_view key, std::string_view text) {
    const std::string_view given = find_value(out, key);
    if (given.empty()) out.emplace_back(key, text);
    if (given.empty() || given == text) return;
    throw InvalidOption("the metadata give '" + std::string(given) + "' as " + std::string(key) +
                        ", but the map has '" + std::string(text) + "'; .npz files must agree with the map");
  };
  keep("quantity", to_string(request.map.quantity));
  keep("sign_rule", to_string(request.map.sign_rule));
  keep(separate_key, request.map.atlas->is_separate ? "true" : "false");
  return out;
}

}  // namespace

void write_npz(const Request& request) {
  const FileMetadata metadata = own_metadata(request);
  AtomicFile file(request.path);
  volume_io::FieldSink sink(data_size(request.mesh, request.map), request.context);
  NpzWriter npz(file, sink, request.context);
  add_texels(npz, request.map);
  add_mesh(npz, request.mesh, request.map);
  add_summaries(npz, request.map);
  npz.add_text("metadata", volume_io::to_json(metadata));
  npz.finish();
  file.commit();
}

}  // namespace blum::surface_map_files

namespace blum {
namespace surface_map_files {
namespace {

using volume_io::ByteSource;
using volume_io::ByteStream;
using volume_io::NpyHeader;
using volume_io::NpzReader;
using volume_io::ScalarType;

using Shape = std::vector<std::uint64_t>;

/// Largest side of a texture in texels, as in write_surface_map().
constexpr std::uint64_t most_a_side = 16384;
/// Largest number of arrays. It leaves room for arrays added by others, as many as the writer's.
constexpr std::size_t most_arrays = 64;
/// Interpolation uses texels whose centres are at most this far outside of a chart, along x and along y, in texels. It
/// includes rounding.
constexpr double reading_reach = 1 + 1e-6;

std::string shape_text(const Shape& shape) {
  std::string out = "[";
  for (const std::uint64_t n : shape) out += (out.size() > 1 ? ", " : "") + std::to_string(n);
  return out + "]";
}

std::string_view type_text(ScalarType type) {
  return type == ScalarType::f32 ? "float32" : type == ScalarType::f64 ? "float64" : "int32";
}

class Reader {
 public:
  explicit Reader(const ByteSource& source) : source_(source), npz_(source) {}

  SurfaceMapFile read() {
    check_archive();
    if (npz_.has("metadata")) file_.metadata = volume_io::from_json(npz_.text("metadata"), source_.name());
    read_metadata();
    read_texels();
    read_mesh();
    read_summaries();
    check_texels();
    file_.map.atlas = std::move(atlas_);
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& array, const std::string& reason) const {
    throw FormatError(source_.name() + "(" + array + ".npy): " + reason);
  }

  void check_archive() const {
    if (!npz_.has("vertex_distance") || !npz_.has("distance")) {
      throw FormatError(source_.name() +
                        ": it does not hold a surface map, which has the arrays 'distance' and 'vertex_distance'");
    }
    if (npz_.arrays().size() > most_arrays) throw FormatError(source_.name() + ": it has too many arrays");
    // Throw if entries overlap, because reading them could exhaust memory.
    if (npz_.packed_size() > source_.size()) {
      throw FormatError(source_.name() + ": its entries have more bytes than the file; it is damaged");
    }
  }

  /// @param shape  required shape. An entry 0 allows any length, and receives it.
  template <class Items>
  Items array(const std::string& name, ScalarType type, Shape& shape) {
    return npz_.read(name, [&](ByteStream& stream, const NpyHeader& header) {
      const bool fits = header.shape.size() == shape.size() &&
                        std::equal(shape.begin(), shape.end(), header.shape.begin(),
                                   [](std::uint64_t wanted, std::uint64_t n) { return wanted == n || wanted == 0; });
      if (!fits) fail(name, "its shape is " + shape_text(header.shape) + wanted_text(shape));
      const std::uint64_t count = volume_io::check_npy_values(stream, header);
      if (header.type != type) fail(name, "its numbers must be " + std::string(type_text(type)));
      if (header.fortran && shape.size() > 1) fail(name, "it is in Fortran order; C order is read");
      shape = header.shape;
      using Item = std::remove_cvref_t<decltype(*std::declval<Items&>().begin())>;
      static_assert(std::is_trivially_copyable_v<Item>);
      const std::size_t size = static_cast<std::size_t>(count) * volume_io::scalar_size(type);
      Items items(size / sizeof(Item));
      volume_io::read_npy_raw(stream, header, std::as_writable_bytes(std::span(items.data(), items.size())));
      return items;
    });
  }
  template <class Items>
  Items array_of(const std::string& name, ScalarType type, Shape shape) {
    if (std::find(shape.begin(), shape.end(), 0U) != shape.end()) fail(name, "the map has no elements for this array");
    return array<Items>(name, type, shape);
  }
  static std::string wanted_text(const Shape& shape) {
    if (std::find(shape.begin(), shape.end(), 0U) == shape.end()) return ", but should be " + shape_text(shape);
    return ", but should have " + std::to_string(shape.size()) + " axes" +
           (shape.back() != 0 ? ", the last of " + std::to_string(shape.back()) : "");
  }

  void read_metadata() {
    SurfaceMap& map = file_.map;
    const auto choose = [&]<class Enum>(const char* key, Enum& value) {
      const std::string_view text = find_value(file_.metadata, key);
      for (const auto& [choice, name] : Description<Enum>::values) {
        if (name != text) continue;
        value = choice;
        return;
      }
      fail("metadata",
           "'" + std::string(key) + "' is " + (text.empty() ? "missing" : "not known: " + std::string(text)));
    };
    choose("quantity", map.quantity);
    choose("sign_rule", map.sign_rule);
    map.sign_reason = std::string(find_value(file_.metadata, "sign_reason"));
    atlas_->is_separate = find_value(file_.metadata, separate_key) == "true";
  }

  void read_texels() {
    SurfaceMap& map = file_.map;
    Shape shape{0, 0};
    map.distance = array<Buffer<float>>("distance", ScalarType::f32, shape);
    if (map.distance.empty() || shape[0] > most_a_side || shape[1] > most_a_side) {
      fail("distance", "its shape is " + shape_text(shape) + "; a map has 1 to 16384 texels a side");
    }
    atlas_->height = static_cast<std::uint32_t>(shape[0]);
    atlas_->width = static_cast<std::uint32_t>(shape[1]);
    map.vector = array_of<Buffer<Vec3f>>("vector", ScalarType::f32, {shape[0], shape[1], 3});
    map.site = array_of<Buffer<SiteId>>("site", ScalarType::i32, shape);
    atlas_->triangle = array_of<Buffer<TriangleId>>("triangle", ScalarType::i32, shape);
  }

  void read_mesh() {
    TriangleMesh& mesh = file_.mesh;
    Shape corners{0, 3, 2};
    atlas_->corners = array<std::vector<std::array<TexturePlace, 3>>>("corners", ScalarType::f64, corners);
    if (atlas_->corners.empty()) fail("corners", "there are no triangles");
    for (std::size_t t = 0; t < atlas_->corners.size(); ++t) {
      for (const TexturePlace& at : atlas_->corners[t]) {
        if (at.x >= 0 && at.y >= 0 && at.x <= atlas_->width && at.y <= atlas_->height) continue;
        fail("corners", "a corner of triangle " + std::to_string(t) + " lies outside of the texture");
      }
    }
    Shape vertices{0, 3};
    mesh.vertices = array<std::vector<Vec3d>>("vertices", ScalarType::f64, vertices);
    mesh.triangles = array_of<std::vector<Triangle>>("triangles", ScalarType::i32, {corners[0], 3});
    try {
      validate(mesh);
    } catch (const InvalidMesh& error) {
      throw FormatError(source_.name() + ": " + error.what());
    }
    file_.map.vertex_distance = array_of<std::vector<double>>("vertex_distance", ScalarType::f64, {vertices[0]});
  }

  void read_summaries() {
    SurfaceMap& map = file_.map;
    const Shape shape{file_.mesh.triangles.size()};
    map.faces.resize(file_.mesh.triangles.size());
    const auto read = [&](const std::string& name, float SurfaceMap::FaceSummary::* part) {
      const auto numbers = array_of<std::vector<float>>("triangle_" + name, ScalarType::f32, shape);
      for (std::size_t t = 0; t < numbers.size(); ++t) map.faces[t].*part = numbers[t];
    };
    read("smallest", &SurfaceMap::FaceSummary::smallest);
    read("largest", &SurfaceMap::FaceSummary::largest);
    read("mean", &SurfaceMap::FaceSummary::mean);
    if (!npz_.has("triangle_error")) return;
    map.error = array_of<std::vector<float>>("triangle_error", ScalarType::f32, shape);
    for (std::size_t t = 0; t < map.error.size(); ++t) {
      if (!(map.error[t] >= 0))
        fail("triangle_error", "the error of triangle " + std::to_string(t) + " is not a number of at least 0");
    }
  }

  void check_texels() const {
    const SurfaceMap& map = file_.map;
    for (std::size_t i = 0; i < map.distance.size(); ++i) {
      const TriangleId triangle = atlas_->triangle[i];
      const auto refuse = [&](const char* array, const std::string& reason) {
        fail(array, "texel in row " + std::to_string(i / atlas_->width) + ", column " +
                        std::to_string(i % atlas_->width) + ": " + reason);
      };
      if (map.site[i].has_value() && map.site[i].value > max_id_count) refuse("site", "it is neither an index nor -1");
      const Vec3f& v = map.vector[i];
      if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) refuse("vector", "it is not finite");
      if (!triangle.has_value()) {
        if (!std::isnan(map.distance[i])) refuse("distance", "it is a number, but the texel belongs to no triangle");
        continue;
      }
      if (triangle.value >= atlas_->corners.size()) {
        refuse("triangle", "triangle " + std::to_string(static_cast<std::int32_t>(triangle.value)) +
                               " is used, but there are only " + std::to_string(atlas_->corners.size()) + " triangles");
      }
      if (std::isnan(map.distance[i])) refuse("distance", "it is not a number");
      if (!has_area(triangle.value)) {
        refuse("triangle", "the chart of that triangle has no area");
      }
      if (!may_read(triangle.value, i)) refuse("triangle", "the chart of that triangle does not contain the texel");
    }
  }

  [[nodiscard]] bool has_area(std::uint32_t triangle) const {
    const auto& [a, b, c] = atlas_->corners[triangle];
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y) != 0;
  }
  /// Returns true if interpolation in a triangle's chart may use a texel.
  [[nodiscard]] bool may_read(std::uint32_t triangle, std::size_t texel) const {
    const auto& [a, b, c] = atlas_->corners[triangle];
    const double x = static_cast<double>(texel % atlas_->width) + 0.5;
    const double y = static_cast<double>(texel / atlas_->width) + 0.5;  // NOLINT: whole on purpose
    return x >= std::min({a.x, b.x, c.x}) - reading_reach && x <= std::max({a.x, b.x, c.x}) + reading_reach &&
           y >= std::min({a.y, b.y, c.y}) - reading_reach && y <= std::max({a.y, b.y, c.y}) + reading_reach;
  }

  const ByteSource& source_;
  NpzReader npz_;
  SurfaceMapFile file_;
  std::shared_ptr<SurfaceAtlas> atlas_ = std::make_shared<SurfaceAtlas>();
};

SurfaceMapFile read_from(const ByteSource& source) {
  try {
    return Reader(source).read();
  } catch (const std::bad_alloc&) {
    throw OutOfMemory("not enough memory to read '" + source.name() + "'");
  }
}

}  // namespace
}  // namespace surface_map_files

SurfaceMapFile read_surface_map(const std::filesystem::path& path) {
  return surface_map_files::read_from(volume_io::FileSource(path));
}

SurfaceMapFile read_surface_map(std::span<const std::byte> bytes, const std::string& name) {
  return surface_map_files::read_from(volume_io::MemorySource(bytes, name));
}

bool holds_surface_map(const std::filesystem::path& path) {
  std::error_code ignored;
  if (file_extension(path) != ".npz") return false;
  if (!std::filesystem::is_regular_file(path, ignored) && !is_pipe(path)) return false;
  try {
    const volume_io::FileSource source(path, volume_io::PipeUse::keep);
    const volume_io::NpzReader npz(source);
    return npz.has("distance") && npz.has("vertex_distance");
  } catch (const Error&) {
    return false;
  }
}

}  // namespace blum
