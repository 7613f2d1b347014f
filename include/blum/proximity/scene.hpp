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

/// How messages call an object, and what it is compared with. Two objects are compared where each is in a layer that
/// the other one meets, and they are not excluded (ProximityScene::exclude).
struct ObjectOptions {
  std::uint32_t layers = 1;          ///< the layers that the object is in, a bit for each
  std::uint32_t meets = 0xffffffff;  ///< the layers whose objects it is compared with
  bool self = false;                 ///< whether it is compared with itself
  std::string name = {};             ///< what messages call it, such as the name of its file; empty: "object 3"
};

template <>
struct Description<ObjectOptions> {
  static constexpr std::string_view name = "ObjectOptions";
  static constexpr std::string_view doc = "What an object of a scene is called, and compared with";
  static constexpr std::tuple members{
      Member{"layers", &ObjectOptions::layers, "bits", "the layers that the object is in, a bit for each"},
      Member{"meets", &ObjectOptions::meets, "bits", "the layers whose objects it is compared with"},
      Member{"self", &ObjectOptions::self, "", "whether it is compared with itself"},
      Member{"name", &ObjectOptions::name, "", "what messages call it; empty: its number"},
  };
};

/// How pairs that cannot count are left out. Answers are the same, to the byte.
enum class Culling : std::uint8_t {
  automatic,  ///< what is faster, as far as that is known: the hierarchy
  bvh,        ///< a hierarchy of oriented boxes over each object
  voronoi     ///< second-order Voronoi diagrams on a grid of the cells that primitives touch (Sud 2006, 4.3)
};

template <>
struct Description<Culling> {
  static constexpr std::string_view name = "Culling";
  static constexpr std::array values{NamedValue{Culling::automatic, "automatic"}, NamedValue{Culling::bvh, "bvh"},
                                     NamedValue{Culling::voronoi, "voronoi"}};
};

struct SceneOptions {
  Culling culling = Culling::automatic;
  /// Side of the cells of Voronoi culling, in parts of the mean extent of a primitive: 0.01 to 100.
  double cell_size = 2;
};

template <>
struct Description<SceneOptions> {
  static constexpr std::string_view name = "SceneOptions";
  static constexpr std::string_view doc = "How a scene finds close pairs";
  static constexpr std::tuple members{
      Member{"culling", &SceneOptions::culling, "", "how pairs that cannot count are left out: answers are the same"},
      Member{"cell_size", &SceneOptions::cell_size, "mean extents of primitives",
             "side of the cells of Voronoi culling", Range::between(0.01, 100)},
  };
};

/// @throws InvalidOption.
void check(const SceneOptions& options);

/// Whether a scene takes a transform: @throws InvalidOption for one that is not rigid to 1e-9, mirrors, or moves beyond
/// 1e70.
void check(const RigidTransform& place);

/// Two primitives, and their closest points. Primitives of an object are the triangles of its mesh, then the segments,
/// then the points, in its order.
struct PrimitivePair {
  ObjectId first_object;
  ObjectId second_object;
  std::uint32_t first = 0;  ///< primitive of the first object
  std::uint32_t second = 0;
  TriangleDistance between;  ///< a segment a, b is the triangle a, b, b; a point the one with three equal corners
};

/// What an answer took.
struct ProximityReport {
  Culling culling = Culling::bvh;  ///< what was used
  std::size_t cells = 0;           ///< of Voronoi culling
  std::size_t left_over = 0;  ///< primitives that Voronoi culling left to the hierarchy: those in large or full cells
  std::size_t object_pairs = 0;  ///< compared; an object with itself is one
  std::size_t candidates = 0;    ///< pairs of primitives that culling left over
  std::size_t exact_tests = 0;   ///< pairs whose distance was computed
  std::vector<PhaseTime> phases;
};

struct ProximityPairs {
  std::vector<PrimitivePair> pairs;
  ProximityReport report;
};

/// A part of what two solids have in common as a pair: its deepest point and the closest one to it of the other
/// surface, in the order of the objects, with the depth as a negative distance.
[[nodiscard]] PrimitivePair deepest_pair(const Penetration& part);

/// Meshes that move, deform and change, and what is close among them. A scene keeps copies of the meshes, and a
/// hierarchy over each.
///
/// Answers are those of comparing all pairs of primitives with triangle_distance(), the same bytes for any number of
/// threads, and after any updates those of a scene made anew: of pairs that are equally far apart the one with the
/// smallest (object, primitive) of the first, then of the second. Positions are those of the meshes where their
/// transforms take them, rounded to doubles.
///
/// An object compared with itself: primitives that share a vertex are left out, unless said otherwise; vertices in one
/// place are one vertex, so that a mesh need not be welded.
///
/// Messages of errors call an object by its name, in quotes; without one, "object 3".
///
/// Queries may run on many threads at once, updates not beside them. All throw Cancelled; InvalidOption for an object
/// that is not there; InvalidMesh where more than 2^29 pairs of primitives lie on each other or next to it, as of heaps
/// of equal triangles, of which all pairs would have to be looked at.
class ProximityScene {
 public:
  /// @throws InvalidOption.
  explicit ProximityScene(const SceneOptions& options = {});
  ProximityScene(ProximityScene&&) noexcept;
  ProximityScene& operator=(ProximityScene&&) noexcept;
  ~ProximityScene();

  /// @param mesh  must pass validate(mesh), with coordinates of magnitude at most 1e70, one of them at least 1e-140 (or
  /// all 0).
  /// @throws InvalidMesh; Cancelled, which leaves the scene as it was.
  /// Cost: about 0.3 microseconds per primitive.
  ObjectId add(const MeshView& mesh, const ObjectOptions& options = {}, const Context& context = {});
  void remove(ObjectId object);
  /// Another name for an object, by which messages call it: see ObjectOptions::name.
  void rename(ObjectId object, std::string name);

  /// New positions of the vertices of an object, before its transform: as many as it has.
  /// @throws InvalidMesh; Cancelled, after which the object must be updated again. Cost: a fifth of add().
  void update(ObjectId object, std::span<const Vec3d> vertices, const Context& context = {});
  /// Where the object is: at once. @throws InvalidOption for a transform that is not rigid to 1e-9, or beyond 1e70.
  void update(ObjectId object, const RigidTransform& place);
  /// Another mesh for an object, which stays where it is and is compared with what it was. As add().
  void update(ObjectId object, const MeshView& mesh, const Context& context = {});

  /// Leaves out a pair of objects, or an object with itself, whatever their layers; or takes that back.
  void exclude(ObjectId first, ObjectId second, bool is_excluded = true);

  /// How many objects were added, those that were removed included.
  [[nodiscard]] std::size_t size() const;
  /// The mesh of an object, before its transform; until the object changes.
  [[nodiscard]] MeshView mesh(ObjectId object) const;

  /// The closest pair of primitives of two objects, whatever their layers; of one object with itself, that of
  /// primitives that share no vertex. Its distance is 0 just where they meet.
  /// @return nullopt where there is no pair, or none within the distance.
  [[nodiscard]] std::optional<PrimitivePair> separation(ObjectId first, ObjectId second,
                                                        double max_distance = std::numeric_limits<double>::infinity(),
                                                        const Context& context = {}) const;
  /// The closest pair for each pair of objects that are compared, where there is one; by rising (first, second) object.
  [[nodiscard]] ProximityPairs separation(double max_distance = std::numeric_limits<double>::infinity(),
                                          const Context& context = {}) const;

  /// For each primitive of the scene the closest one that it is compared with, where there is one within a distance; by
  /// rising (object, primitive) of the first. Sud 2006, ch. 4: the N-body distance query.
  [[nodiscard]] ProximityPairs closest_primitives(double max_distance = std::numeric_limits<double>::infinity(),
                                                  const Context& context = {}) const;

  /// All pairs of primitives that are compared and no further apart than a distance; by rising (first object, first,
  /// second object, second), each once, the smaller object or primitive first.
  /// @param distance  mesh units, not negative. @throws OutOfMemory where more than 2^26 pairs are.
  [[nodiscard]] ProximityPairs closer_than(double distance, const Context& context = {}) const;

  /// All pairs of primitives that have a point in common, as closer_than(0). Of one object also those that share a
  /// vertex, and have more in common than the corner or edge that they share: triangles that are folded onto each
  /// other, or pass through each other beside it. The point told of these is a corner that they share.
  [[nodiscard]] ProximityPairs collisions(const Context& context = {}) const;

  /// All pairs of a vertex and a face, and of two edges, of objects that are compared, that meet while objects move,
  /// each with the time at which they first do: see continuous_collisions(). Objects that are not named rest. The scene
  /// stays as it is: update it with what was asked about, or with a part of it.
  /// @param motions  each object once. @throws InvalidMesh for vertices as update() does, InvalidOption; OutOfMemory
  /// where more than 2^26 pairs collide.
  [[nodiscard]] SceneCollisions continuous(std::span<const ObjectMotion> motions, const ImpactOptions& options = {},
                                           const Context& context = {}) const;

  /// What two solids have in common, and how deep they lie in each other there: nothing where they only touch. Where
  /// one lies in the other, it is deep by the largest distance of a point of it from the surface of that. Where faces
  /// of both coincide, depths depend on which object is the first, by up to a factor of 2 (docs/theory/proximity.md).
  /// With one object twice: what lies in two parts of it; parts are then those that cross each other. An object whose
  /// shells cross, touch, or lie in each other and face the same way is the union of what they bound.
  /// @throws InvalidMesh where an object is not closed, or faces inwards, or lies so far from the origin, beyond some
  /// 1e9 times its size, that its parts cannot be told apart; InvalidOption; Cancelled. Cost: about 2 microseconds for
  /// each triangle, 0.1 ms for each pair that crosses, and up to 2 s for each part in common: the more, the wider it is
  /// for its depth. An object that meets itself in a part of n triangles on s sides takes up to n s microseconds.
  /// Method: docs/theory/proximity.md.
  [[nodiscard]] Penetrations penetration(ObjectId first, ObjectId second, const PenetrationOptions& options = {},
                                         const Context& context = {}) const;

  /// The same of all pairs of objects that are compared: by rising (first, second) object, the parts of each pair as
  /// penetration() has them, to the byte.
  /// @throws as penetration(): for any object of a pair, also where the boxes of both are apart.
  /// Cost: that of penetration() for each pair whose boxes meet; else 0.3 microseconds for each triangle of an object,
  /// once. Progress is that of the pairs.
  [[nodiscard]] Penetrations penetrations(const PenetrationOptions& options = {}, const Context& context = {}) const;

  /// The distance of two solids where they are apart; 0 where they touch; minus the largest depth where they have more
  /// in common. Mesh units. As penetration(); surfaces whose boxes are apart may be open. Infinite of an object with
  /// itself that has no two primitives without a common vertex.
  [[nodiscard]] double signed_separation(ObjectId first, ObjectId second, const PenetrationOptions& options = {},
                                         const Context& context = {}) const;
  /// The same of all pairs of objects that are compared, but for objects with themselves that have no two primitives
  /// without a common vertex: the pairs of separation(), where those of solids that have
  /// something in common are the deepest_pair() of their deepest part, with a negative distance.
  /// @throws as signed_separation(). Cost: that of separation(), and of penetration() for each pair whose boxes meet.
  [[nodiscard]] ProximityPairs signed_separations(const PenetrationOptions& options = {},
                                                  const Context& context = {}) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace blum
