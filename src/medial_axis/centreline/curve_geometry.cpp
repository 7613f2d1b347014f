#include "medial_axis/centreline/curve_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/core/vec3.hpp"
#include "medial_axis/centreline/sections.hpp"

namespace blum::centrelines {
namespace {

/// End of a curve.
struct CurveEnd {
  enum class Kind : std::uint8_t { free, junction, closed };
  Kind kind = Kind::free;
  Vec3d centre{};     ///< centre of a junction's ball
  double radius = 0;  ///< radius of a junction's ball
};

/// Points of a curve outside of the balls of its junctions: at least one. The last point of a closed curve is also its
/// first.
struct Curve {
  std::vector<Vec3d> points;
  std::vector<double> radii;  ///< for each point: radius of the circle with the area of the section there
};

constexpr int rounds = 3;            // number of times that the points are moved to the centroids of sections
constexpr int smoothings = 2;        // number of smoothing steps before each round
constexpr double tail = 2;           // multiples of the depth: length of the part at a free end that is examined
constexpr double full_depth = 0.9;   // relative to the largest depth in that part
constexpr double least_step = 1e-9;  // relative to the shortest side of a voxel

class CurveMaker {
 public:
  CurveMaker(const std::vector<Vec3d>& voxels, const std::array<CurveEnd, 2>& ends, const LabelShare& label,
             double reach)
      : start_(voxels), ends_(ends), label_(label), reach_(reach), is_closed_(ends[0].kind == CurveEnd::Kind::closed) {
    if (is_closed_) start_.pop_back();
    leave_balls();
    points_ = start_;
  }

  Curve make() {
    for (int round = 0; round < rounds; ++round) {
      for (int s = 0; s < smoothings; ++s) smooth();
      recentre();
    }
    smooth();
    Curve out;
    find_tangents();
    if (!is_closed_) {
      if (ends_[0].kind == CurveEnd::Kind::free) place_end();
      if (ends_[1].kind == CurveEnd::Kind::free) {
        std::reverse(points_.begin(), points_.end());
        place_end();
        std::reverse(points_.begin(), points_.end());
      }
      find_tangents();
    }
    out.radii = radii();
    out.points = points_;
    if (is_closed_) {
      out.points.push_back(out.points.front());
      out.radii.push_back(out.radii.front());
    }
    return out;
  }

 private:
  /// Removes the points that lie in the balls of the junctions at the ends. If all points lie in the balls, the middle
  /// point stays.
  void leave_balls() {
    std::size_t first = 0;
    std::size_t last = start_.size();
    const auto is_in = [&](const Vec3d& point, const CurveEnd& end) {
      return end.kind == CurveEnd::Kind::junction && length(point - end.centre) < end.radius;
    };
    while (first < last && is_in(start_[first], ends_[0])) ++first;
    while (last > first && is_in(start_[last - 1], ends_[1])) --last;
    if (first == last) {
      first = start_.size() / 2;
      last = first + 1;
      is_in_balls_ = true;
    }
    start_ = std::vector<Vec3d>(start_.begin() + static_cast<std::ptrdiff_t>(first),
                                start_.begin() + static_cast<std::ptrdiff_t>(last));
  }

  /// Returns the index of the point that is `places` points after point i. Indices of closed curves wrap around;
  /// indices of other curves stop at the ends.
  [[nodiscard]] std::size_t on(std::size_t i, std::ptrdiff_t places) const {
    const auto count = static_cast<std::ptrdiff_t>(points_.size());
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) + places;
    if (is_closed_) return static_cast<std::size_t>(((at % count) + count) % count);
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, count - 1));
  }

  /// Moves each point half way to the midpoint of its two neighbours, but not further than `reach_` from its voxel.
  void smooth() {
    std::vector<Vec3d> next = points_;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!is_closed_ && (i == 0 || i + 1 == points_.size())) continue;
      next[i] = within_reach(i, 0.5 * points_[i] + 0.25 * (points_[on(i, -1)] + points_[on(i, 1)]));
    }
    points_ = std::move(next);
  }

  [[nodiscard]] Vec3d within_reach(std::size_t i, const Vec3d& point) const {
    const Vec3d off = point - start_[i];
    const double distance = length(off);
    return distance > reach_ ? start_[i] + (reach_ / distance) * off : point;
  }

  /// Computes tangents. The tangent at a point is the direction of a chord. Its ends are about as far from the point,
  /// along the curve, as the point is deep.
  void find_tangents() {
    tangents_.resize(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double wanted = std::max(2 * label_.step(), label_.depth(points_[i]));
      const std::size_t before = walk(i, -1, wanted);
      const std::size_t after = walk(i, 1, wanted);
      const Vec3d chord = points_[after] - points_[before];
      const double size = length(chord);
      tangents_[i] = size > least_step * label_.step() ? chord / size : Vec3d{1, 0, 0};
    }
  }

  /// Returns the first point in one direction whose distance along the curve is at least `wanted`. If the curve ends
  /// before this distance, or after a quarter of a closed curve, returns the last point reached.
  [[nodiscard]] std::size_t walk(std::size_t i, std::ptrdiff_t step, double wanted) const {
    double way = 0;
    std::size_t at = i;
    for (std::size_t steps = 0; way < wanted && steps < points_.size() / (is_closed_ ? 4 : 1); ++steps) {
      const std::size_t next = on(at, step);
      if (next == at) break;
      way += length(points_[next] - points_[at]);
      at = next;
    }
    return at;
  }

  void recentre() {
    if (is_in_balls_) return;
    find_tangents();
    std::vector<Vec3d> next = points_;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Section section = label_.section(points_[i], tangents_[i]);
      next[i] = within_reach(i, section.centroid);
    }
    points_ = std::move(next);
  }

  /// Moves the first point, a free end, so that the ball around it touches the tip of the label.
  void place_end() {
    if (points_.size() < 3) return;
    const std::size_t root = end_of_tail();
    const std::size_t inner = walk(root, 1, std::max(3 * label_.step(), 1.5 * label_.depth(points_[root])));
    const Vec3d chord = points_[root] - points_[inner];
    const double size = length(chord);
    if (!(size > label_.step())) return;
    const Vec3d outward = chord / size;
    const double radius = radius_of(label_.section(points_[root], outward).area);
    const double most = 4 * radius + 4 * label_.step();
    const double tip = label_.way_out(points_[root], outward, most);
    if (tip >= most) return;
    std::vector<Vec3d> kept(points_.begin() + static_cast<std::ptrdiff_t>(root), points_.end());
    const double beyond = tip - radius;
    if (beyond > 0.25 * label_.step()) {
      const Vec3d end = points_[root] + beyond * outward;
      const Vec3d off = label_.section(end, outward).centroid - end;
      const double distance = length(off);
      kept.insert(kept.begin(), distance > reach_ ? end + (reach_ / distance) * off : end + off);
    }
    points_ = std::move(kept);
  }

  /// Returns the first point whose depth is at least `full_depth` times the largest depth near the free end. Points
  /// before the returned point may lead into a corner of the label.
  [[nodiscard]] std::size_t end_of_tail() const {
    double deepest = 0;
    double way = 0;
    for (std::size_t i = 0; i + 2 < points_.size() && way <= tail * deepest + reach_; ++i) {
      deepest = std::max(deepest, label_.depth(points_[i]));
      way += length(points_[i + 1] - points_[i]);
    }
    std::size_t root = 0;
    while (root + 3 < points_.size() && label_.depth(points_[root]) < full_depth * deepest) ++root;
    return root;
  }

  [[nodiscard]] static double radius_of(double area) { return std::sqrt(area / std::numbers::pi); }

  /// Returns, for each point, the radius of the circle that has the same area as the cross-section at the point. The
  /// areas are smoothed along the curve in the same way as the points.
  std::vector<double> radii() const {
    std::vector<double> areas(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double depth = label_.depth(points_[i]);
      areas[i] = is_in_balls_ ? std::numbers::pi * depth * depth : label_.section(points_[i], tangents_[i]).area;
    }
    for (int s = 0; s < smoothings; ++s) {
      std::vector<double> next = areas;
      for (std::size_t i = 0; i < areas.size(); ++i) {
        next[i] = 0.5 * areas[i] + 0.25 * (areas[on(i, -1)] + areas[on(i, 1)]);
      }
      areas = std::move(next);
    }
    for (double& area : areas) area = radius_of(area);
    return areas;
  }

  std::vector<Vec3d> start_;  ///< the points before they were moved
  std::array<CurveEnd, 2> ends_;
  const LabelShare& label_;
  double reach_;
  bool is_closed_;
  bool is_in_balls_ = false;  ///< true if the whole curve lies in the balls of its junctions
  std::vector<Vec3d> points_;
  std::vector<Vec3d> tangents_;
};

/// @param voxels  centres of the voxels of a chain, from end to end.
/// @param reach   greatest distance of a point from its voxel's centre.
Curve make_curve(const std::vector<Vec3d>& voxels, const std::array<CurveEnd, 2>& ends, const LabelShare& label,
                 double reach) {
  return CurveMaker(voxels, ends, label, reach).make();
}

// Voxels: sections this close to the ball of a junction also contain other branches.
constexpr double section_blur = 1.5;
// Weight of a node's voxel, relative to a branch. The weight determines the result if all branches are parallel.
constexpr double pull_to_voxel = 1e-3;

/// Point and direction.
struct Ray {
  Vec3d from;
  Vec3d along;
};

/// Returns the point with the least sum of squared distances from all lines and, with a small weight, from `start`. It
/// is at most `reach` away from `start`.
Vec3d meeting_point(const std::vector<Ray>& rays, const Vec3d& start, double reach) {
  // Normal equations of sum |(I - t t')(p - q)|^2 + weight |p - start|^2, solved by Cramer's rule.
  std::array<Vec3d, 3> rows{Vec3d{pull_to_voxel, 0, 0}, Vec3d{0, pull_to_voxel, 0}, Vec3d{0, 0, pull_to_voxel}};
  Vec3d right{};
  for (const Ray& ray : rays) {
    const Vec3d off = ray.from - start;
    right += off - dot(off, ray.along) * ray.along;
    for (std::size_t a = 0; a < 3; ++a) {
      rows[a][a] += 1;
      rows[a] -= ray.along[a] * ray.along;
    }
  }
  const double determinant = dot(rows[0], cross(rows[1], rows[2]));
  Vec3d shift{dot(right, cross(rows[1], rows[2])), dot(right, cross(rows[2], rows[0])),
              dot(right, cross(rows[0], rows[1]))};
  shift = shift / determinant;  // the matrix is symmetric: its rows are its columns
  const double length = blum::length(shift);
  return length > reach ? start + (reach / length) * shift : start + shift;
}

/// Returns the line through points 3 and 10 of a branch, counted from a node. Cross-sections between these points
/// contain no other branch.
std::optional<Ray> ray_at(const Curve& curve, bool at_end) {
  constexpr std::size_t first = 3;
  constexpr std::size_t last = 10;
  const std::size_t count = curve.points.size();
  if (count < 3) return std::nullopt;
  const auto point = [&](std::size_t i) { return curve.points[at_end ? count - 1 - i : i]; };
  const Vec3d from = point(std::min(first, count / 2));
  const Vec3d to = point(std::min(last, count - 1));
  const double length = blum::length(to - from);
  if (!(length > 0)) return std::nullopt;
  return Ray{from, (to - from) / length};
}

/// Computes the mean and least radius of the part of a branch that is further than `margin` from the balls of its
/// junctions. If there is no such part, it uses all points of the curve.
void measure_radii(const Curve& curve, const std::array<CurveEnd, 2>& ends, double margin, CentrelineBranch& branch) {
  const auto is_free = [&](const Vec3d& point) {
    return std::none_of(ends.begin(), ends.end(), [&](const CurveEnd& end) {
      return end.kind == CurveEnd::Kind::junction && length(point - end.centre) < end.radius + margin;
    });
  };
  double way = 0;
  double sum = 0;
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    if (!is_free(curve.points[i])) continue;
    least = std::min(least, curve.radii[i]);
    if (i == 0 || !is_free(curve.points[i - 1])) continue;
    const double piece = length(curve.points[i] - curve.points[i - 1]);
    way += piece;
    sum += piece * (curve.radii[i] + curve.radii[i - 1]) / 2;
  }
  if (!(way > 0) && margin > 0) return measure_radii(curve, ends, -HUGE_VAL, branch);
  branch.min_radius = least;
  branch.mean_radius = way > 0 ? sum / way : curve.radii.front();
}

class Placer {
 public:
  Placer(const CurveGraph& graph, const ChainMeasure& measure, const LabelShare& label, const Context& context)
      : graph_(graph), measure_(measure), label_(label), context_(context), curves_(graph.chains.size()) {}

  void place(Centreline& out) {
    parallel_for(context_, graph_.chains.size(), 16, "centrelines", [&](const WorkRange& range) {
      for (std::size_t c = range.begin; c < range.end; ++c) curves_[c] = curve_of(graph_.chains[c]);
    });
    out.nodes.resize(graph_.nodes.size());
    for (std::size_t n = 0; n < graph_.nodes.size(); ++n) out.nodes[n] = node_of(n);
    out.branches.resize(graph_.chains.size());
    for (std::size_t c = 0; c < graph_.chains.size(); ++c) out.branches[c] = branch_of(c, out.nodes);
  }

 private:
  [[nodiscard]] bool is_free(std::int32_t node) const {
    return node != no_node && graph_.nodes[static_cast<std::size_t>(node)].chains.size() == 1;
  }
  /// Returns the kind of a curve's end at a node and, for a junction, its ball.
  [[nodiscard]] CurveEnd end_of(std::int32_t node) const {
    if (node == no_node) return {CurveEnd::Kind::closed, {}, 0};
    const std::uint32_t voxel = graph_.nodes[static_cast<std::size_t>(node)].voxel;
    if (is_free(node)) return {CurveEnd::Kind::free, measure_.position(voxel), 0};
    return {CurveEnd::Kind::junction, measure_.position(voxel), measure_.depth[voxel]};
  }

  Curve curve_of(const Chain& chain) const {
    std::vector<Vec3d> voxels;
    voxels.reserve(chain.voxels.size());
    for (const std::uint32_t voxel : chain.voxels) voxels.push_back(measure_.position(voxel));
    return make_curve(voxels, {end_of(chain.nodes[0]), end_of(chain.nodes[1])}, label_, measure_.voxel());
  }

  CentrelineNode node_of(std::size_t n) const {
    const ChainNode& node = graph_.nodes[n];
    const Vec3d start = measure_.position(node.voxel);
    if (node.chains.empty()) {
      return {CentrelineNodeKind::point, start, measure_.depth[node.voxel]};
    }
    if (node.chains.size() == 1) {
      const Chain& chain = graph_.chains[node.chains.front()];
      const Curve& curve = curves_[node.chains.front()];
      const bool at_end = chain.nodes[0] != static_cast<std::int32_t>(n);
      return {CentrelineNodeKind::end, at_end ? curve.points.back() : curve.points.front(),
              at_end ? curve.radii.back() : curve.radii.front()};
    }
    std::vector<Ray> rays;
    for (std::size_t k = 0; k < node.chains.size(); ++k) {
      const std::uint32_t c = node.chains[k];
      const bool is_loop = graph_.chains[c].nodes[0] == graph_.chains[c].nodes[1];
      const bool is_second =
          is_loop && std::find(node.chains.begin(), node.chains.begin() + static_cast<std::ptrdiff_t>(k), c) !=
                         node.chains.begin() + static_cast<std::ptrdiff_t>(k);
      const bool at_end = is_loop ? is_second : graph_.chains[c].nodes[0] != static_cast<std::int32_t>(n);
      if (const auto ray = ray_at(curves_[c], at_end)) rays.push_back(*ray);
    }
    const Vec3d position = meeting_point(rays, start, measure_.voxel());
    return {CentrelineNodeKind::junction, position, std::max(label_.depth(position), 0.5 * label_.step())};
  }

  CentrelineBranch branch_of(std::size_t c, const std::vector<CentrelineNode>& nodes) const {
    const Chain& chain = graph_.chains[c];
    const Curve& curve = curves_[c];
    CentrelineBranch branch;
    branch.nodes = chain.nodes;
    measure_radii(curve, {end_of(chain.nodes[0]), end_of(chain.nodes[1])}, section_blur * measure_.voxel(), branch);
    const auto add_node = [&](std::int32_t node) {
      if (node == no_node || is_free(node)) return;
      branch.points.push_back(nodes[static_cast<std::size_t>(node)].position);
      branch.radii.push_back(nodes[static_cast<std::size_t>(node)].radius);
    };
    add_node(chain.nodes[0]);
    branch.points.insert(branch.points.end(), curve.points.begin(), curve.points.end());
    branch.radii.insert(branch.radii.end(), curve.radii.begin(), curve.radii.end());
    add_node(chain.nodes[1]);
    for (std::size_t i = 1; i < branch.points.size(); ++i) {
      branch.length += length(branch.points[i] - branch.points[i - 1]);
    }
    return branch;
  }

  const CurveGraph& graph_;
  const ChainMeasure& measure_;
  const LabelShare& label_;
  const Context& context_;
  std::vector<Curve> curves_;
};

}  // namespace

void place_curves(const CurveGraph& graph, const ChainMeasure& measure, const LabelShare& label, Centreline& out,
                  const Context& context) {
  Placer(graph, measure, label, context).place(out);
}

}  // namespace blum::centrelines
