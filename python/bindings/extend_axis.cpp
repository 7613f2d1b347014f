#include "blum/axis/extend_axis.hpp"

#include <nanobind/stl/filesystem.h>

#include <filesystem>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/io/extended_io.hpp"
#include "call.hpp"
#include "structs.hpp"

namespace blum::python {

void bind_extend_axis(nb::module_& m) {
  bind_options<ExtendOptions>(m);
  bind_struct<ExtendReport>(m);
  m.def(
      "extend_axis",
      [](const Complex& axis, const MeshArrays& mesh, const nb::dict& given, int threads, nb::object progress) {
        const auto options = options_from<ExtendOptions>(given);
        ExtendedAxis out = run({threads, std::move(progress)}, [&](const Context& context) {
          return extend_axis(axis, mesh.view(), options, context);
        });
        return nb::make_tuple(std::move(out.surface), to_python(out.report), to_python(out.warnings));
      },
      nb::arg("axis"), nb::arg("mesh"), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  m.def(
      "write_extended",
      [](const std::filesystem::path& path, const Complex& surface, const nb::dict& stated) {
        auto metadata = options_from<MedialMetadata>(stated);
        metadata.version = BLUM_VERSION;
        run_call({0, nb::none()}, [&](const Context& context) { write_extended(path, surface, metadata, context); });
      },
      nb::arg("path"), nb::arg("surface"), nb::arg("metadata"));
}

}  // namespace blum::python
