#include "blum/solid/solid.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/core/parallel.hpp"
#include "blum/solid/clean_mesh.hpp"
#include "blum/solid/oriented_mesh.hpp"
#include "blum/solid/solid_warnings.hpp"
#include "call.hpp"
#include "images.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

/// Returns (mesh, vertex_of, triangle_of, betti, shells).
nb::tuple parts_of(const SolidBody& body) {
  return nb::make_tuple(arrays_of(body.mesh), handed_over<std::uint32_t>(body.vertex_of),
                        handed_over<std::uint32_t>(body.triangle_of), nb::cast(body.betti),
                        handed_over<std::uint32_t>(body.shells));
}

nb::list bodies_of(const Solid& solid) {
  nb::list out;
  for (const SolidBody& body : solid.bodies()) out.append(parts_of(body));
  return out;
}

nb::list shells_of(const Solid& solid) {
  nb::list out;
  for (const SolidShell& shell : solid.shells()) out.append(result_of(shell));
  return out;
}

std::vector<std::uint8_t> inside(const Solid& solid, std::span<const Vec3d> points, const Context& context) {
  std::vector<std::uint8_t> out(points.size());
  constexpr std::size_t grain = 1024;
  parallel_for(context, points.size(), grain, "points", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) out[k] = solid.inside(points[k]) ? 1 : 0;
  });
  return out;
}

template <class Shape>
nb::tuple cleaned(const Call& call, const Shape& shape, double tolerance) {
  const CleanedMesh out = run(call, [&](const Context& context) { return clean_mesh(shape, tolerance, context); });
  return nb::make_tuple(arrays_of(out.mesh), handed_over<std::uint32_t>(out.vertex_of), to_python(out.report),
                        to_python(out.warnings));
}

/// Binds functions that return (mesh, vertex_of, report, warnings).
void bind_clean_mesh(nb::module_& m) {
  bind_struct<CleanReport>(m);
  m.def(
      "clean_mesh",
      [](const MeshArrays& mesh, double tolerance, int threads, nb::object progress) {
        return cleaned({threads, std::move(progress)}, mesh.view(), tolerance);
      },
      nb::arg("mesh"), nb::arg("tolerance"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "clean_solid",
      [](const Solid& solid, double tolerance, int threads, nb::object progress) {
        return cleaned({threads, std::move(progress)}, solid, tolerance);
      },
      nb::arg("solid"), nb::arg("tolerance"), nb::arg("threads"), nb::arg("progress").none());
}

/// Binds oriented_mesh(), which returns (mesh, reversed_triangles, reversed_shells).
void bind_oriented_mesh(nb::module_& m) {
  m.def(
      "oriented_mesh",
      [](const MeshArrays& mesh, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        const OrientedMesh out =
            run({threads, std::move(progress)}, [&](const Context& context) { return oriented_mesh(view, context); });
        return nb::make_tuple(arrays_of(out.mesh), out.reversed_triangles, out.reversed_shells);
      },
      nb::arg("mesh"), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace

void bind_solid(nb::module_& m) {
  bind_struct<SolidShell>(m);
  bind_struct<CrossingCounts>(m);
  bind_clean_mesh(m);
  bind_oriented_mesh(m);
  bind_options<CellularModelOptions>(m);
  bind_struct<CellularModelReport>(m);
  nb::class_<CellularModel>(m, "CellularModel")
      .def_prop_ro("report", [](const CellularModel& model) { return result_of(model.report()); })
      .def(
          "complex",
          [](const CellularModel& model, int threads, nb::object progress) {
            return run({threads, std::move(progress)}, [&](const Context& context) { return model.complex(context); });
          },
          nb::arg("threads"), nb::arg("progress").none())
      .def(
          "betti",
          [](const CellularModel& model, int threads, nb::object progress) {
            return run({threads, std::move(progress)}, [&](const Context& context) { return model.betti(context); });
          },
          nb::arg("threads"), nb::arg("progress").none());
  nb::class_<Solid>(m, "Solid")
      .def_prop_ro("rule", [](const Solid& solid) { return std::string(to_string(solid.rule())); })
      .def_prop_ro("reason", &Solid::reason)
      .def_prop_ro("problem", &Solid::problem)
      .def_prop_ro("warnings", [](const Solid& solid) { return result_of(solid_warnings(solid)); })
      .def_prop_ro("surface", [](const Solid& solid) { return arrays_of(solid.surface().mesh); })
      .def_prop_ro("betti", [](const Solid& solid) { return nb::cast(solid.betti()); })
      .def_prop_ro("bodies", &bodies_of)
      .def_prop_ro("shells", &shells_of)
      .def_prop_ro("reversed_shells", &Solid::reversed_shells)
      .def_prop_ro("reversed_triangles", &Solid::reversed_triangles)
      .def_prop_ro("resolved",
                   [](const Solid& solid) {
                     return solid.resolved() ? result_of(*solid.resolved()) : nb::steal<nb::any>(nb::none().release());
                   })
      .def_prop_ro("faces_inwards", &Solid::faces_inwards)
      .def_prop_ro("box",
                   [](const Solid& solid) { return std::pair(triple(solid.box().lower), triple(solid.box().upper)); })
      .def(
          "inside",
          [](const Solid& solid, const PointsIn& points, int threads, nb::object progress) {
            return handed_over<std::uint8_t>(run({threads, std::move(progress)}, [&](const Context& context) {
              return inside(solid, vectors(points), context);
            }));
          },
          nb::arg("points").noconvert(), nb::arg("threads"), nb::arg("progress").none())
      .def(
          "model",
          [](const Solid& solid, const nb::dict& given, int threads, nb::object progress) {
            const auto options = options_from<CellularModelOptions>(given);
            return run({threads, std::move(progress)},
                       [&](const Context& context) { return solid.model(options, context); });
          },
          nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "solid_of_mesh",
      [](const MeshArrays& mesh, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        return run({threads, std::move(progress)}, [&](const Context& context) { return Solid::of(view, context); });
      },
      nb::arg("mesh"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "solid_of_image",
      [](const ImageArrays& image, std::optional<std::int64_t> label, std::optional<double> threshold, int threads,
         nb::object progress) {
        const LabelSelection selection = LabelSelection::of(label, threshold);
        return run({threads, std::move(progress)},
                   [&](const Context& context) { return Solid::of(image.view, selection, context); });
      },
      nb::arg("image"), nb::arg("label").none(), nb::arg("threshold").none(), nb::arg("threads"),
      nb::arg("progress").none());
}

}  // namespace blum::python
