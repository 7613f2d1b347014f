#include "blum/field/smooth_surface.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/grid/image_values.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum {
namespace {

/// Configuration of the eight voxels around a corner of the lattice (the corners of all voxels). Voxel o is at (o & 1,
/// o >> 1 & 1, o >> 2 & 1): 0 is the low side of the corner along an axis, 1 the high side. The surface has one patch
/// at the corner for each 6-connected set of unselected voxels.
struct CornerCase {
  static constexpr std::uint8_t none = 255;

  std::uint8_t patches = 0;
  std::array<std::uint8_t, 8> patch_of{};  ///< Per voxel: index of its patch; none if the voxel is selected.
  /// Per patch: sum of its voxels' directions from the corner, (+-1, +-1, +-1) each.
  std::array<std::array<std::int8_t, 3>, 8> way{};
  /// Double edges: bit e stands for the edge from the corner in the positive direction of axis e. It is set if exactly
  /// two voxels around the edge are selected, and they are diagonally opposite. The surface passes such an edge twice.
  std::uint8_t double_edges = 0;
  /// True if exactly two voxels are selected, and they are opposite across the corner. The patch is then a ring around
  /// the corner.
  bool is_ring = false;
};

namespace detail {

constexpr bool is_in(unsigned set, unsigned voxel) {
  return (set >> voxel & 1U) != 0;
}

/// Returns the voxels of a set that are 6-connected to the voxel `first`.
constexpr unsigned flood(unsigned set, unsigned first) {
  unsigned found = 1U << first;
  for (unsigned step = 0; step < 8; ++step) {
    for (unsigned voxel = 0; voxel < 8; ++voxel) {
      for (unsigned axis = 0; axis < 3; ++axis) {
        if (is_in(found, voxel) && is_in(set, voxel ^ 1U << axis)) found |= 1U << (voxel ^ 1U << axis);
      }
    }
  }
  return found;
}

constexpr void add_patch(CornerCase& corner, unsigned voxels) {
  for (unsigned voxel = 0; voxel < 8; ++voxel) {
    if (!is_in(voxels, voxel)) continue;
    corner.patch_of[voxel] = corner.patches;
    for (unsigned axis = 0; axis < 3; ++axis) {
      std::int8_t& sum = corner.way[corner.patches][axis];
      sum = static_cast<std::int8_t>(sum + ((voxel >> axis & 1U) != 0 ? 1 : -1));
    }
  }
  ++corner.patches;
}

/// Returns true if the surface passes an edge twice. `edge` is the axis of the edge.
constexpr bool is_double(unsigned selected, unsigned edge) {
  const unsigned low = 1U << edge;  // all four voxels around the edge have this bit
  const unsigned a = 1U << (edge + 1) % 3;
  const unsigned b = 1U << (edge + 2) % 3;
  const bool first = is_in(selected, low);
  const bool second = is_in(selected, low | a);
  return is_in(selected, low | a | b) == first && is_in(selected, low | b) == second && first != second;
}

constexpr CornerCase make_corner_case(unsigned selected) {
  CornerCase corner;
  corner.patch_of.fill(CornerCase::none);
  for (unsigned voxel = 0; voxel < 8; ++voxel) {
    if (is_in(selected, voxel) || corner.patch_of[voxel] != CornerCase::none) continue;
    add_patch(corner, flood(~selected & 0xffU, voxel));
  }
  for (unsigned edge = 0; edge < 3; ++edge) {
    if (is_double(selected, edge)) corner.double_edges = static_cast<std::uint8_t>(corner.double_edges | 1U << edge);
  }
  const auto first = static_cast<unsigned>(std::countr_zero(selected | 0x100U));
  corner.is_ring = first < 4 && selected == (1U << first | 1U << (7 - first));
  return corner;
}

constexpr std::array<CornerCase, 256> make_corner_cases() {
  std::array<CornerCase, 256> cases{};
  for (unsigned selected = 0; selected < 256; ++selected) cases[selected] = make_corner_case(selected);
  return cases;
}

}  // namespace detail

/// Configurations, indexed by the set of selected voxels: bit o is voxel o.
inline constexpr std::array<CornerCase, 256> corner_cases = detail::make_corner_cases();

/// Box in which a vertex may move, in voxels. If a vertex is fixed along an axis, its box has no extent along that
/// axis.
struct NetBox {
  Vec3d low, high;
};

/// Surface between a set of voxels and the other voxels: a closed, oriented manifold of quadrilaterals and triangles.
/// All polygons face the unselected voxels. Coordinates are in voxels; the centres of voxels are integers. Start
/// positions lie on the faces of voxels. Where voxels touch only in an edge or a corner, the surface connects them, and
/// start positions are moved apart a little.
struct SurfaceNet {
  static constexpr std::uint32_t none = 0xffffffff;

  std::vector<Vec3d> positions;
  std::vector<NetBox> boxes;                           ///< per vertex: box that contains its position
  std::vector<std::array<std::uint32_t, 4>> polygons;  ///< for a triangle, the last entry is `none`
};

constexpr std::size_t rows_per_range = 256;
/// Largest distance, along an axis, of a vertex from its lattice corner. So boxes of different corners are disjoint and
/// contain no voxel centre.
constexpr double reach = 0.49;
/// Smallest distance, along an axis, of the vertices of a double edge from the edge, and of a ring's arm from its
/// corner.
constexpr double least_room = 0.02;
/// Distance by which start positions are moved apart at an edge or corner where voxels touch. Any small number works.
constexpr double room = 0.1;
constexpr double ring_room = 0.2;
/// Largest distance that the vertex in the middle of a face may move within the face's plane.
constexpr double middle_reach = 0.25;

using Place = std::array<std::int64_t, 3>;

/// Lattice corner around which some voxels are selected and some are not.
struct NetCorner {
  std::uint32_t x = 0;
  std::uint8_t selected = 0;  ///< Bits of the selected voxels; see CornerCase.
  /// Bit c is set if a face has a vertex in its middle. The face is perpendicular to axis c, on the corner's positive
  /// side along the other axes.
  std::uint8_t middles = 0;
  std::uint32_t first_vertex = 0;
  std::uint32_t first_polygon = 0;

  [[nodiscard]] const CornerCase& shape() const { return corner_cases[selected]; }
  // Order of a corner's vertices: one per patch, or the six arms of a ring; then two per double edge; then middles of
  // faces.
  [[nodiscard]] std::uint32_t patch_vertices() const { return shape().is_ring ? 6U : shape().patches; }
  [[nodiscard]] std::uint32_t edge_vertex(unsigned edge, unsigned voxel) const {
    const unsigned before = shape().double_edges & ((1U << edge) - 1);
    return first_vertex + patch_vertices() + 2U * static_cast<std::uint32_t>(std::popcount(before)) +
           (voxel >> (edge + 1) % 3 & 1U);
  }
  [[nodiscard]] std::uint32_t edge_vertices() const {
    return 2U * static_cast<std::uint32_t>(std::popcount(shape().double_edges));
  }
  [[nodiscard]] std::uint32_t middle_vertex(unsigned axis) const {
    const unsigned before = middles & ((1U << axis) - 1);
    return first_vertex + patch_vertices() + edge_vertices() + static_cast<std::uint32_t>(std::popcount(before));
  }
  [[nodiscard]] std::uint32_t vertices() const {
    return patch_vertices() + edge_vertices() + static_cast<std::uint32_t>(std::popcount(middles));
  }
};

/// Vertices around a face, counter-clockwise as seen from the unselected voxel.
struct Outline {
  std::array<std::uint32_t, 12> vertices{};
  std::size_t size = 0;

  void add(std::uint32_t vertex) { vertices[size++] = vertex; }
};

constexpr unsigned with_bits(unsigned a, bool at_a, unsigned b, bool at_b, unsigned c, bool at_c) {
  return (at_a ? 1U << a : 0U) | (at_b ? 1U << b : 0U) | (at_c ? 1U << c : 0U);
}

/// Returns the index of a ring's arm that points along an axis, in the positive direction if `is_up`.
constexpr std::uint32_t arm(unsigned axis, bool is_up) {
  return 2U * axis + (is_up ? 1U : 0U);
}

class NetBuilder {
 public:
  NetBuilder(const VoxelSet& voxels, const Context& context) : voxels_(voxels), context_(context) {
    for (std::size_t axis = 0; axis < 3; ++axis) size_[axis] = static_cast<std::size_t>(voxels.size()[axis]) + 1;
    rows_ = size_[1] * size_[2];
  }

  SurfaceNet run() {
    find_corners();
    find_middles();
    number();
    SurfaceNet net;
    net.positions.resize(vertices_);
    net.boxes.resize(vertices_);
    net.polygons.resize(polygons_);
    for_each_corner("surface", [&](const NetCorner& corner, const Place& at) {
      write_vertices(corner, at, net);
      write_polygons(corner, at, net);
    });
    return net;
  }

 private:
  template <class Visit>
  void for_each_row(std::string_view phase, const Visit& visit) const {
    parallel_for(context_, rows_, rows_per_range, phase, [&](const WorkRange& range) {
      for (std::size_t row = range.begin; row < range.end; ++row) {
        if (context_.cancel.stop_requested()) return;
        visit(row, static_cast<std::int64_t>(row % size_[1]), static_cast<std::int64_t>(row / size_[1]));
      }
    });
  }
  template <class Visit>
  void for_each_corner(std::string_view phase, const Visit& visit) {
    for_each_row(phase, [&](std::size_t row, std::int64_t y, std::int64_t z) {
      for (std::size_t i = row_begin_[row]; i < row_begin_[row + 1]; ++i) {
        visit(corners_[i], {static_cast<std::int64_t>(corners_[i].x), y, z});
      }
    });
  }

  [[nodiscard]] std::span<const std::uint64_t> words(std::int64_t y, std::int64_t z) const {
    const auto& size = voxels_.size();
    if (y < 0 || z < 0 || y >= size[1] || z >= size[2]) return {};
    return voxels_.row(y, z);
  }

  /// Calls visit(x, selected) for the corners of a row around which some voxels are selected and some are not.
  template <class Visit>
  void for_each_mixed(std::int64_t y, std::int64_t z, const Visit& visit) const {
    const std::array<std::span<const std::uint64_t>, 4> rows{words(y - 1, z - 1), words(y, z - 1), words(y - 1, z),
                                                             words(y, z)};
    std::array<std::uint64_t, 4> last{};
    for (std::size_t w = 0; w < voxels_.words_per_row(); ++w) {
      std::array<std::uint64_t, 4> here{};
      std::array<std::uint64_t, 4> before{};  // bit x is voxel x - 1
      std::uint64_t any = 0;
      std::uint64_t all = ~std::uint64_t{0};
      for (std::size_t r = 0; r < 4; ++r) {
        here[r] = rows[r].empty() ? 0 : rows[r][w];
        before[r] = here[r] << 1U | last[r] >> 63U;
        any |= here[r] | before[r];
        all &= here[r] & before[r];
      }
      last = here;
      for (std::uint64_t mixed = any & ~all; mixed != 0; mixed &= mixed - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(mixed));
        unsigned selected = 0;
        for (unsigned r = 0; r < 4; ++r) {
          selected |= static_cast<unsigned>((before[r] >> bit & 1U) | (here[r] >> bit & 1U) << 1U) << 2U * r;
        }
        visit(64 * w + bit, static_cast<std::uint8_t>(selected));
      }
    }
  }

  void find_corners() {
    row_begin_.assign(rows_ + 1, 0);
    for_each_row("corners", [&](std::size_t row, std::int64_t y, std::int64_t z) {
      std::size_t count = 0;
      for_each_mixed(y, z, [&](std::size_t, std::uint8_t) { ++count; });
      row_begin_[row + 1] = count;
    });
    for (std::size_t row = 0; row < rows_; ++row) row_begin_[row + 1] += row_begin_[row];
    corners_.resize(row_begin_[rows_]);
    for_each_row("corners", [&](std::size_t row, std::int64_t y, std::int64_t z) {
      std::size_t next = row_begin_[row];
      for_each_mixed(y, z, [&](std::size_t x, std::uint8_t selected) {
        corners_[next++] = {.x = static_cast<std::uint32_t>(x), .selected = selected};
      });
    });
  }

  [[nodiscard]] const NetCorner& corner_at(const Place& at) const {
    const std::size_t row = static_cast<std::size_t>(at[2]) * size_[1] + static_cast<std::size_t>(at[1]);
    const auto begin = corners_.begin() + static_cast<std::ptrdiff_t>(row_begin_[row]);
    const auto end = corners_.begin() + static_cast<std::ptrdiff_t>(row_begin_[row + 1]);
    return *std::lower_bound(begin, end, at[0],
                             [](const NetCorner& corner, std::int64_t x) { return std::int64_t{corner.x} < x; });
  }

  /// Returns true if a face separates a selected voxel from an unselected one. The face is perpendicular to axis c. The
  /// face lies on the positive side of the corner along both other axes.
  static bool has_face(const NetCorner& corner, unsigned c) {
    const unsigned low = 7U ^ 1U << c;
    return (corner.selected >> low & 1U) != (corner.selected >> 7U & 1U);
  }

  /// Returns the vertices around a face. One of the face's two voxels is selected and one is not, so corners_ contains
  /// all four of its corners.
  [[nodiscard]] Outline outline(const NetCorner& corner, const Place& at, unsigned c) const {
    const unsigned a = (c + 1) % 3;
    const unsigned b = (c + 2) % 3;
    const bool faces_up = (corner.selected >> 7U & 1U) == 0;
    constexpr std::array<std::array<bool, 2>, 4> around{{{false, false}, {true, false}, {true, true}, {false, true}}};
    std::array<const NetCorner*, 4> corners{};
    std::array<unsigned, 4> outer{};  // index of the unselected voxel, relative to each corner
    for (std::size_t k = 0; k < 4; ++k) {
      Place place = at;
      place[a] += around[k][0] ? 1 : 0;
      place[b] += around[k][1] ? 1 : 0;
      corners[k] = &corner_at(place);
      outer[k] = with_bits(a, !around[k][0], b, !around[k][1], c, faces_up);
    }
    Outline line;
    for (std::size_t k = 0; k < 4; ++k) {
      const NetCorner& here = *corners[k];
      const bool is_even = k % 2 == 0;
      if (here.shape().is_ring) {
        const std::uint32_t arm_a = here.first_vertex + arm(a, !around[k][0]);
        const std::uint32_t arm_b = here.first_vertex + arm(b, !around[k][1]);
        line.add(is_even ? arm_b : arm_a);
        line.add(is_even ? arm_a : arm_b);
      } else {
        line.add(here.first_vertex + here.shape().patch_of[outer[k]]);
      }
      const unsigned edge = is_even ? a : b;
      // The lower end of the edge from corner k to the next corner.
      const std::size_t low = k == 2 ? 3 : k == 3 ? 0 : k;
      if ((corners[low]->shape().double_edges >> edge & 1U) != 0) line.add(corners[low]->edge_vertex(edge, outer[low]));
    }
    if (!faces_up) std::reverse(line.vertices.begin(), line.vertices.begin() + static_cast<std::ptrdiff_t>(line.size));
    return line;
  }

  void find_middles() {
    for_each_corner("corners", [&](NetCorner& corner, const Place& at) {
      std::uint32_t polygons = corner.shape().is_ring ? 6 : 0;
      for (unsigned c = 0; c < 3; ++c) {
        if (!has_face(corner, c)) continue;
        const auto size = static_cast<std::uint32_t>(outline(corner, at, c).size);
        if (size > 4) corner.middles = static_cast<std::uint8_t>(corner.middles | 1U << c);
        polygons += size > 4 ? size : 1;
      }
      corner.first_polygon = polygons;
    });
  }

  /// Converts the numbers of vertices and polygons per corner into start indices.
  void number() {
    for (NetCorner& corner : corners_) {
      const std::uint32_t polygons = corner.first_polygon;
      corner.first_vertex = static_cast<std::uint32_t>(vertices_);
      corner.first_polygon = static_cast<std::uint32_t>(polygons_);
      vertices_ += corner.vertices();
      polygons_ += polygons;
      if (vertices_ > max_id_count || 2 * polygons_ > max_id_count) {
        throw InvalidOption("the surface has more than " + std::to_string(max_id_count) +
                            " vertices or triangles, the limit for ids: cut the image into parts");
      }
    }
  }

  static void put(SurfaceNet& net, std::size_t vertex, const Vec3d& position, const NetBox& box) {
    net.positions[vertex] = position;
    net.boxes[vertex] = box;
  }

  static void write_vertices(const NetCorner& corner, const Place& at, SurfaceNet& net) {
    const Vec3d p{static_cast<double>(at[0]) - 0.5, static_cast<double>(at[1]) - 0.5, static_cast<double>(at[2]) - 0.5};
    const Vec3d all{reach, reach, reach};
    std::size_t next = corner.first_vertex;
    const CornerCase& shape = corner.shape();
    if (shape.is_ring) {
      for (unsigned axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1.0, 1.0}) put_arm(net, next++, p, axis, sign);
      }
    } else {
      for (std::size_t patch = 0; patch < shape.patches; ++patch) {
        put(net, next++, shape.patches > 1 ? p + way_of(shape, patch) : p, {p - all, p + all});
      }
    }
    for (unsigned edge = 0; edge < 3; ++edge) {
      if ((shape.double_edges >> edge & 1U) != 0) put_edge(net, corner, p, edge);
    }
    for (unsigned c = 0; c < 3; ++c) {
      if ((corner.middles >> c & 1U) == 0) continue;
      Vec3d middle = p + Vec3d{0.5, 0.5, 0.5};
      middle[c] = p[c];
      Vec3d half{middle_reach, middle_reach, middle_reach};
      half[c] = reach;
      put(net, corner.middle_vertex(c), middle, {middle - half, middle + half});
    }
  }

  /// Returns a small offset that leads from the corner into the voxels of a patch.
  static Vec3d way_of(const CornerCase& shape, std::size_t patch) {
    Vec3d way{};
    double most = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      way[axis] = shape.way[patch][axis];
      most = std::max(most, std::abs(way[axis]));
    }
    return room / most * way;
  }

  static void put_arm(SurfaceNet& net, std::size_t vertex, const Vec3d& p, unsigned axis, double sign) {
    Vec3d tip = p;
    tip[axis] += sign * ring_room;
    NetBox box{p - Vec3d{reach, reach, reach}, p + Vec3d{reach, reach, reach}};
    (sign > 0 ? box.low : box.high)[axis] = p[axis] + sign * least_room;
    put(net, vertex, tip, box);
  }

  /// Positions the two vertices at the middle of a double edge. The vertices lie in the plane perpendicular to the
  /// edge, on opposite sides of the edge.
  static void put_edge(SurfaceNet& net, const NetCorner& corner, const Vec3d& p, unsigned edge) {
    const unsigned a = (edge + 1) % 3;
    const unsigned b = (edge + 2) % 3;
    for (unsigned voxel = 0; voxel < 8; ++voxel) {
      if ((voxel >> edge & 1U) == 0 || (corner.selected >> voxel & 1U) != 0) continue;
      Vec3d middle = p;
      middle[edge] += 0.5;
      NetBox box{middle, middle};
      for (const unsigned axis : {a, b}) {
        const double sign = (voxel >> axis & 1U) != 0 ? 1 : -1;
        const double near = p[axis] + sign * least_room;
        const double far = p[axis] + sign * reach;
        middle[axis] += sign * room;
        box.low[axis] = std::min(near, far);
        box.high[axis] = std::max(near, far);
      }
      put(net, corner.edge_vertex(edge, voxel), middle, box);
    }
  }

  void write_polygons(const NetCorner& corner, const Place& at, SurfaceNet& net) const {
    std::size_t next = corner.first_polygon;
    if (corner.shape().is_ring) {
      for (unsigned voxel = 0; voxel < 8; ++voxel) {
        if ((corner.selected >> voxel & 1U) != 0) continue;
        const std::uint32_t x = corner.first_vertex + arm(0, (voxel & 1U) != 0);
        const std::uint32_t y = corner.first_vertex + arm(1, (voxel & 2U) != 0);
        const std::uint32_t z = corner.first_vertex + arm(2, (voxel & 4U) != 0);
        const bool is_turned = std::popcount(voxel) % 2 == 0;
        net.polygons[next++] = {x, is_turned ? z : y, is_turned ? y : z, SurfaceNet::none};
      }
    }
    for (unsigned c = 0; c < 3; ++c) {
      if (!has_face(corner, c)) continue;
      const Outline line = outline(corner, at, c);
      const auto& v = line.vertices;
      if (line.size == 4) {
        net.polygons[next++] = {v[0], v[1], v[2], v[3]};
        continue;
      }
      const std::uint32_t middle = corner.middle_vertex(c);
      for (std::size_t k = 0; k < line.size; ++k) {
        net.polygons[next++] = {middle, v[k], v[(k + 1) % line.size], SurfaceNet::none};
      }
    }
  }

  const VoxelSet& voxels_;
  const Context& context_;
  std::array<std::size_t, 3> size_{};  ///< number of corners along each axis
  std::size_t rows_ = 0;
  std::vector<NetCorner> corners_;
  std::vector<std::size_t> row_begin_;
  std::size_t vertices_ = 0;
  std::size_t polygons_ = 0;
};

/// Builds the surface of a set of voxels.
/// @throws InvalidOption if it has more than max_id_count vertices or triangles; Cancelled.
SurfaceNet make_surface_net(const VoxelSet& voxels, const Context& context) {
  return NetBuilder(voxels, context).run();
}

constexpr int most_iterations = 1000;
constexpr std::size_t vertices_per_range = 4096;
/// Factors of the two steps of Taubin smoothing, inwards and outwards. With these factors, a tube of radius 1.5 voxels
/// keeps its radius over 60 rounds, and ripples of 5 voxels vanish.
constexpr double step_in = 0.5;
constexpr double step_out = -0.51;
/// Number of steps from a vertex's start position to its smoothed position. Vertices of crossing triangles are moved
/// back step by step.
constexpr std::uint8_t hold_steps = 4;

/// Neighbours of each vertex of a net.
struct Neighbours {
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> vertices;

  /// Each side is traversed once in each direction, by two polygons. So every neighbour of a vertex is listed once.
  explicit Neighbours(const SurfaceNet& net) : begin(net.positions.size() + 1, 0) {
    for_each_side(net, [this](std::uint32_t from, std::uint32_t) { ++begin[from + 1]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    vertices.resize(begin.back());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for_each_side(net, [&](std::uint32_t from, std::uint32_t to) { vertices[next[from]++] = to; });
  }

 private:
  template <class Visit>
  static void for_each_side(const SurfaceNet& net, const Visit& visit) {
    for (const auto& polygon : net.polygons) {
      const std::size_t size = polygon[3] == SurfaceNet::none ? 3 : 4;
      for (std::size_t k = 0; k < size; ++k) visit(polygon[k], polygon[(k + 1) % size]);
    }
  }
};

Vec3d moved(const std::vector<Vec3d>& positions, const Neighbours& neighbours, std::size_t vertex, double step) {
  Vec3d sum{};
  const std::uint32_t begin = neighbours.begin[vertex];
  const std::uint32_t end = neighbours.begin[vertex + 1];
  for (std::uint32_t n = begin; n < end; ++n) sum += positions[neighbours.vertices[n]];
  return positions[vertex] + step * (1.0 / (end - begin) * sum - positions[vertex]);
}

/// Returns the positions of the vertices after smoothing. Each vertex stays in its box.
std::vector<Vec3d> relaxed(const SurfaceNet& net, int iterations, const Context& context) {
  std::vector<Vec3d> positions = net.positions;
  if (iterations == 0) return positions;
  const Neighbours neighbours(net);
  std::vector<Vec3d> other(positions.size());
  for (int i = 0; i < iterations; ++i) {
    for (const double step : {step_in, step_out}) {
      parallel_for(context, positions.size(), vertices_per_range, "", [&](const WorkRange& range) {
        for (std::size_t v = range.begin; v < range.end; ++v) {
          const Vec3d place = moved(positions, neighbours, v, step);
          other[v] = max(net.boxes[v].low, min(net.boxes[v].high, place));
        }
      });
      std::swap(positions, other);
    }
    if (context.progress) context.progress((i + 1.0) / iterations, "smoothing");
  }
  return positions;
}

bool is_mirrored(const Mat3& direction) {
  return dot(cross(direction.columns[0], direction.columns[1]), direction.columns[2]) < 0;
}

/// Surface whose vertices lie between their start positions and their smoothed positions.
class Embedding {
 public:
  Embedding(const SurfaceNet& net, const std::vector<Vec3d>& smooth, const GridSpec& grid)
      : net_(net), smooth_(smooth), grid_(grid), steps_(smooth.size(), hold_steps) {
    mesh_.vertices.resize(smooth.size());
    for (std::size_t v = 0; v < smooth.size(); ++v) place(v);
    add_triangles();
  }

  /// Moves vertices back towards their start until the surface does not cross itself. The loop ends, because the
  /// surface of the start positions does not cross itself.
  void resolve(const Context& context) {
    constexpr std::size_t limit = 1000000;
    for (SelfIntersections found = find_self_intersections(mesh_, limit, context); !found.pairs.empty();
         found = find_self_intersections(mesh_, limit, context)) {
      std::vector<std::uint32_t> back;
      for (const TrianglePair& pair : found.pairs) {
        for (const TriangleId t : {pair.first, pair.second}) {
          for (const std::uint32_t v : mesh_.triangles[t.value]) back.push_back(v);
        }
      }
      std::sort(back.begin(), back.end());
      back.erase(std::unique(back.begin(), back.end()), back.end());
      std::erase_if(back, [this](std::uint32_t v) { return steps_[v] == 0; });
      if (back.empty()) {
        throw InvalidGrid(
            "the spacing is so small relative to the origin that rounded coordinates make the surface cross itself: "
            "move the image closer to the origin");
      }
      for (const std::uint32_t v : back) {
        --steps_[v];
        place(v);
      }
    }
  }

  SmoothSurface result() && {
    SmoothSurface out;
    for (std::size_t v = 0; v < steps_.size(); ++v) {
      if (steps_[v] < hold_steps) ++out.held_vertices;
      const Vec3d move = place_of(v) - net_.positions[v];
      for (std::size_t axis = 0; axis < 3; ++axis) out.largest_move = std::max(out.largest_move, std::abs(move[axis]));
    }
    out.mesh = std::move(mesh_);
    return out;
  }

 private:
  [[nodiscard]] Vec3d place_of(std::size_t v) const {
    if (steps_[v] == hold_steps) return smooth_[v];
    const Vec3d& start = net_.positions[v];
    return start + static_cast<double>(steps_[v]) / hold_steps * (smooth_[v] - start);
  }

  void place(std::size_t v) {
    const Vec3d at = place_of(v);
    const Vec3d& s = grid_.spacing;
    mesh_.vertices[v] = grid_.origin + grid_.direction * Vec3d{at.x * s.x, at.y * s.y, at.z * s.z};
  }

  /// Splits quadrilaterals along the shorter diagonal.
  void add_triangles() {
    const bool turns = is_mirrored(grid_.direction);
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh_.triangles.push_back({a, turns ? c : b, turns ? b : c});
    };
    for (const auto& [a, b, c, d] : net_.polygons) {
      if (d == SurfaceNet::none) {
        add(a, b, c);
        continue;
      }
      const auto& at = mesh_.vertices;
      if (squared_length(at[b] - at[d]) < squared_length(at[a] - at[c])) {
        add(a, b, d);
        add(b, c, d);
      } else {
        add(a, b, c);
        add(a, c, d);
      }
    }
  }

  const SurfaceNet& net_;
  const std::vector<Vec3d>& smooth_;
  const GridSpec& grid_;
  std::vector<std::uint8_t> steps_;  ///< per vertex: number of steps towards its smoothed position, of hold_steps
  TriangleMesh mesh_;
};

}  // namespace

SmoothSurface smooth_surface(const VoxelImageView& image, const LabelSelection& selection,
                             const SmoothSurfaceOptions& options, const Context& context) {
  if (options.iterations < 0 || options.iterations > most_iterations) {
    throw InvalidOption("iterations is " + std::to_string(options.iterations) + ", but must be 0 to " +
                        std::to_string(most_iterations));
  }
  validate(image);
  const VoxelSet voxels = selected_voxels(image, selection, context);
  const SurfaceNet net = make_surface_net(voxels, context);
  if (net.polygons.empty()) throw InvalidImage(nothing_selected_text(image, selection));
  const std::vector<Vec3d> smooth = relaxed(net, options.iterations, context);
  Embedding embedding(net, smooth, image.grid);
  embedding.resolve(context);
  return std::move(embedding).result();
}

}  // namespace blum
