// Blum: columns of lists of structures, as arrays. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "blum/core/ids.hpp"

namespace blum::python {

/// Layout of a member of a structure as part of an array: the type and the axes of its elements. Ids and counts become
/// int32, as in files, and none() becomes -1.
template <class Member>
struct Layout {
  using Element = Member;
  static constexpr std::array<std::size_t, 0> extents{};
};
template <>
struct Layout<std::uint32_t> : Layout<std::int32_t> {};
template <class Tag>
struct Layout<Id<Tag>> : Layout<std::int32_t> {};
template <class Member>
  requires std::is_enum_v<Member>
struct Layout<Member> : Layout<std::underlying_type_t<Member>> {};
template <>
struct Layout<Vec3d> {
  using Element = double;
  static constexpr std::array<std::size_t, 1> extents{3};
};
template <class Part, std::size_t count>
struct Layout<std::array<Part, count>> {
  using Element = typename Layout<Part>::Element;
  static constexpr auto extents = [] {
    std::array<std::size_t, Layout<Part>::extents.size() + 1> all{count};
    for (std::size_t a = 1; a < all.size(); ++a) all[a] = Layout<Part>::extents[a - 1];
    return all;
  }();
};

/// Returns one member of every entry of a list as a view, without a copy. It is read-only if the list is const.
/// @param owner  object that keeps the list alive.
template <class List, class Entry, class Member>
[[nodiscard]] auto column(List& entries, Member Entry::* member, nb::handle owner) {
  using Plain = typename Layout<Member>::Element;
  using Element = std::conditional_t<std::is_const_v<List>, const Plain, Plain>;
  constexpr auto extents = Layout<Member>::extents;
  static_assert(sizeof(Entry) % sizeof(Plain) == 0);
  std::array<std::size_t, extents.size() + 1> shape{entries.size()};
  std::array<std::int64_t, extents.size() + 1> strides{sizeof(Entry) / sizeof(Plain)};
  std::int64_t step = 1;
  for (std::size_t a = extents.size(); a > 0; --a) {
    shape[a] = extents[a - 1];
    strides[a] = step;
    step *= static_cast<std::int64_t>(extents[a - 1]);
  }
  static Entry nowhere{};  // An empty array needs an address, too.
  auto& first = entries.empty() ? nowhere : entries.front();
  return Out<Element>(reinterpret_cast<Element*>(&(first.*member)), shape.size(), shape.data(), owner, strides.data());
}

}  // namespace blum::python
