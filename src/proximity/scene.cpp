#include "blum/proximity/scene.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/proximity/continuous_collisions.hpp"
#include "blum/proximity/first_contact.hpp"
#include "blum/proximity/motion.hpp"
#include "proximity/first_search.hpp"
#include "proximity/impact_search.hpp"
#include "proximity/least_translation.hpp"
#include "proximity/meets.hpp"
#include "proximity/scene_object.hpp"
#include "proximity/scene_pairs.hpp"
#include "proximity/scene_penetration.hpp"
#include "proximity/scene_voronoi.hpp"

namespace blum::detail {
namespace {

/// The motions of the objects of a scene.
class SceneMotion {
 public:
  /// @param objects  number of objects. An object without a motion is at rest.
  explicit SceneMotion(std::size_t objects) : ends_(objects) {}

  /// @throws InvalidMesh
  /// @throws InvalidOption if the object already has a motion.
  void add(const SceneObject& object, const ObjectMotion& motion, const Context& context);

  /// See ProximityScene::continuous().
  /// @param pairs  the compared pairs of objects.
  [[nodiscard]] SceneCollisions collisions(std::span<const TwoObjects> pairs, const ImpactOptions& options,
                                           const Context& context) const;

  /// See ProximityScene::first_contact().
  [[nodiscard]] std::optional<FirstContact> first(std::span<const TwoObjects> pairs, const ImpactOptions& options,
                                                  const Context& context) const;

 private:
  /// For each object that moves: its vertices at the end, in scene coordinates.
  std::vector<std::optional<std::vector<Vec3d>>> ends_;
};

/// @throws InvalidMesh if the vertices at the end are not valid. Its message contains the name of the object.
void check_end(const SceneObject& object, const ObjectMotion& motion, const Context& context) {
  try {
    object.check_positions(motion.vertices, context);
  } catch (const InvalidMesh& error) {
    throw InvalidMesh(name_of(motion.object, object) + " at the end: " + error.what());
  }
}

/// The objects of a scene between two frames, with copies of their data.
class MovingObjects {
 public:
  /// @param ends  for each object that moves: its vertices at the end, in scene coordinates.
  MovingObjects(std::span<const TwoObjects> pairs, const std::vector<std::optional<std::vector<Vec3d>>>& ends,
                double min_separation)
      : objects_(ends.size()), min_separation_(min_separation) {
    for (const TwoObjects& pair : pairs) {
      add(pair.first, *pair.a, ends[pair.first.value]);
      add(pair.second, *pair.b, ends[pair.second.value]);
    }
  }

  /// Returns a box around all features of an object, whose sides are moved outwards by half of the separation.
  [[nodiscard]] MovingBox grown_box(ObjectId id) const {
    MovingBox out = box(id);
    grow(out, min_separation_);
    return out;
  }

  /// Returns true if the boxes around the whole motions of two objects are within the separation of each other.
  [[nodiscard]] bool are_close(ObjectId a, ObjectId b) const {
    return box_gap(swept(box(a)), swept(box(b))) <= min_separation_;
  }

  /// Returns an object with its hierarchies. They are built on the first call.
  [[nodiscard]] const MovingObject& object(ObjectId id, const Context& context) {
    Moving& one = *objects_[id.value];
    if (!one.object) one.object.emplace(one.mesh, one.end, min_separation_, context);
    return *one.object;
  }

 private:
  struct Moving {
    TriangleMesh mesh;
    std::vector<Vec3d> end;
    MovingBox box;
    std::optional<MovingObject> object;
  };

  [[nodiscard]] const MovingBox& box(ObjectId id) const { return objects_[id.value]->box; }

  static Box3 swept(const MovingBox& box) {
    Box3 out = box.start;
    out.extend(box.end);
    return out;
  }

  void add(ObjectId id, const SceneObject& object, const std::optional<std::vector<Vec3d>>& end) {
    std::optional<Moving>& one = objects_[id.value];
    if (one) return;
    one.emplace();
    one->mesh = object.mesh();
    one->mesh.vertices = object.positions();
    one->end = end.value_or(one->mesh.vertices);
    for_each_named_vertex(one->mesh, [&](std::uint32_t v) {
      one->box.start.extend(one->mesh.vertices[v]);
      one->box.end.extend(one->end[v]);
    });
  }

  std::vector<std::optional<Moving>> objects_;
  double min_separation_;
};

void SceneMotion::add(const SceneObject& object, const ObjectMotion& motion, const Context& context) {
  std::optional<std::vector<Vec3d>>& end = ends_[motion.object.value];
  if (end) throw InvalidOption(name_of(motion.object, object) + " has two motions; give at most one");
  if (motion.place) check(*motion.place);
  if (!motion.vertices.empty()) check_end(object, motion, context);
  const std::span<const Vec3d> vertices = motion.vertices.empty() ? object.mesh().vertices : motion.vertices;
  end = SceneObject::positions(vertices, motion.place.value_or(object.place()));
}

SceneCollisions SceneMotion::collisions(std::span<const TwoObjects> pairs, const ImpactOptions& options,
                                        const Context& context) const {
  SceneCollisions out;
  PhaseTimer timer(out.phases);
  MovingObjects moving(pairs, ends_, options.min_separation);
  timer.lap("objects");
  ImpactSearch search(options, context);
  for (const TwoObjects& pair : pairs) {
    if (!moving.are_close(pair.first, pair.second)) continue;
    ObjectCollisions found{pair.first, pair.second, {}, {}, {}};
    const MovingObject& a = moving.object(pair.first, context);
    const MovingObject& b = moving.object(pair.second, context);
    found.vertex_face = search.vertices_and_faces(a, b);
    if (pair.first != pair.second) found.face_vertex = search.vertices_and_faces(b, a);
    found.edge_edge = search.edges_and_edges(a, b);
    const bool is_empty = found.vertex_face.empty() && found.face_vertex.empty() && found.edge_edge.empty();
    if (!is_empty) out.objects.push_back(std::move(found));
  }
  timer.lap("features");
  out.box_pairs = search.box_pairs();
  out.exact_tests = search.exact_tests();
  return out;
}

std::optional<FirstContact> SceneMotion::first(std::span<const TwoObjects> pairs, const ImpactOptions& options,
                                               const Context& context) const {
  MovingObjects moving(pairs, ends_, options.min_separation);
  FirstSearch search(options, context);
  std::vector<std::pair<double, const TwoObjects*>> order;  // objects that may meet early come first
  for (const TwoObjects& pair : pairs) {
    order.emplace_back(search.bound(moving.grown_box(pair.first), moving.grown_box(pair.second)), &pair);
  }
  std::sort(order.begin(), order.end());  // equal bounds stay in the order of the pairs
  for (const auto& [bound, pair] : order) {
    if (search.is_hopeless(pair->first, pair->second, bound)) continue;
    search.add(pair->first, moving.object(pair->first, context), pair->second, moving.object(pair->second, context));
  }
  return search.result();
}

}  // namespace
}  // namespace blum::detail

namespace blum {
namespace {

using detail::ObjectPair;
using detail::SceneObject;
using detail::TwoObjects;

constexpr double infinite = std::numeric_limits<double>::infinity();

void check_distance(const char* what, double distance) {
  if (distance >= 0) return;
  throw InvalidOption(std::string(what) + " is " + exact_text(distance) + ", but must be a number of at least 0");
}

/// Calls change(), which may reject a mesh or vertices of an object. Messages of its exceptions then begin with the
/// object's name, if it has one.
template <class Change>
void change_named(const std::string& name, const Change& change) {
  if (name.empty()) return change();
  try {
    change();
  } catch (const InvalidMesh& error) {
    throw InvalidMesh("'" + name + "': " + error.what());
  }
}

}  // namespace

std::optional<double> ObjectCollisions::earliest() const {
  std::optional<double> first;
  const auto look_at = [&](const auto& collisions) {
    for (const auto& one : collisions) {
      if (!first || one.time < *first) first = one.time;
    }
  };
  look_at(vertex_face);
  look_at(face_vertex);
  look_at(edge_edge);
  return first;
}

std::optional<double> SceneCollisions::earliest() const {
  std::optional<double> first;
  for (const ObjectCollisions& pair : objects) {
    const std::optional<double> time = pair.earliest();
    if (time && (!first || *time < *first)) first = time;
  }
  return first;
}

std::vector<Warning> start_warnings(const SceneCollisions& found) {
  std::size_t count = 0;
  const auto add = [&](const auto& pairs) {
    for (const auto& one : pairs) count += one.time == 0 ? 1 : 0;
  };
  for (const ObjectCollisions& pair : found.objects) {
    add(pair.vertex_face);
    add(pair.face_vertex);
    add(pair.edge_edge);
  }
  return start_warnings(count);
}

void check(const SceneOptions& options) {
  if (options.cell_size >= 0.01 && options.cell_size <= 100) return;
  throw InvalidOption("cell_size is " + exact_text(options.cell_size) + ", but must be 0.01 to 100");
}

struct ProximityScene::Data {
  SceneOptions options;
  std::vector<std::optional<SceneObject>> objects;
  /// Pairs of objects that are not compared, the smaller object first.
  std::set<std::pair<std::uint32_t, std::uint32_t>> excluded;

  [[nodiscard]] const SceneObject& at(ObjectId object) const {
    if (object.value >= objects.size() || !objects[object.value]) {
      throw InvalidOption("the scene has no object " + std::to_string(object.value) +
                          (object.value < objects.size() ? ": it was removed" : ""));
    }
    return *objects[object.value];
  }
  [[nodiscard]] SceneObject& at(ObjectId object) {
    static_cast<void>(std::as_const(*this).at(object));
    return *objects[object.value];
  }

  [[nodiscard]] TwoObjects two(ObjectId first, ObjectId second) const {
    return {first, &at(first), second, &at(second)};
  }

  [[nodiscard]] bool are_compared(std::uint32_t a, std::uint32_t b) const {
    if (!objects[a] || !objects[b] || excluded.contains({a, b})) return false;
    const ObjectOptions& of_a = objects[a]->options();
    const ObjectOptions& of_b = objects[b]->options();
    if (a == b) return of_a.self;
    return (of_a.layers & of_b.meets) != 0 && (of_b.layers & of_a.meets) != 0;
  }

  [[nodiscard]] bool uses_cells() const { return options.culling == Culling::voronoi; }

  [[nodiscard]] std::optional<PrimitivePair> closest(const ObjectPair& pair, double max_distance,
                                                     const Context& context, ProximityReport& report) const {
    if (!uses_cells()) return detail::closest_pair(pair, max_distance, context, report);
    return detail::closest_pair_by_cells(pair, objects.size(), options.cell_size, max_distance, context, report);
  }

  /// Returns the pairs of objects that are compared and whose boxes are at most a distance apart.
  [[nodiscard]] std::vector<TwoObjects> compared(double distance, const Context& context) const {
    // Throws if the number of threads is invalid, even if there is nothing to do.
    static_cast<void>(thread_count(context));
    throw_if_cancelled(context);
    std::vector<Box3> boxes(objects.size());
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      if (objects[k]) boxes[k] = objects[k]->bounds();
    }
    std::vector<TwoObjects> out;
    for (std::uint32_t a = 0; a < objects.size(); ++a) {
      for (std::uint32_t b = a; b < objects.size(); ++b) {
        if (are_compared(a, b) && detail::box_gap(boxes[a], boxes[b]) <= distance) {
          out.push_back({ObjectId(a), &*objects[a], ObjectId(b), &*objects[b]});
        }
      }
    }
    return out;
  }
  /// Returns the pairs of compared(), with the data that a comparison of their primitives needs.
  /// @param report  receives the number of pairs and the time spent.
  [[nodiscard]] std::vector<ObjectPair> pairs(double distance, const Context& context, ProximityReport& report) const {
    PhaseTimer timer(report.phases);
    const std::vector<TwoObjects> found = compared(distance, context);
    std::vector<ObjectPair> out(found.begin(), found.end());
    report.object_pairs = out.size();
    timer.lap("objects");
    return out;
  }
};

ProximityScene::ProximityScene(const SceneOptions& options) : data_(std::make_unique<Data>()) {
  check(options);
  data_->options = options;
}
ProximityScene::ProximityScene(ProximityScene&&) noexcept = default;
ProximityScene& ProximityScene::operator=(ProximityScene&&) noexcept = default;
ProximityScene::~ProximityScene() = default;

ObjectId ProximityScene::add(const MeshView& mesh, const ObjectOptions& options, const Context& context) {
  change_named(options.name, [&] {
    SceneObject object(mesh, options, context);
    data_->objects.emplace_back(std::move(object));
  });
  return ObjectId(static_cast<std::uint32_t>(data_->objects.size() - 1));
}

void ProximityScene::remove(ObjectId object) {
  static_cast<void>(data_->at(object));
  data_->objects[object.value].reset();
}

void ProximityScene::rename(ObjectId object, std::string name) {
  data_->at(object).set_name(std::move(name));
}

void ProximityScene::update(ObjectId object, std::span<const Vec3d> vertices, const Context& context) {
  SceneObject& own = data_->at(object);
  change_named(own.options().name, [&] { own.set_positions(vertices, context); });
}
void ProximityScene::update(ObjectId object, const RigidTransform& place) {
  data_->at(object).set_place(place);
}
void ProximityScene::update(ObjectId object, const MeshView& mesh, const Context& context) {
  SceneObject& own = data_->at(object);
  change_named(own.options().name, [&] { own.set_mesh(mesh, context); });
}

void ProximityScene::exclude(ObjectId first, ObjectId second, bool is_excluded) {
  static_cast<void>(data_->at(first));
  static_cast<void>(data_->at(second));
  const auto [a, b] = std::minmax(first.value, second.value);
  if (is_excluded) {
    data_->excluded.emplace(a, b);
  } else {
    data_->excluded.erase({a, b});
  }
}

std::size_t ProximityScene::size() const {
  return data_->objects.size();
}

MeshView ProximityScene::mesh(ObjectId object) const {
  return data_->at(object).mesh();
}

std::optional<PrimitivePair> ProximityScene::separation(ObjectId first, ObjectId second, double max_distance,
                                                        const Context& context) const {
  check_distance("max_distance", max_distance);
  const SceneObject& a = data_->at(first);
  const SceneObject& b = data_->at(second);
  ProximityReport report;
  if (first <= second) return data_->closest(ObjectPair(first, a, second, b), max_distance, context, report);
  auto found = data_->closest(ObjectPair(second, b, first, a), max_distance, context, report);
  return found ? std::optional(detail::exchanged(*found)) : std::nullopt;
}

ProximityPairs ProximityScene::separation(double max_distance, const Context& context) const {
  check_distance("max_distance", max_distance);
  ProximityPairs out;
  const std::vector<ObjectPair> pairs = data_->pairs(max_distance, context, out.report);
  PhaseTimer timer(out.report.phases);
  std::vector<std::optional<PrimitivePair>> found(pairs.size());
  std::vector<ProximityReport> reports(pairs.size());
  const auto find = [&](std::size_t k, const Context& of_pair) {
    found[k] = data_->closest(pairs[k], max_distance, of_pair, reports[k]);
  };
  if (data_->uses_cells()) out.report.culling = Culling::voronoi;
  if (data_->uses_cells() || pairs.size() < static_cast<std::size_t>(thread_count(context))) {
    for (std::size_t k = 0; k < pairs.size(); ++k) find(k, context);
  } else {
    Context alone = context;
    alone.threads = 1;
    parallel_for(context, pairs.size(), 1, "separation", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) find(k, alone);
    });
  }
  for (const auto& one : found) {
    if (one) out.pairs.push_back(*one);
  }
  for (const ProximityReport& one : reports) detail::add(one, out.report);
  timer.lap("primitives");
  return out;
}

bool ProximityScene::meets(ObjectId first, ObjectId second, const Context& context) const {
  return detail::meet(data_->two(first, second), context);
}

bool ProximityScene::meets(const Context& context) const {
  const std::vector<TwoObjects> pairs = data_->compared(0, context);
  return std::any_of(pairs.begin(), pairs.end(), [&](const TwoObjects& two) { return detail::meet(two, context); });
}

std::vector<std::uint8_t> ProximityScene::meets(ObjectId first, ObjectId second,
                                                std::span<const RigidTransform> transforms,
                                                const Context& context) const {
  const TwoObjects two = data_->two(first, second);
  if (first == second) {
    throw InvalidOption("object " + std::to_string(first.value) +
                        " cannot be tested against another pose of itself; add its mesh a second time");
  }
  return detail::meet_at(*two.a, *two.b, transforms, context);
}

ProximityPairs ProximityScene::closest_primitives(double max_distance, const Context& context) const {
  check_distance("max_distance", max_distance);
  ProximityPairs out;
  const std::vector<ObjectPair> pairs = data_->pairs(max_distance, context, out.report);
  PhaseTimer timer(out.report.phases);
  if (data_->uses_cells()) {
    const double cell_size = data_->options.cell_size;
    detail::closest_of_each_by_cells(pairs, data_->objects.size(), cell_size, max_distance, context, out);
  } else {
    detail::closest_of_each(pairs, data_->objects.size(), max_distance, context, out);
    timer.lap("primitives");
  }
  return out;
}

ProximityPairs ProximityScene::closer_than(double distance, const Context& context) const {
  check_distance("distance", distance);
  ProximityPairs out;
  const std::vector<ObjectPair> pairs = data_->pairs(distance, context, out.report);
  PhaseTimer timer(out.report.phases);
  if (data_->uses_cells()) {
    const double cell_size = data_->options.cell_size;
    detail::near_pairs_by_cells(pairs, data_->objects.size(), cell_size, distance, context, out);
  } else {
    detail::near_pairs(pairs, distance, detail::Neighbours::left_out, context, out);
    timer.lap("primitives");
  }
  return out;
}

ProximityPairs ProximityScene::collisions(const Context& context) const {
  ProximityPairs out;
  const std::vector<ObjectPair> pairs = data_->pairs(0, context, out.report);
  PhaseTimer timer(out.report.phases);
  if (!data_->uses_cells()) {
    detail::near_pairs(pairs, 0, detail::Neighbours::folded, context, out);
    timer.lap("primitives");
    return out;
  }
  // Distances do not show if neighbouring triangles are folded. So for pairs of an object and itself, the hierarchies
  // of boxes are used.
  std::vector<ObjectPair> others;
  std::vector<ObjectPair> selves;
  for (const ObjectPair& pair : pairs) (pair.is_self() ? selves : others).push_back(pair);
  detail::near_pairs(selves, 0, detail::Neighbours::folded, context, out);
  timer.lap("objects with themselves");
  detail::near_pairs_by_cells(others, data_->objects.size(), data_->options.cell_size, 0, context, out);
  return out;
}

SceneCollisions ProximityScene::continuous(std::span<const ObjectMotion> motions, const ImpactOptions& options,
                                           const Context& context) const {
  check(options);
  detail::SceneMotion motion(data_->objects.size());
  for (const ObjectMotion& one : motions) motion.add(data_->at(one.object), one, context);
  return motion.collisions(data_->compared(infinite, context), options, context);
}

std::optional<FirstContact> ProximityScene::first_contact(std::span<const ObjectMotion> motions,
                                                          const ImpactOptions& options, const Context& context) const {
  check(options);
  detail::SceneMotion motion(data_->objects.size());
  for (const ObjectMotion& one : motions) motion.add(data_->at(one.object), one, context);
  return motion.first(data_->compared(infinite, context), options, context);
}

Penetrations ProximityScene::penetration(ObjectId first, ObjectId second, const PenetrationOptions& options,
                                         const Context& context) const {
  const TwoObjects two = data_->two(first, second);
  Penetrations out;
  out.object_pairs = 1;
  out.parts = std::move(detail::penetrations({&two, 1}, options, context, out.phases).front());
  return out;
}

LeastTranslation ProximityScene::least_translation(ObjectId first, ObjectId second, const TranslationOptions& options,
                                                   const Context& context) const {
  return detail::least_translation(data_->two(first, second), options, context);
}

Penetrations ProximityScene::penetrations(const PenetrationOptions& options, const Context& context) const {
  Penetrations out;
  const std::vector<TwoObjects> pairs = data_->compared(infinite, context);
  out.object_pairs = pairs.size();
  for (std::vector<Penetration>& parts : detail::penetrations(pairs, options, context, out.phases)) {
    out.parts.insert(out.parts.end(), std::move_iterator(parts.begin()), std::move_iterator(parts.end()));
  }
  return out;
}

double ProximityScene::signed_separation(ObjectId first, ObjectId second, const PenetrationOptions& options,
                                         const Context& context) const {
  check(options);
  const auto closest = separation(first, second, infinite, context);
  const double apart = closest ? closest->between.distance : infinite;
  if (closest && detail::are_apart(data_->two(first, second))) return apart;
  const Penetrations found = penetration(first, second, options, context);
  return found.parts.empty() ? apart : -found.parts.front().depth;
}

ProximityPairs ProximityScene::signed_separations(const PenetrationOptions& options, const Context& context) const {
  check(options);
  ProximityPairs out = separation(infinite, context);
  std::vector<TwoObjects> close;
  for (const PrimitivePair& pair : out.pairs) {
    const TwoObjects two = data_->two(pair.first_object, pair.second_object);
    if (!detail::are_apart(two)) close.push_back(two);
  }
  auto parts = detail::penetrations(close, options, context, out.report.phases);
  std::size_t next = 0;
  for (PrimitivePair& pair : out.pairs) {
    const bool is_close =
        next < close.size() && pair.first_object == close[next].first && pair.second_object == close[next].second;
    if (!is_close) continue;
    if (!parts[next].empty()) pair = deepest_pair(parts[next].front());
    ++next;
  }
  return out;
}

std::span<const PairQuery> pair_queries() {
  using Scene = const ProximityScene&;
  using Options = const PairQueryOptions&;
  static constexpr std::array queries{
      PairQuery{"separation", [](Scene scene, Options options,
                                 const Context& context) { return scene.separation(options.max_distance, context); }},
      PairQuery{"signed_separations",
                [](Scene scene, Options options, const Context& context) {
                  return scene.signed_separations(options.penetration, context);
                }},
      PairQuery{"closest_primitives",
                [](Scene scene, Options options, const Context& context) {
                  return scene.closest_primitives(options.max_distance, context);
                }},
      PairQuery{"closer_than", [](Scene scene, Options options,
                                  const Context& context) { return scene.closer_than(options.max_distance, context); }},
      PairQuery{"collisions", [](Scene scene, Options, const Context& context) { return scene.collisions(context); }},
  };
  return queries;
}

ProximityPairs ask_pairs(const ProximityScene& scene, std::string_view query, const PairQueryOptions& options,
                         const Context& context) {
  for (const PairQuery& one : pair_queries()) {
    if (one.name == query) return one.ask(scene, options, context);
  }
  std::string names;
  for (const PairQuery& one : pair_queries()) names += (names.empty() ? "" : ", ") + std::string(one.name);
  throw InvalidOption("query is '" + std::string(query) + "', but must be one of " + names);
}

}  // namespace blum
