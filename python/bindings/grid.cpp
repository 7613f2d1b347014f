#include <nanobind/stl/array.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/grid/grid_spec.hpp"

namespace blum::python {
namespace {

using Triple = std::array<double, 3>;

Box3 box(const Triple& lower, const Triple& upper) {
  return {vector(lower), vector(upper)};
}

}  // namespace

void bind_grid(nb::module_& m) {
  nb::class_<GridSpec>(m, "GridSpec")
      .def(
          "__init__",
          [](GridSpec* self, const Triple& origin, const Triple& spacing, const std::array<std::int64_t, 3>& size,
             const std::array<Triple, 3>& columns) {
            GridSpec grid{vector(origin), vector(spacing), size, {}};
            for (std::size_t a = 0; a < 3; ++a) grid.direction.columns[a] = vector(columns[a]);
            validate(grid);
            new (self) GridSpec(grid);
          },
          nb::arg("origin"), nb::arg("spacing"), nb::arg("size"), nb::arg("columns"))
      .def_prop_ro("origin", [](const GridSpec& grid) { return triple(grid.origin); })
      .def_prop_ro("spacing", [](const GridSpec& grid) { return triple(grid.spacing); })
      .def_ro("size", &GridSpec::size)
      .def_prop_ro("columns", [](const GridSpec& grid) {
        const Mat3& direction = grid.direction;
        return std::array{triple(direction.columns[0]), triple(direction.columns[1]), triple(direction.columns[2])};
      });
  m.def(
      "grid_around",
      [](const Triple& lower, const Triple& upper, int resolution, double padding) {
        return grid_around(box(lower, upper), resolution, padding);
      },
      nb::arg("lower"), nb::arg("upper"), nb::arg("resolution"), nb::arg("padding"));
  m.def(
      "grid_around_with_spacing",
      [](const Triple& lower, const Triple& upper, double spacing, double padding) {
        return grid_around_with_spacing(box(lower, upper), spacing, padding);
      },
      nb::arg("lower"), nb::arg("upper"), nb::arg("spacing"), nb::arg("padding"));
  m.def(
      "grid_in",
      [](const Triple& lower, const Triple& upper, int resolution) { return grid_in(box(lower, upper), resolution); },
      nb::arg("lower"), nb::arg("upper"), nb::arg("resolution"));
  m.def(
      "grid_in_with_spacing",
      [](const Triple& lower, const Triple& upper, double spacing) {
        return grid_in_with_spacing(box(lower, upper), spacing);
      },
      nb::arg("lower"), nb::arg("upper"), nb::arg("spacing"));
}

}  // namespace blum::python
