#include "shape/cleaning.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "common/described.hpp"
#include "medial/medial_report.hpp"

namespace blum::cli {
namespace {

std::string change_text(std::size_t before, std::size_t after) {
  return count_text(before) + " -> " + count_text(after);
}

}  // namespace

void add_cleaning(const CleanReport& done, double tolerance, double size, TextTable& table) {
  table.add("deviation", "at most " + share_text(done.deviation, size) + " in both directions (tolerance " +
                             rounded_text(tolerance) + ")");
  table.add("topology", "unchanged: " + betti_text(done.betti) + "; no self-intersections (exact test)");
  table.add("vertices", change_text(done.vertices_before, done.vertices));
  table.add("triangles", change_text(done.triangles_before, done.triangles));
  table.detail("steps", plural(done.collapses, "collapse", "collapses") + ", " + plural(done.flips, "flip", "flips"));
  table.detail("heights", "smallest height of a triangle " + rounded_text(done.smallest_height) + ", before " +
                              rounded_text(done.smallest_height_before));
}

Json cleaning_json(const CleanReport& done, double tolerance) {
  Json out = {{"tolerance", tolerance}};
  out.update(to_json(done));
  return out;
}

void add_rounding_warning(const std::filesystem::path& file, const TriangleMesh& mesh, std::vector<Warning>& warnings) {
  if (file.extension() != ".stl") return;
  const auto is_single = [](double x) { return static_cast<double>(static_cast<float>(x)) == x; };
  const bool is_kept = std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                                   [&](const Vec3d& p) { return is_single(p.x) && is_single(p.y) && is_single(p.z); });
  if (is_kept) return;
  warnings.emplace_back(WarningCode::rounded, "'" + file.string() +
                                                  "' stores coordinates in single precision, so the checks may not "
                                                  "hold for this file; write .ply, .obj or .off");
}

}  // namespace blum::cli
