#include "common/solid_input.hpp"

#include <utility>

#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "common/input_facts.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"

namespace blum::cli {

SolidInput load_solid(const std::filesystem::path& path, std::optional<double> weld) {
  SolidInput input;
  input.kind = input_kind(path);
  if (input.kind == InputKind::field) {
    throw FileError("'" + path.string() + "' is a field; a mesh or a voxel image is needed here");
  }
  const Unattended reading;
  if (input.kind == InputKind::mesh) {
    input.mesh = read_mesh_of_any_name(path, {weld, true});
    const MeshView mesh = input.mesh.mesh;
    of_file(path, [&] { validate(mesh); });
    const SiteTable sites(mesh);
    const Orientation facts = orientation(mesh, sites);
    input.json = mesh_json(path, input.mesh, sites, facts);
    input.table = mesh_table(path, input.mesh, sites, facts);
    if (input.mesh.exact) {
      input.weld = weld_facts(*input.mesh.exact, *weld, mesh);
      input.json["weld"] = weld_json(*input.weld);
    }
    return input;
  }
  input.image = read_image_of_any_name(path);
  if (has_only_nan(input.image)) {
    throw FileError("'" + path.string() + "': every voxel is NaN (not a number), so none can be selected");
  }
  input.json = image_json(path, input.image);
  input.table = image_table(path, input.image);
  return input;
}

std::vector<LabelSelection> Selections::all() const {
  if (threshold) return {LabelSelection::at_least(*threshold)};
  std::vector<LabelSelection> selections;
  for (const std::int64_t label : labels) selections.push_back(LabelSelection::of_label(label));
  if (selections.empty()) selections.emplace_back();
  return selections;
}

Selections parse_selections(const std::vector<std::string>& labels, const std::optional<std::string>& threshold) {
  LabelSelection::exclude_both(!labels.empty(), threshold.has_value(), "--");
  Selections out;
  out.labels = parse_labels("--label", labels);
  if (threshold) out.threshold = parse_number("--threshold", *threshold);
  return out;
}

std::vector<Warning> warnings_of(const SolidInput& input) {
  std::vector<Warning> all;
  if (input.weld && input.weld->before != input.weld->after) {
    all.emplace_back(WarningCode::other_vertices, weld_text(*input.weld));
  }
  return all;
}

}  // namespace blum::cli
