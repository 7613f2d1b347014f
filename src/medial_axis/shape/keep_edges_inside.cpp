#include "medial_axis/shape/keep_edges_inside.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <vector>

#include "blum/core/parallel.hpp"
#include "medial_axis/shape/place_vertices.hpp"

namespace blum {
namespace {

constexpr std::size_t cells_per_range = 1024;
constexpr double on_a_face = 1e-7;  ///< voxels

using Voxel = std::array<std::int64_t, 3>;

/// The voxels that a segment can meet, as a box, both ends included; of a segment in a face, those on both sides.
struct VoxelBox {
  Voxel lower, upper;

  /// Whether there is a voxel between those at the ends.
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

  /// Whether a segment leaves the solid other than by cutting a corner: past the side of a voxel that only its end
  /// belongs to, or into a voxel between those of its ends.
  [[nodiscard]] bool crosses_a_gap(const Vec3d& from, const Vec3d& to) const {
    const Vec3d a = in_voxels(from);
    const Vec3d b = in_voxels(to);
    const VoxelBox box = box_around(a, b);
    return !is_full(box) && !is_inside(a, b) && (box.is_long() || !has_end(box, a) || !has_end(box, b));
  }

 private:
  /// Voxel (i, j, k) spans i to i + 1 along x, and so on.
  [[nodiscard]] Vec3d in_voxels(const Vec3d& x) const {
    const Vec3d seen = grid_.direction.transposed_times(x - grid_.origin);
    return {seen.x / grid_.spacing.x + 0.5, seen.y / grid_.spacing.y + 0.5, seen.z / grid_.spacing.z + 0.5};
  }
  /// Whether a voxel of the box that is in the solid holds an end.
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

  /// Whether a segment lies in the closed voxels of the solid: its parts between planes of the lattice do.
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

}  // namespace

void keep_edges_inside(AxisPiece& piece, const AxisCorners& corners, const GovernorField& governors,
                       const Context& context) {
  const GapFinder gaps(governors.solid());
  // Each round puts at least one vertex back for good; mostly there is nothing to do.
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
          look(triangles[0][0], triangles[0][2]);  // the diagonal; the sides are edges of their own
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

}  // namespace blum
