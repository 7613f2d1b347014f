#include "blum/field/closest_points.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <optional>
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

/// (points, distances, sites, triangles), views of one block of memory.
nb::tuple columns_of(std::vector<ClosestPoint> found) {
  const Held<ClosestPoint> kept = held(std::move(found));
  const auto shown = [&](auto member) { return column(*kept.entries, member, kept.owner); };
  return nb::make_tuple(shown(&ClosestPoint::point), shown(&ClosestPoint::distance), shown(&ClosestPoint::site),
                        shown(&ClosestPoint::triangle));
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
  nb::class_<ClosestPointQuery>(m, "ClosestPointQuery")
      .def(
          "__init__",
          [](ClosestPointQuery* self, const MeshArrays& mesh, const nb::dict& given, int threads, nb::object progress) {
            const MeshView view = mesh.view();
            const auto options = options_from<ClosestPointOptions>(given);
            new (self) ClosestPointQuery(run({threads, std::move(progress)}, [&](const Context& context) {
              return ClosestPointQuery(view, options, context);
            }));
          },
          nb::arg("mesh"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none())
      .def(
          "nearest",
          [](const ClosestPointQuery& self, const PointsIn& points, int threads, nb::object progress) {
            return columns_of(run({threads, std::move(progress)},
                                  [&](const Context& context) { return self.nearest(vectors(points), context); }));
          },
          nb::arg("points").noconvert(), nb::arg("threads"), nb::arg("progress").none())
      .def_prop_ro("sign_rule", [](const ClosestPointQuery& self) { return std::string(to_string(self.sign_rule())); })
      .def_prop_ro("sign_reason", [](const ClosestPointQuery& self) { return self.sign_reason(); });
}

}  // namespace blum::python
