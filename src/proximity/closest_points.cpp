#include "proximity/closest_points.hpp"

#include <algorithm>

namespace blum::detail {
namespace {

/// The point of a segment from the origin that is closest to another point.
Vec3d on_segment(const Vec3d& end, const Vec3d& to) {
  const double square = squared_length(end);
  return square > 0 ? end * std::clamp(dot(end, to) / square, 0.0, 1.0) : Vec3d{};
}

}  // namespace

ClosestPair closest_of_point_and_triangle(const Vec3d& point, const Vec3d& b, const Vec3d& c) {
  const Vec3d normal = cross(b, c);
  const double square = squared_length(normal);
  if (square > 0) {
    const double s = dot(normal, cross(point, c)) / square;
    const double r = dot(normal, cross(b, point)) / square;
    if (s >= 0 && r >= 0 && s + r <= 1) return {point, b * s + c * r};
  }
  ClosestPair best{point, on_segment(b, point)};
  for (const Vec3d& other : {on_segment(c, point), b + on_segment(c - b, point - b)}) {
    if (squared_length(other - point) < squared_length(best.second - point)) best.second = other;
  }
  return best;
}

ClosestPair closest_of_segments(const Vec3d& end, const Vec3d& other_start, const Vec3d& other_along) {
  const double a = squared_length(end);
  const double b = dot(end, other_along);
  const double c = squared_length(other_along);
  const double d = dot(end, other_start);
  const double e = dot(other_along, other_start);
  const double determinant = a * c - b * b;
  if (determinant > 0) {
    const double s = (d * c - b * e) / determinant;
    const double r = (b * d - a * e) / determinant;
    if (s >= 0 && s <= 1 && r >= 0 && r <= 1) return {end * s, other_start + other_along * r};
  }
  // Else an end of one is closest.
  const Vec3d other_end = other_start + other_along;
  ClosestPair best{on_segment(end, other_start), other_start};
  for (const ClosestPair& pair : {ClosestPair{on_segment(end, other_end), other_end},
                                  ClosestPair{{}, other_start + on_segment(other_along, -other_start)},
                                  ClosestPair{end, other_start + on_segment(other_along, end - other_start)}}) {
    if (squared_length(pair.first - pair.second) < squared_length(best.first - best.second)) best = pair;
  }
  return best;
}

}  // namespace blum::detail
