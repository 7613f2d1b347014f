// Extension module blum._core: the C++ library on arrays. Only the Python package may call it.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <exception>
#include <string_view>

#include "bindings.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "call.hpp"

namespace blum::python {
namespace {

void raise(const char* name, const std::exception& error) {
  // Messages may contain file names, which may be any bytes.
  const std::string_view text = error.what();
  const auto message =
      nb::steal(PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "backslashreplace"));
  PyErr_SetObject(nb::module_::import_("blum._errors").attr(name).ptr(), message.ptr());
}

/// Raises exceptions of Blum as the exceptions of the same name in blum._errors.
void translate(const std::exception_ptr& thrown, void* /*payload*/) {
  try {
    std::rethrow_exception(thrown);
  } catch (const InvalidMesh& error) {
    raise("InvalidMesh", error);
  } catch (const InvalidGrid& error) {
    raise("InvalidGrid", error);
  } catch (const InvalidImage& error) {
    raise("InvalidImage", error);
  } catch (const InvalidOption& error) {
    raise("InvalidOption", error);
  } catch (const NotCertified& error) {
    raise("NotCertified", error);
  } catch (const OutOfMemory& error) {
    raise("OutOfMemory", error);
  } catch (const DeviceError& error) {
    raise("DeviceError", error);
  } catch (const Cancelled& error) {
    raise("Cancelled", error);
  } catch (const FormatError& error) {
    raise("FormatError", error);
  } catch (const FileError& error) {
    raise("FileError", error);
  } catch (const Error& error) {
    raise("Error", error);
  }
}

}  // namespace
}  // namespace blum::python

// NOLINTNEXTLINE: the macro is nanobind's
NB_MODULE(_core, m) {
  using namespace blum::python;
  m.doc() = "The C++ library on arrays. Private to the package.";
  nb::register_exception_translator(translate);
  end_calls_at_exit();
  m.attr("version") = BLUM_VERSION;
  m.attr("described") = nb::dict();
  m.attr("enums") = nb::dict();
  m.def("thread_count", [](int threads) { return blum::thread_count({.threads = threads}); }, nb::arg("threads") = 0);
  bind_grid(m);
  bind_geometry(m);
  bind_field(m);
  bind_device_field(m);
  bind_closest_points(m);
  bind_points(m);
  bind_surface_map(m);
  bind_images(m);
  bind_complex(m);
  bind_solid(m);
  bind_medial_axis(m);
  bind_axis_graph(m);
  bind_extend_axis(m);
  bind_voronoi(m);
  bind_centreline(m);
  bind_certificate(m);
  bind_proximity(m);
  bind_proximity_scene(m);
  bind_planning(m);
  bind_files(m);
}
