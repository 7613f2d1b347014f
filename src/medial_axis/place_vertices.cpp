#include "medial_axis/place_vertices.hpp"

#include <cmath>
#include <optional>
#include <span>

#include "blum/core/parallel.hpp"
#include "medial_axis/equidistant_point.hpp"

namespace blum {
namespace {

constexpr std::size_t nodes_per_range = 256;
constexpr int most_steps = 12;
/// How far a vertex may move from its corner along each axis, in voxels: less than half keeps neighbours in order.
constexpr double most_moved = 0.49;
/// Two distances count as equal from here on, in voxels.
constexpr double equal_distances = 1e-9;

/// A point and the footprints on the two walls that it lies between.
struct Placed {
  Vec3d x;
  Footprint p;
  Footprint q;
  double angle = 0;
};

class Placer {
 public:
  Placer(const GovernorField& governors, const Bvh& bvh, const MeshView& mesh, const SiteTable& sites)
      : governors_(governors), walk_(governors.walk()), bvh_(bvh), mesh_(mesh), sites_(sites) {}

  [[nodiscard]] MedialVertex place(const std::array<std::int64_t, 3>& node) const {
    const GovernorsAround around = governors_.around(node);
    const Vec3d corner = governors_.solid().grid.position(node[0], node[1], node[2]) -
                         governors_.solid().grid.direction * (governors_.solid().grid.spacing * 0.5);
    std::optional<Placed> best;
    const auto keep = [&](const std::optional<Placed>& placed) {
      if (placed && (!best || placed->angle > best->angle)) best = placed;
    };
    for (const auto& [a, b] : widest_pairs(around)) {
      // Seams and axes first: a point that all footprints agree on; else any point between the two walls.
      for (const int rank : {3, 2}) {
        if (const auto start = fitted(around, corner, rank)) keep(between(around[a], around[b], *start, corner));
      }
      if (!best) keep(between(around[a], around[b], corner, corner));
    }
    return vertex_at(best, corner);
  }

 private:
  using Pairs = std::array<std::array<std::size_t, 2>, 2>;

  /// The two pairs of voxels whose directions differ most.
  static Pairs widest_pairs(const GovernorsAround& around) {
    Pairs pairs{{{0, 7}, {0, 7}}};
    std::array<double, 2> least{2, 2};
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = a + 1; b < 8; ++b) {
        const double cosine = dot(around[a].direction, around[b].direction);
        if (cosine < least[0]) {
          least[1] = least[0];
          pairs[1] = pairs[0];
          least[0] = cosine;
          pairs[0] = {a, b};
        } else if (cosine < least[1]) {
          least[1] = cosine;
          pairs[1] = {a, b};
        }
      }
    }
    return pairs;
  }

  [[nodiscard]] std::optional<Vec3d> fitted(const GovernorsAround& around, const Vec3d& corner, int rank) const {
    std::array<Vec3d, 8> feet;
    for (std::size_t v = 0; v < 8; ++v) feet[v] = around[v].foot.point;
    const std::optional<Vec3d> x = equidistant_point(feet, corner, rank);
    return x && is_near(*x, corner) ? x : std::nullopt;
  }

  [[nodiscard]] bool is_near(const Vec3d& x, const Vec3d& corner) const {
    const Vec3d moved = governors_.solid().grid.direction.transposed_times(x - corner);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::abs(moved[axis]) > most_moved * governors_.solid().grid.spacing[axis]) return false;
    }
    return true;
  }

  /// Newton steps towards the points that are as far from one wall as from the other, along the difference of the
  /// directions to both.
  [[nodiscard]] std::optional<Placed> between(const Governor& a, const Governor& b, const Vec3d& start,
                                              const Vec3d& corner) const {
    Placed at{start, a.foot, b.foot, 0};
    const double voxel = governors_.voxel();
    for (int step = 0; step < most_steps; ++step) {
      at.p = walk_.follow(a.foot, at.x, 2 * voxel);
      at.q = walk_.follow(b.foot, at.x, 2 * voxel);
      const Vec3d to_p = at.x - at.p.point;
      const Vec3d to_q = at.x - at.q.point;
      const double distance_p = length(to_p);
      const double distance_q = length(to_q);
      const double difference = distance_p - distance_q;
      if (std::abs(difference) <= equal_distances * voxel) break;
      if (!(distance_p > 0) || !(distance_q > 0)) return std::nullopt;
      const Vec3d slope = to_p / distance_p - to_q / distance_q;
      const double squared = squared_length(slope);
      if (squared < 1e-4) return std::nullopt;  // the same wall
      at.x -= slope * (difference / squared);
      if (!is_near(at.x, corner)) return std::nullopt;
    }
    if (squared_length(at.p.point - at.q.point) < 1e-12 * voxel * voxel) return std::nullopt;
    at.angle = angle_at(at.x, at.p.point, at.q.point);
    return at;
  }

  /// The exact closest point, and the other wall's where it is as close.
  [[nodiscard]] MedialVertex vertex_at(const std::optional<Placed>& placed, const Vec3d& corner) const {
    MedialVertex vertex;
    vertex.position = placed ? placed->x : corner;
    const std::optional<NearestSite> nearest = bvh_.nearest(vertex.position);
    if (!nearest) return vertex;
    vertex.radius = nearest->distance;
    vertex.footprints = {nearest->point, nearest->point};
    vertex.sites = {nearest->site, nearest->site};
    if (!placed) return vertex;
    const double limit = nearest->distance + 1e-6 * governors_.voxel() + 1e-9 * nearest->distance;
    for (const Footprint& foot : {placed->p, placed->q}) {
      if (length(vertex.position - foot.point) > limit) continue;
      const double angle = angle_at(vertex.position, nearest->point, foot.point);
      if (angle <= vertex.separation_angle) continue;
      vertex.footprints[1] = foot.point;
      vertex.sites[1] = site_of(foot, sites_, mesh_);
      vertex.separation_angle = angle;
    }
    return vertex;
  }

  const GovernorField& governors_;
  const SurfaceWalk& walk_;
  const Bvh& bvh_;
  const MeshView& mesh_;
  const SiteTable& sites_;
};

}  // namespace

std::vector<MedialVertex> place_vertices(const GovernorField& governors, const CellComplex& complex,
                                         const std::vector<std::uint32_t>& nodes, const Bvh& bvh, const MeshView& mesh,
                                         const SiteTable& sites, const Context& context) {
  const Placer placer(governors, bvh, mesh, sites);
  std::vector<MedialVertex> vertices(nodes.size());
  parallel_for(context, nodes.size(), nodes_per_range, "vertices", [&](const WorkRange& range) {
    for (std::size_t n = range.begin; n < range.end; ++n) {
      vertices[n] = placer.place(complex.lattice().place(nodes[n]));
    }
  });
  return vertices;
}

}  // namespace blum
