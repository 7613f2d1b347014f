#include "solid/model/box_cells.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "blum/core/parallel.hpp"
#include "blum/geometry/grid_predicates.hpp"

namespace blum::detail {
namespace {

/// Returns the number of boxes below a plane across an axis that cuts no box; nullopt if no such plane exists. The
/// boxes are sorted by their lower ends along the axis. Among several planes, the one nearest to the middle of the list
/// is chosen.
std::optional<std::size_t> cut_of(std::span<const BoxCell> boxes, std::span<const std::uint32_t> sorted,
                                  std::size_t axis) {
  std::optional<std::size_t> best;
  double reach = boxes[sorted[0]].high[axis];
  const auto from_middle = [&](std::size_t k) {
    return std::max(2 * k, sorted.size()) - std::min(2 * k, sorted.size());
  };
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    if (boxes[sorted[k]].low[axis] >= reach && (!best || from_middle(k) < from_middle(*best))) best = k;
    reach = std::max(reach, boxes[sorted[k]].high[axis]);
  }
  return best;
}

constexpr double infinity = std::numeric_limits<double>::infinity();

bool is_before(const Vec3d& a, const Vec3d& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// A point on a line along an axis: the axis, the line's two coordinates, and the coordinate along the axis.
using OnLine = std::tuple<std::size_t, double, double, double>;

OnLine on_line(std::size_t axis, const Vec3d& p) {
  return {axis, p[next_axis(axis)], p[next_axis(next_axis(axis))], p[axis]};
}

}  // namespace

SplitTree::SplitTree(std::span<const BoxCell> boxes, std::vector<std::uint32_t> own) {
  std::vector<std::pair<std::uint32_t, std::vector<std::uint32_t>>> waiting;
  nodes_.emplace_back();
  waiting.emplace_back(0, std::move(own));
  while (!waiting.empty()) {
    auto [node, list] = std::move(waiting.back());
    waiting.pop_back();
    nodes_[node].below = list.front();
    for (std::size_t axis = 0; axis < 3 && list.size() > 1; ++axis) {
      std::sort(list.begin(), list.end(), [&](std::uint32_t a, std::uint32_t b) {
        return boxes[a].low[axis] != boxes[b].low[axis] ? boxes[a].low[axis] < boxes[b].low[axis] : a < b;
      });
      const std::optional<std::size_t> cut = cut_of(boxes, list, axis);
      if (!cut) continue;
      const auto middle = list.begin() + static_cast<std::ptrdiff_t>(*cut);
      const auto below = static_cast<std::uint32_t>(nodes_.size());
      nodes_[node] = {axis, boxes[*middle].low[axis], below, below + 1};
      nodes_.resize(nodes_.size() + 2);
      waiting.emplace_back(below, std::vector(list.begin(), middle));
      waiting.emplace_back(below + 1, std::vector(middle, list.end()));
      break;
    }
  }
}

std::uint32_t SplitTree::find(const Vec3d& p, const std::array<bool, 3>& up) const {
  const Node* node = nodes_.data();
  while (node->axis < 3) {
    const double coordinate = p[node->axis];
    const bool is_above = up[node->axis] ? coordinate >= node->at : coordinate > node->at;
    node = &nodes_[is_above ? node->above : node->below];
  }
  return node->below;
}

BoxCells::BoxCells(std::span<const BoxCell> boxes, const GridPlanes& planes, const CellLattice& lattice,
                   const Context& context)
    : boxes_(boxes), planes_(planes), lattice_(lattice) {
  std::map<Cell, std::vector<std::uint32_t>> own;
  for (std::uint32_t b = 0; b < boxes.size(); ++b) own[boxes[b].cube].push_back(b);
  for (auto& [cube, list] : own) boxes_of_cube_.try_emplace(cube, boxes, std::move(list));
  find_corners(context);
  find_segments(context);
  find_rectangles();
  order_sides();
}

void BoxCells::find_corners(const Context& context) {
  for (const BoxCell& box : boxes_) {
    for (std::size_t k = 0; k < 8; ++k) corners_.push_back(corner_of(box, k));
  }
  std::array<std::vector<Vec3d>, 3> crossed;
  parallel_for(context, 3, 1, {}, [&](const WorkRange& range) { crossed[range.begin] = crossings(range.begin); });
  for (const std::vector<Vec3d>& more : crossed) corners_.insert(corners_.end(), more.begin(), more.end());
  std::sort(corners_.begin(), corners_.end(), is_before);
  corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
}

/// Returns the points at which edges of boxes cross in planes across an axis.
std::vector<Vec3d> BoxCells::crossings(std::size_t across) const {
  std::vector<Vec3d> found;
  const std::size_t u = next_axis(across);
  const std::size_t v = next_axis(u);
  // Edges along u contain: plane, v, begin, end. Edges along v contain: plane, u, begin, end.
  using Edge = std::array<double, 4>;
  std::vector<Edge> along_u;
  std::vector<Edge> along_v;
  for (const BoxCell& box : boxes_) {
    for (const double plane : {box.low[across], box.high[across]}) {
      for (const double at : {box.low[v], box.high[v]}) along_u.push_back({plane, at, box.low[u], box.high[u]});
      for (const double at : {box.low[u], box.high[u]}) along_v.push_back({plane, at, box.low[v], box.high[v]});
    }
  }
  for (auto* edges : {&along_u, &along_v}) {
    std::sort(edges->begin(), edges->end());
    edges->erase(std::unique(edges->begin(), edges->end()), edges->end());
  }
  for (const Edge& edge : along_u) {
    const auto [plane, at_v, begin, end] = edge;
    auto other = std::upper_bound(along_v.begin(), along_v.end(), Edge{plane, begin, infinity, infinity});
    for (; other != along_v.end() && (*other)[0] == plane && (*other)[1] < end; ++other) {
      if (!((*other)[2] < at_v && at_v < (*other)[3])) continue;
      Vec3d p;
      p[across] = plane;
      p[u] = (*other)[1];
      p[v] = at_v;
      found.push_back(p);
    }
  }
  return found;
}

std::uint32_t BoxCells::corner(const Vec3d& p) const {
  return static_cast<std::uint32_t>(std::lower_bound(corners_.begin(), corners_.end(), p, is_before) -
                                    corners_.begin());
}

void BoxCells::find_segments(const Context& context) {
  std::vector<OnLine> lines;
  for (const Vec3d& p : corners_) {
    for (std::size_t axis = 0; axis < 3; ++axis) lines.push_back(on_line(axis, p));
  }
  std::sort(lines.begin(), lines.end());
  std::vector<std::pair<OnLine, double>> pieces;  // begin of each piece, and the coordinate of its end
  for (const BoxCell& box : boxes_) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < 8; ++k) {
        if ((k >> axis & 1U) != 0) continue;
        auto at = std::lower_bound(lines.begin(), lines.end(), on_line(axis, corner_of(box, k)));
        for (; std::get<3>(*at) < box.high[axis]; ++at) pieces.emplace_back(*at, std::get<3>(*(at + 1)));
      }
    }
  }
  std::sort(pieces.begin(), pieces.end());
  pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
  const auto segment_of = [&](const std::pair<OnLine, double>& piece) {
    const auto& [axis, u, v, low] = piece.first;
    Vec3d p;
    p[next_axis(axis)] = u;
    p[next_axis(next_axis(axis))] = v;
    BoxSegment segment;
    segment.axis = axis;
    p[axis] = low;
    segment.ends[0] = corner(p);
    p[axis] = piece.second;
    segment.ends[1] = corner(p);
    p[axis] = low;
    for (std::size_t q = 0; q < 4; ++q) {
      std::array<bool, 3> up{};
      up[axis] = true;
      up[next_axis(axis)] = (q & 1U) != 0;
      up[next_axis(next_axis(axis))] = (q & 2U) != 0;
      segment.around[q] = locate(p, up);
    }
    return segment;
  };
  constexpr std::size_t grain = 1024;
  segments_.resize(pieces.size());
  parallel_for(context, pieces.size(), grain, {}, [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) segments_[k] = segment_of(pieces[k]);
  });
}

BoxRef BoxCells::locate(const Vec3d& p, const std::array<bool, 3>& up) const {
  Place cube = planes_.cube(p);
  for (std::size_t a = 0; a < 3; ++a) {
    if (!up[a] && p[a] == planes_.at(a, cube[a])) --cube[a];
    if (cube[a] < 0 || cube[a] + 1 >= planes_.count(a)) return {};
  }
  const Cell cell = cell_at(lattice_.node(cube[0], cube[1], cube[2]), 7);
  const auto found = boxes_of_cube_.find(cell);
  if (found == boxes_of_cube_.end()) return {cell, false};
  return {found->second.find(p, up), true};
}

/// Finds the rectangles, and numbers them in the order of their first segments.
void BoxCells::find_rectangles() {
  struct Piece {
    BoxPair key;
    std::uint32_t segment = 0;
    std::uint8_t side = 0, quarter = 0;
    [[nodiscard]] std::tuple<std::uint32_t, std::uint8_t, std::uint8_t> place() const {
      return {segment, side, quarter};
    }
    [[nodiscard]] bool operator<(const Piece& other) const {
      return key != other.key ? key < other.key : place() < other.place();
    }
  };
  std::vector<Piece> pieces;
  for (std::uint32_t s = 0; s < segments_.size(); ++s) {
    for (std::uint8_t side = 0; side < 2; ++side) {
      for (std::uint8_t q = 0; q < 4; ++q) {
        if ((q >> side & 1U) != 0) continue;
        const BoxRef& below = segments_[s].around[q];
        const BoxRef& above = segments_[s].around[q | 1U << side];
        if (below == above || !below.exists() || !above.exists() || (!below.is_box && !above.is_box)) continue;
        pieces.push_back({above < below ? BoxPair{above, below} : BoxPair{below, above}, s, side, q});
      }
    }
  }
  std::sort(pieces.begin(), pieces.end());
  std::vector<std::size_t> order;  // index of the first piece of each pair of boxes; sorted below by place()
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (k == 0 || pieces[k].key != pieces[k - 1].key) order.push_back(k);
  }
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return pieces[a].place() < pieces[b].place(); });
  rectangle_of_.reserve(order.size());
  for (const std::size_t begin : order) {
    const Piece& one = pieces[begin];
    const BoxSegment& segment = segments_[one.segment];
    rectangle_of_.emplace_back(one.key, static_cast<std::uint32_t>(rectangles_.size()));
    BoxRectangle& rectangle = rectangles_.emplace_back();
    rectangle.axis = (segment.axis + 1 + one.side) % 3;
    rectangle.boxes = {segment.around[one.quarter], segment.around[one.quarter | 1U << one.side]};
    // The first side lists the segments of all sides until order_sides() separates them.
    for (std::size_t k = begin; k < pieces.size() && pieces[k].key == one.key; ++k) {
      rectangle.sides[0].push_back(pieces[k].segment);
    }
  }
  std::sort(rectangle_of_.begin(), rectangle_of_.end());
}

void BoxCells::order_sides() {
  for (BoxRectangle& rectangle : rectangles_) {
    std::vector<std::uint32_t> all = std::move(rectangle.sides[0]);
    rectangle.sides = {};
    const std::size_t lower = rectangle.axis == 0 ? 1 : 0;
    const std::size_t upper = 3 - rectangle.axis - lower;
    std::sort(all.begin(), all.end(),
              [&](std::uint32_t a, std::uint32_t b) { return segments_[a].ends[0] < segments_[b].ends[0]; });
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (const std::size_t axis : {lower, upper}) {
      const std::size_t other = axis == lower ? upper : lower;
      const auto height = [&](std::uint32_t s) { return corners_[segments_[s].ends[0]][other]; };
      std::vector<std::uint32_t> along;
      for (const std::uint32_t s : all) {
        if (segments_[s].axis == axis) along.push_back(s);
      }
      double low = height(along.front());
      for (const std::uint32_t s : along) low = std::min(low, height(s));
      for (const std::uint32_t s : along) {
        rectangle.sides[(axis == lower ? 0 : 2) + (height(s) == low ? 0U : 1U)].push_back(s);
      }
    }
  }
}

std::uint32_t BoxCells::rectangle(const BoxRef& one, const BoxRef& other) const {
  const BoxPair key = one < other ? BoxPair{one, other} : BoxPair{other, one};
  return std::lower_bound(rectangle_of_.begin(), rectangle_of_.end(), std::pair(key, std::uint32_t{0}))->second;
}

std::array<std::uint32_t, 2> BoxCells::rectangles_at(const BoxSegment& segment, const BoxRef& box) const {
  std::array<std::uint32_t, 2> found{};
  std::size_t count = 0;
  for (std::size_t q = 0; q < 4 && count < 2; ++q) {
    if (segment.around[q] != box) continue;
    for (const std::size_t step : {1U, 2U}) {
      const BoxRef& beside = segment.around[q ^ step];
      if (beside != box && count < 2) found[count++] = rectangle(box, beside);
    }
  }
  return found;
}

}  // namespace blum::detail
