#include "blum/field/zero_surface.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/plural.hpp"

namespace blum {
namespace {

/// Edge of the subdivision of a cube into six tetrahedra around its diagonal. Corner c of a cube is at (c & 1, c >> 1 &
/// 1, c >> 2 & 1). An edge leads from corner `from` to corner `from | step`; `from` and `step` share no bits.
struct CubeEdge {
  std::uint8_t from = 0;
  std::uint8_t step = 0;  ///< 1 to 7
};

/// Triangles that separate the corners inside from those outside. The triangles face the corners outside.
struct CubeCase {
  std::uint8_t triangle_count = 0;
  std::array<std::array<CubeEdge, 3>, 12> triangles{};  ///< at most two per tetrahedron
};

namespace detail {

struct Corner3 {
  int x, y, z;
};

/// Returns twice the midpoint of an edge between two corners.
constexpr Corner3 doubled_middle(unsigned a, unsigned b) {
  return {static_cast<int>((a & 1U) + (b & 1U)), static_cast<int>((a >> 1 & 1U) + (b >> 1 & 1U)),
          static_cast<int>((a >> 2 & 1U) + (b >> 2 & 1U))};
}

constexpr Corner3 minus(const Corner3& a, const Corner3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// Returns six times the signed volume of the tetrahedron of p, q, r and the origin.
constexpr int volume(const Corner3& p, const Corner3& q, const Corner3& r) {
  return p.x * (q.y * r.z - q.z * r.y) + p.y * (q.z * r.x - q.x * r.z) + p.z * (q.x * r.y - q.y * r.x);
}

/// Pair of corners: one inside, one outside.
using Pair = std::array<unsigned, 2>;

/// Returns the edge between two corners of a tetrahedron. All bits of the smaller corner are also set in the larger
/// corner.
constexpr CubeEdge edge_of(const Pair& pair) {
  const unsigned from = pair[0] & pair[1];
  return {static_cast<std::uint8_t>(from), static_cast<std::uint8_t>((pair[0] | pair[1]) ^ from)};
}

/// Adds the triangle through the midpoints of three edges. The triangle faces the outside corner of the first edge.
constexpr void add_triangle(CubeCase& cube, const Pair& a, const Pair& b, const Pair& c) {
  const Corner3 p = doubled_middle(a[0], a[1]);
  const Corner3 q = doubled_middle(b[0], b[1]);
  const Corner3 r = doubled_middle(c[0], c[1]);
  const Corner3 outer = doubled_middle(a[1], a[1]);
  const bool faces_outer = volume(minus(q, p), minus(r, p), minus(outer, p)) > 0;
  cube.triangles[cube.triangle_count++] = {edge_of(a), edge_of(faces_outer ? b : c), edge_of(faces_outer ? c : b)};
}

constexpr void add_tetrahedron(CubeCase& cube, unsigned inside_corners, const std::array<unsigned, 4>& corners) {
  std::array<unsigned, 4> in{};
  std::array<unsigned, 4> out{};
  std::size_t ins = 0;
  std::size_t outs = 0;
  for (const unsigned corner : corners) ((inside_corners >> corner & 1U) != 0 ? in[ins++] : out[outs++]) = corner;
  if (ins == 1) add_triangle(cube, {in[0], out[0]}, {in[0], out[1]}, {in[0], out[2]});
  if (ins == 3) add_triangle(cube, {in[0], out[0]}, {in[1], out[0]}, {in[2], out[0]});
  if (ins == 2) {
    add_triangle(cube, {in[0], out[0]}, {in[0], out[1]}, {in[1], out[1]});
    add_triangle(cube, {in[0], out[0]}, {in[1], out[1]}, {in[1], out[0]});
  }
}

/// Divides the cube into six tetrahedra. The corners of each tetrahedron are on a path from corner 0 to corner 7 along
/// the three axes, in one of their six orders.
constexpr CubeCase make_cube_case(unsigned inside_corners) {
  CubeCase cube;
  for (unsigned first = 0; first < 3; ++first) {
    for (unsigned second = 0; second < 3; ++second) {
      if (second == first) continue;
      add_tetrahedron(cube, inside_corners, {0, 1U << first, 1U << first | 1U << second, 7});
    }
  }
  return cube;
}

constexpr std::array<CubeCase, 256> make_cube_cases() {
  std::array<CubeCase, 256> cases{};
  for (unsigned inside_corners = 0; inside_corners < 256; ++inside_corners) {
    cases[inside_corners] = make_cube_case(inside_corners);
  }
  return cases;
}

}  // namespace detail

/// Configurations, indexed by the set of corners inside: bit c is corner c.
inline constexpr std::array<CubeCase, 256> cube_cases = detail::make_cube_cases();

/// Ranges of slices are made at least this large, because each range computes a slice that it shares with the next
/// range.
constexpr std::size_t nodes_per_range = std::size_t{1} << 20;
constexpr std::size_t least_slices_per_range = 4;
/// Smallest distance of a vertex from the ends of its edge, as a fraction of the edge. This distance gives an area to
/// triangles next to a node that is exactly at the level.
constexpr double least_part = 1e-3;

void check(const Field& field, double level) {
  validate(field.grid);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (field.grid.size[axis] < 2) {
      throw InvalidGrid("the grid has a single layer along axis " + std::to_string(axis) +
                        ": a surface needs at least two nodes along each axis");
    }
  }
  if (field.distance.size() != field.grid.node_count()) {
    throw InvalidOption("the field has " + std::to_string(field.distance.size()) + " distances, but its grid has " +
                        std::to_string(field.grid.node_count()) + " nodes");
  }
  if (!std::isfinite(level)) throw InvalidOption("the level is " + exact_text(level) + ", but must be finite");
}

/// For each node of a slice, the corners inside of the cube that starts at the node. Bit c stands for the node at the
/// offset of corner c (see CubeEdge). Beyond the grid's border, the border nodes repeat.
class Slice {
 public:
  Slice(const Field& field, double level)
      : field_(field),
        level_(level),
        size_x_(static_cast<std::size_t>(field.grid.size[0])),
        size_y_(static_cast<std::size_t>(field.grid.size[1])),
        size_z_(static_cast<std::size_t>(field.grid.size[2])),
        corners_(size_x_ * size_y_),
        row_(size_x_ + 1) {}

  /// Reads slice z. After a stop request it returns early, with an arbitrary result.
  void read(std::size_t z, const Context& context) {
    for (std::size_t y = size_y_; y-- > 0;) {
      if (context.cancel.stop_requested()) return;
      read_row(y, z);
    }
  }

  [[nodiscard]] unsigned corners(std::size_t node) const { return corners_[node]; }

  /// Calls visit(x, y, index in the slice), in the order of the nodes, for nodes whose cube has corners inside and
  /// corners outside.
  template <class Visit>
  void for_each_mixed(const Visit& visit) const {
    for (std::size_t y = 0, node = 0; y < size_y_; ++y) {
      for (std::size_t x = 0; x < size_x_; ++x, ++node) {
        if (corners_[node] != 0 && corners_[node] != 0xff) visit(x, y, node);
      }
    }
  }

 private:
  /// Bits 0, 1, 4 and 5 are from this row. The others are from the next row, which has already been read.
  void read_row(std::size_t y, std::size_t z) {
    const float* const here = field_.distance.data() + (z * size_y_ + y) * size_x_;
    const float* const above = z + 1 < size_z_ ? here + size_y_ * size_x_ : here;
    for (std::size_t x = 0; x < size_x_; ++x) {
      row_[x] = static_cast<std::uint8_t>((static_cast<double>(here[x]) < level_ ? 1U : 0U) |
                                          (static_cast<double>(above[x]) < level_ ? 16U : 0U));
    }
    row_[size_x_] = row_[size_x_ - 1];
    std::uint8_t* const corners = corners_.data() + y * size_x_;
    const bool has_next = y + 1 < size_y_;
    for (std::size_t x = 0; x < size_x_; ++x) corners[x] = static_cast<std::uint8_t>(row_[x] | row_[x + 1] << 1);
    const std::uint8_t* const next = has_next ? corners + size_x_ : corners;
    for (std::size_t x = 0; x < size_x_; ++x) {
      corners[x] = static_cast<std::uint8_t>(corners[x] | (next[x] & 0x33U) << 2);
    }
  }

  const Field& field_;
  double level_;
  std::size_t size_x_, size_y_, size_z_;
  std::vector<std::uint8_t> corners_;
  std::vector<std::uint8_t> row_;
};

/// Set of edges from a node that cross the level and stay in the grid, as bits 1 to 7 for their `step`.
class CrossedEdges {
 public:
  explicit CrossedEdges(const GridSpec& grid) : size_(grid.size) {}

  [[nodiscard]] unsigned operator()(unsigned corners, std::size_t x, std::size_t y, std::size_t z) const {
    unsigned crossed = ((corners & 1U) != 0 ? ~corners : corners) & 0xfeU;
    if (is_last(x, 0)) crossed &= without_x;
    if (is_last(y, 1)) crossed &= without_y;
    if (is_last(z, 2)) crossed &= without_z;
    return crossed;
  }
  /// Returns true if a cube starts at the node (the node is not at the grid's upper border).
  [[nodiscard]] bool has_cube(std::size_t x, std::size_t y, std::size_t z) const {
    return !is_last(x, 0) && !is_last(y, 1) && !is_last(z, 2);
  }

 private:
  static constexpr unsigned without_x = 0x55, without_y = 0x33, without_z = 0x0f;

  [[nodiscard]] bool is_last(std::size_t index, std::size_t axis) const {
    return index + 1 == static_cast<std::size_t>(size_[axis]);
  }

  std::array<std::int64_t, 3> size_;
};

/// Part of the mesh that belongs to a slice: vertices on edges that start at its nodes, and triangles in the cubes
/// above it.
struct SliceCounts {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  bool is_finite = true;
};

class Marching {
 public:
  Marching(const Field& field, double level, const Context& context)
      : field_(field),
        level_(level),
        context_(context),
        crossed_(field.grid),
        slices_(static_cast<std::size_t>(field.grid.size[2])),
        nodes_per_slice_(field.grid.node_count() / slices_) {
    const Mat3& direction = field.grid.direction;
    is_mirrored_ = dot(cross(direction.columns[0], direction.columns[1]), direction.columns[2]) < 0;
    grain_ = std::max(nodes_per_range / nodes_per_slice_, least_slices_per_range);
  }

  TriangleMesh run() {
    count();
    add_up();
    TriangleMesh mesh;
    mesh.vertices.resize(counts_.back().vertices);
    mesh.triangles.resize(counts_.back().triangles);
    write(mesh);
    return mesh;
  }

 private:
  /// Slice, and for each node the index of the first vertex on its edges.
  struct NumberedSlice {
    Slice slice;
    std::vector<std::uint32_t> first_vertex;

    NumberedSlice(const Field& field, double level, std::size_t nodes) : slice(field, level), first_vertex(nodes) {}
  };

  [[nodiscard]] bool has_finite_distances(std::size_t z) const {
    const float* const begin = field_.distance.data() + z * nodes_per_slice_;
    // The loop examines all nodes, because a loop that stops at the first infinite one is not vectorised.
    std::uint32_t others = 0;
    for (std::size_t node = 0; node < nodes_per_slice_; ++node) {
      others |= std::abs(begin[node]) <= std::numeric_limits<float>::max() ? 0U : 1U;
    }
    return others == 0;
  }

  void count() {
    counts_.assign(slices_ + 1, {});
    parallel_for(context_, slices_, grain_, "counting", [this](const WorkRange& range) {
      Slice slice(field_, level_);
      for (std::size_t z = range.begin; z < range.end && !context_.cancel.stop_requested(); ++z) {
        slice.read(z, context_);
        SliceCounts counts;
        counts.is_finite = has_finite_distances(z);
        slice.for_each_mixed([&](std::size_t x, std::size_t y, std::size_t node) {
          const unsigned corners = slice.corners(node);
          counts.vertices += static_cast<std::size_t>(std::popcount(crossed_(corners, x, y, z)));
          if (crossed_.has_cube(x, y, z)) counts.triangles += cube_cases[corners].triangle_count;
        });
        counts_[z] = counts;
      }
    });
  }

  /// Converts the counts of slices into start indices.
  void add_up() {
    SliceCounts sum;
    for (std::size_t z = 0; z <= slices_; ++z) {
      if (!counts_[z].is_finite) refuse_slice(z);
      const SliceCounts counts = counts_[z];
      counts_[z] = sum;
      sum.vertices += counts.vertices;
      sum.triangles += counts.triangles;
    }
    if (sum.vertices > max_id_count || sum.triangles > max_id_count) {
      throw InvalidOption("the surface has " + std::to_string(sum.vertices) + " vertices and " +
                          std::to_string(sum.triangles) + " triangles; at most " + std::to_string(max_id_count) +
                          " of each can be numbered: use a coarser grid");
    }
  }

  [[noreturn]] void refuse_slice(std::size_t z) const {
    std::size_t node = z * nodes_per_slice_;
    while (std::isfinite(field_.distance[node])) ++node;
    const auto size_x = static_cast<std::size_t>(field_.grid.size[0]);
    throw InvalidOption("the distance at node (" + std::to_string(node % size_x) + ", " +
                        std::to_string(node % nodes_per_slice_ / size_x) + ", " + std::to_string(z) + ") is " +
                        exact_text(static_cast<double>(field_.distance[node])) +
                        ": a surface needs finite distances everywhere");
  }

  void write(TriangleMesh& mesh) const {
    parallel_for(context_, slices_, grain_, "surface", [this, &mesh](const WorkRange& range) {
      NumberedSlice first(field_, level_, nodes_per_slice_);
      NumberedSlice second(field_, level_, nodes_per_slice_);
      NumberedSlice* here = &first;
      NumberedSlice* above = &second;
      number(*here, range.begin);
      for (std::size_t z = range.begin; z < range.end; ++z) {
        if (z + 1 < slices_) number(*above, z + 1);
        if (context_.cancel.stop_requested()) return;
        write_vertices(*here, z, mesh);
        write_triangles(*here, *above, z, mesh);
        std::swap(here, above);
      }
    });
  }

  void number(NumberedSlice& numbered, std::size_t z) const {
    numbered.slice.read(z, context_);
    if (context_.cancel.stop_requested()) return;
    std::size_t next = counts_[z].vertices;
    numbered.slice.for_each_mixed([&](std::size_t x, std::size_t y, std::size_t node) {
      numbered.first_vertex[node] = static_cast<std::uint32_t>(next);
      next += static_cast<std::size_t>(std::popcount(crossed_(numbered.slice.corners(node), x, y, z)));
    });
  }

  void write_vertices(const NumberedSlice& here, std::size_t z, TriangleMesh& mesh) const {
    here.slice.for_each_mixed([&](std::size_t x, std::size_t y, std::size_t node) {
      std::size_t vertex = here.first_vertex[node];
      for (unsigned steps = crossed_(here.slice.corners(node), x, y, z); steps != 0; steps &= steps - 1) {
        mesh.vertices[vertex++] = vertex_on(x, y, z, static_cast<unsigned>(std::countr_zero(steps)));
      }
    });
  }

  [[nodiscard]] Vec3d vertex_on(std::size_t x, std::size_t y, std::size_t z, unsigned step) const {
    const auto at = [&](std::size_t i, std::size_t j, std::size_t k) {
      return static_cast<double>(field_.distance[field_.grid.index(
          static_cast<std::int64_t>(i), static_cast<std::int64_t>(j), static_cast<std::int64_t>(k))]);
    };
    const std::size_t dx = step & 1U;
    const std::size_t dy = step >> 1 & 1U;
    const std::size_t dz = step >> 2 & 1U;
    const double from = at(x, y, z);
    const double to = at(x + dx, y + dy, z + dz);
    const double part = std::clamp((level_ - from) / (to - from), least_part, 1 - least_part);
    const Vec3d& spacing = field_.grid.spacing;
    return field_.grid.origin +
           field_.grid.direction * Vec3d{(static_cast<double>(x) + static_cast<double>(dx) * part) * spacing.x,
                                         (static_cast<double>(y) + static_cast<double>(dy) * part) * spacing.y,
                                         (static_cast<double>(z) + static_cast<double>(dz) * part) * spacing.z};
  }

  void write_triangles(const NumberedSlice& here, const NumberedSlice& above, std::size_t z, TriangleMesh& mesh) const {
    const auto row = static_cast<std::size_t>(field_.grid.size[0]);
    std::size_t next = counts_[z].triangles;
    here.slice.for_each_mixed([&](std::size_t x, std::size_t y, std::size_t node) {
      if (!crossed_.has_cube(x, y, z)) return;
      const auto vertex = [&](const CubeEdge& edge) {
        const unsigned dx = edge.from & 1U;
        const unsigned dy = edge.from >> 1 & 1U;
        const unsigned dz = edge.from >> 2 & 1U;
        const NumberedSlice& slice = dz != 0 ? above : here;
        const std::size_t from = node + dx + dy * row;
        const unsigned crossed = crossed_(slice.slice.corners(from), x + dx, y + dy, z + dz);
        const auto before = static_cast<std::uint32_t>(std::popcount(crossed & ((1U << edge.step) - 1)));
        return slice.first_vertex[from] + before;
      };
      const CubeCase& cube = cube_cases[here.slice.corners(node)];
      for (std::size_t t = 0; t < cube.triangle_count; ++t) {
        const auto& [a, b, c] = cube.triangles[t];
        mesh.triangles[next++] = {vertex(a), vertex(is_mirrored_ ? c : b), vertex(is_mirrored_ ? b : c)};
      }
    });
  }

  const Field& field_;
  double level_;
  const Context& context_;
  CrossedEdges crossed_;
  std::size_t slices_;
  std::size_t nodes_per_slice_;
  std::size_t grain_ = 1;
  bool is_mirrored_ = false;
  /// Before add_up(): counts per slice. Afterwards: sums over all earlier slices; the last entry is the total.
  std::vector<SliceCounts> counts_;
};

/// Counts of the nodes inside a level surface.
struct InsideNodes {
  std::size_t count = 0;
  std::size_t thin = 0;       ///< with both neighbours along some axis outside
  std::size_t at_border = 0;  ///< in the outermost layer of the grid

  InsideNodes& operator+=(const InsideNodes& other) {
    count += other.count;
    thin += other.thin;
    at_border += other.at_border;
    return *this;
  }
};

InsideNodes inside_nodes_of_slice(const Field& field, double level, std::int64_t k) {
  const auto& size = field.grid.size;
  const std::array<std::int64_t, 3> stride{1, size[0], size[0] * size[1]};
  InsideNodes out;
  for (std::int64_t j = 0; j < size[1]; ++j) {
    for (std::int64_t i = 0; i < size[0]; ++i) {
      const auto node = static_cast<std::int64_t>(field.grid.index(i, j, k));
      const auto is_inside = [&](std::int64_t n) { return field.distance[static_cast<std::size_t>(n)] < level; };
      if (!is_inside(node)) continue;
      const std::array<std::int64_t, 3> at{i, j, k};
      bool is_thin = false;
      bool is_border = false;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool is_end = at[axis] == 0 || at[axis] + 1 == size[axis];
        is_border = is_border || is_end;
        is_thin = is_thin || (!is_end && !is_inside(node - stride[axis]) && !is_inside(node + stride[axis]));
      }
      out += {1, is_thin ? 1U : 0U, is_border ? 1U : 0U};
    }
  }
  return out;
}

}  // namespace

TriangleMesh zero_surface(const Field& field, double level, const Context& context) {
  check(field, level);
  return Marching(field, level, context).run();
}

std::vector<Warning> level_warnings(const Field& field, double level, const Context& context) {
  check(field, level);
  std::vector<InsideNodes> slices(static_cast<std::size_t>(field.grid.size[2]));
  parallel_for(context, slices.size(), 1, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      slices[k] = inside_nodes_of_slice(field, level, static_cast<std::int64_t>(k));
    }
  });
  InsideNodes all;
  for (const InsideNodes& slice : slices) all += slice;
  std::vector<Warning> out;
  if (all.at_border > 0) {
    out.push_back({WarningCode::left_out,
                   "the surface leaves the grid and is cut off there, because " +
                       plural(all.at_border, "node", "nodes") +
                       " of the grid's outermost layer are below the level; compute the field on a larger grid"});
  }
  if (2 * all.thin > all.count) {
    out.push_back({WarningCode::coarse_grid, "the shape is one node thick at " + count_text(all.thin) + " of " +
                                                 count_text(all.count) +
                                                 " nodes below the level; compute the field with a smaller spacing"});
  }
  return out;
}

}  // namespace blum
