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

/// Quantity that varies linearly over an edge or a triangle.
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

  /// Returns the share of the length or area in which the quantity is at most `value`.
  [[nodiscard]] double share_up_to(double value) const;
};

/// Computes the 5 % quantile (`spread.low`) and the median of a quantity over weighted parts. If the total weight is 0,
/// all parts get equal weights.
/// @param parts   not empty.
/// @param spread  must contain the minimum and the maximum.
/// Cost: about ten passes over the parts.
void add_quantiles(std::vector<LinearPart> parts, AxisSpread& spread);

/// Kind of an edge. An edge has no triangle (`curve`), one (`rim`), two of the same sheet (`inner`), two of different
/// sheets (`crease`), or more than two (`seam`).
enum class EdgePart : std::uint8_t { curve, rim, inner, crease, seam };

/// Axis whose sheets are cut apart along seams and creases, and at vertices where a sheet only touches itself. Corners
/// of triangles form one cut vertex if inner edges connect their triangles around the vertex.
class AxisParts {
 public:
  /// @param axis  has all columns, and problem_of_medial() finds no problem in it. It must outlive this object
  ///              unchanged.
  AxisParts(const Complex& axis, const Context& context);

  [[nodiscard]] const MedialView& view() const { return view_; }
  [[nodiscard]] const Incidence& incidence() const { return incidence_; }
  [[nodiscard]] EdgePart part(std::uint32_t edge) const { return parts_[edge]; }
  [[nodiscard]] double edge_length(std::uint32_t edge) const;
  /// Returns the index of a triangle's sheet in sheet_numbers().
  [[nodiscard]] std::uint32_t sheet_place(std::uint32_t triangle) const {
    return place_of_sheet_[static_cast<std::size_t>(view_.sheet[triangle])];
  }
  /// Numbers of the sheets that have triangles, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& sheet_numbers() const { return sheet_numbers_; }
  /// Returns the cut vertex of a corner (0, 1, 2) of a triangle.
  [[nodiscard]] std::uint32_t cut_vertex(std::uint32_t triangle, std::uint32_t corner) const {
    return cut_vertex_[3 * triangle + corner];
  }
  /// Returns true and the kind if a vertex is a junction. Returns false if the vertex lies inside a sheet, or on a rim,
  /// seam or curve between its ends.
  [[nodiscard]] std::pair<bool, JunctionKind> junction(std::uint32_t vertex) const;

 private:
  struct Around {
    std::uint32_t rims = 0, seams = 0, curves = 0;
    std::uint32_t fans = 0;       ///< number of cut vertices at the vertex
    bool has_closed_fan = false;  ///< true if triangles surround one of the cut vertices completely
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

/// Adds to `graph` the sheets, except for their patches, and the sums over all sheets. `graph.seams` must be complete.
/// @param homotopy_angle  triangles of at most this angle (degrees) exist for homotopy alone. Without a value, no
///                        triangle exists for homotopy alone.
/// @param seam_of_edge  for each edge of incidence().edges(): the index of its seam in `graph.seams`.
void add_sheets(const AxisParts& parts, const std::vector<std::uint32_t>& seam_of_edge,
                std::optional<double> homotopy_angle, AxisGraph& graph);

}  // namespace blum::detail
