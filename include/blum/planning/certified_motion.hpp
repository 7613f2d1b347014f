// Blum: motions that are proven free of contact. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <tuple>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/planning/rigid_motion.hpp"

namespace blum {

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

/// A primitive of the body, a primitive of the obstacles, and their closest points in the scene. Primitives of a mesh
/// are numbered from 0: first the triangles, then the segments, then the points.
struct MotionPair {
  std::uint32_t body = 0;
  std::uint32_t obstacle = 0;
  double distance = 0;  ///< Mesh units. 0 if and only if the primitives meet.
  Vec3d on_body;        ///< If the primitives meet, a point near both.
  Vec3d on_obstacle;
};

template <>
struct Description<MotionPair> {
  static constexpr std::string_view name = "MotionPair";
  static constexpr std::string_view doc = "Closest primitives of a moving body and of obstacles";
  static constexpr std::tuple members{
      Member{"body", &MotionPair::body, "",
             "primitive of the body: triangles are numbered first, then segments, then points"},
      Member{"obstacle", &MotionPair::obstacle, "", "primitive of the obstacles"},
      Member{"distance", &MotionPair::distance, "mesh units", "distance; 0 if and only if the primitives meet"},
      Member{"on_body", &MotionPair::on_body, "mesh units",
             "closest point of the body; if they meet, a point near both"},
      Member{"on_obstacle", &MotionPair::on_obstacle, "mesh units", "closest point of the obstacles"},
  };
};

struct CertifiedMotion {
  MotionVerdict verdict = MotionVerdict::free;
  /// Before this time, the motion is proven to keep the clearance. 1 if it is free. 0 to 1.
  double free_until = 0;
  double time = 1;                         ///< If not free: a time at which the verdict holds, 0 to 1.
  std::optional<MotionPair> closest = {};  ///< If not free: the closest pair at `time`.
  std::size_t tests = 0;                   ///< Poses at which distances were compared.
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
      Member{"tests", &CertifiedMotion::tests, "", "poses at which distances were compared"},
  };
};

/// Certifies motions of one body among obstacles that rest. Several threads may certify motions at the same time.
///
/// Only surfaces count. A body inside the solid of an obstacle does not meet it.
///
/// Method: adaptive bisection of time. The surfaces must be far apart at the middle of each interval. The distance must
/// be above the clearance plus the way of each point in half the interval (Schwarzer, Saha and Latombe 2005). Rounding
/// is part of the bound: docs/theory/planning.md.
class MotionCertifier {
 public:
  /// @param body, obstacles  must pass validate(mesh). Coordinates are of magnitude at most 1e70.
  /// @throws InvalidMesh; Cancelled. Cost: 0.3 microseconds per primitive.
  MotionCertifier(const MeshView& body, const MeshView& obstacles, const Context& context = {});
  MotionCertifier(MotionCertifier&&) noexcept;
  MotionCertifier& operator=(MotionCertifier&&) noexcept;
  ~MotionCertifier();

  /// Returns the middle of the box around the body, in its coordinates. As the centre of motions, it gives small
  /// bounds.
  [[nodiscard]] Vec3d centre() const;

  /// Returns what is proven of a motion. If several places are too close, it returns the first one.
  /// @throws InvalidOption; Cancelled.
  /// Cost: a test takes about a microsecond. A free motion needs about 2 L / d tests, for a way L of the body at a
  /// distance d. A motion that nearly touches needs up to 2 L / delta.
  [[nodiscard]] CertifiedMotion certify(const RigidMotion& motion, const MotionOptions& options = {},
                                        const Context& context = {}) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Returns what is proven of the motion of a body among obstacles that rest: see MotionCertifier.
/// @throws as MotionCertifier, and MotionCertifier::certify().
[[nodiscard]] CertifiedMotion certify_motion(const MeshView& body, const MeshView& obstacles, const RigidMotion& motion,
                                             const MotionOptions& options = {}, const Context& context = {});

}  // namespace blum
