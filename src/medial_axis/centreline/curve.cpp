#include "medial_axis/centreline/curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace blum::centrelines {
namespace {

constexpr int rounds = 3;            // of moving to centroids
constexpr int smoothings = 2;        // after each
constexpr double tail = 2;           // depths from a free end: how far its width is compared
constexpr double full_depth = 0.9;   // of the largest depth there
constexpr double least_step = 1e-9;  // of the voxel

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
  /// Leaves out the points from each end on that lie in its ball; where none is left, the one in the middle stays.
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

  /// The index of a point some places on; closed curves go on from their start, others stop.
  [[nodiscard]] std::size_t on(std::size_t i, std::ptrdiff_t places) const {
    const auto count = static_cast<std::ptrdiff_t>(points_.size());
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) + places;
    if (is_closed_) return static_cast<std::size_t>(((at % count) + count) % count);
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, count - 1));
  }

  /// Each point goes half way to the middle of its neighbours, within its reach.
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

  /// The direction of the chord over about a radius to both sides.
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

  /// The first point in one direction that is so far away along the curve.
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

  /// Puts the first point, a free end, to where its ball touches the tip.
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

  /// From the first point on: where the label is as wide as behind it. What is before may lead into a corner.
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

  /// Of the sections' areas, smoothed along the curve as the points are.
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

  std::vector<Vec3d> start_;  ///< where the points came from
  std::array<CurveEnd, 2> ends_;
  const LabelShare& label_;
  double reach_;
  bool is_closed_;
  bool is_in_balls_ = false;  ///< whether all of it lies in the balls of its junctions
  std::vector<Vec3d> points_;
  std::vector<Vec3d> tangents_;
};

}  // namespace

Curve make_curve(const std::vector<Vec3d>& voxels, const std::array<CurveEnd, 2>& ends, const LabelShare& label,
                 double reach) {
  return CurveMaker(voxels, ends, label, reach).make();
}

}  // namespace blum::centrelines
