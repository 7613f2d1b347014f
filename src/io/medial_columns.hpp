// Blum: columns of numbers in files of medial axes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/grid/voxel_image.hpp"

namespace blum::medial_files {

/// Calls set(index, value) with each value as a double.
template <class Set>
void for_each_number(const VoxelImage::Values& values, Set set) {
  std::visit(
      [&](const auto& v) {
        for (std::size_t i = 0; i < v.size(); ++i) set(i, static_cast<double>(v[i]));
      },
      values);
}

/// Calls set(index, value) with each value as an int64. @throws FormatError with `where` when there are other values.
template <class Set>
void for_each_integer(const VoxelImage::Values& values, const std::string& where, Set set) {
  std::visit(
      [&]<class T>(const std::vector<T>& v) {
        if constexpr (std::is_floating_point_v<T>) {
          throw FormatError(where + ": the values must be whole numbers, but these are floating-point");
        } else {
          for (std::size_t i = 0; i < v.size(); ++i) {
            if (!std::in_range<std::int64_t>(v[i])) throw FormatError(where + ": a value is too large");
            set(i, static_cast<std::int64_t>(v[i]));
          }
        }
      },
      values);
}

}  // namespace blum::medial_files
