#include "axis/rim_reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "blum/geometry/closest_point.hpp"

namespace blum::detail {
namespace {

constexpr double tangent_of_cone = 2.1445;  // of 65 degrees
constexpr double nearly_all = 1 - 1e-6;     // of the way to a point: nothing may lie in this part
constexpr double nearly_none = 1e-6;        // of the way: crossings in this part are the start itself
constexpr double passing = 0.25;            // of the radius: a way that passes a rim so closely meets its sheet
constexpr int steps_along_rim = 3;          // A way passes rims so close to its own start without meeting them.
/// A ray that is longer than the neighbouring rays by more than this factor misses the obstacle that they meet.
constexpr double longer_way = 1.5;
constexpr double longest_corner = 2.5;  // the same for ways to corners
constexpr double on_same_sheet = 0.02;  // of the radius: a sheet so close to a corner contains it
constexpr int most_halvings = 6;
/// The common point of three planes is computed only if the determinant of their unit normals is at least this.
constexpr double least_determinant = 0.05;
/// Two directions define a plane only if the sine of the angle between them is at least this.
constexpr double least_slant = 0.1;
constexpr double corner_tolerance = 1e-6;  // of the reach

struct Point2 {
  double x = 0, y = 0;
};

/// Coordinates in the plane of a start: its point is the origin, its direction the x-axis.
struct Frame {
  Vec3d origin, x, y, normal;

  [[nodiscard]] Point2 flat(const Vec3d& p) const { return {dot(p - origin, x), dot(p - origin, y)}; }
  [[nodiscard]] Vec3d lifted(const Point2& p) const { return origin + x * p.x + y * p.y; }
};

/// Returns the segment in which the frame's plane cuts a triangle; nullopt if the plane misses or contains the
/// triangle.
std::optional<std::array<Vec3d, 2>> section(const std::array<Vec3d, 3>& corners, const Frame& frame) {
  std::array<double, 3> side{};
  for (std::size_t k = 0; k < 3; ++k) side[k] = dot(corners[k] - frame.origin, frame.normal);
  std::array<Vec3d, 2> ends{};
  std::size_t found = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if ((side[k] < 0) == (side[next] < 0) || found == 2) continue;
    ends[found++] = corners[k] + (corners[next] - corners[k]) * (side[k] / (side[k] - side[next]));
  }
  return found == 2 ? std::optional(ends) : std::nullopt;
}

/// Returns the part of a segment within 65 degrees of the x-axis; nullopt if all of it lies outside.
std::optional<std::array<Point2, 2>> in_cone(const Point2& a, const Point2& b) {
  double from = 0;
  double to = 1;
  for (const double sign : {1.0, -1.0}) {
    const double at_a = tangent_of_cone * a.x + sign * a.y;  // >= 0 inside
    const double at_b = tangent_of_cone * b.x + sign * b.y;
    if (at_a < 0 && at_b < 0) return std::nullopt;
    if (at_a < 0) from = std::max(from, at_a / (at_a - at_b));
    if (at_b < 0) to = std::min(to, at_a / (at_a - at_b));
  }
  if (from > to) return std::nullopt;
  const auto on = [&](double t) { return Point2{a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t}; };
  return std::array{on(from), on(to)};
}

Point2 closest_to_origin(const std::array<Point2, 2>& segment) {
  const auto& [a, b] = segment;
  const Point2 along{b.x - a.x, b.y - a.y};
  const double square = along.x * along.x + along.y * along.y;
  const double t = square > 0 ? std::clamp(-(a.x * along.x + a.y * along.y) / square, 0.0, 1.0) : 0;
  return {a.x + along.x * t, a.y + along.y * t};
}

std::optional<Frame> frame_of(const RimStart& start) {
  if (!start.normal) return std::nullopt;
  const Vec3d across = cross(*start.normal, start.outwards);
  if (!(length(across) > 0.5)) return std::nullopt;
  const Vec3d y = across / length(across);
  return Frame{start.at, cross(y, *start.normal), y, *start.normal};
}

/// Returns the surface point closest to the origin, in the frame's plane and within 65 degrees of its x-axis. The point
/// need not be visible.
std::optional<RimTarget> closest_in_plane(const SearchMesh& surface, const Frame& frame, double reach) {
  std::optional<RimTarget> best;
  std::tuple best_of(reach, std::numeric_limits<std::uint32_t>::max());
  surface.boxes().for_each_near(frame.origin, reach, [&](std::uint32_t triangle) {
    std::array<Vec3d, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = surface.mesh().vertices[surface.mesh().triangles[triangle][k]];
    const auto cut = section(corners, frame);
    const auto seen = cut ? in_cone(frame.flat((*cut)[0]), frame.flat((*cut)[1])) : std::nullopt;
    if (!seen) return std::get<0>(best_of);
    const Point2 at = closest_to_origin(*seen);
    const std::tuple own(std::hypot(at.x, at.y), triangle);
    if (own < best_of) {
      best_of = own;
      best = RimTarget{frame.lifted(at), surface.normal(triangle)};
    }
    return std::get<0>(best_of);
  });
  return best;
}

/// Returns the common point x of three planes, each given by a normal and a point: normal . x = normal . point.
std::optional<Vec3d> meeting_point(const std::array<Vec3d, 3>& normals, const std::array<Vec3d, 3>& points) {
  const double determinant = dot(normals[0], cross(normals[1], normals[2]));
  if (std::abs(determinant) < least_determinant) return std::nullopt;
  Vec3d sum{};
  for (std::size_t k = 0; k < 3; ++k) {
    sum += cross(normals[(k + 1) % 3], normals[(k + 2) % 3]) * dot(normals[k], points[k] - points[0]);
  }
  return points[0] + sum / determinant;
}

/// Returns true if a triangle of the sheet of a start contains one of its vertices.
bool is_own(const RimStart& start, const SearchMesh& sheets, std::uint32_t number) {
  const Triangle& triangle = sheets.mesh().triangles[number];
  return start.sheet == sheets.sheet(number) &&
         std::find_first_of(triangle.begin(), triangle.end(), start.own.begin(), start.own.end()) != triangle.end();
}

/// Returns a start halfway between two starts; nullopt if their directions nearly cancel.
std::optional<RimStart> halfway(const RimStart& a, const RimStart& b) {
  RimStart out = a;
  out.at = (a.at + b.at) * 0.5;
  out.outwards = a.outwards + b.outwards;
  out.radius = (a.radius + b.radius) / 2;
  out.reach = std::max(a.reach, b.reach);
  if (a.own != b.own) out.own = {a.own[0], b.own[1]};
  if (a.normal && b.normal) {
    const Vec3d sum = *a.normal + *b.normal * (dot(*a.normal, *b.normal) < 0 ? -1.0 : 1.0);
    out.normal = sum / length(sum);
  } else if (b.normal) {
    out.normal = b.normal;
  }
  const double size = length(out.outwards);
  if (!(size > 0.1)) return std::nullopt;
  out.outwards = out.outwards / size;
  return out;
}

std::vector<Segment> segments_of(const Rims& rims) {
  std::vector<Segment> segments;
  for (const RimEdge& edge : rims.edges) segments.push_back({edge.vertices[0], edge.vertices[1]});
  return segments;
}

/// Returns true if a sheet forms at least 15 degrees with the plane of a start, or with the ray if no plane exists.
bool forms_angle(const RimStart& start, const Vec3d& way, const Vec3d& normal) {
  if (start.normal) return std::abs(dot(normal, *start.normal)) < cosine_of_meeting;
  return std::abs(dot(normal, way)) > sine_of_meeting * length(way);
}

bool is_at_sheet(const RimReach::Stop& a, const RimReach::Stop& b) {
  return a.target.end == RimEnd::sheet || b.target.end == RimEnd::sheet;
}

/// Returns the length of the longer of two rays.
double longest_way(const RimReach::Stop& a, const RimReach::Stop& b) {
  return std::max(length(a.target.at - a.start.at), length(b.target.at - b.start.at));
}

std::vector<Box3> boxes_of(const TriangleMesh& mesh) {
  std::vector<Box3> boxes(mesh.triangles.size());
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) boxes[t].extend(mesh.vertices[v]);
  }
  return boxes;
}

}  // namespace

SearchMesh::SearchMesh(TriangleMesh mesh, std::vector<std::int32_t> sheet, const Context& context)
    : mesh_(std::move(mesh)),
      sheet_(std::move(sheet)),
      bvh_(mesh_, SiteTable(mesh_, context), context),
      boxes_(boxes_of(mesh_), context) {}

Vec3d SearchMesh::normal(std::uint32_t triangle) const {
  const auto& [a, b, c] = mesh_.triangles[triangle];
  const Vec3d normal = cross(mesh_.vertices[b] - mesh_.vertices[a], mesh_.vertices[c] - mesh_.vertices[a]);
  const double size = length(normal);
  return size > 0 ? normal / size : Vec3d{};
}

RimLines::RimLines(const Complex& axis, const Rims& rims, const Context& context)
    : mesh_{.vertices = axis.positions, .segments = segments_of(rims)},
      bvh_(mesh_, SiteTable(mesh_, context), context) {
  for (const RimEdge& edge : rims.edges) {
    Vec3d normal{};  // those of single triangles at rims are rough
    for (const std::uint32_t c : edge.corners) {
      const Vec3d own = rims.corners[c].normal.value_or(edge.normal);
      normal += dot(own, normal) < 0 ? -own : own;
    }
    const double size = length(normal);
    lines_.push_back({edge.vertices, size > 0 ? normal / size : Vec3d{}});
    beside_[edge.vertices[0]].push_back(edge.vertices[1]);
    beside_[edge.vertices[1]].push_back(edge.vertices[0]);
  }
}

std::vector<std::uint32_t> RimLines::vertices_near(std::span<const std::uint32_t> vertices) const {
  std::vector<std::uint32_t> near(vertices.begin(), vertices.end());
  std::size_t from = 0;
  for (int step = 0; step < steps_along_rim; ++step) {
    const std::size_t to = near.size();
    for (; from < to; ++from) {
      if (const auto known = beside_.find(near[from]); known != beside_.end()) {
        near.insert(near.end(), known->second.begin(), known->second.end());
      }
    }
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return near;
}

void RimLines::for_each_within(const Vec3d& point, double distance, FunctionRef<void(std::uint32_t)> visit) const {
  bvh_.for_each_within(point, distance, [&](const NearestPrimitive& near) {
    visit(near.primitive);
    return true;
  });
}

std::optional<RimTarget> RimReach::on_surface(const RimStart& start) const {
  const SearchMesh& surface = *obstacles_.surface;
  std::optional<RimTarget> target;
  double reach = start.reach;
  if (const auto ahead = surface.bvh().first_crossing({start.at, start.outwards}, reach)) {
    reach = ahead->t;
    target = RimTarget{start.at + start.outwards * ahead->t, surface.normal(ahead->triangle.value)};
  }
  const std::optional<Frame> frame = frame_of(start);
  if (!frame) return target;
  const std::optional<RimTarget> closest = closest_in_plane(surface, *frame, reach);
  if (!closest) return target;
  const Vec3d way = closest->at - start.at;
  if (!(length(way) > 0)) return std::nullopt;
  if (const auto before = surface.bvh().first_crossing({start.at, way}, nearly_all)) {
    return RimTarget{start.at + way * before->t, surface.normal(before->triangle.value)};
  }
  return closest;
}

std::optional<RimTarget> RimReach::first_on_way(const SearchMesh* sheets, const RimStart& start,
                                                const Vec3d& way) const {
  if (sheets == nullptr) return std::nullopt;
  std::optional<RimTarget> first;
  double reach = nearly_all;
  sheets->bvh().for_each_crossing({start.at, way}, nearly_all, [&](const RayCrossing& crossing) {
    const Vec3d normal = sheets->normal(crossing.triangle.value);
    const bool is_met = forms_angle(start, way, normal);
    const bool is_other = !is_own(start, *sheets, crossing.triangle.value);
    if (is_other && is_met && crossing.t > nearly_none && crossing.t <= reach) {
      first = RimTarget{start.at + way * crossing.t, normal, RimEnd::sheet};
      reach = crossing.t;
    }
    return reach;
  });
  return first;
}

std::optional<RimTarget> RimReach::find(const RimStart& start) const {
  if (!(length(start.outwards) > 0)) return std::nullopt;
  std::optional<RimTarget> target = on_surface(start);
  if (!target) target = RimTarget{start.at + start.outwards * start.reach, start.outwards, RimEnd::open};
  if (const auto met = first_on_way(obstacles_.sheets, start, target->at - start.at)) target = met;
  if (const auto met = first_on_way(obstacles_.strips, start, target->at - start.at)) target = met;
  if (const auto met = first_rim(start, target->at - start.at)) target = met;
  if (target->end == RimEnd::open && !allows_open_) return std::nullopt;
  return target;
}

/// Returns the first point of a rim of another sheet that the ray passes within a tenth of the radius.
std::optional<RimTarget> RimReach::first_rim(const RimStart& start, const Vec3d& way) const {
  std::optional<RimTarget> first;
  double along = dot(way, way) * nearly_all;
  const double reach = passing * start.radius;
  const std::vector<std::uint32_t> own = obstacles_.rims->vertices_near(start.own);
  obstacles_.rims->for_each_within(start.at + way * 0.5, length(way) / 2 + reach, [&](std::uint32_t number) {
    const RimLines::Line& line = obstacles_.rims->line(number);
    const std::array ends{obstacles_.rims->at(line.ends[0]), obstacles_.rims->at(line.ends[1])};
    const auto [on_way, on_rim] = closest_points_of_segments({start.at, start.at + way}, ends);
    const bool is_own =
        std::find_first_of(line.ends.begin(), line.ends.end(), start.own.begin(), start.own.end()) != line.ends.end();
    const bool is_met = forms_angle(start, way, line.normal);
    const double of = dot(on_rim - start.at, way);
    if (is_own || !is_met || length(on_rim - on_way) > reach || !(of > 0) || of >= along) return;
    along = of;
    first = RimTarget{on_rim, line.normal, RimEnd::sheet};
  });
  return first;
}

std::vector<Vec3d> RimReach::between(const Stop& a, const Stop& b, double tolerance) const {
  std::vector<Vec3d> path;
  add_between(a, b, tolerance, 0, path);
  return path;
}

/// Returns the target within `tolerance` of a point: on the surface, or else on a sheet or strip.
std::optional<RimTarget> RimReach::at(const Vec3d& point, double tolerance, const RimStart& start) const {
  if (const auto near = obstacles_.surface->bvh().nearest_primitives(point, 1, tolerance); !near.empty()) {
    return RimTarget{near[0].point, obstacles_.surface->normal(near[0].primitive)};
  }
  return on_sheet(point, tolerance, start);
}

/// Returns the target within `tolerance` of a point, on a sheet or strip that forms at least 15 degrees with the plane
/// of the start.
std::optional<RimTarget> RimReach::on_sheet(const Vec3d& point, double tolerance, const RimStart& start) const {
  if (!start.normal) return std::nullopt;
  std::optional<RimTarget> found;
  std::tuple best(tolerance, std::numeric_limits<std::uint32_t>::max());
  for (const SearchMesh* const sheets : {obstacles_.sheets, obstacles_.strips}) {
    if (sheets == nullptr || found) continue;
    sheets->bvh().for_each_within(point, tolerance, [&](const NearestPrimitive& near) {
      const Vec3d own = sheets->normal(near.primitive);
      const std::tuple of(near.distance, near.primitive);
      if (std::abs(dot(own, *start.normal)) > cosine_of_meeting || of >= best) return true;
      if (is_own(start, *sheets, near.primitive)) return true;
      best = of;
      found = RimTarget{near.point, own, RimEnd::sheet};
      return true;
    });
  }
  return found;
}

bool RimReach::is_straight(const Stop& a, const Stop& b, double tolerance) const {
  const Vec3d chord = b.target.at - a.target.at;
  if (a.target.end == RimEnd::open) return std::abs(dot(a.target.normal, chord)) <= tolerance;
  if (b.target.end == RimEnd::open) return std::abs(dot(b.target.normal, chord)) <= tolerance;
  return at((a.target.at + b.target.at) * 0.5, tolerance, a.start.normal ? a.start : b.start).has_value();
}

void RimReach::add_between(const Stop& a, const Stop& b, double tolerance, int depth, std::vector<Vec3d>& path) const {
  const double reach = std::max(a.start.reach, b.start.reach);
  const bool is_short = length(b.target.at - a.target.at) < corner_tolerance * reach;
  if (is_short || depth == most_halvings || is_straight(a, b, tolerance)) return;
  std::optional<Stop> middle = corner(a, b);
  if (!middle) {
    const std::optional<RimStart> start = halfway(a.start, b.start);
    const std::optional<RimTarget> target = start ? find(*start) : std::nullopt;
    if (!target) return;
    if (is_at_sheet(a, b) && length(target->at - start->at) > longer_way * longest_way(a, b)) return;
    middle = Stop{*start, *target};
  }
  add_between(a, *middle, tolerance, depth + 1, path);
  path.push_back(middle->target.at);
  add_between(*middle, b, tolerance, depth + 1, path);
}

/// Returns the point where the planes at two targets intersect, in a plane between their starts. Returns nullopt if no
/// obstacle is at that point.
std::optional<RimReach::Stop> RimReach::corner(const Stop& a, const Stop& b) const {
  const std::optional<RimStart> start = halfway(a.start, b.start);
  if (!start) return std::nullopt;
  // The plane between the starts contains both targets. The sheet's own plane may be tilted, and thus far from the
  // corner.
  const double gap = length(b.target.at - a.target.at);
  Vec3d normal = cross(b.target.at - a.target.at, start->outwards) / gap;
  if (length(normal) < least_slant) normal = start->normal.value_or(Vec3d{});
  if (length(normal) > 0) normal = normal / length(normal);
  const Vec3d middle = (a.target.at + b.target.at) * 0.5;
  const auto meeting = meeting_point({a.target.normal, b.target.normal, normal}, {a.target.at, b.target.at, middle});
  if (!meeting) return std::nullopt;
  const double off = std::min(length(*meeting - a.target.at), length(*meeting - b.target.at));
  if (off > 2 * start->reach || length(*meeting - middle) > 8 * gap) return std::nullopt;
  if (is_at_sheet(a, b)) {
    const bool is_beside = obstacles_.strips != nullptr && !on_sheet(*meeting, on_same_sheet * start->radius, *start);
    if (is_beside || length(*meeting - start->at) > longest_corner * longest_way(a, b)) return std::nullopt;
  }
  const std::optional<RimTarget> target = at(*meeting, corner_tolerance * start->reach, *start);
  return target ? std::optional(Stop{*start, *target}) : std::nullopt;
}

}  // namespace blum::detail
