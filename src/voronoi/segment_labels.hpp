// Blum: which sites are closest along a segment. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"
#include "voronoi/site_labels.hpp"

namespace blum::voronoi {

/// The sites that are closest along a segment, one after the other, and where they change.
struct SegmentLabels {
  std::vector<std::uint32_t> sites;  ///< numbers of SiteLabels::site_of(); neighbours differ
  /// Between sites k and k + 1: two points of the segment that the only change lies between, coordinates along it.
  std::vector<std::array<double, 2>> changes;
};

/// Finds them exactly, by halving.
///
/// Of a part of the segment, labels are ruled out that lie outside of one plane of their domain there, or that are
/// further than a label whose distance is attained all over it, as three signs of the polar form tell. A part is done
/// when the labels left are of one site; or of two labels of two sites, one at each end, of which the squared distances
/// change their order once: their difference is quadratic, and so changes its sign once where it does between the ends;
/// of a triangle and its own edge, or an edge and its end, it is a square, and the plane between their domains, which a
/// segment crosses once, parts them. What is left is halved.
///
/// @param among  labels that hold all that are closest anywhere on the segment.
/// @param from, to  differ along `axis` alone, in rising order; the segment lies in the solid.
/// @return  nullopt where two sites tie at an end or all over a part of it, and where changes are closer than doubles
///          can part.
[[nodiscard]] std::optional<SegmentLabels> labels_along(const SiteLabels& labels, std::span<const Label> among,
                                                        const Vec3d& from, const Vec3d& to, std::size_t axis);

}  // namespace blum::voronoi
