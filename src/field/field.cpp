#include "blum/field/field.hpp"

namespace blum {

std::string_view to_string(SignMode mode) {
  switch (mode) {
    case SignMode::automatic:
      return "auto";
    case SignMode::normals:
      return "normals";
    case SignMode::winding:
      return "winding";
    case SignMode::none:
      return "none";
  }
  return "unknown";
}

std::string_view to_string(SignRule rule) {
  switch (rule) {
    case SignRule::none:
      return "none";
    case SignRule::normals:
      return "normals";
    case SignRule::winding:
      return "winding";
    case SignRule::label:
      return "label";
    case SignRule::balls:
      return "balls";
  }
  return "unknown";
}

std::string_view to_string(SiteIds ids) {
  switch (ids) {
    case SiteIds::features:
      return "features";
    case SiteIds::triangles:
      return "triangles";
    case SiteIds::voxels:
      return "voxels";
  }
  return "unknown";
}

}  // namespace blum
