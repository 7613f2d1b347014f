// Blum: how deep solids lie in each other. SPDX-License-Identifier: Apache-2.0
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
  /// How much larger than the depth told the true one may be, as a part of it: 1e-6 to 1. Where 200,000 points are not
  /// enough to show that, as of parts of curved surfaces much wider than deep, the bound told is larger.
  double depth_tolerance = 0.01;
};

template <>
struct Description<PenetrationOptions> {
  static constexpr std::string_view name = "PenetrationOptions";
  static constexpr std::string_view doc = "How well penetration depths are told";
  static constexpr std::tuple members{
      Member{"depth_tolerance", &PenetrationOptions::depth_tolerance, "parts of the depth",
             "how much larger than the depth told the true one may be", Range::between(1e-6, 1)},
  };
};

/// @throws InvalidOption.
void check(const PenetrationOptions& options);

/// A connected part of what two solids have in common.
///
/// Its border consists of a part of the surface of each, that lies in the other one. The depth is the largest distance
/// of a point of one of these parts from the other part (Sud 2006, ch. 4: local penetration depth). It is no least way
/// apart: moving by it brings the deepest point to the other part, and others may still be inside; nor does it count
/// what of the surfaces is not in the part. Where surfaces coincide, it is that of moving one by next to nothing.
struct Penetration {
  ObjectId first_object;
  ObjectId second_object;
  double depth = 0;        ///< mesh units; that of deep_point and surface_point
  double depth_bound = 0;  ///< what it is at most: a bound for certain, but for rounding
  /// Of length 1: where the first object is to be moved, by `depth`, to bring the deepest point to the surface.
  Vec3d direction;
  Vec3d deep_point;                    ///< the deepest point of the surface of one object in the other one
  Vec3d surface_point;                 ///< the closest one to it of the surface of that
  bool is_first_deep = false;          ///< whether the deepest point is one of the first object; else of the second
  std::uint32_t deep_triangle = 0;     ///< that deep_point lies on, in its object
  std::uint32_t surface_triangle = 0;  ///< that surface_point lies on, in the other one
  /// Of the parts of the surfaces of the first object and the second, square mesh units. Both in the first entry where
  /// an object is compared with itself.
  std::array<double, 2> area{};
  double volume = 0;  ///< cubic mesh units
  /// Where the surfaces cross: closed curves, unless more than two parts meet on them. Each ends where it began.
  std::vector<std::vector<Vec3d>> curves;
};

/// What solids have in common, in its connected parts, of each pair the deepest first.
struct Penetrations {
  std::vector<Penetration> parts;
  std::size_t object_pairs = 0;  ///< compared; an object with itself is one
  std::vector<PhaseTime> phases;
};

}  // namespace blum
