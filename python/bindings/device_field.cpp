#include "blum/field/device_field.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "blum/core/error.hpp"
#include "blum/field/device_distance_transform.hpp"
#include "fields.hpp"

namespace blum::python {
namespace {

struct NamedType {
  const char* name;  ///< as NumPy's typestr
  ElementType type;
  nb::dlpack::dtype dlpack;
  std::size_t bytes;
};

template <class T>
constexpr NamedType named(const char* name, ElementType type) {
  return {name, type, nb::dtype<T>(), sizeof(T)};
}
// A type that is named twice has its first name.
constexpr std::array<NamedType, 11> types{named<std::uint8_t>("|u1", ElementType::uint8),
                                          named<std::int8_t>("|i1", ElementType::int8),
                                          named<std::uint16_t>("<u2", ElementType::uint16),
                                          named<std::int16_t>("<i2", ElementType::int16),
                                          named<std::uint32_t>("<u4", ElementType::uint32),
                                          named<std::int32_t>("<i4", ElementType::int32),
                                          named<std::uint64_t>("<u8", ElementType::uint64),
                                          named<std::int64_t>("<i8", ElementType::int64),
                                          named<float>("<f4", ElementType::float32),
                                          named<double>("<f8", ElementType::float64),
                                          named<bool>("|b1", ElementType::uint8)};

/// An array in a device's memory, and what keeps it there.
struct DeviceArray {
  void* data = nullptr;
  std::vector<std::size_t> shape;
  std::optional<NamedType> type;  ///< none: one that Blum does not take
  bool is_contiguous = true;
  int device = 0;
  DeviceMemory memory;   ///< of its own,
  nb::object owner;      ///< or of another object,
  nb::ndarray<> import;  ///< or of one that came by DLPack

  /// @param axes  how many of the first count the rows.
  [[nodiscard]] DeviceArrayView view(std::size_t axes = 1) const {
    if (!type || !is_contiguous || shape.size() < axes) {
      throw InvalidOption("arrays on a device must be C-contiguous numbers");
    }
    std::size_t rows = 1;
    for (std::size_t axis = 0; axis < axes; ++axis) rows *= shape[axis];
    return {data, type->type, rows};
  }
};

std::optional<NamedType> named_type(const std::string& name) {
  for (const NamedType& type : types) {
    if (name == type.name) return type;
  }
  return std::nullopt;
}

DeviceArray of_capsule(nb::ndarray<> import) {
  DeviceArray array;
  array.data = import.data();
  for (const NamedType& type : types) {
    if (import.dtype() == type.dlpack) array.type = type;
  }
  std::int64_t step = 1;
  for (std::size_t axis = import.ndim(); axis-- > 0;) {
    array.shape.insert(array.shape.begin(), import.shape(axis));
    if (import.shape(axis) != 1 && import.stride(axis) != step) array.is_contiguous = false;
    step *= static_cast<std::int64_t>(import.shape(axis));
  }
  if (step == 0) array.is_contiguous = true;
  array.device = import.device_id();
  array.import = std::move(import);
  return array;
}

DeviceArray at_address(std::uintptr_t address, std::vector<std::size_t> shape, const std::string& type,
                       bool is_contiguous, int device, nb::object owner) {
  DeviceArray array;
  array.data = reinterpret_cast<void*>(address);  // NOLINT(performance-no-int-to-ptr): that is what it came as
  array.shape = std::move(shape);
  array.type = named_type(type);
  array.is_contiguous = is_contiguous;
  array.device = device;
  array.owner = std::move(owner);
  return array;
}

DeviceArray allocated(const std::string& device, std::vector<std::size_t> shape, const std::string& type) {
  DeviceArray array;
  array.type = named_type(type);
  std::size_t bytes = array.type->bytes;
  for (const std::size_t size : shape) bytes *= size;
  const Device there = parse_device(device);
  array.memory = DeviceMemory(there, bytes);
  array.data = array.memory.data();
  array.shape = std::move(shape);
  array.device = there.index;
  return array;
}

/// A DLPack capsule that keeps the array alive.
nb::object capsule_of(nb::pointer_and_handle<DeviceArray> array) {
  const DeviceArray& self = *array.p;
  const nb::ndarray<> view(self.data, self.shape.size(), self.shape.data(), array.h, nullptr, self.type->dlpack,
                           nb::device::cuda::value, self.device);
  return nb::cast(view);
}

void* stream_of(std::uintptr_t stream) {
  return reinterpret_cast<void*>(stream);  // NOLINT(performance-no-int-to-ptr): as CUDA's bindings have it
}

void bind_device_array(nb::module_& m) {
  nb::class_<DeviceArray>(m, "DeviceArray")
      .def_static("of_capsule", &of_capsule, nb::arg("capsule"))
      .def_static("at_address", &at_address, nb::arg("address"), nb::arg("shape"), nb::arg("type"),
                  nb::arg("is_contiguous"), nb::arg("device"), nb::arg("owner").none())
      .def_static("allocated", &allocated, nb::arg("device"), nb::arg("shape"), nb::arg("type"))
      .def_prop_ro("address", [](const DeviceArray& array) { return reinterpret_cast<std::uintptr_t>(array.data); })
      .def_prop_ro("shape", [](const DeviceArray& array) { return nb::tuple(nb::cast(array.shape)); })
      .def_prop_ro("type",
                   [](const DeviceArray& array) {
                     return array.type ? std::optional<std::string>(array.type->name) : std::nullopt;
                   })
      .def_ro("is_contiguous", &DeviceArray::is_contiguous)
      .def_ro("device", &DeviceArray::device)
      .def("capsule", &capsule_of);
}

void set_connectivity(DeviceFieldSolver& solver, const DeviceArray& vertices, const DeviceArray* triangles,
                      const DeviceArray* segments, const DeviceArray* points, std::uintptr_t stream) {
  const auto view = [](const DeviceArray* array) { return array == nullptr ? DeviceArrayView{} : array->view(); };
  const DeviceMeshView mesh{vertices.view(), view(triangles), view(segments), view(points)};
  const nb::gil_scoped_release released;
  solver.set_connectivity(mesh, stream_of(stream));
}

void compute(DeviceFieldSolver& solver, const DeviceArray& vertices, const DeviceArray& distance,
             const DeviceArray& site, std::uintptr_t stream) {
  const DeviceArrayView from = vertices.view();
  const DeviceFieldView to{static_cast<float*>(distance.data), static_cast<std::uint32_t*>(site.data)};
  const nb::gil_scoped_release released;
  solver.compute(from, to, stream_of(stream));
}

void transform(DeviceDistanceTransform& transform, const DeviceArray& values, const DeviceArray& distance,
               const DeviceArray& site, std::uintptr_t stream) {
  const DeviceArrayView from = values.view(3);
  const DeviceFieldView to{static_cast<float*>(distance.data), static_cast<std::uint32_t*>(site.data)};
  const nb::gil_scoped_release released;
  transform.compute(from, to, stream_of(stream));
}

/// What both solvers have.
template <class Solver>
void bind_queue(nb::class_<Solver>& type) {
  type.def_prop_ro("device", [](const Solver& solver) { return to_string(solver.device()); })
      .def("progress",
           [](const Solver& solver) {
             const DeviceProgress progress = solver.progress();
             return nb::make_tuple(progress.queued, progress.finished);
           })
      .def(
          "order",
          [](Solver& solver, std::uintptr_t before, std::uintptr_t after) {
            solver.order(stream_of(before), stream_of(after));
          },
          nb::arg("before"), nb::arg("after"));
}

}  // namespace

void bind_device_field(nb::module_& m) {
  bind_device_array(m);
  auto solver = nb::class_<DeviceFieldSolver>(m, "DeviceFieldSolver");
  solver
      .def(
          "__init__",
          [](DeviceFieldSolver* self, const GridSpec& grid, const std::string& sign, std::optional<double> band,
             const std::string& site_ids, const std::string& device) {
            new (self) DeviceFieldSolver(grid, field_options(sign, band, site_ids), {.device = parse_device(device)});
          },
          nb::arg("grid"), nb::arg("sign"), nb::arg("band").none(), nb::arg("site_ids"), nb::arg("device"))
      .def_prop_ro("sign_rule", [](const DeviceFieldSolver& self) { return std::string(to_string(self.sign_rule())); })
      .def("set_connectivity", &set_connectivity, nb::arg("vertices"), nb::arg("triangles").none(),
           nb::arg("segments").none(), nb::arg("points").none(), nb::arg("stream"))
      .def("compute", &compute, nb::arg("vertices"), nb::arg("distance"), nb::arg("site"), nb::arg("stream"));
  bind_queue(solver);

  auto transforms = nb::class_<DeviceDistanceTransform>(m, "DeviceDistanceTransform");
  transforms
      .def(
          "__init__",
          [](DeviceDistanceTransform* self, const GridSpec& grid, std::optional<std::int64_t> label,
             std::optional<double> threshold, bool is_signed, std::optional<double> band, const std::string& device) {
            DistanceTransformOptions options{.is_signed = is_signed, .band = band};
            if (label) options.selection = LabelSelection::of_label(*label);
            if (threshold) options.selection = LabelSelection::at_least(*threshold);
            new (self) DeviceDistanceTransform(grid, options, {.device = parse_device(device)});
          },
          nb::arg("grid"), nb::arg("label").none(), nb::arg("threshold").none(), nb::arg("is_signed"),
          nb::arg("band").none(), nb::arg("device"))
      .def("compute", &transform, nb::arg("values"), nb::arg("distance"), nb::arg("site"), nb::arg("stream"));
  bind_queue(transforms);
}

}  // namespace blum::python
