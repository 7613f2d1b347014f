#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/core/device.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/field/field.hpp"
#include "blum/field/interpolate.hpp"
#include "blum/field/zero_surface.hpp"
#include "call.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

using FloatsIn = nb::ndarray<const float, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

using SitesIn = nb::ndarray<const std::int32_t, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

template <class T, class Array>
Buffer<T> copied(const Array& array) {
  Buffer<T> out(array.size());
  const auto* first = reinterpret_cast<const T*>(array.data());
  std::copy(first, first + array.size(), out.begin());
  return out;
}

Field field_of(const FloatsIn& distance, const GridSpec& grid, const std::optional<SitesIn>& site,
               const std::optional<FloatsIn>& distance2, const std::optional<SitesIn>& site2,
               const std::optional<std::string>& second, const std::string& site_ids, std::optional<double> band,
               const std::string& sign_rule, std::string sign_reason) {
  Field field;
  field.grid = grid;
  field.distance = copied<float>(distance);
  if (site) field.site = copied<SiteId>(*site);
  if (distance2) field.distance2 = copied<float>(*distance2);
  if (site2) field.site2 = copied<SiteId>(*site2);
  if (second) field.second = parse_enum<SecondRule>("second", *second);
  field.site_ids = parse_enum<SiteIds>("site_ids", site_ids);
  field.band = band;
  field.sign_rule = parse_enum<SignRule>("sign_rule", sign_rule);
  field.sign_reason = std::move(sign_reason);
  return field;
}

/// Returns a view of site ids, or None if the field has none.
nb::object sites_of(const nb::pointer_and_handle<Field>& self, Buffer<SiteId>& sites) {
  if (sites.empty()) return nb::none();
  return nb::cast(grid_view(reinterpret_cast<std::int32_t*>(sites.data()), self.p->grid.size, self.h));
}

using ObjectsIn = nb::ndarray<const std::uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

std::span<const std::uint32_t> objects_of(const std::optional<ObjectsIn>& objects) {
  return objects ? std::span(objects->data(), objects->size()) : std::span<const std::uint32_t>();
}

void bind_field_class(nb::module_& m) {
  nb::class_<Field>(m, "Field")
      .def(
          "__init__",
          [](Field* self, const FloatsIn& distance, const GridSpec& grid, const std::optional<SitesIn>& site,
             const std::optional<FloatsIn>& distance2, const std::optional<SitesIn>& site2,
             const std::optional<std::string>& second, const std::string& site_ids, std::optional<double> band,
             const std::string& sign_rule, std::string sign_reason) {
            new (self) Field(field_of(distance, grid, site, distance2, site2, second, site_ids, band, sign_rule,
                                      std::move(sign_reason)));
          },
          nb::arg("distance").noconvert(), nb::arg("grid"), nb::arg("site").none(), nb::arg("distance2").none(),
          nb::arg("site2").none(), nb::arg("second").none(), nb::arg("site_ids"), nb::arg("band").none(),
          nb::arg("sign_rule"), nb::arg("sign_reason"))
      .def_prop_ro("distance",
                   [](nb::pointer_and_handle<Field> self) {
                     return grid_view(self.p->distance.data(), self.p->grid.size, self.h);
                   })
      .def_prop_ro("site",
                   [](nb::pointer_and_handle<Field> self) -> nb::object { return sites_of(self, self.p->site); })
      .def_prop_ro("distance2",
                   [](nb::pointer_and_handle<Field> self) -> nb::object {
                     if (self.p->distance2.empty()) return nb::none();
                     return nb::cast(grid_view(self.p->distance2.data(), self.p->grid.size, self.h));
                   })
      .def_prop_ro("site2",
                   [](nb::pointer_and_handle<Field> self) -> nb::object { return sites_of(self, self.p->site2); })
      .def_prop_ro("second",
                   [](const Field& field) -> std::optional<std::string> {
                     if (!field.second) return std::nullopt;
                     return std::string(to_string(*field.second));
                   })
      .def_ro("grid", &Field::grid)
      .def_prop_ro("site_ids", [](const Field& field) { return std::string(to_string(field.site_ids)); })
      .def_ro("band", &Field::band)
      .def_prop_ro("sign_rule", [](const Field& field) { return std::string(to_string(field.sign_rule)); })
      .def_ro("sign_reason", &Field::sign_reason)
      .def_prop_ro("warnings", [](const Field& self) { return result_of(self.warnings); })
      .def_prop_ro("device", [](const Field& field) { return to_string(field.device); })
      .def_ro("device_reason", &Field::device_reason)
      .def_prop_ro("seconds", [](const Field& field) { return seconds_of(field.phases); })
      .def(
          "interpolate",
          [](const Field& field, const PointsIn& points, int threads, nb::object progress) {
            return handed_over<double>(run({threads, std::move(progress)}, [&](const Context& context) {
              return interpolate(field, vectors(points), context);
            }));
          },
          nb::arg("points").noconvert(), nb::arg("threads"), nb::arg("progress").none())
      .def(
          "interpolate_with_gradient",
          [](const Field& field, const PointsIn& points, int threads, nb::object progress) {
            InterpolatedGradients found = run({threads, std::move(progress)}, [&](const Context& context) {
              return interpolate_with_gradient(field, vectors(points), context);
            });
            return nb::make_tuple(handed_over<double>(std::move(found.value)),
                                  handed_over<double>(std::move(found.gradient), 3));
          },
          nb::arg("points").noconvert(), nb::arg("threads"), nb::arg("progress").none())
      .def(
          "level_warnings",
          [](const Field& field, double level, int threads) {
            return result_of(run({threads, nb::none()},
                                 [&](const Context& context) { return level_warnings(field, level, context); }));
          },
          nb::arg("level"), nb::arg("threads"))
      .def(
          "zero_surface",
          [](const Field& field, double level, int threads, nb::object progress) {
            return arrays_of(run({threads, std::move(progress)},
                                 [&](const Context& context) { return zero_surface(field, level, context); }));
          },
          nb::arg("level"), nb::arg("threads"), nb::arg("progress").none());
}

/// Binds FieldSolver. `compute` returns a field with its own memory, `compute_in_place` one in the solver's buffers.
void bind_solver(nb::module_& m) {
  nb::class_<FieldSolver>(m, "FieldSolver")
      .def(
          "__init__",
          [](FieldSolver* self, const GridSpec& grid, const nb::dict& options, const std::string& device) {
            new (self) FieldSolver(grid, options_from<FieldOptions>(options), {.device = parse_device(device)});
          },
          nb::arg("grid"), nb::arg("options"), nb::arg("device"))
      .def(
          "compute",
          [](FieldSolver& solver, const MeshArrays& mesh, int threads, nb::object progress) {
            const MeshView view = mesh.view();
            return run({threads, std::move(progress)}, [&](const Context& context) {
              (void)solver.compute(view, context);
              return solver.take();
            });
          },
          nb::arg("mesh"), nb::arg("threads"), nb::arg("progress").none())
      .def(
          "compute_in_place",
          [](FieldSolver& solver, const MeshArrays& mesh, int threads, nb::object progress) {
            const MeshView view = mesh.view();
            return run({threads, std::move(progress)},
                       [&](const Context& context) { return &solver.compute(view, context); });
          },
          nb::arg("mesh"), nb::arg("threads"), nb::arg("progress").none(), nb::rv_policy::reference_internal)
      .def(
          "set_objects",
          [](FieldSolver& solver, const std::optional<ObjectsIn>& objects) { solver.set_objects(objects_of(objects)); },
          nb::arg("objects").none());
}

}  // namespace

void bind_field(nb::module_& m) {
  bind_options<FieldOptions>(m);
  bind_field_class(m);
  bind_solver(m);
  m.def(
      "distance_field",
      [](const MeshArrays& mesh, const GridSpec& grid, const std::optional<ObjectsIn>& objects, const nb::dict& given,
         int threads, const std::string& device, nb::object progress) {
        const MeshView view = mesh.view();
        const auto options = options_from<FieldOptions>(given);
        return run({threads, std::move(progress), parse_device(device)}, [&](const Context& context) {
          if (!objects) return distance_field(view, grid, options, context);
          return distance_field(view, grid, objects_of(objects), options, context);
        });
      },
      nb::arg("mesh"), nb::arg("grid"), nb::arg("objects").none(), nb::arg("options"), nb::arg("threads"),
      nb::arg("device"), nb::arg("progress").none());
}

}  // namespace blum::python
