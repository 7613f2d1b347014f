#include "certificate/homology/apex.hpp"

#include "blum/core/random.hpp"
#include "certificate/exact_crossing.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {
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
  return exact_crossing(apex_, u, v, a, b);
}

std::optional<int> Apex::crossing_above(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
  return exact_crossing(a, b, c, p, apex_);
}

}  // namespace blum::verifier
