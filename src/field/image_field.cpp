#include "field/image_field.hpp"

#include <string>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/grid/image_values.hpp"
#include "field/sign/policy.hpp"

namespace blum::detail {
namespace {

std::string describe(const LabelSelection& selection) {
  switch (selection.rule) {
    case LabelSelection::Rule::nonzero:
      return "differs from zero";
    case LabelSelection::Rule::label:
      return "equals label " + std::to_string(selection.label);
    case LabelSelection::Rule::threshold:
      return "reaches the threshold " + exact_text(selection.threshold);
  }
  return "is selected";
}

}  // namespace

void check_selected(std::size_t selected, const VoxelImageView& image, const ImageRequest& request) {
  if (selected == 0) throw InvalidImage(nothing_selected_text(image, request.selection));
  if (request.is_signed && selected == request.voxel_count()) {
    throw InvalidImage("every voxel of the image " + describe(request.selection) +
                       ", so a signed field has no boundary: select some by label or threshold, or add a layer of 0 "
                       "(numpy.pad(values, 1))");
  }
}

void begin_field(const VoxelImageView& image, const DistanceTransformOptions& options, ImageRequest& request,
                 Field& field) {
  field.grid = image.grid;
  field.distance = Buffer<float>(image.grid.node_count());
  field.site = options.sites ? Buffer<SiteId>(image.grid.node_count()) : Buffer<SiteId>();
  request.distance = field.distance.data();
  // A SiteId consists of its 32-bit value only, so result memory may be cast to integers.
  static_assert(sizeof(SiteId) == sizeof(std::uint32_t));
  request.site = options.sites ? &field.site.data()->value : nullptr;
  field.site_ids = SiteIds::voxels;
  field.band = options.band;
  const sign::Plan plan = sign::plan_image_signs(request.is_signed, describe(request.selection));
  field.sign_rule = plan.rule;
  field.sign_reason = plan.reason;
}

}  // namespace blum::detail
