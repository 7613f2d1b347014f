#include "medial_axis/cells/voxelize.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/field/field.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "blum/solid/body_cells.hpp"
#include "medial_axis/cells/voxel_solid.hpp"

namespace blum::detail {
namespace {

/// Number of layers of voxels added around the box of a mesh. Voxels of the model that lie outside the mesh are within
/// one voxel diagonal of it, and the outermost layer stays empty.
constexpr int margin = 3;

/// Displacement of the grid's middle from the body's middle, in voxels. Without this displacement, planes of symmetry
/// and diagonal planes would pass through voxel centres. Rounding would then decide on which side of a plane such a
/// voxel lies, which makes ragged sheets.
constexpr Vec3d off_middle{0.11, 0.27, 0.37};

using Place = std::array<std::int64_t, 3>;

GridSpec voxels_around(const Box3& box, double spacing, double shift) {
  GridSpec grid;
  grid.spacing = {spacing, spacing, spacing};
  for (std::size_t a = 0; a < 3; ++a) {
    const double steps = std::ceil(box.size()[a] / spacing);
    if (!(steps < 1e6)) throw InvalidOption("a voxel side of " + exact_text(spacing) + " is too small for the mesh");
    const auto layers = margin + static_cast<int>(std::ceil(std::abs(shift)));
    grid.size[a] = static_cast<std::int64_t>(steps) + 2 * layers;
    const double off = off_middle[a] + shift;
    grid.origin[a] = box.center()[a] - spacing * (0.5 * static_cast<double>(grid.size[a] - 1) - off);
  }
  return grid;
}

/// Makes the depths of the voxels of a set positive and those of all others zero or negative. If the surface passes
/// within rounding of a voxel centre, the distance field and the model may disagree on the centre's side.
void agree_with(const VoxelSet& inside, Buffer<float>& depth, const Context& context) {
  const Place& size = inside.size();
  parallel_for(context, static_cast<std::size_t>(size[2]), 1, "", [&](const WorkRange& range) {
    for (auto k = static_cast<std::int64_t>(range.begin); k < static_cast<std::int64_t>(range.end); ++k) {
      for (std::int64_t j = 0; j < size[1]; ++j) {
        const auto row = inside.row(j, k);
        float* own = depth.data() + (k * size[1] + j) * size[0];
        for (std::int64_t i = 0; i < size[0]; ++i) {
          const bool is_in = (row[static_cast<std::size_t>(i / 64)] >> (i % 64) & 1U) != 0;
          own[i] = is_in ? std::max(own[i], std::numeric_limits<float>::min()) : std::min(own[i], 0.0F);
        }
      }
    }
  });
}

/// Returns a solid whose depths are the negated distances of a field, positive inside. The solid's set of voxels is
/// empty.
VoxelSolid solid_of(Field field) {
  VoxelSolid solid;
  solid.grid = field.grid;
  solid.voxels = VoxelSet(field.grid.size);
  solid.depth = std::move(field.distance);
  solid.site = std::move(field.site);
  for (float& d : solid.depth) d = -d;
  return solid;
}

/// Returns an image of the box `extent` plus one layer of voxels on each side. Its values are 1 for voxels of the set
/// and 0 for others.
VoxelImage cut_out(const VoxelSet& voxels, const VoxelExtent& extent, const GridSpec& grid) {
  VoxelImage image;
  image.grid = grid;
  image.grid.origin = grid.position(extent.lower[0] - 1, extent.lower[1] - 1, extent.lower[2] - 1);
  for (std::size_t a = 0; a < 3; ++a) image.grid.size[a] = extent.upper[a] - extent.lower[a] + 2;
  std::vector<std::uint8_t> values(image.grid.node_count(), 0);
  for (std::int64_t k = extent.lower[2]; k < extent.upper[2]; ++k) {
    for (std::int64_t j = extent.lower[1]; j < extent.upper[1]; ++j) {
      std::size_t to = image.grid.index(1, j - extent.lower[1] + 1, k - extent.lower[2] + 1);
      for (std::int64_t i = extent.lower[0]; i < extent.upper[0]; ++i, ++to) values[to] = voxels.contains(i, j, k);
    }
  }
  image.values = std::move(values);
  return image;
}

BodyReport report_of(const VoxelSolid& solid, const Context& context) {
  BodyReport report;
  report.betti = betti_numbers(solid.voxels, context);
  report.topology_matches = true;
  report.spacing = std::min({solid.grid.spacing.x, solid.grid.spacing.y, solid.grid.spacing.z});
  report.voxels = solid.voxels.count();
  return report;
}

/// Moves the extra cells and failures of a model to `voxelized`.
void take_extra(BodyCells cells, Voxelized& voxelized) {
  voxelized.report.topology_matches = cells.failures.empty();
  voxelized.report.extra_cells = cells.extra.size();
  voxelized.report.failures = std::move(cells.failures);
  voxelized.solid.extra = std::make_shared<const ExtraIncidence>(std::move(cells));
}

}  // namespace

Voxelized voxelize_body(const SolidBody& body, double spacing, const Context& context, double shift) {
  Voxelized out;
  FieldOptions options;
  options.sign = SignMode::normals;
  out.solid = solid_of(distance_field(body.mesh, voxels_around(bounds(body.mesh), spacing, shift), options, context));
  BodyCells cells = body_cells(body.mesh, out.solid.grid, {}, context);
  out.solid.voxels = std::move(cells.inside);
  agree_with(out.solid.voxels, out.solid.depth, context);
  BodyReport& report = out.report;
  report.betti = body.betti;
  report.spacing = spacing;
  report.voxels = out.solid.voxels.count();
  take_extra(std::move(cells), out);
  return out;
}

void split_further(Voxelized& voxelized, const SolidBody& body, std::span<const Box3> finer, const Context& context) {
  take_extra(body_cells(body.mesh, voxelized.solid.grid, finer, context), voxelized);
}

Voxelized voxelize_by_winding(const MeshView& mesh, double spacing, const Context& context, double shift) {
  Voxelized out;
  FieldOptions options;
  options.sign = SignMode::winding;
  out.solid = solid_of(distance_field(mesh, voxels_around(bounds(mesh), spacing, shift), options, context));
  take_deeper_than(out.solid.depth.span(), 0, out.solid.voxels, context);
  out.report = report_of(out.solid, context);
  return out;
}

Voxelized voxelize_image(const VoxelSet& all, const GridSpec& grid, std::array<std::int64_t, 3>& first,
                         const Context& context) {
  Voxelized out;
  const VoxelExtent extent = extent_of(all);
  for (std::size_t a = 0; a < 3; ++a) first[a] = extent.lower[a] - 1;
  const VoxelImage cut = cut_out(all, extent, grid);
  VoxelSet voxels = selected_voxels(cut, {}, context);
  out.solid = solid_of(distance_transform(cut, {}, context));
  out.solid.is_exact = true;
  out.solid.voxels = std::move(voxels);
  out.report = report_of(out.solid, context);
  return out;
}

}  // namespace blum::detail
