#include "field/field_options.hpp"

#include <cmath>
#include <string>

#include "blum/core/error.hpp"

namespace blum {

void check_options(const FieldOptions& options) {
  if (options.band && !(*options.band > 0 && std::isfinite(*options.band))) {
    throw InvalidOption("the band's half-width must be positive and finite, in mesh units");
  }
  if (options.site_ids == SiteIds::voxels) {
    throw InvalidOption("voxel ids are for fields of images; for a mesh, choose features or triangles");
  }
  if (options.order != 1 && options.order != 2) {
    throw InvalidOption("the order of a field must be 1 or 2, not " + std::to_string(options.order));
  }
}

void check_objects(const FieldOptions& options) {
  if (options.order == 2 && options.second == SecondRule::other_object) return;
  throw InvalidOption("objects are for fields of order 2 whose second site is of another object");
}

void check_site_ids(const FieldOptions& options, bool has_free_parts) {
  if (options.site_ids == SiteIds::triangles && has_free_parts) {
    throw InvalidOption("triangle ids do not exist for segments or points, which this mesh has: choose features");
  }
}

FieldRequest make_field_request(const GridSpec& grid, const FieldOptions& options, const sign::Plan& plan) {
  FieldRequest request;
  request.grid = grid;
  request.band = options.band.value_or(0);
  request.sign = plan.method;
  request.site_ids = options.site_ids;
  request.level = plan.level;
  return request;
}

}  // namespace blum
