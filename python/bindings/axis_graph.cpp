#include "blum/axis/axis_graph.hpp"

#include <nanobind/stl/filesystem.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/axis/label_patch_sheets.hpp"
#include "blum/axis/match_sheets.hpp"
#include "blum/io/graph_io.hpp"
#include "blum/solid/solid.hpp"
#include "blum/voronoi/axis_patches.hpp"
#include "call.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

using Path = std::filesystem::path;

AxisGraph graph_of(const Complex& axis, const std::optional<MeshView>& mesh, const AxisGraphOptions& options,
                   const Context& context) {
  return mesh ? axis_graph(axis, *mesh, options, context) : axis_graph(axis, options, context);
}

std::optional<MeshView> view_of_mesh(const MeshArrays* mesh) {
  return mesh == nullptr ? std::nullopt : std::optional(mesh->view());
}

}  // namespace

void bind_axis_graph(nb::module_& m) {
  bind_options<AxisGraphOptions>(m);
  bind_struct<AxisGraph>(m);
  m.def(
      "axis_graph",
      [](const Complex& axis, const MeshArrays* mesh, const nb::dict& given, int threads, nb::object progress) {
        const std::optional<MeshView> view = view_of_mesh(mesh);
        const auto options = options_from<AxisGraphOptions>(given);
        return result_of(run({threads, std::move(progress)},
                             [&](const Context& context) { return graph_of(axis, view, options, context); }));
      },
      nb::arg("axis"), nb::arg("mesh").none(), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "write_graph",
      [](const Path& path, const Complex& axis, const MeshArrays* mesh, const nb::dict& given, const nb::dict& stated) {
        const std::optional<MeshView> view = view_of_mesh(mesh);
        const auto options = options_from<AxisGraphOptions>(given);
        auto metadata = options_from<MedialMetadata>(stated);
        metadata.version = BLUM_VERSION;
        run_call({0, nb::none()},
                 [&](const Context& context) { write_graph(path, graph_of(axis, view, options, context), metadata); });
      },
      nb::arg("path"), nb::arg("axis"), nb::arg("mesh").none(), nb::arg("options"), nb::arg("metadata"));
  m.def(
      "with_axis_patches",
      [](const Complex& axis, const MeshArrays& mesh, const nb::dict& given, int threads, nb::object progress) {
        Complex out = axis;
        const MeshView view = mesh.view();
        const auto options = options_from<VoronoiPatchOptions>(given);
        run_call({threads, std::move(progress)}, [&](const Context& context) {
          add_axis_patch_columns(out, Solid::of(view, context), options, context);
          label_patch_sheets(out, context);
        });
        return out;
      },
      nb::arg("axis"), nb::arg("mesh"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  bind_options<SheetMatchOptions>(m);
  bind_struct<SheetMatches>(m);
  m.def(
      "match_sheets",
      [](const Complex& first, const Complex& second, const nb::dict& given, int threads, nb::object progress) {
        const auto options = options_from<SheetMatchOptions>(given);
        return result_of(run({threads, std::move(progress)},
                             [&](const Context& context) { return match_sheets(first, second, options, context); }));
      },
      nb::arg("first"), nb::arg("second"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace blum::python
