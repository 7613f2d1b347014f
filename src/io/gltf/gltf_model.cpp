#include "io/gltf/gltf_model.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

#include "blum/core/exact_text.hpp"
#include "blum/core/ids.hpp"
#include "io/bytes/scalar_type.hpp"
#include "io/text/json.hpp"

namespace blum::gltf_files {
namespace {

constexpr double largest_float = std::numeric_limits<float>::max();

bool is_letter_or_digit(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

void check_attributes(const GltfMesh& mesh) {
  std::set<std::string_view> names;
  for (const GltfAttribute& attribute : mesh.attributes) {
    const std::string what = "the attribute '" + attribute.name + "' of a glTF file";
    const bool is_name = !attribute.name.empty() &&
                         std::all_of(attribute.name.begin(), attribute.name.end(),
                                     [](char c) { return is_letter_or_digit(c) || c == '_' || c == '-' || c == '.'; });
    if (!is_name) throw InvalidOption(what + ": names are made of letters, digits, '_', '-' and '.'");
    if (!names.insert(attribute.name).second) throw InvalidOption(what + " occurs twice");
    if (attribute.components < 1 || attribute.components > 4) {
      throw InvalidOption(what + " has " + std::to_string(attribute.components) +
                          " components, but glTF files hold 1 to 4");
    }
    if (attribute.values.size() != attribute.components * mesh.vertices.size()) {
      throw InvalidOption(what + " has " + std::to_string(attribute.values.size()) + " numbers, not " +
                          std::to_string(attribute.components) + " for each of " +
                          std::to_string(mesh.vertices.size()) + " vertices");
    }
  }
}

void check_coordinates(const GltfMesh& mesh) {
  if (mesh.texture_coordinates.empty()) {
    if (!mesh.texture.empty()) throw InvalidOption("a texture of a glTF file needs texture coordinates");
    return;
  }
  if (mesh.texture_coordinates.size() != mesh.triangles.size()) {
    throw InvalidOption("there are texture coordinates for " + std::to_string(mesh.texture_coordinates.size()) +
                        " triangles of a glTF file, not for " + std::to_string(mesh.triangles.size()));
  }
  if (!mesh.segments.empty() || !mesh.points.empty()) {
    throw InvalidOption("glTF files with texture coordinates hold triangles only, no segments and points");
  }
  for (std::size_t t = 0; t < mesh.texture_coordinates.size(); ++t) {
    for (const std::array<float, 2>& place : mesh.texture_coordinates[t]) {
      if (std::isfinite(place[0]) && std::isfinite(place[1])) continue;
      throw InvalidOption("a texture coordinate of triangle " + std::to_string(t) + " is not finite");
    }
  }
}

void check_texture(std::span<const std::byte> texture) {
  constexpr std::array<unsigned char, 8> signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  if (texture.empty()) return;
  if (texture.size() >= signature.size() && std::memcmp(texture.data(), signature.data(), signature.size()) == 0)
    return;
  throw InvalidOption("the texture of a glTF file is not a PNG file");
}

template <class Cells>
void check_corners(const Cells& cells, std::size_t vertices, const char* what) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (const std::uint32_t v : cells[i]) {
      if (v < vertices) continue;
      throw InvalidMesh(std::string(what) + " " + std::to_string(i) + " uses vertex " + std::to_string(v) +
                        ", but there are only " + std::to_string(vertices) + " vertices");
    }
  }
}

void check_mesh(const GltfMesh& mesh) {
  const std::size_t count = mesh.vertices.size();
  if (count > max_id_count) throw InvalidMesh("there are more than 2^31 - 1 vertices");
  check_corners(mesh.triangles, count, "triangle");
  check_corners(mesh.segments, count, "segment");
  for (const std::uint32_t point : mesh.points) {
    if (point >= count) throw InvalidMesh("a point uses vertex " + std::to_string(point) + ", which does not exist");
  }
  if (!mesh.normals.empty() && mesh.normals.size() != count) {
    throw InvalidOption("there are " + std::to_string(mesh.normals.size()) + " normals for " + std::to_string(count) +
                        " vertices of a glTF file");
  }
}

/// Returns the number of bytes that all parts of a mesh need in a file with `vertices` vertices.
std::uint64_t data_size(const GltfMesh& mesh, std::uint64_t vertices) {
  std::uint64_t of_vertex = 12 + (mesh.normals.empty() ? 0 : 12) + (mesh.texture_coordinates.empty() ? 0 : 8);
  for (const GltfAttribute& attribute : mesh.attributes) of_vertex += 4 * attribute.components;
  return of_vertex * vertices + 12 * mesh.triangles.size() + 8 * mesh.segments.size() + 4 * mesh.points.size() +
         mesh.texture.size();
}

void check_size(std::uint64_t bytes) {
  constexpr std::uint64_t room = std::uint64_t{1} << 20;  // room for the JSON description with its texts
  if (bytes <= most_bytes - room) return;
  throw FileError("a mesh with texture and attributes of " + count_text(bytes) +
                  " bytes does not fit into a binary glTF file, which has at most 2^32 - 1");
}

/// Returns the origin that is subtracted from a mesh's coordinates, so that float32 preserves the mesh's shape.
Vec3d origin_of(const Box3& box) {
  if (box.is_empty()) return {};
  const Vec3d center = box.lower * 0.5 + box.upper * 0.5;
  return length(center) > box.diagonal() ? center : Vec3d{};
}

gltf_library::Value value_of(const std::string& text) {
  return gltf_library::Value(volume_io::valid_utf8(text));
}

gltf_library::Value number_value(double number, const std::string& key) {
  if (std::isfinite(number)) return gltf_library::Value(number);
  throw InvalidOption("'" + key + "' of the extras of a glTF file is not finite");
}

gltf_library::Value extras_value(const GltfExtras& extras) {
  gltf_library::Value::Object object;
  for (const auto& extra : extras) {
    const std::string key = volume_io::valid_utf8(extra.first);
    if (key.empty() || object.contains(key)) {
      throw InvalidOption("the extras of a glTF file need distinct keys, but '" + key + "' is empty or occurs twice");
    }
    if (const auto* text = std::get_if<std::string>(&extra.second)) object[key] = value_of(*text);
    if (const auto* number = std::get_if<double>(&extra.second)) object[key] = number_value(*number, key);
    if (const auto* numbers = std::get_if<std::vector<double>>(&extra.second)) {
      gltf_library::Value::Array array;
      for (const double number : *numbers) array.push_back(number_value(number, key));
      object[key] = gltf_library::Value(array);
    }
  }
  return gltf_library::Value(object);
}

/// Builder of a model. It appends arrays to the model's buffer.
class ModelBuilder {
 public:
  ModelBuilder(const GltfMesh& mesh, const Context& context) : mesh_(mesh), context_(context) {
    if (!mesh.texture_coordinates.empty()) split_ = split_vertices(mesh.triangles, mesh.texture_coordinates);
    check_size(data_size(mesh, vertex_count()));
    model_.buffers.emplace_back();
    data().reserve(static_cast<std::size_t>(data_size(mesh, vertex_count())) + 64);
  }

  gltf_library::Model build() {
    model_.asset.version = "2.0";
    model_.asset.generator = "Blum";
    add_vertices();
    add_parts();
    if (!mesh_.texture.empty()) add_texture();
    add_scene();
    if (data().empty()) model_.buffers.clear();
    return std::move(model_);
  }

 private:
  [[nodiscard]] bool is_split() const { return !mesh_.texture_coordinates.empty(); }
  [[nodiscard]] std::size_t vertex_count() const { return is_split() ? split_.source.size() : mesh_.vertices.size(); }
  [[nodiscard]] std::size_t source_of(std::size_t vertex) const { return is_split() ? split_.source[vertex] : vertex; }
  [[nodiscard]] std::vector<unsigned char>& data() { return model_.buffers.front().data; }

  /// @param target  purpose of the bytes, a constant of glTF; 0 for pictures.
  int add_view(std::span<const std::byte> bytes, int target) {
    throw_if_cancelled(context_);
    data().resize((data().size() + 3) / 4 * 4);
    gltf_library::BufferView view;
    view.buffer = 0;
    view.byteOffset = data().size();
    view.byteLength = bytes.size();
    view.target = target;
    const auto* const begin = reinterpret_cast<const unsigned char*>(bytes.data());
    data().insert(data().end(), begin, begin + bytes.size());
    if (target != 0) {  // the bytes are 32-bit numbers
      const auto written = std::as_writable_bytes(std::span(data())).subspan(view.byteOffset);
      volume_io::to_native(written, volume_io::ScalarType::u32, std::endian::little);
    }
    model_.bufferViews.push_back(std::move(view));
    return static_cast<int>(model_.bufferViews.size()) - 1;
  }

  gltf_library::Accessor& add_accessor(int view, int component_type, int type, std::size_t count) {
    gltf_library::Accessor accessor;
    accessor.bufferView = view;
    accessor.componentType = component_type;
    accessor.type = type;
    accessor.count = count;
    return model_.accessors.emplace_back(std::move(accessor));
  }
  [[nodiscard]] int last_accessor() const { return static_cast<int>(model_.accessors.size()) - 1; }

  /// Adds numbers with a name for the vertices, `components` for each vertex.
  gltf_library::Accessor& add_floats(const std::string& name, std::span<const float> numbers, int components) {
    constexpr std::array types{0, TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4};
    const int view = add_view(std::as_bytes(numbers), TINYGLTF_TARGET_ARRAY_BUFFER);
    gltf_library::Accessor& accessor =
        add_accessor(view, TINYGLTF_COMPONENT_TYPE_FLOAT, types[static_cast<std::size_t>(components)],
                     numbers.size() / static_cast<std::size_t>(components));
    attributes_[name] = last_accessor();
    return accessor;
  }

  void add_vertices() {
    if (vertex_count() == 0) return;
    add_positions();
    if (!mesh_.normals.empty()) add_normals();
    if (is_split()) {
      std::vector<float> places;
      for (const auto& place : split_.coordinates) places.insert(places.end(), place.begin(), place.end());
      add_floats("TEXCOORD_0", places, 2);
    }
    for (const GltfAttribute& attribute : mesh_.attributes) add_attribute(attribute);
  }

  void add_positions() {
    Box3 box;
    for (std::size_t v = 0; v < vertex_count(); ++v) {
      const Vec3d& place = mesh_.vertices[source_of(v)];
      if (!is_finite(place)) throw InvalidMesh("vertex " + std::to_string(source_of(v)) + " is not finite");
      box.extend(place);
    }
    origin_ = origin_of(box);
    std::vector<float> places;
    places.reserve(3 * vertex_count());
    std::vector<double> lower(3, HUGE_VAL);
    std::vector<double> upper(3, -HUGE_VAL);
    for (std::size_t v = 0; v < vertex_count(); ++v) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double place = mesh_.vertices[source_of(v)][axis] - origin_[axis];
        if (!(std::abs(place) <= largest_float)) {
          throw InvalidMesh("vertex " + std::to_string(source_of(v)) +
                            " is beyond single precision, in which glTF files hold positions");
        }
        places.push_back(static_cast<float>(place));
        lower[axis] = std::min(lower[axis], double{places.back()});
        upper[axis] = std::max(upper[axis], double{places.back()});
      }
    }
    gltf_library::Accessor& accessor = add_floats("POSITION", places, 3);
    accessor.minValues = lower;
    accessor.maxValues = upper;
  }

  void add_normals() {
    std::vector<float> normals;
    normals.reserve(3 * vertex_count());
    for (std::size_t v = 0; v < vertex_count(); ++v) {
      const Vec3f given = mesh_.normals[source_of(v)];
      const Vec3d normal{given.x, given.y, given.z};
      const double size = length(normal);
      if (!(size > 0 && std::isfinite(size))) {
        throw InvalidOption("the normal of vertex " + std::to_string(source_of(v)) + " has no direction");
      }
      for (std::size_t axis = 0; axis < 3; ++axis) normals.push_back(static_cast<float>(normal[axis] / size));
    }
    add_floats("NORMAL", normals, 3);
  }

  void add_attribute(const GltfAttribute& attribute) {
    std::vector<float> numbers;
    numbers.reserve(attribute.components * vertex_count());
    for (std::size_t v = 0; v < vertex_count(); ++v) {
      for (std::size_t i = 0; i < attribute.components; ++i) {
        const float number = attribute.values[source_of(v) * attribute.components + i];
        const float largest = std::numeric_limits<float>::max();
        numbers.push_back(std::isfinite(number) ? number : number < 0 ? -largest : largest);
      }
    }
    add_floats("_" + attribute.name, numbers, static_cast<int>(attribute.components));
  }

  /// Adds a part of the mesh: points, lines or triangles, given by vertex indices.
  /// @param mode  kind of the part, a constant of glTF.
  gltf_library::Primitive* add_part(std::span<const std::byte> indices, int mode) {
    if (indices.empty()) return nullptr;
    const int view = add_view(indices, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    add_accessor(view, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                 indices.size() / sizeof(std::uint32_t));
    gltf_library::Primitive part;
    part.attributes = attributes_;
    part.indices = last_accessor();
    part.mode = mode;
    return &shown_.primitives.emplace_back(std::move(part));
  }

  void add_parts() {
    const std::span<const Triangle> triangles =
        is_split() ? std::span<const Triangle>(split_.triangles) : mesh_.triangles;
    if (auto* part = add_part(std::as_bytes(triangles), TINYGLTF_MODE_TRIANGLES)) {
      part->material = 0;
      gltf_library::Material material;
      material.doubleSided = true;
      material.pbrMetallicRoughness.metallicFactor = 0;
      material.pbrMetallicRoughness.roughnessFactor = 0.9;
      model_.materials.push_back(std::move(material));
    }
    add_part(std::as_bytes(mesh_.segments), TINYGLTF_MODE_LINE);
    add_part(std::as_bytes(mesh_.points), TINYGLTF_MODE_POINTS);
  }

  void add_texture() {
    gltf_library::Image image;
    image.mimeType = "image/png";
    image.bufferView = add_view(mesh_.texture, 0);
    model_.images.push_back(std::move(image));
    gltf_library::Sampler sampler;
    sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
    sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
    sampler.wrapS = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    sampler.wrapT = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    model_.samplers.push_back(std::move(sampler));
    gltf_library::Texture texture;
    texture.source = 0;
    texture.sampler = 0;
    model_.textures.push_back(std::move(texture));
    gltf_library::Material& material = model_.materials.front();
    material.pbrMetallicRoughness.baseColorTexture.index = 0;
    material.extensions["KHR_materials_unlit"] = gltf_library::Value(gltf_library::Value::Object());
    model_.extensionsUsed.emplace_back("KHR_materials_unlit");
  }

  void add_scene() {
    gltf_library::Node node;
    gltf_library::Scene scene;
    node.name = "empty";  // tinygltf writes null for an empty node
    if (!shown_.primitives.empty()) {
      shown_.name = volume_io::valid_utf8(mesh_.name);
      if (!mesh_.extras.empty()) shown_.extras = extras_value(mesh_.extras);
      node.mesh = 0;
      node.name = shown_.name;
      if (origin_ != Vec3d{}) node.translation = {origin_.x, origin_.y, origin_.z};
      model_.meshes.push_back(std::move(shown_));
    }
    model_.nodes.push_back(std::move(node));
    scene.nodes = {0};
    model_.scenes.push_back(std::move(scene));
    model_.defaultScene = 0;
  }

  const GltfMesh& mesh_;
  const Context& context_;
  SplitVertices split_;
  gltf_library::Model model_;
  gltf_library::Mesh shown_;
  std::map<std::string, int> attributes_;  ///< indices of accessors, by name
  Vec3d origin_;
};
static_assert(sizeof(Triangle) == 3 * sizeof(std::uint32_t));

}  // namespace

gltf_library::Model model_of(const GltfMesh& mesh, const Context& context) {
  check_size(data_size(mesh, 0));
  check_mesh(mesh);
  check_attributes(mesh);
  check_coordinates(mesh);
  check_texture(mesh.texture);
  return ModelBuilder(mesh, context).build();
}

namespace {

struct Key {
  std::uint32_t vertex = 0;
  std::array<std::uint32_t, 2> place{};  ///< bits of the two coordinates
  friend bool operator==(const Key&, const Key&) = default;
};

struct KeyHash {
  std::size_t operator()(const Key& key) const {
    std::uint64_t hash = key.vertex;
    for (const std::uint32_t part : key.place) {
      hash = (hash ^ part) * 0x9e3779b97f4a7c15U;
      hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash);
  }
};

std::uint32_t bits_of(float coordinate) {
  return std::bit_cast<std::uint32_t>(coordinate == 0 ? 0.0F : coordinate);  // so that +0 and -0 are equal
}

}  // namespace

SplitVertices split_vertices(std::span<const Triangle> triangles, std::span<const TextureCorners> coordinates) {
  SplitVertices out;
  out.triangles.reserve(triangles.size());
  std::unordered_map<Key, std::uint32_t, KeyHash> known;
  known.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<float, 2>& place = coordinates[t][k];
      const Key key{triangles[t][k], {bits_of(place[0]), bits_of(place[1])}};
      const auto [found, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(out.source.size()));
      if (is_new) {
        out.source.push_back(key.vertex);
        out.coordinates.push_back(place);
      }
      corners[k] = found->second;
    }
    out.triangles.push_back(corners);
  }
  return out;
}

}  // namespace blum::gltf_files
