#include "voronoi/traced/proof/structure_proof.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "blum/core/parallel.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/closest_point.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/traced/proof/contact.hpp"
#include "voronoi/traced/proof/site_bounds.hpp"
#include "voronoi/traced/seam_tracer.hpp"

namespace blum::voronoi {
namespace {

using Index = TracedSites::Index;
using Curve = TracedStructure::Curve;
using Junction = TracedStructure::Junction;
/// Seams leave the ball of a proven junction at this share of its radius. Points up to there are on the seam that ends
/// at the junction, as the proof in docs/theory/voronoi.md shows.
constexpr double share_of_ball = 0.3;
/// Seams pass the points in which they are cut within this share of the radius. The cuts are up to 0.33 of the radius
/// away, and the proof above holds up to 0.375.
constexpr double share_beside_cut = 0.04;
constexpr std::size_t most_halvings_of_seam = 4000;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Values and slopes of equations, with bounds on their errors.
struct Errors {
  double value = 0;
  double slope = 0;
};

Errors errors_of(std::span<const LinearBound> equations, double way) {
  Errors out;
  for (const LinearBound& f : equations) {
    const double value = f.value.error + f.error_over(way), slope = f.slope_error(way);
    out.value += value * value;
    out.slope += slope * slope;
  }
  return {std::sqrt(out.value), std::sqrt(out.slope)};
}

/// The inverse of a matrix of slopes. Bounds are Frobenius norms.
struct Inverse {
  std::vector<Vec3d> columns;
  double norm = infinite;

  [[nodiscard]] Vec3d times(std::span<const double> values) const {
    Vec3d out;
    for (std::size_t k = 0; k < values.size(); ++k) out += columns[k] * values[k];
    return out;
  }
};

Inverse with_norm(std::vector<Vec3d> columns) {
  double squared = 0;
  for (const Vec3d& column : columns) squared += squared_length(column);
  // The factor covers the rounding of the inverse, which is below 1e-9 if the norm is below 1e6.
  constexpr double rounded = 1 + 1e-6;
  const double norm = rounded * std::sqrt(squared);
  return {std::move(columns), norm < 1e6 ? norm : infinite};
}

/// Returns the inverse of three slopes.
Inverse inverse_of(const std::vector<LinearBound>& f) {
  const double det = dot(f[0].slope, cross(f[1].slope, f[2].slope));
  if (!(std::abs(det) > 0)) return {};
  return with_norm(
      {cross(f[1].slope, f[2].slope) / det, cross(f[2].slope, f[0].slope) / det, cross(f[0].slope, f[1].slope) / det});
}

/// Returns the inverse of two slopes within the plane at right angles to a direction.
Inverse inverse_across(const std::vector<LinearBound>& f, const Vec3d& along) {
  const double det = dot(along, cross(f[0].slope, f[1].slope));
  if (!(std::abs(det) > 0)) return {};
  return with_norm({cross(f[1].slope, along) / det, cross(along, f[0].slope) / det});
}

/// A ball around a junction or a vertex of the polyhedron, in which everything is known.
struct KnownBall {
  double radius = 0;
  bool is_proven = false;
  bool is_point_of_seam = false;  ///< where the list of a closed seam's points starts
};

class Prover {
 public:
  Prover(const TracedSites& sites, const MeshView& mesh, const SiteTable& table, const TracedStructure& structure,
         const Context& context)
      : sites_(sites),
        mesh_(mesh),
        structure_(structure),
        context_(context),
        bounds_(sites, mesh),
        tree_(mesh, table, context),
        triangles_at_(mesh.vertices.size()) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const std::uint32_t v : mesh.triangles[t]) triangles_at_[v].push_back(t);
    }
  }

  StructureProof prove() {
    out_.moved = bounds_.are_faces_exact() ? 0 : bounds_.moved() + bounds_.corner_error();
    count_ends();
    prove_junctions();
    prove_seams();
    list_left_out();
    return std::move(out_);
  }

 private:
  /// Lists vertices whose regions are not part of the diagram. Their widths are below 1e-7 of their lengths.
  void list_left_out() {
    constexpr double width = 1e-7;
    for (const std::uint32_t v : sites_.left_out()) {
      OpenPlace& place = out_.open.emplace_back();
      place = {sites_.vertices()[v], width * sites_.extent(), {}, VoronoiDoubt::close};
      for (Index i = 0; i < sites_.size(); ++i) {
        if (std::binary_search(sites_[i].vertices.begin(), sites_[i].vertices.end(), v)) place.sites.push_back(i);
      }
    }
  }

  void count_ends() {
    ends_.assign(structure_.junctions.size(), 0);
    seams_at_.resize(structure_.junctions.size());
    for (std::uint32_t c = 0; c < structure_.curves.size(); ++c) {
      if (structure_.curves[c].is_edge) continue;
      for (const std::uint32_t end : structure_.curves[c].ends) {
        if (end == TracedStructure::none) continue;
        ++ends_[end];
        seams_at_[end].push_back(c);
      }
    }
  }

  void prove_junctions() {
    const std::size_t count = structure_.junctions.size();
    balls_.resize(count);
    std::vector<VoronoiDoubt> doubts(count);
    parallel_for(context_, count, 16, "proof of junctions", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        const Junction& junction = structure_.junctions[k];
        balls_[k] = junction.vertex != TracedStructure::none ? cone_at(junction.vertex) : ball_at(k, doubts[k]);
      }
    });
    leave_repeated_open(doubts);
    for (std::size_t k = 0; k < count; ++k) {
      const Junction& junction = structure_.junctions[k];
      if (balls_[k].is_point_of_seam || junction.vertex != TracedStructure::none || ends_[k] == 0) continue;
      ++out_.junctions;
      if (balls_[k].is_proven) {
        ++out_.proven_junctions;
      } else {
        out_.open.push_back({junction.at, balls_[k].radius, junction.sites, doubts[k]});
      }
    }
  }

  /// Returns true if a point is where the points of a closed seam start and end.
  [[nodiscard]] bool is_start_of_loop(std::size_t k) const {
    const Junction& junction = structure_.junctions[k];
    if (ends_[k] != 2) return false;
    const Curve& curve = structure_.curves[seams_at_[k].front()];
    return curve.ends[0] == k && curve.ends[1] == k && curve.curve.sites == junction.sites &&
           length(curve.points.back() - curve.points.front()) <= sites_.tolerance();
  }

  /// Returns true if no two seams at a junction have the same sites. Otherwise, a seam may count for a missing one.
  [[nodiscard]] bool are_seams_distinct(std::size_t k) const {
    std::set<std::vector<Index>> known;
    return std::all_of(seams_at_[k].begin(), seams_at_[k].end(),
                       [&](std::uint32_t c) { return known.insert(structure_.curves[c].curve.sites).second; });
  }

  /// Junctions with the same sites are different only if their solutions are.
  void leave_repeated_open(std::vector<VoronoiDoubt>& doubts) {
    std::map<std::vector<Index>, std::vector<std::size_t>> with;
    for (std::size_t k = 0; k < balls_.size(); ++k) {
      const bool is_junction = balls_[k].is_proven && !balls_[k].is_point_of_seam;
      if (is_junction && structure_.junctions[k].vertex == TracedStructure::none) {
        with[structure_.junctions[k].sites].push_back(k);
      }
    }
    for (const auto& [own, list] : with) {
      for (std::size_t a = 0; a < list.size(); ++a) {
        for (std::size_t b = a + 1; b < list.size(); ++b) {
          // A solution lies within an eighth of the radius.
          const double apart = length(structure_.junctions[list[a]].at - structure_.junctions[list[b]].at);
          if (apart > 0.125 * (balls_[list[a]].radius + balls_[list[b]].radius)) continue;
          for (const std::size_t k : {list[a], list[b]}) {
            balls_[k] = {open_radius(), false};
            doubts[k] = VoronoiDoubt::seams;
          }
        }
      }
    }
  }

  /// Returns the radius around a junction that is not proven within which seams are left open.
  [[nodiscard]] double open_radius() const { return 256 * std::max(sites_.tolerance(), bounds_.corner_error()); }

  /// Returns the largest ball around a junction for which the proof succeeds.
  [[nodiscard]] KnownBall ball_at(std::size_t k, VoronoiDoubt& doubt) const {
    const Junction& junction = structure_.junctions[k];
    const Contact contact(bounds_, mesh_, junction.sites, 3);
    const KnownBall open{open_radius(), false};
    doubt = VoronoiDoubt::degenerate;
    if (contact.equation_count() == 2 && is_start_of_loop(k)) return {0, true, true};
    if (contact.equation_count() != 3) return open;
    doubt = VoronoiDoubt::seams;
    if (contact.degree(junction.at) != ends_[k] || !are_seams_distinct(k)) return open;
    double radius = 0.25 * sites_.distance(junction.sites[0], junction.at);
    doubt = VoronoiDoubt::close;
    constexpr int most_halvings = 40;
    for (int h = 0; h < most_halvings; ++h, radius *= 0.5) {
      if (!has_one_solution(contact, junction.at, radius)) continue;
      const Tube ball{junction.at, {}, 0, radius};
      if (contact.are_inside_domains(ball) && contact.are_closest(ball, tree_)) return {radius, true};
    }
    return open;
  }

  /// Returns true if the equations of a junction are one to one in a ball, and have a solution near its centre.
  [[nodiscard]] static bool has_one_solution(const Contact& contact, const Vec3d& at, double radius) {
    const std::vector<LinearBound> equations = contact.equations(at, radius);
    const Inverse inverse = inverse_of(equations);
    const Errors errors = errors_of(equations, 0);
    const double turn = inverse.norm * errors_of(equations, radius).slope;
    constexpr double most_turn = 1.0 / 3;
    if (!(turn <= most_turn)) return false;
    std::array<double, 3> values{};
    for (std::size_t e = 0; e < 3; ++e) values[e] = equations[e].value.value;
    return length(inverse.times(values)) + inverse.norm * errors.value <= 0.125 * (1 - turn) * radius;
  }

  /// Returns the ball around a vertex of the polyhedron in which only its own triangles matter.
  [[nodiscard]] KnownBall cone_at(std::uint32_t v) const {
    const Vec3d& at = sites_.vertices()[v];
    double radius = infinite;
    for (const std::uint32_t t : triangles_at_[v]) {
      const Triangle& corners = mesh_.triangles[t];
      const std::size_t own = corners[0] == v ? 0 : corners[1] == v ? 1 : 2;
      const Vec3d& a = sites_.vertices()[corners[(own + 1) % 3]];
      const Vec3d& b = sites_.vertices()[corners[(own + 2) % 3]];
      radius = std::min(radius, length(closest_point_on_segment(at, a, b) - at));
    }
    const auto is_other = [&](std::uint32_t t) {
      const Triangle& corners = mesh_.triangles[t];
      return std::find(corners.begin(), corners.end(), v) == corners.end();
    };
    const auto other = tree_.nearest_wanted(at + sites_.origin(), is_other);
    if (other) radius = std::min(radius, 0.5 * (other->distance - 4 * bounds_.moved()));
    return {radius, radius > 0};
  }

  struct Piece {
    Vec3d a, b;
    /// The seam has to pass each end within this distance.
    std::array<double, 2> near{infinite, infinite};
  };

  void prove_seams() {
    const std::size_t count = structure_.curves.size();
    std::vector<std::optional<OpenPlace>> open(count);
    parallel_for(context_, count, 4, "proof of seams", [&](const WorkRange& range) {
      for (std::size_t c = range.begin; c < range.end; ++c) {
        if (!structure_.curves[c].is_edge) open[c] = open_piece_of(structure_.curves[c]);
      }
    });
    for (std::size_t c = 0; c < count; ++c) {
      if (structure_.curves[c].is_edge) continue;
      ++out_.seams;
      if (open[c]) {
        out_.open.push_back(std::move(*open[c]));
      } else {
        ++out_.proven_seams;
      }
    }
  }

  /// Returns the first piece of a seam that is not proven.
  [[nodiscard]] std::optional<OpenPlace> open_piece_of(const Curve& curve) const {
    const std::vector<Index>& own = curve.curve.sites;
    const Contact contact(bounds_, mesh_, own, 2);
    const auto open = [&](const Vec3d& a, const Vec3d& b, VoronoiDoubt doubt) {
      return OpenPlace{(a + b) * 0.5, std::max(length(b - a), open_radius()), own, doubt};
    };
    const Vec3d& first = curve.points.front();
    const Vec3d& last = curve.points.back();
    if (contact.equation_count() != 2 || !contact.is_regular((first + curve.points[1]) * 0.5)) {
      return open(first, last, VoronoiDoubt::degenerate);
    }
    std::vector<Vec3d> points = curve.points;
    TraceWork work;
    const SeamTracer tracer(sites_, work);
    std::array<double, 2> near{};
    for (const std::size_t k : {0U, 1U}) {
      const std::optional<double> most = cut_end(tracer, curve, curve.ends[k], contact, points);
      if (!most) return open(structure_.junctions[curve.ends[k]].at, points.front(), VoronoiDoubt::close);
      near[k] = *most;
      std::reverse(points.begin(), points.end());
    }
    std::size_t budget = most_halvings_of_seam;
    for (std::size_t k = 1; k < points.size(); ++k) {
      const Piece part{
          points[k - 1], points[k], {k == 1 ? near[0] : infinite, k + 1 == points.size() ? near[1] : infinite}};
      if (const auto piece = open_part(tracer, curve, contact, part, budget)) {
        return open(piece->a, piece->b, VoronoiDoubt::close);
      }
    }
    return std::nullopt;
  }

  /// Cuts the first part of a seam, which lies in the ball of its first junction.
  /// @return a distance: points of the seam within it of the first point that is left belong to the seam that ends at
  ///         the junction. Nothing if the seam near the junction is not proven.
  [[nodiscard]] std::optional<double> cut_end(const SeamTracer& tracer, const Curve& curve, std::uint32_t end,
                                              const Contact& contact, std::vector<Vec3d>& points) const {
    if (balls_[end].is_point_of_seam) return infinite;
    const Junction& junction = structure_.junctions[end];
    const bool is_vertex = junction.vertex != TracedStructure::none;
    const std::vector<Index>& own = curve.curve.sites;
    if (!is_vertex && !std::includes(junction.sites.begin(), junction.sites.end(), own.begin(), own.end())) {
      return std::nullopt;
    }
    const double way = (balls_[end].is_proven ? share_of_ball : 1.0) * balls_[end].radius;
    std::size_t k = 1;
    while (k < points.size() && length(points[k] - junction.at) <= way) ++k;
    if (k == points.size()) return balls_[end].is_proven ? std::nullopt : std::optional(infinite);
    const Vec3d step = points[k] - points[k - 1];
    const double inside = length(points[k - 1] - junction.at), beyond = length(points[k] - junction.at);
    const Vec3d guess = points[k - 1] + step * std::min((way - inside) / (beyond - inside), 0.999);
    const auto cut = tracer.point_in_plane(curve.curve, guess, unit(step));
    if (!cut || !(length(*cut - junction.at) <= 1.1 * way)) return std::nullopt;
    points.erase(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(k) - 1);
    points.front() = *cut;
    if (is_vertex) return ray_of_cone(contact, junction.at, *cut, junction.vertex);
    return balls_[end].is_proven ? share_beside_cut * balls_[end].radius : infinite;
  }

  /// Returns a distance if the ray from a vertex of the polyhedron through a point is near exactly one seam. Points of
  /// seams within this distance of the point are on this seam.
  [[nodiscard]] std::optional<double> ray_of_cone(const Contact& contact, const Vec3d& apex, const Vec3d& at,
                                                  std::uint32_t vertex) const {
    const double way = length(at - apex);
    Tube section{at, unit(at - apex), 0, 0.05 * way};
    if (!contact.is_at_vertex(vertex)) return std::nullopt;
    constexpr int most_halvings = 20;
    for (int h = 0; h < most_halvings; ++h, section.radius *= 0.5) {
      if (distance_from_axis(contact, section) && contact.are_inside_domains(section) &&
          contact.are_closest(section, tree_)) {
        return 0.5 * section.radius;
      }
    }
    return std::nullopt;
  }

  /// Returns a bound on the distance of a curve with these closest sites from a tube's axis. Returns nothing unless
  /// each section of the tube contains exactly one of its points.
  [[nodiscard]] static std::optional<double> distance_from_axis(const Contact& contact, const Tube& tube) {
    const double reach = tube.reach();
    const std::vector<LinearBound> f = contact.equations(tube.centre, reach);
    const Inverse inverse = inverse_across(f, tube.along);
    const double turn = inverse.norm * errors_of(f, reach).slope;
    if (!(turn < 0.5)) return std::nullopt;
    const std::array values{f[0].value.value, f[1].value.value};
    const std::array along{dot(f[0].slope, tube.along), dot(f[1].slope, tube.along)};
    const double away = length(inverse.times(values)) + length(inverse.times(along)) * tube.half +
                        inverse.norm * errors_of(f, tube.half).value;
    return away <= (1 - turn) * tube.radius ? std::optional(away / (1 - turn)) : std::nullopt;
  }

  /// Returns the narrowest tube around a piece that the bounds allow.
  [[nodiscard]] std::optional<Tube> tube_around(const Contact& contact, const Vec3d& a, const Vec3d& b) const {
    const double size = length(b - a);
    // The ends overlap those of the next pieces.
    constexpr double width = 0.1;
    Tube tube{(a + b) * 0.5, (b - a) / size, (0.5 + width) * size, width * size};
    const std::optional<double> away = distance_from_axis(contact, tube);
    if (!away) return std::nullopt;
    tube.radius = std::min(tube.radius, std::max(2 * *away, open_radius()));
    return distance_from_axis(contact, tube) ? std::optional(tube) : std::nullopt;
  }

  /// Returns the first part of a piece that is not proven.
  /// @param budget  how often pieces may be halved.
  [[nodiscard]] std::optional<Piece> open_part(const SeamTracer& tracer, const Curve& curve, const Contact& contact,
                                               const Piece& piece, std::size_t& budget) const {
    const auto& [a, b, near] = piece;
    const double size = length(b - a);
    if (!(size > 0)) return std::nullopt;
    const std::optional<Tube> tube = tube_around(contact, a, b);
    if (tube && is_at_ends(contact, *tube, piece) && contact.are_inside_domains(*tube) &&
        contact.are_closest(*tube, tree_)) {
      return std::nullopt;
    }
    const Vec3d centre = (a + b) * 0.5;
    const bool is_small = size <= 64 * std::max(sites_.tolerance(), bounds_.corner_error());
    if (is_small || budget == 0) return piece;
    --budget;
    const auto middle = tracer.point_in_plane(curve.curve, centre, (b - a) / size);
    if (!middle || !(length(*middle - centre) < 0.5 * size)) return piece;
    if (const auto open = open_part(tracer, curve, contact, {a, *middle, {near[0], infinite}}, budget)) return open;
    return open_part(tracer, curve, contact, {*middle, b, {infinite, near[1]}}, budget);
  }

  /// Returns true if the curve in a tube passes close to both ends of its axis. Then the curves of successive tubes are
  /// one.
  [[nodiscard]] static bool is_at_ends(const Contact& contact, const Tube& tube, const Piece& piece) {
    for (const std::size_t k : {0U, 1U}) {
      const Vec3d& end = k == 0 ? piece.a : piece.b;
      const double most = std::min(0.25 * tube.radius, piece.near[k]);
      const std::vector<LinearBound> f = contact.equations(end, tube.radius);
      const Inverse inverse = inverse_across(f, tube.along);
      const double turn = inverse.norm * errors_of(f, tube.radius).slope;
      const std::array values{f[0].value.value, f[1].value.value};
      const double away = length(inverse.times(values)) + inverse.norm * errors_of(f, 0).value;
      if (!(turn < 0.5 && away <= (1 - turn) * most)) return false;
    }
    return true;
  }

  const TracedSites& sites_;
  const MeshView& mesh_;
  const TracedStructure& structure_;
  const Context& context_;
  const SiteBounds bounds_;
  const Bvh tree_;
  std::vector<std::vector<std::uint32_t>> triangles_at_;  ///< of each vertex of the mesh
  std::vector<std::size_t> ends_;                         ///< of seams at each junction
  std::vector<std::vector<std::uint32_t>> seams_at_;      ///< each junction; a closed one twice
  std::vector<KnownBall> balls_;                          ///< of each junction
  StructureProof out_;
};

}  // namespace

StructureProof prove_structure(const TracedSites& sites, const MeshView& mesh, const SiteTable& table,
                               const TracedStructure& structure, const Context& context) {
  return Prover(sites, mesh, table, structure, context).prove();
}

}  // namespace blum::voronoi
