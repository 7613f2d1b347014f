// Blum: bodies and cloth that never pass through each other, for examples. SPDX-License-Identifier: Apache-2.0
//
// They are made of particles, moved by position-based dynamics (Müller and others 2007). Each step is asked about with
// continuous collisions, and shortened where something would meet.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"
#include "blum/proximity/scene.hpp"

namespace simulations {

/// How far two particles of a body keep apart.
struct Spring {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double length = 0;
  double stiffness = 1;  ///< 0 to 1
};

enum class Kind {
  cloth,  ///< held together by springs
  body,   ///< keeps its shape (Müller and others 2005: shape matching)
  driven  ///< goes where it is told, as far as nothing is in the way
};

/// One object of a world.
struct Object {
  blum::TriangleMesh mesh;  ///< where it is
  Kind kind = Kind::body;
  /// Whether parts of it push each other apart. All but driven ones, which are rigid, are kept from passing through
  /// themselves.
  bool self = false;
  double mass = 1;                ///< of each particle; driven objects give way to nothing
  std::vector<bool> pinned = {};  ///< particles that stay; none where empty
  std::vector<Spring> springs = {};
  std::vector<blum::Vec3d> velocity = {};
  std::vector<blum::Vec3d> rest = {};  ///< of bodies: their shape
  std::vector<blum::Vec3d> goal = {};  ///< of driven ones, and of pinned particles: where to be after the step
  blum::ObjectId id = {};
};

struct WorldOptions {
  double step = 1.0 / 120;  ///< seconds
  double thickness = 0.01;  ///< how close surfaces come, mesh units
  int iterations = 12;      ///< of constraints
  double damping = 0.995;   ///< of velocities, a step
  double friction = 0.3;    ///< part of the velocity along a contact that it takes, a step
  blum::Vec3d gravity{0, 0, -9.8};
};

/// What one step took, and found.
struct StepReport {
  double hierarchy_seconds = 0;  ///< for boxes around what moved
  double close_seconds = 0;      ///< for close pairs
  double impact_seconds = 0;     ///< for continuous collisions
  std::size_t close_pairs = 0;
  std::size_t impacts = 0;  ///< collisions that were prevented
  int rounds = 0;           ///< how often the step was shortened
  struct Impact {
    blum::Vec3d first, second;
    double time;
  };
  std::vector<Impact> shown;  ///< some of these collisions, where they would have been
};

class World {
 public:
  explicit World(const WorldOptions& options) : options_(options) {}

  /// @return its number among the objects.
  std::size_t add(Object object);
  /// Another mesh for an object: its triangles may be others.
  void replace(std::size_t object, Object by);

  [[nodiscard]] std::size_t size() const { return objects_.size(); }
  [[nodiscard]] bool is_there(std::size_t object) const { return objects_[object].has_value(); }
  [[nodiscard]] Object& object(std::size_t object) { return *objects_[object]; }
  [[nodiscard]] const Object& object(std::size_t object) const { return *objects_[object]; }
  [[nodiscard]] const blum::ProximityScene& scene() const { return scene_; }

  StepReport step();

  /// How many collisions the library finds in all steps so far, from where objects were to where they went: none.
  [[nodiscard]] std::size_t collisions_in_steps() const { return collisions_in_steps_; }

  /// Everything in one mesh.
  [[nodiscard]] blum::TriangleMesh mesh() const;

 private:
  /// Where particles go.
  using Positions = std::vector<std::vector<blum::Vec3d>>;
  /// Which part of their way particles go.
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

/// Springs along all edges of a mesh, and between the corners across each edge, that bend it less stiffly.
[[nodiscard]] std::vector<Spring> springs_of(const blum::TriangleMesh& mesh, double bending);

/// The rotation that takes one set of points best to another, both around their means (Müller and others 2016).
[[nodiscard]] blum::Mat3 best_rotation(const std::vector<blum::Vec3d>& from, const std::vector<blum::Vec3d>& to,
                                       const blum::Vec3d& from_mean, const blum::Vec3d& to_mean);

}  // namespace simulations
