#include "blum/axis/axis_graph.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "axis/axis_parts.hpp"
#include "axis/patch_axis.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/check_angle.hpp"
#include "blum/core/sort_unique.hpp"
#include "blum/geometry/fitted_patches.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/surface_patches.hpp"

namespace blum {
namespace {

using detail::add_quantiles;
using detail::add_sheets;
using detail::AxisParts;
using detail::check_angle;
using detail::EdgePart;
using detail::LinearPart;
using detail::SurfacePatches;

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Follows each seam and curve from junction to junction, and adds it to the graph as one line.
class LineWalker {
 public:
  LineWalker(const AxisParts& parts, std::optional<double> homotopy_angle, AxisGraph& graph)
      : parts_(parts),
        graph_(graph),
        is_for_homotopy_(parts.incidence().edges().size(), false),
        junction_at_(parts.view().positions.size(), none),
        line_of_edge_(parts.incidence().edges().size(), none) {
    for (std::size_t e = 0; e < parts.view().edges.size(); ++e) {
      is_for_homotopy_[parts.incidence().edge_of_listed()[e]] =
          homotopy_angle && parts.view().edge_angle[e] <= *homotopy_angle;
    }
  }

  void walk(const Context& context) {
    find_junctions();
    for (std::uint32_t j = 0; j < graph_.junctions.size(); ++j) {
      if (j % 4096 == 0) throw_if_cancelled(context);
      const std::uint32_t vertex = graph_.junctions[j].vertex;
      for (const std::uint32_t e : parts_.incidence().edges_of_vertex()[vertex]) begin_at(vertex, e);
    }
    // The edges that are left form loops without junctions. The line of a loop begins at the first end of the loop's
    // first edge.
    for (std::uint32_t e = 0; e < line_of_edge_.size(); ++e) begin_at(parts_.incidence().edges()[e][0], e);
  }

  /// Returns for each edge of incidence().edges() the index of its line in the graph's seams or curves; none for other
  /// edges.
  [[nodiscard]] const std::vector<std::uint32_t>& line_of_edge() const { return line_of_edge_; }

 private:
  void find_junctions() {
    const MedialView& axis = parts_.view();
    for (std::uint32_t v = 0; v < axis.positions.size(); ++v) {
      const auto [is_junction, kind] = parts_.junction(v);
      if (!is_junction) continue;
      junction_at_[v] = static_cast<std::uint32_t>(graph_.junctions.size());
      AxisJunction& junction = graph_.junctions.emplace_back();
      junction.vertex = v;
      junction.kind = kind;
      junction.position = axis.positions[v];
      junction.radius = axis.radius[v];
      for (const std::uint32_t t : parts_.incidence().triangles_of_vertex()[v]) {
        junction.sheets.push_back(static_cast<std::uint32_t>(axis.sheet[t]));
      }
      detail::sort_unique(junction.sheets);
    }
  }

  void begin_at(std::uint32_t vertex, std::uint32_t edge) {
    const EdgePart part = parts_.part(edge);
    if (line_of_edge_[edge] != none || (part != EdgePart::seam && part != EdgePart::curve)) return;
    std::vector<AxisLine>& lines = part == EdgePart::seam ? graph_.seams : graph_.curves;
    const auto number = static_cast<std::uint32_t>(lines.size());
    AxisLine line;
    add_vertex(vertex, line);
    for (; edge != none; edge = next_edge(vertex, part)) {
      line_of_edge_[edge] = number;
      line.length += parts_.edge_length(edge);
      if (is_for_homotopy_[edge]) line.homotopy_length += parts_.edge_length(edge);
      const auto& ends = parts_.incidence().edges()[edge];
      vertex = ends[0] == vertex ? ends[1] : ends[0];
      add_vertex(vertex, line);
      if (part == EdgePart::seam) {
        for (const std::uint32_t t : parts_.incidence().triangles_of_edge()[edge]) {
          line.sheets.push_back(static_cast<std::uint32_t>(parts_.view().sheet[t]));
        }
      }
    }
    finish(line, part, number);
    lines.push_back(std::move(line));
  }

  void add_vertex(std::uint32_t vertex, AxisLine& line) const {
    line.vertices.push_back(vertex);
    line.points.push_back(parts_.view().positions[vertex]);
    line.radii.push_back(parts_.view().radius[vertex]);
    line.arc_length.push_back(line.length);
  }

  /// Returns the next edge of a line that has reached a vertex; none at a junction or at the end of a loop.
  [[nodiscard]] std::uint32_t next_edge(std::uint32_t vertex, EdgePart part) const {
    if (junction_at_[vertex] != none) return none;
    for (const std::uint32_t e : parts_.incidence().edges_of_vertex()[vertex]) {
      if (parts_.part(e) == part && line_of_edge_[e] == none) return e;
    }
    return none;
  }

  void finish(AxisLine& line, EdgePart part, std::uint32_t number) {
    const auto [least, most] = std::minmax_element(line.radii.begin(), line.radii.end());
    std::vector<LinearPart> parts;
    for (std::size_t k = 1; k < line.radii.size(); ++k) {
      const double length = line.arc_length[k] - line.arc_length[k - 1];
      parts.push_back(LinearPart::on_edge(line.radii[k - 1], line.radii[k], length));
    }
    line.radius = {*least, 0, 0, *most};
    add_quantiles(std::move(parts), line.radius);
    const std::uint32_t first = junction_at_[line.vertices.front()];
    const std::uint32_t last = junction_at_[line.vertices.back()];
    line.closed = first == none;
    if (!line.closed) {
      line.junctions = {first, last};
      for (const std::uint32_t j : {first, last}) {
        AxisJunction& junction = graph_.junctions[j];
        (part == EdgePart::seam ? junction.seams : junction.curves).push_back(number);
        if (part == EdgePart::curve) {
          line.sheets.insert(line.sheets.end(), junction.sheets.begin(), junction.sheets.end());
        }
      }
    }
    detail::sort_unique(line.sheets);
    (part == EdgePart::seam ? graph_.seam_length : graph_.curve_length) += line.length;
    if (part == EdgePart::curve) graph_.homotopy_curve_length += line.homotopy_length;
  }

  const AxisParts& parts_;
  AxisGraph& graph_;
  std::vector<bool> is_for_homotopy_;        ///< for each edge: true if it exists for homotopy alone
  std::vector<std::uint32_t> junction_at_;   ///< for each vertex: its index in the junctions, or none
  std::vector<std::uint32_t> line_of_edge_;  ///< for each edge: index of its line in the seams or the curves, or none
};

/// @throws InvalidOption if a column is missing: the radii of vertices or the sheets of triangles.
void check_needed(const Complex& axis) {
  if (!axis.positions.empty() && axis.vertex_columns.find(medial_columns::radius) == nullptr) {
    throw InvalidOption(missing_medial_column("vertices", medial_columns::radius));
  }
  if (!axis.triangles.empty() && axis.triangle_columns.find(medial_columns::sheet) == nullptr) {
    throw InvalidOption(missing_medial_column("triangles", medial_columns::sheet));
  }
}

/// @throws InvalidOption for a site that the mesh does not have.
std::vector<std::uint32_t> patches_at(const SurfacePatches& patches, SiteId site) {
  if (site.value < patches.site_count()) return patches.at(site);
  throw InvalidOption("the axis uses site " + std::to_string(site.value) +
                      " (counted from 0), but the number of sites of the mesh is " +
                      std::to_string(patches.site_count()) +
                      ": the axis belongs to another mesh, or to the same mesh welded differently");
}

/// Patches of a mesh, and the shape of each of them if shapes were fitted.
struct MeshPatches {
  SurfacePatches surface;
  std::vector<SurfaceShape> shapes = {};
};

MeshPatches patches_of(const MeshView& mesh, const AxisGraphOptions& options, const Context& context) {
  if (!options.patch_fit) return {SurfacePatches(mesh, options.patch_angle, context)};
  validate(mesh);
  const SiteTable sites(mesh, context);
  std::vector<Vec3d> normals = detail::triangle_normals(mesh);
  const SurfacePatches flat(mesh, sites, normals, 0, context);
  std::vector<std::uint32_t> face_of;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) face_of.push_back(flat.of_face(t));
  detail::FittedPatches fitted =
      detail::fit_patches(mesh, sites, {face_of, normals, *options.patch_fit, options.patch_angle}, context);
  return {SurfacePatches(mesh, sites, std::move(normals), std::move(fitted.patch_of)), std::move(fitted.shapes)};
}

std::vector<AxisPatch> listed(const MeshPatches& patches) {
  std::vector<AxisPatch> out;
  for (const detail::SurfacePatch& one : patches.surface.patches()) {
    out.push_back({one.faces, one.area, one.centroid, one.normal, {}});
    if (!patches.shapes.empty()) out.back().shape = patches.shapes[out.size() - 1];
  }
  return out;
}

/// Adds to each sheet the pairs of patches that contain the two footprints of its vertices. Each corner of a triangle
/// contributes a third of the triangle's area to its pair.
class PatchPairs {
 public:
  PatchPairs(const AxisParts& parts, const SurfacePatches& patches, AxisGraph& graph)
      : parts_(parts), patches_(patches), graph_(graph), areas_(graph.sheets.size()) {}

  void add() {
    find_sides();
    const MedialView& axis = parts_.view();
    for (std::uint32_t t = 0; t < axis.triangles.size(); ++t) {
      const auto& [a, b, c] = axis.triangles[t];
      const Vec3d& at = axis.positions[a];
      const double third = length(cross(axis.positions[b] - at, axis.positions[c] - at)) / 6;
      for (const std::uint32_t v : axis.triangles[t]) {
        if (sides_[v].first != none) areas_[parts_.sheet_place(t)][sides_[v]] += third;
      }
    }
    for (std::size_t s = 0; s < areas_.size(); ++s) {
      for (const auto& [sides, area] : areas_[s]) {
        graph_.sheets[s].patch_pairs.push_back(
            {sets_[sides.first], sets_[sides.second], graph_.sheets[s].area > 0 ? area / graph_.sheets[s].area : 0});
      }
      std::sort(graph_.sheets[s].patch_pairs.begin(), graph_.sheets[s].patch_pairs.end(),
                [](const AxisPatchPair& a, const AxisPatchPair& b) {
                  return std::tie(b.share, a.first, a.second) < std::tie(a.share, b.first, b.second);
                });
    }
  }

 private:
  /// Finds for each vertex the numbers of two sets of patches, one for each footprint. Both sets are `none` if the
  /// vertex has no two footprints with known sites.
  void find_sides() {
    const MedialView& axis = parts_.view();
    for (std::uint32_t v = 0; v < axis.positions.size(); ++v) {
      sides_.emplace_back(none, none);
      if (axis.footprint(v, 0) == axis.footprint(v, 1)) continue;
      if (!axis.site(v, 0).has_value() || !axis.site(v, 1).has_value()) continue;
      std::vector<std::uint32_t> first = patches_at(patches_, axis.site(v, 0));
      std::vector<std::uint32_t> second = patches_at(patches_, axis.site(v, 1));
      if (second < first) std::swap(first, second);
      sides_.back() = {number_of(std::move(first)), number_of(std::move(second))};
    }
  }
  std::uint32_t number_of(std::vector<std::uint32_t> set) {
    const auto [at, is_new] = numbers_.try_emplace(std::move(set), static_cast<std::uint32_t>(sets_.size()));
    if (is_new) sets_.push_back(at->first);
    return at->second;
  }

  const AxisParts& parts_;
  const SurfacePatches& patches_;
  AxisGraph& graph_;
  std::map<std::vector<std::uint32_t>, std::uint32_t> numbers_;
  std::vector<std::vector<std::uint32_t>> sets_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sides_;
  std::vector<std::map<std::pair<std::uint32_t, std::uint32_t>, double>> areas_;  ///< for each sheet, by pair
};

AxisGraph graph_of(const Complex& axis, const MeshPatches* patches, const AxisGraphOptions& options,
                   const Context& context) {
  check_angle("homotopy_angle", options.homotopy_angle.value_or(0));
  check_needed(axis);
  const CompleteAxis all(axis);
  if (const std::string problem = problem_of_medial(all.get()); !problem.empty()) {
    throw InvalidOption("this is not a medial axis, so it has no graph: " + problem);
  }
  std::optional<detail::PatchAxis> between_patches;
  if (options.of_patches) between_patches.emplace(all.get(), context);
  AxisGraph graph;
  const AxisParts parts(between_patches ? between_patches->get() : all.get(), context);
  LineWalker walker(parts, options.homotopy_angle, graph);
  walker.walk(context);
  add_sheets(parts, walker.line_of_edge(), options.homotopy_angle, graph);
  if (patches != nullptr) {
    graph.patches = listed(*patches);
    PatchPairs(parts, patches->surface, graph).add();
  }
  if (between_patches) between_patches->complete(graph);
  return graph;
}

}  // namespace

AxisGraph axis_graph(const Complex& axis, const AxisGraphOptions& options, const Context& context) {
  return graph_of(axis, nullptr, options, context);
}

AxisGraph axis_graph(const Complex& axis, const MeshView& mesh, const AxisGraphOptions& options,
                     const Context& context) {
  check_angle("patch_angle", options.patch_angle);
  detail::check_patch_fit(options.patch_fit);
  const MeshPatches patches = patches_of(mesh, options, context);
  return graph_of(axis, &patches, options, context);
}

}  // namespace blum
