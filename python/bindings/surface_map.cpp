#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/io/surface_map_io.hpp"
#include "blum/surface_map/hausdorff_distance.hpp"
#include "blum/surface_map/surface_deviation.hpp"
#include "blum/surface_map/surface_distance_map.hpp"
#include "blum/surface_map/surface_map_statistics.hpp"
#include "blum/surface_map/thickness.hpp"
#include "call.hpp"
#include "columns.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

/// Returns (thickness, opposite points, triangles), views of one block of memory.
nb::tuple columns_of(std::vector<Thickness> found) {
  const Held<Thickness> kept = held(std::move(found));
  const auto shown = [&](auto member) { return column(*kept.entries, member, kept.owner); };
  return nb::make_tuple(shown(&Thickness::thickness), shown(&Thickness::opposite), shown(&Thickness::triangle));
}

/// Returns a map as arrays, which keep it alive. `_handle` is the map itself, for write_surface_map().
nb::dict dict_of(SurfaceMap found) {
  const nb::object owner = nb::cast(std::move(found), nb::rv_policy::move);
  SurfaceMap& map = nb::cast<SurfaceMap&>(owner);
  const SurfaceAtlas& atlas = *map.atlas;
  const std::size_t h = atlas.height;
  const std::size_t w = atlas.width;
  static_assert(sizeof(TexturePlace) == 2 * sizeof(double) && sizeof(SurfaceMap::FaceSummary) == 3 * sizeof(float));
  nb::dict out;
  out["quantity"] = std::string(to_string(map.quantity));
  out["distance"] = view_of<float>(map.distance.data(), {h, w}, owner);
  out["vector"] = view_of<float>(reinterpret_cast<float*>(map.vector.data()), {h, w, 3}, owner);
  out["site"] = view_of<std::int32_t>(reinterpret_cast<std::int32_t*>(map.site.data()), {h, w}, owner);
  out["triangle"] =
      view_of<const std::int32_t>(reinterpret_cast<const std::int32_t*>(atlas.triangle.data()), {h, w}, owner);
  out["corners"] =
      view_of<const double>(reinterpret_cast<const double*>(atlas.corners.data()), {atlas.corners.size(), 3, 2}, owner);
  out["error"] = map.error.empty() ? nb::none() : nb::cast(view_of<float>(map.error.data(), {map.error.size()}, owner));
  out["vertex_distance"] = view_of<double>(map.vertex_distance.data(), {map.vertex_distance.size()}, owner);
  out["faces"] = view_of<float>(reinterpret_cast<float*>(map.faces.data()), {map.faces.size(), 3}, owner);
  out["sign_rule"] = std::string(to_string(map.sign_rule));
  out["sign_reason"] = map.sign_reason;
  out["seconds"] = seconds_of(map.phases);
  out["warnings"] = to_python(map.warnings);
  out["_handle"] = owner;
  return out;
}

void bind_maps(nb::module_& m) {
  nb::class_<SurfaceMap>(m, "SurfaceMap");  // NOLINT(bugprone-unused-raii): the constructor registers the type
  m.def(
      "write_surface_map",
      [](const std::filesystem::path& path, const MeshArrays& mesh, const SurfaceMap& map,
         const std::vector<std::pair<std::string, std::string>>& metadata,
         const std::optional<std::pair<double, double>>& range, const std::string& units) {
        const MeshView view = mesh.view();
        run_call({0, nb::none()}, [&](const Context& context) {
          write_surface_map(path, view, map, {metadata.begin(), metadata.end()}, {range, units}, context);
        });
      },
      nb::arg("path"), nb::arg("mesh"), nb::arg("map"), nb::arg("metadata"), nb::arg("range").none(), nb::arg("units"));
  m.def(
      "read_surface_map",
      [](const std::filesystem::path& path) {
        SurfaceMapFile file = run({0, nb::none()}, [&](const Context&) { return read_surface_map(path); });
        nb::tuple mesh = arrays_of(std::move(file.mesh));
        return nb::make_tuple(std::move(mesh), dict_of(std::move(file.map)));
      },
      nb::arg("path"));
  m.def(
      "surface_map_statistics",
      [](const MeshArrays& mesh, const SurfaceMap& map) {
        const MeshView view = mesh.view();
        return result_of(run({0, nb::none()}, [&](const Context&) { return surface_map_statistics(view, map); }));
      },
      nb::arg("mesh"), nb::arg("map"));
  m.def(
      "surface_distance_map",
      [](const MeshArrays& target, const MeshArrays& other, const nb::dict& given, int threads, nb::object progress) {
        const MeshView view = target.view();
        const MeshView facing = other.view();
        const auto options = options_from<SurfaceMapOptions>(given);
        return dict_of(run({threads, std::move(progress)}, [&](const Context& context) {
          return surface_distance_map(view, facing, options, context);
        }));
      },
      nb::arg("target"), nb::arg("other"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "self_distance_map",
      [](const MeshArrays& target, const nb::dict& given, int threads, nb::object progress) {
        const MeshView view = target.view();
        const auto options = options_from<SurfaceMapOptions>(given);
        return dict_of(run({threads, std::move(progress)},
                           [&](const Context& context) { return self_distance_map(view, options, context); }));
      },
      nb::arg("target"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "thickness_map",
      [](const MeshArrays& solid, const nb::dict& given, const nb::dict& how, int threads, nb::object progress) {
        const MeshView view = solid.view();
        const auto options = options_from<SurfaceMapOptions>(given);
        const auto meaning = options_from<ThicknessOptions>(how);
        return dict_of(run({threads, std::move(progress)},
                           [&](const Context& context) { return thickness_map(view, options, meaning, context); }));
      },
      nb::arg("solid"), nb::arg("options"), nb::arg("thickness"), nb::arg("threads"), nb::arg("progress").none());
}

/// Makes an atlas from the positions of the corners of triangles, [t, 3, 2], in texels.
SurfaceAtlas atlas_of(const MeshView& mesh, const In<double, nb::shape<-1, 3, 2>>& places, std::uint32_t width,
                      std::uint32_t height, const Context& context) {
  const std::size_t count = 3 * places.shape(0);
  std::vector<TexturePlace> coordinates(count);
  std::vector<Triangle> corners(places.shape(0));
  for (std::size_t k = 0; k < count; ++k) {
    coordinates[k] = {places.data()[2 * k], places.data()[2 * k + 1]};
    corners[k / 3][k % 3] = static_cast<std::uint32_t>(k);
  }
  return surface_atlas_from(mesh, coordinates, corners, width, height, context);
}

void bind_mapper(nb::module_& m) {
  nb::class_<SurfaceMapper>(m, "SurfaceMapper")
      .def(
          "__init__",
          [](SurfaceMapper* self, const MeshArrays& target, const MeshArrays& other, const nb::dict& given,
             const std::optional<In<double, nb::shape<-1, 3, 2>>>& places, std::uint32_t width, std::uint32_t height,
             int threads, nb::object progress) {
            const MeshView view = target.view();
            const MeshView facing = other.view();
            const auto options = options_from<SurfaceMapOptions>(given);
            new (self) SurfaceMapper(run({threads, std::move(progress)}, [&](const Context& context) {
              if (!places) return SurfaceMapper(view, facing, options, context);
              return SurfaceMapper(view, atlas_of(view, *places, width, height, context), facing, options, context);
            }));
          },
          nb::arg("target"), nb::arg("other"), nb::arg("options"), nb::arg("places").none(), nb::arg("width"),
          nb::arg("height"), nb::arg("threads"), nb::arg("progress").none())
      .def(
          "move_target", [](SurfaceMapper& self, const PointsIn& to) { self.move_target(vectors(to)); },
          nb::arg("vertices").noconvert())
      .def(
          "move_other",
          [](SurfaceMapper& self, const PointsIn& to, int threads) {
            run_call({threads, nb::none()}, [&](const Context& context) { self.move_other(vectors(to), context); });
          },
          nb::arg("vertices").noconvert(), nb::arg("threads"))
      .def(
          "replace_other",
          [](SurfaceMapper& self, const MeshArrays& other, int threads) {
            const MeshView view = other.view();
            run_call({threads, nb::none()}, [&](const Context& context) { self.replace_other(view, context); });
          },
          nb::arg("other"), nb::arg("threads"))
      .def(
          "map",
          [](const SurfaceMapper& self, int threads, nb::object progress) {
            return dict_of(
                run({threads, std::move(progress)}, [&](const Context& context) { return self.map(context); }));
          },
          nb::arg("threads"), nb::arg("progress").none());
}

/// Binds a function of two meshes.
/// @param first, second  names of the parameters for the meshes.
template <class Options, class Result>
void bind_comparison(nb::module_& m, const char* name, const char* first, const char* second,
                     Result (*compare)(const MeshView&, const MeshView&, const Options&, const Context&)) {
  m.def(
      name,
      [compare](const MeshArrays& a, const MeshArrays& b, const nb::dict& given, int threads, nb::object progress) {
        const MeshView of = a.view();
        const MeshView to = b.view();
        const auto options = options_from<Options>(given);
        return result_of(run({threads, std::move(progress)},
                             [&](const Context& context) { return compare(of, to, options, context); }));
      },
      nb::arg(first), nb::arg(second), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace

void bind_surface_map(nb::module_& m) {
  bind_options<SurfaceMapOptions>(m);
  bind_options<ThicknessOptions>(m);
  bind_options<HausdorffOptions>(m);
  bind_options<DeviationOptions>(m);
  bind_struct<HausdorffDistance>(m);
  bind_struct<SurfaceDeviation>(m);
  bind_struct<SurfaceMapStatistics>(m);
  bind_maps(m);
  bind_mapper(m);
  bind_comparison(m, "hausdorff_distance", "a", "b", hausdorff_distance);
  bind_comparison(m, "directed_hausdorff_distance", "mesh", "other", directed_hausdorff_distance);
  bind_comparison(m, "surface_deviation", "mesh", "other", surface_deviation);
  m.def(
      "thickness",
      [](const MeshArrays& solid, const std::optional<PointsIn>& points, const nb::dict& given, int threads,
         nb::object progress) {
        const MeshView view = solid.view();
        const auto options = options_from<ThicknessOptions>(given);
        const std::span<const Vec3d> places = points ? vectors(*points) : std::span<const Vec3d>{};
        return columns_of(run({threads, std::move(progress)}, [&](const Context& context) {
          return points ? thickness(view, places, options, context) : thickness(view, options, context);
        }));
      },
      nb::arg("solid"), nb::arg("points").none(), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "thickness_warnings",
      [](const MeshArrays& solid, int threads) {
        const MeshView view = solid.view();
        return result_of(
            run({threads, nb::none()}, [&](const Context& context) { return thickness_warnings(view, context); }));
      },
      nb::arg("solid"), nb::arg("threads"));
}

}  // namespace blum::python
