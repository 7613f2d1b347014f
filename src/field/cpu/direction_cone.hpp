// Blum: a cone around the directions in which sites can be closest. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "blum/core/vec3.hpp"
#include "field/cpu/site_records.hpp"

namespace blum::cpu {

/// Collects the domains of a cluster's sites, each given by the unit rays that span it, and bounds them all, or their
/// opposites, by one cone.
class DirectionCone {
 public:
  /// @param rays  that span one site's domain; none stands for a domain that may be anything.
  void add(std::span<const Vec3f> rays) {
    if (rays.empty() || count_ + rays.size() > rays_.size()) is_bounded_ = false;
    if (!is_bounded_) return;
    for (const Vec3f& ray : rays) {
      axis_ += dot(axis_, ray) < 0 ? -ray : ray;
      domain_[count_] = domains_;
      rays_[count_++] = ray;
    }
    ++domains_;
  }

  struct Result {
    Vec3f axis{1, 0, 0};
    float cosine = 0;
    float sine = 1;
  };

  /// The double cone: every direction of every domain makes an angle with the axis, or with its opposite, whose cosine
  /// is at least `cosine`. A spherical cap of less than a half-sphere is convex, so a domain whose rays lie in one cap
  /// lies in it; rays on both sides of the axis would not do.
  [[nodiscard]] Result finish() const {
    constexpr float margin = 2e-3F;
    const float size = length(axis_);
    if (!is_bounded_ || count_ == 0 || !(size > 1e-3F)) return {};
    const Vec3f axis = axis_ / size;
    float cosine = 1;
    bool is_positive = true;
    for (std::size_t k = 0; k < count_; ++k) {
      const float along = dot(axis, rays_[k]);
      if (k == 0 || domain_[k] != domain_[k - 1]) is_positive = along > 0;
      if (is_positive != (along > 0)) return {};
      cosine = std::min(cosine, std::abs(along));
    }
    cosine -= margin;
    if (!(cosine > 0.05F)) return {};
    return {axis, cosine, std::sqrt(1 - cosine * cosine)};
  }

 private:
  std::array<Vec3f, 8 * cluster_size> rays_{};
  std::array<std::size_t, 8 * cluster_size> domain_{};
  std::size_t count_ = 0;
  std::size_t domains_ = 0;
  Vec3f axis_{};
  bool is_bounded_ = true;
};

}  // namespace blum::cpu
