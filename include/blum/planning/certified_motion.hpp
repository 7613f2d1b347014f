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
#include "blum/geometry/triangle_distance.hpp"
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
  TriangleDistance between;
};

struct CertifiedMotion {
  MotionVerdict verdict = MotionVerdict::free;
  /// Before this time, the motion is proven to keep the clearance. 1 if it is free. 0 to 1.
  double free_until = 0;
  double time = 1;                         ///< If not free: a time at which the verdict holds.
  std::optional<MotionPair> closest = {};  ///< If not free: the closest pair at `time`.
  std::size_t tests = 0;                   ///< Poses at which distances were compared.
};

/// Certifies motions of one body among obstacles that rest. Several threads may certify motions at the same time.
///
/// Only surfaces count. A body inside the solid of an obstacle does not meet it.
///
/// Method: adaptive bisection of time. If the surfaces are further apart at the middle of an interval than the
/// clearance plus the way of every point of the body in half the interval, the interval is free (Schwarzer, Saha and
/// Latombe 2005). Rounding is part of the bound: docs/theory/planning.md.
class MotionCertifier {
 public:
  /// @param body, obstacles  must pass validate(mesh). Coordinates are of magnitude at most 1e70.
  /// @throws InvalidMesh; Cancelled. Cost: 0.3 microseconds per primitive.
  MotionCertifier(const MeshView& body, const MeshView& obstacles, const Context& context = {});
  MotionCertifier(MotionCertifier&&) noexcept;
  MotionCertifier& operator=(MotionCertifier&&) noexcept;
  ~MotionCertifier();

  /// Returns the middle of the box around the body, in its coordinates. As the centre of motions, it gives small bounds.
  [[nodiscard]] Vec3d centre() const;

  /// Returns what is proven of a motion. Of several places that are too close, it returns the first.
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
