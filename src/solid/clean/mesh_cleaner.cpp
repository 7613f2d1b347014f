#include "solid/clean/mesh_cleaner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/core/union_find.hpp"
#include "blum/geometry/closest_point.hpp"
#include "blum/geometry/orient3d.hpp"
#include "blum/geometry/space_order.hpp"
#include "blum/geometry/triangle_contact.hpp"

namespace blum::detail {
namespace {

double magnitude(const Vec3d& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

ContactTriangle for_contact(const ShrinkingSurface& mesh, const Triangle& t) {
  return {{mesh.point(t[0]), mesh.point(t[1]), mesh.point(t[2])}, t};
}

/// Returns true if a plane through an edge of `a`, at a right angle to `a`, certainly separates the two triangles. In
/// this case, the triangles share at most ends of that edge. The plane's function det(edge, n, x - corner) is 0 at both
/// ends of the edge for every vector n. So rounding of n does not matter. This test decides nearly all coplanar
/// neighbours, for which exact determinants would take long.
bool lies_beyond_an_edge(const ContactTriangle& a, const ContactTriangle& b) {
  constexpr double rounding = 1e-14;
  const Vec3d normal = cross(a.points[1] - a.points[0], a.points[2] - a.points[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& from = a.points[k];
    const std::size_t next = (k + 1) % 3;
    const Vec3d edge = a.points[next] - from;
    const Vec3d outwards = cross(edge, normal);
    const double error = rounding * magnitude(edge) * magnitude(normal);
    const auto side = [&](const Vec3d& p) {
      const Vec3d way = p - from;
      const double value = dot(outwards, way);
      const double uncertain = error * magnitude(way);
      return value > uncertain ? 1 : value < -uncertain ? -1 : 0;
    };
    if (side(a.points[(k + 2) % 3]) >= 0) continue;
    bool beyond = true;
    for (std::size_t j = 0; j < 3 && beyond; ++j) {
      const bool is_end = b.corners[j] == a.corners[k] || b.corners[j] == a.corners[next];
      beyond = is_end || side(b.points[j]) > 0;
    }
    if (beyond) return true;
  }
  return false;
}

bool are_apart(const ContactTriangle& a, const ContactTriangle& b) {
  return lies_beyond_an_edge(a, b) || lies_beyond_an_edge(b, a) || contact(a, b) == Contact::none;
}

/// Returns true if a point lies in a closed tetrahedron; false if the tetrahedron has no volume.
bool holds(const std::array<Vec3d, 4>& corners, const Vec3d& p) {
  const int way = orient3d(corners[0], corners[1], corners[2], corners[3]);
  if (way == 0) return false;
  for (std::size_t k = 0; k < 4; ++k) {
    std::array<Vec3d, 4> with = corners;
    with[k] = p;
    if (way * orient3d(with[0], with[1], with[2], with[3]) < 0) return false;
  }
  return true;
}

std::vector<Box3> boxes_of(const ShrinkingSurface& mesh) {
  std::vector<Box3> out(mesh.triangles().size());
  for (std::uint32_t t = 0; t < out.size(); ++t) {
    if (mesh.is_gone(t)) continue;
    for (const Vec3d& p : mesh.corners(t)) out[t].extend(p);
  }
  return out;
}

/// Returns for each vertex a number of its shell; empty if the mesh has only one shell.
std::vector<std::uint32_t> shells_of(const ShrinkingSurface& mesh) {
  std::uint32_t vertices = 0;
  for (const Triangle& t : mesh.triangles()) vertices = std::max({vertices, t[0] + 1, t[1] + 1, t[2] + 1});
  UnionFind joined(vertices);
  for (const Triangle& t : mesh.triangles()) {
    joined.join(t[0], t[1]);
    joined.join(t[1], t[2]);
  }
  std::vector<std::uint32_t> out(vertices);
  for (std::uint32_t v = 0; v < vertices; ++v) out[v] = joined.find(v);
  const std::uint32_t first = out[mesh.triangle(0)[0]];
  const bool is_one = std::all_of(mesh.triangles().begin(), mesh.triangles().end(),
                                  [&](const Triangle& t) { return out[t[0]] == first; });
  return is_one ? std::vector<std::uint32_t>() : out;
}

constexpr double infinity = std::numeric_limits<double>::infinity();
/// For rings with more corners than this, the edges of the two fans are not compared pair by pair.
constexpr std::size_t most_pairwise = 40;
// Fractions of the squared extent of the fans. Computed areas have errors of at most 2e-15 of the squared extent.
constexpr double clear_area = 1e-12;  ///< a triangle with a larger area certainly turns left
constexpr double clear_side = 1e-14;  ///< a point with a larger area certainly lies beside a line
constexpr double steep_area = 1e-9;   ///< quotients by larger areas are accurate to 4e-6
constexpr double quotient_error = 1e-5;
constexpr double height_error = 1e-14;  ///< fraction of the extent

/// Returns twice the signed area of the triangle of the origin, a and b, projected onto the plane z = 0.
double area(const Vec3d& a, const Vec3d& b) {
  return a.x * b.y - a.y * b.x;
}

/// The ring of both fans in coordinates with the apex as origin. The plane z = 0 is the mean plane of the fan from the
/// apex.
class Fans {
 public:
  Fans(std::span<const Vec3d> ring, const Vec3d& apex, bool closed) : closed_(closed), points_(ring.size()) {
    Vec3d normal{};
    const std::size_t sides = ring.size() - (closed ? 0 : 1);
    for (std::size_t k = 0; k < sides; ++k) normal += cross(ring[k] - apex, ring[(k + 1) % ring.size()] - apex);
    const double size = length(normal);
    if (!(size > 0)) return;
    normal *= 1 / size;
    const Vec3d other = std::abs(normal.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    Vec3d across = cross(normal, other);
    across *= 1 / length(across);
    const Vec3d along = cross(normal, across);
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec3d from_apex = ring[k] - apex;
      points_[k] = {dot(from_apex, across), dot(from_apex, along), dot(from_apex, normal)};
      extent_ = std::max(extent_, std::abs(from_apex.x) + std::abs(from_apex.y) + std::abs(from_apex.z));
      lowest_ = std::min(lowest_, points_[k].z);
      highest_ = std::max(highest_, points_[k].z);
    }
    square_ = extent_ * extent_;
  }

  /// Returns true if both fans are certainly graphs of functions over the projected polygon.
  [[nodiscard]] bool are_graphs() const {
    if (!(square_ > 0)) return false;
    const std::size_t last = points_.size() - 1;
    const double least = clear_area * square_;
    std::size_t turns = 0;
    for (std::size_t k = 0; k + (closed_ ? 0 : 1) <= last; ++k) {
      const Vec3d& a = points_[k];
      const Vec3d& b = points_[k == last ? 0 : k + 1];
      if (!(area(a, b) > least)) return false;
      if (a.y < 0 && b.y >= 0) ++turns;
    }
    for (std::size_t k = 1; k + 1 <= last; ++k) {
      if (!(area(points_[k] - points_[0], points_[k + 1] - points_[0]) > least)) return false;
      // If the apex lies on a side, all corners must lie within half a turn around it.
      if (!closed_ && !(area(points_[0], points_[k]) > least)) return false;
    }
    return !closed_ || turns == 1;
  }

  /// Returns an upper bound on the distance of the fans in z: the height of the slab that contains both.
  [[nodiscard]] double slab() const { return (highest_ - lowest_) + height_error * extent_; }

  /// Returns a smaller upper bound on the distance of the fans in z. The distance is evaluated at the apex and at
  /// crossings of edges. Between these points both fans are linear.
  [[nodiscard]] double gap() const {
    double most = closed_ ? gap_at_apex() : 0;
    const std::size_t last = points_.size() - 1;
    const std::size_t end = closed_ ? last + 1 : last;
    for (std::size_t i = 1; i < end && most < infinity; ++i) {
      for (std::size_t j = 2; j < last; ++j) {
        if (i != j) most = std::max(most, gap_at_crossing(points_[i], points_[j]));
      }
    }
    return std::min(slab(), most + quotient_error * (highest_ - lowest_) + height_error * extent_);
  }

 private:
  [[nodiscard]] double gap_at_apex() const {
    const Vec3d& w = points_[0];
    const Vec3d apex = -w;
    double most = infinity;
    for (std::size_t k = 1; k + 1 < points_.size(); ++k) {
      const Vec3d a = points_[k] - w;
      const Vec3d b = points_[k + 1] - w;
      const double of_b = area(a, apex);
      const double of_a = area(apex, b);
      if (of_a < -clear_side * square_ || of_b < -clear_side * square_) continue;
      const double whole = area(a, b);
      if (whole < steep_area * square_) return infinity;
      const double found = std::abs(w.z + (of_a * a.z + of_b * b.z) / whole);
      most = most == infinity ? found : std::max(most, found);
    }
    return most;
  }

  /// Returns the difference in z where two edges cross: from the apex to p, and from the first corner to q. Returns 0
  /// if they do not cross, infinity if they are nearly parallel.
  [[nodiscard]] double gap_at_crossing(const Vec3d& p, const Vec3d& q) const {
    const Vec3d& w = points_[0];
    const double clear = clear_side * square_;
    const double w_side = area(p, w);
    const double q_side = area(p, q);
    if ((w_side > clear && q_side > clear) || (w_side < -clear && q_side < -clear)) return 0;
    const Vec3d way = q - w;
    const double apex_side = area(way, -w);
    const double p_side = area(way, p - w);
    if ((apex_side > clear && p_side > clear) || (apex_side < -clear && p_side < -clear)) return 0;
    const double turn = area(p, way);
    if (std::abs(turn) < steep_area * square_) return infinity;
    const double s = std::clamp(area(w, way) / turn, 0.0, 1.0);
    const double t = std::clamp(-w_side / turn, 0.0, 1.0);
    return std::abs(s * p.z - (w.z + t * way.z));
  }

  bool closed_;
  std::vector<Vec3d> points_;
  double extent_ = 0;
  double square_ = 0;
  double lowest_ = 0;
  double highest_ = 0;
};

/// For a vertex with more neighbours than this, only the `targets_of_many` closest ones are tried as targets.
constexpr std::size_t many_neighbours = 24;
constexpr std::size_t targets_of_many = 12;
/// A bound below this fraction of the tolerance is good enough. No better bound is then computed.
constexpr double negligible = 0.002;
/// Cost of the worst possible shape of new triangles. A deviation of the whole tolerance costs 1.
constexpr double cost_of_shape = 0.1;
/// The lowest new triangle must have at least this fraction of the height of the lowest old triangle. If a new triangle
/// is a needle, the fraction is 1.
constexpr double flattening = 0.25;
/// A triangle is a needle if its height is below the tolerance, and its longest side exceeds this multiple of the
/// height.
constexpr double slenderness = 10;
/// Cosine of the largest angle by which the normal of a triangle may turn. Needles may turn by any angle, but must not
/// fold onto their neighbours. The second constant is the limit for needles, measured from the neighbour's normal.
constexpr double least_cosine = 0.2;
constexpr double least_cosine_of_needle = -0.5;
/// An edge is flipped only if the flip multiplies the height of the lower triangle by at least this factor. So the
/// sequence of flips ends.
constexpr double least_gain = 1.5;
/// Extra cost of flips, so that collapses with the same deviation come first.
constexpr double cost_of_flip = 0.1;
constexpr double rounding = 1e-14;

double cosine(const Vec3d& a, const Vec3d& b) {
  const double sizes = std::sqrt(squared_length(a)) * std::sqrt(squared_length(b));
  return sizes > 0 ? dot(a, b) / sizes : -1;
}

constexpr std::size_t looks_between_reports = 256;
constexpr std::size_t vertices_per_range = 256;
/// A vertex with more triangles than this is visited again only after a 1 / `part_to_change` share of its triangles has
/// changed. A visit takes time linear in the number of triangles. Without this limit, the centre of a large disc would
/// be visited after each change of its triangles.
constexpr std::size_t many_triangles = 64;
constexpr std::size_t part_to_change = 8;

std::vector<double> heights_of(const ShrinkingSurface& mesh) {
  std::vector<double> out(mesh.triangles().size());
  for (std::uint32_t t = 0; t < out.size(); ++t) {
    const std::array<Vec3d, 3> p = mesh.corners(t);
    out[t] = least_height(p[0], p[1], p[2]);
  }
  return out;
}

}  // namespace

TriangleBoxes::TriangleBoxes(std::span<const Box3> boxes, const Context& context) : leaf_of_(boxes.size()) {
  std::vector<std::uint32_t> there;
  for (std::uint32_t k = 0; k < boxes.size(); ++k) {
    if (!boxes[k].is_empty()) there.push_back(k);
  }
  at_leaf_ = space_order(there.size(), [&](std::size_t k) { return boxes[there[k]].center(); }, context);
  while (leaves_ < there.size()) leaves_ *= 2;
  nodes_.resize(2 * leaves_);
  for (std::uint32_t leaf = 0; leaf < at_leaf_.size(); ++leaf) {
    at_leaf_[leaf] = there[at_leaf_[leaf]];
    leaf_of_[at_leaf_[leaf]] = leaf;
    nodes_[leaves_ + leaf] = boxes[at_leaf_[leaf]];
  }
  for (std::size_t node = leaves_ - 1; node > 0; --node) {
    nodes_[node] = nodes_[2 * node];
    nodes_[node].extend(nodes_[2 * node + 1]);
  }
}

void TriangleBoxes::replace(std::uint32_t index, const Box3& box) {
  std::size_t node = leaves_ + leaf_of_[index];
  nodes_[node] = box;
  for (node /= 2; node > 0; node /= 2) {
    Box3 around = nodes_[2 * node];
    around.extend(nodes_[2 * node + 1]);
    if (around.lower == nodes_[node].lower && around.upper == nodes_[node].upper) return;
    nodes_[node] = around;
  }
}

StepCheck::StepCheck(const ShrinkingSurface& mesh, const Context& context)
    : mesh_(mesh),
      context_(context),
      boxes_(boxes_of(mesh), context),
      triangles_at_build_(mesh.triangles_left()),
      shell_of_(shells_of(mesh)),
      mark_(mesh.triangles().size(), 0) {
  context_.progress = {};
}

Box3 StepCheck::box_of(std::uint32_t t) const {
  Box3 box;
  if (mesh_.is_gone(t)) return box;
  for (const Vec3d& p : mesh_.corners(t)) box.extend(p);
  return box;
}

void StepCheck::update(std::span<const std::uint32_t> triangles) {
  for (const std::uint32_t t : triangles) boxes_.replace(t, box_of(t));
  // Triangles grow while others are removed. A new tree of the remaining triangles keeps queries fast.
  if (2 * mesh_.triangles_left() > triangles_at_build_) return;
  boxes_ = TriangleBoxes(boxes_of(mesh_), context_);
  triangles_at_build_ = mesh_.triangles_left();
}

bool StepCheck::is_clear(const Triangle& triangle) const {
  const ContactTriangle own = for_contact(mesh_, triangle);
  Box3 box;
  for (const Vec3d& p : own.points) box.extend(p);
  return boxes_.for_each_touching(box, [&](std::uint32_t other) {
    return mark_[other] == current_ || are_apart(own, for_contact(mesh_, mesh_.triangle(other)));
  });
}

/// Returns true if the inner triangle at a border edge turns about that edge past the outer triangle. Such a turn would
/// exchange inside and outside at the edge.
bool StepCheck::turns_over_a_neighbour(const BorderEdge& edge) const {
  const Vec3d& a = mesh_.point(edge.a);
  const Vec3d& b = mesh_.point(edge.b);
  const Vec3d& from = mesh_.point(edge.old_apex);
  const Vec3d& to = mesh_.point(edge.new_apex);
  const Vec3d& outer = mesh_.point(edge.outer_apex);
  const int way = orient3d(a, b, from, to);
  return way != 0 && orient3d(a, b, from, outer) == way && orient3d(a, b, outer, to) == way;
}

bool StepCheck::jumps_over_a_shell(const SurfaceStep& step) const {
  if (shell_of_.empty()) return false;
  const std::uint32_t own = shell_of_[step.new_triangles.front()[0]];
  for (const std::array<std::uint32_t, 4>& swept : step.swept) {
    std::array<Vec3d, 4> corners;
    Box3 box;
    for (std::size_t k = 0; k < 4; ++k) {
      corners[k] = mesh_.point(swept[k]);
      box.extend(corners[k]);
    }
    const bool none = boxes_.for_each_touching(box, [&](std::uint32_t other) {
      const Triangle& t = mesh_.triangle(other);
      return shell_of_[t[0]] == own || !(holds(corners, mesh_.point(t[0])) || holds(corners, mesh_.point(t[1])) ||
                                         holds(corners, mesh_.point(t[2])));
    });
    if (!none) return true;
  }
  return false;
}

bool StepCheck::passes(const SurfaceStep& step) {
  ++current_;
  for (const std::uint32_t t : step.old_triangles) mark_[t] = current_;
  for (const Triangle& t : step.new_triangles) {
    if (has_no_area({mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2])})) return false;
  }
  for (const BorderEdge& edge : step.border) {
    if (turns_over_a_neighbour(edge)) return false;
  }
  for (std::size_t i = 0; i < step.new_triangles.size(); ++i) {
    const ContactTriangle own = for_contact(mesh_, step.new_triangles[i]);
    for (std::size_t j = i + 1; j < step.new_triangles.size(); ++j) {
      if (!are_apart(own, for_contact(mesh_, step.new_triangles[j]))) return false;
    }
  }
  for (const Triangle& t : step.new_triangles) {
    if (!is_clear(t)) return false;
  }
  return !jumps_over_a_shell(step);
}

double fan_gap(std::span<const Vec3d> ring, const Vec3d& apex, bool closed, double enough) {
  // With two corners, both fans cover the same segment.
  if (ring.size() < 3) return 0;
  const Fans fans(ring, apex, closed);
  if (!fans.are_graphs()) return infinity;
  if (ring.size() > most_pairwise || fans.slab() <= enough) return fans.slab();
  return fans.gap();
}

bool CollapseSearch::is_needle(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
  const double height = least_height(a, b, c);
  return height < tolerance_ && height * slenderness < longest_side(a, b, c);
}

void CollapseSearch::look_at_star(std::uint32_t v) {
  mesh_.find_star(v, star_);
  const std::size_t count = star_.ring.size();
  around_.resize(count);
  sides_.resize(count);
  for (std::size_t k = 0; k < count; ++k) around_[k] = mesh_.point(star_.ring[k]) - mesh_.point(v);
  deviation_ = 0;
  least_height_ = infinity;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3d& a = around_[k];
    const Vec3d& b = around_[(k + 1) % count];
    sides_[k] = {cross(a, b), least_height({}, a, b), is_needle({}, a, b)};
    deviation_ = std::max(deviation_, deviations_[star_.triangles[k]]);
    least_height_ = std::min(least_height_, sides_[k].height);
  }
}

void CollapseSearch::choose_targets() {
  targets_.resize(around_.size());
  std::iota(targets_.begin(), targets_.end(), std::size_t{0});
  if (targets_.size() <= many_neighbours) return;
  const auto is_closer = [&](std::size_t a, std::size_t b) {
    const double first = squared_length(around_[a]);
    const double second = squared_length(around_[b]);
    return first != second ? first < second : star_.ring[a] < star_.ring[b];
  };
  std::partial_sort(targets_.begin(), targets_.begin() + targets_of_many, targets_.end(), is_closer);
  targets_.resize(targets_of_many);
}

/// Bounds a collapse in two steps. First the vertex moves onto the chord from the target to another neighbour. Then it
/// moves along the chord to the target, which changes one fan on each side of the chord. The best chord is taken.
/// @return  the bound; infinity if it is not below `limit`.
double CollapseSearch::bound_along_crease(double limit) const {
  const std::size_t count = rotated_.size();
  const double enough = negligible * tolerance_;
  double best = infinity;
  std::vector<Vec3d> other_side;
  for (std::size_t m = 1; m < count; ++m) {
    const Vec3d foot = closest_point_on_segment({}, rotated_[0], rotated_[m]);
    const double height = length(foot) + rounding * (length(rotated_[0]) + length(rotated_[m]));
    if (!(height < limit)) continue;
    const double one = fan_gap(std::span(rotated_).first(m + 1), foot, false, enough);
    if (!(height + one < limit)) continue;
    other_side.assign(1, rotated_[0]);
    for (std::size_t k = count - 1; k >= m; --k) other_side.push_back(rotated_[k]);
    const double both = height + std::max(one, fan_gap(other_side, foot, false, enough));
    if (!(both < limit)) continue;
    best = limit = both;
  }
  return best;
}

/// Returns an upper bound on how far the surface moves if the vertex is contracted onto ring corner `onto`. The bound
/// may exceed the budget.
double CollapseSearch::bound(std::size_t onto, double budget) {
  const std::size_t count = around_.size();
  rotated_.resize(count);
  for (std::size_t k = 0; k < count; ++k) rotated_[k] = around_[(onto + k) % count];
  const double enough = negligible * tolerance_;
  double best = length(rotated_[0]) * (1 + rounding);
  if (best > enough) best = std::min(best, fan_gap(rotated_, {}, true, enough));
  if (best <= enough) return best;
  return std::min(best, bound_along_crease(std::min(best, budget)));
}

/// Returns true if a triangle turns too far in a collapse.
/// @param side  index of the triangle in the star. `normal` is its normal after the collapse.
bool CollapseSearch::folds(std::uint32_t v, std::size_t side, const Vec3d& normal) const {
  if (!sides_[side].is_needle) return cosine(sides_[side].normal, normal) < least_cosine;
  const EdgePair edge = mesh_.opposite_edge(star_.triangles[side], v);
  const std::array<Vec3d, 3> beyond = mesh_.corners(edge.right);
  const Vec3d outer = cross(beyond[1] - beyond[0], beyond[2] - beyond[0]);
  const double found = cosine(outer, normal);
  return found < least_cosine_of_needle && found < cosine(outer, sides_[side].normal);
}

CollapseSearch::Shape CollapseSearch::shape(std::uint32_t v, std::size_t onto) const {
  const std::size_t count = around_.size();
  const Vec3d& w = around_[onto];
  Shape out{true, 1};
  double least = infinity;
  bool makes_needle = false;
  for (std::size_t step = 1; step + 1 < count; ++step) {
    const std::size_t side = (onto + step) % count;
    const Vec3d& a = around_[side];
    const Vec3d& b = around_[(side + 1) % count];
    const Vec3d normal = cross(a - w, b - w);
    const double longest = longest_side(w, a, b);
    const double height = longest > 0 ? length(normal) / longest : 0;
    if (!(height > 0) || folds(v, side, normal)) return {};
    least = std::min(least, height);
    makes_needle = makes_needle || is_needle(w, a, b);
    out.quality = std::min(out.quality, height / longest * (2 / std::numbers::sqrt3));
  }
  out.is_allowed = least >= least_height_ || (!makes_needle && least >= flattening * least_height_);
  return out;
}

std::span<const VertexCollapse> CollapseSearch::find(std::uint32_t v) {
  found_.clear();
  look_at_star(v);
  const double budget = tolerance_ - deviation_;
  if (star_.ring.size() < 3 || !(budget > 0)) return {};
  choose_targets();
  for (const std::size_t onto : targets_) {
    const Shape made = shape(v, onto);
    if (!made.is_allowed) continue;
    const double step = bound(onto, budget);
    const double deviation = (deviation_ + step) * (1 + rounding);
    if (!(deviation <= tolerance_)) continue;
    const double cost = deviation / tolerance_ + cost_of_shape * (1 - made.quality);
    found_.push_back({cost, deviation, star_.ring[onto], onto});
  }
  std::sort(found_.begin(), found_.end(), [](const VertexCollapse& a, const VertexCollapse& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.target < b.target;
  });
  return found_;
}

EdgeFlip CollapseSearch::find_flip(std::uint32_t t) const {
  EdgeFlip out;
  const std::array<Vec3d, 3> p = mesh_.corners(t);
  std::size_t apex = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    const auto opposite = [&](std::size_t of) { return squared_length(p[(of + 1) % 3] - p[(of + 2) % 3]); };
    if (opposite(k) > opposite(apex)) apex = k;
  }
  out.edge = mesh_.opposite_edge(t, mesh_.triangle(t)[apex]);
  const EdgePair& e = out.edge;
  const Vec3d& origin = mesh_.point(e.apex_left);
  const Vec3d a = mesh_.point(e.a) - origin;
  const Vec3d b = mesh_.point(e.b) - origin;
  const Vec3d d = mesh_.point(e.apex_right) - origin;
  // Every point of the old triangles is within `height` of the new ones, and vice versa. The flip is bounded by a move
  // of the apex onto the edge, which the apex then divides.
  const double height = length(closest_point_on_segment({}, a, b)) + rounding * (length(a) + length(b));
  out.deviation = (std::max(deviations_[e.left], deviations_[e.right]) + height) * (1 + rounding);
  out.cost = out.deviation / tolerance_ + cost_of_flip;
  if (!(out.deviation <= tolerance_) || e.apex_left == e.apex_right) return out;
  const double before = std::min(least_height({}, a, b), least_height(b, a, d));
  const double after = std::min(least_height({}, a, d), least_height(d, b, {}));
  if (!(after >= least_gain * before && after > 0)) return out;
  const Vec3d beyond = cross(a - b, d - b);
  if (!is_needle(b, a, d) &&
      (cosine(beyond, cross(a, d)) < least_cosine || cosine(beyond, cross(b - d, -d)) < least_cosine)) {
    return out;
  }
  out.is_possible = !mesh_.has_edge(e.apex_left, e.apex_right);
  return out;
}

MeshCleaner::MeshCleaner(const MeshView& mesh, double tolerance, const Context& context)
    : mesh_(mesh),
      tolerance_(tolerance),
      context_(context),
      check_(mesh_, context),
      deviations_(mesh.triangles.size(), 0.0),
      heights_(heights_of(mesh_)),
      search_(mesh_, deviations_, tolerance),
      vertex_versions_(mesh.vertices.size(), 0),
      triangle_versions_(mesh.triangles.size(), 0),
      changes_(mesh.vertices.size(), 0) {}

double MeshCleaner::deviation() const {
  double most = 0;
  for (std::uint32_t t = 0; t < deviations_.size(); ++t) {
    if (!mesh_.is_gone(t)) most = std::max(most, deviations_[t]);
  }
  return most;
}

void MeshCleaner::fill_line() {
  std::vector<double> costs(vertex_versions_.size(), infinity);
  parallel_for(context_, costs.size(), vertices_per_range, "vertices", [&](const WorkRange& range) {
    CollapseSearch search(mesh_, deviations_, tolerance_);
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const std::span<const VertexCollapse> ways = search.find(static_cast<std::uint32_t>(k));
      if (!ways.empty()) costs[k] = ways.front().cost;
    }
  });
  std::vector<Waiting> all;
  for (std::uint32_t v = 0; v < costs.size(); ++v) {
    if (costs[v] < infinity) all.push_back({costs[v], Kind::collapse, v, 0});
  }
  line_ = Line({}, std::move(all));
  for (std::uint32_t t = 0; t < heights_.size(); ++t) offer_triangle(t);
}

void MeshCleaner::run() {
  fill_line();
  do {
    while (!line_.empty()) {
      report_progress();
      const Waiting first = line_.top();
      line_.pop();
      handle(first);
    }
  } while (offer_postponed());
  if (context_.progress) context_.progress(1, "steps");
}

void MeshCleaner::report_progress() {
  if (++looks_ % looks_between_reports != 0) return;
  throw_if_cancelled(context_);
  if (!context_.progress) return;
  const auto done = static_cast<double>(looks_);
  shown_ = std::max(shown_, done / (done + static_cast<double>(line_.size())));
  context_.progress(shown_, "steps");
}

void MeshCleaner::handle(const Waiting& first) {
  const std::uint32_t version =
      first.kind == Kind::collapse ? vertex_versions_[first.index] : triangle_versions_[first.index];
  if (first.version != version) return;
  if (first.kind == Kind::collapse) {
    try_vertex(first.index);
  } else {
    try_triangle(first.index);
  }
}

bool MeshCleaner::comes_later(double cost, Kind kind, std::uint32_t index) const {
  return !line_.empty() && Waiting{cost, kind, index, 0} > line_.top();
}

void MeshCleaner::try_vertex(std::uint32_t v) {
  if (mesh_.triangles_at(v).empty()) return;
  const std::span<const VertexCollapse> ways = search_.find(v);
  if (ways.empty()) return;
  if (comes_later(ways.front().cost, Kind::collapse, v)) {
    line_.push({ways.front().cost, Kind::collapse, v, vertex_versions_[v]});
    return;
  }
  for (const VertexCollapse& way : ways) {
    if (!passes(v, search_.star(), way)) continue;
    collapse(v, VertexCollapse(way));
    return;
  }
}

bool MeshCleaner::passes(std::uint32_t v, const Star& star, const VertexCollapse& way) {
  if (!mesh_.may_collapse(star, way.onto)) return false;
  const std::size_t count = star.ring.size();
  step_.old_triangles = star.triangles;
  step_.new_triangles.clear();
  step_.swept.clear();
  step_.border.clear();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t side = (way.onto + k) % count;
    const std::uint32_t a = star.ring[side];
    const std::uint32_t b = star.ring[(side + 1) % count];
    // The two triangles at the target vanish. For their outer edges, the new apex is a corner of the new triangle that
    // takes their place.
    const std::uint32_t new_apex = k == 0           ? star.ring[(side + 2) % count]
                                   : k + 1 == count ? star.ring[(side + count - 1) % count]
                                                    : way.target;
    const std::uint32_t outer = mesh_.opposite_edge(star.triangles[side], v).apex_right;
    step_.border.push_back({a, b, v, new_apex, outer});
    if (k == 0 || k + 1 == count) continue;
    step_.new_triangles.push_back({way.target, a, b});
    step_.swept.push_back({v, way.target, a, b});
  }
  return check_.passes(step_);
}

void MeshCleaner::collapse(std::uint32_t v, const VertexCollapse& way) {
  const Star star = search_.star();
  mesh_.collapse(v, star, way.onto);
  ++vertex_versions_[v];
  ++collapses_;
  for (const std::uint32_t t : star.triangles) deviations_[t] = way.deviation;
  refresh(star.triangles, star.ring);
}

void MeshCleaner::try_triangle(std::uint32_t t) {
  if (mesh_.is_gone(t)) return;
  const EdgeFlip way = search_.find_flip(t);
  if (!way.is_possible) return;
  if (comes_later(way.cost, Kind::flip, t)) {
    line_.push({way.cost, Kind::flip, t, triangle_versions_[t]});
    return;
  }
  const EdgePair& e = way.edge;
  step_.old_triangles = {e.left, e.right};
  step_.new_triangles = {{e.apex_left, e.a, e.apex_right}, {e.apex_right, e.b, e.apex_left}};
  step_.swept = {{e.a, e.b, e.apex_left, e.apex_right}};
  const auto outer = [&](std::uint32_t of, std::uint32_t corner) { return mesh_.opposite_edge(of, corner).apex_right; };
  step_.border = {{e.apex_left, e.a, e.b, e.apex_right, outer(e.left, e.b)},
                  {e.b, e.apex_left, e.a, e.apex_right, outer(e.left, e.a)},
                  {e.a, e.apex_right, e.b, e.apex_left, outer(e.right, e.b)},
                  {e.apex_right, e.b, e.a, e.apex_left, outer(e.right, e.a)}};
  if (check_.passes(step_)) flip(way);
}

void MeshCleaner::flip(const EdgeFlip& way) {
  const EdgePair& e = way.edge;
  mesh_.flip(e);
  ++flips_;
  deviations_[e.left] = deviations_[e.right] = way.deviation;
  const std::array<std::uint32_t, 2> changed{e.left, e.right};
  const std::array<std::uint32_t, 4> corners{e.a, e.b, e.apex_left, e.apex_right};
  refresh(changed, corners);
}

/// Updates the trees and heights after a step, and queues the steps that it may have changed.
void MeshCleaner::refresh(std::span<const std::uint32_t> changed, std::span<const std::uint32_t> corners) {
  check_.update(changed);
  for (const std::uint32_t t : changed) {
    ++triangle_versions_[t];
    if (mesh_.is_gone(t)) continue;
    const std::array<Vec3d, 3> p = mesh_.corners(t);
    heights_[t] = least_height(p[0], p[1], p[2]);
  }
  for (const std::uint32_t t : changed) offer_triangle(t);
  for (const std::uint32_t v : corners) offer_changed(v);
}

bool MeshCleaner::has_many_triangles(std::uint32_t v) const {
  return mesh_.triangles_at(v).size() > many_triangles;
}

/// Queues a vertex and its triangles after some of the triangles changed. Vertices with many triangles are postponed.
void MeshCleaner::offer_changed(std::uint32_t v) {
  if (has_many_triangles(v) && ++changes_[v] * part_to_change < mesh_.triangles_at(v).size()) return;
  offer_vertex(v);
  for (const std::uint32_t t : mesh_.triangles_at(v)) offer_triangle(t);
}

/// Queues all postponed vertices.
/// @return  true if the queue is not empty.
bool MeshCleaner::offer_postponed() {
  for (std::uint32_t v = 0; v < changes_.size(); ++v) {
    if (changes_[v] > 0 && !mesh_.triangles_at(v).empty()) offer_vertex(v);
  }
  return !line_.empty();
}

/// Queues a vertex at the smallest possible cost, which is the largest deviation of its triangles so far.
void MeshCleaner::offer_vertex(std::uint32_t v) {
  changes_[v] = 0;
  double most = 0;
  for (const std::uint32_t t : mesh_.triangles_at(v)) most = std::max(most, deviations_[t]);
  line_.push({most / tolerance_, Kind::collapse, v, ++vertex_versions_[v]});
}

void MeshCleaner::offer_triangle(std::uint32_t t) {
  if (mesh_.is_gone(t) || heights_[t] >= tolerance_) return;
  line_.push({deviations_[t] / tolerance_, Kind::flip, t, ++triangle_versions_[t]});
}

}  // namespace blum::detail
