#include "solid/model/box_splitter.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "blum/geometry/grid_predicates.hpp"
#include "solid/model/cut_grid.hpp"
#include "solid/model/section_loop.hpp"

namespace blum::detail {
namespace {

/// Cuts keep at least this fraction of the spacing from both ends of a box.
constexpr double least_part = 1e-12;

/// Returns the index of a box's edge along an axis: 4 * axis + two bits for its position along the other axes. `corner`
/// is the lower end of the edge.
constexpr std::size_t side_index(std::size_t axis, std::size_t corner) {
  return 4 * axis + (corner >> next_axis(axis) & 1U) + 2 * (corner >> next_axis(next_axis(axis)) & 1U);
}

/// Returns the indices of the four edges around a face: two along the next axis, low and high, then two along the axis
/// after it. `face` is 2 * axis, + 1 for the upper face.
std::array<std::size_t, 4> sides_of(std::size_t face) {
  const std::size_t u = next_axis(face / 2);
  const std::size_t v = next_axis(u);
  const std::size_t corner = (face & 1U) << (face / 2);
  return {side_index(u, corner), side_index(u, corner | 1U << v), side_index(v, corner),
          side_index(v, corner | 1U << u)};
}

bool is_inside(const SplitBox& box, std::size_t corner) {
  return (box.inside >> corner & 1U) != 0;
}

/// Returns true if two boxes have common interior points.
bool overlap(const BoxCell& box, const Box3& other) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(box.low[a] < other.upper[a] && other.lower[a] < box.high[a])) return false;
  }
  return true;
}

std::size_t longest(const Vec3d& size) {
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

}  // namespace

std::vector<SplitBox> BoxSplitter::split(SplitBox box, std::size_t most_boxes, const Context& context) {
  std::vector<SplitBox> out;
  std::vector<SplitBox> waiting;
  waiting.push_back(std::move(box));
  while (!waiting.empty() && !context.cancel.stop_requested()) {
    SplitBox next_box = std::move(waiting.back());
    waiting.pop_back();
    std::optional<Cut> cut = test(next_box);
    const bool passes = !cut;
    if (passes) cut = further_cut(next_box);
    const bool is_needle = cut && cut->along_hole > ModelFailure::most_cuts;
    if (cut && !is_needle && out.size() + waiting.size() < most_boxes && can_cut(next_box, *cut)) {
      auto [lower, upper] = halves(std::move(next_box), *cut);
      waiting.push_back(std::move(upper));
      waiting.push_back(std::move(lower));
    } else {
      if (cut && !passes) next_box.obstacle = is_needle ? ModelObstacle::slanted_needle : cut->obstacle;
      if (is_needle) next_box.cuts_left = cut->along_hole;
      out.push_back(std::move(next_box));
    }
  }
  return out;
}

std::optional<BoxSplitter::Cut> BoxSplitter::test(SplitBox& box) {
  find_crossings(box);
  find_passes(box);
  arcs_.clear();
  passing_.clear();
  first_part_[0] = 0;
  std::optional<Cut> cut;
  for (std::size_t face = 0; face < 6; ++face) {
    if (const auto hole = connect_face(box, face); hole && !cut) cut = cut_beside(box, face, *hole);
    first_part_[face + 1] = first_part_[face] + square_.count();
  }
  cube_.start(first_part_[6]);
  pieces_.find(mesh_, box.box, box.triangles, arcs_, passing_, cube_);
  box.triangles.assign(pieces_.triangles().begin(), pieces_.triangles().end());
  if (cut) return cut;
  connect_edges(box);
  const bool passes = cube_.finish([&](std::uint32_t piece) { return pieces_.euler(piece); });
  if (pieces_.holds_void()) return cut_through_middle(box, ModelObstacle::void_in_cube);
  if (!passes) return cut_through_middle(box, ModelObstacle::handle);
  return std::nullopt;
}

std::optional<BoxSplitter::Cut> BoxSplitter::further_cut(const SplitBox& box) const {
  constexpr double part = 0.3;  // a quarter of the size of `finer`, with a margin for rounding
  if (box.triangles.empty()) return std::nullopt;
  const Vec3d size = box.box.high - box.box.low;
  const std::size_t axis = longest(size);
  const bool is_wanted = std::any_of(finer_.begin(), finer_.end(), [&](const Box3& finer) {
    const Vec3d wanted = finer.size();
    return size[axis] > part * wanted[longest(wanted)] && overlap(box.box, finer);
  });
  if (!is_wanted) return std::nullopt;
  return Cut{axis, 0.5 * (box.box.low[axis] + box.box.high[axis]), ModelObstacle::handle};
}

void BoxSplitter::find_crossings(const SplitBox& box) {
  crossed_.assign(box.triangles.size(), 0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t corner = 0; corner < 8; ++corner) {
      if ((corner >> axis & 1U) != 0) continue;
      const std::size_t index = side_index(axis, corner);
      Side& side = sides_[index];
      side = {axis, corner, {}, 0};
      const Vec3d low = corner_of(box.box, corner);
      const Vec3d high = corner_of(box.box, corner | 1U << axis);
      for (std::size_t t = 0; t < box.triangles.size(); ++t) {
        if (!crosses(mesh_.corners(box.triangles[t]), axis, low, high)) continue;
        side.crossings.push_back(box.triangles[t]);
        crossed_[t] |= static_cast<std::uint16_t>(1U << index);
      }
      sort_along(mesh_, axis, low, side.crossings);
      side.intervals = intervals_of(static_cast<std::uint32_t>(side.crossings.size()), is_inside(box, corner));
    }
  }
}

void BoxSplitter::find_passes(const SplitBox& box) {
  edges_.clear();
  for (const std::uint32_t t : box.triangles) {
    for (const EdgeId edge : mesh_.edges_of(t)) edges_.push_back(edge.value);
  }
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  passes_.assign(edges_.size(), 0);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const EdgeEnds ends = mesh_.ends(edges_[e]);
    for (std::size_t face = 0; face < 6; ++face) {
      Vec3d low = box.box.low;
      Vec3d high = box.box.high;
      low[face / 2] = high[face / 2] = face % 2 == 0 ? box.box.low[face / 2] : box.box.high[face / 2];
      if (passes_through(ends, face / 2, low, high)) passes_[e] |= static_cast<std::uint8_t>(1U << face);
    }
  }
  passes_of_triangle_.clear();
  for (const std::uint32_t t : box.triangles) {
    auto& passes = passes_of_triangle_.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = std::lower_bound(edges_.begin(), edges_.end(), mesh_.edges_of(t)[k].value);
      passes[k] = passes_[static_cast<std::size_t>(at - edges_.begin())];
    }
  }
}

std::optional<BoxSplitter::Hole> BoxSplitter::connect_face(const SplitBox& box, std::size_t face) {
  const std::array<std::size_t, 4> around = sides_of(face);
  std::array<std::uint32_t, 5> first{};
  unsigned border = 0;
  for (std::size_t s = 0; s < 4; ++s) {
    first[s + 1] = first[s] + sides_[around[s]].intervals;
    border |= 1U << around[s];
  }
  square_.start(first[4]);
  const std::size_t axis = face / 2;
  const std::size_t corner = (face & 1U) << axis;
  const std::size_t along_u = corner | 1U << next_axis(axis);
  const std::size_t along_v = corner | 1U << next_axis(next_axis(axis));
  if (is_inside(box, corner)) square_.join(first[0], first[2]);
  if (is_inside(box, along_u)) square_.join(first[1] - 1, first[3]);
  if (is_inside(box, along_v)) square_.join(first[1], first[3] - 1);
  if (is_inside(box, along_u | along_v)) square_.join(first[2] - 1, first[4] - 1);
  triangles_.clear();
  ends_of_loops_.clear();
  for (std::size_t t = 0; t < box.triangles.size(); ++t) {
    const auto& passes = passes_of_triangle_[t];
    if (((passes[0] | passes[1] | passes[2]) >> face & 1U) == 0 && (crossed_[t] & border) == 0) continue;
    std::array<SquareComponents::End, 2> ends{};
    std::size_t count = 0;
    std::array<std::uint32_t, 2> edges_here{};
    for (std::size_t k = 0; k < 3; ++k) {
      if ((passes[k] >> face & 1U) == 0) continue;
      const EdgeId edge = mesh_.edges_of(box.triangles[t])[k];
      if (count < 2) {
        ends[count] = {false, edge.value};
        edges_here[count] = edge.value;
      }
      ++count;
      passing_.push_back(edge.value);
    }
    for (unsigned rest = crossed_[t] & border; rest != 0; rest &= rest - 1) {
      const auto index = static_cast<std::size_t>(std::countr_zero(rest));
      const Side& side = sides_[index];
      const auto s = static_cast<std::size_t>(std::find(around.begin(), around.end(), index) - around.begin());
      const auto at =
          std::find(side.crossings.begin(), side.crossings.end(), box.triangles[t]) - side.crossings.begin();
      if (count < 2) {
        ends[count] = {true, first[s] + interval_at(static_cast<std::uint32_t>(at), is_inside(box, side.corner))};
      }
      ++count;
    }
    if (count != 2) continue;
    square_.add_arc(ends[0], ends[1]);
    triangles_.push_back(box.triangles[t]);
    ends_of_loops_.push_back(edges_here);
  }
  const double plane = face % 2 == 0 ? box.box.low[axis] : box.box.high[axis];
  std::vector<std::uint32_t>& loop_edges = loop_edges_;
  loop_edges.clear();
  const bool passes = square_.finish([&](std::span<const std::uint32_t> loop) {
    loop_edges.clear();
    for (const std::uint32_t arc : loop) {
      loop_edges.insert(loop_edges.end(), ends_of_loops_[arc].begin(), ends_of_loops_[arc].end());
    }
    return is_around_hole(mesh_, loop_edges, axis, plane);
  });
  for (std::size_t a = 0; a < triangles_.size(); ++a) {
    arcs_.push_back({triangles_[a], first_part_[face] + square_.of_arc(a)});
  }
  interval_part_[face].clear();
  for (std::uint32_t k = 0; k < first[4]; ++k)
    interval_part_[face].push_back(first_part_[face] + square_.of_interval(k));
  if (passes) return std::nullopt;
  return hole_between(box, face, loop_edges);
}

BoxSplitter::Hole BoxSplitter::hole_between(const SplitBox& box, std::size_t face,
                                            std::span<const std::uint32_t> edges) const {
  const std::size_t axis = face / 2;
  const double plane = face % 2 == 0 ? box.box.low[axis] : box.box.high[axis];
  Vec3d slant{};  // sum over the edges: their shift across, per unit along the axis
  Box3 around;
  Vec3d sum{};
  for (const std::uint32_t edge : edges) {
    const auto [a, b] = mesh_.ends(edge);
    const double rise = b[axis] - a[axis];
    const Vec3d at = a + (b - a) * std::clamp((plane - a[axis]) / rise, 0.0, 1.0);
    sum += at;
    around.extend(at);
    slant += (b - a) / rise;
  }
  const auto count = static_cast<double>(edges.size());
  const double depth = box.box.high[axis] - box.box.low[axis];
  const std::size_t u = next_axis(axis);
  const std::size_t v = next_axis(u);
  const auto cuts = [&](std::size_t across) {
    return std::abs(slant[across]) / count * depth / (around.upper[across] - around.lower[across]);
  };
  return {sum / count, std::min(cuts(u), cuts(v))};
}

void BoxSplitter::connect_edges(const SplitBox& box) {
  for (std::size_t index = 0; index < 12; ++index) {
    const Side& side = sides_[index];
    const std::size_t u = next_axis(side.axis);
    const std::size_t v = next_axis(u);
    // The two faces at an edge of the box, and the index of the edge's first interval in each.
    std::array<std::size_t, 2> faces{2 * u + (side.corner >> u & 1U), 2 * v + (side.corner >> v & 1U)};
    std::array<std::uint32_t, 2> first{};
    for (std::size_t f = 0; f < 2; ++f) {
      for (const std::size_t before : sides_of(faces[f])) {
        if (before == index) break;
        first[f] += sides_[before].intervals;
      }
    }
    for (std::uint32_t k = 0; k < side.intervals; ++k) {
      const std::uint32_t part = interval_part_[faces[0]][first[0] + k];
      cube_.join_at_interval(part, interval_part_[faces[1]][first[1] + k]);
      if (side.axis != 0) continue;  // each corner is an end of exactly one edge along x
      if (k == 0 && is_inside(box, side.corner)) cube_.add_corner(part);
      if (k + 1 == side.intervals && is_inside(box, side.corner | 1U)) cube_.add_corner(part);
    }
  }
}

/// Returns a cut through the middle of a hole in a face, which opens the hole. The cut is across the face's longer
/// side, so that boxes stay compact.
BoxSplitter::Cut BoxSplitter::cut_beside(const SplitBox& box, std::size_t face, const Hole& hole) const {
  const Vec3d size = box.box.high - box.box.low;
  const std::size_t u = next_axis(face / 2);
  const std::size_t v = next_axis(u);
  const std::size_t axis = size[u] >= size[v] ? u : v;
  return {axis, hole.middle[axis], ModelObstacle::hole_in_square, hole.cuts};
}

BoxSplitter::Cut BoxSplitter::cut_through_middle(const SplitBox& box, ModelObstacle obstacle) const {
  Vec3d low = box.box.high;
  Vec3d high = box.box.low;
  for (const std::uint32_t t : box.triangles) {
    for (const std::uint32_t v : mesh_.triangles()[t]) {
      const Vec3d& p = mesh_.vertices()[v];
      if (!is_in_box(p, box.box)) continue;
      for (std::size_t a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], p[a]);
        high[a] = std::max(high[a], p[a]);
      }
    }
  }
  // If the vertices in the box are close together, the cut goes through their middle. Repeated halving of the box would
  // take longer. A cut never aims at a single vertex, because near a vertex the surface looks the same at all scales.
  const Vec3d size = box.box.high - box.box.low;
  const Vec3d inner = high - low;
  const std::size_t inner_axis = longest(inner);
  const double middle = 0.5 * (low[inner_axis] + high[inner_axis]);
  const bool is_small = inner[inner_axis] > 0 && inner[inner_axis] < 0.5 * size[inner_axis];
  const double room = 0.05 * size[inner_axis];
  if (is_small && middle > box.box.low[inner_axis] + room && middle < box.box.high[inner_axis] - room) {
    return {inner_axis, middle, obstacle};
  }
  const std::size_t axis = longest(size);
  return {axis, 0.5 * (box.box.low[axis] + box.box.high[axis]), obstacle};
}

bool BoxSplitter::can_cut(const SplitBox& box, const Cut& cut) const {
  const double least = least_part * spacing_;
  return box.splits < most_splits_ && cut.at > box.box.low[cut.axis] + least && cut.at < box.box.high[cut.axis] - least;
}

std::array<SplitBox, 2> BoxSplitter::halves(SplitBox&& box, const Cut& cut) const {
  std::array<SplitBox, 2> out;
  for (std::size_t upper = 0; upper < 2; ++upper) {
    out[upper].box = box.box;
    (upper == 1 ? out[upper].box.low : out[upper].box.high)[cut.axis] = cut.at;
    out[upper].splits = box.splits + 1;
    for (const std::uint32_t t : box.triangles) {
      if (may_meet(mesh_.corners(t), out[upper].box.low, out[upper].box.high)) out[upper].triangles.push_back(t);
    }
  }
  // New corners lie on the edges that are cut. Each crossing between the lower end and the new corner switches between
  // inside and outside.
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const auto bit = static_cast<std::uint8_t>(1U << corner);
    const std::size_t other = corner ^ 1U << cut.axis;
    const bool is_high = (corner >> cut.axis & 1U) != 0;
    SplitBox& keeps = out[is_high ? 1 : 0];
    if (is_inside(box, corner)) keeps.inside |= bit;
    if (is_high) continue;
    Vec3d low = corner_of(box.box, corner);
    Vec3d at = low;
    at[cut.axis] = cut.at;
    bool inside = is_inside(box, corner);
    for (const std::uint32_t t : sides_[side_index(cut.axis, corner)].crossings) {
      if (crosses(mesh_.corners(t), cut.axis, low, at)) inside = !inside;
    }
    if (inside) {
      out[0].inside |= static_cast<std::uint8_t>(1U << other);
      out[1].inside |= bit;
    }
  }
  return out;
}

}  // namespace blum::detail
