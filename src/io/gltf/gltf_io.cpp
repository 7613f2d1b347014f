#include "blum/io/gltf_io.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <new>
#include <ostream>
#include <streambuf>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/atomic_file.hpp"
#include "io/complex/complex_files.hpp"
#include "io/format_table.hpp"
#include "io/gltf/gltf_model.hpp"
#include "io/text/row_writer.hpp"

namespace blum {
namespace {

using Put = std::function<void(std::span<const std::byte>)>;

/// Stream buffer that passes all written bytes to a function.
class PutBuffer : public std::streambuf {
 public:
  explicit PutBuffer(Put put) : put_(std::move(put)) {}

 protected:
  std::streamsize xsputn(const char* text, std::streamsize count) override {
    put_(std::as_bytes(std::span(text, static_cast<std::size_t>(count))));
    return count;
  }
  int_type overflow(int_type character) override {
    if (traits_type::eq_int_type(character, traits_type::eof())) return traits_type::not_eof(character);
    const char one = traits_type::to_char_type(character);
    put_(std::as_bytes(std::span(&one, 1)));
    return character;
  }

 private:
  Put put_;
};

std::uint64_t size_of(const gltf_library::Model& model) {
  return model.buffers.empty() ? 0 : model.buffers.front().data.size();
}

/// @param put  receives the bytes of the file, one piece after the other. Its exceptions are rethrown.
void write_model(const gltf_library::Model& model, const Put& put) {
  PutBuffer buffer(put);
  std::ostream stream(&buffer);
  stream.exceptions(std::ios::badbit);
  gltf_library::TinyGLTF library;
  if (!library.WriteGltfSceneToStream(&model, stream, false, true)) {
    throw FileError("the library tinygltf failed to write the mesh");
  }
}

template <class Use>
void with_model(const GltfMesh& mesh, const Context& context, Use use) {
  try {
    use(gltf_files::model_of(mesh, context));
  } catch (const std::bad_alloc&) {
    throw OutOfMemory("not enough memory to write a mesh as glTF");
  }
}

}  // namespace

void write_gltf(const std::filesystem::path& path, const GltfMesh& mesh, const Context& context) {
  with_model(mesh, context, [&](const gltf_library::Model& model) {
    AtomicFile file(path);
    volume_io::FieldSink sink(size_of(model), context);
    write_model(model, [&](std::span<const std::byte> bytes) { sink.write(file, bytes); });
    file.commit();
  });
}

std::vector<std::byte> encode_gltf(const GltfMesh& mesh, const Context& context) {
  std::vector<std::byte> out;
  with_model(mesh, context, [&](const gltf_library::Model& model) {
    write_model(model, [&](std::span<const std::byte> bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); });
  });
  return out;
}

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

constexpr std::int64_t largest_whole = std::int64_t{1} << 24;  // up to this, float represents all integers
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

/// Returns the names of columns in a file. They are in upper case, like glTF's own names, if they stay distinct.
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

/// @throws InvalidOption if the file would lose content and the options do not allow it. The message lists the content.
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
