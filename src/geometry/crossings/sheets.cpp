#include "geometry/crossings/sheets.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "blum/core/union_find.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/orient3d.hpp"
#include "geometry/crossings/planar_mesh.hpp"

namespace blum::detail {
namespace {

using Signs = std::array<int, 3>;

Signs sides(const ExactSpace& space, const FlatTriangle& plane, const FlatTriangle& of) {
  return {space.side(plane.plane(), of.corners[0]), space.side(plane.plane(), of.corners[1]),
          space.side(plane.plane(), of.corners[2])};
}

/// Collects the points that the edges of one triangle share with another triangle.
class Collector {
 public:
  Collector(ExactSpace& space, EdgePoints& edge_points, Contact3& out)
      : space_(space), edge_points_(edge_points), out_(out) {}

  void collect(const FlatTriangle& a, const Signs& a_sides, const FlatTriangle& b) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      if (a_sides[k] == 0) take_corner(a.corners[k], b);
      if (a_sides[k] * a_sides[next] < 0) take_crossing(a.corners[k], a.corners[next], b);
    }
  }

 private:
  void take(PointId p) {
    for (std::size_t k = 0; k < out_.count; ++k) {
      if (out_.points[k] == p) return;
    }
    if (out_.count < 2) out_.points[out_.count++] = p;
  }

  /// Handles a corner that lies in the plane of b.
  void take_corner(PointId p, const FlatTriangle& b) {
    Signs turns{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (p == b.corners[k]) return take(p);
      turns[k] = b.turn * space_.turn(b.axis, b.corners[k], b.corners[(k + 1) % 3], p);
      if (turns[k] < 0) return;
    }
    take(p);
    for (std::size_t k = 0; k < 3; ++k) {
      if (turns[k] == 0) edge_points_.add(b.corners[k], b.corners[(k + 1) % 3], p);
    }
  }

  /// Handles an edge whose ends are on different sides of b's plane.
  void take_crossing(PointId from, PointId to, const FlatTriangle& b) {
    Signs passes{};
    bool left = false;
    bool right = false;
    for (std::size_t k = 0; k < 3; ++k) {
      passes[k] = orient3d(space_.rounded(from), space_.rounded(to), space_.rounded(b.corners[k]),
                           space_.rounded(b.corners[(k + 1) % 3]));
      left = left || passes[k] > 0;
      right = right || passes[k] < 0;
    }
    if (left && right) return;
    PointId p = 0;
    if (passes[0] == 0 && passes[2] == 0) {
      p = b.corners[0];
    } else if (passes[0] == 0 && passes[1] == 0) {
      p = b.corners[1];
    } else if (passes[1] == 0 && passes[2] == 0) {
      p = b.corners[2];
    } else {
      p = space_.meet(from, to, b.plane());
      for (std::size_t k = 0; k < 3; ++k) {
        if (passes[k] == 0) edge_points_.add(b.corners[k], b.corners[(k + 1) % 3], p);
      }
    }
    edge_points_.add(from, to, p);
    take(p);
  }

  ExactSpace& space_;
  EdgePoints& edge_points_;
  Contact3& out_;
};

constexpr std::uint32_t nobody = 0xffffffffU;

/// Largest number of pairs of segments that are tested, for all sheets together.
constexpr std::size_t most_looks = 400'000'000;

/// Segment in the plane of a sheet. The segment is an edge of a triangle of the sheet. Otherwise, it is the
/// intersection of such a triangle with a triangle outside of the plane.
struct SheetSegment {
  std::array<PointId, 2> ends{};
  Cut cut;
  bool is_edge = false;
  std::vector<PointId> points;  ///< points on the segment, without its ends
};

/// Triangles in one plane that overlap; usually only one triangle.
struct Sheet {
  std::vector<std::uint32_t> members;
  FlatTriangle first;  ///< the first triangle of the sheet
  std::vector<SheetSegment> segments;
  std::vector<PointId> points;
  bool is_crossed = false;  ///< true if the crossings of its segments have been found
};

class Cutter {
 public:
  Cutter(const CrossedMesh& mesh, CutMesh& out, const Context& context)
      : mesh_(mesh), space_(out.space), context_(context), facets_(out.facets), sheet_of_(out.sheet_of) {
    sheet_of_.assign(mesh.triangles.size(), nobody);
  }

  /// Cuts the triangles into facets (parts of triangles).
  /// @returns the number of triangles that were cut.
  std::size_t cut() {
    std::vector<std::uint32_t> involved;
    for (const TrianglePair& pair : mesh_.pairs) {
      involved.push_back(pair.first.value);
      involved.push_back(pair.second.value);
    }
    std::sort(involved.begin(), involved.end());
    involved.erase(std::unique(involved.begin(), involved.end()), involved.end());
    make_sheets(involved);
    add_flat_triangles();
    do {
      for (Sheet& sheet : sheets_) cross_segments(sheet);
      while (pass_over_flat_triangles()) {
      }
    } while (add_triangles_at_cut_edges());
    std::size_t count = 0;
    for (std::uint32_t s = 0; s < sheets_.size(); ++s) {
      throw_if_cancelled(context_);
      count += sheets_[s].members.size();
      add_facets(s);
    }
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (mesh_.is_flat[t] != 0 || sheet_of_[t] != nobody) continue;
      sheet_of_[t] = static_cast<std::uint32_t>(sheets_.size() + t);
      facets_.push_back({mesh_.triangles[t], 1, t, sheet_of_[t]});
    }
    return count;
  }

 private:
  void make_sheets(const std::vector<std::uint32_t>& involved) {
    std::unordered_map<std::uint32_t, std::uint32_t> place;
    std::vector<FlatTriangle> flat;
    for (std::uint32_t k = 0; k < involved.size(); ++k) {
      place[involved[k]] = k;
      flat.push_back(flattened(space_, mesh_.triangles[involved[k]]));
    }
    UnionFind joined(involved.size());
    std::vector<std::pair<std::uint32_t, SheetSegment>> segments;
    std::vector<std::pair<std::uint32_t, PointId>> points;
    std::size_t done = 0;
    for (const TrianglePair& pair : mesh_.pairs) {
      constexpr std::size_t often = 1024;
      if (done++ % often == 0) throw_if_cancelled(context_);
      const std::array<std::uint32_t, 2> two{place.at(pair.first.value), place.at(pair.second.value)};
      const Contact3 contact = contact_of(space_, flat[two[0]], flat[two[1]], edge_points_);
      if (contact.is_coplanar) joined.join(two[0], two[1]);
      for (std::size_t k = 0; k < 2 && contact.count > 0; ++k) {
        for (std::size_t p = 0; p < contact.count; ++p) points.emplace_back(two[k], contact.points[p]);
        if (contact.count < 2) continue;
        segments.push_back({two[k], {contact.points, flat[two[1 - k]].plane(), false, {}}});
      }
    }
    std::vector<std::uint32_t> sheet(involved.size(), nobody);
    for (std::uint32_t k = 0; k < involved.size(); ++k) {
      const std::uint32_t r = joined.find(k);
      sheet[k] = r == k ? new_sheet() : sheet[r];
      add_member(sheet[k], involved[k]);
    }
    for (auto& [k, segment] : segments) sheets_[sheet[k]].segments.push_back(std::move(segment));
    for (const auto& [k, p] : points) sheets_[sheet[k]].points.push_back(p);
  }

  std::uint32_t new_sheet() {
    sheets_.emplace_back();
    return static_cast<std::uint32_t>(sheets_.size() - 1);
  }

  void add_member(std::uint32_t s, std::uint32_t triangle) {
    Sheet& sheet = sheets_[s];
    sheet_of_[triangle] = s;
    const Triangle& corners = mesh_.triangles[triangle];
    if (sheet.members.empty()) sheet.first = flattened(space_, corners);
    sheet.members.push_back(triangle);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<PointId, 2> ends{corners[k], corners[(k + 1) % 3]};
      sheet.points.push_back(corners[k]);
      sheet.segments.push_back({ends, {{ends[0], ends[1], 0}, static_cast<int>(sheet.first.axis)}, true, {}});
    }
  }

  /// Returns true if a point of a line lies between two points of the line or is one of them.
  [[nodiscard]] bool is_between(const std::array<PointId, 2>& ends, PointId p) const {
    return space_.compare(ends[0], p) * space_.compare(p, ends[1]) >= 0;
  }

  [[nodiscard]] Box3 box_of(const SheetSegment& segment) const {
    Box3 box;
    for (const PointId p : segment.ends) box.extend(space_.rounded(p));
    return box;
  }

  static bool overlap(const Box3& a, const Box3& b) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (a.upper[k] < b.lower[k] || b.upper[k] < a.lower[k]) return false;
    }
    return true;
  }

  /// Finds the points where segments of a sheet cross each other, and the points on edges of its triangles.
  void cross_segments(Sheet& sheet) {
    if (std::exchange(sheet.is_crossed, true)) return;
    std::vector<Box3> boxes;
    std::vector<std::uint32_t> order(sheet.segments.size());
    for (std::uint32_t k = 0; k < order.size(); ++k) {
      order[k] = k;
      boxes.push_back(box_of(sheet.segments[k]));
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(boxes[a].lower.x, a) < std::pair(boxes[b].lower.x, b);
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
      throw_if_cancelled(context_);
      for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].lower.x <= boxes[order[i]].upper.x; ++j) {
        if (++looks_ > most_looks) throw Unresolved("too many triangles cross the same triangle");
        if (overlap(boxes[order[i]], boxes[order[j]])) cross(sheet, order[i], order[j]);
      }
    }
    std::sort(sheet.points.begin(), sheet.points.end());
    sheet.points.erase(std::unique(sheet.points.begin(), sheet.points.end()), sheet.points.end());
    for (std::size_t k = 0; k < sheet.segments.size(); ++k) {
      const SheetSegment& segment = sheet.segments[k];
      if (!segment.is_edge) continue;
      for (const PointId p : sheet.points) {
        if (lies_on(segment, boxes[k], p)) edge_points_.add(segment.ends[0], segment.ends[1], p);
      }
    }
  }

  /// Returns true if a point of the sheet lies on a segment, but is not an end of it.
  [[nodiscard]] bool lies_on(const SheetSegment& segment, const Box3& box, PointId p) const {
    if (p == segment.ends[0] || p == segment.ends[1]) return false;
    const Vec3d& at = space_.rounded(p);
    for (std::size_t k = 0; k < 3; ++k) {
      if (at[k] < box.lower[k] || at[k] > box.upper[k]) return false;
    }
    return space_.side(segment.cut, p) == 0 && is_between(segment.ends, p);
  }

  void cross(Sheet& sheet, std::uint32_t i, std::uint32_t j) {
    const SheetSegment& a = sheet.segments[i];
    const SheetSegment& b = sheet.segments[j];
    for (const PointId p : a.ends) {
      if (p == b.ends[0] || p == b.ends[1]) return;  // they share an end, or lie on one line
    }
    if (space_.side(a.cut, b.ends[0]) * space_.side(a.cut, b.ends[1]) >= 0) return;
    if (space_.side(b.cut, a.ends[0]) * space_.side(b.cut, a.ends[1]) >= 0) return;
    const PointId p = space_.meet(sheet.first.plane(), a.cut, b.cut);
    sheet.points.push_back(p);
  }

  /// Cuts the longest edge of each flat triangle at the triangle's middle corner.
  void add_flat_triangles() {
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (mesh_.is_flat[t] != 1) continue;
      std::array<PointId, 3> c = mesh_.triangles[t];
      std::sort(c.begin(), c.end(), [&](PointId a, PointId b) { return space_.compare(a, b) < 0; });
      edge_points_.add(c[0], c[2], c[1]);
      flat_.push_back(c);
    }
  }

  /// If a point cuts an edge of a flat triangle, it must also cut another edge of that triangle. Returns true if a new
  /// cut was added.
  bool pass_over_flat_triangles() {
    bool is_new = false;
    for (const auto& [a, b, c] : flat_) {
      for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}}) {
        const std::span<const PointId> points = edge_points_.of(from, to);
        for (const PointId p : std::vector<PointId>(points.begin(), points.end())) {
          is_new = edge_points_.add(a, c, p) || is_new;
        }
      }
      const std::span<const PointId> points = edge_points_.of(a, c);
      for (const PointId p : std::vector<PointId>(points.begin(), points.end())) {
        if (p == b) continue;
        const bool is_below = space_.compare(p, b) < 0;
        is_new = edge_points_.add(is_below ? a : b, is_below ? b : c, p) || is_new;
      }
    }
    return is_new;
  }

  /// Marks triangles with a cut edge to be cut, too. Returns true if any was added.
  bool add_triangles_at_cut_edges() {
    if (edge_points_.empty()) return false;
    bool is_new = false;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (mesh_.is_flat[t] != 0 || sheet_of_[t] != nobody) continue;
      const Triangle& corners = mesh_.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        if (edge_points_.of(corners[k], corners[(k + 1) % 3]).empty()) continue;
        add_member(new_sheet(), t);
        is_new = true;
        break;
      }
    }
    return is_new;
  }

  void add_facets(std::uint32_t s) {
    Sheet& sheet = sheets_[s];
    for (const SheetSegment& segment : sheet.segments) {
      if (!segment.is_edge) continue;
      for (const PointId p : edge_points_.of(segment.ends[0], segment.ends[1])) sheet.points.push_back(p);
    }
    std::sort(sheet.points.begin(), sheet.points.end());
    sheet.points.erase(std::unique(sheet.points.begin(), sheet.points.end()), sheet.points.end());
    const std::vector<std::array<PointId, 3>> triangles = triangulated(sheet);
    std::vector<FlatTriangle> members;
    for (const std::uint32_t t : sheet.members)
      members.push_back(seen_along(space_, mesh_.triangles[t], sheet.first.axis));
    const bool is_single = members.size() == 1;
    // For each member triangle and each point of the sheet: true if the point lies in the triangle.
    std::vector<std::vector<bool>> holds(members.size(), std::vector<bool>(sheet.points.size(), is_single));
    for (std::size_t m = 0; m < members.size() && !is_single; ++m) {
      for (std::size_t k = 0; k < sheet.points.size(); ++k) {
        holds[m][k] = contains(space_, members[m], sheet.points[k]);
      }
    }
    for (const std::array<PointId, 3>& corners : triangles) {
      Facet facet{corners, 0, nobody, s};
      // First member triangles that face up and down.
      std::uint32_t up = nobody;
      std::uint32_t down = nobody;
      for (std::size_t m = 0; m < members.size(); ++m) {
        const bool is_in = std::all_of(corners.begin(), corners.end(), [&](PointId p) {
          const auto at = std::lower_bound(sheet.points.begin(), sheet.points.end(), p);
          return holds[m][static_cast<std::size_t>(at - sheet.points.begin())];
        });
        if (!is_in) continue;
        facet.times += members[m].turn;
        std::uint32_t& first = members[m].turn > 0 ? up : down;
        if (first == nobody) first = sheet.members[m];
      }
      if (facet.times == 0) continue;
      facet.source = facet.times > 0 ? up : down;
      if (facet.times < 0) std::swap(facet.corners[1], facet.corners[2]);
      facet.times = std::abs(facet.times);
      facets_.push_back(facet);
    }
  }

  /// Returns triangles between the points of a sheet, counter-clockwise seen against its axis. If the sheet has one
  /// triangle, the result fills it exactly, because no point lies outside. If the sheet has several triangles, the
  /// result may also fill gaps between them.
  std::vector<std::array<PointId, 3>> triangulated(const Sheet& sheet) {
    if (sheet.points.size() == 3 && sheet.members.size() == 1) {
      std::array<PointId, 3> corners = sheet.first.corners;
      if (sheet.first.turn < 0) std::swap(corners[1], corners[2]);
      return {corners};
    }
    const std::size_t axis = sheet.first.axis;
    PlanarMesh plane(space_, axis, space_.corners_around(axis));
    std::vector<PointId> points = sheet.points;
    std::sort(points.begin(), points.end(), [&](PointId a, PointId b) { return space_.compare(a, b) < 0; });
    for (const PointId p : points) {
      throw_if_cancelled(context_);
      if (!plane.insert(p)) throw Unresolved("two points of a triangle coincide");
    }
    std::set<std::array<PointId, 2>> pieces;
    for (const SheetSegment& segment : sheet.segments) add_pieces(sheet, segment, pieces);
    for (const auto& [from, to] : pieces) {
      throw_if_cancelled(context_);
      if (!plane.insert_segment(from, to)) throw Unresolved("a triangle could not be cut along its crossings");
    }
    plane.improve();
    return plane.triangles();
  }

  void add_pieces(const Sheet& sheet, const SheetSegment& segment, std::set<std::array<PointId, 2>>& pieces) {
    throw_if_cancelled(context_);
    const Box3 box = box_of(segment);
    std::vector<PointId> on{segment.ends[0], segment.ends[1]};
    for (const PointId p : sheet.points) {
      if (lies_on(segment, box, p)) on.push_back(p);
    }
    std::sort(on.begin(), on.end(), [&](PointId a, PointId b) { return space_.compare(a, b) < 0; });
    for (std::size_t k = 0; k + 1 < on.size(); ++k)
      pieces.insert({std::min(on[k], on[k + 1]), std::max(on[k], on[k + 1])});
  }

  const CrossedMesh& mesh_;
  ExactSpace& space_;
  const Context& context_;
  std::vector<Facet>& facets_;
  std::vector<std::uint32_t>& sheet_of_;
  std::vector<Sheet> sheets_;
  EdgePoints edge_points_;
  std::vector<std::array<PointId, 3>> flat_;
  std::size_t looks_ = 0;
};

/// Returns the corners of triangles that cross, touch or are flat. Includes the corners of triangles with at least two
/// such corners.
std::vector<PointId> corners_near_crossings(const CrossedMesh& mesh) {
  std::vector<bool> is_near(mesh.vertices.size(), false);
  const auto mark = [&](std::uint32_t t) {
    for (const PointId v : mesh.triangles[t]) is_near[v] = true;
  };
  for (const TrianglePair& pair : mesh.pairs) {
    mark(pair.first.value);
    mark(pair.second.value);
  }
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.is_flat[t] != 0) mark(t);
  }
  std::vector<PointId> used;
  for (const Triangle& t : mesh.triangles) {
    if (std::count_if(t.begin(), t.end(), [&](PointId v) { return is_near[v]; }) < 2) continue;
    used.insert(used.end(), t.begin(), t.end());
  }
  return used;
}

}  // namespace

FlatTriangle seen_along(const ExactSpace& space, const Triangle& triangle, std::size_t axis) {
  return {triangle, axis, space.turn(axis, triangle[0], triangle[1], triangle[2])};
}

FlatTriangle flattened(const ExactSpace& space, const Triangle& triangle) {
  const Vec3d& a = space.rounded(triangle[0]);
  const Vec3d normal = cross(space.rounded(triangle[1]) - a, space.rounded(triangle[2]) - a);
  std::array<std::size_t, 3> axes{0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](std::size_t i, std::size_t j) {
    return std::pair(-std::abs(normal[i]), i) < std::pair(-std::abs(normal[j]), j);
  });
  FlatTriangle out;
  for (const std::size_t axis : axes) {
    out = seen_along(space, triangle, axis);
    if (out.turn != 0) break;
  }
  return out;
}

bool contains(const ExactSpace& space, const FlatTriangle& triangle, PointId p) {
  for (std::size_t k = 0; k < 3; ++k) {
    const PointId from = triangle.corners[k];
    const PointId to = triangle.corners[(k + 1) % 3];
    if (p == from || p == to) continue;
    if (triangle.turn * space.turn(triangle.axis, from, to, p) < 0) return false;
  }
  return true;
}

std::uint64_t EdgePoints::key(PointId from, PointId to) {
  return (static_cast<std::uint64_t>(std::min(from, to)) << 32U) | std::max(from, to);
}

bool EdgePoints::add(PointId from, PointId to, PointId p) {
  if (p == from || p == to) return false;
  std::vector<PointId>& points = of_edge_[key(from, to)];
  if (std::find(points.begin(), points.end(), p) != points.end()) return false;
  points.push_back(p);
  return true;
}

std::span<const PointId> EdgePoints::of(PointId from, PointId to) const {
  const auto found = of_edge_.find(key(from, to));
  return found == of_edge_.end() ? std::span<const PointId>{} : found->second;
}

Contact3 contact_of(ExactSpace& space, const FlatTriangle& a, const FlatTriangle& b, EdgePoints& edge_points) {
  Contact3 out;
  const Signs b_sides = sides(space, a, b);
  if (b_sides == Signs{0, 0, 0}) {
    out.is_coplanar = true;
    return out;
  }
  Collector collector(space, edge_points, out);
  collector.collect(a, sides(space, b, a), b);
  collector.collect(b, b_sides, a);
  return out;
}

CutMesh cut_triangles(const CrossedMesh& mesh, const Context& context) {
  const std::vector<PointId> used = corners_near_crossings(mesh);
  try {
    CutMesh out{ExactSpace(mesh.vertices, used)};
    out.cut = Cutter(mesh, out, context).cut();
    return out;
  } catch (const std::range_error& error) {
    throw Unresolved(error.what());
  }
}

}  // namespace blum::detail
