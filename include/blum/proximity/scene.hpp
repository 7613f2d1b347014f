// Blum: proximity among the objects of a scene. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/geometry/rigid_transform.hpp"
#include "blum/geometry/triangle_distance.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/proximity/impact.hpp"
#include "blum/proximity/motion.hpp"
#include "blum/proximity/penetration.hpp"

namespace blum {

/// Name of an object in messages, and the objects that it is compared with. Two objects are compared if each is in a
/// layer that the other one meets, and the pair is not excluded (ProximityScene::exclude).
struct ObjectOptions {
  std::uint32_t layers = 1;          ///< Layers that contain the object, one bit for each.
  std::uint32_t meets = 0xffffffff;  ///< Layers whose objects it is compared with.
  bool self = false;                 ///< True if it is compared with itself.
  std::string name = {};             ///< Name in messages, for example of its file; empty: "object 3".
};

template <>
struct Description<ObjectOptions> {
  static constexpr std::string_view name = "ObjectOptions";
  static constexpr std::string_view doc = "Name of an object of a scene, and the objects that it is compared with";
  static constexpr std::tuple members{
      Member{"layers", &ObjectOptions::layers, "bits", "layers that contain the object, a bit for each"},
      Member{"meets", &ObjectOptions::meets, "bits", "layers whose objects it is compared with"},
      Member{"self", &ObjectOptions::self, "", "true if it is compared with itself"},
      Member{"name", &ObjectOptions::name, "", "name in messages; if empty, its number"},
  };
};

/// Method that excludes pairs that cannot count. Results are the same, to the byte.
enum class Culling : std::uint8_t {
  automatic,  ///< The faster one, as far as known: the hierarchy.
  bvh,        ///< Hierarchy of oriented boxes over each object.
  voronoi     ///< Second-order Voronoi diagrams on a grid of the cells that primitives touch (Sud 2006, 4.3).
};

template <>
struct Description<Culling> {
  static constexpr std::string_view name = "Culling";
  static constexpr std::array values{NamedValue{Culling::automatic, "automatic"}, NamedValue{Culling::bvh, "bvh"},
                                     NamedValue{Culling::voronoi, "voronoi"}};
};

struct SceneOptions {
  Culling culling = Culling::automatic;
  /// Side of the cells of Voronoi culling, in mean extents of a primitive: 0.01 to 100.
  double cell_size = 2;
};

template <>
struct Description<SceneOptions> {
  static constexpr std::string_view name = "SceneOptions";
  static constexpr std::string_view doc = "Method that finds close pairs of a scene";
  static constexpr std::tuple members{
      Member{"culling", &SceneOptions::culling, "", "method that excludes pairs; results are the same"},
      Member{"cell_size", &SceneOptions::cell_size, "mean extents of primitives",
             "side of the cells of Voronoi culling", Range::between(0.01, 100)},
  };
};

/// Checks options.
/// @throws InvalidOption if one is out of range.
void check(const SceneOptions& options);

/// Checks that a scene accepts a transform.
/// @throws InvalidOption if it is not rigid to 1e-9, is a reflection, or moves beyond 1e70.
void check(const RigidTransform& place);

/// Two primitives and their closest points. Primitives of an object are the triangles of its mesh, then the segments,
/// then the points, in its order.
struct PrimitivePair {
  ObjectId first_object;
  ObjectId second_object;
  std::uint32_t first = 0;  ///< Primitive of the first object.
  std::uint32_t second = 0;
  TriangleDistance between;  ///< A segment a, b counts as the triangle a, b, b, and a point as three equal corners.
};

/// Effort of a query.
struct ProximityReport {
  Culling culling = Culling::bvh;  ///< Method that was used.
  std::size_t cells = 0;           ///< Cells of Voronoi culling.
  std::size_t left_over = 0;  ///< Primitives that Voronoi culling left to the hierarchy: those in large or full cells.
  std::size_t object_pairs = 0;  ///< Compared pairs; an object with itself is one.
  std::size_t candidates = 0;    ///< Pairs of primitives that culling did not exclude.
  std::size_t exact_tests = 0;   ///< Pairs whose distance was computed.
  std::vector<PhaseTime> phases;
};

struct ProximityPairs {
  std::vector<PrimitivePair> pairs;
  ProximityReport report;
};

/// Returns the deepest point of a part of an overlap and the closest point of the other surface. Both are in the order
/// of the objects. The distance is the negative depth.
[[nodiscard]] PrimitivePair deepest_pair(const Penetration& part);

/// Meshes that move, deform and change, with queries of proximity among them. A scene keeps copies of the meshes, and a
/// hierarchy over each.
///
/// Results are those of comparing all pairs of primitives with triangle_distance(). They are the same bytes for any
/// number of threads, and after any updates those of a new scene. If pairs are equally far apart, the one with the
/// smallest (object, primitive) of the first, then of the second, is returned. Positions are those of the transformed
/// meshes, rounded to doubles.
///
/// If an object is compared with itself, primitives that share a vertex are left out, unless stated otherwise. Vertices
/// in one place are one vertex, so a mesh need not be welded.
///
/// Error messages contain the name of an object, in quotes; without one, "object 3".
///
/// Queries may run on many threads at once, but not during updates. All throw Cancelled, and InvalidOption if an object
/// does not exist. They throw InvalidMesh if more than 2^29 pairs of primitives touch or are next to each other, as in
/// heaps of equal triangles. All these pairs would have to be compared.
class ProximityScene {
 public:
  /// Constructs an empty scene.
  /// @throws InvalidOption if an option is out of range.
  explicit ProximityScene(const SceneOptions& options = {});
  ProximityScene(ProximityScene&&) noexcept;
  ProximityScene& operator=(ProximityScene&&) noexcept;
  ~ProximityScene();

  /// Adds an object.
  /// @param mesh  must pass validate(mesh). Its coordinates must be of magnitude at most 1e70, one of them at least
  ///              1e-140 (or all 0).
  /// @throws InvalidMesh; Cancelled, which leaves the scene unchanged.
  /// Cost: about 0.3 microseconds per primitive.
  ObjectId add(const MeshView& mesh, const ObjectOptions& options = {}, const Context& context = {});
  void remove(ObjectId object);
  /// Changes the name of an object in messages: see ObjectOptions::name.
  void rename(ObjectId object, std::string name);

  /// Sets new positions of the vertices of an object, before its transform: as many as it has.
  /// @throws InvalidMesh; Cancelled, after which the object must be updated again.
  /// Cost: a fifth of add().
  void update(ObjectId object, std::span<const Vec3d> vertices, const Context& context = {});
  /// Sets the transform of an object, immediately.
  /// @throws InvalidOption if it is not rigid to 1e-9, is a reflection, or moves beyond 1e70.
  void update(ObjectId object, const RigidTransform& place);
  /// Replaces the mesh of an object. Its transform and options stay.
  /// @throws as add().
  void update(ObjectId object, const MeshView& mesh, const Context& context = {});

  /// Excludes a pair of objects, or an object with itself, whatever their layers; or includes it again.
  void exclude(ObjectId first, ObjectId second, bool is_excluded = true);

  /// Returns the number of objects that were added, including removed ones.
  [[nodiscard]] std::size_t size() const;
  /// Returns the mesh of an object, before its transform. Valid until the object changes.
  [[nodiscard]] MeshView mesh(ObjectId object) const;

  /// Returns the closest pair of primitives of two objects, whatever their layers. For one object with itself, it is
  /// the closest pair without a common vertex. The distance is 0 exactly if they meet.
  /// @return nullopt if no pair exists, or none within the distance.
  [[nodiscard]] std::optional<PrimitivePair> separation(ObjectId first, ObjectId second,
                                                        double max_distance = std::numeric_limits<double>::infinity(),
                                                        const Context& context = {}) const;
  /// Returns the closest pair, if any, of each compared pair of objects, by ascending (first, second) object.
  [[nodiscard]] ProximityPairs separation(double max_distance = std::numeric_limits<double>::infinity(),
                                          const Context& context = {}) const;

  /// Returns for each primitive of the scene the closest one that it is compared with, if one is within a distance.
  /// Pairs are sorted by ascending (object, primitive) of the first. (Sud 2006, ch. 4: the N-body distance query.)
  [[nodiscard]] ProximityPairs closest_primitives(double max_distance = std::numeric_limits<double>::infinity(),
                                                  const Context& context = {}) const;

  /// Returns all compared pairs of primitives that are at most a distance apart. Each pair occurs once, with the
  /// smaller object or primitive first. Pairs are sorted by ascending (first object, first, second object, second).
  /// @param distance  mesh units, not negative.
  /// @throws OutOfMemory if more than 2^26 pairs are found.
  [[nodiscard]] ProximityPairs closer_than(double distance, const Context& context = {}) const;

  /// Returns all pairs of primitives that have a point in common, as closer_than(0). For one object, it also returns
  /// triangles that share a vertex and have more in common than the shared corner or edge. Such triangles are folded
  /// onto each other, or pass through each other beside it. The point reported for these is a shared corner.
  [[nodiscard]] ProximityPairs collisions(const Context& context = {}) const;

  /// Returns all pairs of a vertex and a face, and of two edges, of compared objects that meet while objects move. Each
  /// pair has the time at which it first meets: see continuous_collisions(). Objects without a motion rest. The scene
  /// is not changed: update it with the motion, or with a part of it.
  /// @param motions  each object once.
  /// @throws InvalidMesh for vertices as update() does; InvalidOption; OutOfMemory if more than 2^26 pairs collide.
  [[nodiscard]] SceneCollisions continuous(std::span<const ObjectMotion> motions, const ImpactOptions& options = {},
                                           const Context& context = {}) const;

  /// Returns the overlap of two solids and its depths; nothing if they only touch.
  ///
  /// If one solid lies in the other, the depth is the largest distance of one of its points from the other's surface.
  /// If faces of both coincide, depths depend on which object is first, by up to a factor of 2
  /// (docs/theory/proximity.md). If both objects are the same, returns the overlaps of parts of it, which are then the
  /// parts that cross each other. An object whose shells cross, touch, or lie in each other and face the same way is
  /// the union of the solids that they bound.
  /// @throws InvalidMesh if an object is not closed, or faces inwards. Also if it is so far from the origin that its
  /// parts cannot be distinguished, beyond some 1e9 times its size. InvalidOption; Cancelled.
  /// Cost: about 2 microseconds per triangle and 0.1 ms per crossing pair. Each common part takes up to 2 s, more if it
  /// is wide for its depth. An object that meets itself in a part of n triangles on s sides takes up to n s
  /// microseconds.
  /// Method: docs/theory/proximity.md.
  [[nodiscard]] Penetrations penetration(ObjectId first, ObjectId second, const PenetrationOptions& options = {},
                                         const Context& context = {}) const;

  /// Returns the overlaps of all compared pairs of objects, by ascending (first, second) object. The parts of each pair
  /// are those of penetration(), to the byte.
  /// @throws as penetration(): for any object of a pair, even if the boxes of both are apart.
  /// Cost: that of penetration() for each pair whose boxes meet; otherwise 0.3 microseconds per triangle of an object,
  /// once. Progress counts the pairs.
  [[nodiscard]] Penetrations penetrations(const PenetrationOptions& options = {}, const Context& context = {}) const;

  /// Returns the signed distance of two solids, mesh units. It is their distance if they are apart, 0 if they touch,
  /// and minus the largest depth if they overlap. Surfaces whose boxes are apart may be open. Infinite for an object
  /// with itself without two primitives that share no vertex.
  /// @throws as penetration().
  [[nodiscard]] double signed_separation(ObjectId first, ObjectId second, const PenetrationOptions& options = {},
                                         const Context& context = {}) const;
  /// Returns the signed distances of all compared pairs of objects. They are the pairs of separation(), except that
  /// those of overlapping solids are the deepest_pair() of their deepest part, with a negative distance. Objects with
  /// themselves without two primitives that share no vertex are left out.
  /// @throws as signed_separation().
  /// Cost: that of separation(), and of penetration() for each pair whose boxes meet.
  [[nodiscard]] ProximityPairs signed_separations(const PenetrationOptions& options = {},
                                                  const Context& context = {}) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Options of a query that is called by name. Each query uses those that its method has.
struct PairQueryOptions {
  double max_distance = std::numeric_limits<double>::infinity();  ///< Largest distance of a pair, mesh units.
  PenetrationOptions penetration;
};

/// Method of ProximityScene that returns pairs, for front ends that call queries by name.
struct PairQuery {
  std::string_view name;  ///< of the method
  ProximityPairs (*ask)(const ProximityScene& scene, const PairQueryOptions& options, const Context& context);
};

/// Returns all queries of a whole scene that return pairs.
[[nodiscard]] std::span<const PairQuery> pair_queries();

/// Calls the query of this name. @throws InvalidOption if no query has the name; else as the method.
[[nodiscard]] ProximityPairs ask_pairs(const ProximityScene& scene, std::string_view query,
                                       const PairQueryOptions& options = {}, const Context& context = {});

}  // namespace blum
