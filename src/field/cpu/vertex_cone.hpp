// Blum: the cone in which a vertex is closest. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "blum/core/vec3.hpp"

namespace blum::cpu {

/// The cone {w : w . e <= 0 for all edge directions e of a vertex}: which of its planes bound it, and its extreme rays.
class VertexCone {
 public:
  static constexpr std::size_t max_planes = 4;
  static constexpr std::size_t max_rays = 8;
  /// More edges than this are left out, which only widens the cone.
  static constexpr std::size_t max_directions = 16;

  void add(const Vec3d& unit_direction) {
    if (count_ == max_directions) return;
    x_[count_] = static_cast<float>(unit_direction.x);
    y_[count_] = static_cast<float>(unit_direction.y);
    z_[count_] = static_cast<float>(unit_direction.z);
    ++count_;
  }

  /// Finds the cone's extreme rays; false if the cone {w : w . e <= 0 for all e} is provably just its apex.
  bool find_facets() {
    if (count_ < 3) {
      chosen_count_ = count_;
      for (std::size_t i = 0; i < count_; ++i) chosen_[i] = i;
      return true;
    }
    for (std::size_t k = count_; k < max_directions; ++k) {  // copies, so that whole vectors can be looked at
      x_[k] = x_[0];
      y_[k] = y_[0];
      z_[k] = z_[0];
    }
    std::array<bool, max_directions> is_facet{};
    bool is_certain = true;
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = i + 1; j < count_; ++j) {
        const Vec3f w = cross(direction(i), direction(j));
        if (squared_length(w) < 1e-8F) {
          is_certain = false;  // nearly parallel: their ray is lost in rounding
        } else if (const int sign = extreme_ray(w); sign != 0) {
          is_facet[i] = is_facet[j] = true;
          add_ray(w, sign);
        }
      }
    }
    if (ray_count_ == 0 && is_certain) return false;
    are_rays_known_ = is_certain && ray_count_ <= max_rays;
    choose(is_facet, ray_count_ > 0 && is_certain);
    return true;
  }

  [[nodiscard]] std::size_t chosen_count() const { return chosen_count_; }
  [[nodiscard]] Vec3d chosen(std::size_t k) const {
    const Vec3f e = direction(chosen_[k]);
    return {e.x, e.y, e.z};
  }

  /// The unit extreme rays; empty where they are too many or not known for certain.
  [[nodiscard]] std::span<const Vec3f> rays() const { return {rays_.data(), are_rays_known_ ? ray_count_ : 0}; }

 private:
  [[nodiscard]] Vec3f direction(std::size_t k) const { return {x_[k], y_[k], z_[k]}; }

  /// Bit 0: w (no longer than one) lies in the cone, up to rounding; bit 1: -w does. In doubt they do.
  [[nodiscard]] int extreme_ray(const Vec3f& w) const {
    constexpr float tolerance = 2e-6F;
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

  void add_ray(const Vec3f& w, int sign) {
    const Vec3f unit = w / length(w);
    if ((sign & 1) != 0 && ++ray_count_ <= max_rays) rays_[ray_count_ - 1] = unit;
    if ((sign & 2) != 0 && ++ray_count_ <= max_rays) rays_[ray_count_ - 1] = -unit;
  }

  /// Picks up to four directions, of the facets where they are known, each as far from the picked ones as can be.
  void choose(const std::array<bool, max_directions>& is_facet, bool facets_only) {
    std::array<float, max_directions> largest_cosine{};
    std::array<bool, max_directions> is_open{};
    for (std::size_t k = 0; k < count_; ++k) {
      is_open[k] = is_facet[k] || !facets_only;
      largest_cosine[k] = -2;
    }
    for (chosen_count_ = 0; chosen_count_ < max_planes; ++chosen_count_) {
      std::size_t best = max_directions;
      for (std::size_t k = 0; k < count_; ++k) {
        if (is_open[k] && (best == max_directions || largest_cosine[k] < largest_cosine[best])) best = k;
      }
      if (best == max_directions) return;
      is_open[best] = false;
      chosen_[chosen_count_] = best;
      for (std::size_t k = 0; k < count_; ++k) {
        largest_cosine[k] = std::max(largest_cosine[k], dot(direction(k), direction(best)));
      }
    }
  }

  alignas(64) std::array<float, max_directions> x_{}, y_{}, z_{};
  std::size_t count_ = 0;
  std::array<std::size_t, max_planes> chosen_{};
  std::size_t chosen_count_ = 0;
  std::array<Vec3f, max_rays> rays_{};
  std::size_t ray_count_ = 0;
  bool are_rays_known_ = false;
};

}  // namespace blum::cpu
