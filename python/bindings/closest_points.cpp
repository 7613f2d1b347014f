#include "blum/field/closest_points.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/field/winding_numbers.hpp"
#include "call.hpp"
#include "columns.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

/// Returns (points, distances, sites, triangles), views of one block of memory.
nb::tuple columns_of(std::vector<ClosestPoint> found) {
  const Held<ClosestPoint> kept = held(std::move(found));
  const auto shown = [&](auto member) { return column(*kept.entries, member, kept.owner); };
  return nb::make_tuple(shown(&ClosestPoint::point), shown(&ClosestPoint::distance), shown(&ClosestPoint::site),
                        shown(&ClosestPoint::triangle));
}

/// Returns (first entry of each query, primitives, sites, distances, points). All but the first are views of one block
/// of memory.
nb::tuple columns_of(NearPrimitives found) {
  const Held<NearestPrimitive> kept = held(std::move(found.found));
  const auto shown = [&](auto member) { return column(*kept.entries, member, kept.owner); };
  const std::vector<std::int64_t> first(found.first.begin(), found.first.end());
  return nb::make_tuple(handed_over<std::int64_t>(first), shown(&NearestPrimitive::primitive),
                        shown(&NearestPrimitive::site), shown(&NearestPrimitive::distance),
                        shown(&NearestPrimitive::point));
}

void check_counts(std::size_t points, std::initializer_list<std::size_t> others) {
  for (const std::size_t count : others) {
    if (count != points) throw InvalidOption("the arrays must have equal numbers of rows");
  }
}

/// Returns the columns of the closest points, and the gradient at each query: NaN if it has none.
nb::tuple with_gradients(const ClosestPointQuery& query, const PointsIn& points, int threads, nb::object progress) {
  const std::span<const Vec3d> queries = vectors(points);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vec3d> gradients;
  std::vector<ClosestPoint> found = run({threads, std::move(progress)}, [&](const Context& context) {
    std::vector<ClosestPoint> nearest = query.nearest(queries, context);
    gradients.reserve(queries.size());
    for (const std::optional<Vec3d>& one : query.gradients(queries, nearest, context)) {
      gradients.push_back(one.value_or(Vec3d{nan, nan, nan}));
    }
    return nearest;
  });
  return nb::make_tuple(columns_of(std::move(found)), handed_over<double>(std::move(gradients), 3));
}

/// Returns the barycentric weights of each closest point, NaN if it has none.
Out<double> weights(const MeshArrays& mesh, const PointsIn& closest, const IndicesIn& site, const IndicesIn& triangle) {
  check_counts(closest.shape(0), {site.shape(0), triangle.shape(0)});
  const MeshView view = mesh.view();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::array<double, 3>> out(closest.shape(0));
  for (std::size_t k = 0; k < out.size(); ++k) {
    ClosestPoint one;
    one.point = vectors(closest)[k];
    if (site.data()[k] >= 0) one.site = SiteId(static_cast<std::uint32_t>(site.data()[k]));
    const std::int32_t of = triangle.data()[k];
    if (of >= static_cast<std::int64_t>(view.triangles.size()))
      throw InvalidOption("a triangle index is not below the number of triangles");
    if (of >= 0) one.triangle = TriangleId(static_cast<std::uint32_t>(of));
    out[k] = barycentric(view, one).value_or(std::array<double, 3>{nan, nan, nan});
  }
  return handed_over<double>(std::move(out), 3);
}

}  // namespace

void bind_closest_points(nb::module_& m) {
  bind_options<ClosestPointOptions>(m);
  m.def(
      "winding_numbers",
      [](const MeshArrays& mesh, const PointsIn& points, double max_error, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        return handed_over<double>(run({threads, std::move(progress)}, [&](const Context& context) {
          return winding_numbers(view, vectors(points), max_error, context);
        }));
      },
      nb::arg("mesh"), nb::arg("points").noconvert(), nb::arg("max_error"), nb::arg("threads"),
      nb::arg("progress").none());
  m.def("barycentric", &weights, nb::arg("mesh"), nb::arg("closest").noconvert(), nb::arg("site").noconvert(),
        nb::arg("triangle").noconvert());
  nb::class_<ClosestPointQuery>(m, "ClosestPointQuery")
      .def(
          "__init__",
          [](ClosestPointQuery* self, const MeshArrays& mesh, const nb::dict& given, int threads, nb::object progress,
             std::size_t queries) {
            const MeshView view = mesh.view();
            const auto options = options_from<ClosestPointOptions>(given);
            new (self) ClosestPointQuery(run({threads, std::move(progress)}, [&](const Context& context) {
              return queries > 0 ? ClosestPointQuery::for_many(view, queries, options, context)
                                 : ClosestPointQuery(view, options, context);
            }));
          },
          nb::arg("mesh"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none(), nb::arg("queries") = 0)
      .def(
          "nearest",
          [](const ClosestPointQuery& self, const PointsIn& points, int threads, nb::object progress) {
            return columns_of(run({threads, std::move(progress)},
                                  [&](const Context& context) { return self.nearest(vectors(points), context); }));
          },
          nb::arg("points").noconvert(), nb::arg("threads"), nb::arg("progress").none())
      .def("nearest_with_gradients", &with_gradients, nb::arg("points").noconvert(), nb::arg("threads"),
           nb::arg("progress").none())
      .def(
          "within",
          [](const ClosestPointQuery& self, const PointsIn& points, double distance, int threads, nb::object progress) {
            return columns_of(run({threads, std::move(progress)}, [&](const Context& context) {
              return self.within(vectors(points), distance, context);
            }));
          },
          nb::arg("points").noconvert(), nb::arg("distance"), nb::arg("threads"), nb::arg("progress").none())
      .def(
          "nearest_primitives",
          [](const ClosestPointQuery& self, const PointsIn& points, std::size_t k, int threads, nb::object progress) {
            return columns_of(run({threads, std::move(progress)}, [&](const Context& context) {
              return self.nearest_primitives(vectors(points), k, context);
            }));
          },
          nb::arg("points").noconvert(), nb::arg("k"), nb::arg("threads"), nb::arg("progress").none())
      .def(
          "refit",
          [](ClosestPointQuery& self, const PointsIn& vertices, int threads, nb::object progress) {
            run({threads, std::move(progress)}, [&](const Context& context) {
              self.refit(vectors(vertices), context);
              return true;
            });
          },
          nb::arg("vertices").noconvert(), nb::arg("threads"), nb::arg("progress").none())
      .def_prop_ro("sign_rule", [](const ClosestPointQuery& self) { return std::string(to_string(self.sign_rule())); })
      .def_prop_ro("sign_reason", [](const ClosestPointQuery& self) { return self.sign_reason(); })
      .def_prop_ro("warnings", [](const ClosestPointQuery& self) { return result_of(self.warnings()); });
}

}  // namespace blum::python
