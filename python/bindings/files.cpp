#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/io/field_io.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/image_io.hpp"
#include "blum/io/medial_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "call.hpp"
#include "images.hpp"

namespace blum::python {
namespace {

using Path = std::filesystem::path;

void bind_meshes(nb::module_& m) {
  m.def(
      "read_mesh",
      [](const Path& path, std::optional<double> weld) {
        MeshFile file = run({0, nb::none()}, [&](const Context&) { return read_mesh_file(path, {weld}); });
        nb::dict info;
        info["format"] = file.info.format.name();
        info["binary"] = file.info.binary;
        info["vertices"] = file.info.vertices;
        info["faces"] = file.info.faces;
        info["polygons"] = file.info.polygons;
        info["fan_polygons"] = file.info.fan_polygons;
        info["welded"] = file.info.welded;
        info["merged_vertices"] = file.info.merged_vertices;
        return nb::make_tuple(arrays_of(std::move(file.mesh)), info);
      },
      nb::arg("path"), nb::arg("weld").none());
  m.def(
      "write_mesh",
      [](const Path& path, const MeshArrays& mesh) {
        const MeshView view = mesh.view();
        run_call({0, nb::none()}, [&](const Context&) { write_mesh(path, view); });
      },
      nb::arg("path"), nb::arg("mesh"));
}

void bind_volumes(nb::module_& m) {
  m.def(
      "read_image",
      [](const Path& path) { return image_of(run({0, nb::none()}, [&](const Context&) { return read_image(path); })); },
      nb::arg("path"));
  m.def(
      "write_image",
      [](const Path& path, const ImageArrays& image) {
        run_call({0, nb::none()}, [&](const Context&) { write_image(path, image.view); });
      },
      nb::arg("path"), nb::arg("image"));
  m.def(
      "read_field",
      [](const Path& path) { return run({0, nb::none()}, [&](const Context&) { return read_field(path); }); },
      nb::arg("path"));
  m.def(
      "write_field",
      [](const Path& path, const Field& field, const MeshArrays* mesh, const std::string& source,
         const std::string& space, int threads, nb::object progress) {
        const std::optional<MeshView> view = mesh == nullptr ? std::nullopt : std::optional(mesh->view());
        const FieldFileInfo info{view ? &*view : nullptr, nullptr, source, BLUM_VERSION, space};
        run_call({threads, std::move(progress)},
                 [&](const Context& context) { write_field(path, field, info, context); });
      },
      nb::arg("path"), nb::arg("field"), nb::arg("mesh").none(), nb::arg("source"), nb::arg("space"),
      nb::arg("threads"), nb::arg("progress").none());
}

template <class T>
void set(nb::dict& out, const char* name, const std::optional<T>& value) {
  if (value) out[name] = nb::cast(*value);
}

nb::dict metadata_of(const MedialFile& file) {
  const MedialMetadata& metadata = file.metadata;
  nb::dict out;
  out["source"] = metadata.source;
  out["version"] = metadata.version;
  out["site_ids"] = std::string(to_string(metadata.site_ids));
  out["solid_rule"] = metadata.solid_rule;
  set(out, "theta", metadata.theta);
  set(out, "lambda", metadata.lambda);
  set(out, "spacing", metadata.spacing);
  set(out, "grid", metadata.grid);
  set(out, "label", metadata.label);
  set(out, "threshold", metadata.threshold);
  set(out, "weld", metadata.weld);
  out["least_theta"] = file.least_theta;
  out["has_radii"] = file.has_radii;
  out["has_footprints"] = file.has_footprints;
  out["has_sites"] = file.has_sites;
  out["has_angles"] = file.has_angles;
  out["has_labels"] = file.has_labels;
  return out;
}

void bind_medial_files(nb::module_& m) {
  m.def(
      "read_medial",
      [](const Path& path) {
        MedialFile file = run({0, nb::none()}, [&](const Context&) { return read_medial(path); });
        nb::dict metadata = metadata_of(file);
        return nb::make_tuple(std::move(file.complex), std::move(file.nested), metadata);
      },
      nb::arg("path"));
  m.def(
      "write_medial",
      [](const Path& path, const Complex& complex, const Complex* nested, double least_theta, const std::string& source,
         const std::string& site_ids, const std::string& solid_rule, std::optional<double> theta,
         std::optional<double> lambda, std::optional<double> spacing, const GridSpec* grid,
         std::optional<std::int64_t> label, std::optional<double> threshold, std::optional<double> weld) {
        MedialMetadata metadata;
        metadata.source = source;
        metadata.version = BLUM_VERSION;
        metadata.site_ids = site_ids == to_string(SiteIds::voxels) ? SiteIds::voxels : SiteIds::features;
        metadata.solid_rule = solid_rule;
        metadata.theta = theta;
        metadata.lambda = lambda;
        metadata.spacing = spacing;
        if (grid != nullptr) metadata.grid = *grid;
        metadata.label = label;
        metadata.threshold = threshold;
        metadata.weld = weld;
        run_call({0, nb::none()}, [&](const Context& context) {
          if (nested != nullptr) return write_medial(path, complex, *nested, least_theta, metadata, context);
          write_medial(path, complex, metadata, context);
        });
      },
      nb::arg("path"), nb::arg("complex"), nb::arg("nested").none(), nb::arg("least_theta"), nb::arg("source"),
      nb::arg("site_ids"), nb::arg("solid_rule"), nb::arg("theta").none(), nb::arg("lambda_").none(),
      nb::arg("spacing").none(), nb::arg("grid").none(), nb::arg("label").none(), nb::arg("threshold").none(),
      nb::arg("weld").none());
}

void bind_formats(nb::module_& m) {
  m.def("file_formats", [] {
    nb::list out;
    for (const FileFormat& format : file_formats()) {
      out.append(nb::make_tuple(std::string(to_string(format.content)), format.name, format.extensions, format.written,
                                format.holds, format.opens_in));
    }
    return out;
  });
}

}  // namespace

void bind_files(nb::module_& m) {
  bind_formats(m);
  bind_meshes(m);
  bind_volumes(m);
  bind_medial_files(m);
}

}  // namespace blum::python
