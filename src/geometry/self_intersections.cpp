#include "blum/geometry/self_intersections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/geometry/weld.hpp"
#include "geometry/box_tree.hpp"
#include "geometry/space_order.hpp"
#include "geometry/triangle_contact.hpp"

namespace blum {
namespace {

/// Leaves between two looks at the number of pairs: few enough that a search without end in sight stops soon.
constexpr std::size_t batch = 512;
constexpr std::size_t grain = 8;

/// A power of two that brings the largest coordinate to about 1, so that products neither overflow nor underflow.
double scale_of(const MeshView& mesh) {
  const Box3 box = bounds(mesh);
  double largest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    largest = std::max({largest, std::abs(box.lower[axis]), std::abs(box.upper[axis])});
  }
  return largest > 0 ? std::ldexp(1.0, std::clamp(-std::ilogb(largest), -1000, 1000)) : 1.0;
}

std::vector<TriangleId> triangles_with_area(const MeshView& mesh) {
  std::vector<TriangleId> out;
  out.reserve(mesh.triangles.size());
  const double scale = scale_of(mesh);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const std::array<Vec3d, 3> points{mesh.vertices[a] * scale, mesh.vertices[b] * scale, mesh.vertices[c] * scale};
    if (!detail::has_no_area(points)) out.emplace_back(t);
  }
  return out;
}

/// Triangles in leaves of eight, and a tree of boxes over them.
class Search {
 public:
  Search(const MeshView& mesh, const Context& context)
      : ids_(triangles_with_area(mesh)), leaves_((ids_.size() + lanes - 1) / lanes) {
    const double scale = scale_of(mesh);
    const std::vector<std::uint32_t> corners = weld_clusters(mesh.vertices);
    const std::vector<std::uint32_t> order = space_order(
        ids_.size(), [&](std::size_t i) { return box_of(triangle(mesh, corners, scale, ids_[i])).center(); }, context);
    std::vector<TriangleId> sorted(ids_.size());
    for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = ids_[order[i]];
    ids_ = std::move(sorted);
    triangles_.resize(ids_.size());
    boxes_.resize(ids_.size());
    std::vector<Box3> leaf_boxes(leaves_.size());
    parallel_for(context, leaves_.size(), 512, "", [&](const WorkRange& range) {
      for (std::size_t leaf = range.begin; leaf < range.end; ++leaf) {
        leaf_boxes[leaf] = fill(leaf, [&](TriangleId id) { return triangle(mesh, corners, scale, id); });
      }
    });
    tree_ = make_box_tree(leaf_boxes, context);
  }

  [[nodiscard]] std::size_t leaf_count() const { return leaves_.size(); }

  /// Adds the pairs of a leaf's triangles with each other and with those of later leaves; at most about `limit`.
  void find(std::size_t leaf, std::size_t limit, std::vector<TrianglePair>& out) const {
    const std::size_t end = std::min((leaf + 1) * lanes, ids_.size());
    for (std::size_t i = leaf * lanes; i < end && out.size() <= limit; ++i) {
      for_each_near(boxes_[i], leaf, [&](std::size_t other) {
        test(i, other, out);
        return out.size() <= limit;
      });
    }
  }

 private:
  static detail::ContactTriangle triangle(const MeshView& mesh, const std::vector<std::uint32_t>& corners, double scale,
                                          TriangleId id) {
    detail::ContactTriangle out;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[id.value][k];
      out.points[k] = mesh.vertices[v] * scale;
      out.corners[k] = corners[v];
    }
    return out;
  }

  static Box3 box_of(const detail::ContactTriangle& triangle) {
    Box3 box;
    for (const Vec3d& p : triangle.points) box.extend(p);
    return box;
  }

  template <class Read>
  Box3 fill(std::size_t leaf, const Read& read) {
    Box3 whole;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t i = leaf * lanes + lane;
      Box3 box;
      if (i < ids_.size()) {
        triangles_[i] = read(ids_[i]);
        box = boxes_[i] = box_of(triangles_[i]);
      }
      whole.extend(box);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        leaves_[leaf].lower[axis][lane] = box.lower[axis];
        leaves_[leaf].upper[axis][lane] = box.upper[axis];
      }
    }
    return whole;
  }

  /// Calls visit(i) for the triangles from a leaf on whose boxes touch this one, until it returns false.
  template <class Visit>
  void for_each_near(const Box3& box, std::size_t first_leaf, const Visit& visit) const {
    for_each_touching(tree_, box, first_leaf, [&](std::size_t leaf) {
      const unsigned bits = touching(leaves_[leaf], box);
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        if ((bits >> lane & 1U) != 0 && !visit(leaf * lanes + lane)) return false;
      }
      return true;
    });
  }

  void test(std::size_t i, std::size_t other, std::vector<TrianglePair>& out) const {
    if (other <= i) return;
    const detail::Contact found = detail::contact(triangles_[i], triangles_[other]);
    if (found == detail::Contact::none) return;
    out.push_back({std::min(ids_[i], ids_[other]), std::max(ids_[i], ids_[other]), found == detail::Contact::crossing});
  }

  std::vector<TriangleId> ids_;  ///< in the order of the leaves
  std::vector<detail::ContactTriangle> triangles_;
  std::vector<Box3> boxes_;
  std::vector<BoxBlock> leaves_;
  BoxTree tree_;
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
