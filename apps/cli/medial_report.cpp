#include "medial_report.hpp"

#include <string>
#include <utility>
#include <vector>

#include "blum/io/verify_medial.hpp"
#include "commands.hpp"
#include "files.hpp"

namespace blum::cli {
namespace {

const char* against_text(SolidRule rule) {
  return rule == SolidRule::polyhedron ? "the polyhedron"
         : rule == SolidRule::winding  ? "voxels (of the winding number)"
                                       : "the image's voxels";
}

/// Where a mesh bounds no polyhedron, and the axis's file has no metadata.
constexpr const char* untold_rule =
    ": its axis is that of voxels, and the file of the axis does not tell which (.obj and .ma name neither rule nor "
    "grid): verify the .vtp, .ply or .npz of the same run, or give --weld here too if it was given then";

}  // namespace

Certificate certificate_of(const MedialFile& file, const SolidInput& input, const LabelSelection& selection,
                           const Context& context) {
  if (input.kind == InputKind::image) {
    return verify(file.complex, claims_of(file), input.image, selection, {}, context);
  }
  try {
    return verify(file.complex, claims_of(file), input.mesh.mesh, {}, available_memory(), context);
  } catch (const UntoldVoxels& error) {
    throw InvalidMesh("the mesh bounds no polyhedron (" + error.reason() + ")" + untold_rule);
  }
}

NotCertified::NotCertified(const std::vector<std::string>& mismatches, const std::string& rest)
    : std::runtime_error([&] {
        std::string all;
        for (const std::string& mismatch : mismatches) all += (all.empty() ? "" : "; ") + mismatch;
        return "NOT certified: " + all + rest;
      }()) {}

Json to_json(const BettiNumbers& betti) {
  return Json::array({betti[0], betti[1], betti[2]});
}

Json to_json(const Certificate& c) {
  Json checked = {"topology", "positions", "edges"};
  for (const auto& [is_checked, what] :
       {std::pair{c.checked.radii, "radii"}, std::pair{c.checked.footprints, "footprints"},
        std::pair{c.checked.angles, "angles"}, std::pair{c.checked.sites, "sites"}}) {
    if (is_checked) checked.push_back(what);
  }
  std::size_t wrong = 0;
  for (const BodyCheck& body : c.bodies) wrong += body.solid == body.axis ? 0 : 1;
  Json json = {{"certified", c.holds()},
               {"against", to_string(c.against)},
               {"checked", checked},
               {"solid_betti", to_json(c.solid)},
               {"axis_betti", to_json(c.axis)},
               {"bodies", {{"count", c.bodies.size()}, {"wrong", wrong}}},
               {"topology_holds", c.topology_holds},
               {"mismatches", c.mismatches}};
  json["geometry"] = {{"holds", c.geometry.holds},           {"vertices", c.geometry.vertices},
                      {"not_finite", c.geometry.not_finite}, {"outside", c.geometry.outside},
                      {"outside_by", c.geometry.outside_by}, {"tolerance", c.geometry.tolerance}};
  json["edges"] = {{"holds", c.edges.holds},         {"edges", c.edges.edges},     {"pushed", c.edges.pushed},
                   {"pushed_by", c.edges.pushed_by}, {"outside", c.edges.outside}, {"outside_by", c.edges.outside_by},
                   {"tolerance", c.edges.tolerance}};
  if (c.checked.radii) json["geometry"]["radius_error"] = c.geometry.radius_error;
  if (c.checked.footprints) {
    json["geometry"]["footprint_off_surface"] = c.geometry.footprint_off_surface;
    json["geometry"]["footprint_error"] = c.geometry.footprint_error;
  }
  if (c.checked.sites) json["geometry"]["site_error"] = c.geometry.site_error;
  if (c.checked.angles) json["geometry"]["angle_error"] = c.geometry.angle_error;
  if (!c.checked.balls) return json;
  json["balls"] = {{"solid_to_balls", c.balls.solid_to_balls},
                   {"mean_solid_to_balls", c.balls.mean_solid_to_balls},
                   {"balls_beyond_solid", c.balls.balls_beyond_solid},
                   {"balls_to_surface", c.balls.balls_to_surface},
                   {"sample_step", c.balls.step}};
  return json;
}

Json counts_json(const MedialCounts& counts, bool has_labels) {
  const auto labelled = [&](std::size_t n) { return has_labels ? Json(n) : Json(nullptr); };
  return {{"vertices", counts.vertices},
          {"triangles", counts.triangles},
          {"sheets", labelled(counts.sheets)},
          {"curve_edges", counts.curve_edges},
          {"rim_edges", labelled(counts.rim_edges)},
          {"seam_edges", labelled(counts.seam_edges)},
          {"junctions", labelled(counts.junctions)}};
}

std::string betti_text(const BettiNumbers& betti) {
  const auto number = [](std::int64_t n, const char* one, const char* many) {
    return plural(static_cast<std::uint64_t>(n), one, many);
  };
  return number(betti[0], "component", "components") + ", " + number(betti[1], "tunnel", "tunnels") + ", " +
         number(betti[2], "void", "voids");
}

std::string counts_text(const MedialCounts& counts, bool has_labels) {
  const std::string cells =
      plural(counts.vertices, "vertex", "vertices") + ", " + plural(counts.triangles, "triangle", "triangles");
  if (!has_labels) {
    return cells + ", " + plural(counts.curve_edges, "edge", "edges") + " of curves (the file tells no sheets)";
  }
  return cells + " in " + plural(counts.sheets, "sheet", "sheets") + "; edges: " + count_text(counts.curve_edges) +
         " of curves, " + count_text(counts.rim_edges) + " of rims, " + count_text(counts.seam_edges) + " of seams; " +
         plural(counts.junctions, "junction", "junctions");
}

std::string angles_text(double least_theta) {
  return "all from " + rounded_text(least_theta) + " degrees on";
}

void add_certificate(TextTable& table, const Certificate& c) {
  const std::string axis = "the axis has " + betti_text(c.axis);
  if (c.holds()) {
    table.add("certified",
              "against " + std::string(against_text(c.against)) + ": " + axis + ", as many as the solid" +
                  (c.bodies.size() > 1 ? " in each of its " + count_text(c.bodies.size()) + " bodies" : "") +
                  " (numbers are compared, not homotopy classes)");
  } else {
    table.add("NOT certified", axis + "; the solid " + betti_text(c.solid));  // why is told by the error
  }
  std::string geometry = "vertices and edges in the solid";
  if (!c.geometry.holds || !c.edges.holds) geometry = "wrong";
  if (c.edges.pushed > 0) {
    geometry += ", but for " + plural(c.edges.pushed, "edge that cuts a corner", "edges that cut corners") +
                " by up to " + rounded_text(c.edges.pushed_by);
  }
  if (c.checked.radii) geometry += "; radii off by at most " + rounded_text(c.geometry.radius_error);
  if (c.checked.footprints) {
    geometry += ", footprints " + rounded_text(c.geometry.footprint_off_surface) + " off the surface";
  }
  table.add("geometry", geometry + " (tolerance " + rounded_text(c.geometry.tolerance) + ")");
  std::string unknown;
  for (const auto& [is_checked, what] :
       {std::pair{c.checked.radii, "radii"}, std::pair{c.checked.footprints, "footprints"},
        std::pair{c.checked.angles, "separation angles"}, std::pair{c.checked.sites, "sites"}}) {
    if (!is_checked) unknown += (unknown.empty() ? "" : ", ") + std::string(what);
  }
  if (!unknown.empty()) table.add("not checked", "not in the file: " + unknown);
  if (!c.checked.balls) return;
  table.add("balls", "the solid reaches at most " + rounded_text(c.balls.solid_to_balls) +
                         " beyond the union of the balls (mean " + rounded_text(c.balls.mean_solid_to_balls) +
                         "), whose surface is at most " + rounded_text(c.balls.balls_to_surface) + " from the solid's");
}

}  // namespace blum::cli
