#include "blum/geometry/oriented_bvh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/inline_list.hpp"
#include "blum/core/parallel.hpp"
#include "blum/geometry/primitives.hpp"
#include "blum/geometry/space_order.hpp"
#include "geometry/bvh/box_tree.hpp"
#include "geometry/bvh/oriented_block.hpp"

namespace blum {
namespace {

/// Returns a box around boxes. The last axis of each box is orthogonal to the surface inside it.
/// @param bounds  axis-aligned box around the contents of all boxes.
[[nodiscard]] OrientedBox box_around(std::span<const OrientedBox> boxes, const Box3& bounds);

using Axes = std::array<Vec3d, 3>;

/// Intervals along three given axes that contain all boxes and triangles added.
class Extent {
 public:
  explicit Extent(const Axes& axes) : axes_(axes) {}

  void add(const OrientedBox& box) {
    for (std::size_t k = 0; k < 3; ++k) {
      double reach = 0;
      for (std::size_t j = 0; j < 3; ++j) reach += std::abs(dot(axes_[k], box.axes[j])) * box.half[j];
      const double at = dot(axes_[k], box.center);
      low_[k] = std::min(low_[k], at - reach);
      high_[k] = std::max(high_[k], at + reach);
    }
  }
  void add(const FlatTriangleBlock& block) {
    for (std::size_t k = 0; k < 3; ++k) extent_along(block, axes_[k], low_[k], high_[k]);
  }
  [[nodiscard]] OrientedBox box() const {
    OrientedBox out;
    out.axes = axes_;
    for (std::size_t k = 0; k < 3; ++k) {
      out.half[k] = (high_[k] - low_[k]) * 0.5;
      out.center += axes_[k] * ((low_[k] + high_[k]) * 0.5);
    }
    return out;
  }

 private:
  Axes axes_;
  std::array<double, 3> low_{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  std::array<double, 3> high_{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
};

/// Smallest length of a sum of normals. Shorter sums have lost digits, because their squares underflow.
constexpr double least_normal = 1e-140;

/// Returns two directions orthogonal to `normal` and to each other. The first one is as close to `along` as possible.
std::array<Vec3d, 2> plane_axes(const Vec3d& normal, const Vec3d& along) {
  const Vec3d flat = along - normal * dot(normal, along);
  const double size = squared_length(flat);
  if (size > 1e-12 * squared_length(along)) {
    Vec3d u = flat / std::sqrt(size);
    // Repeated, because after cancellation the first result contains rounding errors along the normal.
    u -= normal * dot(normal, u);
    u = u / length(u);
    return {u, cross(normal, u)};
  }
  const Vec3d magnitude{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
  const Vec3d other = magnitude.x <= magnitude.y && magnitude.x <= magnitude.z ? Vec3d{1, 0, 0}
                      : magnitude.y <= magnitude.z                             ? Vec3d{0, 1, 0}
                                                                               : Vec3d{0, 0, 1};
  const Vec3d u = cross(normal, other);
  const Vec3d unit = u / length(u);
  return {unit, cross(normal, unit)};
}

/// Returns the smaller of two boxes: an axis-aligned box, and a box whose last axis is orthogonal to a plane.
/// @param normal  normal of the plane, of any length.
/// @param along   direction in which the contents are longest.
/// @param add_to  callable: add_to(extent) adds the contents to an Extent.
template <class AddTo>
OrientedBox smaller_box(const Box3& bounds, const Vec3d& normal, const Vec3d& along, const AddTo& add_to) {
  OrientedBox plain;
  plain.center = bounds.center();
  for (std::size_t k = 0; k < 3; ++k) plain.half[k] = (bounds.upper[k] - bounds.lower[k]) * 0.5;
  const double size = length(normal);
  if (!(size > least_normal)) return plain;
  const Vec3d unit = normal / size;
  const auto [u, v] = plane_axes(unit, along);
  Extent turned({u, v, unit});
  add_to(turned);
  const OrientedBox box = turned.box();
  return box.half_sum() <= plain.half_sum() ? box : plain;
}

/// Returns a box around eight triangles. The last axis of the box is orthogonal to the common plane of the triangles,
/// or to the plane that fits them best. If the axis-aligned box is smaller, it is returned instead.
/// @param block   receives its triangles' normals.
/// @param bounds  receives the axis-aligned box.
OrientedBox box_around(FlatTriangleBlock& block, Box3& bounds) {
  BlockShape shape;
  set_normals(block, shape);
  extent_along_axes(block, bounds);
  // `along` is the direction of the longest extent, because the spatial order first halves a block across its longest
  // side.
  return smaller_box(bounds, shape.normal, shape.along, [&](Extent& extent) { extent.add(block); });
}

OrientedBox box_around(std::span<const OrientedBox> boxes, const Box3& bounds) {
  Vec3d normal;
  Vec3d along;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const OrientedBox& box = boxes[k];
    const Vec3d own = box.axes[2] * (box.half[0] * box.half[1]);
    normal += dot(normal, own) < 0 ? -own : own;
    along += 2 * k < boxes.size() ? -box.center : box.center;
  }
  if (boxes.size() % 2 != 0) along += boxes.front().center;  // so that both halves have equally many boxes
  return smaller_box(bounds, normal, along, [&](Extent& extent) {
    for (const OrientedBox& box : boxes) extent.add(box);
  });
}

/// Threads fill separate parts of a tree: one part below each block of this level.
constexpr std::size_t level_of_parts = 2;
constexpr std::size_t leaves_per_part = lanes * lanes * lanes;
/// Because of rounding, the distance of a pair may be this much smaller than the distance of their boxes. The value is
/// relative to the largest coordinate.
constexpr double rounding = 1e-13;

using NodeRef = OrientedBvh::Node;
/// Pair of nodes, one from each tree, that must still be compared.
using NodePair = OrientedBvh::NodePair;

struct IndexRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The list contains at most seven siblings from each of at most eleven levels of both trees.
using PendingPairs = InlineList<NodePair, 256>;

/// Returns true if `b` must be taken before `a`. The pair with the smaller gap comes first. If gaps are equal (for
/// example 0, for overlapping boxes), the pair at the lower level comes first.
bool comes_later(const NodePair& a, const NodePair& b) {
  const double of_a = std::max(a.squared_gap, 0.0);
  const double of_b = std::max(b.squared_gap, 0.0);
  if (of_a != of_b) return of_a > of_b;
  return a.here.level + a.there.level > b.here.level + b.there.level;
}

/// Returns the limit for squared gaps, widened for rounding.
double squared_limit(double limit, double slack) {
  if (!(limit >= 0)) return -1;
  const double wide = limit + slack;
  return std::min(wide * wide * (1 + 1e-14), std::numeric_limits<double>::max());
}

/// Inserts a pair into the pairs pushed since `bottom`, which are sorted so that the smallest gap is on top.
void push_sorted(PendingPairs& pending, std::size_t bottom, const NodePair& pair) {
  std::size_t place = pending.size();
  pending.push_back(pair);
  for (; place > bottom && pending[place - 1].squared_gap < pair.squared_gap; --place) {
    pending[place] = pending[place - 1];
  }
  pending[place] = pair;
}

/// Oriented and axis-aligned boxes of nodes.
struct NodeBoxes {
  std::vector<OrientedBox> boxes;
  std::vector<Box3> around;

  void resize(std::size_t count) {
    boxes.resize(count);
    around.resize(count);
  }
  [[nodiscard]] std::size_t size() const { return boxes.size(); }
};

/// Fills the blocks of a level with the boxes below them, and computes the boxes around these blocks.
void fill_level(std::vector<OrientedBlock>& level, const NodeBoxes& below, const IndexRange& range, NodeBoxes& above) {
  for (std::size_t k = range.begin; k < range.end; ++k) {
    const std::size_t first = k * lanes;
    const std::size_t children = std::min(lanes, below.size() - first);
    const auto boxes = std::span<const OrientedBox>(below.boxes).subspan(first, children);
    for (std::size_t lane = 0; lane < lanes; ++lane) level[k].set(lane, boxes[std::min(lane, children - 1)]);
    Box3 around;
    for (std::size_t i = first; i < first + children; ++i) around.extend(below.around[i]);
    above.boxes[k] = box_around(boxes, around);
    above.around[k] = around;
  }
}

}  // namespace

struct OrientedBvh::Data {
  Box3 bounds;
  std::size_t vertices = 0;
  /// Index of the primitive at each rank (position in spatial order).
  std::vector<std::uint32_t> order;
  std::vector<std::array<std::uint32_t, 3>> corners;  ///< vertices of each primitive, in order of rank
  std::vector<FlatTriangleBlock> leaves;              ///< primitives in order of rank
  BlockTree<OrientedBlock> tree;                      ///< its leaves are the blocks of primitives
  /// Index of the smallest primitive in each leaf, and in each block of `tree`.
  std::vector<std::vector<std::uint32_t>> first;
  OrientedBox root;
  std::vector<NodeBoxes> boxes;  ///< boxes of the leaves and of each level; used by fill() only

  [[nodiscard]] std::size_t lanes_of(std::size_t leaf) const { return std::min(lanes, order.size() - leaf * lanes); }
  [[nodiscard]] std::size_t count_below(std::int32_t level) const {
    return level == 0 ? leaves.size() : tree.levels[static_cast<std::size_t>(level) - 1].size();
  }
  [[nodiscard]] NodeRef top() const { return {0, tree.top()}; }
  /// Returns the box of a node. A node's box is stored in its parent: blocks of level k contain the boxes of nodes of
  /// level k - 1.
  [[nodiscard]] OrientedBox box(const NodeRef& node) const {
    if (node.level == tree.top()) return root;
    return tree.levels[static_cast<std::size_t>(node.level) + 1][node.index / lanes].box(node.index % lanes);
  }

  /// Returns the smallest index of a primitive below a node.
  [[nodiscard]] std::uint32_t first_of(const NodeRef& node) const {
    return first[static_cast<std::size_t>(node.level) + 1][node.index];
  }

  void make_room();
  void fill_first();
  void fill(std::span<const Vec3d> positions, const Context& context);
  void fill_leaves(std::span<const Vec3d> positions, const IndexRange& range);
};

/// Fills `first`, which depends on the order only, not on positions.
void OrientedBvh::Data::fill_first() {
  std::vector<std::uint32_t> own = order;
  while (own.size() > 1 || first.size() < 2) {
    std::vector<std::uint32_t> above((own.size() + lanes - 1) / lanes, 0xffffffffU);
    for (std::size_t k = 0; k < own.size(); ++k) above[k / lanes] = std::min(above[k / lanes], own[k]);
    own = above;
    first.push_back(std::move(above));
  }
}

void OrientedBvh::Data::make_room() {
  boxes.emplace_back().resize(leaves.size());
  do {
    const std::size_t count = (boxes.back().size() + lanes - 1) / lanes;
    tree.levels.emplace_back(count);
    boxes.emplace_back().resize(count);
  } while (boxes.back().size() > 1);
}

void OrientedBvh::Data::fill_leaves(std::span<const Vec3d> positions, const IndexRange& range) {
  for (std::size_t leaf = range.begin; leaf < range.end; ++leaf) {
    const std::size_t count = lanes_of(leaf);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      // Unused lanes of the last leaf repeat its last primitive.
      const auto& v = corners[leaf * lanes + std::min(lane, count - 1)];
      leaves[leaf].set(lane, {positions[v[0]], positions[v[1]], positions[v[2]]});
    }
    boxes[0].around[leaf] = {};
    boxes[0].boxes[leaf] = box_around(leaves[leaf], boxes[0].around[leaf]);
  }
}

/// Sets the positions of all primitives and computes all boxes. Each thread fills whole parts of the tree up to
/// `level_of_parts`, while their data are in its cache. One thread fills the few blocks above.
void OrientedBvh::Data::fill(std::span<const Vec3d> positions, const Context& context) {
  const std::size_t parts = (leaves.size() + leaves_per_part - 1) / leaves_per_part;
  parallel_for(context, parts, 1, "", [&](const WorkRange& range) {
    IndexRange part{range.begin * leaves_per_part, std::min(range.end * leaves_per_part, leaves.size())};
    fill_leaves(positions, part);
    for (std::size_t level = 0; level < std::min(level_of_parts + 1, tree.levels.size()); ++level) {
      part = {part.begin / lanes, (part.end + lanes - 1) / lanes};
      fill_level(tree.levels[level], boxes[level], part, boxes[level + 1]);
    }
  });
  for (std::size_t level = level_of_parts + 1; level < tree.levels.size(); ++level) {
    fill_level(tree.levels[level], boxes[level], {0, tree.levels[level].size()}, boxes[level + 1]);
  }
  root = boxes.back().boxes.front();
  bounds = boxes.back().around.front();
}

OrientedBvh::OrientedBvh(const MeshView& mesh, const Context& context) : data_(std::make_unique<Data>()) {
  Data& data = *data_;
  const std::size_t count = primitive_count(mesh);
  data.vertices = mesh.vertices.size();
  const auto middle = [&](std::size_t primitive) {
    Box3 box;
    for (const std::uint32_t v : primitive_vertices(mesh, static_cast<std::uint32_t>(primitive)))
      box.extend(mesh.vertices[v]);
    return box.center();
  };
  data.order = space_order(count, middle, context);
  data.corners.resize(count);
  for (std::size_t rank = 0; rank < count; ++rank) data.corners[rank] = primitive_vertices(mesh, data.order[rank]);
  data.leaves.resize((count + lanes - 1) / lanes);
  data.fill_first();
  data.make_room();
  data.fill(mesh.vertices, context);
}

OrientedBvh::OrientedBvh(OrientedBvh&&) noexcept = default;
OrientedBvh& OrientedBvh::operator=(OrientedBvh&&) noexcept = default;
OrientedBvh::~OrientedBvh() = default;

void OrientedBvh::refit(std::span<const Vec3d> vertices, const Context& context) {
  if (vertices.size() != data_->vertices) {
    throw InvalidMesh("a hierarchy of a mesh with " + std::to_string(data_->vertices) +
                      " vertices cannot be refitted to " + std::to_string(vertices.size()) +
                      " vertices; build a new hierarchy");
  }
  data_->fill(vertices, context);
}

std::size_t OrientedBvh::size() const {
  return data_->order.size();
}
const Box3& OrientedBvh::bounds() const {
  return data_->bounds;
}
std::size_t OrientedBvh::block_count() const {
  return data_->leaves.size();
}
std::span<const std::uint32_t> OrientedBvh::order() const {
  return data_->order;
}
std::span<const std::uint32_t> OrientedBvh::block(std::size_t block) const {
  return std::span<const std::uint32_t>(data_->order).subspan(block * lanes, data_->lanes_of(block));
}

namespace {

/// Traverses two trees together. In each pair of nodes, the larger node is replaced by its children.
template <class Data>
class PairSearch {
 public:
  PairSearch(const Data& here, const Data& there, const RigidTransform& place, double limit,
             const OrientedBvh::Visit& visit)
      : here_(here),
        there_(there),
        place_(place),
        back_(place.inverse()),
        is_placed_(!(place == RigidTransform{})),
        slack_(rounding *
               (here.bounds.largest_coordinate() + there.bounds.largest_coordinate() + length(place.translation))),
        limit_(limit),
        visit_(visit) {}

  /// For a tree that is searched against itself: restricts the search to blocks with at least this index. Each pair of
  /// primitives then occurs only once.
  void only_from(std::size_t block) {
    first_there_ = block;
    is_self_ = true;
  }

  void run(const NodeRef& here, const NodeRef& there) { run({0, here, there}); }
  void run(const NodePair& first) {
    std::size_t steps = std::numeric_limits<std::size_t>::max();
    run(first, steps);
  }
  /// @param steps  number of steps after which the search ends; reduced by those that were done. See pending().
  void run(const NodePair& first, std::size_t& steps) {
    pending_.push_back(first);
    for (; !pending_.empty() && steps > 0; --steps) {
      const NodePair pair = pending_.pop_back();
      const double most = squared_limit(limit_, slack_);
      if (!(pair.squared_gap <= most) || here_.first_of(pair.here) > last_here_) continue;
      if (pair.here.is_leaf() && pair.there.is_leaf()) {
        compare_leaves(pair.here.index, pair.there.index);
      } else {
        descend(pair, most);
      }
    }
  }
  /// Pairs that remain to be compared if a search has ended early.
  [[nodiscard]] std::span<const NodePair> pending() const { return pending_.span(); }
  [[nodiscard]] bool is_over() const { return !(limit_ >= 0); }

  /// Descends `times` times from the closest remaining pair of nodes to a pair of primitives, always to the closest
  /// children.
  /// @return  the remaining pairs, closest first.
  [[nodiscard]] std::vector<NodePair> dive(std::size_t times) {
    std::vector<NodePair> heap{{0, here_.top(), there_.top()}};
    const auto push = [&](const NodePair& pair) {
      heap.push_back(pair);
      std::push_heap(heap.begin(), heap.end(), comes_later);
    };
    for (std::size_t k = 0; k < times && !heap.empty(); ++k) {
      std::pop_heap(heap.begin(), heap.end(), comes_later);
      NodePair pair = heap.back();
      heap.pop_back();
      if (!(pair.squared_gap <= squared_limit(limit_, slack_))) return {};
      bool is_open = true;
      while (is_open && !(pair.here.is_leaf() && pair.there.is_leaf())) {
        descend(pair, squared_limit(limit_, slack_));
        is_open = !pending_.empty();
        if (is_open) pair = pending_.pop_back();
        while (!pending_.empty()) push(pending_.pop_back());
      }
      if (is_open) compare_leaves(pair.here.index, pair.there.index);
    }
    std::sort_heap(heap.begin(), heap.end(), comes_later);
    std::reverse(heap.begin(), heap.end());
    const double limit = squared_limit(limit_, slack_);
    while (!heap.empty() && !(heap.back().squared_gap <= limit)) heap.pop_back();
    return heap;
  }

 private:
  [[nodiscard]] OrientedBox there_seen_from_here(const NodeRef& node) const {
    const OrientedBox box = there_.box(node);
    return is_placed_ ? placed(box, place_) : box;
  }
  [[nodiscard]] OrientedBox here_seen_from_there(const NodeRef& node) const {
    const OrientedBox box = here_.box(node);
    return is_placed_ ? placed(box, back_) : box;
  }

  void descend(const NodePair& pair, double most) {
    bool is_here = pair.there.is_leaf();
    if (!is_here && !pair.here.is_leaf()) {
      is_here = here_.box(pair.here).half_sum() >= there_.box(pair.there).half_sum();
    }
    alignas(64) double gaps[lanes];
    const NodeRef& parent = is_here ? pair.here : pair.there;
    const Data& tree = is_here ? here_ : there_;
    const auto level = static_cast<std::size_t>(parent.level);
    const OrientedBox other = is_here ? there_seen_from_here(pair.there) : here_seen_from_there(pair.here);
    squared_gaps(tree.tree.levels[level][parent.index], other, gaps);
    const std::size_t first = parent.index * lanes;
    const std::size_t count = std::min(lanes, tree.count_below(parent.level) - first);
    const std::size_t bottom = pending_.size();
    for (std::size_t lane = 0; lane < count; ++lane) {
      if (!(gaps[lane] <= most)) continue;
      const NodeRef child{static_cast<std::uint32_t>(first + lane), parent.level - 1};
      // A node of level k contains 8^(k + 1) blocks.
      const bool is_early = !is_here && ((static_cast<std::size_t>(child.index) + 1)
                                         << (3 * static_cast<unsigned>(child.level + 1))) <= first_there_;
      if (is_early || (is_here ? here_.first_of(child) > last_here_ : there_.first_of(child) > last_there_)) continue;
      push_sorted(pending_, bottom, {gaps[lane], is_here ? child : pair.here, is_here ? pair.there : child});
    }
  }

  void compare_leaves(std::size_t here, std::size_t there) {
    const std::size_t rows = there_.lanes_of(there);
    const std::size_t columns = here_.lanes_of(here);
    double most = squared_limit(limit_, slack_);
    // Most primitives of one leaf are far from the box of the other leaf.
    alignas(64) double row_gaps[lanes];
    squared_gaps(there_.leaves[there], here_seen_from_there({static_cast<std::uint32_t>(here), -1}), row_gaps);
    alignas(64) double column_gaps[lanes];
    squared_gaps(here_.leaves[here], there_seen_from_here({static_cast<std::uint32_t>(there), -1}), column_gaps);
    unsigned open = 0;
    for (std::size_t column = 0; column < columns; ++column) {
      const bool is_open = column_gaps[column] <= most && here_.order[here * lanes + column] <= last_here_;
      open |= static_cast<unsigned>(is_open) << column;
    }
    if (open == 0) return;
    struct Candidate {
      double squared_gap;
      std::uint8_t row, column;
    };
    InlineList<Candidate, lanes * lanes> candidates;
    for (std::size_t row = 0; row < rows; ++row) {
      if (!(row_gaps[row] <= most) || there_.order[there * lanes + row] > last_there_) continue;
      FlatTriangle triangle = there_.leaves[there].triangle(row);
      if (is_placed_) {
        for (Vec3d& corner : triangle.corners) corner = place_(corner);
        triangle.normal = place_.rotation * triangle.normal;
      }
      alignas(64) double gaps[lanes];
      squared_gaps(here_.leaves[here], triangle, gaps);
      for (std::size_t column = 0; column < columns; ++column) {
        if (!(gaps[column] <= most) || (open >> column & 1U) == 0 || (is_self_ && here == there && column <= row))
          continue;
        candidates.push_back({gaps[column], static_cast<std::uint8_t>(row), static_cast<std::uint8_t>(column)});
      }
    }
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.squared_gap < b.squared_gap; });
    for (const Candidate& one : candidates) {
      if (!(one.squared_gap <= most)) return;
      const std::uint32_t first = here_.order[here * lanes + one.column];
      const std::uint32_t second = there_.order[there * lanes + one.row];
      if (first > last_here_ || second > last_there_) continue;
      const OrientedBvh::Wanted wanted = visit_(first, second, std::max(std::sqrt(one.squared_gap) - slack_, 0.0));
      last_here_ = std::min(last_here_, wanted.last_here);
      last_there_ = std::min(last_there_, wanted.last_there);
      if (wanted.limit < limit_) {
        limit_ = wanted.limit;
        most = squared_limit(limit_, slack_);
      }
    }
  }

  const Data& here_;
  const Data& there_;
  RigidTransform place_;
  RigidTransform back_;
  bool is_placed_;
  double slack_;
  double limit_;
  std::uint32_t last_here_ = 0xffffffffU;
  std::uint32_t last_there_ = 0xffffffffU;
  std::size_t first_there_ = 0;
  bool is_self_ = false;
  const OrientedBvh::Visit& visit_;
  PendingPairs pending_;
};

}  // namespace

void OrientedBvh::for_each_near_pair(const OrientedBvh& other, const RigidTransform& place, double limit,
                                     Visit visit) const {
  PairSearch<Data>(*data_, *other.data_, place, limit, visit).run(data_->top(), other.data_->top());
}

std::vector<OrientedBvh::NodePair> OrientedBvh::dive_to_near_pairs(const OrientedBvh& other,
                                                                   const RigidTransform& place, double limit,
                                                                   std::size_t dives, Visit visit) const {
  return PairSearch<Data>(*data_, *other.data_, place, limit, visit).dive(dives);
}

std::vector<OrientedBvh::NodePair> OrientedBvh::visit_some_near_pairs(std::span<const NodePair> nodes,
                                                                      const OrientedBvh& other,
                                                                      const RigidTransform& place, double limit,
                                                                      std::size_t steps, Visit visit) const {
  PairSearch<Data> search(*data_, *other.data_, place, limit, visit);
  std::size_t done = 0;
  for (; done < nodes.size() && steps > 0; ++done) search.run(nodes[done], steps);
  if (search.is_over()) return {};
  std::vector<NodePair> left(search.pending().rbegin(), search.pending().rend());
  left.insert(left.end(), nodes.begin() + static_cast<std::ptrdiff_t>(done), nodes.end());
  return left;
}

OrientedBvh::NodePair OrientedBvh::whole(const OrientedBvh& other) const {
  return {0, data_->top(), other.data_->top()};
}

void OrientedBvh::for_each_near_pair(std::size_t block, const OrientedBvh& other, const RigidTransform& place,
                                     double limit, Visit visit) const {
  const NodeRef leaf{static_cast<std::uint32_t>(block), -1};
  PairSearch<Data>(*data_, *other.data_, place, limit, visit).run(leaf, other.data_->top());
}

void OrientedBvh::for_each_near_self_pair(std::size_t block, double limit, Visit visit) const {
  PairSearch<Data> search(*data_, *data_, {}, limit, visit);
  search.only_from(block);
  search.run({static_cast<std::uint32_t>(block), -1}, data_->top());
}

}  // namespace blum
