#include "blum/voronoi/voronoi_complex.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/io/voronoi_io.hpp"
#include "blum/solid/solid.hpp"
#include "blum/voronoi/failing_cells.hpp"
#include "blum/voronoi/voronoi_graph.hpp"
#include "blum/voronoi/voronoi_patches.hpp"
#include "blum/voronoi/voronoi_regions.hpp"
#include "blum/voronoi/voronoi_sites.hpp"
#include "call.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

/// VoronoiReport::joined_faces.
using JoinedFaces = std::vector<std::array<std::uint32_t, 2>>;

std::vector<VoronoiSite> sites_of(const MeshView& mesh, JoinedFaces joined, const Context& context) {
  VoronoiReport report;
  report.joined_faces = std::move(joined);
  return voronoi_sites(mesh, report, context);
}

/// Sites of a complex as patches.
struct Joining {
  const MeshView& mesh;
  JoinedFaces joined;
  VoronoiPatchOptions options;
};

std::vector<VoronoiPatch> patches_of(const Joining& how, const Context& context) {
  return voronoi_patches(how.mesh, sites_of(how.mesh, how.joined, context), how.options, context);
}

/// @param patches  options of the patches; None in Python if the graph is that of the sites.
VoronoiGraph graph_of(const Complex& complex, const MeshView& mesh, const JoinedFaces& joined,
                      const std::optional<VoronoiPatchOptions>& patches, const Context& context) {
  if (!patches) return voronoi_graph(complex, context);
  return voronoi_graph(complex, patches_of({mesh, joined, *patches}, context), context);
}

std::optional<VoronoiPatchOptions> patch_options(const std::optional<nb::dict>& given) {
  if (!given) return std::nullopt;
  return options_from<VoronoiPatchOptions>(*given);
}

}  // namespace

void bind_voronoi(nb::module_& m) {
  bind_options<VoronoiOptions>(m);
  bind_struct<FailingVoronoiCell>(m);
  bind_struct<VoronoiNeighbour>(m);
  bind_struct<VoronoiRegion>(m);
  bind_struct<VoronoiReport>(m);
  m.def(
      "voronoi_complex",
      [](const Solid& solid, const nb::dict& given, int threads, nb::object progress) {
        const auto options = options_from<VoronoiOptions>(given);
        VoronoiComplex out = run({threads, std::move(progress)},
                                 [&](const Context& context) { return voronoi_complex(solid, options, context); });
        return nb::make_tuple(std::move(out.complex), to_python(out.report));
      },
      nb::arg("solid"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "voronoi_regions",
      [](const Complex& complex) {
        nb::list out;
        for (const VoronoiRegion& region : voronoi_regions(complex)) out.append(to_python(region));
        return out;
      },
      nb::arg("complex"));
  bind_struct<VoronoiSite>(m);
  m.def(
      "voronoi_sites",
      [](const MeshArrays& mesh, JoinedFaces joined) {
        nb::list out;
        for (const VoronoiSite& site : sites_of(mesh.view(), std::move(joined), {})) out.append(to_python(site));
        return out;
      },
      nb::arg("mesh"), nb::arg("joined_faces"));
  bind_struct<VoronoiWall>(m);
  bind_struct<VoronoiSeam>(m);
  bind_struct<VoronoiJunction>(m);
  bind_options<VoronoiPatchOptions>(m);
  bind_struct<VoronoiPatch>(m);
  bind_struct<VoronoiGraph>(m);
  m.def(
      "voronoi_patches",
      [](const MeshArrays& mesh, const JoinedFaces& joined, const nb::dict& given) {
        nb::list out;
        const MeshView view = mesh.view();
        const auto options = options_from<VoronoiPatchOptions>(given);
        const auto found =
            run({0, nb::none()}, [&](const Context& context) { return patches_of({view, joined, options}, context); });
        for (const VoronoiPatch& patch : found) out.append(to_python(patch));
        return out;
      },
      nb::arg("mesh"), nb::arg("joined_faces"), nb::arg("options"));
  m.def(
      "with_patches",
      [](const Complex& complex, const MeshArrays& mesh, const JoinedFaces& joined, const nb::dict& given) {
        Complex out = complex;
        const MeshView view = mesh.view();
        const auto options = options_from<VoronoiPatchOptions>(given);
        run_call({0, nb::none()},
                 [&](const Context& context) { add_patch_columns(out, patches_of({view, joined, options}, context)); });
        return out;
      },
      nb::arg("complex"), nb::arg("mesh"), nb::arg("joined_faces"), nb::arg("options"));
  m.def(
      "voronoi_graph",
      [](const Complex& complex, const MeshArrays& mesh, const JoinedFaces& joined,
         const std::optional<nb::dict>& given) {
        const MeshView view = mesh.view();
        const auto options = patch_options(given);
        return result_of(run({0, nb::none()}, [&](const Context& context) {
          return graph_of(complex, view, joined, options, context);
        }));
      },
      nb::arg("complex"), nb::arg("mesh"), nb::arg("joined_faces"), nb::arg("options").none());
  m.def(
      "write_voronoi_graph",
      [](const std::filesystem::path& path, const Complex& complex, const MeshArrays& mesh, const JoinedFaces& joined,
         const std::optional<nb::dict>& given, const std::vector<std::pair<std::string, std::string>>& metadata) {
        const MeshView view = mesh.view();
        const auto options = patch_options(given);
        run_call({0, nb::none()}, [&](const Context& context) {
          const VoronoiGraph graph = graph_of(complex, view, joined, options, context);
          write_voronoi_graph(path, graph, sites_of(view, joined, context), metadata);
        });
      },
      nb::arg("path"), nb::arg("complex"), nb::arg("mesh"), nb::arg("joined_faces"), nb::arg("options").none(),
      nb::arg("metadata"));
  using Cell = std::tuple<std::array<double, 3>, std::array<double, 3>, std::string>;
  m.def(
      "with_failing_cells",
      [](const Complex& complex, const std::vector<Cell>& cells) {
        std::vector<FailingVoronoiCell> failing;
        for (const auto& [low, high, obstacle] : cells) {
          failing.push_back({{low[0], low[1], low[2]},
                             {high[0], high[1], high[2]},
                             parse_enum<VoronoiObstacle>("obstacle", obstacle)});
        }
        Complex out = complex;
        add_failing_cells(out, failing);
        return out;
      },
      nb::arg("complex"), nb::arg("cells"));
  m.def(
      "voronoi_metadata",
      [](const std::string& part, std::optional<double> hausdorff_bound, std::size_t failing_cubes) {
        nb::dict out;
        const auto of_part = parse_enum<VoronoiPart>("part", part);
        for (const auto& [key, value] : voronoi_metadata(of_part, hausdorff_bound, failing_cubes, BLUM_VERSION)) {
          out[key.c_str()] = value;
        }
        return out;
      },
      nb::arg("part"), nb::arg("hausdorff_bound").none(), nb::arg("failing_cubes"));
}

}  // namespace blum::python
