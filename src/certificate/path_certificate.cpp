#include "blum/certificate/path_certificate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "blum/core/error.hpp"
#include "certificate/box_hierarchy.hpp"
#include "certificate/triangle_search.hpp"

namespace blum {
namespace {

using verifier::BoxHierarchy;
using Corners = std::array<Vec3d, 3>;

// Poses, as quaternions.

struct Quaternion {
  double w = 1;
  Vec3d v;

  [[nodiscard]] Quaternion inverse() const { return {w, v * -1.0}; }
  /// Returns the rotated vector.
  [[nodiscard]] Vec3d operator()(const Vec3d& p) const {
    const Vec3d t = cross(v, p) * 2.0;
    return p + t * w + cross(v, t);
  }
  friend Quaternion operator*(const Quaternion& a, const Quaternion& b) {
    return {a.w * b.w - dot(a.v, b.v), b.v * a.w + a.v * b.w + cross(a.v, b.v)};
  }
};

Quaternion quaternion_of(const StatedPath::Pose& pose) {
  const double size = std::sqrt(pose[3] * pose[3] + pose[4] * pose[4] + pose[5] * pose[5] + pose[6] * pose[6]);
  return {pose[3] / size, Vec3d{pose[4], pose[5], pose[6]} / size};
}

/// Motion of one body between two waypoints.
struct StatedMotion {
  Quaternion start;  ///< rotation at time 0
  Vec3d axis;        ///< of the rotation, in the body
  double angle = 0;  ///< of the whole rotation, 0 to pi
  Vec3d centre;      ///< in the body
  Vec3d from, to;    ///< of the centre, in the scene

  StatedMotion(const StatedPath::Pose& first, const StatedPath::Pose& last, const Vec3d& centre_)
      : start(quaternion_of(first)), centre(centre_) {
    const Quaternion end = quaternion_of(last);
    Quaternion turn = start.inverse() * end;
    if (turn.w < 0) turn = {-turn.w, turn.v * -1.0};
    const double size = length(turn.v);
    axis = size > 0 ? turn.v / size : Vec3d{0, 0, 1};
    angle = 2 * std::atan2(size, turn.w);
    from = start(centre) + Vec3d{first[0], first[1], first[2]};
    to = end(centre) + Vec3d{last[0], last[1], last[2]};
  }

  /// Writes the positions of points at a time.
  void move(std::span<const Vec3d> points, double time, std::vector<Vec3d>& out) const {
    const double half = 0.5 * angle * time;
    const Quaternion now = start * Quaternion{std::cos(half), axis * std::sin(half)};
    const Vec3d at = from + (to - from) * time;
    out.resize(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) out[k] = now(points[k] - centre) + at;
  }
};

// Distances of triangles. Segments are triangles with two equal corners, and points with three.

/// Closest points that were found, and a lower bound of the distance that does not rely on them.
struct Closeness {
  double found = HUGE_VAL;
  double at_least = 0;
  Vec3d normal;  ///< from the second to the first, of any length
};

/// Returns the closest points of two segments; parameters are clamped to the segments.
std::pair<Vec3d, Vec3d> closest_of_segments(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d u = b - a, v = d - c, w = a - c;
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
  const double determinant = uu * vv - uv * uv;
  const auto clamped = [](double x) { return std::clamp(x, 0.0, 1.0); };
  double s = determinant > 0 ? clamped((uv * vw - vv * uw) / determinant) : 0;
  const double t = vv > 0 ? clamped((uv * s + vw) / vv) : 0;
  if (uu > 0) s = clamped((uv * t - uw) / uu);
  return {a + u * s, c + v * t};
}

bool is_pierced(const Corners& triangle, const Corners& by) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d &p = by[k], &q = by[(k + 1) % 3];
    if (p == q) continue;
    if (verifier::exact_crossing(triangle[0], triangle[1], triangle[2], p, q).value_or(0) != 0) return true;
  }
  return false;
}

/// Returns the smallest height of corners of `a` above those of `b`, along a unit vector.
double height(const Corners& a, const Corners& b, const Vec3d& unit) {
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (std::size_t k = 0; k < 3; ++k) {
    lowest = std::min(lowest, dot(unit, a[k] - b[0]));
    highest = std::max(highest, dot(unit, b[k] - b[0]));
  }
  return lowest - highest;
}

Closeness closeness(const Corners& a, const Corners& b) {
  Closeness out;
  if (is_pierced(a, b) || is_pierced(b, a)) return {.found = 0, .at_least = 0, .normal = {}};
  const auto compare = [&](const Vec3d& p, const Vec3d& q) {
    const double distance = length(p - q);
    if (!(distance < out.found)) return;
    out.found = distance;
    out.normal = p - q;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    compare(a[i], verifier::closest_point(a[i], b));
    compare(verifier::closest_point(b[i], a), b[i]);
    for (std::size_t j = 0; j < 3; ++j) {
      const auto [p, q] = closest_of_segments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
      compare(p, q);
    }
  }
  if (out.found > 0) out.at_least = std::max(0.0, height(a, b, out.normal / out.found));
  return out;
}

// Meshes.

class PathMesh {
 public:
  PathMesh(const MeshView& mesh, const Context& context) : points_(mesh.vertices.begin(), mesh.vertices.end()) {
    validate(mesh);
    for (const Triangle& t : mesh.triangles) primitives_.push_back({t[0], t[1], t[2]});
    for (const Segment& s : mesh.segments) primitives_.push_back({s[0], s[1], s[1]});
    for (const std::uint32_t p : mesh.points) primitives_.push_back({p, p, p});
    std::vector<Box3> boxes;
    for (const auto& primitive : primitives_) {
      Box3 box;
      for (const std::uint32_t v : primitive) {
        box.extend(points_[v]);
        for (std::size_t axis = 0; axis < 3; ++axis) largest_ = std::max(largest_, std::abs(points_[v][axis]));
      }
      boxes.push_back(box);
    }
    if (!(largest_ <= 1e70)) throw InvalidMesh("path: a coordinate of a mesh is beyond 1e70; use other units");
    tree_ = BoxHierarchy(boxes, context);
  }

  [[nodiscard]] std::span<const Vec3d> points() const { return points_; }
  [[nodiscard]] const BoxHierarchy& tree() const { return tree_; }
  [[nodiscard]] double largest() const { return largest_; }
  /// Returns the corners of a primitive at positions of all points.
  [[nodiscard]] Corners corners(std::uint32_t primitive, std::span<const Vec3d> at) const {
    const auto& [a, b, c] = primitives_[primitive];
    return {at[a], at[b], at[c]};
  }

 private:
  std::vector<Vec3d> points_;
  std::vector<std::array<std::uint32_t, 3>> primitives_;
  BoxHierarchy tree_;
  double largest_ = 0;
};

/// A mesh at three times of an interval. Boxes of its hierarchy are those of the middle.
struct PlacedMesh {
  const PathMesh* mesh = nullptr;
  std::vector<Vec3d> first, middle, last;
  std::vector<Box3> boxes = {};  ///< for each node of the hierarchy
  double speed = 0;              ///< bound for all points, mesh units per unit of time
  double acceleration = 0;

  /// Computes the boxes of all nodes from the positions at the middle.
  void set_boxes() {
    const BoxHierarchy& tree = mesh->tree();
    boxes.resize(tree.node_count());
    for (std::uint32_t n = tree.node_count(); n-- > 0;) {  // children follow their parents
      const BoxHierarchy::Node& node = tree.node(n);
      Box3 box;
      if (node.count == 0) {
        box.extend(boxes[node.first]);
        box.extend(boxes[node.first + 1]);
      }
      for (std::uint32_t k = 0; k < node.count; ++k) {
        for (const Vec3d& p : mesh->corners(tree.order()[node.first + k], middle)) box.extend(p);
      }
      boxes[n] = box;
    }
  }
};

double gap(const Box3& a, const Box3& b) {
  return length(max(max(a.lower - b.upper, b.lower - a.upper), Vec3d{0, 0, 0}));
}

/// Calls visit(primitive of a, primitive of b) for pairs whose boxes are within a distance, until it returns false.
template <class Visit>
bool visit_near(const PlacedMesh& a, const PlacedMesh& b, double within, const Visit& visit) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    if (gap(a.boxes[i], b.boxes[j]) > within) continue;
    const BoxHierarchy::Node &first = a.mesh->tree().node(i), &second = b.mesh->tree().node(j);
    if (first.count > 0 && second.count > 0) {
      for (std::uint32_t k = 0; k < first.count; ++k) {
        for (std::uint32_t l = 0; l < second.count; ++l) {
          if (!visit(a.mesh->tree().order()[first.first + k], b.mesh->tree().order()[second.first + l])) return false;
        }
      }
      continue;
    }
    const bool splits_first = second.count > 0 || (first.count == 0 && a.boxes[i].diagonal() > b.boxes[j].diagonal());
    for (const std::uint32_t child : {0U, 1U}) {
      stack.push_back(splits_first ? std::pair(first.first + child, j) : std::pair(i, second.first + child));
    }
  }
  return true;
}

std::string text_of(double value) {
  std::array<char, 32> out{};
  std::snprintf(out.data(), out.size(), "%.9g", value);
  return out.data();
}

/// Checks a path, motion by motion.
class PathVerifier {
 public:
  PathVerifier(std::span<const MeshView> bodies, std::span<const MeshView> obstacles, const StatedPath& path,
               const Context& context)
      : path_(path), context_(context) {
    if (bodies.empty()) throw InvalidOption("path: there is no body; give the mesh of each body");
    if (bodies.size() == 1 && obstacles.empty()) {
      throw InvalidOption("path: there is one body, but no obstacle; give the meshes of the obstacles");
    }
    for (const MeshView& mesh : bodies) bodies_.emplace_back(mesh, context);
    for (const MeshView& mesh : obstacles) obstacles_.emplace_back(mesh, context);
    for (const PathMesh& mesh : obstacles_) {
      const std::vector<Vec3d> at(mesh.points().begin(), mesh.points().end());
      PlacedMesh& placed =
          placed_obstacles_.emplace_back(PlacedMesh{.mesh = &mesh, .first = at, .middle = at, .last = at});
      placed.set_boxes();
      largest_ = std::max(largest_, mesh.largest());
    }
  }

  PathCertificate run() {
    out_.clearance = path_.clearance;
    out_.edges = path_.poses.empty() ? 0 : path_.poses.size() - 1;
    if (!has_valid_poses() || !covers_all_motions()) return std::move(out_);
    const std::size_t motions = std::max<std::size_t>(out_.edges, 1);
    for (std::size_t edge = 0; edge < motions && out_.mismatches.size() < most_mismatches; ++edge) {
      throw_if_cancelled(context_);
      check_motion(edge);
      if (context_.progress) {
        context_.progress(static_cast<double>(edge + 1) / static_cast<double>(motions), "motions");
      }
    }
    out_.holds = out_.mismatches.empty();
    return std::move(out_);
  }

 private:
  static constexpr std::size_t most_mismatches = 10;
  static constexpr std::size_t most_tests = 1U << 20U;  ///< of one motion

  void refuse(std::string reason) { out_.mismatches.push_back(std::move(reason)); }

  bool has_valid_poses() {
    if (!(path_.clearance >= 0 && std::isfinite(path_.clearance))) {
      refuse("the stated clearance is " + text_of(path_.clearance) + ", but must be 0 or more");
    }
    if (path_.poses.empty()) refuse("the path has no waypoint");
    if (path_.centres.size() != bodies_.size()) {
      refuse("the path has " + std::to_string(path_.centres.size()) + " centres for " + std::to_string(bodies_.size()) +
             " bodies");
    }
    for (std::size_t k = 0; k < path_.poses.size() && out_.mismatches.size() < most_mismatches; ++k) check_waypoint(k);
    return out_.mismatches.empty();
  }

  void check_waypoint(std::size_t k) {
    const std::string name = "waypoint " + std::to_string(k);
    if (path_.poses[k].size() != bodies_.size()) {
      return refuse(name + " has " + std::to_string(path_.poses[k].size()) + " poses for " +
                    std::to_string(bodies_.size()) + " bodies");
    }
    for (const StatedPath::Pose& pose : path_.poses[k]) {
      double squared = 0;
      bool is_finite = true;
      for (std::size_t i = 0; i < pose.size(); ++i) {
        is_finite = is_finite && std::abs(pose[i]) <= 1e70;
        if (i >= 3) squared += pose[i] * pose[i];
      }
      if (!is_finite) return refuse(name + " has a number that is not finite, or beyond 1e70");
      if (!(std::abs(std::sqrt(squared) - 1) <= 1e-3)) return refuse(name + " has a quaternion whose length is not 1");
    }
    for (std::size_t body = 0; k > 0 && body < bodies_.size(); ++body) {
      if (path_.poses[k - 1].size() != bodies_.size()) return;
      const StatedMotion motion(path_.poses[k - 1][body], path_.poses[k][body], path_.centres[body]);
      if (motion.angle < 3.14159264) continue;
      refuse("body " + std::to_string(body) + " turns by 180 degrees from waypoint " + std::to_string(k - 1) + " to " +
             std::to_string(k) + ", so its direction is not defined; add a waypoint between them");
    }
  }

  /// Checks that intervals cover each motion, and that none has a smaller clearance than the path.
  bool covers_all_motions() {
    intervals_ = path_.intervals;
    const auto motions = static_cast<std::uint32_t>(std::max<std::size_t>(out_.edges, 1));
    if (intervals_.empty()) {
      for (std::uint32_t edge = 0; edge < motions; ++edge) intervals_.push_back({edge, 0, 1, path_.clearance});
    }
    std::sort(intervals_.begin(), intervals_.end(), [](const auto& a, const auto& b) {
      return std::tuple(a.edge, a.from, a.to, a.clearance) < std::tuple(b.edge, b.from, b.to, b.clearance);
    });
    std::size_t k = 0;
    for (std::uint32_t edge = 0; edge < motions; ++edge) {
      double covered = 0;
      for (; k < intervals_.size() && intervals_[k].edge == edge && intervals_[k].from <= covered; ++k) {
        covered = std::max(covered, intervals_[k].to);
      }
      if (covered >= 1 && (k == intervals_.size() || intervals_[k].edge > edge)) continue;
      refuse("the intervals of motion " + std::to_string(edge) + " do not cover its time after " + text_of(covered));
      return false;
    }
    if (k < intervals_.size()) {
      refuse("an interval belongs to motion " + std::to_string(intervals_[k].edge) + ", but the path has only " +
             std::to_string(motions));
    }
    for (const StatedPath::Interval& interval : intervals_) {
      const bool is_time = interval.from >= 0 && interval.to <= 1 && interval.from < interval.to;
      if (is_time && interval.clearance >= path_.clearance && std::isfinite(interval.clearance)) continue;
      const std::string name = "the interval from " + text_of(interval.from) + " to " + text_of(interval.to) +
                               " of motion " + std::to_string(interval.edge);
      refuse(is_time ? name + " states a clearance of " + text_of(interval.clearance) + ", but that of the path is " +
                           text_of(path_.clearance)
                     : name + " is not a part of the times from 0 to 1");
      break;
    }
    return out_.mismatches.empty();
  }

  void check_motion(std::size_t edge) {
    const std::size_t next = std::min(edge + 1, path_.poses.size() - 1);
    motions_.clear();
    placed_.assign(bodies_.size(), {});
    double largest = largest_;
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
      const StatedMotion& motion =
          motions_.emplace_back(path_.poses[edge][body], path_.poses[next][body], path_.centres[body]);
      double from_axis = 0;
      for (const Vec3d& p : bodies_[body].points()) {
        from_axis = std::max(from_axis, length(cross(motion.axis, p - motion.centre)));
      }
      PlacedMesh& placed = placed_[body];
      placed.mesh = &bodies_[body];
      placed.speed = (1 + 1e-12) * (length(motion.to - motion.from) + motion.angle * from_axis);
      placed.acceleration = (1 + 1e-12) * motion.angle * motion.angle * from_axis;
      largest = std::max({largest, 2 * bodies_[body].largest() + 2 * length(motion.centre) + length(motion.from),
                          2 * bodies_[body].largest() + 2 * length(motion.centre) + length(motion.to)});
    }
    rounding_ = 1e-14 * largest;
    largest_in_scene_ = largest;
    tests_left_ = most_tests;
    for (const StatedPath::Interval& interval : intervals_) {
      if (interval.edge != edge) continue;
      if (!check_interval(interval, interval.from, interval.to)) return;
    }
  }

  /// Returns true if an interval is proven; otherwise refuses the path.
  bool check_interval(const StatedPath::Interval& stated, double from, double to) {
    throw_if_cancelled(context_);
    ++out_.tests;
    const double middle = from + 0.5 * (to - from);
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
      motions_[body].move(bodies_[body].points(), from, placed_[body].first);
      motions_[body].move(bodies_[body].points(), middle, placed_[body].middle);
      motions_[body].move(bodies_[body].points(), to, placed_[body].last);
      placed_[body].set_boxes();
    }
    const std::optional<Failure> failure = first_failure(stated.clearance, 0.5 * (to - from));
    if (!failure) return true;
    const std::string where = "motion " + std::to_string(stated.edge) + " at time " + text_of(middle) + ": ";
    if (failure->distance < std::max(stated.clearance - allowance(stated.clearance), 0.0) || failure->distance == 0) {
      refuse(where + "the distance of body " + std::to_string(failure->body) + " and " + failure->other + " is " +
             text_of(failure->distance) + ", but the clearance must be " + text_of(stated.clearance));
      return false;
    }
    const bool is_single = middle <= from || middle >= to;
    if (is_single || tests_left_ == 0) {
      refuse(where + "the clearance of " + text_of(stated.clearance) + " could not be proven for body " +
             std::to_string(failure->body) + " and " + failure->other);
      return false;
    }
    --tests_left_;
    return check_interval(stated, from, middle) && check_interval(stated, middle, to);
  }

  struct Failure {
    std::size_t body = 0;
    std::string other;
    double distance = 0;
  };

  /// Returns the first pair that is not proven to keep a clearance during an interval.
  std::optional<Failure> first_failure(double clearance, double half) {
    for (std::size_t body = 0; body < placed_.size(); ++body) {
      for (std::size_t k = 0; k < placed_obstacles_.size(); ++k) {
        if (const auto distance = close_pair(placed_[body], placed_obstacles_[k], clearance, half)) {
          return Failure{body, "obstacle " + std::to_string(k), *distance};
        }
      }
      for (std::size_t other = 0; other < body; ++other) {
        if (const auto distance = close_pair(placed_[body], placed_[other], clearance, half)) {
          return Failure{body, "body " + std::to_string(other), *distance};
        }
      }
    }
    return std::nullopt;
  }

  /// Returns the distance of primitives that may come closer than a clearance, if any do.
  [[nodiscard]] std::optional<double> close_pair(const PlacedMesh& a, const PlacedMesh& b, double clearance,
                                                 double half) const {
    const double wanted = std::max(clearance - allowance(clearance), 0.0) + 2 * rounding_;
    const double spread = half * (a.speed + b.speed);
    // Points leave the chords of their paths by at most this distance.
    const double bulge = 0.5 * half * half * (a.acceleration + b.acceleration);
    std::optional<double> found;
    visit_near(a, b, wanted + spread, [&](std::uint32_t i, std::uint32_t j) {
      const Closeness now = closeness(a.mesh->corners(i, a.middle), b.mesh->corners(j, b.middle));
      if (now.at_least > wanted + spread) return true;
      if (now.found > 0) {
        // Heights above a fixed plane are at least those at one of the ends, for points on their chords.
        const Vec3d unit = now.normal / now.found;
        const double at_ends = std::min(height(a.mesh->corners(i, a.first), b.mesh->corners(j, b.first), unit),
                                        height(a.mesh->corners(i, a.last), b.mesh->corners(j, b.last), unit));
        if (at_ends - bulge > wanted) return true;
      }
      found = now.found;
      return false;
    });
    return found;
  }

  const StatedPath& path_;
  const Context& context_;
  std::vector<PathMesh> bodies_, obstacles_;
  std::vector<PlacedMesh> placed_, placed_obstacles_;
  std::vector<StatedMotion> motions_;
  std::vector<StatedPath::Interval> intervals_;
  /// Returns how much smaller than a stated clearance the true one may be, because of rounding.
  [[nodiscard]] double allowance(double clearance) const {
    return std::min(1e-12 * largest_in_scene_, 1e-6 * clearance);
  }

  double largest_ = 0, rounding_ = 0, largest_in_scene_ = 0;
  std::size_t tests_left_ = 0;
  PathCertificate out_;
};

}  // namespace

PathCertificate verify_path(std::span<const MeshView> bodies, std::span<const MeshView> obstacles,
                            const StatedPath& path, const Context& context) {
  return PathVerifier(bodies, obstacles, path, context).run();
}

}  // namespace blum
