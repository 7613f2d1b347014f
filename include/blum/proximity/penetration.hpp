// Blum: penetration depths of solids. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/describe.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/vec3.hpp"
#include "blum/proximity/motion.hpp"

namespace blum {

struct PenetrationOptions {
  /// Largest excess of the true depth over the reported one, as a part of it: 1e-6 to 1. If 200,000 points do not
  /// suffice to show that, the reported bound is larger. This happens for parts of curved surfaces that are much wider
  /// than deep.
  double depth_tolerance = 0.01;
};

template <>
struct Description<PenetrationOptions> {
  static constexpr std::string_view name = "PenetrationOptions";
  static constexpr std::string_view doc = "Precision of penetration depths";
  static constexpr std::tuple members{
      Member{"depth_tolerance", &PenetrationOptions::depth_tolerance, "parts of the depth",
             "largest excess of the true depth over the reported one", Range::between(1e-6, 1)},
  };
};

/// Checks options.
/// @throws InvalidOption if one is out of range.
void check(const PenetrationOptions& options);

/// Connected part of the overlap of two solids.
///
/// Its border consists of two sides, each the part of one solid's surface that lies in the other solid. The depth is
/// the largest distance of a point of one side from the other side (Sud 2006, ch. 4: local penetration depth). It is
/// not the shortest separating translation: moving by it brings the deepest point to the other side, but others may
/// stay inside. Surfaces outside the part do not count. If surfaces coincide, the depth is the limit for an
/// infinitesimal displacement.
struct Penetration {
  ObjectId first_object;
  ObjectId second_object;
  double depth = 0;        ///< Mesh units; distance of `deep_point` and `surface_point`.
  double depth_bound = 0;  ///< Upper bound on the true depth, proven except for rounding.
  /// Unit vector. Moving the first object by `depth` in this direction brings the deepest point to the surface.
  Vec3d direction;
  Vec3d deep_point;                    ///< Deepest point of the surface of one object in the other one.
  Vec3d surface_point;                 ///< Closest point to it on the surface of the other object.
  bool is_first_deep = false;          ///< True if the deepest point belongs to the first object, else to the second.
  std::uint32_t deep_triangle = 0;     ///< Triangle of its object that contains `deep_point`.
  std::uint32_t surface_triangle = 0;  ///< Triangle of the other object that contains `surface_point`.
  /// Areas of the sides of the first and the second object, square mesh units. If an object is compared with itself,
  /// the first entry contains both.
  std::array<double, 2> area{};
  double volume = 0;  ///< Cubic mesh units.
  /// Curves in which the surfaces cross. Each ends where it began. They are simple closed curves, unless more than two
  /// parts meet on them.
  std::vector<std::vector<Vec3d>> curves;
};

/// Overlaps of solids, as connected parts, for each pair the deepest first.
struct Penetrations {
  std::vector<Penetration> parts;
  std::size_t object_pairs = 0;  ///< Compared pairs; an object with itself is one.
  std::vector<PhaseTime> phases;
};

}  // namespace blum
