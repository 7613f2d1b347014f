#include "common/solid_input.hpp"

#include <cstddef>
#include <utility>

#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/grid/voxel_set.hpp"
#include "common/input_facts.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"

namespace blum::cli {

SolidInput load_solid(const std::filesystem::path& path, std::optional<double> weld,
                      std::span<const std::int64_t> labels) {
  const Unattended reading;  // the wait for the writer of a pipe, too
  SolidInput input;
  input.kind = input_kind(path);
  if (input.kind == InputKind::field) {
    throw FileError("'" + path.string() + "' is a field; a mesh or a voxel image is needed here");
  }
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
  ImageFile file = read_image_of_any_name(path);
  if (!labels.empty()) round_labels(file, labels);
  input.image = std::move(file.image);
  input.image_warnings = std::move(file.warnings);
  if (has_only_nan(input.image)) {
    throw FileError("'" + path.string() + "': every voxel is NaN (not a number), so none can be selected");
  }
  input.json = image_json(path, input.image, file.format);
  input.table = image_table(path, input.image, file.format);
  return input;
}

double size_of(const SolidInput& input, const LabelSelection& selection, const Context& context) {
  if (input.kind == InputKind::mesh) return bounds(input.mesh.mesh).diagonal();
  const VoxelExtent extent = extent_of(selected_voxels(input.image, selection, context));
  if (extent.upper[0] == 0) return 0;
  Vec3d sides;
  for (std::size_t a = 0; a < 3; ++a) {
    sides[a] = static_cast<double>(extent.upper[a] - extent.lower[a]) * input.image.grid.spacing[a];
  }
  return length(sides);
}

InputKind kind_of_input(const std::filesystem::path& path) {
  const Unattended reading;
  return input_kind(path);
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
  std::vector<Warning> all = input.image_warnings;
  if (input.weld && input.weld->before != input.weld->after) {
    all.emplace_back(WarningCode::other_vertices, weld_text(*input.weld));
  }
  return all;
}

}  // namespace blum::cli
