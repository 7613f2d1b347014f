#include "blum/geometry/site_projection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "blum/core/huge_pages.hpp"
#include "blum/core/parallel.hpp"
#include "geometry/box_scale.hpp"
#include "geometry/distance/face_batch.hpp"
#include "geometry/distance/site_feet.hpp"
#include "geometry/distance/triangle_frame.hpp"

namespace blum {
namespace {

constexpr std::size_t grain = std::size_t{1} << 14;

/// Returns true if a vector's component along a direction is certainly negative, by more than a margin.
bool goes_against(const Vec3d& vector, const Vec3d& direction, double margin) {
  const double along = dot(vector, direction);
  return along < 0 && along * along > margin * margin * squared_length(direction);
}

struct Edge {
  std::array<std::uint32_t, 2> ends{};
  /// The vertices opposite to the edge in up to two triangles. An end of the edge replaces a missing vertex.
  std::array<std::uint32_t, 2> apex{};
  std::uint32_t triangles = 0;
};

struct Foot {
  Vec3d point;
  double distance = 0;
};

}  // namespace

struct SiteProjection::Data {
  double scale = 1;              ///< factor from mesh coordinates to the coordinates used here, a power of two
  double unscale = 1;            ///< 1 / scale
  std::vector<Vec3d> positions;  ///< positions of all vertices, scaled
  std::vector<Edge> edges;
  std::vector<TriangleFrame> faces;  ///< frame of each triangle, with its vertices in ascending order
  /// Other ends of the edges at vertex v: neighbours[first[v] .. first[v + 1]).
  std::vector<std::uint32_t> first, neighbours;

  Data(const MeshView& mesh, const SiteTable& sites, const Context& context);
  void add_edges(const MeshView& mesh, const SiteTable& sites);

  /// The following functions return true if the query lies in a site's domain. In this case they set its foot.
  [[nodiscard]] bool find_on_vertex(std::size_t vertex, const Vec3d& q, double margin, Foot& foot) const;
  [[nodiscard]] bool find_on_edge(std::size_t edge, const Vec3d& q, double margin, Foot& foot) const;
  [[nodiscard]] bool find_on_face(std::size_t face, const Vec3d& q, double margin, Foot& foot) const;
  [[nodiscard]] bool find(SiteId site, const Vec3d& query, double margin, NearestSite& found) const;

  [[nodiscard]] std::size_t first_face() const { return positions.size() + edges.size(); }
  /// Loads data of a site into the cache.
  void prefetch(SiteId site) const;
  /// Loads the positions of an edge or vertex into the cache. Its data should be there.
  void prefetch_positions(SiteId site) const;
};

SiteProjection::Data::Data(const MeshView& mesh, const SiteTable& sites, const Context& context)
    : scale(unit_scale(bounds(mesh))),
      unscale(1 / scale),
      positions(mesh.vertices.size()),
      faces(detail::large_list<TriangleFrame>(mesh.triangles.size())) {
  parallel_for(context, positions.size(), grain, "", [&](const WorkRange& range) {
    for (std::size_t v = range.begin; v < range.end; ++v) positions[v] = mesh.vertices[v] * scale;
  });
  parallel_for(context, faces.size(), grain, "", [&](const WorkRange& range) {
    for (std::size_t t = range.begin; t < range.end; ++t) {
      Triangle corners = mesh.triangles[t];
      std::sort(corners.begin(), corners.end());
      faces[t] = make_triangle_frame({positions[corners[0]], positions[corners[1]], positions[corners[2]]});
    }
  });
  add_edges(mesh, sites);
}

void SiteProjection::Data::add_edges(const MeshView& mesh, const SiteTable& sites) {
  edges.reserve(sites.edge_count());
  first.assign(positions.size() + 1, 0);
  for (const Segment& ends : sites.edges()) {
    edges.push_back({ends, ends, 0});
    ++first[ends[0] + 1];
    ++first[ends[1] + 1];
  }
  for (std::size_t v = 0; v < positions.size(); ++v) first[v + 1] += first[v];
  neighbours.resize(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (const Segment& ends : sites.edges()) {
    neighbours[next[ends[0]]++] = ends[1];
    neighbours[next[ends[1]]++] = ends[0];
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const EdgeId edge = sites.triangle_edges()[t][k];
      if (!edge.has_value()) continue;
      Edge& of_triangle = edges[edge.value];
      if (of_triangle.triangles < 2) of_triangle.apex[of_triangle.triangles] = mesh.triangles[t][(k + 2) % 3];
      ++of_triangle.triangles;
    }
  }
}

bool SiteProjection::Data::find_on_vertex(std::size_t vertex, const Vec3d& q, double margin, Foot& foot) const {
  const Vec3d& p = positions[vertex];
  const Vec3d from = q - p;
  for (std::size_t k = first[vertex]; k < first[vertex + 1]; ++k) {
    if (!goes_against(from, positions[neighbours[k]] - p, margin)) return false;
  }
  foot = {p, length(from)};
  return true;
}

bool SiteProjection::Data::find_on_edge(std::size_t edge, const Vec3d& q, double margin, Foot& foot) const {
  const Edge& e = edges[edge];
  if (e.triangles > 2) return false;
  const Vec3d& a = positions[e.ends[0]];
  const Vec3d& b = positions[e.ends[1]];
  if (!goes_against(q - b, b - a, margin) || !goes_against(q - a, a - b, margin)) return false;
  const Vec3d point = foot_on_edge(q, a, b).point;
  const Vec3d from = q - point;
  for (std::uint32_t k = 0; k < e.triangles; ++k) {
    if (!goes_against(from, positions[e.apex[k]] - point, margin)) return false;
  }
  foot = {point, length(from)};
  return true;
}

bool SiteProjection::Data::find_on_face(std::size_t face, const Vec3d& q, double margin, Foot& foot) const {
  const TriangleFrame& frame = faces[face];
  if (frame.is_flat()) return false;
  const FaceFoot of_plane(q, frame);
  if (!of_plane.is_inside(frame, margin)) return false;
  foot = {q - of_plane.rest, length(of_plane.rest)};
  return true;
}

SiteProjection::SiteProjection(const MeshView& mesh, const SiteTable& sites, const Context& context)
    : data_(std::make_unique<const Data>(mesh, sites, context)) {}
SiteProjection::SiteProjection(SiteProjection&&) noexcept = default;
SiteProjection& SiteProjection::operator=(SiteProjection&&) noexcept = default;
SiteProjection::~SiteProjection() = default;

void SiteProjection::Data::prefetch([[maybe_unused]] SiteId site) const {
#if defined(__GNUC__)
  if (site.value >= first_face()) {
    const TriangleFrame& frame = faces[site.value - first_face()];
    __builtin_prefetch(&frame);
    __builtin_prefetch(&frame.apex);  // its end is in another cache line
  } else {
    const std::size_t vertices = positions.size();
    const void* const start = site.value < vertices ? static_cast<const void*>(&first[site.value])
                                                    : static_cast<const void*>(&edges[site.value - vertices]);
    __builtin_prefetch(start);
  }
#endif
}

void SiteProjection::Data::prefetch_positions([[maybe_unused]] SiteId site) const {
#if defined(__GNUC__)
  if (site.value < positions.size()) return __builtin_prefetch(&positions[site.value]);
  const Edge& edge = edges[site.value - positions.size()];
  for (const std::uint32_t v : edge.ends) __builtin_prefetch(&positions[v]);
  for (const std::uint32_t v : edge.apex) __builtin_prefetch(&positions[v]);
#endif
}

bool SiteProjection::Data::find(SiteId site, const Vec3d& query, double margin, NearestSite& found) const {
  const Vec3d q = query * scale;
  const std::size_t vertices = positions.size();
  margin *= scale;
  Foot foot;
  const bool is_found = site.value < vertices       ? find_on_vertex(site.value, q, margin, foot)
                        : site.value < first_face() ? find_on_edge(site.value - vertices, q, margin, foot)
                                                    : find_on_face(site.value - first_face(), q, margin, foot);
  if (is_found) found = {foot.point * unscale, foot.distance * unscale, site};
  return is_found;
}

bool SiteProjection::project(SiteId site, const Vec3d& query, double margin, NearestSite& found) const {
  return data_->find(site, query, margin, found);
}

void SiteProjection::project(std::span<const SiteId> sites, std::span<const Vec3d> queries, double margin,
                             std::span<NearestSite> found) const {
  const Data& data = *data_;
  for (const SiteId site : sites) {
    if (site.has_value()) data.prefetch(site);
  }
  FaceBatch batch;
  FaceBatchFeet feet;
  std::array<std::size_t, FaceBatch::most> query_of;
  std::size_t count = 0;
  std::vector<std::size_t> others;  // queries on edges and vertices, which wait for their data
  const auto flush = [&] {
    // Whole vectors are computed, so the last query is repeated.
    std::size_t end = count;
    for (; end % FaceBatch::step != 0; ++end) batch.repeat(count - 1, end);
    find_feet(batch, end, margin * data.scale, feet);
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3d point{feet.point[0][k], feet.point[1][k], feet.point[2][k]};
      const SiteId site = feet.is_inside[k] != 0 ? sites[query_of[k]] : SiteId::none();
      found[query_of[k]] = {point * data.unscale, std::sqrt(feet.squared[k]) * data.unscale, site};
    }
    count = 0;
  };
  const std::size_t first_face = data.first_face();
  for (std::size_t k = 0; k < sites.size(); ++k) {
    if (sites[k].has_value() && sites[k].value >= first_face) {
      batch.set(count, queries[k] * data.scale, data.faces[sites[k].value - first_face]);
      query_of[count++] = k;
      if (count == FaceBatch::most) flush();
    } else {
      found[k].site = SiteId::none();
      if (!sites[k].has_value()) continue;
      data.prefetch_positions(sites[k]);
      others.push_back(k);
    }
  }
  flush();
  for (const std::size_t k : others) (void)data.find(sites[k], queries[k], margin, found[k]);
}

}  // namespace blum
