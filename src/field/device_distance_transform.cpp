// Distance transforms that stay in the memory of a device.
#include "blum/field/device_distance_transform.hpp"

#include <cmath>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "field/cuda/device_queue.hpp"
#include "field/image_request.hpp"

namespace blum {

struct DeviceDistanceTransform::State {
  State(const GridSpec& voxels, const DistanceTransformOptions& wanted, const Device& device)
      : grid(voxels), options(wanted), request(detail::make_image_request(voxels, wanted)), queue(device) {}

  GridSpec grid;
  DistanceTransformOptions options;
  detail::ImageRequest request;  ///< its result memory is not set
  cuda::DeviceQueue queue;
};

DeviceDistanceTransform::DeviceDistanceTransform(const GridSpec& grid, const DistanceTransformOptions& options,
                                                 const Context& context) {
  validate(grid);
  if (grid.node_count() > max_id_count)
    throw InvalidImage("the image has more than 2^31 - 1 voxels, the limit for ids");
  if (options.selection.rule == LabelSelection::Rule::threshold && std::isnan(options.selection.threshold)) {
    throw InvalidOption("the threshold is NaN, but must be a number");
  }
  state_ = std::make_unique<State>(grid, options, context.device);
}

DeviceDistanceTransform::DeviceDistanceTransform(DeviceDistanceTransform&&) noexcept = default;
DeviceDistanceTransform& DeviceDistanceTransform::operator=(DeviceDistanceTransform&&) noexcept = default;
DeviceDistanceTransform::~DeviceDistanceTransform() = default;

Device DeviceDistanceTransform::device() const {
  return state_->queue.device();
}
const GridSpec& DeviceDistanceTransform::grid() const {
  return state_->grid;
}
const DistanceTransformOptions& DeviceDistanceTransform::options() const {
  return state_->options;
}

void DeviceDistanceTransform::compute(const DeviceArrayView& values, const DeviceFieldView& field, void* stream) {
  if (values.rows != state_->grid.node_count()) {
    throw InvalidImage(std::to_string(values.rows) + " values, but the grid has " +
                       std::to_string(state_->grid.node_count()) + " voxels");
  }
  if (values.data == nullptr || field.distance == nullptr) {
    throw InvalidOption("values and distances on a device must not be null");
  }
  if ((field.site != nullptr) != state_->options.sites) {
    throw InvalidOption(state_->options.sites ? "the memory for sites on a device must not be null"
                                              : "the options request no sites, so their memory must be null");
  }
  detail::ImageRequest request = state_->request;
  request.distance = field.distance;
  request.site = field.site;
  state_->queue.run(&cuda::Module::transform_there, &values, &request, stream);
}

DeviceProgress DeviceDistanceTransform::progress() const {
  return state_->queue.progress();
}
void DeviceDistanceTransform::follow(std::uint64_t pieces, void* stream) {
  state_->queue.follow(pieces, stream);
}
std::optional<Device> DeviceDistanceTransform::device_of(const void* memory) const {
  return state_->queue.device_of(memory);
}
void DeviceDistanceTransform::order(void* before, void* after) {
  state_->queue.order(before, after);
}

}  // namespace blum
