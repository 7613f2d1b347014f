#include "blum/points/sample_surface.hpp"

#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "call.hpp"
#include "columns.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

/// Returns (points, normals, triangles).
nb::tuple columns_of(SurfaceSamples found) {
  static_assert(sizeof(TriangleId) == sizeof(std::int32_t));
  return nb::make_tuple(handed_over<double>(std::move(found.points), 3),
                        handed_over<double>(std::move(found.normals), 3),
                        handed_over<std::int32_t>(std::move(found.triangles)));
}

/// Returns (points, closest points, distances, sites, triangles, sign rule, sign reason, warnings). The second to fifth
/// are views of one block of memory.
nb::tuple columns_of(NearSamples found) {
  const Held<ClosestPoint> kept = held(std::move(found.closest));
  const auto shown = [&](auto member) { return column(*kept.entries, member, kept.owner); };
  return nb::make_tuple(handed_over<double>(std::move(found.points), 3), shown(&ClosestPoint::point),
                        shown(&ClosestPoint::distance), shown(&ClosestPoint::site), shown(&ClosestPoint::triangle),
                        std::string(to_string(found.sign_rule)), found.sign_reason, to_python(found.warnings));
}

}  // namespace

void bind_points(nb::module_& m) {
  bind_options<SampleOptions>(m);
  bind_options<NearSampleOptions>(m);
  m.def(
      "sample_surface",
      [](const MeshArrays& mesh, std::size_t count, const nb::dict& given, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        const auto options = options_from<SampleOptions>(given);
        return columns_of(run({threads, std::move(progress)},
                              [&](const Context& context) { return sample_surface(view, count, options, context); }));
      },
      nb::arg("mesh"), nb::arg("count"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "sample_near",
      [](const MeshArrays& mesh, std::size_t count, const nb::dict& given, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        const auto options = options_from<NearSampleOptions>(given);
        return columns_of(run({threads, std::move(progress)},
                              [&](const Context& context) { return sample_near(view, count, options, context); }));
      },
      nb::arg("mesh"), nb::arg("count"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace blum::python
