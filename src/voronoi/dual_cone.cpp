#include "voronoi/dual_cone.hpp"

#include <cstddef>
#include <optional>

#include "blum/geometry/orient2d.hpp"
#include "blum/geometry/orient3d.hpp"

namespace blum::voronoi {
namespace {

/// A cone with an interior, which one constraint after another cuts. Its rays are cross products of consecutive
/// constraints, all with the same sign.
class Cone {
 public:
  Cone(const Vec3d& v, std::span<const Vec3d> ends) : v_(v), ends_(ends) {}

  std::vector<std::uint32_t> find() {
    if (!begin()) return {};
    for (std::uint32_t k = 1; k < ends_.size(); ++k) {
      if (k == first_[1] || k == first_[2]) continue;
      if (!cut(k)) return {};
    }
    return bounds_;
  }

 private:
  [[nodiscard]] int determinant(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return detail::orient3d(v_, ends_[a], ends_[b], ends_[c]);
  }

  /// Starts with three linearly independent constraints. Returns false if no three constraints are linearly
  /// independent.
  bool begin() {
    const auto count = static_cast<std::uint32_t>(ends_.size());
    std::uint32_t second = 1;
    while (second < count && are_collinear(v_, ends_[0], ends_[second])) ++second;
    for (std::uint32_t third = second + 1; third < count; ++third) {
      const int sign = determinant(0, second, third);
      if (sign == 0) continue;
      // The ray sign_ * (e_a x e_b) must point away from the third edge.
      sign_ = -sign;
      bounds_ = first_ = {0, second, third};
      return true;
    }
    return false;
  }

  /// Cuts the cone with the half-space of a constraint. Returns true if the remaining cone has an interior.
  bool cut(std::uint32_t constraint) {
    // Side of each ray: 1 outside the half-space, -1 inside, 0 on its plane.
    const std::size_t count = bounds_.size();
    side_.resize(count);
    bool has_beyond = false;
    bool has_inside = false;
    for (std::size_t k = 0; k < count; ++k) {
      side_[k] = sign_ * determinant(bounds_[k], bounds_[(k + 1) % count], constraint);
      has_beyond = has_beyond || side_[k] > 0;
      has_inside = has_inside || side_[k] < 0;
    }
    if (!has_inside) return false;
    if (!has_beyond) return true;
    // The rays outside are consecutive; the first one follows ray `from`. A constraint is kept if one of its two rays
    // is kept.
    std::size_t from = 0;
    while (side_[from] > 0 || side_[(from + 1) % count] <= 0) ++from;
    std::vector<std::uint32_t> left{constraint};
    std::size_t k = (from + 1) % count;
    while (side_[k] > 0) k = (k + 1) % count;
    // Ray k, between constraints k and k + 1, is the first that is kept.
    for (;; k = (k + 1) % count) {
      left.push_back(bounds_[k]);
      if (k == from) break;
    }
    left.push_back(bounds_[(from + 1) % count]);
    bounds_ = std::move(left);
    return true;
  }

  const Vec3d& v_;
  std::span<const Vec3d> ends_;
  int sign_ = 1;
  std::vector<std::uint32_t> first_, bounds_;
  std::vector<int> side_;
};

}  // namespace

bool are_collinear(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return detail::orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 &&
         detail::orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
         detail::orient2d({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

std::vector<std::uint32_t> dual_cone(const Vec3d& v, std::span<const Vec3d> ends) {
  return Cone(v, ends).find();
}

}  // namespace blum::voronoi
