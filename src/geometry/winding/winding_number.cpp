#include "blum/geometry/winding_number.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"
#include "geometry/winding/boundary_chain.hpp"
#include "geometry/winding/winding_tree.hpp"

namespace blum {
namespace {

/// Triangles from the boundary of a surface to a common point. Together, surface and cone are closed, so their winding
/// numbers add up to an integer. Thus the surface's winding number follows exactly from a rough value and the cone's
/// number.
class BoundaryCone {
 public:
  BoundaryCone() = default;
  /// @param edges  directed edges of the boundary, in the direction in which the surface traverses them.
  explicit BoundaryCone(std::span<const BoundaryChain::Edge> edges);

  /// Returns the cone's winding number, accurate to `error`. Returns nullopt if this accuracy is uncertain, which
  /// happens close to edges of the cone's triangles.
  [[nodiscard]] std::optional<double> winding_number(const Vec3d& scaled_query) const;
  static constexpr double error = 1e-9;

 private:
  std::vector<TriangleBlock> blocks_;
};

/// Upper bound on the rounding error of an angle's terms.
constexpr double rounding_of_cone = 1e-14;

/// Returns a point near the middle of the boundary. The point is offset by odd amounts, so that nothing in a mesh is
/// likely to be aligned with it.
Vec3d apex_of(std::span<const BoundaryChain::Edge> edges) {
  Box3 box;
  for (const BoundaryChain::Edge& edge : edges) {
    box.extend(edge.from);
    box.extend(edge.to);
  }
  return box.center() + Vec3d{0.01371, 0.02917, -0.01733} * box.diagonal();
}

BoundaryCone::BoundaryCone(std::span<const BoundaryChain::Edge> edges) {
  if (edges.empty()) return;
  const Vec3d apex = apex_of(edges);
  std::size_t lane = lanes;
  for (const BoundaryChain::Edge& edge : edges) {
    for (std::int64_t k = 0; k < edge.multiplicity; ++k) {
      if (lane == lanes) {
        TriangleBlock& block = blocks_.emplace_back();
        for (auto& corner : block.corner) {
          for (std::size_t axis = 0; axis < 3; ++axis) std::fill_n(corner[axis], lanes, apex[axis]);
        }
        lane = 0;
      }
      // The edge is traversed opposite to the surface's direction.
      const std::array<Vec3d, 3> corners{edge.to, edge.from, apex};
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t axis = 0; axis < 3; ++axis) blocks_.back().corner[c][axis][lane] = corners[c][axis];
      }
      ++lane;
    }
  }
}

std::optional<double> BoundaryCone::winding_number(const Vec3d& scaled_query) const {
  SolidAngleSum sum;
  alignas(64) double inverse[lanes] = {};
  for (const TriangleBlock& block : blocks_) add_watched_triangles(block, scaled_query, sum, inverse);
  const double badly = std::accumulate(inverse, inverse + lanes, 0.0);
  if (!(rounding_of_cone * badly < error)) return std::nullopt;  // also if the query is a corner, which gives NaN
  return sum.winding_number();
}

constexpr double full_angle = 4 * std::numbers::pi;
/// Upper bound on the rounding error of a hierarchical sum.
constexpr double rounding = 1e-11;
/// Bound on the rounding error close to a triangle, to be multiplied by largest coordinate / distance. Angles there are
/// quotients of small differences of large products. Close to edges, errors of a tenth of this bound were observed.
constexpr double rounding_nearby = 4e-15;
/// If a query is further away than this many sizes of the mesh, its winding number counts as 0 (it is below 1e-60).
constexpr double far_away = 1e30;
/// is_inside() first accepts clusters whose error, as a winding number, is at most this. If this tolerance does not
/// decide, is_inside() accepts only smaller errors.
constexpr double first_tolerance = 1.5e-2;
/// Returns the next smaller tolerance. Most queries that the first tolerance does not decide need only a little more
/// accuracy.
constexpr double lower(double tolerance) {
  return tolerance * (tolerance > 1e-3 ? 1.0 / 8 : 1.0 / 64);
}

/// For each digit of accuracy after the second one: if there are fewer triangles than this, the full sum is faster than
/// estimates.
constexpr double full_sum_is_quicker = 10000;

/// Winding numbers rarely differ from 1/2 by this much, so larger changes are not examined.
constexpr double side_limit = 1e3;

struct Item {
  std::uint32_t block;
  std::int32_t level;  ///< -1 for a leaf
};

/// Traverses the tree. The function add(block, far, others) must add the clusters that are far enough away to `far`. It
/// must mark the other clusters in `others`; they are then opened.
template <class AddClusters>
WindingNumber::Estimate walk(const WindingTree& tree, const Vec3d& query, const AddClusters& add) {
  std::array<Item, 128> stack;  // the stack contains at most seven siblings from each of at most eleven levels
  std::size_t size = 0;
  stack[size++] = {0, tree.top()};
  SolidAngleSum near;
  bool has_near = false;
  FarSum far;
  OpenLanes others;
  while (size > 0) {
    const Item item = stack[--size];
    if (item.level < 0) {
      add_triangles(tree.leaves[item.block], query, near);
      has_near = true;
      continue;
    }
    add(tree.levels[static_cast<std::size_t>(item.level)][item.block], far, others);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      stack[size] = {static_cast<std::uint32_t>(item.block * lanes + lane), item.level - 1};
      // Computed without branches, which would often be mispredicted.
      size += static_cast<std::size_t>(others.open[lane]);
    }
  }
  const double solid_angle = std::accumulate(far.solid_angle, far.solid_angle + lanes, 0.0);
  const double error = std::accumulate(far.error, far.error + lanes, 0.0);
  return {solid_angle / full_angle + (has_near ? near.winding_number() : 0.0), error / full_angle};
}

}  // namespace

struct WindingNumber::Data {
  std::size_t triangles = 0;
  double largest_coordinate = 0;  ///< mesh units
  WindingTree tree;
  BoundaryChain boundary;
  BoundaryCone cone;  ///< only for boundaries with few edges

  [[nodiscard]] bool is_short() const { return boundary.is_empty() || !boundary.edges().empty(); }

  /// Returns the query in the tree's coordinates. Returns nullopt if it is so far away that its winding number counts
  /// as 0.
  [[nodiscard]] std::optional<Vec3d> scaled(const Vec3d& query) const {
    const Vec3d q = query * tree.scale;
    const BoxBlock* root = tree.levels.empty() ? nullptr : tree.boxes.levels.back().data();
    if (root == nullptr) return std::nullopt;
    const Vec3d first{root->lower[0][0], root->lower[1][0], root->lower[2][0]};
    const Vec3d offset = q - first;
    const double furthest = std::max({std::abs(offset.x), std::abs(offset.y), std::abs(offset.z)});
    if (!(furthest < far_away)) return std::nullopt;
    return q;
  }

  [[nodiscard]] double full_sum(const Vec3d& scaled_query) const {
    SolidAngleSum sum;
    for (const TriangleBlock& leaf : tree.leaves) add_triangles(leaf, scaled_query, sum);
    return sum.winding_number();
  }

  /// Returns an estimate of the winding number with a bound on its error.
  /// @param tolerance  error allowed for each cluster, in units of winding numbers.
  [[nodiscard]] Estimate bounded(const Vec3d& scaled_query, double tolerance) const {
    Estimate out = walk(tree, scaled_query, [&](const MultipoleBlock& block, FarSum& far, OpenLanes& others) {
      add_clusters(block, scaled_query, tolerance * full_angle, far, others);
    });
    out.error += rounding;
    return out;
  }
};

WindingNumber::WindingNumber(const MeshView& mesh, const Context& context)
    : WindingNumber(mesh, SiteTable(mesh, context), context) {}

WindingNumber::WindingNumber(const MeshView& mesh, const SiteTable& sites, const Context& context) {
  auto data = std::make_unique<Data>();
  data->triangles = mesh.triangles.size();
  data->largest_coordinate = bounds(mesh).largest_coordinate();
  data->tree = make_winding_tree(mesh, context);
  data->boundary = BoundaryChain(mesh, sites, data->tree.scale, context);
  data->cone = BoundaryCone(data->boundary.edges());
  data_ = std::move(data);
}

WindingNumber::WindingNumber(WindingNumber&&) noexcept = default;
WindingNumber& WindingNumber::operator=(WindingNumber&&) noexcept = default;
WindingNumber::~WindingNumber() = default;

double WindingNumber::operator()(const Vec3d& query) const {
  const std::optional<Vec3d> q = data_->scaled(query);
  return q ? data_->full_sum(*q) : 0.0;
}

double WindingNumber::approximate(const Vec3d& query, double beta) const {
  const std::optional<Vec3d> q = data_->scaled(query);
  if (!q) return 0;
  return walk(data_->tree, *q,
              [&](const MultipoleBlock& block, FarSum& far, OpenLanes& others) {
                add_clusters_beyond(block, *q, beta, far, others);
              })
      .value;
}

bool WindingNumber::is_inside(const Vec3d& query) const {
  return decide(query, HUGE_VAL).is_inside;
}

double WindingNumber::rounding_at(const Vec3d& query, double distance) const {
  const double largest = std::max({std::abs(query.x), std::abs(query.y), std::abs(query.z), data_->largest_coordinate});
  return rounding_nearby * (largest / distance);
}

WindingNumber::Decision WindingNumber::decide(const Vec3d& query, double distance) const {
  const std::optional<Vec3d> q = data_->scaled(query);
  if (!q) return {false, 0.5};
  const double nearby = rounding_at(query, distance);
  for (double tolerance = first_tolerance; tolerance > 1e-12; tolerance = lower(tolerance)) {
    const Estimate w = data_->bounded(*q, tolerance);
    const double margin = std::abs(w.value - 0.5) - w.error - nearby;
    if (margin > 0) return {w.value > 0.5, margin};
    if (w.error < nearby) break;  // further terms do not reduce the error
  }
  return {data_->full_sum(*q) > 0.5, 0};
}

WindingNumber::Estimate WindingNumber::estimate(const Vec3d& query, double max_error) const {
  const std::optional<Vec3d> q = data_->scaled(query);
  if (!q) return {0, 1e-60};
  for (double tolerance = std::min(first_tolerance, max_error); tolerance > 1e-12; tolerance = lower(tolerance)) {
    const Estimate w = data_->bounded(*q, tolerance);
    if (w.error <= max_error) return w;
  }
  return {data_->full_sum(*q), rounding};
}

bool WindingNumber::has_short_boundary() const {
  return data_->is_short();
}

std::optional<double> WindingNumber::refine(const Vec3d& query, double rough) const {
  if (!data_->is_short()) return std::nullopt;
  if (data_->boundary.is_empty()) return std::round(rough) + 0.0;  // + 0.0 turns -0 into 0
  const std::optional<Vec3d> q = data_->scaled(query);
  if (!q) return 0;
  const std::optional<double> cone = data_->cone.winding_number(*q);
  if (!cone) return std::nullopt;
  return std::round(rough + *cone) - *cone;
}

WindingNumber::Estimate WindingNumber::value(const Vec3d& query, double max_error) const {
  if (data_->is_short() && (max_error >= refined_error || data_->boundary.is_empty())) {
    const Estimate rough = estimate(query, rough_error);
    if (const std::optional<double> fine = refine(query, rough.value)) {
      return {*fine, data_->boundary.is_empty() ? 0 : refined_error};
    }
  }
  if (static_cast<double>(data_->triangles) < full_sum_is_quicker * (-std::log10(max_error) - 2)) {
    return {(*this)(query), rounding};
  }
  return estimate(query, max_error);
}

bool WindingNumber::is_piecewise_constant() const {
  return data_->boundary.is_empty();
}

std::size_t WindingNumber::triangle_count() const {
  return data_->triangles;
}

double WindingNumber::gradient_bound(const Box3& box, double enough) const {
  const double scale = data_->tree.scale;
  return data_->boundary.gradient_bound({box.lower * scale, box.upper * scale}, enough / scale) * scale;
}

std::optional<bool> WindingNumber::side(const Vec3d& query, double change) const {
  if (!(change < side_limit)) return std::nullopt;
  const std::optional<Vec3d> q = data_->scaled(query);
  if (!q) return change < 0.5 ? std::optional(false) : std::nullopt;
  for (double tolerance = first_tolerance; tolerance > 1e-12; tolerance = lower(tolerance)) {
    const Estimate w = data_->bounded(*q, tolerance);
    const double margin = std::abs(w.value - 0.5);
    if (margin > w.error + change) return w.value > 0.5;
    if (margin + w.error < change) return std::nullopt;
  }
  return std::nullopt;
}

std::optional<bool> WindingNumber::uniform_side(const Box3& box) const {
  if (box.is_empty()) return std::nullopt;
  const Data& data = *data_;
  if (data.tree.leaves.empty()) return false;
  const Box3 scaled{box.lower * data.tree.scale, box.upper * data.tree.scale};
  if (blum::may_touch(data.tree.boxes, scaled)) return std::nullopt;
  return side(box.center(), data.boundary.gradient_bound(scaled) * scaled.diagonal() / 2);
}

}  // namespace blum
