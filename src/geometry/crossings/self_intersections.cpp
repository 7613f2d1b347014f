#include "blum/geometry/self_intersections.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/geometry/space_order.hpp"
#include "blum/geometry/triangle_contact.hpp"
#include "blum/geometry/weld.hpp"
#include "geometry/box_scale.hpp"
#include "geometry/bvh/box_tree.hpp"
#include "geometry/bvh/triangle_group.hpp"

namespace blum {
namespace {

/// Smallest number of groups processed between two checks of the number of pairs found. The number is small, so that a
/// search with very many pairs stops soon.
constexpr std::size_t smallest_batch = 512;
/// Largest number of groups between two checks. Such large batches are used if few pairs are found, so that threads
/// rarely wait for each other.
constexpr std::size_t largest_batch = 4096;
constexpr std::size_t grain = 8;
constexpr std::size_t build_grain = 64;

/// Groups are rebuilt when their looseness exceeds their original looseness by this factor.
constexpr double most_loosening = 1.25;

double extent(const Box3& box) {
  const Vec3d size = box.is_empty() ? Vec3d{} : box.size();
  return size.x + size.y + size.z;
}

/// Returns the triangles in spatial order of their middles.
std::vector<std::uint32_t> order_in_space(const MeshView& mesh, double scale, const Context& context) {
  const auto middle = [&](std::size_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3d& p = mesh.vertices[a];
    const Vec3d& q = mesh.vertices[b];
    const Vec3d& r = mesh.vertices[c];
    return (min(min(p, q), r) * scale + max(max(p, q), r) * scale) * 0.5;
  };
  return space_order(mesh.triangles.size(), middle, context);
}

/// Array of groups of triangles. The thread that fills a group constructs it, because groups need 200 bytes per
/// triangle.
class GroupArray {
 public:
  explicit GroupArray(std::size_t count) : count_(count), groups_(std::allocator<TriangleGroup>().allocate(count)) {}
  ~GroupArray() { std::allocator<TriangleGroup>().deallocate(groups_, count_); }
  GroupArray(const GroupArray&) = delete;
  GroupArray& operator=(const GroupArray&) = delete;

  [[nodiscard]] std::size_t size() const { return count_; }
  TriangleGroup& make(std::size_t k) { return *std::construct_at(groups_ + k); }
  [[nodiscard]] const TriangleGroup& operator[](std::size_t k) const { return groups_[k]; }

 private:
  static_assert(std::is_trivially_destructible_v<TriangleGroup>);  // the array does not destroy its groups
  std::size_t count_;
  TriangleGroup* groups_;
};

/// Triangles in groups of eight, and a tree of the groups' bounding boxes.
class Search {
 public:
  /// @param corners  a number for each vertex; vertices with equal numbers count as the same corner. If empty, vertex
  /// indices are used.
  Search(const MeshView& mesh, double scale, std::span<const std::uint32_t> order,
         std::span<const std::uint32_t> corners, const Context& context)
      : order_(order), groups_((order.size() + lanes - 1) / lanes), boxes_(groups_.size()) {
    std::vector<double> sums(groups_.size());
    parallel_for(context, groups_.size(), build_grain, "", [&](const WorkRange& range) {
      for (std::size_t g = range.begin; g < range.end; ++g) sums[g] = make(mesh, scale, corners, g);
    });
    tree_ = make_box_tree(boxes_, context);
    double own = 0;
    double common = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      own += sums[g];
      common += extent(boxes_[g]);
    }
    looseness_ = own > 0 ? common / own : 1;
  }

  [[nodiscard]] std::size_t group_count() const { return groups_.size(); }

  /// Returns the sum of the extents of the groups' boxes, divided by that of the triangles' boxes.
  [[nodiscard]] double looseness() const { return looseness_; }

  /// Adds the pairs of triangles within a group, and the pairs with triangles of later groups. Stops when there are
  /// about `limit` pairs.
  void find(std::size_t group, std::size_t limit, std::vector<TrianglePair>& out) const {
    for_each_touching(tree_, boxes_[group], group, [&](std::size_t other) {
      if (other >= group) find_between(group, other, limit, out);
      return out.size() <= limit;
    });
  }

 private:
  /// @returns the sum of the extents of the boxes of its triangles.
  double make(const MeshView& mesh, double scale, std::span<const std::uint32_t> corners, std::size_t g) {
    double sum = 0;
    TriangleGroup& group = groups_.make(g);
    for (std::size_t rank = g * lanes; rank < std::min((g + 1) * lanes, order_.size()); ++rank) {
      detail::ContactTriangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh.triangles[order_[rank]][k];
        triangle.points[k] = mesh.vertices[v] * scale;
        triangle.corners[k] = corners.empty() ? v : corners[v];
      }
      group.set(rank % lanes, triangle);
      const Box3 box = box_at(group.box, rank % lanes);
      boxes_[g].extend(box);
      sum += extent(box);
    }
    return sum;
  }

  void find_between(std::size_t group, std::size_t other, std::size_t limit, std::vector<TrianglePair>& out) const {
    unsigned rows = touching(groups_[group].box, boxes_[other]);
    for (; rows != 0 && out.size() <= limit; rows &= rows - 1) {
      const auto row = static_cast<std::size_t>(std::countr_zero(rows));
      const GroupTriangle triangle(groups_[group], row);
      unsigned columns = may_meet(groups_[other], triangle);
      if (group == other) columns &= ~0U << (row + 1);  // each pair only once
      for (; columns != 0; columns &= columns - 1) {
        const auto column = static_cast<std::size_t>(std::countr_zero(columns));
        test(triangle, order_[group * lanes + row], other, column, out);
      }
    }
  }

  void test(const GroupTriangle& a, std::uint32_t first, std::size_t group, std::size_t lane,
            std::vector<TrianglePair>& out) const {
    const GroupTriangle b(groups_[group], lane);
    if (is_beside(a, b) || is_beyond_an_edge(a, b) || is_beyond_an_edge(b, a)) return;
    const detail::Contact found = detail::contact(a.for_contact(), b.for_contact());
    if (found == detail::Contact::none) return;
    const std::uint32_t second = order_[group * lanes + lane];
    out.push_back(
        {TriangleId(std::min(first, second)), TriangleId(std::max(first, second)), found == detail::Contact::crossing});
  }

  std::span<const std::uint32_t> order_;
  GroupArray groups_;
  std::vector<Box3> boxes_;  ///< box of each group
  BoxTree tree_;
  double looseness_ = 1;
};

/// Returns the pairs found for the groups in [begin, end), in the order of the groups.
std::vector<TrianglePair> find_in(const Search& search, std::size_t begin, std::size_t end, std::size_t limit,
                                  const Context& context) {
  std::vector<std::vector<TrianglePair>> found((end - begin + grain - 1) / grain);
  parallel_for(context, end - begin, grain, "", [&](const WorkRange& range) {
    std::vector<TrianglePair>& out = found[range.begin / grain];
    for (std::size_t group = range.begin; group < range.end; ++group) search.find(begin + group, limit, out);
  });
  std::vector<TrianglePair> all;
  for (const std::vector<TrianglePair>& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

std::vector<TrianglePair> find_all(const Search& search, std::size_t limit, const Context& context) {
  std::vector<TrianglePair> pairs;
  std::size_t batch = smallest_batch;
  for (std::size_t begin = 0; begin < search.group_count() && pairs.size() <= limit;) {
    const std::size_t end = std::min(begin + batch, search.group_count());
    const std::vector<TrianglePair> found = find_in(search, begin, end, limit, context);
    pairs.insert(pairs.end(), found.begin(), found.end());
    if (context.progress) {
      context.progress(static_cast<double>(end) / static_cast<double>(search.group_count()), "self-intersections");
    }
    batch = found.size() < batch ? std::min(2 * batch, largest_batch) : smallest_batch;
    begin = end;
  }
  return pairs;
}

}  // namespace

SelfIntersections find_self_intersections(const MeshView& mesh, std::size_t limit, const Context& context) {
  validate(mesh);
  throw_if_cancelled(context);
  return find_self_intersections(mesh, order_in_space(mesh, coordinate_scale(bounds(mesh)), context), limit, context);
}

SelfIntersections find_self_intersections(const MeshView& mesh, std::span<const std::uint32_t> order, std::size_t limit,
                                          const Context& context) {
  validate(mesh);
  return find_self_intersections(mesh, order, weld_clusters(mesh.vertices), limit, context);
}

SelfIntersections find_self_intersections(const MeshView& mesh, std::span<const std::uint32_t> order,
                                          std::span<const std::uint32_t> corners, std::size_t limit,
                                          const Context& context) {
  throw_if_cancelled(context);
  if (order.size() != mesh.triangles.size()) {
    throw InvalidOption("an order of " + std::to_string(order.size()) + " triangles is given for a mesh with " +
                        std::to_string(mesh.triangles.size()) + " triangles");
  }
  if (corners.size() != mesh.vertices.size()) {
    throw InvalidOption("the corners of " + std::to_string(corners.size()) + " vertices are given for a mesh with " +
                        std::to_string(mesh.vertices.size()) + " vertices");
  }
  const double scale = coordinate_scale(bounds(mesh));
  SelfIntersections result;
  result.pairs = find_all(Search(mesh, scale, order, corners, context), limit, context);
  std::sort(result.pairs.begin(), result.pairs.end(), [](const TrianglePair& a, const TrianglePair& b) {
    return std::tie(a.first, a.second) < std::tie(b.first, b.second);
  });
  result.complete = result.pairs.size() <= limit;
  if (!result.complete) result.pairs.resize(limit);
  for (const TrianglePair& pair : result.pairs) ++(pair.crosses ? result.crossing : result.touching);
  return result;
}

bool SelfIntersectionSearch::finds_any(const MeshView& mesh, const Context& context) {
  validate(mesh);
  throw_if_cancelled(context);
  const double scale = coordinate_scale(bounds(mesh));
  if (order_.size() != mesh.triangles.size()) {
    order_ = order_in_space(mesh, scale, context);
    looseness_ = -1;
  }
  // If several vertices are at the same position, this search may find pairs that share only such corners. So if any
  // pair is found, the search is repeated with numbers of welded vertices.
  const Search search(mesh, scale, order_, {}, context);
  if (looseness_ < 0) looseness_ = search.looseness();
  bool found = !find_all(search, 0, context).empty();
  if (found) {
    const std::vector<std::uint32_t> corners = weld_clusters(mesh.vertices);
    found = !find_all(Search(mesh, scale, order_, corners, context), 0, context).empty();
  }
  if (search.looseness() > most_loosening * looseness_) order_.clear();
  return found;
}

}  // namespace blum
