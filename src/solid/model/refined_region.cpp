#include "solid/model/refined_region.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "blum/core/parallel.hpp"
#include "solid/model/box_splitter.hpp"
#include "solid/model/box_surface.hpp"
#include "solid/model/components.hpp"

namespace blum::detail {

namespace {

/// Limit on the number of boxes in a region. A slanted tunnel takes about length / width boxes.
constexpr std::size_t most_boxes = std::size_t{1} << 17U;
constexpr std::size_t cubes_in_batch = 32;
/// Limit for one cube while the cubes of a batch are split concurrently.
constexpr std::size_t most_at_first = most_boxes / cubes_in_batch;

/// Calls visit(k, worker) for each k below `count`, distributed over all threads.
template <class Visit>
void for_each(const Context& context, std::size_t count, const Visit& visit) {
  constexpr std::size_t grain = 256;
  parallel_for(context, count, grain, {}, [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) visit(static_cast<std::uint32_t>(k), range.worker);
  });
}

}  // namespace

struct RefinedRegion::Scratch {
  SquareComponents square;
  CubeComponents cube;
  BoxPieces pieces;
};

RefinedRegion::RefinedRegion(const SurfaceMesh& mesh, const CutGrid& grid, std::span<const Cell> cubes,
                             std::vector<std::vector<std::uint32_t>> triangles, int most_splits,
                             std::span<const Box3> finer, const Context& context)
    : mesh_(mesh), grid_(grid), cubes_(cubes.begin(), cubes.end()) {
  const Vec3d& spacing = grid.planes().spacing();
  std::vector<BoxSplitter> splitters;  // one for each thread
  for (int k = 0; k < thread_count(context); ++k) {
    splitters.emplace_back(mesh, std::max({spacing.x, spacing.y, spacing.z}), most_splits, finer);
  }
  // The result is the same as if the cubes were split one after the other, each with the limit that earlier cubes
  // leave. A cube that exceeds a limit is split again, alone.
  std::vector<std::vector<SplitBox>> parts(cubes_in_batch);
  for (std::size_t first = 0; first < cubes.size(); first += cubes_in_batch) {
    const std::size_t count = std::min(cubes_in_batch, cubes.size() - first);
    parallel_for(context, count, 1, {}, [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        parts[k] = splitters[static_cast<std::size_t>(range.worker)].split(
            whole_box(cubes[first + k], triangles[first + k]), most_at_first, context);
      }
    });
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t room = most_boxes - std::min(most_boxes, boxes_.size());
      if (parts[k].size() >= most_at_first || parts[k].size() > room) {
        parts[k] = splitters[0].split(whole_box(cubes[first + k], triangles[first + k]), room, context);
        throw_if_cancelled(context);
      }
      for (SplitBox& part : parts[k]) take(std::move(part));
      triangles[first + k] = {};
    }
  }
  connect(context);
}

SplitBox RefinedRegion::whole_box(Cell cube, std::vector<std::uint32_t> triangles) const {
  const CellLattice& lattice = grid_.lattice();
  const std::size_t first = node_of(cube);
  SplitBox whole;
  whole.box = {grid_.planes().node(lattice.place(first)),
               grid_.planes().node(lattice.place(first + lattice.node(1, 1, 1))), cube};
  whole.triangles = std::move(triangles);
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t step = lattice.node(corner & 1U, corner >> 1U & 1U, corner >> 2U);
    if (grid_.is_inside(first + step)) whole.inside |= static_cast<std::uint8_t>(1U << corner);
  }
  return whole;
}

void RefinedRegion::take(SplitBox part) {
  boxes_.push_back(part.box);
  depth_ = std::max(depth_, part.splits);
  split_boxes_ += part.splits > 0 ? 1U : 0U;
  if (part.obstacle) stuck_.push_back({part.box, *part.obstacle, part.cuts_left});
  triangles_.push_back(std::move(part.triangles));
}

void RefinedRegion::connect(const Context& context) {
  cells_ = std::make_unique<BoxCells>(boxes_, grid_.planes(), grid_.lattice(), context);
  segments_.resize(cells_->segments().size());
  rectangles_.resize(cells_->rectangles().size());
  rectangles_of_box_.resize(boxes_.size());
  segments_of_box_.resize(boxes_.size());
  part_component_.resize(boxes_.size());
  box_components_.assign(boxes_.size(), 0);
  bodies_of_box_.resize(boxes_.size());
  for_each(context, segments_.size(), [&](std::uint32_t s, int) { find_crossings(s); });
  for (std::uint32_t s = 0; s < segments_.size(); ++s) {
    for (const BoxRef& box : cells_->segments()[s].around) {
      if (box.is_box) segments_of_box_[box.id].push_back(s);
    }
  }
  for (auto& own : segments_of_box_) own.erase(std::unique(own.begin(), own.end()), own.end());
  find_inside();
  std::vector<Scratch> scratch(static_cast<std::size_t>(thread_count(context)));
  for_each(context, rectangles_.size(), [&](std::uint32_t r, int worker) {
    find_arcs(r);
    connect_rectangle(r, scratch[static_cast<std::size_t>(worker)]);
  });
  for (std::uint32_t r = 0; r < rectangles_.size(); ++r) {
    for (const BoxRef& box : cells_->rectangles()[r].boxes) {
      if (box.is_box) rectangles_of_box_[box.id].push_back(r);
    }
  }
  for_each(context, boxes_.size(),
           [&](std::uint32_t b, int worker) { connect_box(b, scratch[static_cast<std::size_t>(worker)]); });
}

const std::vector<std::uint32_t>& RefinedRegion::candidates(std::span<const BoxRef> boxes) const {
  const std::vector<std::uint32_t>* fewest = nullptr;
  for (const BoxRef& box : boxes) {
    if (!box.is_box) continue;
    const auto& own = triangles_[box.id];
    if (fewest == nullptr || own.size() < fewest->size()) fewest = &own;
  }
  static const std::vector<std::uint32_t> nothing;  // fallback; in fact every segment and rectangle lies at a box
  return fewest != nullptr ? *fewest : nothing;
}

void RefinedRegion::find_crossings(std::uint32_t segment) {
  const BoxSegment& s = cells_->segments()[segment];
  const Vec3d& low = cells_->corners()[s.ends[0]];
  const Vec3d& high = cells_->corners()[s.ends[1]];
  std::vector<std::uint32_t>& found = segments_[segment].crossings;
  for (const std::uint32_t t : candidates(s.around)) {
    if (crosses(mesh_.corners(t), s.axis, low, high)) found.push_back(t);
  }
  sort_along(mesh_, s.axis, low, found);
}

/// Finds which corners are inside the solid. At nodes of the grid, the result is known. From the nodes, it spreads
/// along segments, whose crossings switch between inside and outside.
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
  std::vector<std::vector<std::uint32_t>> around(corners.size());  // for each corner: its segments
  for (std::uint32_t s = 0; s < segments_.size(); ++s) {
    for (const std::uint32_t end : cells_->segments()[s].ends) around[end].push_back(s);
  }
  std::vector<std::uint32_t> known;
  for (std::uint32_t c = 0; c < corners.size(); ++c) {
    if (inside_[c] != unknown) known.push_back(c);
  }
  for (std::size_t k = 0; k < known.size(); ++k) {
    for (const std::uint32_t s : around[known[k]]) {
      const auto [a, b] = cells_->segments()[s].ends;
      const std::uint32_t other = known[k] == a ? b : a;
      if (inside_[other] != unknown) continue;
      inside_[other] = inside_[known[k]] ^ static_cast<std::uint8_t>(segments_[s].crossings.size() & 1U);
      known.push_back(other);
    }
  }
  for (std::uint32_t s = 0; s < segments_.size(); ++s) {
    SegmentSurface& own = segments_[s];
    own.begins_inside = is_inside(cells_->segments()[s].ends[0]);
    own.components = intervals_of(static_cast<std::uint32_t>(own.crossings.size()), own.begins_inside);
  }
}

void RefinedRegion::find_arcs(std::uint32_t rectangle) {
  const BoxRectangle& own = cells_->rectangles()[rectangle];
  const auto corners = cells_->corners();
  const Vec3d& low = corners[cells_->segments()[own.sides[0].front()].ends[0]];
  const Vec3d& high = corners[cells_->segments()[own.sides[1].back()].ends[1]];
  std::vector<std::pair<std::uint32_t, std::uint32_t>> on_border;  // (triangle, segment)
  for (const auto& side : own.sides) {
    for (const std::uint32_t s : side) {
      for (const std::uint32_t t : segments_[s].crossings) on_border.emplace_back(t, s);
    }
  }
  std::sort(on_border.begin(), on_border.end());
  std::map<std::uint32_t, bool> passes;  // for each edge of the mesh: true if it passes through the rectangle
  for (const std::uint32_t t : candidates(own.boxes)) {
    if (!may_meet(mesh_.corners(t), low, high)) continue;
    std::array<ArcEnd, 4> ends{};
    std::size_t count = 0;
    for (const EdgeId edge : mesh_.edges_of(t)) {
      const auto [at, is_new] = passes.try_emplace(edge.value, false);
      if (is_new) at->second = passes_through(mesh_.ends(edge.value), own.axis, low, high);
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
  std::vector<std::pair<std::uint32_t, std::uint32_t>> at_corners;
  std::uint32_t count = 0;
  for (const auto& side : cell.sides) {
    for (const std::uint32_t s : side) {
      own.first_interval.emplace_back(s, count);
      const auto& ends = cells_->segments()[s].ends;
      if (is_inside(ends[0])) at_corners.emplace_back(ends[0], count);
      count += segments_[s].components;
      if (is_inside(ends[1])) at_corners.emplace_back(ends[1], count - 1);
    }
  }
  std::sort(own.first_interval.begin(), own.first_interval.end());
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
    return {true, first_interval(own, end.id) + interval_at(static_cast<std::uint32_t>(at), s.begins_inside)};
  };
  for (const BoxArc& arc : own.arcs) {
    components.add_arc(end_of(arc.ends[0], arc.triangle), end_of(arc.ends[1], arc.triangle));
  }
  // BoxSplitter has tested the boxes at this rectangle, so holes need not be found again.
  static_cast<void>(components.finish([](std::span<const std::uint32_t>) { return false; }));
  own.components = components.count();
  for (std::uint32_t k = 0; k < count; ++k) own.interval_component.push_back(components.of_interval(k));
  for (std::size_t a = 0; a < own.arcs.size(); ++a) own.arcs[a].component = components.of_arc(a);
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
  const RectangleSurface& own = rectangles_[rectangle];
  return own.interval_component[first_interval(own, segment) + interval];
}

std::uint32_t RefinedRegion::first_interval(const RectangleSurface& rectangle, std::uint32_t segment) {
  return std::lower_bound(rectangle.first_interval.begin(), rectangle.first_interval.end(),
                          std::pair(segment, std::uint32_t{0}))
      ->second;
}

std::uint32_t RefinedRegion::component_of_part(std::uint32_t box, std::uint32_t rectangle, std::uint32_t part) const {
  return part_component_[box][part_offset(box, rectangle) + part];
}

std::vector<ArcEnd> RefinedRegion::loose_ends(std::uint32_t rectangle, std::uint32_t component) const {
  std::vector<ArcEnd> ends;
  for (const BoxArc& arc : rectangles_[rectangle].arcs) {
    if (arc.component != component) continue;
    for (const ArcEnd& end : arc.ends) {
      if (end.on_border) return {};
      ends.push_back(end);
    }
  }
  return ends;
}

void RefinedRegion::connect_box(std::uint32_t box, Scratch& scratch) {
  const auto& rectangles = rectangles_of_box_[box];
  std::size_t parts = 0;
  for (const std::uint32_t r : rectangles) parts += rectangles_[r].components;
  CubeComponents& components = scratch.cube;
  components.start(parts);
  join_at_segments(box, components);
  std::vector<BoxPieces::ArcPart> arcs;
  std::vector<std::uint32_t> passing;  // edges of the mesh that pass through the box's faces
  std::size_t offset = 0;
  for (const std::uint32_t r : rectangles) {
    for (const BoxArc& arc : rectangles_[r].arcs) {
      arcs.push_back({arc.triangle, static_cast<std::uint32_t>(offset + arc.component)});
      for (const ArcEnd& end : arc.ends) {
        if (!end.on_border) passing.push_back(end.id);
      }
    }
    offset += rectangles_[r].components;
  }
  scratch.pieces.find(mesh_, boxes_[box], triangles_[box], arcs, passing, components);
  // BoxSplitter has tested this box, so the result is not needed. Dividing the faces of the box into rectangles does
  // not change this result.
  static_cast<void>(components.finish([&](std::uint32_t piece) { return scratch.pieces.euler(piece); }));
  for (std::size_t k = 0; k < parts; ++k) part_component_[box].push_back(components.of_part(k));
  const auto bodies = scratch.pieces.bodies();
  bodies_of_box_[box].assign(bodies.begin(), bodies.end());
  box_components_[box] = components.count() + static_cast<std::uint32_t>(bodies.size());
}

void RefinedRegion::join_at_segments(std::uint32_t box, CubeComponents& components) const {
  std::map<std::uint32_t, std::size_t> part_at_corner;
  for (const std::uint32_t s : segments_of_box_[box]) {
    const std::uint32_t count = segments_[s].components;
    if (count == 0) continue;
    const BoxSegment& segment = cells_->segments()[s];
    const auto [one, other] = cells_->rectangles_at(segment, {box, true});
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::size_t part = part_offset(box, one) + component_of_interval(one, s, k);
      components.join_at_interval(part, part_offset(box, other) + component_of_interval(other, s, k));
      if (k == 0 && is_inside(segment.ends[0])) part_at_corner.try_emplace(segment.ends[0], part);
      if (k + 1 == count && is_inside(segment.ends[1])) part_at_corner.try_emplace(segment.ends[1], part);
    }
  }
  for (const auto& [corner, part] : part_at_corner) components.add_corner(part);
}

}  // namespace blum::detail
