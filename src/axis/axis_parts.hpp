// Blum: kinds of edges and vertices of a medial axis, from its triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "blum/axis/axis_graph.hpp"
#include "blum/complex/complex.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/context.hpp"
#include "blum/core/union_find.hpp"

namespace blum::detail {

/// Number that is linear over an edge or a triangle.
struct LinearPart {
  static LinearPart on_edge(double a, double b, double length) {
    return {{std::min(a, b), std::min(a, b), std::max(a, b)}, length, true};
  }
  static LinearPart on_triangle(std::array<double, 3> values, double area) {
    std::sort(values.begin(), values.end());
    return {values, area, false};
  }

  std::array<double, 3> values;  ///< at the corners, ascending; an edge has the lower value twice
  double weight;                 ///< length or area
  bool is_edge;

  /// Returns the share of the edge or triangle in which the number is at most `value`.
  [[nodiscard]] double share_up_to(double value) const;
};

/// Computes the low value and the median of a number over parts: 5 % and half of the weight lie up to these. If no part
/// has weight, all parts count the same.
/// @param parts   not empty.
/// @param spread  with its minimum and maximum.
/// Cost: O(parts), some ten times.
void add_quantiles(std::vector<LinearPart> parts, AxisSpread& spread);

/// Kind of an edge by its triangles: none; one; two of one sheet; two of different sheets; more.
enum class EdgePart : std::uint8_t { curve, rim, inner, crease, seam };

/// Axis cut open along seams, creases, and where a sheet only touches itself. Corners of triangles that are glued
/// together through inner edges are one vertex of the cut-open sheet.
class AxisParts {
 public:
  /// @param axis  has all columns and no problem. It must stay unchanged.
  AxisParts(const Complex& axis, const Context& context);

  [[nodiscard]] const MedialView& view() const { return view_; }
  [[nodiscard]] const Incidence& incidence() const { return incidence_; }
  [[nodiscard]] EdgePart part(std::uint32_t edge) const { return parts_[edge]; }
  [[nodiscard]] double edge_length(std::uint32_t edge) const;
  /// Returns the place of a triangle's sheet among those that have triangles.
  [[nodiscard]] std::uint32_t sheet_place(std::uint32_t triangle) const {
    return place_of_sheet_[static_cast<std::size_t>(view_.sheet[triangle])];
  }
  /// Numbers of the sheets that have triangles, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& sheet_numbers() const { return sheet_numbers_; }
  /// Returns the vertex of the cut-open sheet for a corner (0, 1, 2) of a triangle.
  [[nodiscard]] std::uint32_t cut_vertex(std::uint32_t triangle, std::uint32_t corner) const {
    return cut_vertex_[3 * triangle + corner];
  }
  /// Returns true and the kind of a junction. Returns false if the vertex is the middle of a sheet, a rim, a seam or a
  /// curve.
  [[nodiscard]] std::pair<bool, JunctionKind> junction(std::uint32_t vertex) const;

 private:
  struct Around {
    std::uint32_t rims = 0, seams = 0, curves = 0;
    std::uint32_t fans = 0;       ///< cut vertices here
    bool has_closed_fan = false;  ///< one of them has no border
  };
  void find_parts();
  void number_sheets();
  void glue();
  void look_around();

  MedialView view_;
  Incidence incidence_;
  std::vector<EdgePart> parts_;
  std::vector<std::uint32_t> place_of_sheet_, sheet_numbers_, cut_vertex_;
  std::vector<Around> around_;
};

/// Adds to `graph` its sheets, without their patches, and the sums over them. `graph.seams` must be complete.
/// @param homotopy_angle  triangles of at most this angle exist for homotopy alone; without it, none does.
/// @param seam_of_edge  place in the seams for each of incidence().edges().
void add_sheets(const AxisParts& parts, const std::vector<std::uint32_t>& seam_of_edge,
                std::optional<double> homotopy_angle, AxisGraph& graph);

}  // namespace blum::detail
