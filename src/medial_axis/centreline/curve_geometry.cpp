#include "medial_axis/centreline/curve_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "blum/core/parallel.hpp"
#include "medial_axis/centreline/curve.hpp"

namespace blum::centrelines {
namespace {

constexpr double section_blur = 1.5;    // voxels: sections closer to the ball of a junction see other branches
constexpr double pull_to_voxel = 1e-3;  // of a node, beside the pull of each branch: where all of them are parallel

/// A point and a direction.
struct Ray {
  Vec3d from;
  Vec3d along;
};

/// The point closest to all lines and, weakly, to `start`; at most `reach` from that.
Vec3d meeting_point(const std::vector<Ray>& rays, const Vec3d& start, double reach) {
  // The normal equations of sum |(I - t t')(p - q)|^2 + weight |p - start|^2, solved by Cramer's rule.
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
  shift = shift / determinant;  // the matrix is symmetric, so that its rows are its columns
  const double length = blum::length(shift);
  return length > reach ? start + (reach / length) * shift : start + shift;
}

/// The line of a branch where sections see it alone, a little outside of the ball of a node.
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

/// Mean and least radius along a branch, further than `margin` from the balls of its junctions; where there is no such
/// part, along what lies outside of the balls.
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
  /// The ball of a junction; of other nodes, none.
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
