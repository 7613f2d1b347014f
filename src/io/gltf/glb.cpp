// Meshes and complexes as binary glTF. Readers of glTF would have to know scenes, skins and compressed data; what Blum
// writes needs none of it, and is in .ply and .npz files in double precision.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/gltf_io.hpp"
#include "io/complex/complex_files.hpp"
#include "io/complex/edge_set.hpp"
#include "io/format_table.hpp"

namespace blum {
namespace {

void write_mesh_glb(const std::filesystem::path& path, const MeshView& mesh) {
  GltfMesh shown;
  shown.vertices = mesh.vertices;
  shown.triangles = mesh.triangles;
  shown.segments = mesh.segments;
  shown.points = mesh.points;
  write_gltf(path, shown);
}

}  // namespace

namespace complex_files {
namespace {

constexpr std::int64_t largest_whole = std::int64_t{1} << 24;  // single precision holds all up to it
constexpr std::size_t most_components = 4;

bool holds_whole_numbers(const Column& column) {
  return std::visit(
      []<class T>(const std::vector<T>& values) {
        if constexpr (std::is_floating_point_v<T>) {
          return true;
        } else {
          return std::all_of(values.begin(), values.end(), [](T value) {
            return static_cast<std::int64_t>(value) >= -largest_whole &&
                   static_cast<std::int64_t>(value) <= largest_whole;
          });
        }
      },
      column.values);
}

std::vector<float> floats_of(const Column& column) {
  return std::visit(
      [](const auto& values) {
        std::vector<float> out;
        out.reserve(values.size());
        for (const auto value : values) out.push_back(static_cast<float>(value));
        return out;
      },
      column.values);
}

std::string upper_case(std::string text) {
  for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return text;
}

/// The names of columns in a file: in upper case, as glTF's own are, where they differ then.
std::vector<std::string> attribute_names(const Columns& columns) {
  std::map<std::string, int> counts;
  for (const Column& column : columns) ++counts[upper_case(column.name)];
  std::vector<std::string> names;
  for (const Column& column : columns) {
    const std::string upper = upper_case(column.name);
    names.push_back(counts[upper] == 1 ? upper : column.name);
  }
  return names;
}

/// @throws InvalidOption naming what the file would not hold, unless the options allow it.
void refuse_glb_loss(const std::filesystem::path& path, const Complex& complex, const ComplexWriteOptions& options) {
  if (options.allow_loss) return;
  std::string lost;
  const auto lose = [&](const std::string& what) { lost += (lost.empty() ? "" : ", ") + what; };
  for (const Column& column : complex.vertex_columns) {
    if (column.components > most_components) lose("column '" + column.name + "' of more than four components");
    if (!holds_whole_numbers(column)) lose("column '" + column.name + "' of whole numbers beyond 2^24");
  }
  for (const Column& column : complex.edge_columns) lose("column '" + column.name + "' of edges");
  for (const Column& column : complex.triangle_columns) lose("column '" + column.name + "' of triangles");
  if (lost.empty()) return;
  throw InvalidOption("'" + path.string() + "': GLB files do not hold " + lost +
                      "; write .vtp, .ply or .npz, or allow the loss");
}

}  // namespace

void write_glb(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions& options, const Context& context) {
  refuse_glb_loss(path, complex, options);
  const std::vector<std::uint32_t> isolated = isolated_vertices(complex.view());
  GltfMesh shown;
  shown.vertices = complex.positions;
  shown.triangles = complex.triangles;
  shown.segments = complex.edges;
  shown.points = isolated;
  const std::vector<std::string> names = attribute_names(complex.vertex_columns);
  std::vector<std::vector<float>> numbers;
  numbers.reserve(names.size());
  std::size_t next = 0;
  for (const Column& column : complex.vertex_columns) {
    const std::string& name = names[next++];
    if (column.components > most_components || column.rows() == 0) continue;
    numbers.push_back(floats_of(column));
    shown.attributes.push_back({name, column.components, numbers.back()});
  }
  for (const auto& pair : metadata) shown.extras.emplace_back(pair.first, pair.second);
  write_gltf(path, shown, context);
}

}  // namespace complex_files

namespace formats {

constinit const MeshCode mesh_glb{nullptr, write_mesh_glb};
constinit const ComplexCode complex_glb{nullptr, nullptr, complex_files::write_glb};

}  // namespace formats
}  // namespace blum
