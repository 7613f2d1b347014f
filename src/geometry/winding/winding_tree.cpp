#include "geometry/winding/winding_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "blum/core/parallel.hpp"
#include "blum/geometry/space_order.hpp"
#include "geometry/box_scale.hpp"

namespace blum {
namespace {

constexpr std::size_t grain = 512;

/// Symmetric tensor of second order; the next struct is one of third order.
struct Symmetric2 {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};
struct Symmetric3 {
  double xxx = 0, yyy = 0, zzz = 0, xxy = 0, xxz = 0, xyy = 0, yyz = 0, xzz = 0, yzz = 0, xyz = 0;
};

/// Adds factor * (symmetric part of a b^T) to m.
void add_product(Symmetric2& m, const Vec3d& a, const Vec3d& b, double factor) {
  m.xx += factor * a.x * b.x;
  m.yy += factor * a.y * b.y;
  m.zz += factor * a.z * b.z;
  m.xy += factor * (a.x * b.y + a.y * b.x) / 2;
  m.xz += factor * (a.x * b.z + a.z * b.x) / 2;
  m.yz += factor * (a.y * b.z + a.z * b.y) / 2;
}

/// Adds factor * (symmetric part of m a) to t.
void add_product(Symmetric3& t, const Symmetric2& m, const Vec3d& a, double factor) {
  t.xxx += factor * m.xx * a.x;
  t.yyy += factor * m.yy * a.y;
  t.zzz += factor * m.zz * a.z;
  t.xxy += factor * (m.xx * a.y + 2 * m.xy * a.x) / 3;
  t.xxz += factor * (m.xx * a.z + 2 * m.xz * a.x) / 3;
  t.xyy += factor * (m.yy * a.x + 2 * m.xy * a.y) / 3;
  t.yyz += factor * (m.yy * a.z + 2 * m.yz * a.y) / 3;
  t.xzz += factor * (m.zz * a.x + 2 * m.xz * a.z) / 3;
  t.yzz += factor * (m.zz * a.y + 2 * m.yz * a.z) / 3;
  t.xyz += factor * (m.xy * a.z + m.xz * a.y + m.yz * a.x) / 3;
}

/// Moments of a cluster of triangles about its centre. s is the vector from the centre.
struct Cluster {
  Vec3d center;
  double area = 0;
  Vec3d dipole;
  Symmetric2 quadrupole;
  Symmetric3 octupole;
  double cubed = 0;   ///< bound on the integral of |s|^3
  double radius = 0;  ///< bound on |s|
  Box3 box;
};

/// Returns the distance from a point inside a box to the box's furthest corner.
double furthest_in(const Box3& box, const Vec3d& p) {
  return length(max(box.upper - p, p - box.lower));
}

Cluster cluster_of(const std::array<std::array<Vec3d, 3>, lanes>& triangles, std::size_t count) {
  Cluster out;
  std::array<Vec3d, lanes> area_vectors;
  Vec3d weighted;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [a, b, c] = triangles[i];
    area_vectors[i] = cross(b - a, c - a) * 0.5;
    const double area = length(area_vectors[i]);
    out.area += area;
    weighted += (a + b + c - out.center * 3) * (area / 3);
    for (const Vec3d& p : triangles[i]) out.box.extend(p);
  }
  out.center = out.area > 0 ? min(max(weighted / out.area, out.box.lower), out.box.upper) : out.box.center();
  out.radius = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d& normal = area_vectors[i];
    const double area = length(normal);
    Vec3d sum;
    // The mean of s s^T is (sum over corners of s s^T + 9 c c^T) / 12, with c the mean of the corners.
    Symmetric2 second;
    for (const Vec3d& p : triangles[i]) {
      const Vec3d s = p - out.center;
      const double r = length(s);
      out.radius = std::max(out.radius, r);
      out.cubed += area / 3 * r * r * r;  // |s|^3 is convex, so its mean is at most the mean over the corners
      sum += s;
      add_product(second, s, s, 1.0 / 12);
    }
    const Vec3d mean = sum / 3;
    add_product(second, mean, mean, 9.0 / 12);
    out.dipole += normal;
    add_product(out.quadrupole, normal, mean, 1);
    add_product(out.octupole, second, normal, 1);
  }
  return out;
}

Cluster merge(const Cluster* children, std::size_t count) {
  Cluster out;
  Vec3d weighted;
  for (std::size_t i = 0; i < count; ++i) {
    out.area += children[i].area;
    weighted += children[i].center * children[i].area;
    out.box.extend(children[i].box);
  }
  out.center = out.area > 0 ? min(max(weighted / out.area, out.box.lower), out.box.upper) : out.box.center();
  out.radius = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Cluster& child = children[i];
    const Vec3d shift = child.center - out.center;
    const double distance = length(shift);
    out.radius = std::max(out.radius, distance + child.radius);
    // Bound by Minkowski's inequality in L3.
    const double bound = std::cbrt(child.cubed) + distance * std::cbrt(child.area);
    out.cubed += bound * bound * bound;
    out.dipole += child.dipole;
    Symmetric2& m = out.quadrupole;
    const Symmetric2& n = child.quadrupole;
    m = {m.xx + n.xx, m.yy + n.yy, m.zz + n.zz, m.xy + n.xy, m.xz + n.xz, m.yz + n.yz};
    add_product(m, child.dipole, shift, 1);
    Symmetric3& t = out.octupole;
    const Symmetric3& u = child.octupole;
    t = {t.xxx + u.xxx, t.yyy + u.yyy, t.zzz + u.zzz, t.xxy + u.xxy, t.xxz + u.xxz,
         t.xyy + u.xyy, t.yyz + u.yyz, t.xzz + u.xzz, t.yzz + u.yzz, t.xyz + u.xyz};
    add_product(t, n, shift, 2);
    Symmetric2 squared;
    add_product(squared, shift, shift, 1);
    add_product(t, squared, child.dipole, 1);
  }
  out.radius = std::min(out.radius, furthest_in(out.box, out.center)) * (1 + 1e-14);
  return out;
}

/// Stores a cluster in the form that series() in lane_kernels.cpp requires, with constant factors included. Traces of
/// the tensors are removed: the kernel is harmonic, so they contribute nothing.
void store(const Cluster& cluster, MultipoleBlock& block, std::size_t lane) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    block.center[axis][lane] = cluster.center[axis];
    block.dipole[axis][lane] = cluster.dipole[axis];
  }
  const Symmetric2& m = cluster.quadrupole;
  const double third = (m.xx + m.yy + m.zz) / 3;
  const double quadrupole[5] = {m.xx - third, m.yy - third, 2 * m.xy, 2 * m.xz, 2 * m.yz};
  for (std::size_t k = 0; k < 5; ++k) block.quadrupole[k][lane] = -3 * quadrupole[k];
  const Symmetric3& t = cluster.octupole;
  const double x = (t.xxx + t.xyy + t.xzz) / 5;
  const double y = (t.xxy + t.yyy + t.yzz) / 5;
  const double z = (t.xxz + t.yyz + t.zzz) / 5;
  const double octupole[7] = {t.xxx - 3 * x, t.yyy - 3 * y, 3 * (t.xyy - x), 3 * (t.xxy - y),
                              t.xxz - z,     t.yyz - z,     6 * t.xyz};
  for (std::size_t k = 0; k < 7; ++k) block.octupole[k][lane] = 7.5 * octupole[k];
  block.cubed[lane] = cluster.cubed;
  block.radius[lane] = cluster.radius;
}

/// Fills the leaves and returns their clusters.
std::vector<Cluster> make_leaves(const MeshView& mesh, const std::vector<std::uint32_t>& order, WindingTree& tree,
                                 const Context& context) {
  const std::size_t count = order.size();
  tree.leaves.resize((count + lanes - 1) / lanes);
  std::vector<Cluster> clusters(tree.leaves.size());
  parallel_for(context, tree.leaves.size(), grain, "", [&](const WorkRange& range) {
    for (std::size_t leaf = range.begin; leaf < range.end; ++leaf) {
      std::array<std::array<Vec3d, 3>, lanes> triangles;
      const std::size_t used = std::min(lanes, count - leaf * lanes);
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const Triangle& triangle = mesh.triangles[order[leaf * lanes + std::min(lane, used - 1)]];
        for (std::size_t k = 0; k < 3; ++k) {
          triangles[lane][k] = mesh.vertices[triangle[lane < used ? k : 0]] * tree.scale;
          for (std::size_t axis = 0; axis < 3; ++axis)
            tree.leaves[leaf].corner[k][axis][lane] = triangles[lane][k][axis];
        }
      }
      clusters[leaf] = cluster_of(triangles, used);
    }
  });
  return clusters;
}

}  // namespace

WindingTree make_winding_tree(const MeshView& mesh, const Context& context) {
  WindingTree tree;
  Box3 box;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) box.extend(mesh.vertices[v]);
  }
  if (mesh.triangles.empty()) return tree;
  tree.scale = unit_scale(box);
  const std::vector<std::uint32_t> order = space_order(
      mesh.triangles.size(),
      [&](std::size_t i) {
        const Triangle& t = mesh.triangles[i];
        return (mesh.vertices[t[0]] * tree.scale + mesh.vertices[t[1]] * tree.scale +
                mesh.vertices[t[2]] * tree.scale) /
               3.0;
      },
      context);
  std::vector<Cluster> clusters = make_leaves(mesh, order, tree, context);
  std::vector<Box3> boxes(clusters.size());
  std::transform(clusters.begin(), clusters.end(), boxes.begin(), [](const Cluster& c) { return c.box; });
  tree.boxes = make_box_tree(boxes, context);
  Cluster nothing;
  nothing.center = {1e35, 1e35, 1e35};
  while (true) {
    const std::size_t count = (clusters.size() + lanes - 1) / lanes;
    std::vector<MultipoleBlock>& blocks = tree.levels.emplace_back(count);
    std::vector<Cluster> parents(count);
    parallel_for(context, count, grain, "", [&](const WorkRange& range) {
      for (std::size_t i = range.begin; i < range.end; ++i) {
        const std::size_t used = std::min(lanes, clusters.size() - i * lanes);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          store(lane < used ? clusters[i * lanes + lane] : nothing, blocks[i], lane);
        }
        parents[i] = merge(&clusters[i * lanes], used);
      }
    });
    if (count == 1) break;
    clusters = std::move(parents);
  }
  return tree;
}

SolidAngleSum::SolidAngleSum() {
  std::fill(re, re + lanes, 1.0);
  std::fill(im, im + lanes, 0.0);
  std::fill(turns, turns + lanes, 0.0);
}

double SolidAngleSum::winding_number() const {
  double x = re[0], y = im[0], sum = turns[0];
  for (std::size_t i = 1; i < lanes; ++i) {
    const double px = x * re[i] - y * im[i];
    const double py = x * im[i] + y * re[i];
    if (y >= 0 && im[i] >= 0 && py < 0) sum += 1;
    if (y < 0 && im[i] < 0 && py >= 0) sum -= 1;
    sum += turns[i];
    x = px;
    y = py;
  }
  return sum + std::atan2(y, x) / (2 * std::numbers::pi);
}

}  // namespace blum
