// Blum: what the edges and vertices of a medial axis are by their triangles. SPDX-License-Identifier: Apache-2.0
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

/// A number that is linear over an edge or a triangle.
struct LinearPart {
  static LinearPart on_edge(double a, double b, double length) {
    return {{std::min(a, b), std::min(a, b), std::max(a, b)}, length, true};
  }
  static LinearPart on_triangle(std::array<double, 3> values, double area) {
    std::sort(values.begin(), values.end());
    return {values, area, false};
  }

  std::array<double, 3> values;  ///< at the corners, rising; of an edge, the first two are those of one end
  double weight;                 ///< length or area
  bool is_edge;

  /// Where the number is at most this, as a share of the edge or triangle.
  [[nodiscard]] double share_up_to(double value) const;
};

/// The low value and the median of a number over parts: those up to which 5 % and half of the weight lie; of parts
/// without weight, of their number.
/// @param parts   not empty.
/// @param spread  its minimum and maximum are there.
/// Cost: O(parts), some ten times.
void add_quantiles(std::vector<LinearPart> parts, AxisSpread& spread);

/// What an edge is: of no triangle; of one; of two of one sheet; of two of different sheets; of more.
enum class EdgePart : std::uint8_t { curve, rim, inner, crease, seam };

/// An axis cut open: corners of triangles are one where these are glued together through inner edges, and so are the
/// vertices of each sheet cut open along seams, creases and where it only touches itself.
class AxisParts {
 public:
  /// @param axis  has all columns, and no problem. It must stay as it is.
  AxisParts(const Complex& axis, const Context& context);

  [[nodiscard]] const MedialView& view() const { return view_; }
  [[nodiscard]] const Incidence& incidence() const { return incidence_; }
  [[nodiscard]] EdgePart part(std::uint32_t edge) const { return parts_[edge]; }
  [[nodiscard]] double edge_length(std::uint32_t edge) const;
  /// Of a triangle: its sheet's place among those that have triangles.
  [[nodiscard]] std::uint32_t sheet_place(std::uint32_t triangle) const {
    return place_of_sheet_[static_cast<std::size_t>(view_.sheet[triangle])];
  }
  /// The numbers of the sheets that have triangles, rising.
  [[nodiscard]] const std::vector<std::uint32_t>& sheet_numbers() const { return sheet_numbers_; }
  /// The vertex of the cut-open sheet that a corner (0, 1, 2) of a triangle is.
  [[nodiscard]] std::uint32_t cut_vertex(std::uint32_t triangle, std::uint32_t corner) const {
    return cut_vertex_[3 * triangle + corner];
  }
  /// What a vertex is; false where it is the middle of a sheet, a rim, a seam or a curve.
  [[nodiscard]] std::pair<bool, JunctionKind> junction(std::uint32_t vertex) const;

 private:
  struct Around {
    std::uint32_t rims = 0, seams = 0, curves = 0;
    std::uint32_t fans = 0;       ///< cut vertices here
    bool has_closed_fan = false;  ///< one of them without a border
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

/// Puts into `graph` its sheets, but for their patches, and the sums over them. `graph.seams` is there.
/// @param homotopy_angle  triangles of at most this are there for homotopy alone; without it, none is.
/// @param seam_of_edge  of incidence().edges(): its place in the seams.
void add_sheets(const AxisParts& parts, const std::vector<std::uint32_t>& seam_of_edge,
                std::optional<double> homotopy_angle, AxisGraph& graph);

}  // namespace blum::detail
