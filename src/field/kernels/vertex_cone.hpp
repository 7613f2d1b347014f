// Blum: the cone in which a vertex is closest. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "field/kernels/host_device.hpp"

namespace blum::kernels {

/// Directions at a vertex that are used as planes of its domain.
struct ChosenPlanes {
  static constexpr std::size_t most = 4;
  std::array<std::size_t, most> index{};
  std::size_t count = 0;

  /// Picks up to four of the directions whose bit is set in `open`. Each pick is as far as possible from the earlier
  /// ones.
  /// @param direction  callable: index -> unit Vec3f.
  template <class Direction>
  BLUM_HD void choose(std::uint32_t open, Direction direction) {
    count = 0;
    if (count_bits(open) <= most) {
      for (; open != 0; open &= open - 1) index[count++] = lowest_bit(open);
      return;
    }
    std::array<float, 32> largest_cosine;
    largest_cosine.fill(-2);
    while (count < most) {
      std::size_t best = lowest_bit(open);
      for (std::uint32_t rest = open; rest != 0; rest &= rest - 1) {
        const std::size_t k = lowest_bit(rest);
        if (largest_cosine[k] < largest_cosine[best]) best = k;
      }
      open &= ~(1U << best);
      index[count++] = best;
      for (std::uint32_t rest = open; rest != 0; rest &= rest - 1) {
        const std::size_t k = lowest_bit(rest);
        largest_cosine[k] = larger(largest_cosine[k], dot(direction(k), direction(best)));
      }
    }
  }
};

/// Cone {w : w . e <= 0 for all edge directions e} of a vertex, with the planes that bound it and its extreme rays.
class VertexCone {
 public:
  /// Two directions are treated as parallel if their cross product has a smaller squared length.
  static constexpr float parallel = 1e-8F;
  /// Bound on the rounding error of w . e, where w is the cross product of two directions.
  static constexpr float tolerance = 2e-6F;
  static constexpr std::size_t max_rays = 8;
  /// Largest number of edges used. Further edges are left out, which only widens the cone.
  static constexpr std::size_t max_directions = 16;

  BLUM_HD void add(const Vec3d& unit_direction) {
    if (count_ == max_directions) return;
    x_[count_] = static_cast<float>(unit_direction.x);
    y_[count_] = static_cast<float>(unit_direction.y);
    z_[count_] = static_cast<float>(unit_direction.z);
    ++count_;
  }

  /// Finds the cone's extreme rays. Returns false if the cone {w : w . e <= 0 for all e} certainly consists of its apex
  /// only.
  BLUM_HD bool find_facets() {
    if (count_ < 3) {
      choose(all());
      return true;
    }
    // Copies of the first direction, so that whole vectors can be tested.
    for (std::size_t k = count_; k < max_directions; ++k) {
      x_[k] = x_[0];
      y_[k] = y_[0];
      z_[k] = z_[0];
    }
    std::uint32_t facets = 0;
    bool is_certain = true;
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = i + 1; j < count_; ++j) {
        const Vec3f w = cross(direction(i), direction(j));
        if (squared_length(w) < parallel) {
          is_certain = false;  // nearly parallel: their common ray is uncertain because of rounding
        } else if (const int sign = extreme_ray(w); sign != 0) {
          facets |= (1U << i) | (1U << j);
          add_ray(w, sign);
        }
      }
    }
    if (ray_count_ == 0 && is_certain) return false;
    are_rays_known_ = is_certain && ray_count_ <= max_rays;
    choose(is_certain ? facets : all());
    return true;
  }

  /// Returns up to four directions whose planes bound a cone that contains the domain.
  [[nodiscard]] BLUM_HD const ChosenPlanes& planes() const { return chosen_; }
  [[nodiscard]] BLUM_HD Vec3f direction(std::size_t k) const { return {x_[k], y_[k], z_[k]}; }

  /// Returns the unit extreme rays. Empty if there are too many or they are uncertain.
  [[nodiscard]] BLUM_HD std::span<const Vec3f> rays() const { return {rays_.data(), are_rays_known_ ? ray_count_ : 0}; }

 private:
  /// Tests if w or -w, of length at most one, lies in the cone, up to rounding. Sets bit 0 for w and bit 1 for -w.
  /// Doubtful cases count as in the cone.
  [[nodiscard]] BLUM_HD int extreme_ray(const Vec3f& w) const {
    const std::size_t end = count_ <= 8 ? 8 : max_directions;
    int beyond = 0;
    int before = 0;
    for (std::size_t k = 0; k < end; ++k) {
      const float side = w.x * x_[k] + w.y * y_[k] + w.z * z_[k];
      beyond |= static_cast<int>(side > tolerance);
      before |= static_cast<int>(side < -tolerance);
    }
    return (beyond == 0 ? 1 : 0) + (before == 0 ? 2 : 0);
  }

  BLUM_HD void add_ray(const Vec3f& w, int sign) {
    const Vec3f unit = w / norm(w);
    if ((sign & 1) != 0 && ++ray_count_ <= max_rays) rays_[ray_count_ - 1] = unit;
    if ((sign & 2) != 0 && ++ray_count_ <= max_rays) rays_[ray_count_ - 1] = -unit;
  }

  [[nodiscard]] BLUM_HD std::uint32_t all() const { return (1U << count_) - 1; }
  BLUM_HD void choose(std::uint32_t open) {
    chosen_.choose(open, [this](std::size_t k) { return direction(k); });
  }

  alignas(64) std::array<float, max_directions> x_{}, y_{}, z_{};
  std::size_t count_ = 0;
  ChosenPlanes chosen_;
  std::array<Vec3f, max_rays> rays_{};
  std::size_t ray_count_ = 0;
  bool are_rays_known_ = false;
};

}  // namespace blum::kernels
