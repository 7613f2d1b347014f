#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "certificate/sampling.hpp"
#include "certificate/segments.hpp"
#include "certificate/shells.hpp"
#include "certificate/solid_oracle.hpp"
#include "certificate/stated_sites.hpp"
#include "certificate/surface_walls.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {
namespace {

/// Decides if a path along the surface joins the points where a segment leaves a body and enters it again. If the
/// segment only cuts an edge of the solid, however closely, such a path exists. If the segment crosses a gap, however
/// narrow, no such path exists.
class GapSearch {
 public:
  /// All arguments must outlive this object.
  /// @param search  the triangles of the mesh, with bodies as groups.
  /// @param beside  for each side of a triangle, the triangle on its other side.
  GapSearch(const SolidOracle& solid, const TriangleSearch& search, const MeshView& mesh,
            std::span<const std::uint32_t> body_of, std::span<const std::uint32_t> beside)
      : solid_(solid), search_(search), mesh_(mesh), body_of_(body_of), beside_(beside) {}

  /// Returns true if, for a part of the segment outside the body, no path along the surface within `reach` joins its
  /// ends. Returns nullopt if this is undecided.
  [[nodiscard]] std::optional<bool> crosses(const Vec3d& a, const Vec3d& b, std::uint32_t body, double reach) const;

 private:
  /// A point where a segment meets the surface, or an end of the segment that is not inside.
  struct Meeting {
    Vec3d at;
    std::uint32_t triangle = 0;
  };

  [[nodiscard]] std::optional<std::vector<Meeting>> meetings(const Vec3d& a, const Vec3d& b, std::uint32_t body) const;
  [[nodiscard]] std::optional<bool> are_joined(const Meeting& from, const Meeting& to, double reach) const;

  const SolidOracle& solid_;
  const TriangleSearch& search_;
  const MeshView& mesh_;
  std::span<const std::uint32_t> body_of_;
  std::span<const std::uint32_t> beside_;
};

std::optional<bool> GapSearch::crosses(const Vec3d& a, const Vec3d& b, std::uint32_t body, double reach) const {
  const auto met = meetings(a, b, body);
  if (!met) return std::nullopt;
  const double nothing = 1e-13 * solid_.diagonal();
  bool is_decided = true;
  for (std::size_t k = 0; k + 1 < met->size(); ++k) {
    const Meeting& from = (*met)[k];
    const Meeting& to = (*met)[k + 1];
    if (from.triangle == to.triangle || solid_.depth(0.5 * (from.at + to.at), body) > 0) continue;
    const std::optional<bool> joined = are_joined(from, to, reach);
    if (joined == true) continue;
    if (joined == false && length(to.at - from.at) > nothing) return true;
    is_decided = false;
  }
  return is_decided ? std::optional(false) : std::nullopt;
}

std::optional<std::vector<GapSearch::Meeting>> GapSearch::meetings(const Vec3d& a, const Vec3d& b,
                                                                   std::uint32_t body) const {
  constexpr std::uint32_t most_attempts = 8;
  const double nothing = 1e-13 * solid_.diagonal();
  const double whole = length(b - a);
  std::vector<Meeting> met;
  const auto add_end = [&](const Vec3d& p) {
    if (solid_.depth(p, body) <= nothing) met.push_back({p, search_.nearest(p, body).triangle});
  };
  add_end(a);
  if (!(whole > nothing)) return met;
  Random random(0x9a9U);
  std::vector<Crossing> crossings;
  bool is_certain = search_.crossings(line_between(a, b), crossings, whole);
  // A segment that passes through edges of the mesh is undecided. Segments next to it may be decided.
  double aside = 0;
  for (std::uint32_t k = 0; k < most_attempts && !is_certain; ++k) {
    const Vec3d from = a + random.in_ball() * aside;
    const Vec3d to = b + random.in_ball() * aside;
    is_certain = search_.exact_crossings(from, to, body, crossings);
    aside = std::max(4 * aside, nothing);
  }
  if (!is_certain) return std::nullopt;
  std::erase_if(crossings, [&](const Crossing& one) {
    return body_of_[one.triangle] != body || one.at < -nothing || one.at > whole + nothing;
  });
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& p, const Crossing& q) { return p.at < q.at; });
  for (const Crossing& one : crossings) {
    met.push_back({a + (b - a) * std::clamp(one.at / whole, 0.0, 1.0), one.triangle});
  }
  add_end(b);
  return met;
}

std::optional<bool> GapSearch::are_joined(const Meeting& from, const Meeting& to, double reach) const {
  constexpr std::size_t most_triangles = 20'000;
  const Segment3 between{from.at, to.at};
  std::unordered_set<std::uint32_t> seen{from.triangle};
  std::vector<std::uint32_t> line{from.triangle};
  while (!line.empty()) {
    const std::uint32_t t = line.back();
    line.pop_back();
    if (t == to.triangle) return true;
    if (seen.size() > most_triangles) return std::nullopt;
    const std::array<Vec3d, 3> corners = corners_of(mesh_, t);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = beside_[3 * t + k];
      if (seen.contains(other)) continue;
      const Segment3 side{corners[k], corners[(k + 1) % 3]};
      if (squared_distance(between, side) > reach * reach) continue;
      seen.insert(other);
      line.push_back(other);
    }
  }
  return false;
}

class ShellOracle : public SolidOracle {
 public:
  ShellOracle(const MeshView& mesh, const MeshView& named, ClosedShells shells, TriangleSearch shell_search,
              const Context& context)
      : mesh_(mesh),
        named_(named),
        shells_(std::move(shells)),
        body_of_(shells_.of_triangle),
        boxes_(shells_.bodies),
        surfaces_(shells_.bodies),
        corners_(shells_.bodies),
        sites_(named, context) {
    for (std::size_t t = 0; t < body_of_.size(); ++t) {
      if (body_of_[t] == no_group) continue;
      body_of_[t] = shells_.shells[body_of_[t]].body;
      for (const std::uint32_t v : mesh.triangles[t]) boxes_[body_of_[t]].extend(mesh.vertices[v]);
    }
    for (std::uint32_t t = 0; t < body_of_.size(); ++t) {
      if (body_of_[t] == no_group || shells_.outwards[t] == 0) continue;
      const auto [a, b, c] = corners_of(mesh_, t);
      surfaces_[body_of_[t]].add(length(cross(b - a, c - a)), t);
    }
    find_corners();
    search_ = shells_.shells.size() == 1 ? std::move(shell_search) : TriangleSearch(mesh, body_of_, context);
  }

  [[nodiscard]] double diagonal() const override { return search_.bounds().diagonal(); }

  [[nodiscard]] Location locate(const Vec3d& p) const override {
    const TriangleSearch::Nearest closest = search_.nearest(p);
    if (side_of(p, closest) == Side::inside) {
      return {body_of_[closest.triangle], closest.distance, 0, closest.distance};
    }
    if (const std::optional<std::uint32_t> shell = innermost_around(p)) {
      const ClosedShell& around = shells_.shells[*shell];
      const double own = distance(p, around.body);
      const bool is_inside = around.depth % 2 == 0;
      return {around.body, own, is_inside ? 0 : own, is_inside ? own : -own};
    }
    return {body_of_[closest.triangle], closest.distance, closest.distance, -closest.distance};
  }

  [[nodiscard]] double distance(const Vec3d& p, std::uint32_t body) const override {
    return search_.nearest(p, body).distance;
  }

  [[nodiscard]] double distance_above(const Vec3d& p, double enough, std::uint32_t body) const override {
    return search_.distance_above(p, enough, body);
  }

  [[nodiscard]] Samples make_samples(double step, const Context& context) const override {
    return samples_of_triangles(mesh_, body_of_, step, context);
  }

  [[nodiscard]] Box3 box(std::uint32_t body) const override { return boxes_[body]; }

  [[nodiscard]] bool has_triangles() const override { return true; }

  [[nodiscard]] std::optional<Vec3d> beside_surface(std::uint32_t body, Random& random) const override {
    if (!(surfaces_[body].total() > 0)) return std::nullopt;
    const std::uint32_t t = surfaces_[body].at(random.uniform());
    const std::array<Vec3d, 3> corners = corners_of(mesh_, t);
    const bool is_void = shells_.shells[shells_.of_triangle[t]].depth % 2 == 1;
    const double inwards = (shells_.outwards[t] > 0) == is_void ? 1 : -1;
    const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    return random_point(corners, random) + normal * (inwards * 1e-7 * boxes_[body].diagonal() / length(normal));
  }

  [[nodiscard]] std::size_t corners(std::uint32_t body) const override { return corners_[body].size(); }

  [[nodiscard]] std::optional<Vec3d> behind_corner(std::uint32_t body, std::size_t corner) const override {
    constexpr std::uint32_t most_attempts = 4;
    constexpr double aside = 0.02;  // a chord of a regular shape may meet an edge exactly
    const Vec3d inwards = inwards_at(corners_[body][corner]);
    const Vec3d from = mesh_.vertices[vertex_of(corners_[body][corner])];
    Random random(0xc04eULL + corner);
    for (std::uint32_t attempt = 0; attempt < most_attempts; ++attempt) {
      const std::optional<Vec3d> middle = middle_of_chord(from, inwards + random.in_ball() * aside, body);
      if (middle) return middle;
    }
    return std::nullopt;
  }

  [[nodiscard]] double depth(const Vec3d& p, std::uint32_t body) const override {
    const TriangleSearch::Nearest closest = search_.nearest(p, body);
    const double own = closest.distance;
    if (const Side side = side_of(p, closest); side != Side::unknown) return side == Side::inside ? own : -own;
    const std::optional<std::uint32_t> shell = innermost_around(p);
    return shell && shells_.shells[*shell].body == body && shells_.shells[*shell].depth % 2 == 0 ? own : -own;
  }

  [[nodiscard]] double depth_beside(const Vec3d& p, std::uint32_t body, const Vec3d& other, double other_depth,
                                    double near) const override {
    const double own = distance(p, body);
    if (own < near) return -own;
    if (std::abs(other_depth) <= near) return depth(p, body);
    const bool other_is_inside = other_depth > 0;
    const double reach = length(other - p);
    const double nothing = 1e-13 * diagonal();
    if (reach < own) return other_is_inside ? own : -own;
    std::vector<Crossing> crossings;
    if (!(reach > nothing) || !search_.crossings(line_between(p, other), crossings, reach)) return depth(p, body);
    bool is_inside = other_is_inside;
    for (const Crossing& crossing : crossings) {
      if (body_of_[crossing.triangle] != body) continue;
      if (std::abs(crossing.at) <= nothing || std::abs(crossing.at - reach) <= nothing) return depth(p, body);
      if (crossing.at > 0 && crossing.at < reach) is_inside = !is_inside;
    }
    return is_inside ? own : -own;
  }

  /// If both ends lie on one triangle of the boundary, the whole segment does, such as on an edge at which a sheet
  /// ends.
  [[nodiscard]] bool holds(const Vec3d& a, const Vec3d& b, std::uint32_t body) const override {
    const double nothing = 1e-11 * diagonal();
    const TriangleSearch::Nearest closest = search_.nearest(0.5 * (a + b), body);
    if (!(closest.distance <= nothing)) return false;
    const std::array<Vec3d, 3> corners = corners_of(mesh_, closest.triangle);
    if (std::max(squared_distance(a, corners), squared_distance(b, corners)) > nothing * nothing) return false;
    return has_one_wall(a, closest.triangle, nothing, body) && has_one_wall(b, closest.triangle, nothing, body);
  }

  [[nodiscard]] bool is_clear(const Vec3d& a, const Vec3d& b, std::uint32_t body) const override {
    const double reach = length(b - a);
    const double nothing = 1e-13 * diagonal();
    std::vector<Crossing> crossings;
    if (!(reach > nothing)) return false;
    if (!search_.crossings(line_between(a, b), crossings, reach)) {
      // The line may pass through an edge of the mesh beyond the segment.
      return search_.exact_crossings(a, b, body, crossings) && crossings.empty();
    }
    return std::none_of(crossings.begin(), crossings.end(), [&](const Crossing& crossing) {
      return body_of_[crossing.triangle] == body && crossing.at >= -nothing && crossing.at <= reach + nothing;
    });
  }

  /// If the boundary passes through a triangle, it meets one of the triangle's sides, or an edge of the boundary
  /// pierces the triangle.
  [[nodiscard]] bool is_clear(const std::array<Vec3d, 3>& triangle, std::uint32_t body) const override {
    const auto& [a, b, c] = triangle;
    return is_clear(a, b, body) && is_clear(b, c, body) && is_clear(c, a, body) && search_.is_unpierced(triangle, body);
  }

  [[nodiscard]] std::optional<bool> crosses_gap(const Vec3d& a, const Vec3d& b, std::uint32_t body,
                                                double reach) const override {
    return GapSearch(*this, search_, mesh_, body_of_, shells_.beside).crosses(a, b, body, reach);
  }

  [[nodiscard]] Vec3d closest_point(const Vec3d& p, std::uint32_t body) const override {
    return closest_point_within(p, HUGE_VAL, body);
  }

  [[nodiscard]] Vec3d closest_point_within(const Vec3d& p, double within, std::uint32_t body) const override {
    return search_.closest_point_within(p, within, body);
  }

  [[nodiscard]] std::unique_ptr<Complement> make_complement(const Context& context) const override {
    std::vector<std::vector<std::uint32_t>> walls(shells_.shells.size());  // for each void: its triangles
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const std::uint32_t shell = shells_.of_triangle[t];
      if (shell != no_group && shells_.shells[shell].depth % 2 == 1) walls[shell].push_back(t);
    }
    const auto points = [&](std::uint32_t shell) { return points_of_void(shell, walls[shell]); };
    return std::make_unique<Complement>(complement_of_mesh(mesh_, shells_, points, context));
  }

  [[nodiscard]] std::array<std::uint32_t, 2> walls_at(const Vec3d& point, std::uint32_t body) const override {
    std::vector<std::uint32_t> at;
    search_.find_within(point, 1e-9 * diagonal(), body, at);
    if (at.empty()) at.push_back(search_.nearest(point, body).triangle);
    std::array<std::uint32_t, 2> both{walls().of(at[0]), walls().of(at[0])};
    for (const std::uint32_t t : at) both = {std::min(both[0], walls().of(t)), std::max(both[1], walls().of(t))};
    return both;
  }

  [[nodiscard]] bool are_smooth(std::uint32_t wall, std::uint32_t other) const override {
    return walls().smooth_part_of_wall(wall) == walls().smooth_part_of_wall(other);
  }

  [[nodiscard]] const StatedSites* stated_sites() const override {
    if (mesh_.triangles.data() != named_.triangles.data()) return nullptr;
    return &stated_sites_.get([&] { return StatedSites(mesh_, sites_, shells_, walls()); });
  }

  [[nodiscard]] double distance_from_site(const Vec3d& p, SiteId site) const override {
    return verifier::distance_from_site(named_, sites_, p, site);
  }

 private:
  enum class Side { inside, outside, unknown };

  [[nodiscard]] const SurfaceWalls& walls() const {
    return walls_.get([&] { return SurfaceWalls(mesh_, shells_, body_of_); });
  }

  /// Returns on which side of the boundary a point lies, judged by its closest triangle. No other part of the boundary
  /// lies between them. If the closest point belongs to no other triangle, the height above the triangle decides. If it
  /// lies on the edge to exactly one other triangle, the sum of both heights decides (Baerentzen and Aanaes 2005).
  [[nodiscard]] Side side_of(const Vec3d& p, const TriangleSearch::Nearest& closest) const {
    constexpr double nearly = 1 - 1e-6;
    constexpr double clearly = 0.1;  // of the distance: excludes edges as sharp as a knife
    constexpr double next_to =
        1e-7;  // of the diagonal: for closer points, rounding may miss other triangles at a corner
    if (!closest.others || *closest.others > 1) return Side::unknown;
    if (!(closest.distance > (*closest.others == 1 ? next_to : 1e-9) * diagonal())) return Side::unknown;
    const std::optional<double> own = height_above(closest.triangle, p, closest.distance);
    if (!own) return Side::unknown;
    double height = *own;
    double least = nearly * closest.distance;
    if (*closest.others == 1) {
      const std::optional<double> beside = height_above(closest.other, p, closest.distance);
      if (!beside || !are_beside(closest.triangle, closest.other)) return Side::unknown;
      height += *beside;
      least = clearly * closest.distance;
    }
    if (!(std::abs(height) >= least)) return Side::unknown;
    const bool is_void = shells_.shells[shells_.of_triangle[closest.triangle]].depth % 2 == 1;
    return (height < 0) != is_void ? Side::inside : Side::outside;
  }
  /// Returns the height of a point above the plane of a triangle, positive outside its shell. Returns nullopt if
  /// rounding makes it too inexact relative to the point's distance from the triangle. Rounding turns the normals of
  /// thin triangles.
  [[nodiscard]] std::optional<double> height_above(std::uint32_t triangle, const Vec3d& p, double distance) const {
    const auto [a, b, c] = corners_of(mesh_, triangle);
    // With L as the longest side, rounding turns a normal by up to rounding * L^2 / size, and changes a height by L
    // times that.
    constexpr double rounding = 1e-13;
    const Vec3d normal = cross(b - a, c - a);
    const double size = length(normal);
    const double longest = std::max({squared_length(b - a), squared_length(c - b), squared_length(a - c)});
    const double cubed = longest * std::sqrt(longest);
    if (shells_.outwards[triangle] == 0 || !(size * distance > rounding * cubed)) return std::nullopt;
    return shells_.outwards[triangle] * dot(p - a, normal) / size;
  }

  /// Returns true if the triangles within a distance of a point are joined to the given one by edges among them. At a
  /// narrow gap, the triangles are not joined.
  [[nodiscard]] bool has_one_wall(const Vec3d& p, std::uint32_t triangle, double within, std::uint32_t body) const {
    std::vector<std::uint32_t> near;
    search_.find_within(p, 2 * within, body, near);
    std::vector<std::uint32_t> line{triangle};
    std::unordered_set<std::uint32_t> left(near.begin(), near.end());
    left.erase(triangle);
    while (!line.empty() && !left.empty()) {
      const std::uint32_t t = line.back();
      line.pop_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t beside = shells_.beside[3 * std::size_t{t} + k];
        if (left.erase(beside) > 0) line.push_back(beside);
      }
    }
    return left.empty();
  }

  [[nodiscard]] bool are_beside(std::uint32_t triangle, std::uint32_t other) const {
    const auto first = shells_.beside.begin() + 3 * static_cast<std::ptrdiff_t>(triangle);
    return std::find(first, first + 3, other) != first + 3;
  }

  /// Returns points deep in a void. The first is the deepest of the middles of some chords. Further points lie on
  /// opposite sides of the first point, halfway to the wall. The middles of other chords are added if they are at least
  /// half as deep. Flat triangles of an axis in a curved wall may stick out of the wall. So a point near the wall may
  /// be on either side of them.
  [[nodiscard]] std::vector<Vec3d> points_of_void(std::uint32_t shell, const std::vector<std::uint32_t>& walls) const {
    constexpr std::size_t pairs = 4;
    constexpr std::size_t most_middles = 16;
    constexpr double share = 0.5;
    const std::vector<DeepPoint> middles = middles_of_chords(shell, walls);
    if (middles.empty()) return {mesh_.vertices[mesh_.triangles[walls.front()][0]]};
    const DeepPoint best = *std::max_element(middles.begin(), middles.end(),
                                             [](const DeepPoint& p, const DeepPoint& q) { return p.depth < q.depth; });
    std::vector<Vec3d> points{best.at};
    Random random(0x701dU);
    for (std::size_t k = 0; k < pairs; ++k) {
      const Vec3d aside = random.in_ball();
      const Vec3d step = aside * (share * best.depth / length(aside));
      points.push_back(best.at + step);
      points.push_back(best.at - step);
    }
    const std::size_t every = (middles.size() + most_middles - 1) / most_middles;
    for (std::size_t k = 0; k < middles.size(); k += every) {
      if (middles[k].depth >= share * best.depth) points.push_back(middles[k].at);
    }
    return points;
  }

  /// Corner of a triangle: 3 * triangle + 0, 1 or 2.
  using Corner = std::uint32_t;

  [[nodiscard]] std::uint32_t vertex_of(Corner corner) const { return mesh_.triangles[corner / 3][corner % 3]; }
  /// Finds one corner at each vertex of the bodies' surfaces.
  void find_corners() {
    std::vector<bool> is_found(mesh_.vertices.size(), false);
    for (std::uint32_t t = 0; t < body_of_.size(); ++t) {
      if (body_of_[t] == no_group || shells_.outwards[t] == 0) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh_.triangles[t][k];
        if (!is_found[v]) corners_[body_of_[t]].push_back(3 * t + k);
        is_found[v] = true;
      }
    }
  }
  /// Returns the mean direction of the triangles around a vertex, into the body. The weight of a triangle is its angle
  /// at the vertex, so that the division into triangles does not matter. The result is not a unit vector, and may be
  /// zero.
  [[nodiscard]] Vec3d inwards_at(Corner corner) const {
    constexpr int most_triangles = 1024;
    const std::uint32_t v = vertex_of(corner);
    const bool is_void = shells_.shells[shells_.of_triangle[corner / 3]].depth % 2 == 1;
    Vec3d sum;
    std::uint32_t t = corner / 3;
    std::uint32_t before = no_group;
    for (int n = 0; n < most_triangles; ++n) {
      const Triangle& own = mesh_.triangles[t];
      const std::uint32_t k = own[0] == v ? 0 : own[1] == v ? 1 : 2;
      const Vec3d& at = mesh_.vertices[v];
      const Vec3d p = mesh_.vertices[own[(k + 1) % 3]] - at;
      const Vec3d q = mesh_.vertices[own[(k + 2) % 3]] - at;
      const Vec3d normal = cross(p, q);
      if (const double size = length(normal); size > 0) {
        const double inwards = (shells_.outwards[t] > 0) == is_void ? 1 : -1;
        sum += normal * (inwards * std::atan2(size, dot(p, q)) / size);
      }
      // The sides at the vertex lead to the triangles before and after this one.
      const std::uint32_t first = shells_.beside[3 * t + k];
      const std::uint32_t second = shells_.beside[3 * t + (k + 2) % 3];
      const std::uint32_t next = first == before ? second : first;
      before = std::exchange(t, next);
      if (t == corner / 3) break;
    }
    return sum;
  }
  /// Returns the middle of the part in a body of a line from a vertex.
  [[nodiscard]] std::optional<Vec3d> middle_of_chord(const Vec3d& from, const Vec3d& direction,
                                                     std::uint32_t body) const {
    const double size = length(direction);
    const double reach = boxes_[body].diagonal();
    const double nothing = 1e-7 * reach;
    if (!(size > 0) || !(nothing > 0)) return std::nullopt;
    const Vec3d start = from + direction * (nothing / size);
    std::vector<Crossing> crossings;
    if (!search_.crossings(line_between(start, from + direction * (reach / size)), crossings, reach)) {
      return std::nullopt;
    }
    double first = HUGE_VAL;
    for (const Crossing& crossing : crossings) {
      if (body_of_[crossing.triangle] == body && crossing.at > 0) first = std::min(first, crossing.at);
    }
    if (!(first < reach)) return std::nullopt;
    return start + direction * (0.5 * first / size);
  }

  struct DeepPoint {
    Vec3d at;
    double depth = 0;  ///< distance from the wall of a void, above 0
  };

  /// Returns the middles of chords of a void that start at some of its triangles.
  [[nodiscard]] std::vector<DeepPoint> middles_of_chords(std::uint32_t shell,
                                                         const std::vector<std::uint32_t>& walls) const {
    constexpr std::size_t most_chords = 32;
    std::vector<DeepPoint> middles;
    const std::size_t every = (walls.size() + most_chords - 1) / most_chords;
    for (std::size_t k = 0; k < walls.size(); k += every) {
      for (const double side : {1.0, -1.0}) {
        const std::optional<Vec3d> middle = middle_of_chord(walls[k], side);
        if (!middle || innermost_around(*middle) != shell) continue;
        const double depth = search_.nearest(*middle).distance;
        if (depth > 0) middles.push_back({*middle, depth});
      }
    }
    return middles;
  }

  /// Returns the point halfway between the centre of a triangle and the first triangle that its normal meets. Returns
  /// nullopt if the normal meets nothing, or if that is undecided.
  [[nodiscard]] std::optional<Vec3d> middle_of_chord(std::uint32_t triangle, double side) const {
    const std::array<Vec3d, 3> corners = corners_of(mesh_, triangle);
    const Vec3d start = (corners[0] + corners[1] + corners[2]) / 3.0;
    const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (!(length(normal) > 0)) return std::nullopt;
    const double reach = diagonal();
    const Vec3d end = start + normal * (side * reach / length(normal));
    std::vector<Crossing> crossings;
    if (!search_.crossings(line_between(start, end), crossings, reach)) return std::nullopt;
    double first = reach;
    for (const Crossing& crossing : crossings) {
      if (crossing.triangle != triangle && crossing.at > 0) first = std::min(first, crossing.at);
    }
    if (!(first < reach)) return std::nullopt;
    return start + (end - start) * (0.5 * first / reach);
  }

  /// Returns the innermost shell around a point; nullopt if there is none, or if the point lies on the surface.
  [[nodiscard]] std::optional<std::uint32_t> innermost_around(const Vec3d& p) const {
    constexpr std::uint32_t most_lines = 24;
    const double nothing = 1e-13 * diagonal();
    std::vector<Crossing> crossings;
    std::vector<std::uint32_t> ahead;
    std::vector<std::uint32_t> all;
    for (std::uint32_t attempt = 0; attempt < most_lines; ++attempt) {
      if (!search_.crossings(line_through(p, attempt), crossings)) continue;
      ahead.clear();
      all.clear();
      bool is_certain = true;
      for (const Crossing& crossing : crossings) {
        is_certain = is_certain && std::abs(crossing.at) > nothing;
        const std::uint32_t shell = shells_.of_triangle[crossing.triangle];
        all.push_back(shell);
        if (crossing.at > 0) ahead.push_back(shell);
      }
      if (!is_certain || !odd_ones(all).empty()) continue;
      std::optional<std::uint32_t> innermost;
      for (const std::uint32_t shell : odd_ones(ahead)) {
        if (!innermost || shells_.shells[shell].depth > shells_.shells[*innermost].depth) innermost = shell;
      }
      return innermost;
    }
    return std::nullopt;
  }

  /// Returns the shells that are listed an odd number of times.
  static std::vector<std::uint32_t> odd_ones(std::vector<std::uint32_t>& shells) {
    std::sort(shells.begin(), shells.end());
    std::vector<std::uint32_t> odd;
    for (const std::uint32_t shell : shells) {
      if (!odd.empty() && odd.back() == shell) {
        odd.pop_back();
      } else {
        odd.push_back(shell);
      }
    }
    return odd;
  }

  MeshView mesh_;
  MeshView named_;  ///< mesh whose sites distance_from_site() uses
  ClosedShells shells_;
  std::vector<std::uint32_t> body_of_;        ///< for each triangle
  std::vector<Box3> boxes_;                   ///< for each body
  std::vector<Spread> surfaces_;              ///< for each body: its triangles
  std::vector<std::vector<Corner>> corners_;  ///< for each body: one corner at each vertex
  SiteTable sites_;                           ///< sites of `named_`
  TriangleSearch search_;                     ///< with bodies as groups
  Lazy<SurfaceWalls> walls_;
  Lazy<StatedSites> stated_sites_;
};

}  // namespace

KnownSolid solid_of_mesh(const MeshView& mesh, const MeshView& named, const Context& context) {
  ClosedShells shells = cut_into_shells(mesh, context);
  TriangleSearch search(mesh, shells.of_triangle, context);
  nest(shells, mesh, search, context);
  std::vector<BettiNumbers> bodies = betti_numbers(shells);
  return {std::make_unique<ShellOracle>(mesh, named, std::move(shells), std::move(search), context), std::move(bodies)};
}

}  // namespace blum::verifier
