#include "cleaning.hpp"

#include <cstddef>
#include <string>

#include "blum/core/error.hpp"
#include "described.hpp"
#include "medial_report.hpp"

namespace blum::cli {
namespace {

std::string change_text(std::size_t before, std::size_t after) {
  return count_text(after) + " of " + count_text(before);
}

}  // namespace

CleanedMesh clean_input(const std::filesystem::path& path, const MeshView& mesh, double tolerance,
                        const Context& context) {
  try {
    return clean_mesh(mesh, tolerance, context);
  } catch (const InvalidMesh& error) {
    throw InvalidMesh("'" + path.string() + "': " + error.what());
  }
}

void add_cleaning(const CleanReport& done, double tolerance, TextTable& table) {
  table.add("vertices", change_text(done.vertices_before, done.vertices));
  table.add("triangles", change_text(done.triangles_before, done.triangles));
  table.add("steps", plural(done.collapses, "collapse", "collapses") + ", " + plural(done.flips, "flip", "flips"));
  table.add("deviation",
            "at most " + rounded_text(done.deviation) + ", both ways; tolerance " + rounded_text(tolerance));
  table.add("heights", "of triangles at least " + rounded_text(done.smallest_height) + ", before " +
                           rounded_text(done.smallest_height_before));
  table.add("topology", betti_text(done.betti) + ", as before; no crossings, checked exactly");
}

Json cleaning_json(const CleanReport& done, double tolerance) {
  Json out = {{"tolerance", tolerance}};
  out.update(to_json(done));
  return out;
}

}  // namespace blum::cli
