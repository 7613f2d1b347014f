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
  /// Largest excess of the true depth over the reported depth, as a fraction of the reported depth: 1e-6 to 1. The
  /// search ends after 200,000 points, even if Penetration::depth_bound still exceeds this limit. The limit may be
  /// exceeded if a common part is bounded by curved surfaces and is much wider than deep.
  double depth_tolerance = 0.01;
};

template <>
struct Description<PenetrationOptions> {
  static constexpr std::string_view name = "PenetrationOptions";
  static constexpr std::string_view doc = "Precision of penetration depths";
  static constexpr std::tuple members{
      Member{"depth_tolerance", &PenetrationOptions::depth_tolerance, "parts of the depth",
             "largest excess of the true depth over the reported depth", Range::between(1e-6, 1)},
  };
};

/// Checks the options.
/// @throws InvalidOption if an option is out of range.
void check(const PenetrationOptions& options);

/// Connected part of the overlap of two solids.
///
/// The part is bounded by two sides. Each side is the region of one solid's surface that lies in the other solid. The
/// depth is the largest distance of a point of one side from the other side (Sud 2006, ch. 4: local penetration depth).
/// The depth is not the length of the shortest translation that separates the solids. A translation by the depth brings
/// the deepest point to the other side, but other points may remain in the other solid. Only surfaces that bound the
/// part matter. If surfaces coincide, the depth is the limit for a displacement of one solid that tends to zero.
struct Penetration {
  ObjectId first_object;
  ObjectId second_object;
  double depth = 0;        ///< Mesh units; distance of `deep_point` and `surface_point`.
  double depth_bound = 0;  ///< Upper bound on the true depth, proven except for rounding.
  /// Unit vector. If the first object moves by `depth` along it, `deep_point` and `surface_point` coincide.
  Vec3d direction;
  Vec3d deep_point;            ///< Deepest point, on the surface of one object and inside the other object.
  Vec3d surface_point;         ///< Point of the other object's surface that is closest to `deep_point`.
  bool is_first_deep = false;  ///< True if `deep_point` lies on the surface of the first object; false for the second.
  /// Triangle that contains `deep_point`: its index in the object whose surface contains this point.
  std::uint32_t deep_triangle = 0;
  std::uint32_t surface_triangle = 0;  ///< Triangle of the other object that contains `surface_point`.
  /// Areas of the two sides, square mesh units: of the side on the first object's surface, then of the side on the
  /// second object's surface. If an object is compared with itself, the first entry is the sum of both areas.
  std::array<double, 2> area{};
  double volume = 0;  ///< Volume of the common part, cubic mesh units.
  /// Curves along which the surfaces cross, as polylines. A closed curve ends with its first point. A curve that meets
  /// other curves runs from one meeting point to the next.
  std::vector<std::vector<Vec3d>> curves;
};

/// Connected parts of the overlaps of pairs of solids. For each pair of objects, the deepest part is first.
struct Penetrations {
  std::vector<Penetration> parts;
  std::size_t object_pairs = 0;  ///< Number of compared pairs, including objects compared with themselves.
  std::vector<PhaseTime> phases;
};

}  // namespace blum
