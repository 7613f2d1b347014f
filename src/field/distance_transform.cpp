// Distance transforms of images on the requested device.
#include "blum/field/distance_transform.hpp"

#include <memory>
#include <string>
#include <utility>

#include "blum/core/context.hpp"
#include "blum/core/phase_timer.hpp"
#include "field/backend.hpp"
#include "field/cpu/distance_transform.hpp"
#include "field/image_field.hpp"

namespace blum {
namespace {

std::vector<Field> transforms_on(ImageBackend& device, const VoxelImageView& image,
                                 std::span<const LabelSelection> selections, const DistanceTransformOptions& options,
                                 const Context& context) {
  detail::ImageRequest request = detail::make_image_request(image.grid, options);
  device.set_image(image, request);
  std::vector<Field> fields;
  fields.reserve(selections.size());
  for (const LabelSelection& selection : selections) {
    throw_if_cancelled(context);
    Field& field = fields.emplace_back();
    PhaseTimer timer(field.phases);
    request.selection = selection;
    detail::check_selected(device.select(request), image, request);
    timer.lap("select voxels");
    detail::begin_field(image, options, request, field);
    field.device = device.device();
    device.transform(request);
    timer.lap("transform");
  }
  return fields;
}

}  // namespace

std::vector<Field> distance_transforms(const VoxelImageView& image, std::span<const LabelSelection> selections,
                                       const DistanceTransformOptions& options, const Context& context) {
  validate(image);
  std::string device_reason;
  if (const std::unique_ptr<ImageBackend> device = make_image_backend(context, device_reason)) {
    return transforms_on(*device, image, selections, options, context);
  }
  std::vector<Field> fields = cpu::distance_transforms(image, selections, options, context);
  for (Field& field : fields) field.device_reason = device_reason;
  return fields;
}

Field distance_transform(const VoxelImageView& image, const DistanceTransformOptions& options, const Context& context) {
  return std::move(distance_transforms(image, {&options.selection, 1}, options, context).front());
}

}  // namespace blum
