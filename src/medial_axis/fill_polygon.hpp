// Blum: triangles in a polygon whose inside is not flat. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "medial_axis/solid_paths.hpp"

namespace blum {

/// Fills polygons of a few corners with triangles whose edges stay in a solid.
class PolygonFiller {
 public:
  using Places = std::vector<std::uint32_t>;

  /// @param stop_of  where a place is.
  /// @param add      makes a vertex and tells its place; empty where there must be none.
  PolygonFiller(const SolidPaths& paths, std::function<Stop(std::uint32_t)> stop_of,
                std::function<std::uint32_t(const Stop&)> add)
      : paths_(paths), stop_of_(std::move(stop_of)), add_(std::move(add)) {}

  /// Cuts off the shortest ears, of these first such that no part of the surface comes through, then such that stay in
  /// the solid; where there are none, one along a path of new vertices.
  /// @param sides  groups of places that other polygons have, too. No edge joins two of a group: another polygon that
  ///               has both may join them as well.
  /// @return  whether all edges stay in the solid. They are of the complex in any case.
  bool fill(Places polygon, const std::vector<Places>& sides);

  /// Three places for each triangle, of all polygons.
  [[nodiscard]] const Places& triangles() const { return triangles_; }

 private:
  struct Ear;
  struct Detour;
  [[nodiscard]] std::vector<Ear> ears_of(const Places& polygon, const std::vector<Places>& sides) const;
  [[nodiscard]] bool is_joined(const Ear& ear) const;
  [[nodiscard]] bool is_open(const Ear& ear) const;
  bool fan_out(const Places& polygon);
  [[nodiscard]] std::optional<Detour> detour(const Places& polygon, std::span<const Ear> ears);

  const SolidPaths& paths_;
  std::function<Stop(std::uint32_t)> stop_of_;
  std::function<std::uint32_t(const Stop&)> add_;
  Places triangles_;
  int detours_ = 0;
  int fans_ = 0;
};

}  // namespace blum
