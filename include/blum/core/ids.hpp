// Blum: typed indices. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace blum {

/// Index of 32 bits. Each kind of object has its own type. The value none() stands for "no object". Id is used instead
/// of std::optional, which would double the memory of large arrays. Files store none() as -1.
template <class Tag>
struct Id {
  std::uint32_t value = std::numeric_limits<std::uint32_t>::max();

  constexpr Id() = default;
  constexpr explicit Id(std::uint32_t index) : value(index) {}
  [[nodiscard]] static constexpr Id none() { return Id(); }
  [[nodiscard]] constexpr bool has_value() const { return value != std::numeric_limits<std::uint32_t>::max(); }
  /// Returns the number that files contain: the index, or -1 for none().
  [[nodiscard]] constexpr std::int32_t to_file() const { return static_cast<std::int32_t>(value); }
  [[nodiscard]] friend constexpr auto operator<=>(const Id&, const Id&) = default;
};

using VertexId = Id<struct VertexTag>;
using EdgeId = Id<struct EdgeTag>;
using TriangleId = Id<struct TriangleTag>;
/// Site of a mesh (see geometry/sites.hpp for the numbering), or linear index of a voxel of an image.
using SiteId = Id<struct SiteTag>;

/// Largest number of objects of one kind. Files store ids as signed 32-bit integers, so larger ids are not possible.
inline constexpr std::size_t max_id_count = 0x7fffffff;

}  // namespace blum
