#include "axis/shared_sheets.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "axis/join_sheets.hpp"
#include "blum/complex/homology.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/union_find.hpp"
#include "blum/geometry/closest_point.hpp"

namespace blum::detail {
namespace {

using Edge = std::array<std::uint32_t, 2>;
using Triangle = std::array<std::uint32_t, 3>;

constexpr std::size_t longest_gap = 10;  // edges around a gap that is filled
constexpr double longest_loop = 12;      // thicknesses: the length of these edges
constexpr std::size_t most_groups = 8;   // of joins that are tried one by one; many groups hardly ever fit

/// Returns the values with the given indices.
template <class T>
std::vector<T> chosen(const std::vector<T>& values, const std::vector<std::uint32_t>& indices) {
  std::vector<T> out;
  out.reserve(indices.size());
  for (const std::uint32_t k : indices) out.push_back(values[k]);
  return out;
}

Edge sorted(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Joins edges that share a vertex, if the vertex connects.
UnionFind connected(const std::vector<Edge>& edges, FunctionRef<bool(std::uint32_t)> connects) {
  UnionFind groups(edges.size());
  std::map<std::uint32_t, std::uint32_t> first_at;
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    for (const std::uint32_t v : edges[e]) {
      if (!connects(v)) continue;
      const auto [known, is_new] = first_at.emplace(v, e);
      if (!is_new) groups.join(known->second, e);
    }
  }
  return groups;
}

BettiNumbers betti_of(const ExtendedSheets& sheets) {
  Complex complex;
  complex.positions = sheets.positions;
  complex.edges = sheets.curves;
  complex.triangles = sheets.triangles;
  return homology(complex.view());
}

/// Fills gaps between strips that were joined.
class GapFiller {
 public:
  GapFiller(ExtendedSheets& sheets, const std::vector<JoinedSheets::Part>& seams,
            FunctionRef<bool(const Vec3d&)> is_inside)
      : sheets_(sheets), is_inside_(is_inside) {
    for (const JoinedSheets::Part& seam : seams) on_seams_.insert(seam.ends.begin(), seam.ends.end());
    for (std::uint32_t t = 0; t < sheets.triangles.size(); ++t) count(t);
  }

  /// Fills gaps at rim edges without strips, and other small gaps at seams.
  void fill_all(const std::vector<Edge>& gaps) {
    for (const Edge& gap : gaps) fill(gap);
    std::vector<Edge> at_seams;
    for (const auto& [edge, triangles] : sides_) {
      const bool is_border = triangles.size() == 1;
      if (is_border && (on_seams_.contains(edge[0]) || on_seams_.contains(edge[1]))) at_seams.push_back(edge);
    }
    for (const Edge& edge : at_seams) fill(edge);
  }

 private:
  [[nodiscard]] const Vec3d& at(std::uint32_t v) const { return sheets_.positions[v]; }

  void fill(const Edge& border) {
    const auto side = sides_.find(sorted(border[0], border[1]));
    if (side == sides_.end() || side->second.size() != 1) return;
    const std::uint32_t own = side->second[0];
    const std::vector<std::uint32_t> loop = loop_of(directed(border, own));
    const bool is_at_seam = std::any_of(loop.begin(), loop.end(), [&](auto v) { return on_seams_.contains(v); });
    if (loop.size() < 3 || !is_at_seam || length_of(loop) > longest_loop * sheets_.thickness[loop[0]]) return;
    for (const Triangle& triangle : smallest_fan(loop)) add(triangle, own);
  }

  /// Returns an edge in the direction of a triangle.
  [[nodiscard]] Edge directed(const Edge& edge, std::uint32_t t) const {
    const Triangle& corners = sheets_.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      if (corners[k] == edge[0] && corners[(k + 1) % 3] == edge[1]) return edge;
    }
    return {edge[1], edge[0]};
  }

  [[nodiscard]] double length_of(const std::vector<std::uint32_t>& loop) const {
    double sum = 0;
    for (std::size_t k = 0; k < loop.size(); ++k) sum += length(at(loop[(k + 1) % loop.size()]) - at(loop[k]));
    return sum;
  }

  void count(std::uint32_t t) {
    const Triangle& corners = sheets_.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k];
      const std::uint32_t b = corners[(k + 1) % 3];
      sides_[sorted(a, b)].push_back(t);
      around_.insert({a, b});
      around_.insert({b, a});
    }
  }

  /// Returns the shortest loop of border edges that contains a border edge, in the direction against its triangle.
  /// Returns no vertices if the loop has too many edges.
  [[nodiscard]] std::vector<std::uint32_t> loop_of(const Edge& rim) const {
    std::map<std::uint32_t, std::uint32_t> from{{rim[0], rim[0]}};
    std::vector<std::uint32_t> front{rim[0]};
    for (std::size_t step = 1; step < longest_gap && !front.empty() && !from.contains(rim[1]); ++step) {
      std::vector<std::uint32_t> next;
      for (const std::uint32_t v : front) {
        for (const std::uint32_t w : border_neighbours(v)) {
          if (sorted(v, w) != sorted(rim[0], rim[1]) && from.emplace(w, v).second) next.push_back(w);
        }
      }
      front = std::move(next);
    }
    std::vector<std::uint32_t> loop;
    if (!from.contains(rim[1])) return loop;
    for (std::uint32_t v = rim[1]; v != rim[0]; v = from.at(v)) loop.push_back(v);
    loop.push_back(rim[0]);
    std::reverse(loop.begin() + 1, loop.end());  // rim[1], rim[0], and on to rim[1]
    return loop;
  }

  /// Returns the other ends of the border edges at a vertex.
  [[nodiscard]] std::vector<std::uint32_t> border_neighbours(std::uint32_t v) const {
    std::vector<std::uint32_t> found;
    for (auto edge = around_.lower_bound({v, 0}); edge != around_.end() && edge->first == v; ++edge) {
      if (sides_.at(sorted(v, edge->second)).size() == 1) found.push_back(edge->second);
    }
    return found;
  }

  /// Returns the fan of triangles over a loop, around one of its vertices, that has the smallest area.
  [[nodiscard]] std::vector<Triangle> smallest_fan(const std::vector<std::uint32_t>& loop) const {
    std::vector<Triangle> best;
    double least = std::numeric_limits<double>::infinity();
    const std::size_t n = loop.size();
    for (std::size_t apex = 0; apex < n; ++apex) {
      std::vector<Triangle> fan;
      double area = 0;
      for (std::size_t k = 1; k + 1 < n; ++k) {
        fan.push_back({loop[apex], loop[(apex + k) % n], loop[(apex + k + 1) % n]});
        area += length(cross(at(fan.back()[1]) - at(fan.back()[0]), at(fan.back()[2]) - at(fan.back()[0])));
      }
      if (area >= least) continue;
      least = area;
      best = std::move(fan);
    }
    return best;
  }

  void add(const Triangle& triangle, std::uint32_t own) {
    const auto& [a, b, c] = triangle;
    if (!is_inside_((at(a) + at(b) + at(c)) / 3.0)) return;
    sheets_.triangles.push_back(triangle);
    sheets_.sheet.push_back(sheets_.sheet[own]);
    sheets_.is_new_triangle.push_back(1);
    count(static_cast<std::uint32_t>(sheets_.triangles.size() - 1));
  }

  ExtendedSheets& sheets_;
  FunctionRef<bool(const Vec3d&)> is_inside_;
  std::map<Edge, std::vector<std::uint32_t>> sides_;          ///< triangles of each edge
  std::set<std::pair<std::uint32_t, std::uint32_t>> around_;  ///< both directions of each edge
  std::set<std::uint32_t> on_seams_;
};

/// Sheets after an attempt to join them, and where they were joined.
struct Attempt {
  ExtendedSheets sheets;
  std::vector<JoinedSheets::Part> seams;
};

class SheetSharer {
 public:
  SheetSharer(const ExtendedSheets& apart, const Complex& axis, const SheetContacts& contacts,
              FunctionRef<bool(const Vec3d&)> is_inside, const Context& context)
      : apart_(apart),
        axis_(axis),
        radius_(axis.vertex_columns.get<double>(medial_columns::radius)),
        contacts_(contacts),
        is_inside_(is_inside),
        context_(context),
        search_({apart.positions, apart.triangles}, {}, context),
        betti_(betti_of(apart)) {
    for (const double thickness : apart.thickness) tolerance_.push_back(contacts.tolerance * thickness);
  }

  ExtendedSheets run() {
    std::set<std::uint32_t> all;
    for (std::uint32_t k = 0; k < contacts_.borders.size(); ++k) all.insert(k);
    // Single points that touch would add loops, so only borders that share edges are joined.
    Attempt joined = attempt(all);
    const std::set<std::uint32_t> sharing = borders_of(joined.seams);
    if (sharing.empty()) return apart_;
    if (sharing != all) joined = attempt(sharing);
    if (betti_of(joined.sheets) == betti_) return joined.sheets;
    return join_by_groups(joined);
  }

 private:
  static std::set<std::uint32_t> borders_of(const std::vector<JoinedSheets::Part>& parts) {
    std::set<std::uint32_t> borders;
    for (const JoinedSheets::Part& part : parts) borders.insert(part.border);
    return borders;
  }

  /// Joins connected groups of seams one after the other, the longest first. Leaves out groups that change the
  /// topology.
  [[nodiscard]] ExtendedSheets join_by_groups(const Attempt& joined) const {
    ExtendedSheets best = apart_;
    best.unshared_length = joined.sheets.seam_length;
    std::set<std::uint32_t> kept;
    const std::vector<std::set<std::uint32_t>> groups = groups_of(joined);
    if (groups.size() > most_groups) return best;
    for (const std::set<std::uint32_t>& group : groups) {
      std::set<std::uint32_t> tried = kept;
      tried.insert(group.begin(), group.end());
      Attempt next = attempt(tried);
      if (betti_of(next.sheets) != betti_) continue;
      kept = std::move(tried);
      best = std::move(next.sheets);
      best.unshared_length = std::max(0.0, joined.sheets.seam_length - best.seam_length);
    }
    return best;
  }

  /// Returns the borders of each connected group of seams, the longest group first.
  [[nodiscard]] static std::vector<std::set<std::uint32_t>> groups_of(const Attempt& joined) {
    std::vector<Edge> edges;
    for (const JoinedSheets::Part& seam : joined.seams) edges.push_back(seam.ends);
    UnionFind groups = connected(edges, [](std::uint32_t) { return true; });
    std::map<std::uint32_t, std::pair<std::size_t, std::set<std::uint32_t>>> found;
    for (std::uint32_t s = 0; s < joined.seams.size(); ++s) {
      auto& [size, borders] = found[groups.find(s)];
      ++size;
      borders.insert(joined.seams[s].border);
    }
    std::vector<std::pair<std::size_t, std::set<std::uint32_t>>> ordered;
    for (auto& [group, of_group] : found) ordered.push_back(std::move(of_group));
    std::sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    std::vector<std::set<std::uint32_t>> out;
    for (auto& [size, borders] : ordered) out.push_back(std::move(borders));
    return out;
  }

  [[nodiscard]] Attempt attempt(const std::set<std::uint32_t>& borders) const {
    Attempt out{apart_, {}};
    ExtendedSheets& sheets = out.sheets;
    const std::vector<std::uint32_t> indices(borders.begin(), borders.end());
    const JoinedSheets joined =
        join_sheets({search_, axis_.positions.size(), chosen(contacts_.borders, indices), tolerance_}, context_);
    for (const JoinedSheets::OnEdge& on : joined.new_vertices) {
      const auto [a, b] = on.ends;
      sheets.thickness.push_back(sheets.thickness[a] + (sheets.thickness[b] - sheets.thickness[a]) * on.part);
      sheets.is_new_vertex.push_back(1);
    }
    sheets.positions = joined.positions;
    sheets.triangles = joined.triangles;
    sheets.sheet = chosen(sheets.sheet, joined.first);
    sheets.is_new_triangle = chosen(sheets.is_new_triangle, joined.first);
    for (const JoinedSheets::Part& part : joined.seams) {
      sheets.seam_length += length_of(sheets, part);
      out.seams.push_back({part.ends, indices[part.border]});
    }
    for (const JoinedSheets::Part& part : joined.unshared) sheets.unshared_length += length_of(sheets, part);
    if (!joined.seams.empty()) GapFiller(sheets, joined.seams, is_inside_).fill_all(contacts_.gaps);
    remove_curves(out);
    remove_unused_vertices(sheets);
    return out;
  }

  static double length_of(const ExtendedSheets& sheets, const JoinedSheets::Part& part) {
    return length(sheets.positions[part.ends[1]] - sheets.positions[part.ends[0]]);
  }

  /// Removes each connected group of curves if each of its vertices is within two radii of a seam. Such curves
  /// lead through the gap between two sheets, which is now closed.
  void remove_curves(Attempt& joined) const {
    std::vector<bool> is_in_triangle(joined.sheets.positions.size(), false);
    for (const Triangle& triangle : joined.sheets.triangles) {
      for (const std::uint32_t v : triangle) is_in_triangle[v] = true;
    }
    std::vector<Edge>& curves = joined.sheets.curves;
    UnionFind groups = connected(curves, [&](std::uint32_t v) { return !is_in_triangle[v]; });
    std::vector<bool> stays(curves.size(), false);
    for (std::uint32_t e = 0; e < curves.size(); ++e) {
      for (const std::uint32_t v : curves[e]) {
        if (!is_near_seam(v, joined)) stays[groups.find(e)] = true;
      }
    }
    std::vector<Edge> kept;
    for (std::uint32_t e = 0; e < curves.size(); ++e) {
      if (stays[groups.find(e)]) kept.push_back(curves[e]);
    }
    curves = std::move(kept);
  }

  /// Returns true if a vertex of the axis is within two radii of a seam.
  [[nodiscard]] bool is_near_seam(std::uint32_t v, const Attempt& joined) const {
    const std::vector<Vec3d>& at = joined.sheets.positions;
    return std::any_of(joined.seams.begin(), joined.seams.end(), [&](const JoinedSheets::Part& seam) {
      return length(closest_point_on_segment(at[v], at[seam.ends[0]], at[seam.ends[1]]) - at[v]) <= 2 * radius_[v];
    });
  }

  /// Removes vertices that had a triangle or curve before, but have none now.
  void remove_unused_vertices(ExtendedSheets& sheets) const {
    std::vector<bool> stays(sheets.positions.size(), true);
    const auto mark = [&](const auto& cells, bool value) {
      for (const auto& cell : cells) {
        for (const std::uint32_t v : cell) stays[v] = value;
      }
    };
    mark(apart_.triangles, false);
    mark(apart_.curves, false);
    mark(sheets.triangles, true);
    mark(sheets.curves, true);
    std::vector<std::uint32_t> kept;
    std::vector<std::uint32_t> number(sheets.positions.size());
    for (std::uint32_t v = 0; v < number.size(); ++v) {
      number[v] = static_cast<std::uint32_t>(kept.size());
      if (stays[v]) kept.push_back(v);
    }
    sheets.positions = chosen(sheets.positions, kept);
    sheets.thickness = chosen(sheets.thickness, kept);
    sheets.is_new_vertex = chosen(sheets.is_new_vertex, kept);
    const auto renumber = [&](auto& cells) {
      for (auto& cell : cells) {
        for (std::uint32_t& v : cell) v = number[v];
      }
    };
    renumber(sheets.triangles);
    renumber(sheets.curves);
  }

  const ExtendedSheets& apart_;
  const Complex& axis_;
  std::span<const double> radius_;
  const SheetContacts& contacts_;
  FunctionRef<bool(const Vec3d&)> is_inside_;
  const Context& context_;
  SearchMesh search_;              ///< of the sheets apart
  std::vector<double> tolerance_;  ///< for each vertex of the sheets apart
  BettiNumbers betti_;
};

}  // namespace

ExtendedSheets share_vertices(const ExtendedSheets& apart, const Complex& axis, const SheetContacts& contacts,
                              FunctionRef<bool(const Vec3d&)> is_inside, const Context& context) {
  return SheetSharer(apart, axis, contacts, is_inside, context).run();
}

}  // namespace blum::detail
