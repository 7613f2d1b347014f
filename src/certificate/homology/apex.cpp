#include "certificate/homology/apex.hpp"

#include "blum/core/random.hpp"
#include "blum/geometry/orient3d.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {
namespace {

using detail::orient3d;

/// How often the way from p to q crosses the triangle a, b, c.
std::optional<int> crossing_of(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p, const Vec3d& q) {
  const int from = orient3d(a, b, c, p);
  const int to = orient3d(a, b, c, q);
  if (from == to && from != 0) return 0;
  const int first = orient3d(p, q, a, b);
  const int second = orient3d(p, q, b, c);
  if (first * second < 0) return 0;
  const int third = orient3d(p, q, c, a);
  if (first * third < 0 || second * third < 0) return 0;
  if (from == 0 || to == 0 || first == 0 || second == 0 || third == 0) return std::nullopt;
  return to;
}

}  // namespace

Apex::Apex(const Box3& box, std::uint32_t attempt) : size_(box.diagonal()) {
  constexpr double far = 3;
  constexpr std::uint32_t first_direction = 1000;  // other ones than those by which points are located
  const ProbeLine line = line_through(box.center(), first_direction + attempt);
  apex_ = box.center() - line.along * (far * size_);
  along_ = line.along;
  across_ = line.across;
  up_ = line.up;
}

Vec3d Apex::seen(const Vec3d& p) const {
  const Vec3d q = p - apex_;
  const double away = dot(along_, q);
  return {dot(across_, q) / away * size_, dot(up_, q) / away * size_, away};
}

std::optional<int> Apex::crossing(const Vec3d& u, const Vec3d& v, const Vec3d& a, const Vec3d& b) const {
  return crossing_of(apex_, u, v, a, b);
}

std::optional<int> Apex::crossing_above(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
  return crossing_of(a, b, c, p, apex_);
}

}  // namespace blum::verifier
