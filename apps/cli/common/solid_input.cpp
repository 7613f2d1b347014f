#include "common/solid_input.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/grid/selected_voxels.hpp"
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
  const VoxelSet voxels = selected_voxels(input.image, selection, context);
  std::array<std::int64_t, 3> least = voxels.size();
  std::array<std::int64_t, 3> most{-1, -1, -1};
  const auto extend = [&](std::size_t axis, std::int64_t at) {
    least[axis] = std::min(least[axis], at);
    most[axis] = std::max(most[axis], at);
  };
  for (std::int64_t k = 0; k < voxels.size()[2]; ++k) {
    for (std::int64_t j = 0; j < voxels.size()[1]; ++j) {
      const auto words = voxels.row(j, k);
      for (std::size_t w = 0; w < words.size(); ++w) {
        if (words[w] == 0) continue;
        extend(0, static_cast<std::int64_t>(64 * w) + std::countr_zero(words[w]));
        extend(0, static_cast<std::int64_t>(64 * w) + 63 - std::countl_zero(words[w]));
        extend(1, j);
        extend(2, k);
      }
    }
  }
  Vec3d sides;
  for (std::size_t a = 0; a < 3; ++a) {
    sides[a] = static_cast<double>(most[a] - least[a] + 1) * input.image.grid.spacing[a];
  }
  return most[0] < 0 ? 0 : length(sides);
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
