#include "medial/medial_report.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "blum/io/complex_io.hpp"
#include "commands.hpp"
#include "common/files.hpp"

namespace blum::cli {
namespace {

std::string against_text(const Certificate& c) {
  if (c.against == SolidRule::polyhedron) return "the solid";
  const std::string voxels =
      c.against == SolidRule::winding ? "the voxels inside by winding number" : "the voxels of the image";
  return c.voxel ? voxels + ", side " + rounded_text(*c.voxel) : voxels;
}

/// Returns the parameters that a file states for its axis.
std::string claims_text(const CertificateOptions& said) {
  std::string text;
  const auto add = [&](const std::optional<double>& value, const char* before, const char* after) {
    if (value) text += (text.empty() ? "" : ", ") + std::string(before) + rounded_text(*value) + after;
  };
  add(said.theta, "theta ", " degrees");
  add(said.lambda, "lambda ", "");
  add(said.spacing, "voxels of ", "");
  return text;
}

/// Returns the angle above which missing parts of the axis are judged, as text.
std::string sought_text(const Certificate& c) {
  constexpr double well_above = 30;  // degrees
  const double sought = c.medial.sought_angle;
  return rounded_text(sought) + " degrees" +
         (c.checked.theta && sought == *c.checked.theta + well_above ? " (theta + 30)" : "");
}

/// Advice for a mesh that does not bound a polyhedron, if the axis's file has no metadata.
constexpr const char* missing_rule =
    "; its axis belongs to voxels that the file of the axis does not record (.obj and .ma store neither rule nor "
    "grid). Verify the .vtp, .ply or .npz file of the same axis; if the axis was made with --weld, repeat it";

std::string nothing_seen(const MedialCheck& check) {
  return "random points of the solid show " +
         std::string(check.balls == 0 ? "no medial ball" : "too few medial balls") + " with an angle above " +
         rounded_text(check.sought_angle) + " degrees";
}

std::string medial_text(const Certificate& c) {
  const MedialCheck& check = c.medial;
  std::string text;
  if (check.samples == 0) {
    text = "no part of the axis has a separation angle above theta";
  } else {
    text = percent(check.medial_share) + " of the samples are in the middle (tolerance " +
           rounded_text(check.allowance) + "), " + percent(check.close_share) + " within " +
           rounded_text(check.close_allowance) + " of it";
  }
  if (check.homotopy_share > 0) text += "; " + percent(check.homotopy_share) + " of the area exists for homotopy alone";
  if (check.sought_angle == 0) return text + "; missing parts not checked: theta is unknown";
  if (!check.judges_missing) return text + "; missing parts not checked: " + nothing_seen(check);
  return text + "; " + percent(check.missed_share) + " of the exact axis with a separation angle above " +
         sought_text(c) + " is missing (" + count_text(check.balls) + " random balls), at most " +
         percent(check.missed_share_of_body) + " in one body";
}

/// Describes the checks of roles, sheets, and angles of triangles and edges.
std::string labels_text(const Certificate& c) {
  if (!c.checked.labels && !c.checked.angles) return "not checked";
  std::string text;
  if (c.checked.labels) text = c.labels.holds ? "roles and sheets match the triangles" : "wrong roles or sheets";
  if (!c.checked.angles) return text;
  if (!text.empty()) text += "; ";
  if (!c.angles.holds) return text + "separation angles of triangles or edges do not fit their positions";
  if (c.angles.below_share == 0 && c.angles.above_share == 0) return text + "angles match the corners";
  return text + percent(c.angles.below_share) + " of the triangles have a smaller angle than their corners, " +
         percent(c.angles.above_share) + " a larger one than their surroundings";
}

/// Describes the share of the axis that lies midway between two walls, and the share of the exact axis that is missing.
/// Returns an empty text if neither was checked.
std::string medial_share_text(const Certificate& c) {
  if (!c.checked.medial || c.medial.samples == 0) return "";
  std::string text = "; " + percent(c.medial.medial_share) + " of the axis's samples are midway between two walls";
  if (!c.medial.judges_missing) return text;
  return text + ", " + percent(c.medial.missed_share) + " of the exact axis with a separation angle above " +
         sought_text(c) + " is missing";
}

}  // namespace

std::string percent(double share) {
  return rounded_text(std::round(share * 1000) / 10) + " %";
}

MedialFile read_axis(const std::filesystem::path& path) {
  MedialFile file = read_medial(path);
  add_missing_medial_columns(file.complex);
  return file;
}

namespace {

std::string text_of(const FileMetadata& metadata, std::string_view name) {
  const auto at = std::find_if(metadata.begin(), metadata.end(), [&](const auto& pair) { return pair.first == name; });
  return at == metadata.end() ? "" : at->second;
}

/// Gives each wall its sheet number: triangles between the same two sites get the same number.
void number_walls(Complex& complex) {
  const auto site_a = complex.triangle_columns.get<std::int32_t>("site_a");
  const auto site_b = complex.triangle_columns.get<std::int32_t>("site_b");
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> number;
  std::vector<std::int32_t> sheets;
  for (std::size_t t = 0; t < site_a.size(); ++t) {
    sheets.push_back(
        number.try_emplace({site_a[t], site_b[t]}, static_cast<std::int32_t>(number.size())).first->second);
  }
  const auto out = complex.triangle_columns.edit<std::int32_t>(medial_columns::sheet);
  std::copy(sheets.begin(), sheets.end(), out.begin());
}

}  // namespace

namespace {

constexpr const char* centrelines = "centreline";
constexpr const char* extended_axis = "extended medial axis";
constexpr const char* thickness = "thickness";  // column of extended axes: twice the radius

/// Returns true if files with this content have only cells to show. Their columns are not shown.
bool is_plain_content(std::string_view content) {
  return content == "points" || content == "surface map" || content == "witnesses";
}

bool has_thickness(const Complex& complex) {
  return complex.vertex_columns.find(thickness) != nullptr &&
         complex.triangle_columns.find(medial_columns::sheet) != nullptr;
}

/// Returns the parts of a file that are shown for any content but a medial axis.
ShownAxis shown_complex(Complex&& complex, const FileMetadata& metadata, const std::string& content) {
  ShownAxis out;
  out.content = content;
  out.is_axis = false;
  out.is_plain = is_plain_content(content);
  out.file.complex = std::move(complex);
  out.file.metadata.source = text_of(metadata, "source");
  return out;
}

/// Adds radii, which are half of the thicknesses.
void add_radii(Complex& complex) {
  const auto thick = complex.vertex_columns.get<double>(thickness);
  const std::vector<double> whole(thick.begin(), thick.end());
  add_missing_medial_columns(complex);
  const auto radius = complex.vertex_columns.edit<double>(medial_columns::radius);
  std::transform(whole.begin(), whole.end(), radius.begin(), [](double value) { return value / 2; });
}

/// Returns true if a complex has the columns of a Voronoi diagram that are read here.
bool has_walls(const Complex& complex) {
  return complex.triangle_columns.find("site_a") != nullptr && complex.triangle_columns.find("site_b") != nullptr;
}

/// Returns true if a complex has the columns of centrelines that are read here.
bool has_branches(const Complex& complex) {
  return complex.vertex_columns.find("radius") != nullptr && complex.edge_columns.find("label") != nullptr &&
         complex.edge_columns.find("branch") != nullptr;
}

/// Returns the number of branches of centrelines.
std::size_t branch_count(const Complex& complex) {
  std::set<std::pair<std::int64_t, std::int64_t>> branches;
  const auto label = complex.edge_columns.get<std::int64_t>("label");
  const auto branch = complex.edge_columns.get<std::int32_t>("branch");
  for (std::size_t e = 0; e < complex.edges.size(); ++e) branches.emplace(label[e], branch[e]);
  return branches.size();
}

}  // namespace

const char* cells_label(const ShownAxis& shown) {
  if (shown.is_axis || shown.content == extended_axis) return "axis";
  if (shown.is_plain) return "cells";
  return shown.content == centrelines ? "curves" : "walls";
}

std::string cells_text(const ShownAxis& shown) {
  const Complex& complex = shown.file.complex;
  if (shown.is_axis) return counts_text(count(complex), shown.file.has_labels);
  const std::string vertices = plural(complex.positions.size(), "vertex", "vertices") + ", ";
  if (shown.content == centrelines) {
    return vertices + plural(complex.edges.size(), "edge", "edges") + "; " +
           plural(branch_count(complex), "branch", "branches");
  }
  const std::string triangles = plural(complex.triangles.size(), "triangle", "triangles");
  if (shown.content == extended_axis) {
    return vertices + triangles + " in " + plural(sheet_count(complex), "sheet", "sheets");
  }
  if (shown.is_plain) return vertices + plural(complex.edges.size(), "edge", "edges") + ", " + triangles;
  return vertices + triangles + " between " + plural(sheet_count(complex), "pair", "pairs") + " of sites";
}

namespace {

/// Reads the certificate from the metadata of a Voronoi diagram.
void add_certified(const FileMetadata& metadata, ShownAxis& out) {
  const std::string certified = text_of(metadata, "certified");
  if (certified != "true" && certified != "false") return;
  out.is_certified = certified == "true";
  const std::string bound = text_of(metadata, "hausdorff_bound");
  const std::string cubes = text_of(metadata, "failing_cubes");
  out.certified = *out.is_certified ? "yes" : "NO";
  if (!bound.empty()) out.certified += "; at most " + bound + " from the exact diagram, everywhere";
  if (!cubes.empty()) out.certified += ": " + cubes + " cubes did not pass the local test";
}

}  // namespace

ShownAxis read_axis_or_curves(const std::filesystem::path& path) {
  if (may_hold_columns(path)) {
    ComplexFile file = read_complex(path);
    const std::string content = text_of(file.metadata, "content");
    const bool is_diagram = content.ends_with("Voronoi diagram") && has_walls(file.complex);
    if (content == extended_axis && has_thickness(file.complex)) {
      ShownAxis out = shown_complex(std::move(file.complex), file.metadata, content);
      out.file.has_radii = out.file.has_labels = true;
      add_radii(out.file.complex);
      return out;
    }
    if (is_plain_content(content)) {
      ShownAxis out = shown_complex(std::move(file.complex), file.metadata, content);
      add_missing_medial_columns(out.file.complex);
      return out;
    }
    if (is_diagram || (content == centrelines && has_branches(file.complex))) {
      ShownAxis out = shown_complex(std::move(file.complex), file.metadata, content);
      out.file.has_radii = true;
      out.file.has_footprints = out.file.has_sites = out.file.has_angles = is_diagram;
      add_missing_medial_columns(out.file.complex);
      if (is_diagram) {
        add_certified(file.metadata, out);
        number_walls(out.file.complex);
      } else {
        out.file.metadata.site_ids = SiteIds::voxels;
      }
      return out;
    }
    // The file is not read again, because it may be a pipe.
    ShownAxis out{read_medial(file, path.string()), "medial axis", true, false, {}, ""};
    add_missing_medial_columns(out.file.complex);
    return out;
  }
  return {read_axis(path), "medial axis", true, false, {}, ""};
}

SolidVerifier::SolidVerifier(const SolidInput& input) {
  if (input.kind == InputKind::image) {
    image_.emplace(input.image);
  } else {
    mesh_.emplace(input.mesh.mesh);
  }
}

Certificate SolidVerifier::certificate_of(const MedialFile& file, const LabelSelection& selection,
                                          const Context& context) const {
  if (image_) return image_->verify(file.complex, claims_of(file), selection, {}, context);
  try {
    return mesh_->verify(file.complex, claims_of(file), {}, available_memory(), context);
  } catch (const UnknownVoxels& error) {
    throw InvalidMesh("the mesh bounds no polyhedron (" + error.reason() + ")" + missing_rule);
  }
}

Certificate SolidVerifier::certificate_of(const std::filesystem::path& written, const MedialMetadata& metadata,
                                          const LabelSelection& selection, const Context& context) const {
  MedialFile file = read_axis(written);
  if (file.metadata.solid_rule.empty()) {
    file.metadata.solid_rule = metadata.solid_rule;
    file.metadata.grid = metadata.grid;
  }
  return certificate_of(file, selection, context);
}

namespace {

/// Lists the kinds of columns that a file may lack: true if the columns were checked, and their name for texts.
std::vector<std::pair<bool, const char*>> what_files_may_lack(const Certificate& c) {
  return {{c.checked.radii, "radii"},
          {c.checked.footprints, "footprints"},
          {c.checked.angles, "separation angles"},
          {c.checked.sites, "sites"},
          {c.checked.labels, "roles and sheets"}};
}

/// Lists parts of the file or of the solid that were not checked.
std::vector<std::string> not_looked_at(const Certificate& c, bool has_nested) {
  std::vector<std::string> all;
  const MedialCheck& medial = c.medial;
  if (c.checked.medial && medial.sought_angle == 0) {
    all.emplace_back("missing parts: theta is unknown");
  } else if (c.checked.medial && !medial.judges_missing) {
    all.push_back("missing parts: " + nothing_seen(medial));
  } else if (c.checked.medial && c.bodies.size() > 1 && medial.bodies_unseen > 0) {
    all.push_back("missing parts in " + count_text(medial.bodies_unseen) + " of " + count_text(c.bodies.size()) +
                  " bodies: points near their surface show too few medial balls");
  }
  if (has_nested) all.emplace_back("nested columns: the axes of other angles");
  return all;
}

/// Lists metadata that no certificate checks.
std::vector<std::string> taken_as_said(const Certificate& c) {
  std::vector<std::string> all;
  if (c.checked.deviation) all.emplace_back("deviation");
  for (const char* const what : {"source", "version"}) all.emplace_back(what);
  return all;
}

Json not_checked_json(const Certificate& c, bool has_nested) {
  Json all = Json::array();
  for (const auto& [is_checked, what] : what_files_may_lack(c)) {
    if (!is_checked) all.push_back(std::string(what) + ": not in the file");
  }
  for (const std::string& what : not_looked_at(c, has_nested)) all.push_back(what);
  for (const std::string& what : taken_as_said(c)) all.push_back(what + ": copied from the file");
  return all;
}

}  // namespace

std::string balls_text(const BallUnionCheck& balls, double size) {
  return "from the solid's surface to the union of the medial balls: at most " +
         share_text(balls.solid_to_balls, size) + ", mean " + share_text(balls.mean_solid_to_balls, size) +
         "; from the surface of the union back to the solid's surface: at most " +
         share_text(balls.balls_to_surface, size);
}

void add_decimated(TextTable& table, const CertifiedAxis& made, double size) {
  if (!made.metadata.deviation) return;
  table.detail("decimated", "from " + count_text(made.axis.vertices_before) + " vertices; moved by at most " +
                                share_text(made.axis.deviation, size));
}

Json certificate_json(const Certificate& c, bool has_nested) {
  Json json = {{"certified", c.holds()}};
  json.update(to_json(c));
  json.erase("holds");
  Json checked = {"topology", "positions", "edges", "triangles"};
  for (const char* const what : {"radii", "footprints", "angles", "sites", "labels", "medial"}) {
    if (json["checked"][what].is_true()) checked.push_back(what);
  }
  if (c.checked.medial && c.medial.judges_missing) checked.push_back("missing");
  json["claims"] = Json::object();
  for (const char* const what : {"theta", "lambda", "spacing", "deviation"}) {
    json["claims"][what] = json["checked"][what];
  }
  for (const char* const what : {"theta", "lambda", "spacing"}) {
    if (!json["checked"][what].is_null()) checked.push_back(what);
  }
  json["checked"] = checked;
  json["not_checked"] = not_checked_json(c, has_nested);
  const auto wrong =
      std::count_if(c.bodies.begin(), c.bodies.end(), [](const BodyCheck& body) { return body.solid != body.axis; });
  json["bodies"] = {{"count", c.bodies.size()}, {"wrong", wrong}};
  // Remove the values of checks that were not made.
  Json& geometry = json["geometry"];
  if (!c.checked.radii) geometry.erase("radius_error");
  if (!c.checked.footprints) geometry.erase("footprint_off_surface");
  if (!c.checked.footprints) geometry.erase("footprint_error");
  if (!c.checked.sites) geometry.erase("site_error");
  if (!c.checked.angles) geometry.erase("angle_error");
  if (!c.checked.labels) json.erase("labels");
  if (!c.checked.angles) json.erase("angles");
  if (!c.checked.balls) json.erase("balls");
  if (!c.checked.medial) json.erase("medial");
  return json;
}

Json counts_json(const MedialCounts& counts, bool has_labels) {
  Json json = to_json(counts);
  if (!has_labels) {
    for (const char* const stated : {"sheets", "rim_edges", "seam_edges", "junctions"}) json[stated] = nullptr;
  }
  return json;
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
  const std::string on_curves = ", " + plural(counts.curve_edges, "line segment on a curve", "line segments on curves");
  if (!has_labels) return cells + on_curves + " (no sheets in the file)";
  return cells + (counts.curve_edges > 0 ? on_curves : "") + "; " + plural(counts.sheets, "sheet", "sheets") + ", " +
         plural(counts.junctions, "junction point", "junction points");
}

void add_axis_counts(TextTable& table, const std::string& before, const MedialCounts& counts, bool has_labels) {
  table.add("axis", before + counts_text(counts, has_labels));
  if (!has_labels) return;
  table.detail("edges", count_text(counts.curve_edges) + " of curves, " + count_text(counts.rim_edges) + " of rims, " +
                            count_text(counts.seam_edges) + " of seams");
}

std::string angles_text(double least_theta) {
  return "all from " + rounded_text(least_theta) + " to 180 degrees";
}

void add_certificate(TextTable& table, const std::string& of, const Certificate& c, bool has_nested, double size) {
  if (c.holds()) {
    table.add("certified", "yes" + of + ": the axis has the topology of " + against_text(c) + " (" +
                               betti_text(c.axis) + ")" +
                               (c.bodies.size() > 1 ? ", in each of " + count_text(c.bodies.size()) + " bodies" : "") +
                               " and lies inside the solid" + medial_share_text(c));
  } else {
    // If the axis is not certified, the error message gives the reasons.
    table.add("certified", c.topology_holds
                               ? "NO" + of + ": the topology is that of the solid, but another check fails"
                               : "NO" + of + ": " + betti_text(c.axis) + "; the solid has " + betti_text(c.solid));
  }
  table.detail("homology", c.homology.shown);
  if (const std::string claims = claims_text(c.checked); !claims.empty()) table.detail("claims", claims);
  std::string geometry = "vertices, edges and triangles inside the solid";
  if (!c.geometry.holds || !c.edges.holds || !c.triangles.holds) geometry = "wrong";
  if (c.edges.pushed > 0) {
    geometry += ", except " + plural(c.edges.pushed, "edge that cuts a corner", "edges that cut corners") +
                " by up to " + share_text(c.edges.pushed_by, size);
  }
  if (c.triangles.holds && c.triangles.leaving > 0) {
    geometry += ", except the interiors of " + plural(c.triangles.leaving, "triangle", "triangles") + ", by up to " +
                share_text(c.triangles.outside_by, size);
  }
  if (c.triangles.undecided > 0) {
    geometry += ", " + plural(c.triangles.undecided, "triangle", "triangles") + " in thin walls undecided";
  }
  if (c.checked.radii) geometry += "; radius error at most " + share_text(c.geometry.radius_error, size);
  if (c.checked.footprints) {
    geometry += ", footprints at most " + share_text(c.geometry.footprint_off_surface, size) + " off the surface";
  }
  table.detail("geometry", geometry + " (tolerance " + rounded_text(c.geometry.tolerance) + ")");
  std::string unknown;
  for (const auto& [is_checked, what] : what_files_may_lack(c)) {
    if (!is_checked) unknown += (unknown.empty() ? "" : ", ") + std::string(what);
  }
  table.detail("labels", labels_text(c));
  if (!unknown.empty()) unknown = "not in the file: " + unknown;
  for (const std::string& what : not_looked_at(c, has_nested)) unknown += (unknown.empty() ? "" : "; ") + what;
  if (!unknown.empty()) table.add("not checked", unknown);
  std::string said;
  for (const std::string& what : taken_as_said(c)) said += (said.empty() ? "" : ", ") + what;
  table.detail("not verified", said + ": copied from the file");
  if (c.checked.medial) table.detail("medial", medial_text(c));
  if (!c.checked.balls) return;
  table.add("balls", "distance " + balls_text(c.balls, size));
}

}  // namespace blum::cli
