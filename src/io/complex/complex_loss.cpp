#include <string>

#include "blum/core/error.hpp"
#include "io/complex/complex_files.hpp"

namespace blum::complex_files {
namespace {

/// The names of columns but one, for messages.
std::string names_of(const Columns& columns, std::string_view kept) {
  std::string names;
  for (const Column& column : columns) {
    if (column.name != kept) names += (names.empty() ? "" : ", ") + column.name;
  }
  return names;
}

}  // namespace

void refuse_loss(const std::filesystem::path& path, std::string_view format, const Complex& complex,
                 const FileMetadata& metadata, const ComplexWriteOptions& options, std::string_view kept) {
  if (options.allow_loss) return;
  std::string lost;
  const auto lose = [&](const std::string& what) { lost += (lost.empty() ? "" : "; ") + what; };
  const auto lose_columns = [&](const char* of, const Columns& columns, std::string_view but) {
    if (const std::string names = names_of(columns, but); !names.empty()) {
      lose(std::string("columns of ") + of + " (" + names + ")");
    }
  };
  lose_columns("vertices", complex.vertex_columns, kept);
  lose_columns("edges", complex.edge_columns, {});
  lose_columns("triangles", complex.triangle_columns, {});
  if (!metadata.empty()) lose("metadata");
  if (lost.empty()) return;
  const std::string also = kept.empty() ? std::string() : ", the column '" + std::string(kept) + "' of vertices";
  throw InvalidOption("'" + path.string() + "': " + std::string(format) + " files hold positions, edges and triangles" +
                      also + " only, so that these would be lost: " + lost +
                      "; write .vtp, .ply or .npz, or allow the loss");
}

}  // namespace blum::complex_files
