#include "blum/voronoi/voronoi_graph.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <utility>

#include "blum/complex/incidence.hpp"
#include "blum/core/sort_unique.hpp"
#include "blum/core/union_find.hpp"
#include "blum/voronoi/voronoi_regions.hpp"
#include "voronoi/site_patches.hpp"

namespace blum {
namespace {

constexpr std::uint32_t none = UINT32_MAX;

using detail::sort_unique;

class GraphBuilder {
 public:
  /// @param of_patches  true if the sites of the complex are patches. In this case, a mark in the column `junction` may
  ///                    be that of a point inside a patch's wall or seam.
  GraphBuilder(const Complex& complex, bool of_patches, const Context& context)
      : complex_(complex),
        of_patches_(of_patches),
        site_a_(complex.triangle_columns.get<std::int32_t>("site_a")),
        site_b_(complex.triangle_columns.get<std::int32_t>("site_b")),
        incidence_({complex.positions.size(), {}, complex.triangles}, context),
        context_(context) {
    if (complex.vertex_columns.find("junction") != nullptr) {
      is_junction_ = complex.vertex_columns.get<std::int32_t>("junction");
    }
  }

  VoronoiGraph build() {
    const bool has_surface = std::any_of(site_a_.begin(), site_a_.end(), [](std::int32_t site) { return site < 0; });
    if (has_surface) out_.regions = voronoi_regions(complex_);
    throw_if_cancelled(context_);
    find_walls();
    find_seams();
    for (VoronoiWall& wall : out_.walls) sort_unique(wall.seams);
    return std::move(out_);
  }

 private:
  [[nodiscard]] bool is_wall(std::size_t t) const { return site_a_[t] >= 0; }

  void find_walls() {
    const auto count = static_cast<std::uint32_t>(complex_.triangles.size());
    detail::UnionFind joined(count);
    // Triangles of the same wall may share only the vertex of their cube, so a common vertex joins them.
    std::vector<std::pair<std::array<std::int32_t, 2>, std::uint32_t>> at;  // (sites, triangle)
    for (std::size_t v = 0; v < complex_.positions.size(); ++v) {
      at.clear();
      for (const std::uint32_t t : incidence_.triangles_of_vertex()[v]) at.push_back({{site_a_[t], site_b_[t]}, t});
      std::sort(at.begin(), at.end());
      for (std::size_t k = 1; k < at.size(); ++k) {
        if (at[k].first == at[k - 1].first) joined.join(at[k].second, at[k - 1].second);
      }
    }
    wall_of_.assign(count, none);
    std::vector<std::uint32_t> number(count, none);
    for (std::uint32_t t = 0; t < count; ++t) {
      if (!is_wall(t)) continue;
      std::uint32_t& wall = number[joined.find(t)];
      if (wall == none) {
        wall = static_cast<std::uint32_t>(out_.walls.size());
        out_.walls.push_back({site_a_[t], site_b_[t], 0, {}});
      }
      wall_of_[t] = wall;
      const auto& [a, b, c] = complex_.triangles[t];
      const Vec3d& p = complex_.positions[a];
      out_.walls[wall].area += 0.5 * length(cross(complex_.positions[b] - p, complex_.positions[c] - p));
    }
    throw_if_cancelled(context_);
  }

  [[nodiscard]] std::vector<std::int32_t> sites_of(std::span<const std::uint32_t> triangles) const {
    std::vector<std::int32_t> out;
    for (const std::uint32_t t : triangles) {
      if (is_wall(t)) out.push_back(site_a_[t]);
      out.push_back(site_b_[t]);
    }
    sort_unique(out);
    return out;
  }

  /// Returns true if three or more triangles and at least three regions meet at an edge.
  [[nodiscard]] bool is_seam(std::size_t e) const {
    const std::span<const std::uint32_t> at = incidence_.triangles_of_edge()[e];
    return at.size() > 2 && sites_of(at).size() > 2;
  }

  void find_seams() {
    const std::vector<std::uint32_t> seam_of = find_chains();
    throw_if_cancelled(context_);
    join_junctions();
    number_seams();
    for (std::uint32_t e = 0; e < seam_of.size(); ++e) {
      if (seam_of[e] != none) add_edge(e, chains_[seam_of[e]].number);
    }
    for (const Chain& chain : chains_) add_ends(chain);
    for (VoronoiSeam& seam : out_.seams) {
      sort_unique(seam.sites);
      sort_unique(seam.walls);
      sort_unique(seam.junctions);
    }
    for (VoronoiJunction& junction : out_.junctions) {
      sort_unique(junction.sites);
      sort_unique(junction.seams);
    }
  }

  /// A chain of seam edges. At each vertex inside the chain, exactly two seam edges meet.
  struct Chain {
    std::size_t edges = 0;
    bool has_many_sites = false;      ///< true if at least four regions meet at each edge
    std::vector<std::uint32_t> ends;  ///< vertices at the ends of the chain
    std::uint32_t number = none;      ///< index of its seam; `none` if the chain belongs to a junction
  };

  /// Returns for each edge the index of its chain; `none` for edges that are not on seams.
  std::vector<std::uint32_t> find_chains() {
    const std::size_t count = incidence_.edges().size();
    std::vector<std::uint8_t> is_on_seam(count, 0);
    for (std::size_t e = 0; e < count; ++e) is_on_seam[e] = is_seam(e) ? 1 : 0;
    detail::UnionFind joined(static_cast<std::uint32_t>(count));
    is_end_.assign(complex_.positions.size(), 0);
    for (std::uint32_t v = 0; v < complex_.positions.size(); ++v) {
      std::vector<std::uint32_t> meeting;
      for (const std::uint32_t e : incidence_.edges_of_vertex()[v]) {
        if (is_on_seam[e] != 0) meeting.push_back(e);
      }
      const bool is_passed = meeting.size() == 2 && may_pass(v, meeting);
      if (is_passed) joined.join(meeting[0], meeting[1]);
      is_end_[v] = meeting.empty() || is_passed ? 0 : 1;
    }
    std::vector<std::uint32_t> out(count, none);
    std::vector<std::uint32_t> number(count, none);
    for (std::uint32_t e = 0; e < count; ++e) {
      if (is_on_seam[e] == 0) continue;
      std::uint32_t& chain = number[joined.find(e)];
      if (chain == none) {
        chain = static_cast<std::uint32_t>(chains_.size());
        chains_.push_back({0, true, {}, none});
      }
      out[e] = chain;
      Chain& own = chains_[chain];
      ++own.edges;
      own.has_many_sites = own.has_many_sites && sites_of(incidence_.triangles_of_edge()[e]).size() > 3;
      for (const std::uint32_t v : incidence_.edges()[e]) {
        if (is_end_[v] != 0) own.ends.push_back(v);
      }
    }
    return out;
  }

  /// Returns true if the two seam edges at a vertex may belong to one seam.
  [[nodiscard]] bool may_pass(std::uint32_t v, const std::vector<std::uint32_t>& meeting) const {
    if (!is_exact() || is_junction_[v] == 0) return true;
    if (!of_patches_) return false;
    const std::vector<std::int32_t> sites = sites_of(incidence_.triangles_of_vertex()[v]);
    return std::all_of(meeting.begin(), meeting.end(),
                       [&](std::uint32_t e) { return sites_of(incidence_.triangles_of_edge()[e]) == sites; });
  }

  /// Returns true if the complex marks its junctions, because it has those of the exact diagram.
  [[nodiscard]] bool is_exact() const { return !is_junction_.empty(); }

  [[nodiscard]] bool is_short(const Chain& chain) const {
    if (is_exact()) return false;
    constexpr std::size_t few = 4;  // for example through a square, a cube and another square
    return chain.has_many_sites && chain.edges <= few && chain.ends.size() == 2;
  }

  /// Finds the junctions. Around a point where four or more regions meet, several vertices in neighbouring cells may
  /// represent that point. Short chains connect them, and they become one junction.
  void join_junctions() {
    detail::UnionFind joined(static_cast<std::uint32_t>(is_end_.size()));
    for (const Chain& chain : chains_) {
      if (is_short(chain)) joined.join(chain.ends[0], chain.ends[1]);
    }
    junction_of_.assign(is_end_.size(), none);
    std::vector<std::uint32_t> number(is_end_.size(), none);
    for (std::uint32_t v = 0; v < is_end_.size(); ++v) {
      if (is_end_[v] == 0) continue;
      std::uint32_t& junction = number[joined.find(v)];
      const std::vector<std::int32_t> sites = sites_of(incidence_.triangles_of_vertex()[v]);
      if (junction == none) {
        junction = static_cast<std::uint32_t>(out_.junctions.size());
        out_.junctions.push_back({v, {}, {}, {}});
      }
      junction_of_[v] = junction;
      VoronoiJunction& own = out_.junctions[junction];
      // The vertex with the most triangles is the vertex of a cube. It was moved to the point with equal distances if
      // that point is in its cube.
      const IndexRows& at = incidence_.triangles_of_vertex();
      if (at[v].size() > at[own.vertex].size()) own.vertex = v;
      own.position = complex_.positions[own.vertex];
      own.sites.insert(own.sites.end(), sites.begin(), sites.end());
    }
  }

  void number_seams() {
    for (Chain& chain : chains_) {
      const bool is_inside = is_short(chain) && junction_of_[chain.ends[0]] == junction_of_[chain.ends[1]];
      if (is_inside) continue;
      chain.number = static_cast<std::uint32_t>(out_.seams.size());
      out_.seams.emplace_back();
    }
  }

  void add_edge(std::uint32_t e, std::uint32_t number) {
    if (number == none) return;
    VoronoiSeam& seam = out_.seams[number];
    const auto& [a, b] = incidence_.edges()[e];
    seam.length += length(complex_.positions[a] - complex_.positions[b]);
    const std::span<const std::uint32_t> at = incidence_.triangles_of_edge()[e];
    for (const std::int32_t site : sites_of(at)) seam.sites.push_back(site);
    for (const std::uint32_t t : at) {
      if (!is_wall(t)) continue;
      seam.walls.push_back(wall_of_[t]);
      out_.walls[wall_of_[t]].seams.push_back(number);
    }
  }

  void add_ends(const Chain& chain) {
    if (chain.number == none) return;
    for (const std::uint32_t v : chain.ends) {
      out_.seams[chain.number].junctions.push_back(junction_of_[v]);
      out_.junctions[junction_of_[v]].seams.push_back(chain.number);
    }
  }

  const Complex& complex_;
  const bool of_patches_;
  std::span<const std::int32_t> site_a_, site_b_;
  std::span<const std::int32_t> is_junction_;  ///< for each vertex: 1 at junctions; empty if the complex has no marks
  const Incidence incidence_;
  const Context& context_;
  std::vector<std::uint32_t> wall_of_;      ///< for each triangle
  std::vector<std::uint8_t> is_end_;        ///< for each vertex: 1 if chains end at it
  std::vector<std::uint32_t> junction_of_;  ///< for each vertex at which chains end
  std::vector<Chain> chains_;
  VoronoiGraph out_;
};

/// Returns the complex whose sites are the patches: only triangles on walls between different patches and on the
/// surface. It has all vertices of the given complex.
Complex complex_of(const Complex& complex, std::span<const VoronoiPatch> patches) {
  const auto site_a = complex.triangle_columns.get<std::int32_t>("site_a");
  const auto site_b = complex.triangle_columns.get<std::int32_t>("site_b");
  const voronoi::SitePatches patch_of(patches);
  Complex out;
  out.positions = complex.positions;
  out.vertex_columns = Columns(out.positions.size());
  if (const Column* junction = complex.vertex_columns.find("junction")) out.vertex_columns.add(*junction);
  std::vector<std::int32_t> patch_a, patch_b;
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    std::int32_t a = patch_of.of_side(site_a[t]);
    std::int32_t b = patch_of.of_side(site_b[t]);
    if (a == b) continue;
    auto [p, q, r] = complex.triangles[t];
    if (a > b) {  // corners run counterclockwise as seen from the region of patch b
      std::swap(a, b);
      std::swap(q, r);
    }
    out.triangles.push_back({p, q, r});
    patch_a.push_back(a);
    patch_b.push_back(b);
  }
  out.triangle_columns = Columns(out.triangles.size());
  out.triangle_columns.add({"site_a", 1, std::move(patch_a)});
  out.triangle_columns.add({"site_b", 1, std::move(patch_b)});
  return out;
}

}  // namespace

VoronoiGraph voronoi_graph(const Complex& complex, const Context& context) {
  validate(complex);
  return GraphBuilder(complex, false, context).build();
}

VoronoiGraph voronoi_graph(const Complex& complex, std::span<const VoronoiPatch> patches, const Context& context) {
  validate(complex);
  const Complex of_patches = complex_of(complex, patches);
  VoronoiGraph out = GraphBuilder(of_patches, true, context).build();
  out.patches.assign(patches.begin(), patches.end());
  return out;
}

std::vector<VoronoiRegion> voronoi_regions(const Complex& complex) {
  validate(complex);
  const auto site_a = complex.triangle_columns.get<std::int32_t>("site_a");
  const auto site_b = complex.triangle_columns.get<std::int32_t>("site_b");
  Vec3d middle;
  for (const Vec3d& p : complex.positions) middle += p * (1.0 / static_cast<double>(complex.positions.size()));
  std::map<std::int32_t, double> volumes, surfaces;
  std::map<std::pair<std::int32_t, std::int32_t>, double> areas;
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    const auto& [a, b, c] = complex.triangles[t];
    const Vec3d p = complex.positions[a] - middle;
    const Vec3d normal = cross(complex.positions[b] - middle - p, complex.positions[c] - middle - p);
    // The corners run counterclockwise as seen from the region of site_b, so the normal points into that region.
    const double cone = dot(p, normal) / 6;
    const double area = 0.5 * length(normal);
    volumes[site_b[t]] -= cone;
    if (site_a[t] < 0) {
      surfaces[site_b[t]] += area;
      continue;
    }
    volumes[site_a[t]] += cone;
    areas[{site_a[t], site_b[t]}] += area;
    areas[{site_b[t], site_a[t]}] += area;
  }
  std::vector<VoronoiRegion> out;
  for (const auto& [site, volume] : volumes) {
    VoronoiRegion& region = out.emplace_back();
    region.site = site;
    region.volume = volume;
    if (const auto at = surfaces.find(site); at != surfaces.end()) region.surface_area = at->second;
    for (auto at = areas.lower_bound({site, INT32_MIN}); at != areas.end() && at->first.first == site; ++at) {
      region.neighbours.push_back({at->first.second, at->second});
    }
  }
  return out;
}

}  // namespace blum
