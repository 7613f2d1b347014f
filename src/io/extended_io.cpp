#include "blum/io/extended_io.hpp"

#include <algorithm>
#include <string_view>

#include "blum/core/describe.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/mesh_io.hpp"

namespace blum {
namespace {

FileMetadata pairs_of(const MedialMetadata& metadata) {
  FileMetadata pairs{{"content", "extended medial axis"}};
  const auto add = [&](const char* key, const std::string& text) {
    if (!text.empty()) pairs.emplace_back(key, text);
  };
  const auto add_number = [&](const char* key, const auto& number) {
    if (number) pairs.emplace_back(key, exact_text(static_cast<double>(*number)));
  };
  add("blum_version", metadata.version);
  add("source", metadata.source);
  add_number("theta", metadata.theta);
  add_number("lambda", metadata.lambda);
  add_number("spacing", metadata.spacing);
  add_number("deviation", metadata.deviation);
  add_number("smooth", metadata.smooth);
  return pairs;
}

}  // namespace

const std::vector<std::string>& extended_extensions() {
  static const std::vector<std::string> extensions{".vtp", ".ply", ".obj", ".npz", ".stl"};
  return extensions;
}

void write_extended(const std::filesystem::path& path, const Complex& surface, const MedialMetadata& metadata,
                    const Context& context) {
  const std::string extension = file_extension(path);
  const auto& known = extended_extensions();
  if (std::find(known.begin(), known.end(), extension) == known.end()) {
    const std::vector<std::string_view> names(known.begin(), known.end());
    throw InvalidOption("'" + path.string() + "': extended axes are written to " + join_words(names, "or") +
                        " files; use one of these extensions");
  }
  if (extension == ".stl" && surface.triangles.empty()) {
    throw InvalidOption("'" + path.string() +
                        "': the axis has no triangles, which is all that .stl files hold; use another extension");
  }
  if (extension == ".stl") return write_mesh(path, MeshView{surface.positions, surface.triangles});
  ComplexWriteOptions options;
  options.allow_loss = true;
  write_complex(path, surface, pairs_of(metadata), options, context);
}

}  // namespace blum
