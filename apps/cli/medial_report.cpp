#include "medial_report.hpp"

#include <string>
#include <vector>

#include "blum/field/field.hpp"
#include "commands.hpp"

namespace blum::cli {
namespace {

/// Voxels of a grid whose centre has a winding number above 1/2.
VoxelSet voxels_inside(const MeshView& mesh, const GridSpec& grid, const Context& context) {
  FieldOptions options;
  options.sign = SignMode::winding;
  const Field field = distance_field(mesh, grid, options, context);
  VoxelSet voxels(grid.size);
  std::size_t node = 0;
  for (std::int64_t k = 0; k < grid.size[2]; ++k) {
    for (std::int64_t j = 0; j < grid.size[1]; ++j) {
      for (std::int64_t i = 0; i < grid.size[0]; ++i, ++node) {
        if (field.distance[node] < 0) voxels.insert(i, j, k);
      }
    }
  }
  return voxels;
}

const char* against_text(SolidRule rule) {
  return rule == SolidRule::polyhedron ? "the polyhedron"
         : rule == SolidRule::winding  ? "voxels (of the winding number)"
                                       : "the image's voxels";
}

/// Where a mesh bounds no polyhedron, and the axis's file has no metadata.
constexpr const char* untold_rule =
    "; so its axis is that of voxels, and the file of the axis does not tell which (.obj and .ma name neither rule nor "
    "grid): verify the .vtp, .ply or .npz of the same run, or give --weld here too if it was given then";

}  // namespace

Certificate certificate_of(const MedialFile& file, const SolidInput& input, const LabelSelection& selection,
                           const Context& context) {
  const AxisGeometry known = !file.has_radii       ? AxisGeometry::none
                             : file.has_footprints ? AxisGeometry::footprints
                                                   : AxisGeometry::radii;
  if (input.kind == InputKind::image) {
    const VoxelSet voxels = selected_voxels(input.image, selection, context);
    return certify(file.complex, voxels, input.image.grid, nullptr, known, context);
  }
  const MeshView mesh = input.mesh.mesh;
  if (file.metadata.solid_rule != to_string(SolidRule::winding)) {
    try {
      return certify(file.complex, mesh, known, context);
    } catch (const InvalidMesh& error) {
      if (!file.metadata.solid_rule.empty()) throw;
      throw InvalidMesh(error.what() + std::string(untold_rule));
    }
  }
  if (!file.metadata.grid) {
    throw FileError("the axis is that of voxels, but its file does not say which: take .vtp, .ply or .npz");
  }
  const VoxelSet voxels = voxels_inside(mesh, *file.metadata.grid, context);
  return certify(file.complex, voxels, *file.metadata.grid, &mesh, known, context);
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
  Json json = {{"certified", c.holds()},        {"against", to_string(c.against)},    {"solid_betti", to_json(c.solid)},
               {"axis_betti", to_json(c.axis)}, {"topology_holds", c.topology_holds}, {"mismatches", c.mismatches}};
  if (c.checked == AxisGeometry::none) return json;
  json["geometry"] = {{"holds", c.geometry.holds},
                      {"vertices", c.geometry.vertices},
                      {"radius_error", c.geometry.radius_error},
                      {"tolerance", c.geometry.tolerance}};
  if (c.checked == AxisGeometry::footprints) {
    json["geometry"]["footprint_off_surface"] = c.geometry.footprint_off_surface;
    json["geometry"]["footprint_error"] = c.geometry.footprint_error;
  }
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

void add_certificate(TextTable& table, const Certificate& c) {
  const std::string axis = "the axis has " + betti_text(c.axis);
  if (c.holds()) {
    table.add("certified", "against " + std::string(against_text(c.against)) + ": " + axis + ", as the solid");
  } else {
    table.add("NOT certified", axis + "; the solid " + betti_text(c.solid));  // why is told by the error
  }
  if (c.checked == AxisGeometry::none) {
    table.add("geometry", "not checked: the file holds no radii");
    return;
  }
  const std::string footprints =
      c.checked == AxisGeometry::footprints
          ? "footprints " + number_text(c.geometry.footprint_off_surface) + " off the surface"
          : "no footprints in the file";
  table.add("geometry", "radii off by at most " + number_text(c.geometry.radius_error) + ", " + footprints +
                            " (tolerance " + number_text(c.geometry.tolerance) + ")");
  table.add("balls", "the solid reaches at most " + number_text(c.balls.solid_to_balls) +
                         " beyond the union of the balls (mean " + number_text(c.balls.mean_solid_to_balls) +
                         "), whose surface is at most " + number_text(c.balls.balls_to_surface) + " from the solid's");
}

}  // namespace blum::cli
