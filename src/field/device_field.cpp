// Fields that stay in the memory of a device.
#include "blum/field/device_field.hpp"

#include <optional>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "field/cuda/device_queue.hpp"
#include "field/field_options.hpp"
#include "field/sign/policy.hpp"

namespace blum {
namespace {

void check_vertices(const DeviceArrayView& vertices) {
  if (vertices.type != ElementType::float32 && vertices.type != ElementType::float64) {
    throw InvalidOption("vertices on a device must be float32 or float64");
  }
}

void check_indices(const DeviceArrayView& indices, const std::string& name) {
  if (indices.rows == 0) return;
  if (indices.data == nullptr) throw InvalidOption(name + " on a device have rows, but their data are null");
  if (indices.type != ElementType::int32 && indices.type != ElementType::uint32 && indices.type != ElementType::int64) {
    throw InvalidOption(name + " on a device must be int32, uint32 or int64");
  }
}

void check_mesh(const DeviceMeshView& mesh, const FieldOptions& options) {
  check_vertices(mesh.vertices);
  check_indices(mesh.triangles, "triangles");
  check_indices(mesh.segments, "segments");
  check_indices(mesh.points, "points");
  if (mesh.triangles.rows + mesh.segments.rows + mesh.points.rows == 0) {
    throw InvalidMesh("the mesh has no triangles, segments or points, so no node has a closest site");
  }
  // Each triangle may have three edges of its own. So it may add four sites: itself and the edges.
  const std::size_t limit = max_id_count;
  for (const std::size_t rows : {mesh.vertices.rows, mesh.triangles.rows, mesh.segments.rows, mesh.points.rows}) {
    if (rows > limit) throw InvalidMesh("the mesh has more than 2^31 - 1 sites, the limit for ids");
  }
  if (mesh.vertices.rows + 4 * mesh.triangles.rows + mesh.segments.rows > limit) {
    throw InvalidMesh(
        "the mesh may have more than 2^31 - 1 sites, the limit for ids: on a device, vertices + segments + 4 * "
        "triangles must be below 2^31");
  }
  check_site_ids(options, mesh.segments.rows + mesh.points.rows > 0);
}

}  // namespace

struct DeviceFieldSolver::State {
  State(const GridSpec& nodes, const FieldOptions& wanted, const Device& device)
      : grid(nodes), options(wanted), queue(device) {}

  GridSpec grid;
  FieldOptions options;
  cuda::DeviceQueue queue;
  std::optional<sign::Plan> plan;  ///< no value until set_connectivity()
};

DeviceFieldSolver::DeviceFieldSolver(const GridSpec& grid, const FieldOptions& options, const Context& context) {
  validate(grid);
  check_options(options);
  if (options.order != 1)
    throw InvalidOption("fields in device memory have order 1; order 2 is computed on the CPU only");
  // Normals are not supported for any mesh in device memory, so they are rejected before a mesh is known.
  if (options.sign == SignMode::normals) (void)sign::plan_unseen_signs(options.sign, 0);
  state_ = std::make_unique<State>(grid, options, context.device);
}

DeviceFieldSolver::DeviceFieldSolver(DeviceFieldSolver&&) noexcept = default;
DeviceFieldSolver& DeviceFieldSolver::operator=(DeviceFieldSolver&&) noexcept = default;
DeviceFieldSolver::~DeviceFieldSolver() = default;

Device DeviceFieldSolver::device() const {
  return state_->queue.device();
}
const GridSpec& DeviceFieldSolver::grid() const {
  return state_->grid;
}
const FieldOptions& DeviceFieldSolver::options() const {
  return state_->options;
}

void DeviceFieldSolver::set_connectivity(const DeviceMeshView& mesh, void* stream) {
  check_mesh(mesh, state_->options);
  sign::Plan plan = sign::plan_unseen_signs(state_->options.sign, mesh.triangles.rows);
  state_->plan.reset();
  state_->queue.run(&cuda::Module::set_connectivity_there, &mesh, stream);
  state_->plan = std::move(plan);
}

SignRule DeviceFieldSolver::sign_rule() const {
  return state_->plan ? state_->plan->rule : SignRule::none;
}

void DeviceFieldSolver::compute(const DeviceArrayView& vertices, const DeviceFieldView& field, void* stream) {
  if (!state_->plan)
    throw InvalidOption("the first field of a solver needs the triangles, segments or points of its mesh");
  check_vertices(vertices);
  const bool wants_sites = state_->options.sites;
  if (vertices.data == nullptr || field.distance == nullptr || (wants_sites && field.site == nullptr)) {
    throw InvalidOption("vertices, distances and sites on a device must not be null");
  }
  FieldRequest request = make_field_request(state_->grid, state_->options, *state_->plan);
  request.distance = field.distance;
  request.site = wants_sites ? field.site : nullptr;
  state_->queue.run(&cuda::Module::compute_there, &vertices, &request, stream);
}

DeviceProgress DeviceFieldSolver::progress() const {
  return state_->queue.progress();
}
void DeviceFieldSolver::follow(std::uint64_t pieces, void* stream) {
  state_->queue.follow(pieces, stream);
}
std::optional<Device> DeviceFieldSolver::device_of(const void* memory) const {
  return state_->queue.device_of(memory);
}
void DeviceFieldSolver::order(void* before, void* after) {
  state_->queue.order(before, after);
}

}  // namespace blum
