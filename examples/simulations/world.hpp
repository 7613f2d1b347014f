// Blum: bodies and cloth that never pass through each other, for examples. SPDX-License-Identifier: Apache-2.0
//
// Objects consist of particles that move by position-based dynamics (Müller and others 2007). Each step is checked for
// continuous collisions, and shortened before objects meet.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"
#include "blum/proximity/scene.hpp"

namespace simulations {

/// A distance that two particles keep.
struct Spring {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double length = 0;
  double stiffness = 1;  ///< 0 to 1
};

enum class Kind {
  cloth,  ///< held together by springs
  body,   ///< keeps its shape (Müller and others 2005: shape matching)
  driven  ///< moves to its goal as far as no object blocks the way
};

/// One object of a world.
struct Object {
  blum::TriangleMesh mesh;  ///< at the current position
  Kind kind = Kind::body;
  /// True if parts of the object push each other apart. All objects except driven ones, which are rigid, are checked
  /// against passing through themselves.
  bool self = false;
  double mass = 1;                ///< of each particle; driven objects do not give way
  std::vector<bool> pinned = {};  ///< fixed particles; none if empty
  std::vector<Spring> springs = {};
  std::vector<blum::Vec3d> velocity = {};
  std::vector<blum::Vec3d> rest = {};  ///< bodies: shape at rest
  std::vector<blum::Vec3d> goal = {};  ///< driven objects and pinned particles: positions after the step
  blum::ObjectId id = {};
};

struct WorldOptions {
  double step = 1.0 / 120;  ///< seconds
  double thickness = 0.01;  ///< smallest distance of surfaces, mesh units
  int iterations = 12;      ///< iterations of constraints
  double damping = 0.995;   ///< factor of velocities for each step
  double friction = 0.3;    ///< share of the velocity along a contact that is lost in each step
  blum::Vec3d gravity{0, 0, -9.8};
};

/// Times and results of one step.
struct StepReport {
  double hierarchy_seconds = 0;  ///< for boxes around moved objects
  double close_seconds = 0;      ///< for searching close pairs
  double impact_seconds = 0;     ///< for finding continuous collisions
  std::size_t close_pairs = 0;
  std::size_t impacts = 0;  ///< collisions that were prevented
  int rounds = 0;           ///< number of times that the step was shortened
  struct Impact {
    blum::Vec3d first, second;
    double time;
  };
  std::vector<Impact> shown;  ///< some of the prevented collisions, at their places
};

class World {
 public:
  explicit World(const WorldOptions& options) : options_(options) {}

  /// @return the number of the object.
  std::size_t add(Object object);
  /// Replaces an object. Its mesh may have other triangles.
  void replace(std::size_t object, Object by);

  [[nodiscard]] std::size_t size() const { return objects_.size(); }
  [[nodiscard]] bool is_there(std::size_t object) const { return objects_[object].has_value(); }
  [[nodiscard]] Object& object(std::size_t object) { return *objects_[object]; }
  [[nodiscard]] const Object& object(std::size_t object) const { return *objects_[object]; }
  [[nodiscard]] const blum::ProximityScene& scene() const { return scene_; }

  StepReport step();

  /// The number of collisions that the library finds in the motions of all steps so far. It must be 0.
  [[nodiscard]] std::size_t collisions_in_steps() const { return collisions_in_steps_; }

  /// All objects in one mesh.
  [[nodiscard]] blum::TriangleMesh mesh() const;

 private:
  /// Positions of the particles of each object after a step.
  using Positions = std::vector<std::vector<blum::Vec3d>>;
  /// Share of its way that each particle moves.
  using Shares = std::vector<std::vector<double>>;

  struct Contact;
  [[nodiscard]] Positions predicted() const;
  [[nodiscard]] std::vector<Contact> contacts(StepReport& report);
  void compare_selves(bool all);
  void satisfy(const std::vector<Contact>& contacts, Positions& to) const;
  void pull_springs(std::size_t object, std::vector<blum::Vec3d>& to) const;
  void push_apart(const Contact& contact, Positions& to) const;
  void keep_shape(std::size_t object, std::vector<blum::Vec3d>& to) const;
  void shorten(Positions& to, StepReport& report);
  void show(const blum::SceneCollisions& found, const Positions& to, StepReport& report) const;
  void limit(const blum::ObjectCollisions& pair, double part, Shares& shares) const;
  static void go_less_far(const Object& object, const std::vector<double>& shares, std::vector<blum::Vec3d>& to);
  [[nodiscard]] blum::SceneCollisions collisions(const Positions& to) const;
  void accept(const Positions& to, const std::vector<Contact>& contacts, StepReport& report);
  [[nodiscard]] double inverse_mass(std::size_t object, std::uint32_t particle) const;
  [[nodiscard]] std::optional<std::size_t> number(blum::ObjectId id) const;

  WorldOptions options_;
  std::vector<std::optional<Object>> objects_;
  blum::ProximityScene scene_;
  std::size_t collisions_in_steps_ = 0;
};

/// Springs along all edges of a mesh, and weaker ones between the two corners across each edge, against bending.
[[nodiscard]] std::vector<Spring> springs_of(const blum::TriangleMesh& mesh, double bending);

/// The rotation that best maps one set of points to another, around their means (Müller and others 2016).
[[nodiscard]] blum::Mat3 best_rotation(const std::vector<blum::Vec3d>& from, const std::vector<blum::Vec3d>& to,
                                       const blum::Vec3d& from_mean, const blum::Vec3d& to_mean);

}  // namespace simulations
