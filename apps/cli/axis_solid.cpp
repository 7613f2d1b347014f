#include "axis_solid.hpp"

namespace blum::cli {
namespace {

/// The selection as options; empty for all that is not 0.
std::string selection_text(const std::optional<std::int64_t>& label, const std::optional<double>& threshold) {
  if (label) return "--label " + std::to_string(*label);
  return threshold ? "--threshold " + rounded_text(*threshold) : "";
}

std::string weld_text(double weld) {
  return weld == 0 ? "--weld" : "--weld " + rounded_text(weld);
}

std::string contradiction(const std::filesystem::path& axis, const std::string& recorded, const std::string& given) {
  return "'" + axis.string() + "' was made with " + recorded + "; " + given + " is used, as it was given";
}

/// Whether a file tells how it was made: .obj, .ma and those of other programs do not.
bool tells_its_solid(const MedialMetadata& metadata) {
  return !metadata.solid_rule.empty();
}

}  // namespace

void record(const LabelSelection& selection, std::optional<double> weld, InputKind kind, MedialMetadata& metadata) {
  if (kind == InputKind::mesh) {
    metadata.weld = weld;
    return;
  }
  if (selection.rule == LabelSelection::Rule::label) metadata.label = selection.label;
  if (selection.rule == LabelSelection::Rule::threshold) metadata.threshold = selection.threshold;
}

SolidChoice solid_of_axis(const SolidChoice& given, InputKind kind, const MedialMetadata& metadata,
                          const std::filesystem::path& axis) {
  SolidChoice out = given;
  if (kind == InputKind::mesh) {
    if (!given.weld) out.weld = metadata.weld;
    if (metadata.weld && out.weld != metadata.weld) {
      out.warnings.push_back(contradiction(axis, weld_text(*metadata.weld), weld_text(*out.weld)));
    }
    return out;
  }
  const bool is_given = !given.selections.labels.empty() || given.selections.threshold.has_value();
  const std::string recorded = selection_text(metadata.label, metadata.threshold);
  if (!is_given) {
    if (metadata.label) out.selections.labels = {*metadata.label};
    out.selections.threshold = metadata.threshold;
    return out;
  }
  const std::optional<std::int64_t> label =
      given.selections.labels.empty() ? std::nullopt : std::optional(given.selections.labels.front());
  const bool is_same = label == metadata.label && given.selections.threshold == metadata.threshold;
  if (!recorded.empty() && !is_same) {
    out.warnings.push_back(contradiction(axis, recorded, selection_text(label, given.selections.threshold)));
  }
  return out;
}

std::string missing_options(const SolidChoice& given, InputKind kind, const MedialMetadata& metadata,
                            bool topology_holds) {
  if (tells_its_solid(metadata)) return {};
  if (kind == InputKind::mesh) {
    // Welding moves vertices by little, and changes what is closed.
    if (given.weld || topology_holds) return {};
    return "; the file of the axis does not tell how the mesh was read: if --weld was given then, give it here too";
  }
  if (!given.selections.labels.empty() || given.selections.threshold) return {};
  return "; the file of the axis does not tell which voxels it is of: if --label or --threshold was given then, give "
         "it here too";
}

}  // namespace blum::cli
