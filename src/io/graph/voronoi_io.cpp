#include "blum/io/voronoi_io.hpp"

#include <string>

#include "blum/core/exact_text.hpp"

namespace blum {

FileMetadata voronoi_metadata(VoronoiPart part, std::optional<double> hausdorff_bound, std::size_t failing_cubes,
                              std::string_view version) {
  FileMetadata out{{"content", part == VoronoiPart::all ? "Voronoi diagram" : "walls of a Voronoi diagram"},
                   {"blum_version", std::string(version)},
                   {"certified", hausdorff_bound ? "true" : "false"}};
  if (hausdorff_bound) {
    out.emplace_back("hausdorff_bound", exact_text(*hausdorff_bound));
  } else {
    out.emplace_back("failing_cubes", std::to_string(failing_cubes));
  }
  return out;
}

}  // namespace blum
