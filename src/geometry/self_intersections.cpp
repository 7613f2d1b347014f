#include "blum/geometry/self_intersections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/geometry/box_bvh.hpp"
#include "blum/geometry/orient3d.hpp"
#include "blum/geometry/triangle_contact.hpp"
#include "blum/geometry/weld.hpp"
#include "geometry/box_scale.hpp"

namespace blum {
namespace {

/// Leaves between two looks at the number of pairs: few enough that a search without end in sight stops soon.
constexpr std::size_t batch = 512;
constexpr std::size_t grain = 8;

std::vector<TriangleId> triangles_with_area(const MeshView& mesh) {
  std::vector<TriangleId> out;
  out.reserve(mesh.triangles.size());
  const double scale = coordinate_scale(bounds(mesh));
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const std::array<Vec3d, 3> points{mesh.vertices[a] * scale, mesh.vertices[b] * scale, mesh.vertices[c] * scale};
    if (!detail::has_no_area(points)) out.emplace_back(t);
  }
  return out;
}

/// The plane of a triangle a, b, c, to reject in a few operations most of what does not touch it.
struct Plane {
  Vec3d point;      ///< a
  Vec3d normal;     ///< (b - a) x (c - a)
  Vec3d magnitude;  ///< of the products that are summed up to the normal

  explicit Plane(const std::array<Vec3d, 3>& p) : point(p[0]) {
    const Vec3d v = p[1] - p[0];
    const Vec3d w = p[2] - p[0];
    for (std::size_t x = 0; x < 3; ++x) {
      const double left = v[(x + 1) % 3] * w[(x + 2) % 3];
      const double right = v[(x + 2) % 3] * w[(x + 1) % 3];
      normal[x] = left - right;
      magnitude[x] = std::abs(left) + std::abs(right);
    }
  }

  /// 1 or -1 where a point lies on that side for certain, by the filter of orient3d; else 0.
  [[nodiscard]] int side(const Vec3d& p) const {
    const Vec3d offset = p - point;
    const double height = dot(normal, offset);
    const double bound =
        std::abs(offset.x) * magnitude.x + std::abs(offset.y) * magnitude.y + std::abs(offset.z) * magnitude.z;
    return std::abs(height) > detail::orient3d_rounding * bound ? (height > 0 ? 1 : -1) : 0;
  }
};

/// Whether all corners of a triangle that another one does not have are on one side of the other's plane: then the two
/// have nothing in common but common corners.
bool is_beside(const Plane& plane, const detail::ContactTriangle& of, const detail::ContactTriangle& triangle) {
  int common = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t corner = triangle.corners[k];
    if (corner == of.corners[0] || corner == of.corners[1] || corner == of.corners[2]) continue;
    const int side = plane.side(triangle.points[k]);
    if (side == 0 || side == -common) return false;
    common = side;
  }
  return common != 0;
}

/// Triangles with an area, and a hierarchy of boxes over them. "Leaves" are eight triangles of neighbouring ranks.
class Search {
 public:
  Search(const MeshView& mesh, const Context& context)
      : ids_(triangles_with_area(mesh)), triangles_(read(mesh, ids_)), bvh_(boxes(triangles_), context) {
    planes_.reserve(triangles_.size());
    for (const detail::ContactTriangle& triangle : triangles_) planes_.emplace_back(triangle.points);
  }

  [[nodiscard]] std::size_t leaf_count() const { return (ids_.size() + leaf_size - 1) / leaf_size; }

  /// Adds the pairs of a leaf's triangles with each other and with those of later ranks; at most about `limit`.
  void find(std::size_t leaf, std::size_t limit, std::vector<TrianglePair>& out) const {
    const std::size_t end = std::min((leaf + 1) * leaf_size, ids_.size());
    for (std::size_t rank = leaf * leaf_size; rank < end && out.size() <= limit; ++rank) {
      bvh_.for_each_later(rank, 0, [&](std::size_t later) {
        test(bvh_.at_rank(rank), bvh_.at_rank(later), out);
        return out.size() <= limit;
      });
    }
  }

 private:
  static constexpr std::size_t leaf_size = 8;

  static std::vector<detail::ContactTriangle> read(const MeshView& mesh, const std::vector<TriangleId>& ids) {
    const double scale = coordinate_scale(bounds(mesh));
    const std::vector<std::uint32_t> corners = weld_clusters(mesh.vertices);
    std::vector<detail::ContactTriangle> out(ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh.triangles[ids[i].value][k];
        out[i].points[k] = mesh.vertices[v] * scale;
        out[i].corners[k] = corners[v];
      }
    }
    return out;
  }

  static std::vector<Box3> boxes(const std::vector<detail::ContactTriangle>& triangles) {
    std::vector<Box3> out(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (const Vec3d& p : triangles[i].points) out[i].extend(p);
    }
    return out;
  }

  void test(std::uint32_t i, std::uint32_t other, std::vector<TrianglePair>& out) const {
    const detail::ContactTriangle& a = triangles_[i];
    const detail::ContactTriangle& b = triangles_[other];
    if (is_beside(planes_[i], a, b) || is_beside(planes_[other], b, a)) return;
    const detail::Contact found = detail::contact(a, b);
    if (found == detail::Contact::none) return;
    out.push_back({std::min(ids_[i], ids_[other]), std::max(ids_[i], ids_[other]), found == detail::Contact::crossing});
  }

  std::vector<TriangleId> ids_;
  std::vector<detail::ContactTriangle> triangles_;  ///< of these ids
  std::vector<Plane> planes_;                       ///< of the triangles
  BoxBvh bvh_;
};

/// The pairs of some leaves, in the order of the leaves.
std::vector<TrianglePair> find_in(const Search& search, std::size_t begin, std::size_t end, std::size_t limit,
                                  const Context& context) {
  std::vector<std::vector<TrianglePair>> found((end - begin + grain - 1) / grain);
  parallel_for(context, end - begin, grain, "", [&](const WorkRange& range) {
    std::vector<TrianglePair>& out = found[range.begin / grain];
    for (std::size_t leaf = range.begin; leaf < range.end; ++leaf) search.find(begin + leaf, limit, out);
  });
  std::vector<TrianglePair> all;
  for (const std::vector<TrianglePair>& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

SelfIntersections find_self_intersections(const MeshView& mesh, std::size_t limit, const Context& context) {
  validate(mesh);
  throw_if_cancelled(context);
  SelfIntersections result;
  const Search search(mesh, context);
  for (std::size_t begin = 0; begin < search.leaf_count() && result.pairs.size() <= limit; begin += batch) {
    const std::size_t end = std::min(begin + batch, search.leaf_count());
    const std::vector<TrianglePair> found = find_in(search, begin, end, limit, context);
    result.pairs.insert(result.pairs.end(), found.begin(), found.end());
    if (context.progress) {
      context.progress(static_cast<double>(end) / static_cast<double>(search.leaf_count()), "self-intersections");
    }
  }
  std::sort(result.pairs.begin(), result.pairs.end(), [](const TrianglePair& a, const TrianglePair& b) {
    return std::tie(a.first, a.second) < std::tie(b.first, b.second);
  });
  result.complete = result.pairs.size() <= limit;
  if (!result.complete) result.pairs.resize(limit);
  for (const TrianglePair& pair : result.pairs) ++(pair.crosses ? result.crossing : result.touching);
  return result;
}

}  // namespace blum
