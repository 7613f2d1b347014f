// Blum: typed indices. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace blum {

/// An index of 32 bits that cannot be mixed up with an index of another kind.
/// none() marks "no such thing" inside large arrays, where an optional would double the memory; files show it as -1.
template <class Tag>
struct Id {
  std::uint32_t value = std::numeric_limits<std::uint32_t>::max();

  constexpr Id() = default;
  constexpr explicit Id(std::uint32_t index) : value(index) {}
  [[nodiscard]] static constexpr Id none() { return Id(); }
  [[nodiscard]] constexpr bool has_value() const { return value != std::numeric_limits<std::uint32_t>::max(); }
  /// The number that files hold: the index, or -1 for none().
  [[nodiscard]] constexpr std::int32_t to_file() const { return static_cast<std::int32_t>(value); }
  [[nodiscard]] friend constexpr auto operator<=>(const Id&, const Id&) = default;
};

using VertexId = Id<struct VertexTag>;
using EdgeId = Id<struct EdgeTag>;
using TriangleId = Id<struct TriangleTag>;
/// A site of a mesh (see geometry/sites.hpp for the numbering), or the linear index of a voxel of an image.
using SiteId = Id<struct SiteTag>;

/// The largest number of things of one kind: ids must fit a signed 32-bit integer, as files hold them.
inline constexpr std::size_t max_id_count = 0x7fffffff;

}  // namespace blum
