// Blum: motions that are proven free of contact. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/rigid_transform.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/planning/rigid_motion.hpp"

namespace blum {
namespace detail {
struct Bodies;
}

/// Answer about a motion. There is no other case, and none is a guess.
enum class MotionVerdict : std::uint8_t {
  free,       ///< At all times, the surfaces are further apart than the wanted clearance.
  too_close,  ///< At `time`, the surfaces are closer than the wanted clearance plus `delta`.
  colliding   ///< At `time`, the surfaces meet: exactly, for the vertices as rounded.
};

template <>
struct Description<MotionVerdict> {
  static constexpr std::string_view name = "MotionVerdict";
  static constexpr std::array values{NamedValue{MotionVerdict::free, "free"},
                                     NamedValue{MotionVerdict::too_close, "too_close"},
                                     NamedValue{MotionVerdict::colliding, "colliding"}};
};

struct MotionOptions {
  double clearance = 0;  ///< The surfaces must stay further apart than this distance, >= 0, mesh units.
  /// A motion that comes closer than the clearance plus this distance may be too close, > 0, mesh units. If not given,
  /// it is 1e-6 of the size of the body.
  std::optional<double> delta = {};
};

template <>
struct Description<MotionOptions> {
  static constexpr std::string_view name = "MotionOptions";
  static constexpr std::string_view doc = "Clearance of a motion that must be proven";
  static constexpr std::tuple members{
      Member{"clearance", &MotionOptions::clearance, "mesh units", "distance that the surfaces must keep",
             Range::at_least(0)},
      Member{"delta", &MotionOptions::delta, "mesh units",
             "motions that come closer than the clearance plus this distance may be too close; default: 1e-6 of the "
             "size of the body",
             Range::positive()},
  };
};

/// A primitive of a moving body, and a primitive of another body or of an obstacle, with their closest points.
/// Primitives of a mesh are numbered from 0: first the triangles, then the segments, then the points.
struct MotionPair {
  std::uint32_t body = 0;                        ///< Number of the moving body, from 0.
  std::optional<std::uint32_t> other_body = {};  ///< Number of the other moving body. Nothing for an obstacle.
  std::optional<std::uint32_t> obstacle = {};    ///< Number of the obstacle, from 0. Nothing for another body.
  std::uint32_t primitive = 0;                   ///< Primitive of the moving body.
  std::uint32_t other_primitive = 0;             ///< Primitive of the other body or of the obstacle.
  double distance = 0;                           ///< Mesh units. 0 if and only if the primitives meet.
  Vec3d on_body;                                 ///< Closest point, in the scene. A point near both if they meet.
  Vec3d on_other;
};

template <>
struct Description<MotionPair> {
  static constexpr std::string_view name = "MotionPair";
  static constexpr std::string_view doc = "Closest primitives of a moving body and of another body or an obstacle";
  static constexpr std::tuple members{
      Member{"body", &MotionPair::body, "", "number of the moving body"},
      Member{"other_body", &MotionPair::other_body, "", "number of the other body; none for an obstacle"},
      Member{"obstacle", &MotionPair::obstacle, "", "number of the obstacle; none for another body"},
      Member{"primitive", &MotionPair::primitive, "",
             "primitive of the body: triangles are numbered first, then segments, then points"},
      Member{"other_primitive", &MotionPair::other_primitive, "", "primitive of the other body or of the obstacle"},
      Member{"distance", &MotionPair::distance, "mesh units", "distance; 0 if and only if the primitives meet"},
      Member{"on_body", &MotionPair::on_body, "mesh units",
             "closest point of the body; if the primitives meet, a point near both"},
      Member{"on_other", &MotionPair::on_other, "mesh units", "closest point of the other body or of the obstacle"},
  };
};

struct CertifiedMotion {
  MotionVerdict verdict = MotionVerdict::free;
  /// Before this time, the motion is proven to keep the clearance. 1 if it is free. 0 to 1.
  double free_until = 0;
  double time = 1;                         ///< If not free: a time at which the verdict holds, 0 to 1.
  std::optional<MotionPair> closest = {};  ///< If not free: the closest pair at `time`.
  std::size_t tests = 0;                   ///< Comparisons of two objects at a time.
};

template <>
struct Description<CertifiedMotion> {
  static constexpr std::string_view name = "CertifiedMotion";
  static constexpr std::string_view doc = "Answer about a motion";
  static constexpr std::tuple members{
      Member{"verdict", &CertifiedMotion::verdict, "",
             "free: it keeps the clearance at all times; too_close: at 'time', the surfaces are closer than the "
             "clearance plus delta; colliding: at 'time', they meet"},
      Member{"free_until", &CertifiedMotion::free_until, "",
             "before this time, the motion is proven to keep the clearance; 1 if it is free"},
      Member{"time", &CertifiedMotion::time, "", "if not free: a time at which the verdict holds"},
      Member{"closest", &CertifiedMotion::closest, "", "if not free: the closest pair at 'time'"},
      Member{"tests", &CertifiedMotion::tests, "", "comparisons of two objects at a time"},
  };
};

/// Bounds of the distance between surfaces during a motion.
struct MotionClearance {
  double at_least = 0;                     ///< The surfaces stay at least this far apart, mesh units. 0 if they meet.
  double at_most = 0;                      ///< Distance of the closest pair that was found, mesh units.
  double time = 0;                         ///< Time of this pair, 0 to 1.
  std::optional<MotionPair> closest = {};  ///< This pair. Nothing if no pair of objects is compared.
  std::size_t tests = 0;                   ///< Distances of two objects that were computed.
};

template <>
struct Description<MotionClearance> {
  static constexpr std::string_view name = "MotionClearance";
  static constexpr std::string_view doc = "Bounds of the distance between surfaces during a motion";
  static constexpr std::tuple members{
      Member{"at_least", &MotionClearance::at_least, "mesh units", "the surfaces stay at least this far apart"},
      Member{"at_most", &MotionClearance::at_most, "mesh units", "distance of the closest pair that was found"},
      Member{"time", &MotionClearance::time, "", "time of this pair, 0 to 1"},
      Member{"closest", &MotionClearance::closest, "", "this pair; none if no pair of objects is compared"},
      Member{"tests", &MotionClearance::tests, "", "distances of two objects that were computed"},
  };
};

/// First time at which surfaces meet during a motion.
struct MotionContact {
  double earliest = 0;  ///< Before this time, the surfaces do not meet. 0 to 1.
  /// At this time, they meet: exactly, for the vertices as rounded. Nothing if they come closer than rounding at
  /// `earliest`, and no time at which they meet was found.
  std::optional<double> latest = {};
  MotionPair pair = {};  ///< A pair that meets at `latest`; without it, the closest pair at `earliest`.
};

template <>
struct Description<MotionContact> {
  static constexpr std::string_view name = "MotionContact";
  static constexpr std::string_view doc = "First time at which surfaces meet during a motion";
  static constexpr std::tuple members{
      Member{"earliest", &MotionContact::earliest, "", "before this time, the surfaces do not meet"},
      Member{"latest", &MotionContact::latest, "",
             "at this time, they meet; none if they only come closer than rounding"},
      Member{"pair", &MotionContact::pair, "",
             "a pair that meets at 'latest'; without it, the closest pair at 'earliest'"},
  };
};

/// Poses of all bodies at each time from 0 to 1, for motions of any kind.
struct BoundedMotion {
  /// Writes the pose of each body at a time. Poses map bodies to the scene. Their rotations are replaced by the closest
  /// rotations. Their error (RigidTransform::rotation_error) must be at most 1e-9.
  std::function<void(double time, std::span<RigidTransform> poses)> poses_at;
  /// For each body: no point of the body moves faster, mesh units per unit of time.
  std::vector<double> speeds;
  /// For each body: the error of the position of each point at a pose, mesh units. If empty, it is 0. Rounding of the
  /// transformed vertices is added.
  std::vector<double> errors = {};
};

/// Certifies motions of bodies among obstacles that rest. Each body is compared with all obstacles and with the other
/// bodies. Several threads may certify motions at the same time.
///
/// Only surfaces count. A body inside the solid of an obstacle does not meet it.
///
/// Method: adaptive bisection of time. The surfaces must be far apart at the middle of each interval. The distance must
/// be above the clearance plus the displacement of each point in half the interval (Schwarzer, Saha and Latombe 2005).
/// Rounding is part of the bound: docs/theory/planning.md.
class MotionCertifier {
 public:
  /// @param body, obstacles  must pass validate(mesh). The largest magnitude of a mesh's coordinates must be 0, or from
  ///                         1e-140 to 1e70.
  /// @throws InvalidMesh; Cancelled. Cost: 0.3 microseconds per primitive.
  MotionCertifier(const MeshView& body, const MeshView& obstacles, const Context& context = {});
  /// Takes several bodies and several obstacles.
  /// @param obstacles  may be empty.
  /// @throws InvalidOption if there are no bodies, or one body and no obstacle. Otherwise as above.
  MotionCertifier(std::span<const MeshView> bodies, std::span<const MeshView> obstacles, const Context& context = {});
  MotionCertifier(MotionCertifier&&) noexcept;
  MotionCertifier& operator=(MotionCertifier&&) noexcept;
  ~MotionCertifier();

  /// Returns the number of bodies.
  [[nodiscard]] std::size_t size() const;
  /// Excludes a pair of bodies from comparisons, for example neighbouring links of an arm.
  /// @throws InvalidOption if a body does not exist, or if both are the same.
  void exclude(std::size_t body, std::size_t other_body);
  /// Excludes a body from comparisons with all obstacles, for example the base of an arm that stands on a table.
  /// @throws InvalidOption if the body does not exist.
  void exclude_obstacles(std::size_t body);

  /// Returns the middle of the box around a body, in its coordinates. As the centre of motions, it gives small bounds.
  /// @throws InvalidOption if the body does not exist.
  [[nodiscard]] Vec3d centre(std::size_t body = 0) const;

  /// Returns a proof that a motion keeps its clearance, or the first time at which it may not.
  /// @throws InvalidOption; Cancelled.
  /// Cost: a test takes about a microsecond. A free motion needs about 2 L / d tests, if the body's points move by at
  /// most L at a distance d. A motion that nearly touches needs up to 2 L / delta.
  [[nodiscard]] CertifiedMotion certify(const RigidMotion& motion, const MotionOptions& options = {},
                                        const Context& context = {}) const;
  /// @param motions  one for each body.
  [[nodiscard]] CertifiedMotion certify(std::span<const RigidMotion> motions, const MotionOptions& options = {},
                                        const Context& context = {}) const;
  [[nodiscard]] CertifiedMotion certify(const BoundedMotion& motion, const MotionOptions& options = {},
                                        const Context& context = {}) const;

  /// Returns bounds of the smallest distance during a motion.
  /// @param tolerance  largest difference of the bounds, relative to the upper one: above 0, below 1. Close to contact,
  ///                   rounding may leave a larger difference.
  /// @throws InvalidOption; Cancelled. Cost: a few times that of certify() with this clearance.
  [[nodiscard]] MotionClearance clearance(std::span<const RigidMotion> motions, double tolerance = 0.05,
                                          const Context& context = {}) const;

  /// Returns the first contact during a motion along arcs, or nothing if the surfaces never meet.
  ///
  /// It is never late: before `earliest`, the surfaces do not meet. If they come closer than rounding without meeting,
  /// `earliest` is the time of this approach, and `latest` the time of a later contact.
  /// @param tolerance  wanted difference of `earliest` and `latest`: above 0, at most 1.
  /// @throws InvalidOption; Cancelled. Cost: about 100 tests.
  [[nodiscard]] std::optional<MotionContact> first_contact(std::span<const RigidMotion> motions,
                                                           double tolerance = 1e-9, const Context& context = {}) const;

 private:
  friend class PathCertifier;
  std::unique_ptr<detail::Bodies> bodies_;
};

/// Returns what is proven of the motion of a body among obstacles that rest: see MotionCertifier.
/// @throws as MotionCertifier, and MotionCertifier::certify().
[[nodiscard]] CertifiedMotion certify_motion(const MeshView& body, const MeshView& obstacles, const RigidMotion& motion,
                                             const MotionOptions& options = {}, const Context& context = {});

}  // namespace blum
