#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "blum/core/plural.hpp"
#include "blum/core/warning.hpp"
#include "blum/medial_axis/centreline.hpp"

namespace blum {
namespace {

constexpr std::size_t most_warnings = 5;

Warning warning_of(const Centreline& line) {
  const std::string label = line.label ? std::to_string(*line.label) : "";
  if (line.voxels > 0) {
    return {WarningCode::other_topology, (line.label ? "label " + label + ": " : "") + line.homotopy};
  }
  return {WarningCode::nothing_found,
          line.label ? "no voxel has the label " + label : "no voxel reaches the threshold"};
}

}  // namespace

std::vector<Warning> centreline_warnings(const Centrelines& lines, const GridSpec& grid) {
  std::vector<Warning> out;
  if (std::count(grid.size.begin(), grid.size.end(), 1) > 0) {
    out.emplace_back(WarningCode::single_layer,
                     "the image has a single layer, which is a plate as thick as a voxel: lengths and radii are not "
                     "those of a picture in the plane");
  }
  std::size_t unnamed = 0;
  for (const Centreline& line : lines.labels) {
    if (line.voxels > 0 && line.homotopy_kept) continue;
    if (out.size() < most_warnings) {
      out.push_back(warning_of(line));
    } else {
      ++unnamed;
    }
  }
  if (unnamed > 0) {
    out.emplace_back(WarningCode::other_topology,
                     plural(unnamed, "more label has", "more labels have") +
                         " no voxels, or another topology than their curves: `homotopy` of "
                         "each label says more");
  }
  if (lines.labels.empty()) out.emplace_back(WarningCode::nothing_found, "no voxel is selected");
  return out;
}

}  // namespace blum
