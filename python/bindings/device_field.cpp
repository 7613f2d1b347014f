#include "blum/field/device_field.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "blum/core/error.hpp"
#include "blum/field/cuda_devices.hpp"
#include "blum/field/device_distance_transform.hpp"
#include "call.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

struct NamedType {
  const char* name;  ///< As NumPy's typestr.
  ElementType type;
  nb::dlpack::dtype dlpack;
  std::size_t bytes;
};

template <class T>
constexpr NamedType named(const char* name, ElementType type) {
  return {name, type, nb::dtype<T>(), sizeof(T)};
}
// Booleans are read as uint8.
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

/// Array in a device's memory, and the owner of that memory.
struct DeviceArray {
  DeviceArray() = default;
  DeviceArray(DeviceArray&&) noexcept = default;
  DeviceArray& operator=(DeviceArray&&) noexcept = default;
  DeviceArray(const DeviceArray&) = delete;
  DeviceArray& operator=(const DeviceArray&) = delete;
  ~DeviceArray() {
    if (memory.data() == nullptr) return;
    const nb::gil_scoped_release released;  // Freeing waits for the device, which may wait for Python.
    memory = {};
  }

  void* data = nullptr;
  std::vector<std::size_t> shape;
  std::optional<NamedType> type;  ///< nullopt if Blum does not accept the type.
  bool is_contiguous = true;
  int device = 0;
  DeviceMemory memory;   ///< Set if the array owns its memory.
  nb::object owner;      ///< Set if another object owns it.
  nb::ndarray<> import;  ///< Set if it was imported by DLPack.

  /// Returns a view for Blum.
  /// @param axes  number of leading axes; the product of their sizes is the number of rows.
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
  if (import.device_type() != nb::device::cuda::value && import.device_type() != nb::device::cuda_managed::value) {
    throw InvalidOption("its DLPack capsule is not for a CUDA device");
  }
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
  array.data = reinterpret_cast<void*>(address);  // NOLINT(performance-no-int-to-ptr): Python passes an integer
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
  {
    const nb::gil_scoped_release released;
    array.memory = DeviceMemory(there, bytes);
  }
  array.data = array.memory.data();
  array.shape = std::move(shape);
  array.device = there.index;
  return array;
}

/// Returns a DLPack capsule that keeps the array alive.
nb::object capsule_of(nb::pointer_and_handle<DeviceArray> array) {
  const DeviceArray& self = *array.p;
  const nb::ndarray<> view(self.data, self.shape.size(), self.shape.data(), array.h, nullptr, self.type->dlpack,
                           nb::device::cuda::value, self.device);
  return nb::cast(view);
}

void* stream_of(std::uintptr_t stream) {
  return reinterpret_cast<void*>(stream);  // NOLINT(performance-no-int-to-ptr): CUDA's bindings use integers
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

/// Solver that many threads may call; the calls run one after the other. No thread holds Python's lock during a call,
/// because the device may wait for Python, too.
template <class Solver>
class Locked {
 public:
  template <class Options>
  Locked(const GridSpec& grid, const Options& options, const Context& context)
      : solver_(std::in_place, grid, options, context) {}
  Locked(const Locked&) = delete;
  Locked& operator=(const Locked&) = delete;
  ~Locked() {
    const nb::gil_scoped_release released;
    solver_.reset();
  }

  template <class Work>
  auto with(const Work& work) {
    const nb::gil_scoped_release released;
    const std::scoped_lock lock(mutex_);
    return work(*solver_);
  }

 private:
  std::mutex mutex_;
  std::optional<Solver> solver_;
};
using FieldSolverHere = Locked<DeviceFieldSolver>;
using TransformHere = Locked<DeviceDistanceTransform>;

/// @param site  may be nullptr.
DeviceFieldView output_of(const DeviceArray& distance, const DeviceArray* site) {
  return {static_cast<float*>(distance.data), site == nullptr ? nullptr : static_cast<std::uint32_t*>(site->data)};
}

/// Queues the computation of a field. Returns the number of pieces of work queued so far, including this one.
std::uint64_t compute(FieldSolverHere& solver, const DeviceArray& vertices, const DeviceArray* triangles,
                      const DeviceArray* segments, const DeviceArray* points, const DeviceArray& distance,
                      const DeviceArray* site, std::uintptr_t stream) {
  const auto view = [](const DeviceArray* array) { return array == nullptr ? DeviceArrayView{} : array->view(); };
  const DeviceMeshView mesh{vertices.view(), view(triangles), view(segments), view(points)};
  const bool has_connectivity = triangles != nullptr || segments != nullptr || points != nullptr;
  const DeviceFieldView to = output_of(distance, site);
  return solver.with([&](DeviceFieldSolver& own) {
    if (has_connectivity) own.set_connectivity(mesh, stream_of(stream));
    own.compute(mesh.vertices, to, stream_of(stream));
    return own.progress().queued;
  });
}

std::uint64_t transform(TransformHere& transform, const DeviceArray& values, const DeviceArray& distance,
                        const DeviceArray* site, std::uintptr_t stream) {
  const DeviceArrayView from = values.view(3);
  const DeviceFieldView to = output_of(distance, site);
  return transform.with([&](DeviceDistanceTransform& own) {
    own.compute(from, to, stream_of(stream));
    return own.progress().queued;
  });
}

/// Binds the functions that both solvers have.
template <class Solver>
void bind_queue(nb::class_<Locked<Solver>>& type) {
  type.def_prop_ro(
          "device",
          [](Locked<Solver>& self) { return self.with([](const Solver& own) { return to_string(own.device()); }); })
      .def("progress",
           [](Locked<Solver>& self) {
             const DeviceProgress progress = self.with([](const Solver& own) { return own.progress(); });
             return nb::make_tuple(progress.queued, progress.finished);
           })
      .def(
          "device_of",
          [](Locked<Solver>& self, std::uintptr_t address) {
            return self.with([&](const Solver& own) -> std::optional<int> {
              const std::optional<Device> device = own.device_of(stream_of(address));
              return device ? std::make_optional(device->index) : std::nullopt;
            });
          },
          nb::arg("address"))
      .def(
          "follow",
          [](Locked<Solver>& self, std::uint64_t pieces, std::uintptr_t stream) {
            self.with([&](Solver& own) { own.follow(pieces, stream_of(stream)); });
          },
          nb::arg("pieces"), nb::arg("stream"))
      .def(
          "order",
          [](Locked<Solver>& self, std::uintptr_t before, std::uintptr_t after) {
            self.with([&](Solver& own) { own.order(stream_of(before), stream_of(after)); });
          },
          nb::arg("before"), nb::arg("after"));
}

}  // namespace

void bind_device_field(nb::module_& m) {
  bind_struct<CudaDevices>(m);
  m.def("cuda_devices", [] { return result_of(run({0, nb::none()}, [](const Context&) { return cuda_devices(); })); });
  bind_device_array(m);
  auto solver = nb::class_<FieldSolverHere>(m, "DeviceFieldSolver");
  solver
      .def(
          "__init__",
          [](FieldSolverHere* self, const GridSpec& grid, const nb::dict& options, const std::string& device) {
            new (self)
                FieldSolverHere(grid, options_from<FieldOptions>(options), Context{.device = parse_device(device)});
          },
          nb::arg("grid"), nb::arg("options"), nb::arg("device"))
      .def_prop_ro("options",
                   [](FieldSolverHere& self) {
                     return dict_of(self.with([](const DeviceFieldSolver& own) { return own.options(); }));
                   })
      .def_prop_ro(
          "sign_rule",
          [](FieldSolverHere& self) {
            return self.with([](const DeviceFieldSolver& own) { return std::string(to_string(own.sign_rule())); });
          })
      .def("compute", &compute, nb::arg("vertices"), nb::arg("triangles").none(), nb::arg("segments").none(),
           nb::arg("points").none(), nb::arg("distance"), nb::arg("site").none(), nb::arg("stream"));
  bind_queue(solver);

  auto transforms = nb::class_<TransformHere>(m, "DeviceDistanceTransform");
  transforms
      .def(
          "__init__",
          [](TransformHere* self, const GridSpec& grid, const nb::dict& options, const std::string& device) {
            new (self) TransformHere(grid, options_from<DistanceTransformOptions>(options),
                                     Context{.device = parse_device(device)});
          },
          nb::arg("grid"), nb::arg("options"), nb::arg("device"))
      .def_prop_ro("options",
                   [](TransformHere& self) {
                     return dict_of(self.with([](const DeviceDistanceTransform& own) { return own.options(); }));
                   })
      .def("compute", &transform, nb::arg("values"), nb::arg("distance"), nb::arg("site").none(), nb::arg("stream"));
  bind_queue(transforms);
}

}  // namespace blum::python
