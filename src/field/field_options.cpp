#include "field/field_options.hpp"

#include <cmath>

#include "blum/core/error.hpp"

namespace blum {

void check_options(const FieldOptions& options) {
  if (options.band && !(*options.band > 0 && std::isfinite(*options.band))) {
    throw InvalidOption("the band's half-width must be positive and finite, in mesh units");
  }
  if (options.site_ids == SiteIds::voxels) {
    throw InvalidOption("voxel ids are for fields of images; a mesh has features or triangles");
  }
}

void check_site_ids(const FieldOptions& options, bool has_free_parts) {
  if (options.site_ids == SiteIds::triangles && has_free_parts) {
    throw InvalidOption("triangle ids were asked for, but the mesh also has segments or points: ask for features");
  }
}

}  // namespace blum
