#include "solid/model/cut_grid.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/radix_sort.hpp"
#include "blum/geometry/grid_predicates.hpp"
#include "solid/model/components.hpp"
#include "solid/model/section_loop.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t grain = 2048;

/// The lower and the upper axis of a square, as bits.
constexpr std::array<CellAxes, 2> span_of(Cell square) {
  const CellAxes axes = axes_of(square);
  const CellAxes lower = axes & (~axes + 1U);
  return {lower, axes ^ lower};
}

[[noreturn]] void throw_crossing(const GridPlanes& planes, const CellLattice& lattice, Cell cell) {
  const Vec3d p = planes.node(lattice.place(node_of(cell)));
  throw InvalidMesh("the mesh bounds no solid near (" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " +
                    std::to_string(p.z) + "): its surface is open, or crosses itself");
}

/// Items in the order of their keys.
template <class Item, class Key>
std::vector<KeyedIndex> sorted_by(const std::vector<Item>& items, const Key& key) {
  std::vector<KeyedIndex> order(items.size());
  for (std::uint32_t k = 0; k < items.size(); ++k) order[k] = {key(items[k]), k};
  radix_sort(order);
  return order;
}

}  // namespace

struct CutGrid::Scratch {
  SquareComponents square;
  CubeComponents cube;
  std::vector<std::uint32_t> loop_edges;
  std::vector<Cell> failing;
};

std::array<Cell, 4> CutGrid::sides_of(Cell square) const {
  const auto [lower, upper] = span_of(square);
  const std::size_t node = node_of(square);
  return {cell_at(node, lower), cell_at(node + lattice_.stride(axis_of(upper)), lower), cell_at(node, upper),
          cell_at(node + lattice_.stride(axis_of(lower)), upper)};
}

std::array<Cell, 6> CutGrid::faces_of(Cell cube) const {
  std::array<Cell, 6> faces{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const CellAxes spanned = 7U ^ (1U << axis);
    faces[2 * axis] = cell_at(node_of(cube), spanned);
    faces[2 * axis + 1] = cell_at(node_of(cube) + lattice_.stride(axis), spanned);
  }
  return faces;
}

std::span<const std::uint32_t> CutGrid::crossings(Cell edge) const {
  if (!cut_.contains(edge)) return {};
  const CutCell& own = cut(edge);
  return std::span(crossings_).subspan(own.first, own.count);
}

std::uint32_t CutGrid::component_of_interval(Cell square, Cell side, std::uint32_t interval) const {
  if (!cut_.contains(square)) return 0;
  std::uint32_t at = cut(square).table + interval;
  for (const Cell before : sides_of(square)) {
    if (before == side) break;
    at += components(before);
  }
  return interval_component_[at];
}

std::uint32_t CutGrid::component_of_part(Cell cube, std::size_t face, std::uint32_t part) const {
  if (!cut_.contains(cube)) return 0;
  std::uint32_t at = cut(cube).table + part;
  const std::array<Cell, 6> faces = faces_of(cube);
  for (std::size_t before = 0; before < face; ++before) at += components(faces[before]);
  return part_component_[at];
}

std::vector<ArcEnd> CutGrid::loose_ends(Cell square, std::uint32_t component) const {
  std::vector<ArcEnd> ends;
  if (!cut_.contains(square)) return ends;
  const CutCell& own = cut(square);
  for (std::uint32_t a = own.first; a < own.first + own.count; ++a) {
    if (arc_component_[a] != component) continue;
    for (const ArcEnd& end : arcs_[a].ends) {
      if (end.on_border) return {};
      ends.push_back(end);
    }
  }
  return ends;
}

std::span<const std::pair<Cell, std::uint32_t>> CutGrid::shells_in(Cell cube) const {
  const auto first = std::lower_bound(whole_shells_.begin(), whole_shells_.end(), std::pair{cube, std::uint32_t{0}});
  auto last = first;
  while (last != whole_shells_.end() && last->first == cube) ++last;
  return {first, last};
}

CutGrid::CutGrid(const SurfaceMesh& mesh, GridPlanes planes, const Context& context)
    : planes_(std::move(planes)),
      lattice_({planes_.count(0) - 1, planes_.count(1) - 1, planes_.count(2) - 1}),
      cut_(lattice_) {
  TracedSurface surface = trace_surface(mesh, planes_, lattice_, context);
  take_closed_shells(mesh, surface);
  number_cells(surface);
  sort_crossings(mesh, surface);
  sort_arcs(surface);
  throw_if_cancelled(context);
  find_inside(context);
  connect_squares(mesh, context);
  connect_cubes(surface, context);
  std::sort(failing_.begin(), failing_.end());
  failing_.erase(std::unique(failing_.begin(), failing_.end()), failing_.end());
}

/// Notes shells that no plane cuts. A void fails its cube; an outer shell is a whole body.
void CutGrid::take_closed_shells(const SurfaceMesh& mesh, TracedSurface& surface) {
  std::vector<bool> is_cut(surface.euler.size(), false);
  for (const Arc& arc : surface.arcs) {
    for (const std::uint32_t piece : arc.pieces) is_cut[surface.pieces.find(piece)] = true;
  }
  const auto vertices = mesh.vertices();
  std::vector<std::uint32_t> closed;
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    // The smallest index of a piece stands for it; pieces that are no vertex are cut.
    if (surface.pieces.find(v) == v && !is_cut[v]) closed.push_back(v);
  }
  if (closed.empty()) return;
  std::vector<std::uint32_t> outer;
  for (const std::uint32_t v : mesh.outermost()) outer.push_back(surface.pieces.find(v));
  std::sort(outer.begin(), outer.end());
  for (const std::uint32_t shell : closed) {
    const Place& at = surface.cube_of_vertex[shell];
    const Cell cube = cell_at(lattice_.node(at[0], at[1], at[2]), 7);
    cut_.insert(cube);
    whole_shells_.emplace_back(cube, shell);
    const bool is_outer = std::binary_search(outer.begin(), outer.end(), shell);
    if (!is_outer || surface.euler_of(shell) != 2) failing_.push_back(cube);
  }
  std::sort(whole_shells_.begin(), whole_shells_.end());
}

void CutGrid::number_cells(TracedSurface& surface) {
  for (const GridCrossing& crossing : surface.crossings) cut_.insert(crossing.edge);
  for (const Arc& arc : surface.arcs) {
    cut_.insert(arc.square);
    for (const Cell cube : lattice_.cubes_beside(arc.square)) cut_.insert(cube);
  }
  cut_.finish();
  cells_.resize(cut_.size());
  cut_cells_ = cut_.cells();
}

void CutGrid::sort_crossings(const SurfaceMesh& mesh, const TracedSurface& surface) {
  const auto order = sorted_by(surface.crossings, [](const GridCrossing& crossing) { return crossing.edge; });
  crossings_.resize(order.size());
  inside_ = Buffer<std::uint8_t>(lattice_.node_count(), 0);
  std::vector<GridCrossing> row;
  for (std::size_t i = 0; i < order.size();) {
    const Cell edge = order[i].key;
    row.clear();
    std::size_t j = i;
    for (; j < order.size() && order[j].key == edge; ++j) row.push_back(surface.crossings[order[j].index]);
    const std::size_t axis = axis_of(axes_of(edge));
    if (row.size() > 1) {
      const auto place = lattice_.place(node_of(edge));
      const std::size_t u = next_axis(axis);
      const std::size_t v = next_axis(u);
      const double at_u = planes_.at(u, place[u]);
      const double at_v = planes_.at(v, place[v]);
      std::sort(row.begin(), row.end(), [&](const GridCrossing& a, const GridCrossing& b) {
        return is_crossed_before(mesh.corners(a.triangle), mesh.corners(b.triangle), axis, at_u, at_v);
      });
    }
    CutCell& own = cut(edge);
    own.first = static_cast<std::uint32_t>(i);
    own.count = static_cast<std::uint32_t>(row.size());
    own.components = intervals_of(own.count, row.front().leaves);
    for (std::size_t k = 0; k < row.size(); ++k) {
      if ((row[k].leaves == row.front().leaves) != (k % 2 == 0)) throw_crossing(planes_, lattice_, edge);
      crossings_[i + k] = row[k].triangle;
    }
    // For now, whether the edge along z to a node has its ends on different sides.
    if (axis == 2 && row.size() % 2 == 1) inside_[node_of(edge) + lattice_.stride(2)] = 1;
    i = j;
  }
}

void CutGrid::sort_arcs(TracedSurface& surface) {
  const auto order = sorted_by(surface.arcs, [](const Arc& arc) { return arc.square; });
  arcs_.reserve(order.size());
  for (const KeyedIndex& item : order) {
    const Arc& arc = surface.arcs[item.index];
    CutCell& own = cut(arc.square);
    if (own.count == 0) own.first = static_cast<std::uint32_t>(arcs_.size());
    ++own.count;
    arcs_.push_back(arc);
    for (std::uint32_t& piece : arcs_.back().pieces) piece = surface.pieces.find(piece);
  }
  surface.arcs = {};
  arc_component_.resize(arcs_.size());
}

void CutGrid::find_inside(const Context& context) {
  const std::size_t layer = lattice_.stride(2);
  const auto layers = static_cast<std::size_t>(lattice_.size()[2]);
  parallel_for(context, layer, 16384, "", [&](const WorkRange& range) {
    for (std::size_t k = 1; k < layers; ++k) {
      std::uint8_t* own = inside_.data() + k * layer;
      const std::uint8_t* below = own - layer;
      for (std::size_t n = range.begin; n < range.end; ++n) own[n] ^= below[n];
    }
  });
  for (const Cell cell : cut_cells_) {
    if (dimension_of(cell) != 1) continue;
    const CutCell& own = cut(cell);
    const bool begins_inside = is_inside(node_of(cell));
    const bool ends_inside = is_inside(node_of(cell) + lattice_.stride(axis_of(axes_of(cell))));
    if (begins_inside != (ends_inside != (own.count % 2 == 1)) ||
        own.components != intervals_of(own.count, begins_inside)) {
      throw_crossing(planes_, lattice_, cell);
    }
  }
}

void CutGrid::connect_squares(const SurfaceMesh& mesh, const Context& context) {
  std::uint32_t table = 0;
  for (const Cell cell : cut_cells_) {
    if (dimension_of(cell) != 2) continue;
    cut(cell).table = table;
    for (const Cell side : sides_of(cell)) table += components(side);
  }
  interval_component_.resize(table);
  std::vector<Scratch> chunks((cut_cells_.size() + grain - 1) / grain);
  parallel_for(context, cut_cells_.size(), grain, "squares", [&](const WorkRange& range) {
    Scratch& scratch = chunks[range.begin / grain];
    for (std::size_t c = range.begin; c < range.end; ++c) {
      const Cell cell = cut_cells_[c];
      if (dimension_of(cell) != 2 || connect_square(mesh, cell, scratch)) continue;
      for (const Cell cube : lattice_.cubes_beside(cell)) scratch.failing.push_back(cube);
    }
  });
  for (const Scratch& scratch : chunks) {
    failing_.insert(failing_.end(), scratch.failing.begin(), scratch.failing.end());
  }
}

bool CutGrid::connect_square(const SurfaceMesh& mesh, Cell square, Scratch& scratch) {
  CutCell& own = cut(square);
  const std::array<Cell, 4> sides = sides_of(square);
  std::array<std::uint32_t, 5> first{};
  for (std::size_t s = 0; s < 4; ++s) first[s + 1] = first[s] + components(sides[s]);
  SquareComponents& components_here = scratch.square;
  components_here.start(first[4]);
  // Corners, each the begin of a side or its end.
  const auto [lower, upper] = span_of(square);
  const std::size_t node = node_of(square);
  const std::size_t along_lower = lattice_.stride(axis_of(lower));
  const std::size_t along_upper = lattice_.stride(axis_of(upper));
  if (is_inside(node)) components_here.join(first[0], first[2]);
  if (is_inside(node + along_lower)) components_here.join(first[1] - 1, first[3]);
  if (is_inside(node + along_upper)) components_here.join(first[1], first[3] - 1);
  if (is_inside(node + along_lower + along_upper)) components_here.join(first[2] - 1, first[4] - 1);
  const auto end_of = [&](const ArcEnd& end, std::uint32_t triangle) -> SquareComponents::End {
    if (!end.on_border) return {false, end.id};
    const auto s = static_cast<std::size_t>(std::find(sides.begin(), sides.end(), end.id) - sides.begin());
    const auto row = crossings(end.id);
    const auto index = static_cast<std::uint32_t>(std::find(row.begin(), row.end(), triangle) - row.begin());
    return {true, first[s] + interval_at(index, is_inside(node_of(end.id)))};
  };
  const auto arcs = std::span(arcs_).subspan(own.first, own.count);
  for (const Arc& arc : arcs) {
    components_here.add_arc(end_of(arc.ends[0], arc.triangle), end_of(arc.ends[1], arc.triangle));
  }
  const std::size_t across = normal_axis(square);
  const double plane = planes_.at(across, lattice_.place(node)[across]);
  const bool passes = components_here.finish([&](std::span<const std::uint32_t> loop) {
    scratch.loop_edges.clear();
    for (const std::uint32_t arc : loop) {
      for (const ArcEnd& end : arcs[arc].ends) scratch.loop_edges.push_back(end.id);
    }
    return is_around_hole(mesh, scratch.loop_edges, across, plane);
  });
  own.components = components_here.count();
  for (std::uint32_t k = 0; k < first[4]; ++k) interval_component_[own.table + k] = components_here.of_interval(k);
  for (std::uint32_t a = 0; a < own.count; ++a) arc_component_[own.first + a] = components_here.of_arc(a);
  return passes;
}

void CutGrid::connect_cubes(TracedSurface& surface, const Context& context) {
  std::uint32_t table = 0;
  for (const Cell cell : cut_cells_) {
    if (dimension_of(cell) != 3) continue;
    cut(cell).table = table;
    for (const Cell face : faces_of(cell)) table += components(face);
  }
  part_component_.resize(table);
  std::vector<Scratch> chunks((cut_cells_.size() + grain - 1) / grain);
  parallel_for(context, cut_cells_.size(), grain, "cubes", [&](const WorkRange& range) {
    Scratch& scratch = chunks[range.begin / grain];
    for (std::size_t c = range.begin; c < range.end; ++c) {
      const Cell cell = cut_cells_[c];
      if (dimension_of(cell) == 3 && !connect_cube(surface, cell, scratch)) scratch.failing.push_back(cell);
    }
  });
  for (const Scratch& scratch : chunks) {
    failing_.insert(failing_.end(), scratch.failing.begin(), scratch.failing.end());
  }
}

bool CutGrid::connect_cube(const TracedSurface& surface, Cell cube, Scratch& scratch) {
  CutCell& own = cut(cube);
  const std::array<Cell, 6> faces = faces_of(cube);
  std::array<std::uint32_t, 7> first{};
  for (std::size_t f = 0; f < 6; ++f) first[f + 1] = first[f] + components(faces[f]);
  CubeComponents& components_here = scratch.cube;
  components_here.start(first[6]);
  const std::size_t node = node_of(cube);
  // An edge along an axis lies in two faces: across the next axis and the one after, each below or above.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = next_axis(axis);
    const std::size_t v = next_axis(u);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::size_t at_u = corner & 1U;
      const std::size_t at_v = corner >> 1U;
      const Cell edge = cell_at(node + at_u * lattice_.stride(u) + at_v * lattice_.stride(v), 1U << axis);
      const std::size_t face_u = 2 * u + at_u;
      const std::size_t face_v = 2 * v + at_v;
      const std::uint32_t intervals = components(edge);
      for (std::uint32_t k = 0; k < intervals; ++k) {
        const std::uint32_t one = first[face_u] + component_of_interval(faces[face_u], edge, k);
        components_here.join_at_interval(one, first[face_v] + component_of_interval(faces[face_v], edge, k));
        // The corners of the cube are the ends of its four edges along x.
        if (axis != 0) continue;
        if (k == 0 && is_inside(node_of(edge))) components_here.add_corner(one);
        if (k + 1 == intervals && is_inside(node_of(edge) + 1)) components_here.add_corner(one);
      }
    }
  }
  for (std::size_t f = 0; f < 6; ++f) {
    if (!cut_.contains(faces[f])) continue;
    const CutCell& square = cut(faces[f]);
    for (std::uint32_t a = square.first; a < square.first + square.count; ++a) {
      components_here.add_arc(arcs_[a].pieces[f % 2 == 0 ? 1 : 0], first[f] + arc_component_[a]);
    }
  }
  const bool passes = components_here.finish([&](std::uint32_t piece) { return surface.euler_of(piece); });
  for (std::uint32_t k = 0; k < first[6]; ++k) part_component_[own.table + k] = components_here.of_part(k);
  own.components = components_here.count();
  own.components += static_cast<std::uint32_t>(shells_in(cube).size());
  return passes;
}

}  // namespace blum::detail
