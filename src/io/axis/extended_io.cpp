#include "blum/io/extended_io.hpp"

#include <string>

#include "blum/core/exact_text.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/mesh_io.hpp"
#include "io/format_table.hpp"

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

void write_as_complex(const std::filesystem::path& path, const Complex& surface, const FileMetadata& metadata,
                      const Context& context) {
  ComplexWriteOptions options;
  options.allow_loss = true;
  write_complex(path, surface, metadata, options, context);
}

void write_stl(const std::filesystem::path& path, const Complex& surface, const FileMetadata& /*metadata*/,
               const Context& /*context*/) {
  if (surface.triangles.empty()) {
    throw InvalidOption("'" + path.string() +
                        "': the axis has no triangles, which is all that .stl files hold; use another extension");
  }
  write_mesh(path, MeshView{surface.positions, surface.triangles});
}

}  // namespace

void write_extended(const std::filesystem::path& path, const Complex& surface, const MedialMetadata& metadata,
                    const Context& context) {
  const auto format = ExtendedAxisFormat::of(path, FileAccess::write);
  formats::code_of(format).write(path, surface, pairs_of(metadata), context);
}

constinit const formats::ExtendedAxisCode formats::extended_as_complex{write_as_complex};
constinit const formats::ExtendedAxisCode formats::extended_stl{write_stl};

}  // namespace blum
