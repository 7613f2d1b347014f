#include "solid/model/refined_region.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "blum/core/union_find.hpp"
#include "blum/geometry/grid_predicates.hpp"
#include "solid/model/components.hpp"
#include "solid/model/section_loop.hpp"

namespace blum::detail {
namespace {

/// Boxes are not cut to less than this part of the spacing.
constexpr double least_part = 1e-12;

constexpr std::size_t next(std::size_t axis) {
  return (axis + 1) % 3;
}

std::size_t place_in(std::span<const std::uint32_t> sorted, std::uint32_t value) {
  return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin());
}

void sort_unique(std::vector<std::uint32_t>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// Whether the box around a triangle meets a box, both closed.
bool may_meet(const TriangleCorners& t, const BoxCell& box) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (std::min({t[0][a], t[1][a], t[2][a]}) > box.high[a]) return false;
    if (std::max({t[0][a], t[1][a], t[2][a]}) < box.low[a]) return false;
  }
  return true;
}

/// Whether a triangle crosses a part of a line along an axis.
bool crosses(const TriangleCorners& t, std::size_t axis, const Vec3d& low, const Vec3d& high) {
  const double u = low[next(axis)];
  const double v = low[next(next(axis))];
  const int first = side_of_line({t[0], t[1]}, axis, u, v);
  if (first == 0 || side_of_line({t[1], t[2]}, axis, u, v) != first) return false;
  if (side_of_line({t[2], t[0]}, axis, u, v) != first) return false;
  return side_of_node(t, low) == -first && side_of_node(t, high) == first;
}

}  // namespace

struct RefinedRegion::Scratch {
  SquareComponents square;
  CubeComponents cube;
  UnionFind pieces;
};

RefinedRegion::RefinedRegion(const SurfaceMesh& mesh, const CutGrid& grid, std::span<const Cell> cubes,
                             std::vector<std::vector<std::uint32_t>> triangles, int most_splits, const Context& context)
    : mesh_(mesh), grid_(grid), cubes_(cubes.begin(), cubes.end()) {
  const auto vertices = mesh.vertices();
  outermost_ = static_cast<std::uint32_t>(
      std::max_element(vertices.begin(), vertices.end(), [](const Vec3d& a, const Vec3d& b) { return a.x < b.x; }) -
      vertices.begin());
  for (std::size_t c = 0; c < cubes.size(); ++c) {
    const auto at = grid.lattice().place(node_of(cubes[c]));
    const Place low{static_cast<std::int32_t>(at[0]), static_cast<std::int32_t>(at[1]),
                    static_cast<std::int32_t>(at[2])};
    boxes_.push_back({grid.planes().node(low), grid.planes().node({low[0] + 1, low[1] + 1, low[2] + 1}), cubes[c]});
    data_.push_back({std::move(triangles[c]), 0});
  }
  while (!context.cancel.stop_requested()) {
    const std::vector<Cut> cuts = evaluate();
    stuck_.clear();
    bool is_cut = false;
    for (const Cut& cut : cuts) {
      if (can_cut(cut, most_splits)) {
        split(cut);
        is_cut = true;
      } else {
        stuck_.push_back({boxes_[cut.box], cut.obstacle});
      }
    }
    if (!is_cut) break;
  }
  for (const BoxData& data : data_) depth_ = std::max(depth_, data.splits);
}

bool RefinedRegion::can_cut(const Cut& cut, int most_splits) const {
  const BoxCell& box = boxes_[cut.box];
  const double least = least_part * grid_.planes().spacing()[cut.axis];
  return data_[cut.box].splits < most_splits && cut.at > box.low[cut.axis] + least &&
         cut.at < box.high[cut.axis] - least;
}

void RefinedRegion::split(const Cut& cut) {
  BoxCell upper = boxes_[cut.box];
  BoxCell& lower = boxes_[cut.box];
  lower.high[cut.axis] = upper.low[cut.axis] = cut.at;
  const std::vector<std::uint32_t> all = std::move(data_[cut.box].triangles);
  data_[cut.box].triangles = {};
  const int splits = ++data_[cut.box].splits;
  BoxData above{{}, splits};
  for (const std::uint32_t t : all) {
    const TriangleCorners corners = mesh_.corners(t);
    if (may_meet(corners, lower)) data_[cut.box].triangles.push_back(t);
    if (may_meet(corners, upper)) above.triangles.push_back(t);
  }
  boxes_.push_back(upper);
  data_.push_back(std::move(above));
}

std::vector<RefinedRegion::Cut> RefinedRegion::evaluate() {
  cells_ = std::make_unique<BoxCells>(boxes_, grid_.planes(), grid_.lattice());
  segments_.assign(cells_->segments().size(), {});
  rectangles_.assign(cells_->rectangles().size(), {});
  rectangles_of_box_.assign(boxes_.size(), {});
  segments_of_box_.assign(boxes_.size(), {});
  part_component_.assign(boxes_.size(), {});
  box_components_.assign(boxes_.size(), 0);
  holds_all_.assign(boxes_.size(), false);
  for (std::uint32_t s = 0; s < segments_.size(); ++s) {
    find_crossings(s);
    for (const BoxRef& box : cells_->segments()[s].around) {
      if (box.is_box) segments_of_box_[box.id].push_back(s);
    }
  }
  for (auto& own : segments_of_box_) own.erase(std::unique(own.begin(), own.end()), own.end());
  find_inside();
  Scratch scratch;
  std::map<std::uint32_t, Cut> cuts;
  for (std::uint32_t r = 0; r < rectangles_.size(); ++r) {
    find_arcs(r);
    connect_rectangle(r, scratch);
    for (const BoxRef& box : cells_->rectangles()[r].boxes) {
      if (box.is_box) rectangles_of_box_[box.id].push_back(r);
    }
    if (rectangles_[r].hole.empty()) continue;
    const Cut cut = cut_through_hole(r);
    cuts.try_emplace(cut.box, cut);
  }
  std::vector<Cut> out;
  for (std::uint32_t b = 0; b < boxes_.size(); ++b) connect_box(b, scratch, out);
  for (const Cut& cut : out) cuts.try_emplace(cut.box, cut);
  out.clear();
  for (const auto& [box, cut] : cuts) out.push_back(cut);
  return out;
}

const std::vector<std::uint32_t>& RefinedRegion::candidates(std::span<const BoxRef> boxes) const {
  const std::vector<std::uint32_t>* fewest = nullptr;
  for (const BoxRef& box : boxes) {
    if (!box.is_box) continue;
    const auto& own = data_[box.id].triangles;
    if (fewest == nullptr || own.size() < fewest->size()) fewest = &own;
  }
  return *fewest;
}

void RefinedRegion::find_crossings(std::uint32_t segment) {
  const BoxSegment& s = cells_->segments()[segment];
  const Vec3d& low = cells_->corners()[s.ends[0]];
  const Vec3d& high = cells_->corners()[s.ends[1]];
  std::vector<std::uint32_t>& found = segments_[segment].crossings;
  const BoxCell own{low, high, 0};
  for (const std::uint32_t t : candidates(s.around)) {
    const TriangleCorners corners = mesh_.corners(t);
    if (may_meet(corners, own) && crosses(corners, s.axis, low, high)) found.push_back(t);
  }
  if (found.size() < 2) return;
  std::sort(found.begin(), found.end(), [&](std::uint32_t a, std::uint32_t b) {
    return is_crossed_before(mesh_.corners(a), mesh_.corners(b), s.axis, low[next(s.axis)], low[next(next(s.axis))]);
  });
}

/// Corners of the grid are known; from there along segments.
void RefinedRegion::find_inside() {
  constexpr std::uint8_t unknown = 2;
  const auto corners = cells_->corners();
  inside_.assign(corners.size(), unknown);
  for (std::uint32_t c = 0; c < corners.size(); ++c) {
    const Place at = grid_.planes().cube(corners[c]);
    if (grid_.planes().node(at) == corners[c]) {
      inside_[c] = grid_.is_inside(grid_.lattice().node(at[0], at[1], at[2])) ? 1 : 0;
    }
  }
  bool is_new = true;
  while (is_new) {
    is_new = false;
    for (std::uint32_t s = 0; s < segments_.size(); ++s) {
      const auto [a, b] = cells_->segments()[s].ends;
      if ((inside_[a] == unknown) == (inside_[b] == unknown)) continue;
      const std::uint32_t known = inside_[a] == unknown ? b : a;
      inside_[known == a ? b : a] = inside_[known] ^ (segments_[s].crossings.size() & 1U);
      is_new = true;
    }
  }
  for (std::uint32_t s = 0; s < segments_.size(); ++s) {
    SegmentSurface& own = segments_[s];
    own.begins_inside = is_inside(cells_->segments()[s].ends[0]);
    own.components = intervals_of(static_cast<std::uint32_t>(own.crossings.size()), own.begins_inside);
  }
}

/// Whether an edge of the mesh passes through a rectangle.
bool RefinedRegion::passes_through(std::uint32_t edge, const BoxRectangle& rectangle) const {
  const std::size_t w = rectangle.axis;
  const EdgeEnds ends = mesh_.ends(edge);
  const auto corners = cells_->corners();
  const Vec3d& low = corners[cells_->segments()[rectangle.sides[0].front()].ends[0]];
  const Vec3d& high = corners[cells_->segments()[rectangle.sides[1].back()].ends[1]];
  if (is_above(ends[0][w], low[w]) == is_above(ends[1][w], low[w])) return false;
  const int rises = is_above(ends[1][w], low[w]) ? 1 : -1;
  // Where it passes, a line across that lies to the left of the rising edge, seen in the plane of w and a, is above.
  for (const std::size_t a : {next(w), next(next(w))}) {
    const std::size_t along = 3 - w - a;
    const bool is_w_first = next(along) == w;
    const auto is_line_above = [&](double coordinate) {
      const int side =
          is_w_first ? side_of_line(ends, along, low[w], coordinate) : -side_of_line(ends, along, coordinate, low[w]);
      return side * rises > 0;
    };
    if (is_line_above(low[a]) || !is_line_above(high[a])) return false;
  }
  return true;
}

void RefinedRegion::find_arcs(std::uint32_t rectangle) {
  const BoxRectangle& own = cells_->rectangles()[rectangle];
  const auto corners = cells_->corners();
  const BoxCell flat{corners[cells_->segments()[own.sides[0].front()].ends[0]],
                     corners[cells_->segments()[own.sides[1].back()].ends[1]], 0};
  std::vector<std::pair<std::uint32_t, std::uint32_t>> on_border;  // triangles and segments
  for (const auto& side : own.sides) {
    for (const std::uint32_t s : side) {
      for (const std::uint32_t t : segments_[s].crossings) on_border.emplace_back(t, s);
    }
  }
  std::sort(on_border.begin(), on_border.end());
  std::map<std::uint32_t, bool> passes;  // of edges of the mesh
  for (const std::uint32_t t : candidates(own.boxes)) {
    if (!may_meet(mesh_.corners(t), flat)) continue;
    std::array<ArcEnd, 4> ends{};
    std::size_t count = 0;
    for (const EdgeId edge : mesh_.edges_of(t)) {
      const auto [at, is_new] = passes.try_emplace(edge.value, false);
      if (is_new) at->second = passes_through(edge.value, own);
      if (at->second && count < 4) ends[count++] = {edge.value, false};
    }
    auto at = std::lower_bound(on_border.begin(), on_border.end(), std::pair{t, std::uint32_t{0}});
    for (; at != on_border.end() && at->first == t && count < 4; ++at) ends[count++] = {at->second, true};
    if (count == 2) rectangles_[rectangle].arcs.push_back({t, {ends[0], ends[1]}, 0});
  }
}

void RefinedRegion::connect_rectangle(std::uint32_t rectangle, Scratch& scratch) {
  const BoxRectangle& cell = cells_->rectangles()[rectangle];
  RectangleSurface& own = rectangles_[rectangle];
  std::map<std::uint32_t, std::uint32_t> first;  // interval of each segment
  std::vector<std::pair<std::uint32_t, std::uint32_t>> at_corners;
  std::uint32_t count = 0;
  for (const auto& side : cell.sides) {
    for (const std::uint32_t s : side) {
      first[s] = count;
      const auto& ends = cells_->segments()[s].ends;
      if (is_inside(ends[0])) at_corners.emplace_back(ends[0], count);
      count += segments_[s].components;
      if (is_inside(ends[1])) at_corners.emplace_back(ends[1], count - 1);
    }
  }
  SquareComponents& components = scratch.square;
  components.start(count);
  std::sort(at_corners.begin(), at_corners.end());
  for (std::size_t k = 0; k + 1 < at_corners.size(); ++k) {
    if (at_corners[k].first == at_corners[k + 1].first) components.join(at_corners[k].second, at_corners[k + 1].second);
  }
  const auto end_of = [&](const ArcEnd& end, std::uint32_t triangle) -> SquareComponents::End {
    if (!end.on_border) return {false, end.id};
    const SegmentSurface& s = segments_[end.id];
    const auto at = std::find(s.crossings.begin(), s.crossings.end(), triangle) - s.crossings.begin();
    return {true, first[end.id] + interval_at(static_cast<std::uint32_t>(at), s.begins_inside)};
  };
  for (const BoxArc& arc : own.arcs) {
    components.add_arc(end_of(arc.ends[0], arc.triangle), end_of(arc.ends[1], arc.triangle));
  }
  const double plane = cells_->corners()[cells_->segments()[cell.sides[0].front()].ends[0]][cell.axis];
  std::vector<std::uint32_t> edges;
  const bool passes = components.finish([&](std::span<const std::uint32_t> loop) {
    edges.clear();
    for (const std::uint32_t arc : loop) {
      for (const ArcEnd& end : own.arcs[arc].ends) edges.push_back(end.id);
    }
    return is_around_hole(mesh_, edges, cell.axis, plane);
  });
  if (!passes) {
    for (const std::uint32_t arc : components.hole()) {
      for (const ArcEnd& end : own.arcs[arc].ends) own.hole.push_back(end.id);
    }
  }
  own.components = components.count();
  for (std::uint32_t k = 0; k < count; ++k) own.interval_component.push_back(components.of_interval(k));
  for (std::size_t a = 0; a < own.arcs.size(); ++a) own.arcs[a].component = components.of_arc(a);
}

bool RefinedRegion::is_in_box(std::uint32_t vertex, const BoxCell& box) const {
  const Vec3d& p = mesh_.vertices()[vertex];
  for (std::size_t a = 0; a < 3; ++a) {
    if (!is_above(p[a], box.low[a]) || is_above(p[a], box.high[a])) return false;
  }
  return true;
}

std::size_t RefinedRegion::part_offset(std::uint32_t box, std::uint32_t rectangle) const {
  std::size_t offset = 0;
  for (const std::uint32_t r : rectangles_of_box_[box]) {
    if (r == rectangle) break;
    offset += rectangles_[r].components;
  }
  return offset;
}

std::uint32_t RefinedRegion::component_of_interval(std::uint32_t rectangle, std::uint32_t segment,
                                                   std::uint32_t interval) const {
  std::size_t at = interval;
  for (const auto& side : cells_->rectangles()[rectangle].sides) {
    for (const std::uint32_t s : side) {
      if (s == segment) return rectangles_[rectangle].interval_component[at];
      at += segments_[s].components;
    }
  }
  return 0;
}

std::uint32_t RefinedRegion::component_of_part(std::uint32_t box, std::uint32_t rectangle, std::uint32_t part) const {
  return part_component_[box][part_offset(box, rectangle) + part];
}

std::optional<ArcEnd> RefinedRegion::loose_end(std::uint32_t rectangle, std::uint32_t component) const {
  for (const BoxArc& arc : rectangles_[rectangle].arcs) {
    if (arc.component != component) continue;
    for (const ArcEnd& end : arc.ends) {
      if (!end.on_border) return end;
    }
  }
  return std::nullopt;
}

std::optional<std::uint32_t> RefinedRegion::shell_in(std::uint32_t box) const {
  if (!holds_all_[box]) return std::nullopt;
  return outermost_;
}

void RefinedRegion::connect_box(std::uint32_t box, Scratch& scratch, std::vector<Cut>& cuts) {
  const auto& rectangles = rectangles_of_box_[box];
  for (const std::uint32_t r : rectangles) {
    if (!rectangles_[r].hole.empty()) return;  // its components are not known yet
  }
  std::size_t parts = 0;
  for (const std::uint32_t r : rectangles) parts += rectangles_[r].components;
  CubeComponents& components = scratch.cube;
  components.start(parts);
  std::map<std::uint32_t, std::size_t> part_at_corner;
  for (const std::uint32_t s : segments_of_box_[box]) {
    if (segments_[s].components == 0) continue;
    const BoxSegment& segment = cells_->segments()[s];
    const auto [one, other] = cells_->rectangles_at(segment, {box, true});
    for (std::uint32_t k = 0; k < segments_[s].components; ++k) {
      const std::size_t part = part_offset(box, one) + component_of_interval(one, s, k);
      components.join_at_interval(part, part_offset(box, other) + component_of_interval(other, s, k));
      if (k == 0 && is_inside(segment.ends[0])) part_at_corner.try_emplace(segment.ends[0], part);
      if (k + 1 == segments_[s].components && is_inside(segment.ends[1])) {
        part_at_corner.try_emplace(segment.ends[1], part);
      }
    }
  }
  for (const auto& [corner, part] : part_at_corner) components.add_corner(part);
  std::vector<std::int64_t> euler;
  std::vector<std::uint32_t> triangles = data_[box].triangles;
  // Of each triangle: its arcs' parts.
  std::map<std::uint32_t, std::vector<std::size_t>> parts_of;
  std::vector<std::uint32_t> passing;  // edges that pass its sides
  for (const std::uint32_t r : rectangles) {
    const std::size_t offset = part_offset(box, r);
    for (const BoxArc& arc : rectangles_[r].arcs) {
      parts_of[arc.triangle].push_back(offset + arc.component);
      for (const ArcEnd& end : arc.ends) {
        if (!end.on_border) passing.push_back(end.id);
      }
    }
  }
  sort_unique(passing);
  // Pieces are joined from triangles, edges and vertices that meet the open box.
  std::vector<std::uint32_t> met_triangles;
  std::vector<std::uint32_t> met_edges = passing;
  std::vector<std::uint32_t> met_vertices;
  for (const std::uint32_t t : triangles) {
    int inside = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh_.triangles()[t][k];
      if (!is_in_box(v, boxes_[box])) continue;
      ++inside;
      met_vertices.push_back(v);
      met_edges.push_back(mesh_.edges_of(t)[k].value);
      met_edges.push_back(mesh_.edges_of(t)[(k + 2) % 3].value);
    }
    if (inside == 3 || parts_of.contains(t)) met_triangles.push_back(t);
  }
  sort_unique(met_triangles);
  sort_unique(met_edges);
  sort_unique(met_vertices);
  const std::size_t first_edge = met_triangles.size();
  const std::size_t first_vertex = first_edge + met_edges.size();
  scratch.pieces.reset(first_vertex + met_vertices.size());
  const auto join = [&](std::size_t a, std::size_t b) {
    scratch.pieces.join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
  };
  for (std::size_t k = 0; k < met_triangles.size(); ++k) {
    for (const EdgeId edge : mesh_.edges_of(met_triangles[k])) {
      const std::size_t at = place_in(met_edges, edge.value);
      if (at < met_edges.size() && met_edges[at] == edge.value) join(k, first_edge + at);
    }
  }
  for (std::size_t k = 0; k < met_edges.size(); ++k) {
    for (const std::uint32_t v : mesh_.edges()[met_edges[k]]) {
      const std::size_t at = place_in(met_vertices, v);
      if (at < met_vertices.size() && met_vertices[at] == v) join(first_edge + k, first_vertex + at);
    }
  }
  euler.assign(first_vertex + met_vertices.size(), 0);
  for (std::uint32_t k = 0; k < euler.size(); ++k) {
    euler[scratch.pieces.find(k)] += k >= first_edge && k < first_vertex ? -1 : 1;
  }
  std::vector<bool> is_open(euler.size(), false);
  for (std::size_t k = 0; k < met_triangles.size(); ++k) {
    const auto at = parts_of.find(met_triangles[k]);
    if (at == parts_of.end()) continue;
    const std::uint32_t piece = scratch.pieces.find(static_cast<std::uint32_t>(k));
    is_open[piece] = true;
    for (const std::size_t part : at->second) components.add_arc(piece, part);
  }
  bool has_void = false;
  std::uint32_t whole = 0;
  for (std::size_t k = 0; k < met_vertices.size(); ++k) {
    const std::uint32_t piece = scratch.pieces.find(static_cast<std::uint32_t>(first_vertex + k));
    if (is_open[piece]) continue;
    is_open[piece] = true;  // looked at
    const std::size_t outer = place_in(met_vertices, outermost_);
    const bool is_outer = outer < met_vertices.size() && met_vertices[outer] == outermost_ &&
                          scratch.pieces.find(static_cast<std::uint32_t>(first_vertex + outer)) == piece;
    if (is_outer && euler[piece] == 2) ++whole;
    if (!is_outer || euler[piece] != 2) has_void = true;
  }
  const bool passes = components.finish([&](std::uint32_t piece) { return euler[piece]; });
  for (std::size_t k = 0; k < parts; ++k) part_component_[box].push_back(components.of_part(k));
  box_components_[box] = components.count() + whole;
  holds_all_[box] = whole > 0;
  if (has_void || !passes) {
    cuts.push_back(cut_through_middle(box, has_void ? CellObstacle::void_in_cube : CellObstacle::handle));
  }
}

RefinedRegion::Cut RefinedRegion::cut_through_hole(std::uint32_t rectangle) const {
  const BoxRectangle& own = cells_->rectangles()[rectangle];
  const auto corners = cells_->corners();
  const Vec3d& low = corners[cells_->segments()[own.sides[0].front()].ends[0]];
  const Vec3d& high = corners[cells_->segments()[own.sides[1].back()].ends[1]];
  Vec3d sum{};
  for (const std::uint32_t edge : rectangles_[rectangle].hole) {
    const auto [a, b] = mesh_.ends(edge);
    const double t = (low[own.axis] - a[own.axis]) / (b[own.axis] - a[own.axis]);
    sum += a + (b - a) * std::clamp(t, 0.0, 1.0);
  }
  const Vec3d middle = sum / static_cast<double>(rectangles_[rectangle].hole.size());
  // Across the longer side, so that boxes stay compact; and the larger of the two boxes.
  const std::size_t a = next(own.axis);
  const std::size_t b = next(a);
  const std::size_t axis = high[a] - low[a] >= high[b] - low[b] ? a : b;
  const auto volume = [&](const BoxRef& box) {
    if (!box.is_box) return -1.0;
    const Vec3d size = boxes_[box.id].high - boxes_[box.id].low;
    return size.x * size.y * size.z;
  };
  const BoxRef& box = volume(own.boxes[0]) >= volume(own.boxes[1]) ? own.boxes[0] : own.boxes[1];
  return {box.id, axis, middle[axis], CellObstacle::hole_in_square};
}

RefinedRegion::Cut RefinedRegion::cut_through_middle(std::uint32_t box, CellObstacle obstacle) const {
  const BoxCell& own = boxes_[box];
  Vec3d low = own.high;
  Vec3d high = own.low;
  for (const std::uint32_t t : data_[box].triangles) {
    for (const std::uint32_t v : mesh_.triangles()[t]) {
      if (!is_in_box(v, own)) continue;
      for (std::size_t a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], mesh_.vertices()[v][a]);
        high[a] = std::max(high[a], mesh_.vertices()[v][a]);
      }
    }
  }
  // Small things are cut themselves, so that they need not be come near to in halves.
  const auto longest = [](const Vec3d& size) {
    return size.x >= size.y && size.x >= size.z ? std::size_t{0} : size.y >= size.z ? std::size_t{1} : std::size_t{2};
  };
  const Vec3d size = own.high - own.low;
  const Vec3d inner = high - low;
  const std::size_t inner_axis = longest(inner);
  const double middle = 0.5 * (low[inner_axis] + high[inner_axis]);
  const bool is_small = inner.x >= 0 && inner[inner_axis] < 0.5 * size[inner_axis];
  const double room = 0.05 * size[inner_axis];
  if (is_small && middle > own.low[inner_axis] + room && middle < own.high[inner_axis] - room) {
    return {box, inner_axis, middle, obstacle};
  }
  const std::size_t axis = longest(size);
  return {box, axis, 0.5 * (own.low[axis] + own.high[axis]), obstacle};
}

}  // namespace blum::detail
