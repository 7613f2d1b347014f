#include "blum/axis/extend_axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "axis/rim_reach.hpp"
#include "axis/rims.hpp"
#include "axis/shared_sheets.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/union_find.hpp"

namespace blum {
namespace {

using detail::fill_strip;
using detail::find_rims;
using detail::is_strip_inside;
using detail::RimCorner;
using detail::RimEdge;
using detail::RimEnd;
using detail::RimObstacles;
using detail::RimReach;
using detail::Rims;
using detail::RimStart;
using detail::RimTarget;
using detail::SearchMesh;
using detail::StripOutline;

constexpr std::size_t rims_per_range = 64;
/// New vertices are merged if their distance is at most this fraction of the radius at the rim.
constexpr double one_point = 1e-3;
/// A rim lies on another sheet if its distance is at most this fraction of the radius, and the sheet is behind it.
constexpr double beside = 0.05;
/// A rim leads along a sheet if the cosine of the angle between its direction and the direction to the sheet is at
/// least this.
constexpr double least_lead = 0.5;

/// A corner of a rim, and the point to which the rim is extended there.
struct Continued {
  RimStart start;
  bool stays = false;               ///< not extended: at the border of the solid or on another sheet
  bool is_beside_sheet = false;     ///< on another sheet: only rims that lead along this sheet are extended
  std::optional<RimTarget> target;  ///< none if the corner stays, or if no surface or sheet is close enough
};

/// Triangles in front of a rim edge. They use the point numbers of fill_strip().
struct Strip {
  std::vector<Vec3d> line;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  bool is_pinched = false;   ///< both ends of the rim edge have the same target
  bool is_left_out = false;  ///< no triangles, because they would fold back, leave the solid or close a hole
};

double area_of(const std::vector<Vec3d>& positions, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  double area = 0;
  for (const auto& [a, b, c] : triangles) {
    area += length(cross(positions[b] - positions[a], positions[c] - positions[a])) / 2;
  }
  return area;
}

/// Returns the boundaries of all bodies in one mesh.
TriangleMesh boundary_of(const Solid& solid) {
  TriangleMesh all;
  for (const SolidBody& body : solid.bodies()) {
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), body.mesh.vertices.begin(), body.mesh.vertices.end());
    for (const auto& [a, b, c] : body.mesh.triangles) all.triangles.push_back({first + a, first + b, first + c});
  }
  return all;
}

class AxisExtender {
 public:
  AxisExtender(const Complex& axis, const Solid& solid, const ExtendOptions& options, const Context& context)
      : axis_(axis),
        view_(axis),
        solid_(solid),
        options_(options),
        context_(context),
        rims_(find_rims(axis, context)),
        continued_(rims_.corners.size()),
        strips_(rims_.edges.size()) {}

  ExtendedAxis run() {
    begin_result();
    if (!rims_.edges.empty()) find_strips();
    std::vector<std::uint32_t> stands_for = number_new_vertices();
    for (std::size_t e = 0; e < strips_.size(); ++e) add_strip(e, stands_for);
    if (options_.join && !borders_.empty()) join();
    finish();
    return std::move(out_);
  }

 private:
  [[nodiscard]] Vec3d at(std::uint32_t v) const { return axis_.positions[v]; }

  /// Copies from the axis all vertices and triangles, and the edges without triangles.
  void begin_result() {
    sheets_.positions = axis_.positions;
    sheets_.triangles = axis_.triangles;
    const Incidence incidence(axis_.view(), context_);
    for (std::size_t e = 0; e < axis_.edges.size(); ++e) {
      const bool is_curve = incidence.triangles_of_edge()[incidence.edge_of_listed()[e]].empty();
      if (is_curve) sheets_.curves.push_back(axis_.edges[e]);
    }
    for (const double r : view_.radius) sheets_.thickness.push_back(2 * r);
    sheets_.is_new_vertex.assign(axis_.positions.size(), 0);
    sheets_.sheet.assign(view_.sheet.begin(), view_.sheet.end());
    sheets_.is_new_triangle.assign(axis_.triangles.size(), 0);
  }

  // --- Targets of rims.

  void find_starts() {
    const std::vector<double> stays_below = radii_at_borders();
    for (const RimEdge& edge : rims_.edges) {
      for (const std::uint32_t c : edge.corners) continued_[c].start.sheet = view_.sheet[edge.triangle];
    }
    for (std::size_t c = 0; c < rims_.corners.size(); ++c) {
      const RimCorner& corner = rims_.corners[c];
      const double own = view_.radius[corner.vertex];
      continued_[c].start = {at(corner.vertex),
                             corner.outwards,
                             corner.normal,
                             own,
                             options_.max_length * own,
                             {corner.vertex, corner.vertex},
                             continued_[c].start.sheet};
      continued_[c].stays = corner.is_on_sheet || own <= stays_below[c];
      if (corner.is_beside_sheet) stay_on_sheet(continued_[c]);
    }
  }

  static void stay_on_sheet(Continued& corner) {
    corner.is_beside_sheet = true;
    corner.start.normal.reset();
    corner.stays = corner.stays || length(corner.start.outwards) == 0;
  }

  /// Turns the directions of corners that lie on another sheet, or slightly beyond it, but share no vertex with it.
  void turn_beside(const SearchMesh& sheets) {
    for (Continued& corner : continued_) {
      if (corner.stays || !corner.start.normal) continue;
      const double slack = beside * corner.start.radius;
      std::optional<Vec3d> turned;
      sheets.bvh().for_each_within(corner.start.at, slack, [&](const NearestPrimitive& near) {
        if (sheets.sheet(near.primitive) == corner.start.sheet) return true;
        turned = detail::way_beside(corner.start.outwards, *corner.start.normal, sheets.normal(near.primitive),
                                    corner.start.at - near.point);
        return !turned;
      });
      if (!turned) continue;
      corner.start.outwards = *turned;
      stay_on_sheet(corner);
    }
  }

  /// Returns the target of an end of a rim edge, or null.
  [[nodiscard]] const RimTarget* target_of(const RimEdge& edge, std::size_t end) const {
    const Continued& corner = continued_[edge.corners[end]];
    const bool leads_away = corner.is_beside_sheet && dot(edge.outwards, corner.start.outwards) < least_lead;
    return corner.target && !leads_away ? &*corner.target : nullptr;
  }

  /// Returns for each corner the largest radius at which the corner is treated as lying at the border of the solid.
  [[nodiscard]] std::vector<double> radii_at_borders() const {
    std::vector<double> of_sheet(sheet_count(axis_), 0);
    for (std::size_t t = 0; t < axis_.triangles.size(); ++t) {
      double& largest = of_sheet[static_cast<std::size_t>(view_.sheet[t])];
      for (const std::uint32_t v : axis_.triangles[t]) largest = std::max(largest, view_.radius[v]);
    }
    std::vector<double> of_corner(rims_.corners.size(), 0);
    for (const RimEdge& edge : rims_.edges) {
      const double own = options_.border_radius * of_sheet[static_cast<std::size_t>(view_.sheet[edge.triangle])];
      for (const std::uint32_t corner : edge.corners) of_corner[corner] = std::max(of_corner[corner], own);
    }
    return of_corner;
  }

  /// The first round extends each rim without regard to the others. The second round also stops each rim at the strips
  /// of the first round. So two sheets that both end before they meet are extended up to each other.
  void find_strips() {
    find_starts();
    const SearchMesh surface(boundary_of(solid_), {}, context_);
    const SearchMesh sheets({axis_.positions, axis_.triangles}, {view_.sheet.begin(), view_.sheet.end()}, context_);
    turn_beside(sheets);
    const detail::RimLines rims(axis_, rims_, context_);
    extend({&surface, &sheets, nullptr, &rims}, false);
    TriangleMesh strips{axis_.positions};
    std::vector<std::int32_t> of_sheet;
    add_strips_to(strips, of_sheet);
    const std::optional<SearchMesh> met =
        strips.triangles.empty() ? std::nullopt : std::optional<SearchMesh>(std::in_place, strips, of_sheet, context_);
    extend({&surface, &sheets, met ? &*met : nullptr, &rims}, true);
  }

  void extend(const RimObstacles& obstacles, bool is_final) {
    const RimReach reach(obstacles, !is_final);
    parallel_for(context_, continued_.size(), rims_per_range, "rims", [&](const WorkRange& range) {
      for (std::size_t c = range.begin; c < range.end; ++c) {
        if (!continued_[c].stays) continued_[c].target = reach.find(continued_[c].start);
      }
    });
    parallel_for(context_, strips_.size(), rims_per_range, "strips", [&](const WorkRange& range) {
      for (std::size_t e = range.begin; e < range.end; ++e) strips_[e] = strip_of(rims_.edges[e], reach, is_final);
    });
  }

  /// Adds the triangles of all strips to a mesh of the axis's vertices, and the numbers of their sheets to a list.
  void add_strips_to(TriangleMesh& mesh, std::vector<std::int32_t>& of_sheet) const {
    for (std::size_t e = 0; e < strips_.size(); ++e) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      const auto& ends = rims_.edges[e].vertices;
      mesh.vertices.insert(mesh.vertices.end(), strips_[e].line.begin(), strips_[e].line.end());
      for (Triangle triangle : strips_[e].triangles) {
        for (std::uint32_t& v : triangle) v = v < 2 ? ends[v] : first + v - 2;
        mesh.triangles.push_back(triangle);
        of_sheet.push_back(view_.sheet[rims_.edges[e].triangle]);
      }
    }
  }

  // --- Triangles in front of rims.

  [[nodiscard]] Strip strip_of(const RimEdge& edge, const RimReach& reach, bool is_final) const {
    const std::array ends{target_of(edge, 0), target_of(edge, 1)};
    Strip strip;
    if (!ends[0] && !ends[1]) return strip;
    const double own = std::min(view_.radius[edge.vertices[0]], view_.radius[edge.vertices[1]]);
    if (ends[0]) strip.line.push_back(ends[0]->at);
    if (ends[0] && ends[1]) {
      std::array<RimReach::Stop, 2> stops{
          {{continued_[edge.corners[0]].start, *ends[0]}, {continued_[edge.corners[1]].start, *ends[1]}}};
      for (RimReach::Stop& stop : stops) stop.start.own = edge.vertices;
      const std::vector<Vec3d> between = reach.between(stops[0], stops[1], options_.tolerance * own);
      for (const Vec3d& p : between) {
        const double gap = std::min(length(p - strip.line.back()), length(p - ends[1]->at));
        if (gap > one_point * own) strip.line.push_back(p);
      }
    }
    if (ends[1]) strip.line.push_back(ends[1]->at);
    if (ends[0] && ends[1] && strip.line.size() == 2 && length(strip.line[1] - strip.line[0]) <= one_point * own) {
      strip.is_pinched = true;
      strip.line.pop_back();
    }
    fill(edge, is_final, strip);
    return strip;
  }

  /// Fills a strip with triangles. If that fails for the whole line, the ends of the line alone are tried.
  void fill(const RimEdge& edge, bool is_final, Strip& strip) const {
    const auto is_inside = [&](const Vec3d& p) { return solid_.inside(p); };
    const std::array rim{at(edge.vertices[0]), at(edge.vertices[1])};
    for (int attempt = 0; attempt < 2; ++attempt) {
      const StripOutline outline{rim, strip.line, edge.normal};
      const auto triangles = fill_strip(outline);
      if (triangles && (!is_final || is_strip_inside(outline, *triangles, is_inside))) {
        strip.triangles = *triangles;
        return;
      }
      keep_ends(edge, strip);
      if (strip.line.empty()) break;
    }
    leave_out(strip);
  }

  /// Removes from the strip's line all points between the targets of the rim edge's ends.
  void keep_ends(const RimEdge& edge, Strip& strip) const {
    strip.line.clear();
    for (const std::size_t end : {0U, 1U}) {
      if (const RimTarget* const target = target_of(edge, end)) strip.line.push_back(target->at);
    }
    if (strip.is_pinched) strip.line.pop_back();
  }

  static void leave_out(Strip& strip) {
    strip.triangles.clear();
    strip.line.clear();
    strip.is_left_out = true;
  }

  // --- The result.

  /// Makes a new vertex of each corner's target; the two targets of a pinched strip become one vertex. If a loop
  /// consists of pinched strips, one strip is left out, because all strips together would close a hole.
  std::vector<std::uint32_t> number_new_vertices() {
    detail::UnionFind corners(rims_.corners.size());
    detail::UnionFind vertices(axis_.positions.size());
    for (std::size_t e = 0; e < strips_.size(); ++e) {
      const RimEdge& edge = rims_.edges[e];
      if (!strips_[e].is_pinched || strips_[e].is_left_out) continue;
      if (vertices.join(edge.vertices[0], edge.vertices[1])) {
        corners.join(edge.corners[0], edge.corners[1]);
      } else {
        leave_out(strips_[e]);
      }
    }
    std::vector<bool> is_used(rims_.corners.size(), false);
    for (std::size_t e = 0; e < strips_.size(); ++e) {
      if (strips_[e].triangles.empty()) continue;
      for (const std::size_t end : {0U, 1U}) {
        if (target_of(rims_.edges[e], end) != nullptr) is_used[corners.find(rims_.edges[e].corners[end])] = true;
      }
    }
    std::vector<std::uint32_t> stands_for(rims_.corners.size());
    for (std::uint32_t c = 0; c < stands_for.size(); ++c) {
      const std::uint32_t v = rims_.corners[c].vertex;
      const std::uint32_t first = corners.find(c);
      if (!continued_[c].target) {
        stands_for[c] = v;
      } else if (first != c) {
        stands_for[c] = stands_for[first];
      } else if (is_used[c]) {
        stands_for[c] = add_vertex(continued_[c].target->at, 2 * view_.radius[v]);
      }
    }
    return stands_for;
  }

  std::uint32_t add_vertex(const Vec3d& position, double thickness) {
    sheets_.positions.push_back(position);
    sheets_.thickness.push_back(thickness);
    sheets_.is_new_vertex.push_back(1);
    return static_cast<std::uint32_t>(sheets_.positions.size() - 1);
  }

  void add_strip(std::size_t e, const std::vector<std::uint32_t>& stands_for) {
    const RimEdge& edge = rims_.edges[e];
    Strip& strip = strips_[e];
    if (strip.triangles.empty()) return;
    const std::array is_moved{target_of(edge, 0) != nullptr, target_of(edge, 1) != nullptr};
    std::array ends{edge.vertices};
    for (const std::size_t end : {0U, 1U}) {
      if (is_moved[end]) ends[end] = stands_for[edge.corners[end]];
    }
    const bool is_plain = std::cmp_equal(strip.line.size(), is_moved[0] + is_moved[1]);
    // Two strips with a common border edge would close a hole.
    if (is_plain && !strip.is_pinched && !border_.insert(std::minmax(ends[0], ends[1])).second) {
      leave_out(strip);
      return;
    }
    std::vector<std::uint32_t> numbers{edge.vertices[0], edge.vertices[1]};
    for (std::size_t p = 0; p < strip.line.size(); ++p) {
      if (p == 0 && is_moved[0]) {
        numbers.push_back(ends[0]);
      } else if (p + 1 == strip.line.size() && is_moved[1]) {
        numbers.push_back(ends[1]);
      } else {
        numbers.push_back(add_vertex(strip.line[p], 2 * view_.radius[nearer_end(edge, strip.line[p])]));
      }
    }
    for (const auto& [a, b, c] : strip.triangles) {
      sheets_.triangles.push_back({numbers[a], numbers[b], numbers[c]});
      sheets_.sheet.push_back(view_.sheet[edge.triangle]);
      sheets_.is_new_triangle.push_back(1);
    }
    if (!is_moved[0]) numbers.insert(numbers.begin() + 2, ends[0]);
    if (!is_moved[1]) numbers.push_back(ends[1]);
    for (std::size_t p = 2; p + 1 < numbers.size(); ++p) {
      if (numbers[p] != numbers[p + 1]) borders_.push_back({numbers[p], numbers[p + 1]});
    }
  }

  [[nodiscard]] std::uint32_t nearer_end(const RimEdge& edge, const Vec3d& p) const {
    const auto& [a, b] = edge.vertices;
    return squared_length(p - at(a)) <= squared_length(p - at(b)) ? a : b;
  }

  /// Joins the strips to the sheets and strips that they meet.
  void join() {
    std::vector<std::array<std::uint32_t, 2>> gaps;
    for (std::size_t e = 0; e < strips_.size(); ++e) {
      if (strips_[e].is_left_out) gaps.push_back(rims_.edges[e].vertices);
    }
    const auto is_inside = [&](const Vec3d& p) { return solid_.inside(p); };
    sheets_ =
        detail::share_vertices(sheets_, axis_, {borders_, std::move(gaps), options_.tolerance}, is_inside, context_);
  }

  void finish() {
    count();
    Complex& out = out_.surface;
    out.positions = std::move(sheets_.positions);
    out.edges = std::move(sheets_.curves);
    out.triangles = std::move(sheets_.triangles);
    out.vertex_columns = Columns(out.positions.size());
    out.edge_columns = Columns(out.edges.size());
    out.triangle_columns = Columns(out.triangles.size());
    out.vertex_columns.add({std::string(extended_columns::thickness), 1, std::move(sheets_.thickness)});
    out.vertex_columns.add({std::string(extended_columns::extended), 1, std::move(sheets_.is_new_vertex)});
    out.triangle_columns.add({std::string(extended_columns::sheet), 1, std::move(sheets_.sheet)});
    out.triangle_columns.add({std::string(extended_columns::extended), 1, std::move(sheets_.is_new_triangle)});
    warn();
  }

  void warn() {
    const ExtendReport& report = out_.report;
    if (report.open_length > 0) {
      out_.warnings.emplace_back(WarningCode::not_extended,
                                 "rims of length " + rounded_text(report.open_length) + ", of " +
                                     rounded_text(report.rim_length) +
                                     " in total, are not extended: the surface is too far away, or triangles would "
                                     "fold back or leave the solid");
    }
    if (report.unshared_length > 0) {
      out_.warnings.emplace_back(
          WarningCode::not_extended,
          "extensions meet other sheets without shared vertices along a length of " +
              rounded_text(report.unshared_length) + ", and with shared vertices along " +
              rounded_text(report.seam_length) +
              ": vertices cannot be shared everywhere, because sheets do not fit or the topology would change");
    }
  }

  void count() {
    ExtendReport& report = out_.report;
    for (std::size_t e = 0; e < strips_.size(); ++e) {
      const RimEdge& edge = rims_.edges[e];
      const bool is_at_border = continued_[edge.corners[0]].stays && continued_[edge.corners[1]].stays;
      report.rim_length += edge.length;
      if (strips_[e].triangles.empty() && !is_at_border) report.open_length += edge.length;
      if (strips_[e].is_left_out) ++report.left_out;
    }
    report.rim_vertices = continued_.size();
    for (const Continued& own : continued_) {
      ++(own.stays                           ? report.at_border
         : !own.target                       ? report.not_reached
         : own.target->end == RimEnd::border ? report.reached_border
                                             : report.reached_sheet);
    }
    const auto count_of = [](const std::vector<std::int32_t>& flags) {
      return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), 1));
    };
    report.vertices = count_of(sheets_.is_new_vertex);
    report.triangles = count_of(sheets_.is_new_triangle);
    report.seam_length = sheets_.seam_length;
    report.unshared_length = sheets_.unshared_length;
    report.axis_area = area_of(axis_.positions, axis_.triangles);
    report.area = area_of(sheets_.positions, sheets_.triangles);
  }

  const Complex& axis_;
  MedialView view_;
  const Solid& solid_;
  const ExtendOptions& options_;
  const Context& context_;
  Rims rims_;
  std::vector<Continued> continued_;  ///< for each corner of the rims
  std::vector<Strip> strips_;         ///< for each edge of the rims
  std::set<std::pair<std::uint32_t, std::uint32_t>> border_;
  std::vector<std::array<std::uint32_t, 2>> borders_;  ///< outer edges of the strips
  detail::ExtendedSheets sheets_;
  ExtendedAxis out_;
};

void check_positive(std::string_view name, double value) {
  if (value > 0 && std::isfinite(value)) return;
  throw InvalidOption(std::string(name) + " is " + exact_text(value) + ", but must be above 0");
}

void check(const Complex& axis, const Solid& solid, const ExtendOptions& options) {
  check_positive("max_length", options.max_length);
  check_positive("tolerance", options.tolerance);
  if (!(options.border_radius >= 0)) {
    throw InvalidOption("border_radius is " + exact_text(options.border_radius) + ", but must be at least 0");
  }
  if (solid.rule() == SolidRule::voxels) {
    throw InvalidOption(
        "axes of images cannot be extended, because their surface is that of voxels: compute the axis of "
        "smooth_surface() instead");
  }
  if (!axis.positions.empty() && axis.vertex_columns.find(medial_columns::radius) == nullptr) {
    throw InvalidOption(missing_medial_column("vertices", medial_columns::radius));
  }
  if (!axis.triangles.empty() && axis.triangle_columns.find(medial_columns::sheet) == nullptr) {
    throw InvalidOption(missing_medial_column("triangles", medial_columns::sheet));
  }
}

}  // namespace

ExtendedAxis extend_axis(const Complex& axis, const Solid& solid, const ExtendOptions& options,
                         const Context& context) {
  check(axis, solid, options);
  const CompleteAxis all(axis);
  if (const std::string problem = problem_of_medial(all.get()); !problem.empty()) {
    throw InvalidOption("this is not a medial axis, so it cannot be extended: " + problem);
  }
  return AxisExtender(all.get(), solid, options, context).run();
}

ExtendedAxis extend_axis(const Complex& axis, const MeshView& mesh, const ExtendOptions& options,
                         const Context& context) {
  return extend_axis(axis, Solid::of(mesh, context), options, context);
}

}  // namespace blum
