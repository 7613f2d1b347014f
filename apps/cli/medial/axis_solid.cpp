#include "medial/axis_solid.hpp"

#include "common/options.hpp"

namespace blum::cli {
namespace {

/// Returns true if a file records its solid. Files with the extension .obj or .ma, and those of other programs, do not.
bool states_its_solid(const MedialMetadata& metadata) {
  return !metadata.solid_rule.empty();
}

}  // namespace

SolidSelection parse_solid(const std::vector<std::string>& labels, const std::optional<std::string>& threshold,
                           const std::optional<std::string>& weld) {
  const Selections selections = parse_selections(labels, threshold);
  if (selections.labels.size() > 1) throw UsageError("--label: an axis belongs to one label; give only one");
  SolidSelection out;
  if (!selections.labels.empty()) out.label = selections.labels.front();
  out.threshold = selections.threshold;
  out.weld = parse_weld(weld);
  return out;
}

AxisSolid solid_of_axis(const SolidSelection& given, InputKind kind, const MedialMetadata& metadata,
                        const std::filesystem::path& axis) {
  return blum::solid_of_axis(given, kind == InputKind::image, metadata, "'" + axis.string() + "'",
                             OptionStyle::command_line);
}

std::vector<std::int64_t> labels_of(const SolidSelection& selection) {
  return selection.label ? std::vector{*selection.label} : std::vector<std::int64_t>{};
}

void record(const LabelSelection& selection, std::optional<double> weld, InputKind kind, MedialMetadata& metadata) {
  if (kind == InputKind::mesh) {
    metadata.weld = weld;
    return;
  }
  if (selection.rule == LabelSelection::Rule::label) metadata.label = selection.label;
  if (selection.rule == LabelSelection::Rule::threshold) metadata.threshold = selection.threshold;
}

std::string missing_options(const SolidSelection& given, InputKind kind, const MedialMetadata& metadata,
                            bool topology_holds) {
  if (states_its_solid(metadata)) return {};
  if (kind == InputKind::mesh) {
    // Welding moves vertices only slightly. So a wrong --weld can make only the topology wrong.
    if (given.weld || topology_holds) return {};
    return "; the file of the axis does not record how the mesh was welded; if the axis was made with --weld, repeat "
           "it";
  }
  if (given.label || given.threshold) return {};
  return "; the file of the axis does not record the selection of voxels; if the axis was made with --label, "
         "--threshold or --smooth, repeat it";
}

}  // namespace blum::cli
