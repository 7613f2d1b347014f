#include "blum/complex/complex.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include <array>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/complex/homology.hpp"
#include "blum/core/error.hpp"
#include "call.hpp"

namespace blum::python {
namespace {

/// Array with one or more numbers per row.
template <class T>
using ColumnIn = nb::ndarray<const T, nb::c_contig, nb::device::cpu>;

/// Returns the columns by name, as read-only views without a copy.
/// @param owner  object that keeps the columns alive.
nb::dict views_of(const Columns& columns, nb::handle owner) {
  nb::dict out;
  for (const Column& column : columns) {
    std::visit(
        [&]<class T>(const std::vector<T>& values) {
          const std::size_t rows = column.rows();
          out[column.name.c_str()] = column.components == 1
                                         ? nb::cast(view_of<const T>(values.data(), {rows}, owner))
                                         : nb::cast(view_of<const T>(values.data(), {rows, column.components}, owner));
        },
        column.values);
  }
  return out;
}

/// Adds a copy of an array. Returns false if its elements are not of type T.
template <class T>
bool add_column(Columns& columns, const std::string& name, nb::handle array) {
  ColumnIn<T> numbers;
  if (!nb::try_cast(array, numbers, false)) return false;
  if (numbers.ndim() != 1 && numbers.ndim() != 2) {
    throw InvalidOption("column '" + name + "' has " + std::to_string(numbers.ndim()) + " axes, but must have 1 or 2");
  }
  const std::size_t components = numbers.ndim() == 1 ? 1 : numbers.shape(1);
  columns.add({name, components, std::vector<T>(numbers.data(), numbers.data() + numbers.size())});
  return true;
}

Columns columns_of(const nb::dict& arrays, std::size_t rows) {
  Columns columns(rows);
  for (const auto& [key, array] : arrays) {
    const auto name = nb::cast<std::string>(key);
    if (!(add_column<double>(columns, name, array) || add_column<float>(columns, name, array) ||
          add_column<std::int64_t>(columns, name, array) || add_column<std::int32_t>(columns, name, array))) {
      throw InvalidOption("column '" + name + "' must be an array of float64, float32, int64 or int32");
    }
  }
  return columns;
}

template <std::size_t n, class Array>
std::vector<std::array<std::uint32_t, n>> cells_of(const Array& array) {
  const auto all = rows<std::array<std::uint32_t, n>>(array);
  return {all.begin(), all.end()};
}

template <std::size_t n>
auto indices_of(const std::vector<std::array<std::uint32_t, n>>& cells, nb::handle owner) {
  return view_of<const std::int32_t>(reinterpret_cast<const std::int32_t*>(cells.data()), {cells.size(), n}, owner);
}

}  // namespace

void bind_complex(nb::module_& m) {
  using Self = nb::pointer_and_handle<Complex>;
  nb::class_<Complex>(m, "Complex")
      .def(
          "__init__",
          [](Complex* self, const PointsIn& positions, const SegmentsIn& edges, const TrianglesIn& triangles,
             const nb::dict& vertex_columns, const nb::dict& edge_columns, const nb::dict& triangle_columns) {
            const auto points = vectors(positions);
            Complex complex;
            complex.positions.assign(points.begin(), points.end());
            complex.edges = cells_of<2>(edges);
            complex.triangles = cells_of<3>(triangles);
            complex.vertex_columns = columns_of(vertex_columns, complex.positions.size());
            complex.edge_columns = columns_of(edge_columns, complex.edges.size());
            complex.triangle_columns = columns_of(triangle_columns, complex.triangles.size());
            new (self) Complex(std::move(complex));
          },
          nb::arg("positions").noconvert(), nb::arg("edges").noconvert(), nb::arg("triangles").noconvert(),
          nb::arg("vertex_columns"), nb::arg("edge_columns"), nb::arg("triangle_columns"))
      .def_prop_ro("vertices",
                   [](Self self) {
                     const std::vector<Vec3d>& all = self.p->positions;
                     return view_of<const double>(reinterpret_cast<const double*>(all.data()), {all.size(), 3}, self.h);
                   })
      .def_prop_ro("edges", [](Self self) { return indices_of(self.p->edges, self.h); })
      .def_prop_ro("triangles", [](Self self) { return indices_of(self.p->triangles, self.h); })
      .def_prop_ro("vertex_columns", [](Self self) { return views_of(self.p->vertex_columns, self.h); })
      .def_prop_ro("edge_columns", [](Self self) { return views_of(self.p->edge_columns, self.h); })
      .def_prop_ro("triangle_columns", [](Self self) { return views_of(self.p->triangle_columns, self.h); })
      .def("problem", [](const Complex& complex) { return problem_of(complex); });
  m.def(
      "homology",
      [](std::size_t vertex_count, const SegmentsIn& edges, const TrianglesIn& triangles, int threads,
         nb::object progress) {
        const ComplexView view{vertex_count, rows<std::array<std::uint32_t, 2>>(edges), rows<Triangle>(triangles)};
        return run({threads, std::move(progress)}, [&](const Context& context) { return homology(view, context); });
      },
      nb::arg("vertex_count"), nb::arg("edges").noconvert(), nb::arg("triangles").noconvert(), nb::arg("threads"),
      nb::arg("progress").none());
}

}  // namespace blum::python
