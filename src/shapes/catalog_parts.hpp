// Blum: parts of the shape catalog. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/shapes/shape_catalog.hpp"

namespace blum::detail {

using Betti = std::optional<std::array<std::int64_t, 3>>;

/// Groups of shapes of the catalog. Each group is defined in a separate file.
[[nodiscard]] std::vector<ShapeInfo> round_shapes();
[[nodiscard]] std::vector<ShapeInfo> machined_shapes();
[[nodiscard]] std::vector<ShapeInfo> loose_shapes();

inline constexpr double largest_length = 1e9;
inline constexpr double smallest_length = 1e-9;

/// Returns a parameter for a length above 0, in mesh units.
inline ShapeParameter length_parameter(std::string name, std::string description, double value) {
  return {std::move(name), std::move(description) + ", in mesh units", value, smallest_length, largest_length, false};
}
/// Returns a parameter for a length that may be 0, in mesh units.
inline ShapeParameter length_or_zero(std::string name, std::string description, double value) {
  return {std::move(name), std::move(description) + ", in mesh units", value, 0, largest_length, false};
}
inline ShapeParameter count_parameter(std::string name, std::string description, int value, int minimum, int maximum) {
  return {std::move(name),
          std::move(description),
          static_cast<double>(value),
          static_cast<double>(minimum),
          static_cast<double>(maximum),
          true};
}
inline ShapeParameter seed_parameter() {
  return {"seed", "seed of the random numbers", 1, 0, 4294967295.0, true};
}

/// Access to parameters that complete_parameters() has checked.
struct Values {
  const ShapeParameters& map;
  [[nodiscard]] double real(const char* name) const { return map.at(name); }
  [[nodiscard]] int whole(const char* name) const { return static_cast<int>(map.at(name)); }
  [[nodiscard]] std::size_t count(const char* name) const { return static_cast<std::size_t>(map.at(name)); }
  [[nodiscard]] std::uint64_t seed() const { return static_cast<std::uint64_t>(map.at("seed")); }
};

/// Returns a function for Betti numbers that do not depend on the parameters.
inline auto always(std::int64_t components, std::int64_t tunnels, std::int64_t voids) {
  return [=](const ShapeParameters&) -> Betti { return {{components, tunnels, voids}}; };
}
inline auto no_solid() {
  return [](const ShapeParameters&) -> Betti { return std::nullopt; };
}

}  // namespace blum::detail
