#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/geometry/ear_clipping.hpp"
#include "blum/geometry/orient2d.hpp"
#include "io/mesh/mesh_builder.hpp"

namespace blum {
namespace {

/// Corner of a polygon, projected along a coordinate axis.
using Point = std::array<double, 2>;

/// Projects the corners of a polygon along the coordinate axis closest to its mean normal (Newell's). The result is
/// counter-clockwise, and scaled by a power of two. Both steps are exact, so corners that lie on edges stay on them.
/// Together, both steps are an affine map of the polygon's plane.
/// @returns empty if the area of the polygon is negligible.
std::vector<Point> flattened(std::span<const Vec3d> vertices, std::span<const std::uint32_t> corners) {
  Box3 box;
  for (const std::uint32_t corner : corners) box.extend(vertices[corner]);
  const Vec3d origin = box.lower;
  // Computed from halves, because the difference itself might overflow.
  const Vec3d size = box.upper * 0.5 - box.lower * 0.5;
  const double largest = std::max({size.x, size.y, size.z});
  if (!(largest > 0)) return {};
  const auto scaled = [&](std::uint32_t corner) {
    const Vec3d v = vertices[corner] * 0.5 - origin * 0.5;
    return Vec3d{v.x / largest, v.y / largest, v.z / largest};
  };
  Vec3d normal;
  Vec3d last = scaled(corners.back());
  for (const std::uint32_t corner : corners) {
    const Vec3d next = scaled(corner);
    normal += cross(last, next);
    last = next;
  }
  const Vec3d magnitude = {std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
  const std::size_t axis = magnitude.z >= magnitude.x && magnitude.z >= magnitude.y ? 2
                           : magnitude.y >= magnitude.x                             ? 1
                                                                                    : 0;
  constexpr double rounding = 1e-15;  // each term above is below 1 and has an error of about 1e-16
  if (!(magnitude[axis] > rounding * static_cast<double>(corners.size()))) return {};
  std::vector<Point> points;
  points.reserve(corners.size());
  double reach = 0;
  for (const Vec3d& end : {box.lower, box.upper})
    reach = std::max({reach, std::abs(end.x), std::abs(end.y), std::abs(end.z)});
  const double scale = std::ldexp(1.0, std::clamp(-std::ilogb(reach), -1000, 1000));
  for (const std::uint32_t corner : corners) {
    const Vec3d v = vertices[corner] * scale;
    const Point p = {v[(axis + 1) % 3], v[(axis + 2) % 3]};
    points.push_back(normal[axis] > 0 ? p : Point{p[1], p[0]});
  }
  return points;
}

/// Returns true if the outline turns left at every corner and goes around once.
bool is_strictly_convex(const std::vector<Point>& points) {
  const std::size_t n = points.size();
  std::size_t upward_starts = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point& a = points[i];
    const Point& b = points[i + 1 < n ? i + 1 : i + 1 - n];
    const Point& c = points[i + 2 < n ? i + 2 : i + 2 - n];
    if (detail::orient2d(a, b, c) <= 0) return false;
    const bool first_up = b[1] > a[1] || (b[1] == a[1] && b[0] > a[0]);
    const bool second_up = c[1] > b[1] || (c[1] == b[1] && c[0] > b[0]);
    upward_starts += !first_up && second_up ? 1 : 0;
  }
  return upward_starts == 1;
}

void cut_as_fan(std::span<const std::uint32_t> corners, std::span<Triangle> triangles) {
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) triangles[i] = {corners[0], corners[i + 1], corners[i + 2]};
}

}  // namespace

bool cut_polygon(std::span<const Vec3d> vertices, std::span<const std::uint32_t> corners, std::span<Triangle> triangles,
                 std::int64_t& work_left) {
  const std::vector<Point> points = flattened(vertices, corners);
  if (!points.empty() && is_strictly_convex(points)) {
    cut_as_fan(corners, triangles);
    return true;
  }
  work_left += polygon_work_per_corner * static_cast<std::int64_t>(corners.size());
  if (!points.empty() && detail::clip_ears(points, detail::EarOrder::in_turn, triangles, work_left)) {
    for (Triangle& triangle : triangles) {
      for (std::uint32_t& corner : triangle) corner = corners[corner];
    }
    return true;
  }
  work_left = std::max<std::int64_t>(work_left, 0);
  cut_as_fan(corners, triangles);
  return false;
}

void cannot_hold(const std::filesystem::path& path, std::string_view format, std::string_view what) {
  throw FileError("cannot write '" + path.string() + "': " + std::string(format) + " holds no " + std::string(what) +
                  "; write OBJ instead");
}

void refuse_points(const std::filesystem::path& path, std::string_view format, const MeshView& mesh) {
  if (mesh.points.empty()) return;
  if (!mesh.triangles.empty() || !mesh.segments.empty())
    cannot_hold(path, format, "points together with triangles or segments");
  std::vector<bool> named(mesh.vertices.size(), false);
  for (const std::uint32_t point : mesh.points) named[point] = true;
  if (std::find(named.begin(), named.end(), false) != named.end()) {
    cannot_hold(path, format, "unused vertices together with points");
  }
}

}  // namespace blum
