#include "blum/solid/body_cells.hpp"

#include <utility>

#include "blum/core/parallel.hpp"
#include "solid/model/cut_grid.hpp"
#include "solid/model/model_cells.hpp"
#include "solid/model/model_regions.hpp"
#include "solid/model/refined_region.hpp"
#include "solid/model/surface_mesh.hpp"

namespace blum {
namespace {

using detail::scaled;

detail::GridPlanes planes_of(const GridSpec& grid, int exponent) {
  detail::Place last{};
  for (std::size_t a = 0; a < 3; ++a) last[a] = static_cast<std::int32_t>(grid.size[a] - 1);
  return {scaled(grid.origin, exponent), scaled(grid.spacing, exponent), {0, 0, 0}, last};
}

VoxelSet nodes_inside(const detail::CutGrid& cut, const GridSpec& grid, const Context& context) {
  VoxelSet inside(grid.size);
  parallel_for(context, static_cast<std::size_t>(grid.size[2]), 1, "", [&](const WorkRange& range) {
    for (auto k = static_cast<std::int64_t>(range.begin); k < static_cast<std::int64_t>(range.end); ++k) {
      for (std::int64_t j = 0; j < grid.size[1]; ++j) {
        for (std::int64_t i = 0; i < grid.size[0]; ++i) {
          if (cut.is_inside(cut.lattice().node(i, j, k))) inside.insert(i, j, k);
        }
      }
    }
  });
  return inside;
}

ExtraCell extra_cell(const detail::ModelCells& cells, std::size_t k, int exponent) {
  ExtraCell cell;
  cell.dimension = cells.dimension[k];
  cell.witness = scaled(cells.witness[k], exponent);
  for (std::size_t end = 0; end < 2; ++end) {
    cell.ends[end] = {scaled(cells.ends[k][end].point, exponent), cells.ends[k][end].triangle};
  }
  if (const std::optional<Box3>& box = cells.boxes[k]) {
    cell.box = Box3{scaled(box->lower, exponent), scaled(box->upper, exponent)};
  }
  return cell;
}

}  // namespace

BodyCells body_cells(const TriangleMesh& body, const GridSpec& grid, std::span<const Box3> finer,
                     const Context& context) {
  const int exponent = detail::scale_of(bounds(body));
  const TriangleMesh mesh = scaled(body, exponent);
  const detail::SurfaceMesh surface(mesh, context);
  const detail::CutGrid cut(surface, planes_of(grid, exponent), context);
  std::vector<Box3> finer_there;
  for (const Box3& box : finer) finer_there.push_back({scaled(box.lower, exponent), scaled(box.upper, exponent)});
  const std::vector<detail::RefinedRegion> regions =
      detail::refine_regions(surface, cut, CellularModelOptions{}.most_splits, finer_there, context);
  BodyCells out;
  out.lattice = CellLattice(grid.size);
  out.inside = nodes_inside(cut, grid, context);
  out.failures = detail::failures_of(regions, exponent);
  detail::ExtraModelCells extra = detail::extra_model_cells(surface, cut, regions, out.lattice, context);
  out.replaced = std::move(extra.replaced);
  out.cofaces = std::move(extra.cofaces);
  out.first = extra.first;
  out.extra.reserve(extra.cells.size());
  for (std::size_t k = 0; k < extra.cells.size(); ++k) {
    out.extra.push_back(extra_cell(extra.cells, k, -exponent));
    if (k < extra.places.size()) out.extra.back().place = extra.places[k];
  }
  out.faces = IndexRows({extra.cells.first_face.begin(), extra.cells.first_face.end()}, std::move(extra.cells.faces));
  return out;
}

}  // namespace blum
