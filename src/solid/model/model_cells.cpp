#include "solid/model/model_cells.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "blum/core/error.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t most_cells = 0xfffffff0U;

/// Returns the cells of a grid that belong to a cube of a region, in ascending order.
std::vector<Cell> cells_of(const CutGrid& grid, std::span<const RefinedRegion> regions) {
  std::vector<Cell> cells;
  for (const RefinedRegion& region : regions) {
    for (const Cell cube : region.cubes()) {
      for (std::size_t corner = 0; corner < 8; ++corner) {
        std::size_t node = node_of(cube);
        for (std::size_t a = 0; a < 3; ++a) node += (corner >> a & 1U) * grid.lattice().stride(a);
        for (CellAxes axes = 0; axes < 8; ++axes) {
          if ((axes & corner) == 0) cells.push_back(cell_at(node, axes));
        }
      }
    }
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

/// Returns the coordinate at which a line along an axis crosses the plane of a triangle.
double crossing_height(const TriangleCorners& t, std::size_t axis, const Vec3d& on_line) {
  const Vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
  return on_line[axis] - dot(normal, on_line - t[0]) / normal[axis];
}

class Assembly {
 public:
  Assembly(const SurfaceMesh& mesh, const CutGrid& grid, std::span<const RefinedRegion> regions, const Context& context)
      : mesh_(mesh), grid_(grid), lattice_(grid.lattice()), regions_(regions), context_(context) {}

  /// Assembles all cells of the model.
  ModelCells assemble() {
    refined_ = cells_of(grid_, regions_);
    std::vector<Cell> all;
    for (std::size_t node = 0; node < lattice_.node_count(); ++node) {
      for (CellAxes axes = 0; axes < 8; ++axes) {
        const Cell cell = cell_at(node, axes);
        if (grid_.components(cell) > 0 && (refined_.empty() || !is_refined(cell))) all.push_back(cell);
      }
    }
    return assemble(all);
  }

  /// Assembles the cells of the model that differ from those of the voxels on a lattice.
  ExtraModelCells assemble_extra(const CellLattice& voxels) {
    refined_ = cells_of(grid_, regions_);
    voxels_ = &voxels;
    base_ = static_cast<std::uint32_t>(8 * voxels.node_count());
    ExtraModelCells out;
    out.first = base_;
    std::vector<Cell> extra;
    for (const Cell cell : grid_.cut_cells()) {
      if (is_refined(cell)) continue;
      const std::uint32_t components = grid_.components(cell);
      const bool has_voxel = has_corner_inside(cell);
      if (components == (has_voxel ? 1U : 0U)) continue;
      extra.push_back(cell);
      if (has_voxel) out.replaced.push_back(dual(cell));
    }
    for (const Cell cell : refined_) {
      if (has_corner_inside(cell)) out.replaced.push_back(dual(cell));
    }
    std::sort(out.replaced.begin(), out.replaced.end());
    out.cells = assemble(extra);
    for (const Cell cell : extra) {
      add_cofaces(cell, out.cofaces);
      out.places.insert(out.places.end(), grid_.components(cell), dual(cell));
    }
    std::sort(out.cofaces.begin(), out.cofaces.end());
    witness_by_cofaces(out);
    return out;
  }

 private:
  /// @param named  cells of the grid that belong to no region, in ascending order.
  ModelCells assemble(const std::vector<Cell>& named) {
    name_cells(named);
    out_.first_face.reserve(out_.size() + 1);
    std::size_t seen = 0;
    for (const Cell cell : named) {
      if (seen++ % 65536 == 0) throw_if_cancelled(context_);
      add_faces(cell);
    }
    for (std::uint32_t r = 0; r < regions_.size(); ++r) add_region_faces(r);
    out_.first_face.push_back(static_cast<std::uint32_t>(out_.faces.size()));
    spread_witnesses();
    return std::move(out_);
  }

  [[nodiscard]] bool has_corner_inside(Cell cell) const {
    for (CellAxes corner = 0; corner < 8; ++corner) {
      if ((corner & axes_of(cell)) == corner && grid_.is_inside(moved(node_of(cell), corner))) return true;
    }
    return false;
  }
  /// Returns the node one step further along each of the given axes.
  [[nodiscard]] std::size_t moved(std::size_t node, CellAxes axes) const {
    for (std::size_t a = 0; a < 3; ++a) node += (axes >> a & 1U) * lattice_.stride(a);
    return node;
  }
  /// Returns the cell of the voxels' lattice that stands for a cell of the grid.
  [[nodiscard]] Cell dual(Cell cell) const {
    std::array<std::int64_t, 3> at = lattice_.place(node_of(cell));
    for (std::size_t a = 0; a < 3; ++a) at[a] += axes_of(cell) >> a & 1U;
    return cell_at(voxels_->node(at[0], at[1], at[2]), 7U ^ axes_of(cell));
  }
  /// Returns the id of a component of a grid cell that belongs to no region.
  [[nodiscard]] std::uint32_t id_of(Cell cell, std::uint32_t component) const {
    return first_.contains(cell) ? base_ + first_.of(cell) + component : dual(cell);
  }
  /// Returns true if the voxels' cell that stands for a cell of the grid is also a cell of the model.
  [[nodiscard]] bool is_plain(Cell cell) const {
    return !first_.contains(cell) && grid_.components(cell) > 0 && !is_refined(cell);
  }

  /// Adds pairs of a component of a cell and a plain cell (see is_plain()) of which the component is a face.
  void add_cofaces(Cell cell, std::vector<std::array<std::uint32_t, 2>>& pairs) const {
    const auto add = [&](Cell side, std::uint32_t component) {
      pairs.push_back({first_.of(cell) + component, dual(side)});
    };
    if (dimension_of(cell) == 1) {
      const std::size_t high = node_of(cell) + lattice_.stride(axis_of(axes_of(cell)));
      if (is_plain(cell_at(node_of(cell), 0))) add(cell_at(node_of(cell), 0), 0);
      if (is_plain(cell_at(high, 0))) add(cell_at(high, 0), grid_.components(cell) - 1);
    } else if (dimension_of(cell) == 2) {
      for (const Cell side : grid_.sides_of(cell)) {
        if (is_plain(side)) add(side, grid_.component_of_interval(cell, side, 0));
      }
    } else if (dimension_of(cell) == 3) {
      const std::array<Cell, 6> faces = grid_.faces_of(cell);
      for (std::size_t f = 0; f < 6; ++f) {
        if (is_plain(faces[f])) add(faces[f], grid_.component_of_part(cell, f, 0));
      }
    }
  }

  /// Sets missing witnesses of extra cells. An extra cell without a witness is a face of a plain cell. An inside node
  /// of this plain cell becomes the witness.
  void witness_by_cofaces(ExtraModelCells& out) const {
    for (const auto& [extra, plain] : out.cofaces) {
      if (has_witness_[extra]) continue;
      const std::array<std::int64_t, 3> voxel = voxel_at(plain);
      out.cells.witness[extra] = grid_.planes().node(voxel);
    }
  }
  /// Returns an inside node at a corner of the grid cell for which a cell of the voxels stands.
  [[nodiscard]] std::array<std::int64_t, 3> voxel_at(Cell plain) const {
    std::array<std::int64_t, 3> found = voxels_->place(node_of(plain));
    voxels_->for_each_cube_around(plain, [&](const std::array<std::int64_t, 3>& at) {
      if (grid_.is_inside(lattice_.node(at[0], at[1], at[2]))) found = at;
    });
    return found;
  }

  /// For each cell of the grid that has ids: the first of them.
  class FirstIds {
   public:
    void reset(const CellLattice& lattice) { ranked_ = RankedCells(lattice); }
    void insert(Cell cell) { ranked_.insert(cell); }
    void finish() {
      ranked_.finish();
      ids_.reserve(ranked_.size());
    }
    void push(std::uint32_t id) { ids_.push_back(id); }
    [[nodiscard]] bool contains(Cell cell) const { return ranked_.contains(cell); }
    [[nodiscard]] std::uint32_t of(Cell cell) const { return ids_[ranked_.number(cell)]; }

   private:
    RankedCells ranked_;
    std::vector<std::uint32_t> ids_;
  };

  struct RegionIds {
    std::vector<std::uint32_t> boxes, rectangles, segments, corners;  ///< first id of each
  };

  [[nodiscard]] bool is_refined(Cell cell) const { return std::binary_search(refined_.begin(), refined_.end(), cell); }

  void push_cells(std::size_t dimension, std::uint32_t count) {
    if (base_ + out_.dimension.size() + count > most_cells) {
      throw InvalidGrid("the model has more cells than can be numbered: use a coarser grid");
    }
    for (std::uint32_t k = 0; k < count; ++k) out_.dimension.push_back(static_cast<std::uint8_t>(dimension));
  }

  void name_cells(const std::vector<Cell>& named) {
    first_.reset(lattice_);
    for (const Cell cell : named) first_.insert(cell);
    first_.finish();
    for (const Cell cell : named) {
      first_.push(static_cast<std::uint32_t>(out_.size()));
      push_cells(static_cast<std::size_t>(3 - dimension_of(cell)), grid_.components(cell));
    }
    for (const RefinedRegion& region : regions_) {
      RegionIds& ids = of_region_.emplace_back();
      const auto name = [&](std::vector<std::uint32_t>& first, std::size_t dimension, std::size_t count,
                            const auto& components) {
        for (std::uint32_t k = 0; k < count; ++k) {
          first.push_back(static_cast<std::uint32_t>(out_.size()));
          push_cells(dimension, components(k));
        }
      };
      const BoxCells& cells = region.cells();
      name(ids.boxes, 0, region.boxes().size(), [&](std::uint32_t k) { return region.components_of_box(k); });
      name(ids.rectangles, 1, cells.rectangles().size(),
           [&](std::uint32_t k) { return region.components_of_rectangle(k); });
      name(ids.segments, 2, cells.segments().size(), [&](std::uint32_t k) { return region.components_of_segment(k); });
      name(ids.corners, 3, cells.corners().size(), [&](std::uint32_t k) { return region.is_inside(k) ? 1U : 0U; });
    }
    out_.witness.assign(out_.size(), Vec3d{});
    if (voxels_ != nullptr) {
      out_.ends.assign(out_.size(), {});
      out_.boxes.assign(out_.size(), {});
    }
    has_witness_.assign(out_.size(), false);
  }

  void begin_cell() { out_.first_face.push_back(static_cast<std::uint32_t>(out_.faces.size())); }
  /// Sets the witness of the current cell, which begin_cell() began.
  void set_witness(const Vec3d& p) {
    out_.witness[out_.first_face.size() - 1] = p;
    has_witness_[out_.first_face.size() - 1] = true;
  }
  /// Copies witnesses from cells to those of their faces that have none. The component of a face contains the component
  /// of the cell.
  void spread_witnesses() {
    for (int dimension = 3; dimension > 0; --dimension) {
      for (std::uint32_t cell = 0; cell < out_.size(); ++cell) {
        if (out_.dimension[cell] != dimension || !has_witness_[cell]) continue;
        for (const std::uint32_t id : out_.faces_of(cell)) {
          if (id < base_) continue;
          const std::uint32_t face = id - base_;
          if (!has_witness_[face]) out_.witness[face] = out_.witness[cell];
          has_witness_[face] = true;
        }
      }
    }
  }

  /// Sets the ends of interval `interval` on a segment along an axis, from `low` to the coordinate `high`. The middle
  /// of the interval becomes the witness. `crossings` are the triangles that cross the segment, from below.
  void set_interval(std::size_t axis, const Vec3d& low, double high, bool begins_inside,
                    std::span<const std::uint32_t> crossings, std::uint32_t interval) {
    const auto end_at = [&](std::size_t k) {
      IntervalEnd end{low, crossings[k]};
      end.point[axis] = std::clamp(crossing_height(mesh_.corners(crossings[k]), axis, low), low[axis], high);
      return end;
    };
    const std::size_t begin = 2 * std::size_t{interval} + (begins_inside ? 0 : 1);  // it lies after crossing begin - 1
    IntervalEnd top{low};
    top.point[axis] = high;
    const std::array<IntervalEnd, 2> ends{begin == 0 ? IntervalEnd{low} : end_at(begin - 1),
                                          begin < crossings.size() ? end_at(begin) : top};
    set_witness(0.5 * (ends[0].point + ends[1].point));
    if (voxels_ != nullptr) out_.ends[out_.first_face.size() - 1] = ends;
  }
  [[nodiscard]] Vec3d node_position(std::size_t node) const { return grid_.planes().node(lattice_.place(node)); }
  /// Sets the witness to the mean of the points where edges of the mesh pass through a plane. Does nothing without
  /// edges.
  void set_middle(const std::vector<ArcEnd>& ends, std::size_t across, double plane) {
    if (ends.empty()) return;
    Vec3d sum;
    for (const ArcEnd& end : ends) sum += point_on(end, across, plane);
    set_witness(sum / static_cast<double>(ends.size()));
  }
  /// Returns the point where an edge of the mesh meets a plane of the grid.
  [[nodiscard]] Vec3d point_on(const ArcEnd& end, std::size_t across, double plane) const {
    const auto [a, b] = mesh_.ends(end.id);
    const double t = (plane - a[across]) / (b[across] - a[across]);
    return a + (b - a) * std::clamp(t, 0.0, 1.0);
  }
  void add_face(std::uint32_t id) { out_.faces.push_back(id); }

  void add_faces(Cell cell) {
    const std::uint32_t components = grid_.components(cell);
    for (std::uint32_t k = 0; k < components; ++k) {
      begin_cell();
      if (dimension_of(cell) == 3) witness_cube(cell, k);
      if (dimension_of(cell) == 2) add_ends(cell, k);
      if (dimension_of(cell) == 1) add_border(cell, k);
      if (dimension_of(cell) == 0) add_sides(cell);
    }
  }

  void witness_cube(Cell cube, std::uint32_t component) {
    if (!grid_.is_cut(cube)) {
      set_witness(0.5 * (node_position(node_of(cube)) + node_position(node_of(cube) + lattice_.node(1, 1, 1))));
      return;
    }
    const auto shells = grid_.shells_in(cube);
    const std::size_t others = grid_.components(cube) - shells.size();
    if (component >= others) set_witness(mesh_.vertices()[shells[component - others].second]);
  }

  /// Adds the faces of an edge of the model: the vertices in the cubes on both sides of the square.
  void add_ends(Cell square, std::uint32_t component) {
    const std::size_t across = normal_axis(square);
    set_middle(grid_.loose_ends(square, component), across, node_position(node_of(square))[across]);
    const auto [below, above] = lattice_.cubes_beside(square);
    add_face(id_of(below, grid_.component_of_part(below, 2 * across + 1, component)));
    add_face(id_of(above, grid_.component_of_part(above, 2 * across, component)));
  }

  /// Adds the faces of a polygon: the edges in the four squares around the grid's edge.
  void add_border(Cell edge, std::uint32_t interval) {
    const std::size_t axis = axis_of(axes_of(edge));
    set_interval(axis, node_position(node_of(edge)), node_position(node_of(edge) + lattice_.stride(axis))[axis],
                 grid_.is_inside(node_of(edge)), grid_.crossings(edge), interval);
    for (std::size_t a = 0; a < 3; ++a) {
      const CellAxes bit = 1U << a;
      if ((axes_of(edge) & bit) != 0) continue;
      const Cell above = edge | bit;
      for (const Cell square : {static_cast<Cell>(above - 8 * lattice_.stride(a)), above}) {
        add_face(id_of(square, grid_.component_of_interval(square, edge, interval)));
      }
    }
  }

  /// Adds the faces of a polyhedron: the polygons on the six edges of the grid at the node.
  void add_sides(Cell node) {
    set_witness(node_position(node_of(node)));
    for (std::size_t a = 0; a < 3; ++a) {
      const Cell above = node | 1U << a;
      const auto below = static_cast<Cell>(above - 8 * lattice_.stride(a));
      add_face(id_of(below, grid_.components(below) - 1));
      add_face(id_of(above, 0));
    }
  }

  void add_region_faces(std::uint32_t r) {
    const RefinedRegion& region = regions_[r];
    const RegionIds& ids = of_region_[r];
    const BoxCells& cells = region.cells();
    for (std::uint32_t b = 0; b < region.boxes().size(); ++b) {
      const auto bodies = region.bodies_in(b);
      const std::size_t others = region.components_of_box(b) - bodies.size();
      for (std::uint32_t k = 0; k < region.components_of_box(b); ++k) {
        begin_cell();
        const BoxCell& box = region.boxes()[b];
        if (voxels_ != nullptr) out_.boxes[out_.first_face.size() - 1] = Box3{box.low, box.high};
        if (k >= others) set_witness(mesh_.vertices()[bodies[k - others]]);
      }
    }
    for (std::uint32_t k = 0; k < cells.rectangles().size(); ++k) {
      for (std::uint32_t c = 0; c < region.components_of_rectangle(k); ++c) {
        begin_cell();
        add_ends(region, ids, k, c);
      }
    }
    for (std::uint32_t s = 0; s < cells.segments().size(); ++s) {
      for (std::uint32_t c = 0; c < region.components_of_segment(s); ++c) {
        begin_cell();
        add_border(region, ids, s, c);
      }
    }
    add_region_sides(region, ids);
  }

  void add_ends(const RefinedRegion& region, const RegionIds& ids, std::uint32_t rectangle, std::uint32_t component) {
    const BoxRectangle& own = region.cells().rectangles()[rectangle];
    const BoxSegment& side = region.cells().segments()[own.sides[0].front()];
    set_middle(region.loose_ends(rectangle, component), own.axis, region.cells().corners()[side.ends[0]][own.axis]);
    for (std::size_t side = 0; side < 2; ++side) {
      const BoxRef& box = own.boxes[side];
      if (box.is_box) {
        add_face(base_ + ids.boxes[box.id] + region.component_of_part(box.id, rectangle, component));
      } else {
        add_face(id_of(box.id, grid_.component_of_part(box.id, 2 * own.axis + 1 - side, component)));
      }
    }
  }

  void add_border(const RefinedRegion& region, const RegionIds& ids, std::uint32_t segment, std::uint32_t interval) {
    const BoxSegment& own = region.cells().segments()[segment];
    const auto corners = region.cells().corners();
    set_interval(own.axis, corners[own.ends[0]], corners[own.ends[1]][own.axis], region.is_inside(own.ends[0]),
                 region.crossings(segment), interval);
    constexpr std::array<std::array<std::size_t, 2>, 4> beside{{{0, 1}, {2, 3}, {0, 2}, {1, 3}}};
    for (std::size_t k = 0; k < 4; ++k) {
      const BoxRef& below = own.around[beside[k][0]];
      const BoxRef& above = own.around[beside[k][1]];
      if (below == above) continue;
      if (below.is_box || above.is_box) {
        const std::uint32_t rectangle = region.cells().rectangle(below, above);
        add_face(base_ + ids.rectangles[rectangle] + region.component_of_interval(rectangle, segment, interval));
      } else {
        const std::size_t across = k < 2 ? next_axis(own.axis) : next_axis(next_axis(own.axis));
        const Cell square = above.id ^ (1U << across);
        add_face(id_of(square, grid_.component_of_interval(square, edge_of(region, own), interval)));
      }
    }
  }

  /// Returns the edge of the grid that a segment covers completely.
  [[nodiscard]] Cell edge_of(const RefinedRegion& region, const BoxSegment& segment) const {
    const Place at = grid_.planes().cube(region.cells().corners()[segment.ends[0]]);
    return cell_at(lattice_.node(at[0], at[1], at[2]), 1U << segment.axis);
  }

  void add_region_sides(const RefinedRegion& region, const RegionIds& ids) {
    const BoxCells& cells = region.cells();
    std::vector<std::vector<std::uint32_t>> sides(cells.corners().size());
    for (std::uint32_t s = 0; s < cells.segments().size(); ++s) {
      const auto [low, high] = cells.segments()[s].ends;
      const std::uint32_t count = region.components_of_segment(s);
      if (count == 0) continue;
      if (region.is_inside(low)) sides[low].push_back(base_ + ids.segments[s]);
      if (region.is_inside(high)) sides[high].push_back(base_ + ids.segments[s] + count - 1);
    }
    for (std::uint32_t c = 0; c < sides.size(); ++c) {
      if (!region.is_inside(c)) continue;
      begin_cell();
      set_witness(cells.corners()[c]);
      for (const std::uint32_t side : sides[c]) add_face(side);
      const Place at = grid_.planes().cube(cells.corners()[c]);
      if (grid_.planes().node(at) != cells.corners()[c]) continue;
      // Adds edges of the grid that belong to no region.
      const Cell node = cell_at(lattice_.node(at[0], at[1], at[2]), 0);
      for (std::size_t a = 0; a < 3; ++a) {
        const Cell above = node | 1U << a;
        const auto below = static_cast<Cell>(above - 8 * lattice_.stride(a));
        if (!is_refined(below)) add_face(id_of(below, grid_.components(below) - 1));
        if (!is_refined(above)) add_face(id_of(above, 0));
      }
    }
  }

  const SurfaceMesh& mesh_;
  const CutGrid& grid_;
  const CellLattice& lattice_;
  std::span<const RefinedRegion> regions_;
  const Context& context_;
  const CellLattice* voxels_ = nullptr;  ///< set if only extra cells are assembled
  std::uint32_t base_ = 0;               ///< added to the numbers of extra cells to get ids
  std::vector<Cell> refined_;            ///< cells of the grid that belong to a region
  FirstIds first_;
  std::vector<RegionIds> of_region_;
  ModelCells out_;
  std::vector<bool> has_witness_;
};

}  // namespace

ModelCells model_cells(const SurfaceMesh& mesh, const CutGrid& grid, std::span<const RefinedRegion> regions,
                       const Context& context) {
  return Assembly(mesh, grid, regions, context).assemble();
}

ExtraModelCells extra_model_cells(const SurfaceMesh& mesh, const CutGrid& grid, std::span<const RefinedRegion> regions,
                                  const CellLattice& voxels, const Context& context) {
  return Assembly(mesh, grid, regions, context).assemble_extra(voxels);
}

std::array<std::int64_t, 4> count_model_cells(const CutGrid& grid, std::span<const RefinedRegion> regions) {
  std::array<std::int64_t, 4> count{};
  std::int64_t inside = 0;
  for (std::size_t node = 0; node < grid.lattice().node_count(); ++node) inside += grid.is_inside(node) ? 1 : 0;
  const auto add = [&](Cell cell, std::int64_t components) {
    count[static_cast<std::size_t>(3 - dimension_of(cell))] += components;
  };
  for (CellAxes axes = 0; axes < 8; ++axes) add(axes, inside);
  // Corrects cells that the surface cuts: their components differ from the state of their first corner.
  for (const Cell cell : grid.cut_cells()) {
    add(cell, std::int64_t{grid.components(cell)} - (grid.is_inside(node_of(cell)) ? 1 : 0));
  }
  for (const Cell cell : cells_of(grid, regions)) add(cell, -std::int64_t{grid.components(cell)});
  for (const RefinedRegion& region : regions) {
    for (std::uint32_t k = 0; k < region.boxes().size(); ++k) count[0] += region.components_of_box(k);
    for (std::uint32_t k = 0; k < region.cells().rectangles().size(); ++k) {
      count[1] += region.components_of_rectangle(k);
    }
    for (std::uint32_t k = 0; k < region.cells().segments().size(); ++k) count[2] += region.components_of_segment(k);
    for (std::uint32_t k = 0; k < region.cells().corners().size(); ++k) count[3] += region.is_inside(k) ? 1 : 0;
  }
  return count;
}

}  // namespace blum::detail
