#include <cstddef>
#include <new>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/certificate/path_certificate.hpp"
#include "blum/planning/certified_motion.hpp"
#include "blum/planning/certified_path.hpp"
#include "call.hpp"
#include "places.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

/// Poses of bodies: a row for each body.
using BodyPlacesIn = In<double, nb::shape<-1, 3, 4>>;
/// Poses of bodies at waypoints.
using PathPlacesIn = In<double, nb::shape<-1, -1, 3, 4>>;

std::vector<MeshView> views_of(const nb::list& meshes) {
  std::vector<MeshView> out;
  for (const nb::handle mesh : meshes) out.push_back(nb::cast<const MeshArrays&>(mesh).view());
  return out;
}

std::vector<Vec3d> vectors_of(const PointsIn& rows) {
  std::vector<Vec3d> out;
  for (std::size_t k = 0; k < rows.shape(0); ++k) out.push_back({rows(k, 0), rows(k, 1), rows(k, 2)});
  return out;
}

/// Reads a pose from 12 numbers, row by row.
RigidTransform place_at(const double* rows) {
  RigidTransform place;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t k = 0; k < 3; ++k) place.rotation.columns[k][row] = rows[4 * row + k];
    place.translation[row] = rows[4 * row + 3];
  }
  return place;
}

std::vector<RigidMotion> motions_of(const BodyPlacesIn& from, const BodyPlacesIn& to, const PointsIn& centres) {
  const std::vector<Vec3d> at = vectors_of(centres);
  std::vector<RigidMotion> out;
  for (std::size_t k = 0; k < at.size(); ++k) {
    out.emplace_back(place_at(from.data() + 12 * k), place_at(to.data() + 12 * k), at[k]);
  }
  return out;
}

MotionPath path_of(const PathPlacesIn& poses, const PointsIn& centres) {
  MotionPath out{.centres = vectors_of(centres), .poses = {}};
  const std::size_t bodies = poses.shape(1);
  for (std::size_t waypoint = 0; waypoint < poses.shape(0); ++waypoint) {
    std::vector<RigidTransform>& to = out.poses.emplace_back();
    for (std::size_t k = 0; k < bodies; ++k) to.push_back(place_at(poses.data() + 12 * (waypoint * bodies + k)));
  }
  return out;
}

/// Certifies a motion that a function of Python gives. The function runs in this thread, with the interpreter's lock.
CertifiedMotion certify_poses(const MotionCertifier& certifier, const nb::callable& poses_at,
                              const std::vector<double>& speeds, const std::vector<double>& errors,
                              const MotionOptions& options) {
  BoundedMotion motion;
  motion.speeds = speeds;
  motion.errors = errors;
  motion.poses_at = [&](double time, std::span<RigidTransform> poses) {
    const auto rows = nb::cast<BodyPlacesIn>(poses_at(time));
    for (std::size_t k = 0; k < poses.size(); ++k) poses[k] = place_at(rows.data() + 12 * k);
  };
  return certifier.certify(motion, options);
}

/// Numbers of poses of bodies at waypoints: x, y, z, qw, qx, qy, qz.
using PathNumbersIn = In<double, nb::shape<-1, -1, 7>>;

StatedPath stated_path_of(const PathNumbersIn& poses, const PointsIn& centres, double clearance) {
  StatedPath out{.centres = vectors_of(centres), .poses = {}, .clearance = clearance, .intervals = {}};
  for (std::size_t waypoint = 0; waypoint < poses.shape(0); ++waypoint) {
    std::vector<StatedPath::Pose>& to = out.poses.emplace_back();
    for (std::size_t body = 0; body < poses.shape(1); ++body) {
      StatedPath::Pose& pose = to.emplace_back();
      for (std::size_t k = 0; k < pose.size(); ++k) pose[k] = poses(waypoint, body, k);
    }
  }
  return out;
}

}  // namespace

void bind_planning(nb::module_& m) {
  bind_struct<PathCertificate>(m);
  m.def(
      "verify_path",
      [](const nb::list& bodies, const nb::list& obstacles, const PathNumbersIn& poses, const PointsIn& centres,
         double clearance, nb::object progress) {
        const std::vector<MeshView> first = views_of(bodies), second = views_of(obstacles);
        const StatedPath path = stated_path_of(poses, centres, clearance);
        return result_of(run({1, std::move(progress)},
                             [&](const Context& context) { return verify_path(first, second, path, context); }));
      },
      nb::arg("bodies"), nb::arg("obstacles"), nb::arg("poses"), nb::arg("centres"), nb::arg("clearance"),
      nb::arg("progress").none());
  bind_options<MotionOptions>(m);
  bind_options<PathOptions>(m);
  bind_struct<MotionPair>(m);
  bind_struct<CertifiedMotion>(m);
  bind_struct<MotionClearance>(m);
  bind_struct<MotionContact>(m);
  bind_struct<PathInterval>(m);
  bind_struct<CertifiedPath>(m);
  nb::class_<MotionCertifier>(m, "MotionCertifier")
      .def(
          "__init__",
          [](MotionCertifier* self, const nb::list& bodies, const nb::list& obstacles, int threads) {
            const std::vector<MeshView> first = views_of(bodies), second = views_of(obstacles);
            new (self) MotionCertifier(run({threads, nb::none()}, [&](const Context& context) {
              return MotionCertifier(first, second, context);
            }));
          },
          nb::arg("bodies"), nb::arg("obstacles"), nb::arg("threads"))
      .def("size", &MotionCertifier::size)
      .def("exclude", &MotionCertifier::exclude, nb::arg("body"), nb::arg("other_body"))
      .def("exclude_obstacles", &MotionCertifier::exclude_obstacles, nb::arg("body"))
      .def(
          "centre",
          [](const MotionCertifier& self, std::size_t body) {
            const Vec3d centre = self.centre(body);
            return nb::make_tuple(centre.x, centre.y, centre.z);
          },
          nb::arg("body"))
      .def(
          "certify",
          [](const MotionCertifier& self, const PlaceIn& from, const PlaceIn& to, double x, double y, double z,
             const nb::dict& given) {
            const auto options = options_from<MotionOptions>(given);
            const RigidMotion motion(place_of(from), place_of(to), {x, y, z});
            return result_of(run_brief({1, nb::none()},
                                       [&](const Context& context) { return self.certify(motion, options, context); }));
          },
          nb::arg("start"), nb::arg("goal"), nb::arg("x"), nb::arg("y"), nb::arg("z"), nb::arg("options"))
      .def(
          "certify_all",
          [](const MotionCertifier& self, const BodyPlacesIn& from, const BodyPlacesIn& to, const PointsIn& centres,
             const nb::dict& given) {
            const auto options = options_from<MotionOptions>(given);
            const std::vector<RigidMotion> motions = motions_of(from, to, centres);
            return result_of(run_brief(
                {1, nb::none()}, [&](const Context& context) { return self.certify(motions, options, context); }));
          },
          nb::arg("start"), nb::arg("goal"), nb::arg("centres"), nb::arg("options"))
      .def(
          "certify_poses",
          [](const MotionCertifier& self, const nb::callable& poses_at, const std::vector<double>& speeds,
             const std::vector<double>& errors, const nb::dict& given) {
            return result_of(certify_poses(self, poses_at, speeds, errors, options_from<MotionOptions>(given)));
          },
          nb::arg("poses_at"), nb::arg("speeds"), nb::arg("errors"), nb::arg("options"))
      .def(
          "clearance",
          [](const MotionCertifier& self, const BodyPlacesIn& from, const BodyPlacesIn& to, const PointsIn& centres,
             double tolerance) {
            const std::vector<RigidMotion> motions = motions_of(from, to, centres);
            return result_of(run({1, nb::none()},
                                 [&](const Context& context) { return self.clearance(motions, tolerance, context); }));
          },
          nb::arg("start"), nb::arg("goal"), nb::arg("centres"), nb::arg("tolerance"))
      .def(
          "first_contact",
          [](const MotionCertifier& self, const BodyPlacesIn& from, const BodyPlacesIn& to, const PointsIn& centres,
             double tolerance) -> nb::object {
            const std::vector<RigidMotion> motions = motions_of(from, to, centres);
            const auto found = run({1, nb::none()}, [&](const Context& context) {
              return self.first_contact(motions, tolerance, context);
            });
            if (!found) return nb::none();
            return result_of(*found);
          },
          nb::arg("start"), nb::arg("goal"), nb::arg("centres"), nb::arg("tolerance"))
      .def(
          "certify_path",
          [](const MotionCertifier& self, const PathPlacesIn& poses, const PointsIn& centres, const nb::dict& given,
             nb::object progress) {
            const auto options = options_from<PathOptions>(given);
            const MotionPath path = path_of(poses, centres);
            return result_of(run({1, std::move(progress)},
                                 [&](const Context& context) { return certify_path(self, path, options, context); }));
          },
          nb::arg("poses"), nb::arg("centres"), nb::arg("options"), nb::arg("progress").none());
}

}  // namespace blum::python
