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
#include "blum/proximity/first_contact.hpp"
#include "blum/proximity/impact.hpp"
#include "blum/proximity/least_translation.hpp"
#include "blum/proximity/motion.hpp"
#include "blum/proximity/penetration.hpp"

namespace blum {

/// Name of an object in messages, and selection of the objects that it is compared with. Two objects are compared if
/// the `layers` of each object have a bit in common with the `meets` of the other object. Pairs that
/// ProximityScene::exclude() excludes are not compared.
struct ObjectOptions {
  std::uint32_t layers = 1;          ///< Layers that contain the object, one bit for each layer.
  std::uint32_t meets = 0xffffffff;  ///< Layers whose objects this object is compared with, one bit for each layer.
  bool self = false;                 ///< True if the object is compared with itself.
  /// Name in messages, for example a file name. If empty, messages contain the object's number: "object 3".
  std::string name = {};
};

template <>
struct Description<ObjectOptions> {
  static constexpr std::string_view name = "ObjectOptions";
  static constexpr std::string_view doc = "Name of an object of a scene, and the objects that it is compared with";
  static constexpr std::tuple members{
      Member{"layers", &ObjectOptions::layers, "bits", "layers that contain the object, one bit for each"},
      Member{"meets", &ObjectOptions::meets, "bits", "layers whose objects this object is compared with"},
      Member{"self", &ObjectOptions::self, "", "true if the object is compared with itself"},
      Member{"name", &ObjectOptions::name, "", "name in messages; if empty, messages contain the number"},
  };
};

/// Method that excludes pairs of primitives which cannot be in the result. All methods give the same results, byte for
/// byte.
enum class Culling : std::uint8_t {
  automatic,  ///< The method that is faster in all known cases: `bvh`.
  bvh,        ///< Hierarchy of oriented boxes over each object.
  voronoi     ///< Second-order Voronoi diagrams on a grid, in the cells that primitives touch (Sud 2006, 4.3).
};

template <>
struct Description<Culling> {
  static constexpr std::string_view name = "Culling";
  static constexpr std::array values{NamedValue{Culling::automatic, "automatic"}, NamedValue{Culling::bvh, "bvh"},
                                     NamedValue{Culling::voronoi, "voronoi"}};
};

struct SceneOptions {
  Culling culling = Culling::automatic;
  /// Side of the cells of Voronoi culling, as a multiple of the mean extent of a primitive: 0.01 to 100.
  double cell_size = 2;
};

template <>
struct Description<SceneOptions> {
  static constexpr std::string_view name = "SceneOptions";
  static constexpr std::string_view doc = "Method that finds close pairs of a scene";
  static constexpr std::tuple members{
      Member{"culling", &SceneOptions::culling, "", "method that excludes distant pairs; it does not affect results"},
      Member{"cell_size", &SceneOptions::cell_size, "mean extents of primitives",
             "side of the cells of Voronoi culling", Range::between(0.01, 100)},
  };
};

/// Checks the options.
/// @throws InvalidOption if an option is out of range.
void check(const SceneOptions& options);

/// Checks that a scene accepts a transform.
/// @throws InvalidOption if the transform is not rigid to 1e-9, is a reflection, or has a translation beyond 1e70.
void check(const RigidTransform& place);

/// Two primitives and their closest points. Primitives of an object are numbered from 0: first the triangles of its
/// mesh, then the segments, then the points.
struct PrimitivePair {
  ObjectId first_object;
  ObjectId second_object;
  std::uint32_t first = 0;  ///< Number of the primitive of the first object.
  std::uint32_t second = 0;
  TriangleDistance between;  ///< Segments are treated as triangles a, b, b, and points as triangles a, a, a.
};

/// Effort of a query.
struct ProximityReport {
  Culling culling = Culling::bvh;  ///< Method that was used.
  std::size_t cells = 0;           ///< Number of cells of Voronoi culling.
  /// Number of primitives in many cells or crowded cells, which Voronoi culling left to the hierarchy of boxes.
  std::size_t left_over = 0;
  std::size_t object_pairs = 0;  ///< Number of compared pairs of objects, including objects compared with themselves.
  std::size_t candidates = 0;    ///< Number of pairs of primitives that culling did not exclude.
  std::size_t exact_tests = 0;   ///< Number of pairs whose distance was computed.
  std::vector<PhaseTime> phases;
};

struct ProximityPairs {
  std::vector<PrimitivePair> pairs;
  ProximityReport report;
};

/// Returns the deepest point of a part of an overlap, and the closest point of the other object's surface. The point of
/// the first object comes first. The distance of the returned pair is minus the depth.
[[nodiscard]] PrimitivePair deepest_pair(const Penetration& part);

/// Meshes that move, deform and change, with proximity queries between them. A scene stores a copy of each mesh, and a
/// hierarchy of boxes over the mesh.
///
/// Results equal those of an exhaustive search, which computes triangle_distance() for all pairs of primitives. Results
/// are the same bytes for any number of threads. After updates, results equal those of a new scene with the updated
/// objects. If several pairs are equally far apart, the pair with the smallest (first object, first primitive, second
/// object, second primitive) is returned. Queries use the positions of the transformed vertices, rounded to doubles.
///
/// If an object is compared with itself, queries ignore pairs of primitives that share a vertex, unless stated
/// otherwise. Vertices at the same position count as one vertex, so a mesh need not be welded.
///
/// Error messages contain the name of an object, in quotes. An object without a name is called by its number: "object
/// 3".
///
/// Several threads may call queries at the same time, but not during updates. All queries throw Cancelled, and
/// InvalidOption if an object does not exist. Queries throw InvalidMesh if more than 2^29 pairs of primitives touch, or
/// are so close that they must be compared. For example, a mesh in which many triangles coincide may have too many
/// pairs.
class ProximityScene {
 public:
  /// Constructs an empty scene.
  /// @throws InvalidOption if an option is out of range.
  explicit ProximityScene(const SceneOptions& options = {});
  ProximityScene(ProximityScene&&) noexcept;
  ProximityScene& operator=(ProximityScene&&) noexcept;
  ~ProximityScene();

  /// Adds an object.
  /// @param mesh  must pass validate(mesh).
  /// The largest magnitude of a coordinate must be 0, or from 1e-140 to 1e70.
  /// @throws InvalidMesh; Cancelled, which leaves the scene unchanged.
  /// Cost: about 0.3 microseconds per primitive.
  ObjectId add(const MeshView& mesh, const ObjectOptions& options = {}, const Context& context = {});
  void remove(ObjectId object);
  /// Changes the name of an object in messages: see ObjectOptions::name.
  void rename(ObjectId object, std::string name);

  /// Sets new positions of all vertices of an object. The positions are those before the object's transform.
  /// @throws InvalidMesh, also if the number of vertices differs. Cancelled; a cancelled object must be updated again
  /// before it is used.
  /// Cost: a fifth of that of add().
  void update(ObjectId object, std::span<const Vec3d> vertices, const Context& context = {});
  /// Replaces the transform of an object.
  /// @throws InvalidOption if the new transform is not rigid to 1e-9, is a reflection, or moves beyond 1e70.
  void update(ObjectId object, const RigidTransform& place);
  /// Replaces the mesh of an object. The transform and the options of the object do not change.
  /// @throws as add().
  void update(ObjectId object, const MeshView& mesh, const Context& context = {});

  /// Excludes a pair of objects from comparisons, whatever their layers. The two objects may be the same.
  /// @param is_excluded  false: removes an earlier exclusion of this pair.
  void exclude(ObjectId first, ObjectId second, bool is_excluded = true);

  /// Returns the number of objects that were added, including those that were removed.
  [[nodiscard]] std::size_t size() const;
  /// Returns the mesh of an object, without the object's transform. The view is valid until the object changes.
  [[nodiscard]] MeshView mesh(ObjectId object) const;

  /// Returns the closest pair of primitives of two objects, whatever their layers. If both objects are the same,
  /// returns the closest pair of primitives without a common vertex. The distance is exactly 0 if and only if the two
  /// primitives meet.
  /// @return nullopt if no pair exists, or if no pair is within max_distance.
  [[nodiscard]] std::optional<PrimitivePair> separation(ObjectId first, ObjectId second,
                                                        double max_distance = std::numeric_limits<double>::infinity(),
                                                        const Context& context = {}) const;
  /// Returns the closest pair of primitives of each compared pair of objects, by ascending (first, second) object. The
  /// result omits pairs of objects that have no two primitives within max_distance of each other.
  [[nodiscard]] ProximityPairs separation(double max_distance = std::numeric_limits<double>::infinity(),
                                          const Context& context = {}) const;

  /// Returns true if two objects meet, whatever their layers. Objects meet if a primitive of the first object and a
  /// primitive of the second object have a common point. The search stops at the first pair that meets. Only surfaces
  /// are compared, so a solid in the interior of another solid does not meet it. The answer is exact, like that of
  /// collisions(). If both objects are the same, returns true if collisions() would find a pair within the object.
  /// @throws as collisions(), except OutOfMemory.
  /// Cost: 0.2 to 30 microseconds for objects that are apart or meet in many places. Objects that are close to each
  /// other in many places take longer. Most searches for two objects allocate no memory.
  [[nodiscard]] bool meets(ObjectId first, ObjectId second, const Context& context = {}) const;
  /// Returns true if the objects of any compared pair meet. The search stops at the first pair that meets.
  /// @throws as meets() of two objects.
  [[nodiscard]] bool meets(const Context& context = {}) const;
  /// Tests the second object at each transform: entry k is 1 if it meets the first object at transforms[k], else 0.
  /// Entry k equals meets() after update(second, transforms[k]). The scene does not change.
  /// @param transforms  of the second object; each replaces the object's present transform.
  /// @throws InvalidOption if a transform is not rigid to 1e-9, is a reflection, or moves beyond 1e70. It is also
  /// thrown if both objects are the same. Otherwise as meets(). Cost: that of meets() for each transform, divided by
  /// the number of threads. A transform takes about 0.2 microseconds if the primitives that met at the previous one
  /// meet again. Progress counts the transforms.
  [[nodiscard]] std::vector<std::uint8_t> meets(ObjectId first, ObjectId second,
                                                std::span<const RigidTransform> transforms,
                                                const Context& context = {}) const;

  /// Returns a pair for each primitive of the scene: the primitive, and the closest of all primitives that it is
  /// compared with. The result omits primitives for which no compared primitive lies within max_distance. Pairs are
  /// sorted by ascending (first object, first primitive). (Sud 2006, ch. 4: the N-body distance query.)
  [[nodiscard]] ProximityPairs closest_primitives(double max_distance = std::numeric_limits<double>::infinity(),
                                                  const Context& context = {}) const;

  /// Returns all compared pairs of primitives that are at most `distance` apart. Each pair occurs once. In a pair, the
  /// object with the smaller number is first; within one object, the primitive with the smaller number is first. Pairs
  /// are sorted by ascending (first object, first primitive, second object, second primitive).
  /// @param distance  mesh units, not negative.
  /// @throws OutOfMemory if more than 2^26 pairs are found.
  [[nodiscard]] ProximityPairs closer_than(double distance, const Context& context = {}) const;

  /// Returns all compared pairs of primitives that have a point in common, as closer_than(0). Within one object, the
  /// result also contains pairs of triangles that have more in common than a shared corner or edge. Such triangles are
  /// folded onto each other, or cross away from the shared corner or edge. The point that is reported for a pair with a
  /// common vertex is a shared corner.
  [[nodiscard]] ProximityPairs collisions(const Context& context = {}) const;

  /// Returns all collisions of compared objects while objects move: pairs of a vertex and a face, and pairs of two
  /// edges. For each pair, the result contains the time of the first contact: see continuous_collisions(). Objects
  /// without a motion stay at rest. The scene does not change: call update() to move its objects.
  /// @param motions  at most one for each object.
  /// @throws InvalidMesh for vertices as update() does; InvalidOption; OutOfMemory if more than 2^26 pairs collide.
  [[nodiscard]] SceneCollisions continuous(std::span<const ObjectMotion> motions, const ImpactOptions& options = {},
                                           const Context& context = {}) const;

  /// Returns the first contact of objects that move: the earliest of all pairs that continuous() returns. Among pairs
  /// with the same time, returns the pair that continuous() lists first. The function skips later pairs.
  /// @param motions  at most one for each object.
  /// @return nullopt if nothing meets.
  /// @throws InvalidMesh for vertices as update() does; InvalidOption.
  /// Cost: see the function first_contact() (blum/proximity/first_contact.hpp).
  [[nodiscard]] std::optional<FirstContact> first_contact(std::span<const ObjectMotion> motions,
                                                          const ImpactOptions& options = {},
                                                          const Context& context = {}) const;

  /// Returns the connected parts of the overlap of two solids, with their depths. Returns no parts if the solids only
  /// touch.
  ///
  /// If one solid lies in the other, the depth is the largest distance of the inner solid's points from the outer
  /// solid's surface. If faces of both solids coincide, the order of the objects changes depths by up to a factor of 2
  /// (docs/theory/proximity.md). If both objects are the same, returns the connected regions in which the winding
  /// number of the object's surface is 2 or more. If shells of an object cross, touch, or lie in each other and face
  /// the same way, the object is the union of their solids.
  /// @throws InvalidMesh if an object is not closed, or faces inwards. Also thrown if an object is further from the
  /// origin than about 1e9 times its size: rounding then hides the object's shape. InvalidOption; Cancelled.
  /// Cost: about 2 microseconds per triangle and 0.1 ms per pair of triangles that cross. The depth of each common part
  /// takes up to 2 s, or more if the part is much wider than deep. If an object overlaps itself, a common part of n
  /// triangles, from s connected parts of the surface, takes up to n * s microseconds.
  /// Method: docs/theory/proximity.md.
  [[nodiscard]] Penetrations penetration(ObjectId first, ObjectId second, const PenetrationOptions& options = {},
                                         const Context& context = {}) const;

  /// Returns the overlaps of all compared pairs of objects, by ascending (first, second) object. The parts of each pair
  /// equal those of penetration(), byte for byte.
  /// @throws as penetration(), also for objects of pairs whose boxes are apart.
  /// Cost: that of penetration() for each pair whose boxes meet. For the objects of other pairs, the cost is only 0.3
  /// microseconds per triangle, once for each object. Progress counts the pairs.
  [[nodiscard]] Penetrations penetrations(const PenetrationOptions& options = {}, const Context& context = {}) const;

  /// Returns bounds on the length of the shortest translation of the first solid that separates it from the second. The
  /// bounds are for the whole pair, not for parts of the overlap as in penetration(). The bounds are equal, except for
  /// rounding, if both solids are convex. The bounds are 0 if the solids are apart or touch.
  /// @throws InvalidMesh as penetration(); InvalidOption, also if both objects are the same; Cancelled.
  /// Cost: see blum::least_translation().
  [[nodiscard]] LeastTranslation least_translation(ObjectId first, ObjectId second,
                                                   const TranslationOptions& options = {},
                                                   const Context& context = {}) const;

  /// Returns the signed distance of two solids, mesh units. It is positive if the solids are apart, 0 if they touch,
  /// and minus the largest depth if they overlap. If the boxes of the objects are apart, their surfaces may be open.
  /// For an object and itself, the result is infinite if every two of its primitives share a vertex.
  /// @throws as penetration().
  [[nodiscard]] double signed_separation(ObjectId first, ObjectId second, const PenetrationOptions& options = {},
                                         const Context& context = {}) const;
  /// Returns the signed distances of all compared pairs of objects. For objects that are apart or touch, the pair is
  /// that of separation(). For objects that overlap, the pair is the deepest_pair() of the deepest part, with a
  /// negative distance. An object compared with itself is left out if every two of its primitives share a vertex.
  /// @throws as signed_separation().
  /// Cost: that of separation(), plus that of penetration() for each pair whose boxes meet.
  [[nodiscard]] ProximityPairs signed_separations(const PenetrationOptions& options = {},
                                                  const Context& context = {}) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Options of a query that is called by name. A query ignores the options that its method does not take.
struct PairQueryOptions {
  double max_distance = std::numeric_limits<double>::infinity();  ///< Largest distance of a pair, mesh units.
  PenetrationOptions penetration;
};

/// Method of ProximityScene that returns pairs, for programs that call queries by name.
struct PairQuery {
  std::string_view name;  ///< of the method
  ProximityPairs (*ask)(const ProximityScene& scene, const PairQueryOptions& options, const Context& context);
};

/// Returns all queries that return pairs of a whole scene.
[[nodiscard]] std::span<const PairQuery> pair_queries();

/// Calls the query with the given name.
/// @throws InvalidOption if no query has the name; otherwise as the method of the query.
[[nodiscard]] ProximityPairs ask_pairs(const ProximityScene& scene, std::string_view query,
                                       const PairQueryOptions& options = {}, const Context& context = {});

}  // namespace blum
