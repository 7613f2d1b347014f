#include "medial_axis/shape/axis_piece.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/union_find.hpp"
#include "medial_axis/cells/attached_voxels.hpp"
#include "medial_axis/cells/collapse.hpp"
#include "medial_axis/shape/axis_corners.hpp"
#include "medial_axis/shape/place_vertices.hpp"
#include "medial_axis/shape/shape_cells.hpp"
#include "medial_axis/surface/governors.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t cells_per_range = 1024;
constexpr double on_a_face = 1e-7;  ///< voxels

using Voxel = std::array<std::int64_t, 3>;

/// Box of the voxels that a segment can meet, from voxel `lower` to voxel `upper`, both included. If the segment lies
/// in a face of voxels, the box contains the voxels on both sides.
struct VoxelBox {
  Voxel lower, upper;

  /// Returns true if there is a voxel between those at the two ends, along any axis.
  [[nodiscard]] bool is_long() const {
    return upper[0] - lower[0] > 1 || upper[1] - lower[1] > 1 || upper[2] - lower[2] > 1;
  }

  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::int64_t k = lower[2]; k <= upper[2]; ++k) {
      for (std::int64_t j = lower[1]; j <= upper[1]; ++j) {
        for (std::int64_t i = lower[0]; i <= upper[0]; ++i) visit(Voxel{i, j, k});
      }
    }
  }
};

VoxelBox box_around(const Vec3d& a, const Vec3d& b) {
  VoxelBox box{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double least = std::min(a[axis], b[axis]);
    const double most = std::max(a[axis], b[axis]);
    box.lower[axis] = static_cast<std::int64_t>(std::floor(least + on_a_face));
    box.upper[axis] = static_cast<std::int64_t>(std::ceil(most - on_a_face)) - 1;
    if (box.upper[axis] >= box.lower[axis]) continue;
    box.upper[axis] = static_cast<std::int64_t>(std::lround(least));
    box.lower[axis] = box.upper[axis] - 1;
  }
  return box;
}

class GapFinder {
 public:
  explicit GapFinder(const VoxelSolid& solid) : grid_(solid.grid), voxels_(solid.voxels) {}

  /// Returns true if a segment leaves the solid other than by cutting a corner. In this case a voxel lies between those
  /// of its ends, or an end lies in no voxel of the solid.
  [[nodiscard]] bool crosses_a_gap(const Vec3d& from, const Vec3d& to) const {
    const Vec3d a = in_voxels(from);
    const Vec3d b = in_voxels(to);
    const VoxelBox box = box_around(a, b);
    return !is_full(box) && !is_inside(a, b) && (box.is_long() || !has_end(box, a) || !has_end(box, b));
  }

 private:
  /// Converts a point to voxel coordinates: voxel (i, j, k) spans i to i + 1 along x, and likewise along y and z.
  [[nodiscard]] Vec3d in_voxels(const Vec3d& x) const {
    const Vec3d seen = grid_.direction.transposed_times(x - grid_.origin);
    return {seen.x / grid_.spacing.x + 0.5, seen.y / grid_.spacing.y + 0.5, seen.z / grid_.spacing.z + 0.5};
  }
  /// Returns true if a voxel of the box contains a point and is in the solid.
  [[nodiscard]] bool has_end(const VoxelBox& box, const Vec3d& x) const {
    bool is_found = false;
    box.for_each([&](const Voxel& v) { is_found = is_found || (contains(v) && has(v, x)); });
    return is_found;
  }
  static bool has(const Voxel& v, const Vec3d& x) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto low = static_cast<double>(v[axis]);
      if (x[axis] < low - on_a_face || x[axis] > low + 1 + on_a_face) return false;
    }
    return true;
  }
  [[nodiscard]] bool is_full(const VoxelBox& box) const {
    bool is_full = true;
    box.for_each([&](const Voxel& v) { is_full = is_full && contains(v); });
    return is_full;
  }
  [[nodiscard]] bool contains(const Voxel& v) const { return voxels_.contains(v[0], v[1], v[2]); }

  /// Returns true if a segment lies in the closed voxels of the solid. It tests the middle of each part between two
  /// planes of the lattice.
  [[nodiscard]] bool is_inside(const Vec3d& a, const Vec3d& b) const {
    std::vector<double> cuts{0, 1};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double step = b[axis] - a[axis];
      if (std::abs(step) < on_a_face) continue;
      const double last = std::max(a[axis], b[axis]);
      for (double plane = std::ceil(std::min(a[axis], b[axis])); plane <= last; plane += 1) {
        cuts.push_back(std::clamp((plane - a[axis]) / step, 0.0, 1.0));
      }
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t c = 1; c < cuts.size(); ++c) {
      if (cuts[c] - cuts[c - 1] < on_a_face) continue;
      const Vec3d middle = a + (b - a) * (0.5 * (cuts[c] + cuts[c - 1]));
      bool is_in = false;
      box_around(middle, middle).for_each([&](const Voxel& v) { is_in = is_in || contains(v); });
      if (!is_in) return false;
    }
    return true;
  }

  const GridSpec& grid_;
  const VoxelSet& voxels_;
};

/// Moves the ends of an edge back to their lattice corners if the edge crosses a gap of the solid. In an image, the two
/// ends may have moved into parts with a gap between them, like the tips of a U. Edges between lattice corners lie in
/// the solid or on its surface, where the radius of vertices is 0. Edges that only cut a corner of the solid do not
/// change.
void keep_edges_inside(AxisPiece& piece, const AxisCorners& corners, const GovernorField& governors,
                       const Context& context) {
  const GapFinder gaps(governors.solid());
  // Each round moves at least one vertex back permanently. In most cases no vertex must be moved.
  for (bool is_done = false; !is_done;) {
    std::vector<std::uint8_t> goes_back(piece.vertices.size(), 0);
    std::atomic<bool> is_found = false;
    const auto look = [&](std::uint32_t a, std::uint32_t b) {
      if (!gaps.crosses_a_gap(piece.vertices[a].position, piece.vertices[b].position)) return;
      for (const std::uint32_t v : {a, b}) std::atomic_ref(goes_back[v]).store(1, std::memory_order_relaxed);
      is_found = true;
    };
    parallel_for(context, piece.cells.size(), cells_per_range, "vertices", [&](const WorkRange& range) {
      for (std::size_t c = range.begin; c < range.end; ++c) {
        const auto own = corners.of_cells()[c];
        if (piece.cells[c].dimension == 1) {
          look(own[0], own[1]);
        } else if (piece.cells[c].dimension == 2) {
          const auto triangles = triangles_of(own, piece.vertices);
          look(triangles[0][0], triangles[0][2]);  // the diagonal; the sides are tested as edges
        }
      }
    });
    is_done = true;
    if (!is_found) return;
    for (std::size_t v = 0; v < goes_back.size(); ++v) {
      if (goes_back[v] == 0) continue;
      const AxisVertex corner =
          vertex_at_corner(governors, piece.structure.lattice().place(node_of(corners.vertex_cells()[v])));
      if (corner.position == piece.vertices[v].position) continue;
      piece.vertices[v] = corner;
      is_done = false;
    }
  }
}

constexpr double same_place = 1e-6;  ///< voxels

/// Returns the cells of a complex, ascending, with infinite levels.
std::vector<AxisCell> cells_of(const CellComplex& complex, const Importance& importance) {
  std::vector<AxisCell> cells;
  complex.for_each_cell([&](Cell cell) {
    cells.push_back(
        {cell, complex.structure().dimension(cell), std::numeric_limits<float>::infinity(), importance.of(cell)});
  });
  return cells;
}

/// Returns the depths of extra cells in the solid. The depth of a polygon is half the length of the interval that it
/// represents. The depth of an edge or vertex is the largest one of its polygons.
std::vector<float> depths_of_extra(const CellStructure& structure) {
  std::vector<float> depths(structure.extra_count(), 0);
  const Cell first = structure.first_extra();
  for (int dimension = 2; dimension > 0; --dimension) {
    for (std::size_t k = 0; k < depths.size(); ++k) {
      const ExtraCell& cell = structure.extra()->cell(first + static_cast<Cell>(k));
      if (cell.dimension != dimension) continue;
      if (dimension == 2) depths[k] = static_cast<float>(0.5 * length(cell.ends[1].point - cell.ends[0].point));
      for (const Cell face : structure.extra()->faces_of(first + static_cast<Cell>(k))) {
        if (structure.is_extra(face)) depths[face - first] = std::max(depths[face - first], depths[k]);
      }
    }
  }
  return depths;
}

/// Makes the two ends of an edge equal if their positions are at most `tolerance` apart, as in a ribbon around a curve.
void make_equal(AxisPiece& piece, const IndexRows& corners, double tolerance) {
  detail::UnionFind joined(piece.vertices.size());
  for (std::size_t c = 0; c < piece.cells.size(); ++c) {
    if (piece.cells[c].dimension != 1) continue;
    const std::uint32_t a = corners[c][0];
    const std::uint32_t b = corners[c][1];
    if (squared_length(piece.vertices[a].position - piece.vertices[b].position) > tolerance * tolerance) continue;
    joined.join(a, b);
  }
  for (std::uint32_t v = 0; v < piece.vertices.size(); ++v) piece.vertices[v] = piece.vertices[joined.find(v)];
}

/// The cells of a piece that are left at an angle theta.
class Remainder {
 public:
  Remainder(const AxisPiece& piece, double theta, AxisLists& lists)
      : piece_(piece), lists_(lists), vertex_(piece.vertices.size(), nobody), in_polygon_(piece.cells.size(), false) {
    for (std::size_t c = 0; c < piece.cells.size(); ++c) {
      if (piece.cells[c].level > theta) left_.push_back(c);
    }
  }

  void append(const Context& context) {
    for (const std::size_t c : left_) {
      if (piece_.cells[c].dimension == 0) static_cast<void>(number(piece_.shapes[c][0]));
    }
    throw_if_cancelled(context);
    for (const std::size_t c : left_) {
      if (piece_.cells[c].dimension == 2) append_polygon(c);
    }
    throw_if_cancelled(context);
    for (const std::size_t c : left_) {
      if (piece_.cells[c].dimension == 1 && !in_polygon_[c]) append_curve(c);
    }
  }

 private:
  static constexpr std::uint32_t nobody = 0xffffffffU;

  /// Returns the index in the lists of a vertex of the piece. If the vertex is not yet in the lists, it is added.
  [[nodiscard]] std::uint32_t number(std::uint32_t place) {
    if (vertex_[place] == nobody) {
      vertex_[place] = static_cast<std::uint32_t>(lists_.vertices.size());
      lists_.vertices.push_back(piece_.vertices[place]);
    }
    return vertex_[place];
  }

  void append_polygon(std::size_t c) {
    const auto shape = piece_.shapes[c];
    for (std::size_t k = 0; k < shape.size(); k += 3) {
      lists_.add_triangle({number(shape[k]), number(shape[k + 1]), number(shape[k + 2])}, piece_.cells[c].angle);
    }
    for (const std::uint32_t edge : piece_.sides[c]) in_polygon_[edge] = true;
  }

  void append_curve(std::size_t c) {
    const auto shape = piece_.shapes[c];
    for (std::size_t k = 0; k + 1 < shape.size(); ++k) {
      lists_.add_edge({number(shape[k]), number(shape[k + 1])}, piece_.cells[c].angle);
    }
  }

  const AxisPiece& piece_;
  AxisLists& lists_;
  std::vector<std::size_t> left_;
  std::vector<std::uint32_t> vertex_;
  std::vector<bool> in_polygon_;
};

}  // namespace

AxisPiece make_axis_piece(const GovernorField& governors, const NoiseFloor& floor, double greatest_theta,
                          std::vector<PhaseTime>& phases, const Context& context) {
  PhaseTimer timer(phases);
  const VoxelSolid& solid = governors.solid();
  CellComplex complex(solid.voxels, solid.extra, context);
  timer.lap("cells");
  const Importance importance = separation_angles(governors, complex, floor, context);
  timer.lap("separation angles");
  AxisPiece piece;
  piece.structure = complex.structure();
  collapse_extra(complex, importance);
  {
    const AttachedVoxels attached(complex, solid.voxels, importance);
    complex = attached.rest(thin_voxels(solid, attached, complex.lattice(), importance, context), context);
  }
  timer.lap("thinning");
  const std::vector<float> depths = depths_of_extra(piece.structure);
  const CollapseOrder order = collapse(std::move(complex), {solid.depth.span(), depths}, 0.25 * governors.voxel(),
                                       importance, greatest_theta, context);
  piece.cells = cells_of(order.base, importance);
  const AxisCorners corners(piece, context);
  for (const Removal& removal : order.removals) {
    for (const Cell cell : {removal.cell, removal.face}) piece.cells[corners.index_of(cell)].level = removal.level;
  }
  timer.lap("collapse");
  const Witnesses witnesses(governors, piece.structure);
  piece.vertices = place_vertices(witnesses, corners.vertex_cells(), context);
  if (solid.is_exact) keep_edges_inside(piece, corners, governors, context);
  make_equal(piece, corners.of_cells(), same_place * governors.voxel());
  shape_cells(piece, corners, witnesses, context);
  timer.lap("vertices");
  return piece;
}

void append_at(const AxisPiece& piece, double theta, AxisLists& lists, const Context& context) {
  throw_if_cancelled(context);
  Remainder(piece, theta, lists).append(context);
}

}  // namespace blum::detail
