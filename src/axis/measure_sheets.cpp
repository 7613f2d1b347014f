#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "axis/axis_parts.hpp"
#include "blum/core/sort_unique.hpp"

namespace blum::detail {
namespace {

constexpr double wall_angle = 150;  ///< degrees: two walls face each other if the separation angle is at least this

/// Data of a sheet while it is measured.
struct Measured {
  std::vector<LinearPart> thickness, angle, wall;  ///< by triangle; `wall`: thickness between facing walls
  Vec3d corners;                                   ///< sum of the positions of all corners
  std::int64_t border_sides = 0, cut_vertices = 0;
  bool is_shown = false;  ///< true if some triangle does not exist for homotopy alone
};

class SheetMeasurer {
 public:
  SheetMeasurer(const AxisParts& parts, const std::vector<std::uint32_t>& seam_of_edge,
                std::optional<double> homotopy_angle, AxisGraph& graph)
      : parts_(parts),
        seam_of_edge_(seam_of_edge),
        homotopy_angle_(homotopy_angle),
        graph_(graph),
        measured_(parts.sheet_numbers().size()) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    for (const std::uint32_t sheet : parts.sheet_numbers()) {
      graph_.sheets.emplace_back().sheet = sheet;
      AxisSheet& own = graph_.sheets.back();
      own.thickness = own.separation_angle = own.wall_thickness = {infinite, 0, 0, -infinite};
    }
  }

  void measure() {
    const std::size_t corners = 3 * parts_.view().triangles.size();
    detail::UnionFind borders(corners);
    std::vector<bool> is_border(corners, false);
    for (std::uint32_t t = 0; t < parts_.view().triangles.size(); ++t) {
      add_triangle(t);
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t from = parts_.cut_vertex(t, k);
        const std::uint32_t to = parts_.cut_vertex(t, (k + 1) % 3);
        if (from == 3 * t + k) ++measured_[parts_.sheet_place(t)].cut_vertices;
        if (!add_side(t, parts_.incidence().sides()[t][k])) continue;
        borders.join(from, to);
        is_border[from] = is_border[to] = true;
      }
    }
    for (std::uint32_t c = 0; c < corners; ++c) {
      if (is_border[c] && borders.find(c) == c) ++sheet_of(c / 3).boundary_loops;
    }
    for (std::size_t s = 0; s < measured_.size(); ++s) finish(graph_.sheets[s], measured_[s]);
    for (const AxisSheet& sheet : graph_.sheets) {
      graph_.area += sheet.area;
      graph_.homotopy_area += sheet.homotopy_area;
      graph_.rim_length += sheet.rim_length;
    }
  }

 private:
  AxisSheet& sheet_of(std::uint32_t triangle) { return graph_.sheets[parts_.sheet_place(triangle)]; }

  void add_triangle(std::uint32_t t) {
    const MedialView& axis = parts_.view();
    const auto& [a, b, c] = axis.triangles[t];
    const Vec3d& at = axis.positions[a];
    const double area = 0.5 * length(cross(axis.positions[b] - at, axis.positions[c] - at));
    const Vec3d corners = at + axis.positions[b] + axis.positions[c];
    AxisSheet& sheet = sheet_of(t);
    Measured& measured = measured_[parts_.sheet_place(t)];
    const std::array<double, 3> thickness{2 * axis.radius[a], 2 * axis.radius[b], 2 * axis.radius[c]};
    const std::array<double, 3> angles{axis.separation_angle[a], axis.separation_angle[b], axis.separation_angle[c]};
    add_corners(thickness, area, sheet.thickness, measured.thickness);
    add_corners(angles, area, sheet.separation_angle, measured.angle);
    if (*std::min_element(angles.begin(), angles.end()) >= wall_angle) {
      add_corners(thickness, area, sheet.wall_thickness, measured.wall);
      sheet.wall_area += area;
    }
    ++sheet.triangles;
    sheet.area += area;
    if (homotopy_angle_ && axis.triangle_angle[t] <= *homotopy_angle_) {
      sheet.homotopy_area += area;
    } else {
      measured.is_shown = true;
    }
    sheet.centroid += area / 3 * corners;
    measured.corners += corners;
  }

  static void add_corners(const std::array<double, 3>& values, double area, AxisSpread& spread,
                          std::vector<LinearPart>& parts) {
    for (const double value : values) {
      spread.minimum = std::min(spread.minimum, value);
      spread.maximum = std::max(spread.maximum, value);
    }
    parts.push_back(LinearPart::on_triangle(values, area));
  }

  /// Adds a side of a triangle to its sheet. Returns true if the side belongs to the sheet's border.
  bool add_side(std::uint32_t t, std::uint32_t edge) {
    const EdgePart part = parts_.part(edge);
    if (part == EdgePart::inner) return false;
    AxisSheet& sheet = sheet_of(t);
    double& along = part == EdgePart::rim    ? sheet.rim_length
                    : part == EdgePart::seam ? sheet.seam_length
                                             : sheet.crease_length;
    along += parts_.edge_length(edge);
    if (part == EdgePart::seam) sheet.seams.push_back(seam_of_edge_[edge]);
    ++measured_[parts_.sheet_place(t)].border_sides;
    return true;
  }

  static void finish(AxisSheet& sheet, Measured& measured) {
    const auto triangles = static_cast<std::int64_t>(sheet.triangles);
    add_quantiles(std::move(measured.thickness), sheet.thickness);
    add_quantiles(std::move(measured.angle), sheet.separation_angle);
    if (measured.wall.empty()) {
      sheet.wall_thickness = {};
    } else {
      add_quantiles(std::move(measured.wall), sheet.wall_thickness);
    }
    sheet.centroid =
        sheet.area > 0 ? sheet.centroid / sheet.area : measured.corners / static_cast<double>(3 * sheet.triangles);
    const std::int64_t edges = (3 * triangles + measured.border_sides) / 2;
    sheet.euler_characteristic = measured.cut_vertices - edges + triangles;
    sheet.for_homotopy = !measured.is_shown;
    detail::sort_unique(sheet.seams);
  }

  const AxisParts& parts_;
  const std::vector<std::uint32_t>& seam_of_edge_;
  std::optional<double> homotopy_angle_;
  AxisGraph& graph_;
  std::vector<Measured> measured_;
};

}  // namespace

void add_sheets(const AxisParts& parts, const std::vector<std::uint32_t>& seam_of_edge,
                std::optional<double> homotopy_angle, AxisGraph& graph) {
  SheetMeasurer(parts, seam_of_edge, homotopy_angle, graph).measure();
}

}  // namespace blum::detail
