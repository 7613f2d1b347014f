// Blum: the least translation that separates two solids. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <tuple>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

struct TranslationOptions {
  /// For convex solids: largest difference between the upper and the lower bound, as a fraction of the upper bound: 0
  /// to 1. With 0, the difference is as small as rounding permits.
  double translation_tolerance = 0;
  /// For convex solids: largest number of planes to try, at least 1. After this number, the bounds may differ more.
  std::size_t max_planes = 50'000;
  /// For solids that are not convex: largest number of translations that the search tries.
  std::size_t max_tests = 1'500;
};

template <>
struct Description<TranslationOptions> {
  static constexpr std::string_view name = "TranslationOptions";
  static constexpr std::string_view doc = "Precision of the least translation that separates two solids";
  static constexpr std::tuple members{
      Member{"translation_tolerance", &TranslationOptions::translation_tolerance, "parts of the upper bound",
             "largest gap between both bounds for convex solids; 0: as small as rounding permits",
             Range::between(0, 1)},
      Member{"max_planes", &TranslationOptions::max_planes, "", "largest number of planes tried for convex solids",
             Range::between(1, 1e9)},
      Member{"max_tests", &TranslationOptions::max_tests, "", "largest number of translations tried for other solids",
             Range::between(0, 1e9)},
  };
};

/// Checks the options.
/// @throws InvalidOption if an option is out of range.
void check(const TranslationOptions& options);

/// Bounds on the length of the shortest translation that separates two solids, so that they touch or are apart. Other
/// names of this length are penetration depth and global penetration depth. The local depth is Penetration::depth.
struct LeastTranslation {
  /// Lower bound on the length, mesh units: no shorter translation separates the solids. The bound allows for rounding,
  /// which may lower it by 1e-14 times the extent of both solids. The bound is 0 if the solids are apart or touch.
  double lower = 0;
  double upper = 0;  ///< Length of `translation`, mesh units.
  /// Translation of the first solid. After the translation, the interiors of both solids are disjoint, except for
  /// rounding.
  Vec3d translation;
  /// True if both solids are convex, except for rounding. If true, the bounds differ only by rounding, unless an option
  /// ended the search early. If false, the true length may lie anywhere between the bounds.
  bool are_convex = false;
};

template <>
struct Description<LeastTranslation> {
  static constexpr std::string_view name = "LeastTranslation";
  static constexpr std::string_view doc = "Bounds on the shortest translation that separates two solids";
  static constexpr std::tuple members{
      Member{"lower", &LeastTranslation::lower, "mesh units", "no shorter translation separates the solids"},
      Member{"upper", &LeastTranslation::upper, "mesh units", "length of 'translation', which separates the solids"},
      Member{"translation", &LeastTranslation::translation, "mesh units", "translation of the first solid"},
      Member{"are_convex", &LeastTranslation::are_convex, "",
             "true if both solids are convex, so that both bounds are equal except for rounding"},
  };
};

/// Returns bounds on the length of the shortest translation that separates two solids.
///
/// @param first, second  closed meshes that face outwards, as for ProximityScene::penetration().
/// @return               the same for any number of threads.
/// @throws InvalidMesh as ProximityScene::penetration(); InvalidOption; Cancelled.
/// Cost: for convex solids, about a microsecond per plane and 2 ns per plane and vertex. For other solids, the cost is
/// that of ProximityScene::penetration() and of up to `max_tests` tests for a common point.
/// Method: docs/theory/proximity.md.
[[nodiscard]] LeastTranslation least_translation(const MeshView& first, const MeshView& second,
                                                 const TranslationOptions& options = {}, const Context& context = {});

}  // namespace blum
