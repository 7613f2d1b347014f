#include "blum/planning/plan.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/triangle_components.hpp"
#include "blum/geometry/winding_number.hpp"
#include "planning/path_search.hpp"

namespace blum {

bool has_path_planner() {
#ifdef BLUM_HAS_OMPL
  return true;
#else
  return false;
#endif
}

#ifndef BLUM_HAS_OMPL
namespace detail {
void set_search_seed(std::uint32_t /*seed*/) {}
FoundPath search_path(const PathSearch& /*search*/) {
  return {};
}
}  // namespace detail
#endif

namespace {

using Clock = std::chrono::steady_clock;

std::string place_text(const Vec3d& p) {
  return "(" + exact_text(p.x) + ", " + exact_text(p.y) + ", " + exact_text(p.z) + ")";
}

/// Returns a vertex of each part of a mesh.
std::vector<Vec3d> vertex_of_each_part(const MeshView& mesh) {
  const SiteTable sites(mesh);
  const detail::SurfaceComponents parts = detail::find_components(mesh, sites, detail::tally_edges(mesh, sites));
  std::vector<std::optional<Vec3d>> of_part(parts.count);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t part = parts.of_triangle[t];
    if (part != detail::no_component && !of_part[part]) of_part[part] = mesh.vertices[mesh.triangles[t][0]];
  }
  std::vector<Vec3d> out;
  for (const std::optional<Vec3d>& p : of_part) {
    if (p) out.push_back(*p);
  }
  for (const Segment& s : mesh.segments) out.push_back(mesh.vertices[s[0]]);
  for (const std::uint32_t p : mesh.points) out.push_back(mesh.vertices[p]);
  return out;
}

bool is_closed(const MeshView& mesh) {
  return !mesh.triangles.empty() && orientation(mesh, SiteTable(mesh)).closed;
}

/// Searches for paths of one body after the other.
class Planner {
 public:
  Planner(const PlanProblem& problem, const PlanOptions& options, const Context& context)
      : problem_(problem),
        options_(options),
        context_(context),
        certifier_(problem.bodies, problem.obstacles, context),
        at_(problem.start) {
    check_problem();
    for (std::size_t body = 0; body < bodies(); ++body) {
      const Vec3d centre = certifier_.centre(body);
      double size = 0;
      for (const Vec3d& p : problem.bodies[body].vertices) size = std::max(size, length(p - centre));
      centres_.push_back(centre);
      sizes_.push_back(size);
      delta_ = std::min(delta_, 2e-4 * size);
    }
    if (options.delta) delta_ = *options.delta;
    check_pose(problem.start, "start");
    check_pose(problem.goal, "goal");
    if (!options.allow_inside) {
      check_inside(problem.start, "start");
      check_inside(problem.goal, "goal");
    }
    set_bounds();
  }

  PlannedPath run() {
    detail::set_search_seed(options_.seed);
    begin_ = Clock::now();
    out_.path.centres = centres_;
    out_.path.poses.push_back(at_);
    std::vector<std::size_t> waiting;
    for (std::size_t body = 0; body < bodies(); ++body) waiting.push_back(body);
    // Each round gives every waiting body an equal part of the time, twice as much as the round before.
    double slice = bodies() == 1 ? options_.time : std::min(0.5, options_.time / static_cast<double>(2 * bodies()));
    while (!waiting.empty() && left() > 0) {
      const std::size_t before = waiting.size();
      std::erase_if(waiting,
                    [&](std::size_t body) { return left() > 0 && moves_to_goal(body, std::min(slice, left())); });
      if (waiting.size() == before) slice *= 2;
    }
    throw_if_cancelled(context_);
    out_.seconds = seconds();
    out_.is_found = waiting.empty() && prove();
    if (!out_.is_found) out_.path = {};
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::size_t bodies() const { return problem_.bodies.size(); }
  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  [[nodiscard]] double left() const { return context_.cancel.stop_requested() ? 0 : options_.time - seconds(); }

  void check_problem() const {
    if (!has_path_planner()) {
      throw InvalidOption(
          "this build contains no search for paths; install libompl-dev and build again with -DBLUM_OMPL=ON, or use "
          "blum.plan() of the Python package");
    }
    if (problem_.start.size() != bodies() || problem_.goal.size() != bodies()) {
      throw InvalidOption("plan: there are " + std::to_string(problem_.start.size()) + " starts and " +
                          std::to_string(problem_.goal.size()) + " goals for " + std::to_string(bodies()) +
                          " bodies; give one of each for each body");
    }
    if (!(options_.time > 0 && std::isfinite(options_.time))) {
      throw InvalidOption("plan: time must be positive, not " + exact_text(options_.time));
    }
  }

  /// Returns motions of which only that of one body moves.
  [[nodiscard]] std::vector<RigidMotion> motions(std::size_t body, const RigidTransform& from,
                                                 const RigidTransform& to) const {
    std::vector<RigidMotion> out;
    for (std::size_t k = 0; k < bodies(); ++k) {
      out.emplace_back(k == body ? from : at_[k], k == body ? to : at_[k], centres_[k]);
    }
    return out;
  }

  void check_pose(const std::vector<RigidTransform>& poses, const std::string& name) const {
    std::vector<RigidMotion> rest;
    for (std::size_t k = 0; k < bodies(); ++k) rest.emplace_back(poses[k], poses[k], centres_[k]);
    const CertifiedMotion found =
        certifier_.certify(rest, {.clearance = options_.clearance, .delta = delta_}, context_);
    if (found.verdict == MotionVerdict::free) return;
    const MotionPair& pair = *found.closest;
    const std::string other = pair.obstacle ? "obstacle " + std::to_string(*pair.obstacle)
                                            : "body " + std::to_string(pair.other_body.value_or(0));
    throw InvalidOption("plan: at the " + name + ", body " + std::to_string(pair.body) + " " +
                        (pair.distance == 0
                             ? "meets " + other
                             : "is too close to " + other + ": their distance is " + exact_text(pair.distance) +
                                   ", but must be above " + exact_text(options_.clearance + delta_) +
                                   ", the clearance and delta,") +
                        " at " + place_text(pair.on_body) + "; choose another " + name);
  }

  /// A mesh of the problem at a pose.
  struct Placed {
    const MeshView& mesh;
    RigidTransform pose;
    std::string name;
    bool moves;
  };
  [[nodiscard]] std::vector<Placed> placed(const std::vector<RigidTransform>& poses) const {
    std::vector<Placed> out;
    for (std::size_t k = 0; k < bodies(); ++k) {
      out.push_back({problem_.bodies[k], poses[k], "body " + std::to_string(k), true});
    }
    for (std::size_t k = 0; k < problem_.obstacles.size(); ++k) {
      out.push_back({problem_.obstacles[k], {}, "obstacle " + std::to_string(k), false});
    }
    return out;
  }

  /// Rejects poses at which a mesh is inside the solid of another one: no path leads out of it.
  void check_inside(const std::vector<RigidTransform>& poses, const std::string& name) const {
    const std::vector<Placed> all = placed(poses);
    for (const Placed& solid : all) {
      if (!is_closed(solid.mesh)) continue;
      const WindingNumber winding(solid.mesh, context_);
      const RigidTransform to_solid = solid.pose.inverse();
      for (const Placed& other : all) {
        if (&other == &solid || !(other.moves || solid.moves)) continue;
        for (const Vec3d& p : vertex_of_each_part(other.mesh)) {
          const Vec3d at = other.pose(p);
          // The number is -1 in solids that face inwards.
          if (!(std::abs(winding.estimate(to_solid(at), 0.1).value) > 0.5)) continue;
          throw InvalidOption("plan: at the " + name + ", " + other.name + " is inside the solid of " + solid.name +
                              " at " + place_text(at) + "; choose another " + name +
                              ", or allow it for a solid that is a room (allow_inside)");
        }
      }
    }
  }

  void set_bounds() {
    if (problem_.bounds) {
      bounds_ = *problem_.bounds;
      for (std::size_t k = 0; k < bodies(); ++k) {
        for (const RigidTransform* pose : {&problem_.start[k], &problem_.goal[k]}) {
          if (bounds_.contains((*pose)(centres_[k]))) continue;
          throw InvalidOption("plan: the centre of body " + std::to_string(k) + " is at " +
                              place_text((*pose)(centres_[k])) +
                              " at its start or goal, which is outside the bounds; give larger bounds");
        }
      }
      return;
    }
    for (const MeshView& mesh : problem_.obstacles) {
      for (const Vec3d& p : mesh.vertices) bounds_.extend(p);
    }
    for (std::size_t k = 0; k < bodies(); ++k) {
      bounds_.extend(problem_.start[k](centres_[k]));
      bounds_.extend(problem_.goal[k](centres_[k]));
    }
    const double margin = 2 * *std::max_element(sizes_.begin(), sizes_.end());
    bounds_.lower -= Vec3d{margin, margin, margin};
    bounds_.upper += Vec3d{margin, margin, margin};
  }

  /// Searches for a path of one body to its goal. If there is one, the body moves along it.
  bool moves_to_goal(std::size_t body, double time) {
    const MotionOptions wanted{.clearance = options_.clearance, .delta = delta_};
    const Clock::time_point end =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time));
    const auto free_until = [&](const RigidTransform& from, const RigidTransform& to) {
      return certifier_.certify(motions(body, from, to), wanted).free_until;
    };
    const auto stops = [&] {
      report_progress();
      return context_.cancel.stop_requested() || Clock::now() >= end;
    };
    const detail::FoundPath found = detail::search_path({.centre = centres_[body],
                                                         .start = at_[body],
                                                         .goal = problem_.goal[body],
                                                         .bounds = bounds_,
                                                         .size = sizes_[body],
                                                         .time = time,
                                                         .planner = options_.planner,
                                                         .free_until = free_until,
                                                         .stops = stops});
    out_.states += found.states;
    if (found.poses.empty()) return false;
    for (std::size_t k = 1; k < found.poses.size(); ++k) {
      at_[body] = found.poses[k];
      out_.path.poses.push_back(at_);
    }
    out_.order.push_back(body);
    return true;
  }

  void report_progress() {
    if (!context_.progress) return;
    const double share = std::min(seconds() / options_.time, 1.0);
    if (share < reported_ + 0.005) return;
    reported_ = share;
    context_.progress(share, "search");
  }

  /// Adds a waypoint to motions with turns of almost 180 degrees: the direction of a half turn would not be defined.
  void split_half_turns() {
    constexpr double most = 3.14;
    std::vector<std::vector<RigidTransform>>& poses = out_.path.poses;
    for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
      std::vector<RigidTransform> middle;
      bool turns_far = false;
      for (std::size_t body = 0; body < bodies(); ++body) {
        const RigidMotion motion(poses[k][body], poses[k + 1][body], centres_[body]);
        turns_far = turns_far || motion.angle() > most;
        middle.push_back(pose_of(numbers_of(motion.at(0.5))));
      }
      if (turns_far) poses.insert(poses.begin() + static_cast<std::ptrdiff_t>(k) + 1, middle);
    }
  }

  /// Certifies the whole path, as written: with poses that were converted to numbers and back.
  bool prove() {
    for (std::vector<RigidTransform>& waypoint : out_.path.poses) {
      for (RigidTransform& pose : waypoint) pose = pose_of(numbers_of(pose));
    }
    split_half_turns();
    out_.proof = certify_path(certifier_, out_.path, {.clearance = options_.clearance, .delta = delta_ / 2}, context_);
    return out_.proof.verdict == MotionVerdict::free;
  }

  const PlanProblem& problem_;
  const PlanOptions& options_;
  const Context& context_;
  MotionCertifier certifier_;
  std::vector<RigidTransform> at_;  ///< poses of the bodies now
  std::vector<Vec3d> centres_;
  std::vector<double> sizes_;
  double delta_ = HUGE_VAL;
  Box3 bounds_;
  Clock::time_point begin_ = Clock::now();
  double reported_ = 0;
  PlannedPath out_;
};

}  // namespace

PlannedPath plan_path(const PlanProblem& problem, const PlanOptions& options, const Context& context) {
  return Planner(problem, options, context).run();
}

}  // namespace blum
