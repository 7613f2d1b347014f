// Blum: what computes unsigned fields. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

struct FieldRequest {
  GridSpec grid;
  std::optional<double> band = {};
  /// Signs by pseudonormals, of a closed, consistently oriented mesh. Only where the back end can_tell_sides().
  bool with_sides = false;
};

/// Computes fields on one device; keeps connectivity and memory from one to the next.
class FieldBackend {
 public:
  FieldBackend() = default;
  FieldBackend(const FieldBackend&) = delete;
  FieldBackend& operator=(const FieldBackend&) = delete;
  virtual ~FieldBackend() = default;

  [[nodiscard]] virtual Device device() const = 0;
  [[nodiscard]] virtual bool can_tell_sides() const = 0;

  /// Makes `mesh` the current one; what depends on its connectivity alone is kept while that stays the same. The mesh
  /// must stay alive until compute() returns.
  virtual void set_mesh(const MeshView& mesh, const Context& context) = 0;
  [[nodiscard]] virtual const SiteTable& sites() const = 0;

  /// Fills distance and site (as feature ids) of a field whose buffers have the grid's size, and appends phase times.
  /// Returns nodes that are left to exact queries: those that no site claimed in float32, and those whose side is too
  /// close to call; rising.
  [[nodiscard]] virtual std::vector<std::size_t> compute(const FieldRequest& request, const Context& context,
                                                         Field& field) = 0;
};

/// The back end of context.device. @throws DeviceError.
[[nodiscard]] std::unique_ptr<FieldBackend> make_field_backend(const Context& context);

/// Puts something in the place of the CUDA back end, for tests; nothing restores it.
using BackendMaker = std::function<std::unique_ptr<FieldBackend>(int index)>;
void replace_cuda_backend(BackendMaker maker);

}  // namespace blum
