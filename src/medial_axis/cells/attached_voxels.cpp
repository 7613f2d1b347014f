#include "medial_axis/cells/attached_voxels.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/bits.hpp"
#include "blum/core/parallel.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "medial_axis/cells/thinning_order.hpp"

namespace blum::detail {
namespace {

using Place = std::array<std::int64_t, 3>;

constexpr std::size_t steps_between_looks = std::size_t{1} << 16U;

/// Returns bits: bit a is set if the cell that spans axes `a` from a lattice node belongs to one given voxel around the
/// node. Bit x, y or z of `behind` is 1 if the voxel lies on the lower side of the node along that axis.
constexpr std::uint8_t cells_towards(unsigned behind) {
  std::uint8_t bits = 0;
  for (unsigned axes = 0; axes < 8; ++axes) {
    if ((axes & behind) == 0) bits |= static_cast<std::uint8_t>(1U << axes);
  }
  return bits;
}

/// Table of the neighbours of a voxel that also contain one of its cells. The cell spans `axes` from the voxel's corner
/// `corner` (bits x, y, z: 1 on the upper side).
constexpr auto make_sharers() {
  std::array<std::array<Neighbourhood, 8>, 8> table{};
  for (unsigned corner = 0; corner < 8; ++corner) {
    for (unsigned axes = 0; axes < 8; ++axes) {
      if ((axes & corner) == 0) table[corner][axes] = sharers_of_place[place_on_border(corner, axes)];
    }
  }
  return table;
}
constexpr auto sharers_of = make_sharers();

class Thinner {
 public:
  Thinner(const VoxelSolid& solid, const AttachedVoxels& attached, const CellLattice& lattice,
          const Importance& importance, const Context& context)
      : attached_(attached),
        voxels_(attached.voxels()),
        size_(voxels_.size()),
        lattice_(lattice),
        importance_(importance),
        context_(context),
        own_depth_(is_depth_enough(solid, voxels_, context) ? Buffer<float>() : depth_of(solid, voxels_)),
        depth_(own_depth_.empty() ? solid.depth.span() : own_depth_.span()),
        order_(depth_, size_),
        step_(std::min({solid.grid.spacing.x, solid.grid.spacing.y, solid.grid.spacing.z}) / 16) {}

  VoxelSet thin() {
    Line line(step_);
    is_in_line_ = VoxelSet(size_);
    kept_ = VoxelSet(size_);
    const auto stuck = order_.stuck(
        voxels_,
        [this](std::uint32_t voxel, const Place& at, Neighbourhood around, SimpleCache& simple) {
          return may_go(voxel, at, around, simple);
        },
        context_);
    for (const std::uint32_t voxel : stuck) {
      const Place at = voxels_.place(voxel);
      is_in_line_.insert(at[0], at[1], at[2]);
      line.push({depth_[voxel], voxel});
    }
    SimpleCache simple;
    Waiting next{};
    std::size_t steps = 0;
    while (line.pop(next)) {
      if (++steps % steps_between_looks == 0) throw_if_cancelled(context_);
      const Place at = voxels_.place(next.voxel);
      const Neighbourhood around = order_.present_around(next.voxel, kept_);
      if (may_go(next.voxel, at, around, simple)) continue;
      kept_.insert(at[0], at[1], at[2]);
      for (std::size_t n = 0; n < 27; ++n) {
        const std::uint32_t other = order_.neighbour(next.voxel, n);
        if (!order_.is_deeper(other, next.voxel)) continue;
        const Place there = voxels_.place(other);
        if (is_in_line_.contains(there[0], there[1], there[2])) continue;
        is_in_line_.insert(there[0], there[1], there[2]);
        line.push({depth_[other], other});
      }
    }
    return std::move(kept_);
  }

 private:
  /// Returns true if the solid's depths are above zero for all voxels of the set and for no others. The result is false
  /// if an extra cell of the model replaces a voxel.
  static bool is_depth_enough(const VoxelSolid& solid, const VoxelSet& voxels, const Context& context) {
    const auto layers = static_cast<std::size_t>(solid.grid.size[2]);
    std::vector<std::uint8_t> is_enough(layers, 1);
    parallel_for(context, layers, 1, "", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        std::size_t at = solid.grid.index(0, 0, static_cast<std::int64_t>(k));
        for (std::int64_t j = 0; j < solid.grid.size[1]; ++j) {
          const auto row = voxels.row(j, static_cast<std::int64_t>(k));
          for (std::int64_t i = 0; i < solid.grid.size[0]; ++i, ++at) {
            const bool is_in = (row[static_cast<std::size_t>(i / 64)] >> (i % 64) & 1U) != 0;
            if (is_in != (solid.depth[at] > 0)) is_enough[k] = 0;
          }
        }
      }
    });
    return std::all_of(is_enough.begin(), is_enough.end(), [](std::uint8_t is) { return is != 0; });
  }

  /// Returns the solid's depths, changed so that they are above zero for all voxels of the set and for no others.
  static Buffer<float> depth_of(const VoxelSolid& solid, const VoxelSet& voxels) {
    Buffer<float> depth = solid.depth.clone();
    std::size_t at = 0;
    for (std::int64_t k = 0; k < solid.grid.size[2]; ++k) {
      for (std::int64_t j = 0; j < solid.grid.size[1]; ++j) {
        const auto row = voxels.row(j, k);
        for (std::int64_t i = 0; i < solid.grid.size[0]; ++i, ++at) {
          const bool is_in = (row[static_cast<std::size_t>(i / 64)] >> (i % 64) & 1U) != 0;
          depth[at] = is_in ? std::max(depth[at], std::numeric_limits<float>::min()) : 0;
        }
      }
    }
    return depth;
  }

  /// Returns true if a voxel is simple given the neighbours `around` and none of its cells is needed.
  [[nodiscard]] bool may_go(std::uint32_t voxel, const Place& at, Neighbourhood around, SimpleCache& simple) const {
    if (attached_.contain(at[0], at[1], at[2])) return attached_.may_go(voxel, around);
    return simple.is_simple(around) && !is_needed(at, around);
  }

  /// Returns true if a cell of a voxel has an importance above 0 and belongs to none of the neighbours `around`.
  [[nodiscard]] bool is_needed(const Place& at, Neighbourhood around) const {
    const std::size_t node = lattice_.node(at[0], at[1], at[2]);
    for (unsigned corner = 0; corner < 8; ++corner) {
      const std::size_t n =
          node + (corner & 1U) + (corner >> 1U & 1U) * lattice_.stride(1) + (corner >> 2U) * lattice_.stride(2);
      unsigned cells = importance_.cells_at(n) & towards_[corner];
      for (; cells != 0; cells &= cells - 1) {
        if ((sharers_of[corner][static_cast<unsigned>(std::countr_zero(cells))] & around) == 0) return true;
      }
    }
    return false;
  }

  static constexpr std::array<std::uint8_t, 8> towards_{cells_towards(0), cells_towards(1), cells_towards(2),
                                                        cells_towards(3), cells_towards(4), cells_towards(5),
                                                        cells_towards(6), cells_towards(7)};

  const AttachedVoxels& attached_;
  const VoxelSet& voxels_;
  Place size_;
  const CellLattice& lattice_;
  const Importance& importance_;
  const Context& context_;
  Buffer<float> own_depth_;
  std::span<const float> depth_;
  DepthOrder order_;
  double step_;
  VoxelSet is_in_line_;
  VoxelSet kept_;
};

constexpr unsigned middle = place_of_voxel;

using Place = std::array<std::int64_t, 3>;

/// Returns true if one cell of a voxel is a face of another cell of the voxel. Both arguments are places (see
/// place_of_voxel).
constexpr bool is_face(unsigned face, unsigned cell) {
  const auto f = along_axes(face);
  const auto c = along_axes(cell);
  for (std::size_t a = 0; a < 3; ++a) {
    if (c[a] != 1 && c[a] != f[a]) return false;
  }
  return face != cell;
}
constexpr int dimension_at(unsigned place) {
  int dimension = 0;
  for (const unsigned x : along_axes(place)) dimension += x == 1 ? 1 : 0;
  return dimension;
}

struct BorderTables {
  std::array<std::uint32_t, 27> touching{};  ///< faces and cofaces of each cell of the border
  std::uint32_t even = 0;                    ///< cells of even dimension
};
constexpr BorderTables make_tables() {
  BorderTables tables;
  for (unsigned p = 0; p < 27; ++p) {
    if (dimension_at(p) % 2 == 0) tables.even |= 1U << p;
    for (unsigned q = 0; q < 27; ++q) {
      if (q == middle) continue;
      if (p != middle && (is_face(p, q) || is_face(q, p))) tables.touching[p] |= 1U << q;
    }
  }
  return tables;
}
constexpr BorderTables tables = make_tables();

/// Returns true if a set of border cells of a voxel is contractible: connected, with Euler number 1. The set must
/// contain all faces of its cells.
bool is_contractible(std::uint32_t cells) {
  if (cells == 0) return false;
  if (bit_count(cells & tables.even) != bit_count(cells & ~tables.even) + 1) return false;
  std::uint32_t reached = cells & (0U - cells);
  for (std::uint32_t next = reached; next != 0;) {
    std::uint32_t touched = 0;
    for (std::uint32_t rest = next; rest != 0; rest &= rest - 1) {
      touched |= tables.touching[static_cast<std::size_t>(std::countr_zero(rest))];
    }
    next = touched & cells & ~reached;
    reached |= next;
  }
  return reached == cells;
}

}  // namespace

VoxelSet thin_voxels(const VoxelSolid& solid, const AttachedVoxels& attached, const CellLattice& lattice,
                     const Importance& importance, const Context& context) {
  return Thinner(solid, attached, lattice, importance, context).thin();
}

AttachedVoxels::AttachedVoxels(const CellComplex& model, const VoxelSet& voxels, const Importance& importance)
    : model_(model), structure_(model.structure()) {
  if (structure_.extra() == nullptr) {
    plain_ = voxels;
    attached_ = VoxelSet(voxels.size());
    return;
  }
  find_plain(voxels);
  find_attached();
  find_staying();
  find_borders(importance);
}

void AttachedVoxels::find_plain(const VoxelSet& voxels) {
  plain_ = voxels;
  for (const Cell cell : structure_.extra()->replaced()) {
    if (dimension_of(cell) != 3) continue;
    const Place at = structure_.lattice().place(node_of(cell));
    plain_.erase(at[0], at[1], at[2]);
  }
}

/// Finds the voxels that touch a lattice cell with an extra cell as face or coface.
void AttachedVoxels::find_attached() {
  attached_ = VoxelSet(plain_.size());
  const ExtraIncidence& extra = *structure_.extra();
  const auto is_there = [&](Cell cell) { return model_.contains(cell); };
  for (const Cell mixed : extra.mixed()) {
    const auto faces = extra.extra_faces_of(mixed);
    const auto cofaces = extra.extra_cofaces_of(mixed);
    if (std::none_of(faces.begin(), faces.end(), is_there) && std::none_of(cofaces.begin(), cofaces.end(), is_there)) {
      continue;
    }
    attach_around(mixed);
  }
}

template <class Visit>
void AttachedVoxels::for_each_voxel_around(Cell cell, const Visit& visit) const {
  structure_.lattice().for_each_cube_around(cell, [&](const Place& at) {
    if (plain_.contains(at[0], at[1], at[2])) visit(at);
  });
}

void AttachedVoxels::attach_around(Cell cell) {
  for_each_voxel_around(cell, [&](const Place& at) { attached_.insert(at[0], at[1], at[2]); });
}

template <class Visit>
void AttachedVoxels::for_each_attached(const Visit& visit) const {
  for (std::int64_t k = 0; k < plain_.size()[2]; ++k) {
    for (std::int64_t j = 0; j < plain_.size()[1]; ++j) {
      const auto row = attached_.row(j, k);
      for (std::size_t w = 0; w < row.size(); ++w) {
        for (std::uint64_t rest = row[w]; rest != 0; rest &= rest - 1) {
          visit(Place{static_cast<std::int64_t>(64 * w) + std::countr_zero(rest), j, k});
        }
      }
    }
  }
}

/// Lists the cells of a voxel: first the voxel itself, then the cells of its border.
void AttachedVoxels::find_closure(const Place& voxel, std::vector<Cell>& cells) const {
  cells.assign(1, cell_at(structure_.lattice().node(voxel[0], voxel[1], voxel[2]), 7));
  for (std::size_t n = 0; n < cells.size(); ++n) {
    structure_.for_each_face(cells[n], [&](Cell face) {
      if (model_.contains(face) && std::find(cells.begin(), cells.end(), face) == cells.end()) cells.push_back(face);
    });
  }
}

/// Appends to `found` those lattice cells in the border of an extra polyhedron that no voxel contains. The polyhedron
/// itself may already be removed.
void AttachedVoxels::find_without_voxel(Cell polyhedron, std::vector<Cell>& found) {
  structure_.for_each_face(polyhedron, [&](Cell polygon) {
    const auto look_at = [&](Cell cell) {
      if (structure_.is_extra(cell) || !model_.contains(cell)) return;
      bool has_voxel = false;
      for_each_voxel_around(cell, [&](const Place&) { has_voxel = true; });
      if (!has_voxel && plain_staying_.insert(cell).second) found.push_back(cell);
    };
    look_at(polygon);
    structure_.for_each_face(polygon, [&](Cell edge) {
      look_at(edge);
      structure_.for_each_face(edge, look_at);
    });
  });
}

void AttachedVoxels::find_staying() {
  const std::size_t count = structure_.extra_count();
  const Cell first = structure_.first_extra();
  voxels_of_.resize(count);
  std::vector<Cell> line;
  for_each_attached([&](const Place& voxel) {
    find_closure(voxel, line);
    for (const Cell cell : line) {
      if (structure_.is_extra(cell)) voxels_of_[cell - first].push_back(plain_.index(voxel));
    }
  });
  stays_.assign(count, 0);
  line.clear();
  for (std::size_t k = 0; k < count; ++k) {
    if (voxels_of_[k].empty() && model_.contains(first + static_cast<Cell>(k))) {
      stays_[k] = 1;
      line.push_back(first + static_cast<Cell>(k));
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    if (structure_.extra()->cell(first + static_cast<Cell>(k)).dimension == 3) {
      find_without_voxel(first + static_cast<Cell>(k), line);
    }
  }
  while (!line.empty()) {
    const Cell cell = line.back();
    line.pop_back();
    structure_.for_each_face(cell, [&](Cell face) {
      if (!model_.contains(face)) return;
      bool is_new = false;
      if (structure_.is_extra(face)) {
        is_new = stays_[face - first] == 0;
        stays_[face - first] = 1;
      } else {
        is_new = plain_staying_.insert(face).second;
      }
      if (is_new) line.push_back(face);
    });
  }
  for (const Cell cell : plain_staying_) attach_around(cell);
  for_each_attached([&](const Place& voxel) { list_.push_back({plain_.index(voxel), {}}); });
}

bool AttachedVoxels::stays(Cell cell) const {
  if (structure_.is_extra(cell)) return stays_[cell - structure_.first_extra()] != 0;
  return plain_staying_.contains(cell);
}

void AttachedVoxels::find_borders(const Importance& importance) {
  const CellLattice& lattice = structure_.lattice();
  const auto place_in = [&](const Place& voxel, Cell cell) {
    const Place node = lattice.place(node_of(cell));
    unsigned place = 0;
    for (std::size_t a = 3; a-- > 0;) {
      const bool is_spanned = (axes_of(cell) >> a & 1U) != 0;
      place = 3 * place + (is_spanned ? 1 : static_cast<unsigned>(2 * (node[a] - voxel[a])));
    }
    return place;
  };
  std::vector<Cell> line;
  for (Attached& own : list_) {
    const Place voxel = plain_.place(own.voxel);
    find_closure(voxel, line);
    for (std::size_t n = 1; n < line.size(); ++n) {
      const Cell cell = line[n];
      const bool is_extra = structure_.is_extra(cell);
      const unsigned place = place_in(voxel, is_extra ? structure_.extra()->cell(cell).place.value_or(0) : cell);
      BorderCell& border = own.border[place];
      border = {cell, is_extra ? 0 : sharers_of_place[place], stays(cell), importance.of(cell) > 0};
      if (!is_extra) continue;
      for (const std::uint32_t other : voxels_of_[cell - structure_.first_extra()]) {
        if (other == own.voxel) continue;
        const Place there = plain_.place(other);
        const std::int64_t neighbour =
            there[0] - voxel[0] + 1 + 3 * (there[1] - voxel[1] + 1) + 9 * (there[2] - voxel[2] + 1);
        border.sharers |= 1U << static_cast<unsigned>(neighbour);
      }
    }
  }
}

const AttachedVoxels::Attached& AttachedVoxels::at(std::uint32_t voxel) const {
  return *std::lower_bound(list_.begin(), list_.end(), voxel,
                           [](const Attached& a, std::uint32_t value) { return a.voxel < value; });
}

bool AttachedVoxels::may_go(std::uint32_t voxel, Neighbourhood around) const {
  const Attached& own = at(voxel);
  std::uint32_t shared = 0;
  for (unsigned place = 0; place < 27; ++place) {
    if (place == middle) continue;
    const BorderCell& border = own.border[place];
    if (border.stays || (border.sharers & around) != 0) {
      shared |= 1U << place;
    } else if (border.is_important) {
      return false;
    }
  }
  return is_contractible(shared);
}

CellComplex AttachedVoxels::rest(const VoxelSet& kept, const Context& context) const {
  CellComplex out(kept, structure_, context);
  for (const Attached& own : list_) {
    const Place at = plain_.place(own.voxel);
    if (!kept.contains(at[0], at[1], at[2])) continue;
    for (unsigned place = 0; place < 27; ++place) {
      if (place != middle && structure_.is_extra(own.border[place].cell)) out.insert_closure(own.border[place].cell);
    }
  }
  for (const Cell cell : plain_staying_) out.insert_closure(cell);
  for (std::size_t k = 0; k < stays_.size(); ++k) {
    if (stays_[k] != 0) out.insert_closure(structure_.first_extra() + static_cast<Cell>(k));
  }
  return out;
}

}  // namespace blum::detail
