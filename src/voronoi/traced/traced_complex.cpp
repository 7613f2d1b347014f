#include "voronoi/traced/traced_complex.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/union_find.hpp"
#include "blum/geometry/box_bvh.hpp"
#include "blum/geometry/closest_point.hpp"
#include "blum/geometry/plane_polygon.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/traced/seam_tracer.hpp"
#include "voronoi/traced/sheet_triangles.hpp"
#include "voronoi/traced/wall_map.hpp"

namespace blum::voronoi {
namespace {

using Index = TracedSites::Index;
using Sheet = TracedStructure::Sheet;
constexpr std::uint32_t none = TracedStructure::none;

/// A point of the complex.
struct Vertex {
  Vec3d at;
  std::vector<Index> sites;  ///< closest sites; empty on the surface
  std::uint32_t on = none;   ///< vertex of the mesh, on the surface
  bool is_junction = false;
  std::uint32_t edge = none;  ///< edge of the mesh that contains the point, if it is not an end of it
  double share = 0;           ///< of the way along that edge
};

class Assembly {
 public:
  Assembly(const MeshView& mesh, const SiteTable& table, const TracedSites& sites, const TracedStructure& structure,
           VoronoiPart part, double chord, double longest, const Context& context)
      : mesh_(mesh),
        table_(table),
        sites_(sites),
        structure_(structure),
        part_(part),
        chord_(chord),
        longest_(longest),
        context_(context),
        tracer_(sites, work_) {}

  std::optional<Complex> build() {
    list_triangles();
    for (const TracedStructure::Junction& junction : structure_.junctions) {
      vertices_.push_back({junction.at, junction.sites, junction.vertex, false});
    }
    for (const TracedStructure::Curve& curve : structure_.curves) add_curve(curve);
    const std::vector<Sheet> sheets = joined_sheets();
    refine_curves(sheets);
    for (const Sheet& sheet : sheets) {
      if (part_ == VoronoiPart::medial_axis && is_domain_wall(sheet)) continue;
      if (!add_sheet(sheet)) return std::nullopt;
      throw_if_cancelled(context_);
    }
    if (part_ == VoronoiPart::all) add_surface();
    if (part_ == VoronoiPart::medial_axis) part_at_surface();
    return finish();
  }

 private:
  /// Lists the triangles of each face.
  void list_triangles() {
    triangles_of_.resize(sites_.size());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) triangles_of_[sites_.face_of(t)].push_back(t);
    boxes_of_.resize(sites_.size());
    for (std::size_t i = 0; i < triangles_of_.size(); ++i) {
      // A box tree takes longer than a short list.
      constexpr std::size_t many = 24;
      if (triangles_of_[i].size() <= many) continue;
      std::vector<Box3> boxes(triangles_of_[i].size());
      for (std::size_t k = 0; k < boxes.size(); ++k) {
        for (const Vec3d& corner : corners_of(triangles_of_[i][k])) boxes[k].extend(corner);
      }
      boxes_of_[i].emplace(boxes);
    }
  }

  /// Adds the points of a curve between its ends.
  void add_curve(const TracedStructure::Curve& curve) {
    std::vector<std::uint32_t>& list = points_of_curve_.emplace_back();
    list.push_back(curve.ends[0]);
    if (curve.is_edge) {
      add_edge(curve, list);
    } else {
      vertices_[curve.ends[0]].is_junction = vertices_[curve.ends[1]].is_junction = true;
      std::vector<Vec3d> dense{curve.points[0]};
      for (std::size_t k = 1; k < curve.points.size(); ++k) {
        divide(curve, curve.points[k - 1], curve.points[k], 0, dense);
      }
      std::vector<bool> is_kept(dense.size(), false);
      is_kept.front() = is_kept.back() = true;
      std::vector<double> radii;
      for (const Vec3d& x : dense) radii.push_back(sites_.distance(curve.curve.sites[0], x));
      keep(dense, radii, 0, dense.size() - 1, is_kept);
      for (std::size_t k = 1; k + 1 < dense.size(); ++k) {
        if (!is_kept[k]) continue;
        list.push_back(static_cast<std::uint32_t>(vertices_.size()));
        vertices_.push_back({dense[k], curve.curve.sites, none, false});
      }
    }
    list.push_back(curve.ends[1]);
  }

  /// Adds points of an edge of the polyhedron between its ends, where a sheet of the medial axis ends.
  void add_edge(const TracedStructure::Curve& curve, std::vector<std::uint32_t>& list) {
    if (part_ != VoronoiPart::medial_axis) return;
    const Vertex& from = vertices_[curve.ends[0]];
    const Vertex& to = vertices_[curve.ends[1]];
    const Vec3d start = from.at;
    const Vec3d way = to.at - start;
    const Segment ends{std::min(from.on, to.on), std::max(from.on, to.on)};
    const std::span<const Segment> edges = table_.edges();
    const auto edge = static_cast<std::uint32_t>(std::lower_bound(edges.begin(), edges.end(), ends) - edges.begin());
    const auto pieces = static_cast<std::size_t>(std::ceil(length(way) / longest_));
    const bool is_turned = from.on > to.on;
    for (std::size_t k = 1; k < pieces; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(pieces);
      list.push_back(static_cast<std::uint32_t>(vertices_.size()));
      vertices_.push_back({start + way * share, {}, none, false, edge, is_turned ? 1 - share : share});
    }
  }

  /// Adds points of a curve after a, up to b, so that chords are close to the curve.
  void divide(const TracedStructure::Curve& curve, const Vec3d& a, const Vec3d& b, int depth,
              std::vector<Vec3d>& out) const {
    constexpr int most_depth = 12;
    const Vec3d way = b - a;
    const double size = length(way);
    if (depth < most_depth && size > chord_) {
      const Vec3d middle = a + way * 0.5;
      const auto found = tracer_.point_in_plane(curve.curve, middle, way / size);
      const auto radius = [&](const Vec3d& x) { return sites_.distance(curve.curve.sites[0], x); };
      const double away = found ? length(*found - middle) : 0;
      if (found && away < size &&
          (away > 0.5 * chord_ || std::abs(radius(*found) - 0.5 * (radius(a) + radius(b))) > 0.5 * chord_)) {
        divide(curve, a, *found, depth + 1, out);
        divide(curve, *found, b, depth + 1, out);
        return;
      }
    }
    out.push_back(b);
  }

  /// Marks the points that a polyline needs to stay within half the chord, in place and radius (Douglas and Peucker
  /// 1973).
  void keep(const std::vector<Vec3d>& points, const std::vector<double>& radii, std::size_t first, std::size_t last,
            std::vector<bool>& is_kept) const {
    if (last - first < 2) return;
    const Vec3d way = points[last] - points[first];
    const double squared = squared_length(way);
    double most = 0;
    std::size_t furthest = first + 1;
    for (std::size_t k = first + 1; k < last; ++k) {
      const Vec3d step = points[k] - points[first];
      const double share = squared > 0 ? std::clamp(dot(step, way) / squared, 0.0, 1.0) : 0;
      const double radius = radii[first] + share * (radii[last] - radii[first]);
      const double away = std::max(length(step - way * share), std::abs(radii[k] - radius));
      if (away > most) {
        most = away;
        furthest = k;
      }
    }
    if (most <= 0.5 * chord_) return;
    is_kept[furthest] = true;
    keep(points, radii, first, furthest, is_kept);
    keep(points, radii, furthest, last, is_kept);
  }

  /// Divides seams until their pieces are close to the sheets' maps of straight pieces in the plane. Otherwise,
  /// triangles at the boundary would overlap.
  void refine_curves(const std::vector<Sheet>& sheets) {
    constexpr int most_passes = 12;
    std::vector<bool> is_new(structure_.curves.size(), true);
    for (int pass = 0; pass < most_passes; ++pass) {
      std::vector<std::vector<bool>> is_split(structure_.curves.size());
      for (std::size_t c = 0; c < is_split.size(); ++c) is_split[c].resize(points_of_curve_[c].size() - 1);
      for (const Sheet& sheet : sheets) mark_pieces(sheet, is_new, is_split);
      for (std::size_t c = 0; c < is_split.size(); ++c) {
        for (std::size_t k = 0; k < is_split[c].size() && !structure_.curves[c].is_edge; ++k) {
          const std::vector<std::uint32_t>& list = points_of_curve_[c];
          if (length(vertices_[list[k + 1]].at - vertices_[list[k]].at) > longest_) is_split[c][k] = true;
        }
      }
      bool is_any = false;
      for (std::size_t c = 0; c < is_split.size(); ++c) {
        is_new[c] = split(structure_.curves[c], is_split[c], points_of_curve_[c]);
        is_any = is_any || is_new[c];
      }
      if (!is_any) return;
    }
  }

  /// Marks the pieces of a sheet's boundary whose middle in the plane is too far from their own middle.
  void mark_pieces(const Sheet& sheet, const std::vector<bool>& is_new,
                   std::vector<std::vector<bool>>& is_split) const {
    for (const std::vector<TracedStructure::Side>& loop : sheet.loops) {
      if (vertices_of(loop).size() > 2) continue;
      // A lens between two seams needs corners inside them.
      for (const TracedStructure::Side& side : loop) {
        if (!structure_.curves[side.curve].is_edge) is_split[side.curve].assign(is_split[side.curve].size(), true);
      }
    }
    const std::optional<Vec3d> normal = normal_of(sheet);
    if (normal) return;
    const WallMap map(sites_, sheet.first, sheet.second, normal, points_of(sheet.loops[0]));
    for (const std::vector<TracedStructure::Side>& loop : sheet.loops) {
      for (const TracedStructure::Side& side : loop) {
        if (!is_new[side.curve] || structure_.curves[side.curve].is_edge) continue;
        const std::vector<std::uint32_t>& list = points_of_curve_[side.curve];
        for (std::size_t k = 1; k < list.size(); ++k) {
          const Vec3d& a = vertices_[list[k - 1]].at;
          const Vec3d& b = vertices_[list[k]].at;
          const WallMap::Point p = map.to_plane(a), q = map.to_plane(b);
          const Vec3d middle = map.from_plane({0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])});
          const double away = length(middle - 0.5 * (a + b));
          if (away > chord_ && away > 0.02 * length(b - a)) is_split[side.curve][k - 1] = true;
        }
      }
    }
  }

  /// Divides marked pieces of a curve. Returns true if there are any.
  bool split(const TracedStructure::Curve& curve, const std::vector<bool>& is_split, std::vector<std::uint32_t>& list) {
    if (std::none_of(is_split.begin(), is_split.end(), [](bool marked) { return marked; })) return false;
    std::vector<std::uint32_t> out{list[0]};
    bool is_any = false;
    for (std::size_t k = 1; k < list.size(); ++k) {
      const Vec3d a = vertices_[list[k - 1]].at;
      const Vec3d way = vertices_[list[k]].at - a;
      const double size = length(way);
      if (is_split[k - 1] && size > 16 * sites_.tolerance()) {
        const auto found = tracer_.point_in_plane(curve.curve, a + way * 0.5, way / size);
        if (found && length(*found - a) < size) {
          out.push_back(static_cast<std::uint32_t>(vertices_.size()));
          vertices_.push_back({*found, curve.curve.sites, none, false});
          is_any = true;
        }
      }
      out.push_back(list[k]);
    }
    list = std::move(out);
    return is_any;
  }

  [[nodiscard]] std::vector<std::uint32_t> vertices_of(const std::vector<TracedStructure::Side>& loop) const {
    std::vector<std::uint32_t> out;
    for (const TracedStructure::Side& side : loop) {
      std::vector<std::uint32_t> list = points_of_curve_[side.curve];
      if (!side.is_forward) std::reverse(list.begin(), list.end());
      out.insert(out.end(), list.begin(), list.end() - 1);
    }
    return out;
  }

  /// Returns a point inside the longest curve of a sheet's boundary inside the solid.
  [[nodiscard]] Vec3d point_of(const Sheet& sheet) const {
    Vec3d best;
    double longest = -1;
    for (const TracedStructure::Side& side : sheet.loops[0]) {
      const TracedStructure::Curve& curve = structure_.curves[side.curve];
      if (curve.is_edge) continue;
      for (std::size_t k = 1; k < curve.points.size(); ++k) {
        const double size = squared_length(curve.points[k] - curve.points[k - 1]);
        if (size <= longest) continue;
        longest = size;
        best = 0.5 * (curve.points[k] + curve.points[k - 1]);
      }
    }
    return best;
  }

  /// Returns true if a site's own border separates its region from that of its neighbour: both have one footprint.
  [[nodiscard]] bool is_domain_wall(const Sheet& sheet) const {
    return sites_.side_between(sheet.first, sheet.second) != nullptr;
  }

  /// Returns the normal of a planar sheet.
  [[nodiscard]] std::optional<Vec3d> normal_of(const Sheet& sheet) const {
    const TracedSite& a = sites_[sheet.first];
    const TracedSite& b = sites_[sheet.second];
    if (const DomainSide* side = sites_.side_between(sheet.first, sheet.second)) return side->normal;
    if (a.kind == SiteKind::face && b.kind == SiteKind::face) return unit(a.direction - b.direction);
    if (a.kind == SiteKind::vertex && b.kind == SiteKind::vertex) return unit(a.point - b.point);
    const TracedSurface surface = tracer_.between(sheet.first, sheet.second, point_of(sheet));
    if (!surface.is_plane()) return std::nullopt;
    // Two edges from one vertex have two planes between them, at right angles. Where both footprints are the vertex,
    // rounding decides; the boundary shows which plane it is.
    const Vec3d other = cross(surface.normal, cross(a.direction, b.direction));
    if (!(length(other) > 0)) return surface.normal;
    const auto height = [&](const Vec3d& normal) {
      double most = 0;
      for (const Vec3d& x : points_of(sheet.loops[0])) most = std::max(most, std::abs(dot(normal, x - surface.point)));
      return most;
    };
    const Vec3d second = unit(other);
    return height(second) < height(surface.normal) ? second : surface.normal;
  }

  [[nodiscard]] std::vector<Vec3d> points_of(const std::vector<TracedStructure::Side>& loop) const {
    std::vector<Vec3d> out;
    for (const std::uint32_t v : vertices_of(loop)) out.push_back(vertices_[v].at);
    return out;
  }

  /// Returns the sheets. Loops of one pair of sites are one sheet if one encloses the others.
  [[nodiscard]] std::vector<Sheet> joined_sheets() const {
    std::map<std::pair<Index, Index>, std::vector<std::size_t>> by_pair;
    for (std::size_t k = 0; k < structure_.sheets.size(); ++k) {
      by_pair[{structure_.sheets[k].first, structure_.sheets[k].second}].push_back(k);
    }
    std::vector<Sheet> out;
    for (const auto& [pair, list] : by_pair) {
      if (list.size() == 1) {
        out.push_back(structure_.sheets[list[0]]);
      } else {
        join(list, out);
      }
    }
    return out;
  }

  void join(const std::vector<std::size_t>& list, std::vector<Sheet>& out) const {
    struct Loop {
      std::size_t sheet;
      std::vector<WallMap::Point> plane;
      double area;
      std::size_t depth = 0;
      std::size_t parent = static_cast<std::size_t>(-1);
    };
    std::vector<Loop> loops;
    // Sheets of one pair may lie in two planes.
    std::vector<Vec3d> sample;
    for (const std::size_t k : list) {
      for (const Vec3d& x : points_of(structure_.sheets[k].loops[0])) sample.push_back(x);
    }
    std::vector<std::optional<Vec3d>> normals;
    for (const std::size_t k : list) normals.push_back(normal_of(structure_.sheets[k]));
    for (std::size_t k = 0; k < list.size(); ++k) {
      const std::vector<Vec3d> points = points_of(structure_.sheets[list[k]].loops[0]);
      const WallMap map(sites_, structure_.sheets[list[k]].first, structure_.sheets[list[k]].second, normals[k],
                        sample);
      Loop loop{list[k], {}, 0};
      for (const Vec3d& x : points) loop.plane.push_back(map.to_plane(x));
      loop.area = std::abs(detail::doubled_area(loop.plane));
      loops.push_back(std::move(loop));
    }
    const auto is_same_plane = [&](std::size_t a, std::size_t b) {
      return !normals[a] || length(cross(*normals[a], *normals[b])) < 1e-6;
    };
    for (std::size_t a = 0; a < loops.size(); ++a) {
      for (std::size_t b = 0; b < loops.size(); ++b) {
        if (a == b || !(loops[b].area > loops[a].area) || !is_same_plane(a, b)) continue;
        if (!is_inside(loops[a].plane, loops[b].plane)) continue;
        ++loops[a].depth;
        if (loops[a].parent == static_cast<std::size_t>(-1) || loops[b].area < loops[loops[a].parent].area) {
          loops[a].parent = b;
        }
      }
    }
    std::vector<std::size_t> number(loops.size());
    for (std::size_t a = 0; a < loops.size(); ++a) {
      if (loops[a].depth % 2 != 0) continue;
      number[a] = out.size();
      out.push_back(structure_.sheets[loops[a].sheet]);
    }
    for (const Loop& loop : loops) {
      if (loop.depth % 2 != 0) out[number[loop.parent]].loops.push_back(structure_.sheets[loop.sheet].loops[0]);
    }
  }

  /// Returns true if most points of a loop lie inside another one. The loops do not cross, but may touch.
  static bool is_inside(const std::vector<WallMap::Point>& loop, const std::vector<WallMap::Point>& other) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      // Middles of edges: corners may be common to both loops.
      const WallMap::Point& before = loop[(i + loop.size() - 1) % loop.size()];
      const WallMap::Point p{0.5 * (loop[i][0] + before[0]), 0.5 * (loop[i][1] + before[1])};
      bool is_in = false;
      for (std::size_t k = 0; k < other.size(); ++k) {
        const WallMap::Point& a = other[k];
        const WallMap::Point& b = other[(k + 1) % other.size()];
        if ((a[1] > p[1]) == (b[1] > p[1])) continue;
        if (p[0] < a[0] + (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1])) is_in = !is_in;
      }
      if (is_in) ++count;
    }
    return 2 * count > loop.size();
  }

  bool add_sheet(const Sheet& sheet) {
    std::vector<std::vector<Vec3d>> loops;
    std::vector<std::uint32_t> number;
    for (const std::vector<TracedStructure::Side>& loop : sheet.loops) {
      const std::vector<std::uint32_t> list = vertices_of(loop);
      number.insert(number.end(), list.begin(), list.end());
      loops.push_back(points_of(loop));
      if (list.size() < 3) return false;
    }
    const WallMap map(sites_, sheet.first, sheet.second, normal_of(sheet), loops[0]);
    std::optional<SheetTriangles> made = sheet_triangles(map, loops, chord_, longest_, context_);
    if (!made && loops.size() == 1) made = narrow_sheet_triangles(map, loops[0], chord_, context_);
    if (!made) return false;
    std::vector<Index> pair{std::min(sheet.first, sheet.second), std::max(sheet.first, sheet.second)};
    for (std::size_t k = number.size(); k < made->points.size(); ++k) {
      number.push_back(static_cast<std::uint32_t>(vertices_.size()));
      vertices_.push_back({made->points[k], pair, none, false});
    }
    const bool is_turned = is_along_boundary(made->triangles) != loop_faces_second(sheet);
    for (Triangle t : made->triangles) {
      if (is_turned) std::swap(t[1], t[2]);
      const Vec3d middle = (made->points[t[0]] + made->points[t[1]] + made->points[t[2]]) / 3.0;
      const double angle = is_domain_wall(sheet) ? 0
                                                 : degrees_between(sites_.gradient(sheet.first, middle),
                                                                   sites_.gradient(sheet.second, middle));
      add_triangle({number[t[0]], number[t[1]], number[t[2]]}, sites_[sheet.first].number, sites_[sheet.second].number,
                   angle);
    }
    return true;
  }

  /// Returns true if triangles run in the direction of the outer loop: the first edge of the loop is one of theirs.
  static bool is_along_boundary(const std::vector<Triangle>& triangles) {
    return std::any_of(triangles.begin(), triangles.end(), [](const Triangle& t) {
      return (t[0] == 0 && t[1] == 1) || (t[1] == 0 && t[2] == 1) || (t[2] == 0 && t[0] == 1);
    });
  }

  /// Returns true if triangles that run in the direction of the outer loop face the region of the sheet's second site.
  [[nodiscard]] bool loop_faces_second(const Sheet& sheet) const {
    for (const TracedStructure::Side& side : sheet.loops[0]) {
      const std::vector<RegionRing::Germ>& germs = structure_.curves[side.curve].ring.germs;
      const auto has_pair = [&](const RegionRing::Germ& germ) {
        return std::minmax(germ.before, germ.after) == std::minmax(sheet.first, sheet.second);
      };
      if (std::count_if(germs.begin(), germs.end(), has_pair) != 1) continue;
      // Seen from the tip of the curve, the region after the wall is counterclockwise of it.
      const auto germ = std::find_if(germs.begin(), germs.end(), has_pair);
      return side.is_forward == (germ->after == sheet.second);
    }
    return true;
  }

  void add_surface() {
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Triangle& corners = mesh_.triangles[t];
      // Seen from the region, corners run clockwise in the mesh.
      add_triangle({corners[0], corners[2], corners[1]}, -1, sites_[sites_.face_of(t)].number, 0);
    }
  }

  /// Gives sheets that share only a vertex of the polyhedron vertices of their own. Points of the medial axis lie
  /// inside the solid, so its sheets are not connected there.
  void part_at_surface() {
    std::map<std::uint32_t, std::vector<std::pair<std::size_t, std::size_t>>> corners_at;  // (triangle, corner)
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (vertices_[triangles_[t][k]].on != none) corners_at[triangles_[t][k]].emplace_back(t, k);
      }
    }
    for (const auto& [v, corners] : corners_at) {
      detail::UnionFind joined(static_cast<std::uint32_t>(corners.size()));
      std::map<std::uint32_t, std::uint32_t> first;  // corner at each neighbour
      for (std::uint32_t c = 0; c < corners.size(); ++c) {
        const auto& [t, k] = corners[c];
        for (const std::size_t next : {1U, 2U}) {
          const auto [place, is_new] = first.try_emplace(triangles_[t][(k + next) % 3], c);
          if (!is_new) joined.join(place->second, c);
        }
      }
      std::map<std::uint32_t, std::uint32_t> copy{{joined.find(0), v}};
      std::vector<std::uint32_t> own(corners.size());
      for (std::uint32_t c = 0; c < corners.size(); ++c) {
        const auto [place, is_new] = copy.try_emplace(joined.find(c), static_cast<std::uint32_t>(vertices_.size()));
        if (is_new) {
          const Vertex same = vertices_[v];
          vertices_.push_back(same);
        }
        own[c] = place->second;
      }
      for (std::size_t c = 0; c < corners.size(); ++c) triangles_[corners[c].first][corners[c].second] = own[c];
    }
  }

  void add_triangle(const Triangle& corners, std::int32_t a, std::int32_t b, double angle) {
    triangles_.push_back(corners);
    if (a > b) {
      std::swap(a, b);
      std::swap(triangles_.back()[1], triangles_.back()[2]);
    }
    site_a_.push_back(a);
    site_b_.push_back(b);
    angle_.push_back(static_cast<float>(angle));
  }

  [[nodiscard]] std::array<Vec3d, 3> corners_of(std::uint32_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return {sites_.vertices()[a], sites_.vertices()[b], sites_.vertices()[c]};
  }

  /// Returns the element of the mesh that is the footprint on a site.
  [[nodiscard]] SiteId element_at(Index i, const Vec3d& foot) const {
    const TracedSite& site = sites_[i];
    if (site.kind != SiteKind::face) return table_.id({site.kind, site.triangle_or_element});
    std::uint32_t best = triangles_of_[i].front();
    double least = std::numeric_limits<double>::infinity();
    const auto consider = [&](std::uint32_t t) {
      const double squared = squared_length(closest_point_on_triangle(foot, corners_of(t)) - foot);
      if (!(squared < least) && !(squared == least && t < best)) return;
      least = squared;
      best = t;
    };
    if (boxes_of_[i]) {
      boxes_of_[i]->for_each_near(foot, least, [&](std::uint32_t k) {
        consider(triangles_of_[i][k]);
        return (1 + 1e-9) * std::sqrt(least);
      });
    } else {
      for (const std::uint32_t t : triangles_of_[i]) consider(t);
    }
    return table_.id({SiteKind::face, best});
  }

  struct Footprints {
    std::array<Vec3d, 2> at;
    std::array<SiteId, 2> sites;
    double radius = 0;
    double angle = 0;
  };

  [[nodiscard]] Footprints footprints_of(const Vertex& vertex) const {
    Footprints out;
    if (vertex.sites.empty()) {
      const bool is_vertex = vertex.on != none;
      const SiteId own =
          table_.id({is_vertex ? SiteKind::vertex : SiteKind::edge, is_vertex ? vertex.on : vertex.edge});
      return {{vertex.at, vertex.at}, {own, own}, 0, 0};
    }
    std::array<Index, 2> widest{vertex.sites[0], vertex.sites[0]};
    double least = 2;
    for (std::size_t a = 0; a < vertex.sites.size(); ++a) {
      for (std::size_t b = a + 1; b < vertex.sites.size(); ++b) {
        const double cosine =
            dot(sites_.gradient(vertex.sites[a], vertex.at), sites_.gradient(vertex.sites[b], vertex.at));
        if (cosine >= least) continue;
        least = cosine;
        widest = {vertex.sites[a], vertex.sites[b]};
      }
    }
    out.radius = std::max(0.0, sites_.distance(widest[0], vertex.at));
    out.angle = degrees_between(sites_.gradient(widest[0], vertex.at), sites_.gradient(widest[1], vertex.at));
    for (const std::size_t which : {0U, 1U}) {
      out.at[which] = sites_.foot(widest[which], vertex.at);
      out.sites[which] = element_at(widest[which], out.at[which]);
    }
    return out;
  }

  /// Returns the position of a vertex. Vertices of the mesh keep their coordinates.
  [[nodiscard]] Vec3d position_of(const Vertex& vertex) const {
    if (vertex.on != none) return mesh_.vertices[vertex.on];
    if (vertex.edge == none) return vertex.at + sites_.origin();
    const auto& [a, b] = table_.edges()[vertex.edge];
    return mesh_.vertices[a] + (mesh_.vertices[b] - mesh_.vertices[a]) * vertex.share;
  }

  Complex finish() {
    // Vertices of the mesh that nothing uses are left out.
    std::vector<std::uint32_t> number(vertices_.size(), none);
    std::vector<const Vertex*> used;
    for (Triangle& t : triangles_) {
      for (std::uint32_t& v : t) {
        if (number[v] == none) {
          number[v] = static_cast<std::uint32_t>(used.size());
          used.push_back(&vertices_[v]);
        }
        v = number[v];
      }
    }
    Complex out;
    for (const Vertex* vertex : used) {
      out.positions.push_back(position_of(*vertex));
    }
    out.triangles = std::move(triangles_);
    out.vertex_columns = Columns(out.positions.size());
    out.triangle_columns = Columns(out.triangles.size());
    std::vector<Footprints> found;
    for (const Vertex* vertex : used) found.push_back(footprints_of(*vertex));
    const auto fill = [&]<class T>(std::span<T> column, const auto& value) {
      for (std::size_t k = 0; k < used.size(); ++k) column[k] = value(k);
    };
    Columns& columns = out.vertex_columns;
    fill(columns.add<double>(std::string(medial_columns::radius)), [&](std::size_t k) { return found[k].radius; });
    for (const std::size_t which : {0U, 1U}) {
      const std::span<double> column = columns.add<double>(std::string(medial_columns::footprints[which]), 3);
      for (std::size_t k = 0; k < used.size(); ++k) {
        for (std::size_t axis = 0; axis < 3; ++axis)
          column[3 * k + axis] = (found[k].at[which] + sites_.origin())[axis];
      }
    }
    for (const std::size_t which : {0U, 1U}) {
      fill(columns.add<std::int32_t>(std::string(medial_columns::sites[which])),
           [&](std::size_t k) { return static_cast<std::int32_t>(found[k].sites[which].value); });
    }
    fill(columns.add<double>(std::string(medial_columns::separation_angle)),
         [&](std::size_t k) { return found[k].angle; });
    fill(columns.add<std::int32_t>("junction"), [&](std::size_t k) { return used[k]->is_junction ? 1 : 0; });
    out.triangle_columns.add({"site_a", 1, std::move(site_a_)});
    out.triangle_columns.add({"site_b", 1, std::move(site_b_)});
    out.triangle_columns.add({std::string(medial_columns::separation_angle), 1, std::move(angle_)});
    return out;
  }

  const MeshView& mesh_;
  const SiteTable& table_;
  const TracedSites& sites_;
  const TracedStructure& structure_;
  const VoronoiPart part_;
  const double chord_;
  const double longest_;
  const Context& context_;
  TraceWork work_;
  const SeamTracer tracer_;
  std::vector<std::vector<std::uint32_t>> triangles_of_;     ///< of each face
  std::vector<std::optional<BoxBvh>> boxes_of_;              ///< of the triangles of each large face
  std::vector<std::vector<std::uint32_t>> points_of_curve_;  ///< vertices, both ends included
  std::vector<Vertex> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<std::int32_t> site_a_, site_b_;
  std::vector<float> angle_;
};

}  // namespace

std::optional<Complex> traced_complex(const MeshView& mesh, const SiteTable& table, const TracedSites& sites,
                                      const TracedStructure& structure, VoronoiPart part, double chord, double longest,
                                      const Context& context) {
  return Assembly(mesh, table, sites, structure, part, chord, longest, context).build();
}

}  // namespace blum::voronoi
