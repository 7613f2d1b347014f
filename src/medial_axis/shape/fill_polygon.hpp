// Blum: triangles in a polygon whose inside is not flat. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "medial_axis/surface/solid_paths.hpp"

namespace blum {

/// How many ways past the surface may be looked for while polygons are filled; counted down.
struct FillBudget {
  int detours = 60;  ///< paths that take the place of edges
  int fans = 8;      ///< points that see all corners
};

/// Fills polygons of a few corners with triangles whose edges stay in a solid.
class PolygonFiller {
 public:
  using Places = std::vector<std::uint32_t>;

  /// @param stop_of  where a place is.
  /// @param add      makes a vertex and tells its place; empty where there must be none.
  /// @param budget   it must stay.
  PolygonFiller(const SolidPaths& paths, std::function<Stop(std::uint32_t)> stop_of,
                std::function<std::uint32_t(const Stop&)> add, FillBudget& budget)
      : paths_(paths), stop_of_(std::move(stop_of)), add_(std::move(add)), budget_(budget) {}

  /// Cuts off the shortest ears, of these first such that no part of the surface comes through, then such that stay in
  /// the solid; where there are none, one along a path of new vertices.
  /// @param sides  groups of places that other polygons have, too. No edge joins two of a group: another polygon that
  ///               has both may join them as well.
  /// @return  whether all edges stay in the solid. They are of the complex in any case.
  bool fill(Places polygon, const std::vector<Places>& sides);

  /// Whether none of the surface comes through the triangles: false also where that is not easy to see.
  [[nodiscard]] bool is_all_open() const { return is_all_open_; }

  /// Three places for each triangle, of all polygons.
  [[nodiscard]] const Places& triangles() const { return triangles_; }

 private:
  struct Ear;
  struct Detour;
  [[nodiscard]] std::vector<Ear> ears_of(const Places& polygon, const std::vector<Places>& sides) const;
  [[nodiscard]] bool is_joined(const Ear& ear) const;
  [[nodiscard]] bool is_open(const Ear& ear) const;
  bool fan_out(const Places& polygon, std::size_t least_open);
  [[nodiscard]] std::optional<Detour> detour(const Places& polygon, std::span<const Ear> ears);

  const SolidPaths& paths_;
  std::function<Stop(std::uint32_t)> stop_of_;
  std::function<std::uint32_t(const Stop&)> add_;
  Places triangles_;
  FillBudget& budget_;
  bool is_all_open_ = true;
};

}  // namespace blum
