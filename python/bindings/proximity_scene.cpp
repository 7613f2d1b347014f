#include "blum/proximity/scene.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/core/parallel.hpp"
#include "blum/geometry/primitives.hpp"
#include "blum/geometry/triangle_distance.hpp"
#include "call.hpp"
#include "contacts.hpp"
#include "places.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

/// Matrices of three or four rows.
using PlacesIn = In<double, nb::shape<-1, -1, 4>>;
using TrianglesOfPointsIn = In<double, nb::shape<-1, 3, 3>>;
/// Vertices of the features of both sides, as in files.
using Features = std::array<std::array<std::int32_t, 3>, 2>;

std::vector<RigidTransform> places_of(const PlacesIn& given, const Context& context) {
  constexpr std::size_t grain = 512;
  std::vector<RigidTransform> out(given.shape(0));
  const std::size_t size = 4 * given.shape(1);
  parallel_for(context, out.size(), grain, "", [&](const WorkRange& range) {
    for (std::size_t n = range.begin; n < range.end; ++n) {
      const double* const rows = given.data() + n * size;
      for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t k = 0; k < 3; ++k) out[n].rotation.columns[k][row] = rows[4 * row + k];
        out[n].translation[row] = rows[4 * row + 3];
      }
    }
  });
  return out;
}

/// Pairs and the vertices of their features.
struct Pairs {
  std::vector<PrimitivePair> pairs;
  std::vector<Features> features;
  ProximityReport report;
};

/// Adds the vertices of features to pairs.
Pairs with_features(const ProximityScene& scene, ProximityPairs found, const Context& context) {
  constexpr std::size_t look_every = 65536;
  const auto vertices = [&](ObjectId object, std::uint32_t primitive, const TriangleFeature& feature) {
    return feature_vertices(primitive_vertices(scene.mesh(object), primitive), feature);
  };
  Pairs out{std::move(found.pairs), {}, std::move(found.report)};
  out.features.reserve(out.pairs.size());
  for (const PrimitivePair& pair : out.pairs) {
    if (out.features.size() % look_every == 0) throw_if_cancelled(context);
    out.features.push_back({vertices(pair.first_object, pair.first, pair.between.first_feature),
                            vertices(pair.second_object, pair.second, pair.between.second_feature)});
  }
  return out;
}

/// Returns a view of numbers of every entry of a list, without a copy.
/// @param of  returns the first number of an entry; the others follow it in memory.
/// @param shape  shape of the numbers of one entry.
template <class T, class Entry, class Of, std::size_t axes>
Out<T> numbers(const Held<Entry>& list, const Of& of, const std::array<std::size_t, axes>& shape) {
  static_assert(sizeof(Entry) % sizeof(T) == 0);
  static Entry nowhere{};  // An empty array needs an address, too.
  std::array<std::size_t, axes + 1> extents{list.entries->size()};
  std::array<std::int64_t, axes + 1> strides{sizeof(Entry) / sizeof(T)};
  std::int64_t step = 1;
  for (std::size_t a = axes; a > 0; --a) {
    extents[a] = shape[a - 1];
    strides[a] = std::exchange(step, step * static_cast<std::int64_t>(shape[a - 1]));
  }
  Entry& first = list.entries->empty() ? nowhere : list.entries->front();
  return Out<T>(reinterpret_cast<T*>(&of(first)), extents.size(), extents.data(), list.owner, strides.data());
}

constexpr std::array<std::size_t, 0> single{};
constexpr std::array<std::size_t, 1> two{2};
constexpr std::array<std::size_t, 2> two_vectors{2, 3};

// numbers() requires that these members are adjacent in memory.
static_assert(offsetof(PrimitivePair, second_object) - offsetof(PrimitivePair, first_object) == sizeof(std::int32_t));
static_assert(offsetof(PrimitivePair, second) - offsetof(PrimitivePair, first) == sizeof(std::int32_t));
static_assert(offsetof(TriangleDistance, second_point) - offsetof(TriangleDistance, first_point) == 3 * sizeof(double));

Out<std::int32_t> features_out(std::vector<Features> features) {
  return numbers<std::int32_t>(held(std::move(features)), [](Features& one) -> auto& { return one; }, two_vectors);
}

/// Returns (object, primitive, distance, point, feature, culling, cells, left_over, object_pairs, candidates,
/// exact_tests).
nb::tuple columns_of(Pairs found) {
  const Held<PrimitivePair> pairs = held(std::move(found.pairs));
  return nb::make_tuple(numbers<std::int32_t>(
                            pairs, [](PrimitivePair& one) -> auto& { return one.first_object; }, two),
                        numbers<std::int32_t>(
                            pairs, [](PrimitivePair& one) -> auto& { return one.first; }, two),
                        numbers<double>(
                            pairs, [](PrimitivePair& one) -> auto& { return one.between.distance; }, single),
                        numbers<double>(
                            pairs, [](PrimitivePair& one) -> auto& { return one.between.first_point; }, two_vectors),
                        features_out(std::move(found.features)), std::string(to_string(found.report.culling)),
                        found.report.cells, found.report.left_over, found.report.object_pairs, found.report.candidates,
                        found.report.exact_tests);
}

/// Returns (distance, point, feature). Features name corners of their triangles, 0 to 2.
nb::tuple columns_of(std::vector<TriangleDistance> found) {
  constexpr Triangle corners{0, 1, 2};
  std::vector<Features> features;
  features.reserve(found.size());
  for (const TriangleDistance& one : found) {
    features.push_back({feature_vertices(corners, one.first_feature), feature_vertices(corners, one.second_feature)});
  }
  const Held<TriangleDistance> kept = held(std::move(found));
  return nb::make_tuple(numbers<double>(
                            kept, [](TriangleDistance& one) -> auto& { return one.distance; }, single),
                        numbers<double>(
                            kept, [](TriangleDistance& one) -> auto& { return one.first_point; }, two_vectors),
                        features_out(std::move(features)));
}

void bind_updates(nb::class_<ProximityScene>& scene) {
  scene.def(
      "add",
      [](ProximityScene& self, const MeshArrays& mesh, std::uint32_t layers, std::uint32_t meets, bool compare_self,
         std::string name, const PlaceIn& place, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        const ObjectOptions options{layers, meets, compare_self, std::move(name)};
        const RigidTransform where = place_of(place);
        check(where);
        return run({threads, std::move(progress)}, [&](const Context& context) {
          const ObjectId added = self.add(view, options, context);
          self.update(added, where);
          return added.value;
        });
      },
      nb::arg("mesh"), nb::arg("layers"), nb::arg("meets"), nb::arg("compare_self"), nb::arg("name"),
      nb::arg("place").noconvert(), nb::arg("threads"), nb::arg("progress").none());
  scene.def(
      "remove", [](ProximityScene& self, std::uint32_t object) { self.remove(ObjectId(object)); }, nb::arg("object"));
  scene.def(
      "rename",
      [](ProximityScene& self, std::uint32_t object, std::string name) {
        self.rename(ObjectId(object), std::move(name));
      },
      nb::arg("object"), nb::arg("name"));
  scene.def(
      "mesh",
      [](const ProximityScene& self, std::uint32_t object) {
        return arrays_of(run({0, nb::none()}, [&](const Context&) { return copy_of(self.mesh(ObjectId(object))); }));
      },
      nb::arg("object"));
  scene.def(
      "set_mesh",
      [](ProximityScene& self, std::uint32_t object, const MeshArrays& mesh, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        run_call({threads, std::move(progress)},
                 [&](const Context& context) { self.update(ObjectId(object), view, context); });
      },
      nb::arg("object"), nb::arg("mesh"), nb::arg("threads"), nb::arg("progress").none());
  scene.def(
      "set_vertices",
      [](ProximityScene& self, std::uint32_t object, const PointsIn& vertices, int threads, nb::object progress) {
        run_call({threads, std::move(progress)},
                 [&](const Context& context) { self.update(ObjectId(object), vectors(vertices), context); });
      },
      nb::arg("object"), nb::arg("vertices").noconvert(), nb::arg("threads"), nb::arg("progress").none());
  scene.def_static("check_place", [](const PlaceIn& place) { check(place_of(place)); }, nb::arg("place").noconvert());
  scene.def(
      "set_place",
      [](ProximityScene& self, std::uint32_t object, const PlaceIn& place) {
        self.update(ObjectId(object), place_of(place));
      },
      nb::arg("object"), nb::arg("place").noconvert());
  scene.def(
      "exclude",
      [](ProximityScene& self, std::uint32_t first, std::uint32_t second, bool excluded) {
        self.exclude(ObjectId(first), ObjectId(second), excluded);
      },
      nb::arg("first"), nb::arg("second"), nb::arg("excluded"));
}

void bind_queries(nb::class_<ProximityScene>& scene) {
  scene.def(
      "separation",
      [](const ProximityScene& self, std::uint32_t first, std::uint32_t second, double most, int threads,
         nb::object progress) {
        return columns_of(run_brief({threads, std::move(progress)}, [&](const Context& context) {
          ProximityPairs found;
          found.report.object_pairs = 1;
          if (const auto pair = self.separation(ObjectId(first), ObjectId(second), most, context)) {
            found.pairs.push_back(*pair);
          }
          return with_features(self, std::move(found), context);
        }));
      },
      nb::arg("first"), nb::arg("second"), nb::arg("distance"), nb::arg("threads"), nb::arg("progress").none());
  scene.def(
      "pairs",
      [](const ProximityScene& self, const std::string& query, double distance, const nb::dict& given, int threads,
         nb::object progress) {
        const PairQueryOptions options{distance, options_from<PenetrationOptions>(given)};
        return columns_of(run({threads, std::move(progress)}, [&](const Context& context) {
          return with_features(self, ask_pairs(self, query, options, context), context);
        }));
      },
      nb::arg("query"), nb::arg("distance"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
}

void bind_meets(nb::class_<ProximityScene>& scene) {
  scene.def(
      "meets",
      [](const ProximityScene& self, int threads, nb::object progress) {
        return run({threads, std::move(progress)}, [&](const Context& context) { return self.meets(context); });
      },
      nb::arg("threads"), nb::arg("progress").none());
  scene.def(
      "meets_two",
      [](const ProximityScene& self, std::uint32_t first, std::uint32_t second, int threads, nb::object progress) {
        return run_brief({threads, std::move(progress)}, [&](const Context& context) {
          return self.meets(ObjectId(first), ObjectId(second), context);
        });
      },
      nb::arg("first"), nb::arg("second"), nb::arg("threads"), nb::arg("progress").none());
  scene.def(
      "meets_at",
      [](const ProximityScene& self, std::uint32_t first, std::uint32_t second, const PlacesIn& given, int threads,
         nb::object progress) {
        return handed_over<std::uint8_t>(run({threads, std::move(progress)}, [&](const Context& context) {
          return self.meets(ObjectId(first), ObjectId(second), places_of(given, context), context);
        }));
      },
      nb::arg("first"), nb::arg("second"), nb::arg("places").noconvert(), nb::arg("threads"),
      nb::arg("progress").none());
}

nb::tuple vector_out(const Vec3d& p) {
  return nb::make_tuple(p.x, p.y, p.z);
}

/// Returns (objects, depth, depth_bound, direction, deep_point, surface_point, is_first_deep, deep_triangle,
/// surface_triangle, area, volume, curves) of each part.
nb::list parts_out(Penetrations found) {
  nb::list out;
  for (Penetration& part : found.parts) {
    nb::list curves;
    for (std::vector<Vec3d>& curve : part.curves) curves.append(handed_over<double>(std::move(curve), 3));
    out.append(nb::make_tuple(nb::make_tuple(part.first_object.value, part.second_object.value), part.depth,
                              part.depth_bound, vector_out(part.direction), vector_out(part.deep_point),
                              vector_out(part.surface_point), part.is_first_deep, part.deep_triangle,
                              part.surface_triangle, nb::make_tuple(part.area[0], part.area[1]), part.volume, curves));
  }
  return out;
}

using Row4 = std::array<std::int32_t, 4>;
using Row6 = std::array<std::int32_t, 6>;

/// Returns (vertex_face, its times, edge_edge, its times, box_pairs, exact_tests). Rows of vertex_face are object,
/// vertex, object, face. Rows of edge_edge are object, two vertices, object, two vertices.
nb::tuple collisions_out(const SceneCollisions& found) {
  const auto number = [](std::uint32_t value) { return static_cast<std::int32_t>(value); };
  std::vector<Row4> vertex_face;
  std::vector<Row6> edge_edge;
  std::vector<double> vertex_face_time;
  std::vector<double> edge_edge_time;
  for (const ObjectCollisions& pair : found.objects) {
    const std::int32_t a = pair.first.to_file();
    const std::int32_t b = pair.second.to_file();
    const auto add = [&](std::int32_t of_vertex, std::int32_t of_face, const VertexFaceCollision& one) {
      vertex_face.push_back({of_vertex, number(one.vertex), of_face, one.face.to_file()});
      vertex_face_time.push_back(one.time);
    };
    for (const VertexFaceCollision& one : pair.vertex_face) add(a, b, one);
    for (const VertexFaceCollision& one : pair.face_vertex) add(b, a, one);
    for (const EdgeEdgeCollision& one : pair.edge_edge) {
      edge_edge.push_back(
          {a, number(one.first[0]), number(one.first[1]), b, number(one.second[0]), number(one.second[1])});
      edge_edge_time.push_back(one.time);
    }
  }
  return nb::make_tuple(handed_over<std::int32_t>(std::move(vertex_face), 4),
                        handed_over<double>(std::move(vertex_face_time)),
                        handed_over<std::int32_t>(std::move(edge_edge), 6),
                        handed_over<double>(std::move(edge_edge_time)), found.box_pairs, found.exact_tests);
}

void bind_solids(nb::class_<ProximityScene>& scene) {
  scene.def(
      "penetration",
      [](const ProximityScene& self, std::uint32_t first, std::uint32_t second, const nb::dict& given, int threads,
         nb::object progress) {
        const auto options = options_from<PenetrationOptions>(given);
        return parts_out(run({threads, std::move(progress)}, [&](const Context& context) {
          return self.penetration(ObjectId(first), ObjectId(second), options, context);
        }));
      },
      nb::arg("first"), nb::arg("second"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  scene.def(
      "least_translation",
      [](const ProximityScene& self, std::uint32_t first, std::uint32_t second, const nb::dict& given, int threads,
         nb::object progress) {
        const auto options = options_from<TranslationOptions>(given);
        return result_of(run({threads, std::move(progress)}, [&](const Context& context) {
          return self.least_translation(ObjectId(first), ObjectId(second), options, context);
        }));
      },
      nb::arg("first"), nb::arg("second"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  scene.def(
      "signed_separation",
      [](const ProximityScene& self, std::uint32_t first, std::uint32_t second, const nb::dict& given, int threads,
         nb::object progress) {
        const auto options = options_from<PenetrationOptions>(given);
        return run({threads, std::move(progress)}, [&](const Context& context) {
          return self.signed_separation(ObjectId(first), ObjectId(second), options, context);
        });
      },
      nb::arg("first"), nb::arg("second"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  scene.def(
      "penetrations",
      [](const ProximityScene& self, const nb::dict& given, int threads, nb::object progress) {
        const auto options = options_from<PenetrationOptions>(given);
        return parts_out(run({threads, std::move(progress)},
                             [&](const Context& context) { return self.penetrations(options, context); }));
      },
      nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
}

/// Object, and its vertices and its place at the end of the motion.
using MotionIn = std::tuple<std::uint32_t, std::optional<PointsIn>, std::optional<PlaceIn>>;

std::vector<ObjectMotion> motions_of(const std::vector<MotionIn>& given) {
  std::vector<ObjectMotion> motions;
  for (const auto& [object, vertices, place] : given) {
    ObjectMotion& motion = motions.emplace_back();
    motion.object = ObjectId(object);
    if (vertices) motion.vertices = vectors(*vertices);
    if (place) motion.place = place_of(*place);
  }
  return motions;
}

void bind_motions(nb::class_<ProximityScene>& scene) {
  scene.def(
      "continuous",
      [](const ProximityScene& self, const std::vector<MotionIn>& given_motions, const nb::dict& given, int threads,
         nb::object progress) {
        const auto options = options_from<ImpactOptions>(given);
        const std::vector<ObjectMotion> motions = motions_of(given_motions);
        return collisions_out(run({threads, std::move(progress)},
                                  [&](const Context& context) { return self.continuous(motions, options, context); }));
      },
      nb::arg("motions"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  scene.def(
      "first_contact",
      [](const ProximityScene& self, const std::vector<MotionIn>& given_motions, const nb::dict& given, int threads,
         nb::object progress) {
        const auto options = options_from<ImpactOptions>(given);
        const std::vector<ObjectMotion> motions = motions_of(given_motions);
        return contact_out(run({threads, std::move(progress)},
                               [&](const Context& context) { return self.first_contact(motions, options, context); }));
      },
      nb::arg("motions"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace

void bind_proximity_scene(nb::module_& m) {
  nb::class_<ProximityScene> scene(m, "ProximityScene");
  bind_options<SceneOptions>(m);
  bind_options<PenetrationOptions>(m);
  bind_options<TranslationOptions>(m);
  bind_struct<LeastTranslation>(m);
  scene.def(
      "__init__",
      [](ProximityScene* self, const nb::dict& given) { new (self) ProximityScene(options_from<SceneOptions>(given)); },
      nb::arg("options"));
  bind_updates(scene);
  bind_queries(scene);
  bind_meets(scene);
  bind_solids(scene);
  bind_motions(scene);
  m.def(
      "closest_rotation",
      [](const In<double, nb::shape<3, 3>>& rows) {
        Mat3 matrix;
        for (std::size_t row = 0; row < 3; ++row) {
          for (std::size_t k = 0; k < 3; ++k) matrix.columns[k][row] = rows(row, k);
        }
        const Mat3 out = closest_rotation(matrix);
        const auto& c = out.columns;
        return nb::make_tuple(c[0].x, c[1].x, c[2].x, c[0].y, c[1].y, c[2].y, c[0].z, c[1].z, c[2].z);
      },
      nb::arg("matrix").noconvert());
  m.def(
      "triangle_distances",
      [](const TrianglesOfPointsIn& a, const TrianglesOfPointsIn& b, int threads, nb::object progress) {
        return columns_of(run({threads, std::move(progress)}, [&](const Context& context) {
          return triangle_distances(rows<std::array<Vec3d, 3>>(a), rows<std::array<Vec3d, 3>>(b), context);
        }));
      },
      nb::arg("a").noconvert(), nb::arg("b").noconvert(), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace blum::python
