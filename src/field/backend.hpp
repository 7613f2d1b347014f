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
  /// Signs by counted crossings: nodes with a winding number above this are inside. Of a mesh that is_balanced(), and
  /// only where the back end can_count_crossings().
  std::optional<int> level = {};
};

struct FieldResult {
  /// Nodes that are left to exact queries: those that no site claimed in float32, and those whose side is too close to
  /// call; rising.
  std::vector<std::size_t> unsettled;
  /// With a level: whether every node has the winding number level or level + 1, as those of a mesh that does not cross
  /// itself have.
  bool is_simple = false;
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
  [[nodiscard]] virtual bool can_count_crossings() const = 0;

  /// Makes `mesh` the current one; what depends on its connectivity alone is kept while that stays the same. The mesh
  /// must stay alive until compute() returns.
  virtual void set_mesh(const MeshView& mesh, const Context& context) = 0;
  [[nodiscard]] virtual const SiteTable& sites() const = 0;

  /// Fills distance and site (as feature ids) of a field whose buffers have the grid's size, and appends phase times.
  [[nodiscard]] virtual FieldResult compute(const FieldRequest& request, const Context& context, Field& field) = 0;
};

/// The back end of context.device. @throws DeviceError.
[[nodiscard]] std::unique_ptr<FieldBackend> make_field_backend(const Context& context);

/// Puts something in the place of the CUDA back end, for tests; nothing restores it.
using BackendMaker = std::function<std::unique_ptr<FieldBackend>(int index)>;
void replace_cuda_backend(BackendMaker maker);

}  // namespace blum
