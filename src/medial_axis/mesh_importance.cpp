#include "medial_axis/mesh_importance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "blum/core/parallel.hpp"
#include "medial_axis/equidistant_point.hpp"

namespace blum {
namespace {

/// How far, in voxels, a footprint may move when its point moves by less than one.
constexpr double reach_around_axis = 1.5;
/// How far beyond the closest distance a footprint may be to count, in voxels, at a point that all were fitted to.
constexpr double fitted_tolerance = 0.1;
constexpr double fitted_reach = 0.6;  ///< of a point from the middle of its cell, in voxels along each axis
constexpr int bisector_steps = 4;

class Measure {
 public:
  Measure(const GovernorField& governors, const CellComplex& complex, const Bvh& bvh, const NoiseFloor& floor)
      : governors_(governors),
        walk_(governors.walk()),
        complex_(complex),
        bvh_(bvh),
        floor_(floor),
        voxel_(governors.voxel()) {}

  using Around = GovernorsAround;

  /// Calls use(node, cells, around) for the nodes of a layer that have cells, and voxels around them whose closest
  /// points lie in different directions.
  template <class Use>
  void for_each_uneven_node(std::int64_t k, const Use& use) const {
    const CellLattice& lattice = complex_.lattice();
    const auto& size = lattice.size();
    Around around;
    for (std::int64_t j = 1; j + 1 < size[1]; ++j) {
      std::int64_t known = -2;
      for (std::int64_t i = 1; i + 1 < size[0]; ++i) {
        const std::size_t node = lattice.node(i, j, k);
        const unsigned cells = complex_.bytes()[node];
        if (cells == 0) continue;
        for (unsigned v = 0; v < 8; ++v) {
          if ((v & 1U) == 0 && known == i - 1) {
            around[v] = around[v + 1];
          } else {
            around[v] = governors_.at(i - 1 + (v & 1U), j - 1 + (v >> 1U & 1U), k - 1 + (v >> 2U));
          }
        }
        known = i;
        if (is_uneven(around)) use(node, cells, around);
      }
    }
  }

  /// The angle on the bisector between two voxels that share a square; 0 where both follow the same wall.
  [[nodiscard]] double between(const Governor& a, const Governor& b) const {
    if (a.foot.triangle == b.foot.triangle || (!a.is_inside && !b.is_inside)) return 0;
    double low = 0;  // where a's wall is the closer one
    double high = 1;
    double t = 0.5;
    Vec3d x;
    Footprint p = a.foot;
    Footprint q = b.foot;
    for (int step = 0; step < bisector_steps; ++step) {
      x = a.centre + (b.centre - a.centre) * t;
      p = walk_.follow(a.foot, x, HUGE_VAL);
      q = walk_.follow(b.foot, x, HUGE_VAL);
      const double difference = length(x - p.point) - length(x - q.point);
      if (std::abs(difference) < 1e-3 * voxel_) break;
      (difference < 0 ? low : high) = t;
      // Where both distances change linearly, their slopes are those along the two directions.
      const double slope = slope_along(a, b, x, p) - slope_along(a, b, x, q);
      const double next = slope > 0 ? t - difference / slope : -1;
      t = next > low && next < high ? next : 0.5 * (low + high);
    }
    if (!is_inside(a, x) && !is_inside(b, x)) return 0;
    return above_floor(x, p.point, q.point);
  }

  /// The largest angle between any two voxels of a cell, as the voxels' own directions tell it.
  [[nodiscard]] static double coarse(const Around& around, CellAxes axes) {
    double least = 1;
    for (unsigned v = 0; v < 8; ++v) {
      if ((v & axes) != axes) continue;
      for (unsigned w = v + 1; w < 8; ++w) {
        if ((w & axes) == axes) least = std::min(least, dot(around[v].direction, around[w].direction));
      }
    }
    return std::acos(std::clamp(least, -1.0, 1.0)) * degrees_per_radian;
  }

  /// The angle at a point as far from all footprints around an edge or vertex, within half a voxel of its middle.
  [[nodiscard]] double fitted(const Around& around, CellAxes axes) const {
    std::array<Vec3d, 8> feet;
    std::array<const Governor*, 8> governors{};
    std::size_t count = 0;
    Vec3d middle;
    for (unsigned v = 0; v < 8; ++v) {
      if ((v & axes) != axes) continue;
      governors[count] = &around[v];
      feet[count++] = around[v].foot.point;
      middle += around[v].centre;
    }
    middle *= 1.0 / static_cast<double>(count);
    double largest = 0;
    for (const int rank : {3, 2}) {
      const std::optional<Vec3d> x = equidistant_point({feet.data(), count}, middle, rank);
      if (!x || !is_near(*x, middle)) continue;
      largest = std::max(largest, angle_of({governors.data(), count}, *x));
    }
    return largest;
  }

 private:
  [[nodiscard]] bool is_uneven(const Around& around) const {
    Vec3d sum;
    bool is_same = true;
    for (const Governor& g : around) {
      sum += g.direction;
      is_same = is_same && g.foot.triangle == around[0].foot.triangle;
    }
    if (is_same) return false;
    const double size = length(sum);
    const double narrow = std::cos(0.5 * floor_.angle / degrees_per_radian);
    for (const Governor& g : around) {
      if (dot(g.direction, sum) < narrow * size) return true;
    }
    return false;
  }

  [[nodiscard]] static double slope_along(const Governor& a, const Governor& b, const Vec3d& x, const Footprint& p) {
    const double distance = length(x - p.point);
    return distance > 0 ? dot(b.centre - a.centre, x - p.point) / distance : 0;
  }

  /// Whether a point near a voxel is on the inner side of the wall that the voxel is closest to.
  [[nodiscard]] static bool is_inside(const Governor& g, const Vec3d& x) {
    return dot(x - g.foot.point, g.direction) < 0;
  }

  [[nodiscard]] double above_floor(const Vec3d& x, const Vec3d& p, const Vec3d& q) const {
    const double angle = angle_at(x, p, q);
    if (angle < floor_.angle) return 0;
    if (angle < floor_.clear_angle && length(p - q) < floor_.voxels * voxel_) return 0;
    return angle;
  }

  [[nodiscard]] bool is_near(const Vec3d& x, const Vec3d& middle) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::abs(x[axis] - middle[axis]) > fitted_reach * governors_.solid().grid.spacing[axis]) return false;
    }
    return true;
  }

  [[nodiscard]] double angle_of(std::span<const Governor* const> governors, const Vec3d& x) const {
    const std::optional<NearestSite> nearest = bvh_.nearest(x);
    if (!nearest) return 0;
    const double limit = nearest->distance + fitted_tolerance * voxel_;
    std::array<Vec3d, 8> feet;
    std::size_t count = 0;
    bool is_in = false;
    for (const Governor* g : governors) {
      is_in = is_in || is_inside(*g, x);
      const Footprint foot = walk_.follow(g->foot, x, reach_around_axis * voxel_);
      if (length(x - foot.point) <= limit) feet[count++] = foot.point;
    }
    if (!is_in) return 0;
    double largest = 0;
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = a + 1; b < count; ++b) largest = std::max(largest, above_floor(x, feet[a], feet[b]));
    }
    return largest;
  }

  const GovernorField& governors_;
  const SurfaceWalk& walk_;
  const CellComplex& complex_;
  const Bvh& bvh_;
  const NoiseFloor& floor_;
  double voxel_;
};

using Entries = std::vector<Importance::Entry>;

/// One list of all layers' entries.
Entries joined(const std::vector<Entries>& layers) {
  Entries all;
  for (const Entries& layer : layers) all.insert(all.end(), layer.begin(), layer.end());
  return all;
}

/// Gives each cell at least what its cofaces have.
Entries closed(const CellLattice& lattice, const Entries& own) {
  Entries all = own;
  for (const Importance::Entry& entry : own) {
    lattice.for_each_face(entry.cell, [&](Cell face) {
      all.push_back({face, entry.degrees});
      if (dimension_of(face) == 0) return;
      lattice.for_each_face(face, [&](Cell corner) { all.push_back({corner, entry.degrees}); });
    });
  }
  std::sort(all.begin(), all.end(), [](const Importance::Entry& a, const Importance::Entry& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.degrees > b.degrees;
  });
  all.erase(std::unique(all.begin(), all.end(),
                        [](const Importance::Entry& a, const Importance::Entry& b) { return a.cell == b.cell; }),
            all.end());
  return all;
}

}  // namespace

Importance mesh_importance(const GovernorField& governors, const CellComplex& complex, const Bvh& bvh,
                           const NoiseFloor& floor, const Context& context) {
  const Measure measure(governors, complex, bvh, floor);
  const CellLattice& lattice = complex.lattice();
  const auto layers = static_cast<std::size_t>(lattice.size()[2]);
  std::vector<Entries> found(layers);
  const auto for_each_layer = [&](std::string_view phase, const auto& use) {
    parallel_for(context, layers, 1, phase, [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        if (k == 0 || k + 1 == layers) continue;
        measure.for_each_uneven_node(static_cast<std::int64_t>(k),
                                     [&](std::size_t node, unsigned cells, const Measure::Around& around) {
                                       use(found[k], node, cells, around);
                                     });
      }
    });
  };
  for_each_layer("separation angles of squares",
                 [&](Entries& out, std::size_t node, unsigned cells, const Measure::Around& around) {
                   for (const CellAxes axes : {3U, 5U, 6U}) {
                     if ((cells >> axes & 1U) == 0) continue;
                     const double angle = measure.between(around[axes], around[7]);
                     if (angle > 0) out.push_back({cell_at(node, axes), static_cast<float>(angle)});
                   }
                 });
  const Importance squares(lattice.node_count(), closed(lattice, joined(found)));
  constexpr double worth_looking = 15;  // degrees more than the squares have
  for_each_layer("separation angles of edges",
                 [&](Entries& out, std::size_t node, unsigned cells, const Measure::Around& around) {
                   for (const CellAxes axes : {0U, 1U, 2U, 4U}) {
                     if ((cells >> axes & 1U) == 0) continue;
                     const Cell cell = cell_at(node, axes);
                     const double known = squares.of(cell);
                     if (Measure::coarse(around, axes) < std::max(known + worth_looking, floor.angle)) continue;
                     const double angle = measure.fitted(around, axes);
                     if (angle > known) out.push_back({cell, static_cast<float>(angle)});
                   }
                 });
  return {lattice.node_count(), closed(lattice, joined(found))};
}

}  // namespace blum
