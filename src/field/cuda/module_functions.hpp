// Blum: functions of the module, for any platform that runs kernels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "blum/core/error.hpp"
#include "field/cuda/module_interface.hpp"
#include "field/kernels/field_engine.hpp"
#include "field/kernels/image_engine.hpp"

namespace blum::cuda {

/// Functions of the module. Exceptions are turned into a Status. Platform is CudaPlatform, or in the tests a platform
/// that runs on the host. A platform must have these members:
///
///   `Device` launches kernels.
///   `Queue` owns a Device and the stream on which it queues work. Members: device(), enter(stream), leave(), queued(),
///     finished(), wait(), follow(pieces, stream), order(before, after).
///   `Choice` makes a device the current one while it is alive.
///   `static void expect_device(int index)` throws DeviceError if the device does not exist.
///   `static void expect_runnable()` throws DeviceError if the current device cannot run the module.
///   `static int device_of(const void* memory)` returns the index of the device that owns memory, -1 for the host's.
///   `static void* allocate(std::size_t bytes)`, `static void release(void*)`.
///   `static std::string name_of(int index)`, `static std::uint64_t memory_of(int index)`.
///   `static std::size_t slab_nodes()` returns the number of nodes per slab for fields that are copied to the host's
///     memory.
template <class Platform>
class ModuleFunctions {
 public:
  [[nodiscard]] static const Module* table() {
    static const Module module{
        module_version, create,          destroy,   set_connectivity, compute,         set_connectivity_there,
        compute_there,  transform_there, progress,  follow,           order,           device_of,
        allocate,       release,         set_image, select_voxels,    transform_image, describe_device};
    return &module;
  }

 private:
  /// One device, its queue, and the data that it keeps for a solver.
  struct Engine {
    explicit Engine(int device_index)
        : index(device_index), fields(queue.device(), Platform::slab_nodes()), images(queue.device()) {}

    int index;
    typename Platform::Queue queue;
    kernels::FieldEngine<typename Platform::Device> fields;
    kernels::ImageEngine<typename Platform::Device> images;
  };

  /// While alive, makes an engine queue its work on a stream of the caller.
  class Visit {
   public:
    Visit(Engine& engine, void* stream) : engine_(engine) { engine_.queue.enter(stream); }
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;
    ~Visit() { engine_.queue.leave(); }

   private:
    Engine& engine_;
  };

  template <class Work>
  static Status guarded(int device, Call* call, const Work& work) {
    const auto fail = [&](Status status, const char* what) {
      std::snprintf(call->message, sizeof(call->message), "%s", what);
      return status;
    };
    try {
      Platform::expect_device(device);
      const typename Platform::Choice choice(device);
      work();
    } catch (const OutOfMemory& error) {
      return fail(Status::out_of_memory, error.what());
    } catch (const InvalidMesh& error) {
      return fail(Status::invalid_mesh, error.what());
    } catch (const InvalidGrid& error) {
      return fail(Status::invalid_grid, error.what());
    } catch (const InvalidOption& error) {
      return fail(Status::invalid_option, error.what());
    } catch (const std::bad_alloc&) {
      return fail(Status::out_of_memory, "not enough memory on the host");
    } catch (const Cancelled& error) {
      return fail(Status::cancelled, error.what());
    } catch (const std::exception& error) {
      return fail(Status::device_error, error.what());
    }
    return Status::done;
  }
  /// Runs work(engine), with the engine's device as the current one.
  template <class Work>
  static Status with(void* engine, Call* call, const Work& work) {
    auto& own = *static_cast<Engine*>(engine);
    return guarded(own.index, call, [&] { work(own); });
  }

  static Status create(int device, void** engine, Call* call) {
    *engine = nullptr;
    return guarded(device, call, [&] {
      Platform::expect_runnable();
      *engine = new Engine(device);
    });
  }
  static void destroy(void* engine) {
    auto* own = static_cast<Engine*>(engine);
    if (own == nullptr) return;
    Call call;
    (void)guarded(own->index, &call, [&] {
      own->queue.wait();
      delete own;
    });
  }

  static Status set_connectivity(void* engine, const MeshView* mesh, Call* call) {
    return with(engine, call, [&](Engine& own) { own.fields.set_connectivity(*mesh); });
  }
  static Status compute(void* engine, const MeshView* mesh, const FieldRequest* request, bool* is_signed, Call* call) {
    return with(engine, call, [&](Engine& own) {
      *is_signed = own.fields.compute(
          *mesh, *request, [&] { return call->is_cancelled(call->context); },
          [&](double fraction) { call->report(call->context, fraction); });
    });
  }
  static Status set_connectivity_there(void* engine, const DeviceMeshView* mesh, void* stream, Call* call) {
    return with(engine, call, [&](Engine& own) {
      const Visit visit(own, stream);
      own.fields.set_connectivity(*mesh);
    });
  }
  static Status compute_there(void* engine, const DeviceArrayView* vertices, const FieldRequest* request, void* stream,
                              Call* call) {
    return with(engine, call, [&](Engine& own) {
      const Visit visit(own, stream);
      own.fields.compute(*vertices, *request);
    });
  }
  static Status transform_there(void* engine, const DeviceArrayView* values, const detail::ImageRequest* request,
                                void* stream, Call* call) {
    return with(engine, call, [&](Engine& own) {
      const Visit visit(own, stream);
      own.images.transform_there(*values, *request);
    });
  }
  static Status progress(void* engine, std::uint64_t* queued, std::uint64_t* finished, Call* call) {
    return with(engine, call, [&](Engine& own) {
      *finished = own.queue.finished();
      *queued = own.queue.queued();
    });
  }
  static Status follow(void* engine, std::uint64_t pieces, void* stream, Call* call) {
    return with(engine, call, [&](Engine& own) { own.queue.follow(pieces, stream); });
  }
  static Status device_of(void* engine, const void* memory, int* device, Call* call) {
    return with(engine, call, [&](Engine&) { *device = Platform::device_of(memory); });
  }
  static Status order(void* engine, void* before, void* after, Call* call) {
    return with(engine, call, [&](Engine& own) { own.queue.order(before, after); });
  }
  static Status allocate(int device, std::size_t bytes, void** memory, Call* call) {
    *memory = nullptr;
    return guarded(device, call, [&] { *memory = Platform::allocate(bytes); });
  }
  static void release(int device, void* memory) {
    Call call;
    (void)guarded(device, &call, [&] { Platform::release(memory); });
  }

  static Status set_image(void* engine, const VoxelImageView* image, const detail::ImageRequest* request, Call* call) {
    return with(engine, call, [&](Engine& own) { own.images.set_image(*image, *request); });
  }
  static Status select_voxels(void* engine, const detail::ImageRequest* request, std::size_t* selected, Call* call) {
    return with(engine, call, [&](Engine& own) { *selected = own.images.select(*request); });
  }
  static Status transform_image(void* engine, const detail::ImageRequest* request, Call* call) {
    return with(engine, call, [&](Engine& own) { own.images.transform(*request); });
  }
  static Status describe_device(int device, char* name, std::size_t capacity, std::uint64_t* memory, Call* call) {
    return guarded(device, call, [&] {
      std::snprintf(name, capacity, "%s", Platform::name_of(device).c_str());
      *memory = Platform::memory_of(device);
    });
  }
};

}  // namespace blum::cuda
