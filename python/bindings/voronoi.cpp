#include "blum/voronoi/voronoi_complex.hpp"

#include <nanobind/stl/filesystem.h>

#include <filesystem>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/voronoi/voronoi_regions.hpp"
#include "call.hpp"
#include "structs.hpp"

namespace blum::python {

void bind_voronoi(nb::module_& m) {
  bind_options<VoronoiOptions>(m);
  bind_struct<FailingVoronoiCell>(m);
  bind_struct<VoronoiNeighbour>(m);
  bind_struct<VoronoiRegion>(m);
  bind_struct<VoronoiReport>(m);
  m.def(
      "voronoi_complex",
      [](const MeshArrays& mesh, const nb::dict& given, int threads, nb::object progress) {
        const auto options = options_from<VoronoiOptions>(given);
        VoronoiComplex out = run({threads, std::move(progress)}, [&](const Context& context) {
          return voronoi_complex(mesh.view(), options, context);
        });
        return nb::make_tuple(std::move(out.complex), to_python(out.report));
      },
      nb::arg("mesh"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "voronoi_regions",
      [](const Complex& complex) {
        nb::list out;
        for (const VoronoiRegion& region : voronoi_regions(complex)) out.append(to_python(region));
        return out;
      },
      nb::arg("complex"));
  m.def(
      "write_complex",
      [](const std::filesystem::path& path, const Complex& complex) {
        run_call({0, nb::none()},
                 [&](const Context& context) { write_complex(path, complex, {}, {.allow_loss = true}, context); });
      },
      nb::arg("path"), nb::arg("complex"));
}

}  // namespace blum::python
