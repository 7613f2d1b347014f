#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/field_io.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/image_io.hpp"
#include "blum/io/medial_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "call.hpp"
#include "images.hpp"
#include "structs.hpp"

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
      [](const Path& path) {
        ImageFile file = run({0, nb::none()}, [&](const Context&) { return read_image_file(path); });
        return nb::make_tuple(image_of(std::move(file.image)), to_python(file.warnings));
      },
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

nb::dict texts_of(const FileMetadata& metadata) {
  nb::dict out;
  for (const auto& [key, value] : metadata) out[nb::str(key.c_str(), key.size())] = value;
  return out;
}

void bind_complex_files(nb::module_& m) {
  m.def(
      "read_complex",
      [](const Path& path) {
        ComplexFile file = run({0, nb::none()}, [&](const Context&) { return read_complex(path); });
        nb::dict further;
        for (NamedComplex& one : file.further)
          further[nb::str(one.name.c_str(), one.name.size())] = std::move(one.complex);
        return nb::make_tuple(std::move(file.complex), texts_of(file.metadata), further);
      },
      nb::arg("path"));
  m.def(
      "write_complex",
      [](const Path& path, const Complex& complex, const std::vector<std::pair<std::string, std::string>>& metadata,
         const std::vector<std::pair<std::string, const Complex*>>& further, bool allow_loss) {
        ComplexWriteOptions how;
        how.allow_loss = allow_loss;
        for (const auto& [name, one] : further) how.further.push_back({name, one});
        run_call({0, nb::none()},
                 [&](const Context& context) { write_complex(path, complex, metadata, how, context); });
      },
      nb::arg("path"), nb::arg("complex"), nb::arg("metadata"), nb::arg("further"), nb::arg("allow_loss"));
}

/// Returns for each attribute whether the file of an axis has it.
nb::dict has_of(const MedialFile& file) {
  nb::dict out;
  out["radii"] = file.has_radii;
  out["footprints"] = file.has_footprints;
  out["angles"] = file.has_angles;
  out["sites"] = file.has_sites;
  out["labels"] = file.has_labels;
  return out;
}

void bind_medial_files(nb::module_& m) {
  m.def(
      "read_medial",
      [](const Path& path) {
        MedialFile file = run({0, nb::none()}, [&](const Context&) { return read_medial(path); });
        return nb::make_tuple(std::move(file.complex), std::move(file.nested), file.least_theta, dict_of(file.metadata),
                              has_of(file));
      },
      nb::arg("path"));
  m.def(
      "write_medial",
      [](const Path& path, const Complex& complex, const Complex* nested, double least_theta, const nb::dict& given) {
        auto metadata = options_from<MedialMetadata>(given);
        metadata.version = BLUM_VERSION;
        run_call({0, nb::none()}, [&](const Context& context) {
          if (nested != nullptr) return write_medial(path, complex, *nested, least_theta, metadata, context);
          write_medial(path, complex, metadata, context);
        });
      },
      nb::arg("path"), nb::arg("complex"), nb::arg("nested").none(), nb::arg("least_theta"), nb::arg("metadata"));
}

void bind_formats(nb::module_& m) {
  bind_struct<FileFormat>(m);
  m.def("file_formats", [] { return result_of(file_formats()); });
}

}  // namespace

void bind_files(nb::module_& m) {
  bind_formats(m);
  bind_meshes(m);
  bind_volumes(m);
  bind_complex_files(m);
  bind_medial_files(m);
}

}  // namespace blum::python
