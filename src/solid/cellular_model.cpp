#include "blum/solid/cellular_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/complex/homology.hpp"
#include "blum/core/context.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/solid/solid.hpp"
#include "solid/model/cut_grid.hpp"
#include "solid/model/model_cells.hpp"
#include "solid/model/model_regions.hpp"
#include "solid/model/refined_region.hpp"
#include "solid/model/surface_mesh.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t steps_between_looks = std::size_t{1} << 18U;

class Collapse {
 public:
  Collapse(const ModelCells& cells, const Context& context)
      : cells_(cells), context_(context), is_there_(cells.size(), 1), cofaces_left_(cells.size(), 0) {
    first_coface_.assign(cells.size() + 1, 0);
    for (const std::uint32_t face : cells.faces) ++first_coface_[face + std::size_t{1}];
    for (std::size_t c = 0; c < cells.size(); ++c) {
      cofaces_left_[c] = first_coface_[c + 1];
      first_coface_[c + 1] += first_coface_[c];
    }
    cofaces_.resize(cells.faces.size());
    std::vector<std::uint32_t> next(first_coface_.begin(), first_coface_.end() - 1);
    for (std::uint32_t c = 0; c < cells.size(); ++c) {
      for (const std::uint32_t face : cells.faces_of(c)) cofaces_[next[face]++] = c;
    }
  }

  void run() {
    std::vector<std::uint32_t> line;
    for (int dimension = 2; dimension >= 0; --dimension) {
      for (std::uint32_t c = 0; c < cells_.size(); ++c) {
        if (cells_.dimension[c] == dimension && cofaces_left_[c] == 1) line.push_back(c);
      }
    }
    for (std::size_t k = 0; k < line.size(); ++k) {
      if (k % steps_between_looks == 0) throw_if_cancelled(context_);
      const std::uint32_t face = line[k];
      if (is_there_[face] == 0 || cofaces_left_[face] != 1) continue;
      const std::uint32_t cell = only_coface(face);
      is_there_[face] = is_there_[cell] = 0;
      for (const std::uint32_t gone : {cell, face}) {
        for (const std::uint32_t side : cells_.faces_of(gone)) {
          if (--cofaces_left_[side] == 1 && is_there_[side] != 0) line.push_back(side);
        }
      }
    }
  }

  [[nodiscard]] bool is_there(std::uint32_t cell) const { return is_there_[cell] != 0; }

 private:
  [[nodiscard]] std::uint32_t only_coface(std::uint32_t face) const {
    for (std::uint32_t k = first_coface_[face]; k < first_coface_[face + 1]; ++k) {
      if (is_there_[cofaces_[k]] != 0) return cofaces_[k];
    }
    return face;
  }

  const ModelCells& cells_;
  const Context& context_;
  std::vector<std::uint8_t> is_there_;
  std::vector<std::uint32_t> cofaces_left_;
  std::vector<std::uint32_t> first_coface_;
  std::vector<std::uint32_t> cofaces_;
};

/// Collapses the cells: removes a cell together with a face of it that no other cell has, until no such pair exists.
/// Collapses preserve the homotopy type. For a solid in space, no polyhedron is left; a remaining polyhedron would be
/// dropped. Returns the remaining cells as a complex. Each edge and each polygon is subdivided at its witness. Cost:
/// near-linear in the number of cells.
/// @throws Cancelled.
Complex collapse_cells(const ModelCells& cells, const Context& context) {
  Collapse collapse(cells, context);
  collapse.run();
  Complex out;
  std::vector<std::uint32_t> vertex(cells.size(), 0);
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    if (!collapse.is_there(c) || cells.dimension[c] == 3) continue;
    vertex[c] = static_cast<std::uint32_t>(out.positions.size());
    out.positions.push_back(cells.witness[c]);
  }
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    if (!collapse.is_there(c)) continue;
    for (const std::uint32_t side : cells.faces_of(c)) {
      if (cells.dimension[c] == 1) out.edges.push_back({vertex[c], vertex[side]});
      if (cells.dimension[c] != 2) continue;
      for (const std::uint32_t end : cells.faces_of(side)) {
        out.triangles.push_back({vertex[c], vertex[side], vertex[end]});
      }
    }
  }
  out.vertex_columns = Columns(out.positions.size());
  out.edge_columns = Columns(out.edges.size());
  out.triangle_columns = Columns(out.triangles.size());
  return out;
}

}  // namespace
}  // namespace blum::detail

namespace blum {
namespace {

using detail::GridPlanes;
using detail::Place;
using detail::scaled;

constexpr int most_resolution = 800;
constexpr int most_splits_of_all = 200;

void check(const CellularModelOptions& options) {
  const auto refuse = [](const char* name, const std::string& value, const std::string& range) {
    throw InvalidOption(std::string(name) + " is " + value + ", but must be " + range);
  };
  if (options.resolution < 1 || options.resolution > most_resolution) {
    refuse("resolution", std::to_string(options.resolution), "1 to " + std::to_string(most_resolution));
  }
  if (options.spacing && !(*options.spacing > 0 && std::isfinite(*options.spacing))) {
    refuse("spacing", exact_text(*options.spacing), "above 0");
  }
  if (!(options.shift >= 0 && options.shift <= 1)) refuse("shift", exact_text(options.shift), "0 to 1");
  if (options.most_splits < 0 || options.most_splits > most_splits_of_all) {
    refuse("most_splits", std::to_string(options.most_splits), "0 to " + std::to_string(most_splits_of_all));
  }
}

double longest_side(const Box3& box) {
  return std::max({box.size().x, box.size().y, box.size().z});
}

/// Returns the planes of a grid around a box, with a margin of at least one cube on each side.
GridPlanes planes_around(const Box3& box, const Vec3d& origin, double spacing) {
  Place first{};
  Place last{};
  for (std::size_t a = 0; a < 3; ++a) {
    first[a] = static_cast<std::int32_t>(std::floor((box.lower[a] - origin[a]) / spacing)) - 1;
    last[a] = static_cast<std::int32_t>(std::floor((box.upper[a] - origin[a]) / spacing)) + 2;
  }
  return {origin, {spacing, spacing, spacing}, first, last};
}

/// Several bodies that do not touch each other, in one mesh.
struct BodyGroup {
  TriangleMesh mesh;
  std::vector<std::uint32_t> outermost;  ///< one vertex of each outer shell

  void add(const TriangleMesh& body) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    outermost.push_back(first + detail::SurfaceMesh::outermost_vertex(body.vertices));
    mesh.vertices.insert(mesh.vertices.end(), body.vertices.begin(), body.vertices.end());
    for (const auto& [a, b, c] : body.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
  }
};

std::vector<BodyGroup> grouped(std::span<const SolidBody> bodies, const std::vector<std::uint32_t>& groups) {
  std::vector<BodyGroup> out(*std::max_element(groups.begin(), groups.end()) + std::size_t{1});
  for (std::size_t b = 0; b < bodies.size(); ++b) out[groups[b]].add(bodies[b].mesh);
  return out;
}

/// The model of a group of bodies.
struct GroupModel {
  GroupModel(BodyGroup&& group, int exponent, const Vec3d& origin, double spacing, const Context& context)
      : mesh(scaled(std::move(group.mesh), exponent)),
        surface(mesh, std::move(group.outermost), context),
        grid(surface, planes_around(bounds(mesh), origin, spacing), context) {}

  TriangleMesh mesh;
  detail::SurfaceMesh surface;
  detail::CutGrid grid;
  std::vector<detail::RefinedRegion> regions;
};

}  // namespace

struct CellularModel::Data {
  CellularModelReport report;
  int exponent = 0;  ///< coordinates were multiplied by 2^exponent
  std::vector<std::unique_ptr<const GroupModel>> groups;
};

CellularModel::CellularModel(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

const CellularModelReport& CellularModel::report() const {
  return data_->report;
}

CellularModel CellularModel::of(const Solid& solid, const std::vector<std::uint32_t>& groups,
                                const CellularModelOptions& options, const Context& context) {
  check(options);
  if (solid.rule() == SolidRule::voxels) {
    throw InvalidOption("a union of voxels is its own cellular model: build models of meshes only");
  }
  if (solid.rule() != SolidRule::polyhedron) throw InvalidMesh("no cellular model: " + solid.reason());
  auto data = std::make_shared<Data>();
  CellularModelReport& report = data->report;
  PhaseTimer timer(report.phases);
  data->exponent = detail::scale_of(solid.box());
  const double spacing =
      std::ldexp(options.spacing.value_or(longest_side(solid.box()) / options.resolution), data->exponent);
  const Box3 box{scaled(solid.box().lower, data->exponent), scaled(solid.box().upper, data->exponent)};
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(box.size()[a] / spacing <= most_resolution + 1) || !(spacing > 64 * std::numeric_limits<double>::epsilon())) {
      throw InvalidOption("spacing is " + exact_text(std::ldexp(spacing, -data->exponent)) +
                          ", which is too small for this mesh: the grid may have at most " +
                          std::to_string(most_resolution) +
                          " cubes along a side, none smaller than the rounding of coordinates");
    }
  }
  const Vec3d origin = box.lower - Vec3d{1, 1, 1} * ((1 + options.shift) * spacing);
  const double unit = std::ldexp(spacing, -data->exponent);
  report.grid.origin = scaled(origin, -data->exponent);
  report.grid.spacing = {unit, unit, unit};
  for (std::size_t a = 0; a < 3; ++a) {
    report.grid.size[a] = static_cast<std::int64_t>(std::floor((box.upper[a] - origin[a]) / spacing)) + 3;
  }
  for (BodyGroup& group : grouped(solid.bodies(), groups)) {
    auto model = std::make_unique<GroupModel>(std::move(group), data->exponent, origin, spacing, context);
    model->regions = detail::refine_regions(model->surface, model->grid, options.most_splits, {}, context);
    for (const Cell cell : model->grid.cut_cells()) report.cut_cubes += dimension_of(cell) == 3 ? 1U : 0U;
    report.failing_cubes += model->grid.failing_cubes().size();
    for (const detail::RefinedRegion& region : model->regions) {
      report.splits = std::max(report.splits, region.depth());
      report.boxes += region.split_boxes();
    }
    const std::vector<ModelFailure> failures = detail::failures_of(model->regions, data->exponent);
    report.failures.insert(report.failures.end(), failures.begin(), failures.end());
    const auto counts = detail::count_model_cells(model->grid, model->regions);
    for (std::size_t d = 0; d < 4; ++d) report.cells[d] += counts[d];
    data->groups.push_back(std::move(model));
  }
  timer.lap("model");
  report.euler = report.cells[0] - report.cells[1] + report.cells[2] - report.cells[3];
  report.passes = report.failures.empty();
  return CellularModel(std::move(data));
}

Complex CellularModel::complex(const Context& context) const {
  Complex out;
  for (const auto& group : data_->groups) {
    const detail::ModelCells cells = detail::model_cells(group->surface, group->grid, group->regions, context);
    const Complex own = detail::collapse_cells(cells, context);
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    for (const Vec3d& p : own.positions) out.positions.push_back(scaled(p, -data_->exponent));
    for (auto [a, b] : own.edges) out.edges.push_back({first + a, first + b});
    for (auto [a, b, c] : own.triangles) out.triangles.push_back({first + a, first + b, first + c});
  }
  out.vertex_columns = Columns(out.positions.size());
  out.edge_columns = Columns(out.edges.size());
  out.triangle_columns = Columns(out.triangles.size());
  return out;
}

BettiNumbers CellularModel::betti(const Context& context) const {
  return homology(complex(context).view(), context);
}

}  // namespace blum
