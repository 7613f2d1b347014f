#include "blum/geometry/site_projection.hpp"

#include <algorithm>

#include "blum/core/parallel.hpp"
#include "geometry/box_scale.hpp"
#include "geometry/site_feet.hpp"
#include "geometry/triangle_frame.hpp"

namespace blum {
namespace {

constexpr std::size_t grain = std::size_t{1} << 14;

/// Whether a vector goes against a direction by more than a margin for certain.
bool goes_against(const Vec3d& vector, const Vec3d& direction, double margin) {
  const double along = dot(vector, direction);
  return along < 0 && along * along > margin * margin * squared_length(direction);
}

}  // namespace

SiteProjection::SiteProjection(const MeshView& mesh, const SiteTable& sites, const Context& context)
    : scale_(unit_scale(bounds(mesh))) {
  const std::size_t vertices = mesh.vertices.size();
  positions_.resize(vertices);
  parallel_for(context, vertices, grain, "", [&](const WorkRange& range) {
    for (std::size_t v = range.begin; v < range.end; ++v) positions_[v] = mesh.vertices[v] * scale_;
  });
  faces_.resize(mesh.triangles.size());
  parallel_for(context, faces_.size(), grain, "", [&](const WorkRange& range) {
    for (std::size_t t = range.begin; t < range.end; ++t) {
      faces_[t] = mesh.triangles[t];
      std::sort(faces_[t].begin(), faces_[t].end());
    }
  });
  edges_.reserve(sites.edge_count());
  first_.assign(vertices + 1, 0);
  for (const Segment& ends : sites.edges()) {
    edges_.push_back({ends, ends, 0});
    ++first_[ends[0] + 1];
    ++first_[ends[1] + 1];
  }
  for (std::size_t v = 0; v < vertices; ++v) first_[v + 1] += first_[v];
  neighbours_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const Segment& ends : sites.edges()) {
    neighbours_[next[ends[0]]++] = ends[1];
    neighbours_[next[ends[1]]++] = ends[0];
  }
  throw_if_cancelled(context);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const EdgeId edge = sites.triangle_edges()[t][k];
      if (!edge.has_value()) continue;
      Edge& of_triangle = edges_[edge.value];
      if (of_triangle.triangles < 2) of_triangle.apex[of_triangle.triangles] = mesh.triangles[t][(k + 2) % 3];
      ++of_triangle.triangles;
    }
  }
}

std::optional<NearestSite> SiteProjection::project(SiteId site, const Vec3d& query, double margin) const {
  const Vec3d q = query * scale_;
  const std::size_t vertices = positions_.size();
  const auto found = [&]() -> std::optional<Foot> {
    if (site.value < vertices) return on_vertex(site.value, q, margin * scale_);
    const std::size_t edge = site.value - vertices;
    if (edge < edges_.size()) return on_edge(static_cast<std::uint32_t>(edge), q, margin * scale_);
    return on_face(static_cast<std::uint32_t>(edge - edges_.size()), q, margin * scale_);
  }();
  if (!found) return std::nullopt;
  return NearestSite{found->point / scale_, found->distance / scale_, site};
}

std::optional<SiteProjection::Foot> SiteProjection::on_vertex(std::uint32_t vertex, const Vec3d& q,
                                                              double margin) const {
  const Vec3d& p = positions_[vertex];
  const Vec3d from = q - p;
  for (std::size_t k = first_[vertex]; k < first_[vertex + 1]; ++k) {
    if (!goes_against(from, positions_[neighbours_[k]] - p, margin)) return std::nullopt;
  }
  return Foot{p, length(from)};
}

std::optional<SiteProjection::Foot> SiteProjection::on_edge(std::uint32_t edge, const Vec3d& q, double margin) const {
  const Edge& e = edges_[edge];
  if (e.triangles > 2) return std::nullopt;
  const Vec3d& a = positions_[e.ends[0]];
  const Vec3d& b = positions_[e.ends[1]];
  if (!goes_against(q - b, b - a, margin) || !goes_against(q - a, a - b, margin)) return std::nullopt;
  const EdgeFoot foot = foot_on_edge(q, a, b);
  const Vec3d from = q - foot.point;
  for (std::uint32_t k = 0; k < e.triangles; ++k) {
    if (!goes_against(from, positions_[e.apex[k]] - foot.point, margin)) return std::nullopt;
  }
  return Foot{foot.point, length(from)};
}

std::optional<SiteProjection::Foot> SiteProjection::on_face(std::uint32_t face, const Vec3d& q, double margin) const {
  const auto& [a, b, c] = faces_[face];
  const TriangleFrame frame = make_triangle_frame({positions_[a], positions_[b], positions_[c]});
  if (frame.is_flat()) return std::nullopt;
  const FaceFoot foot(q, frame);
  if (!foot.is_inside(frame, margin)) return std::nullopt;
  return Foot{q - foot.rest, length(foot.rest)};
}

}  // namespace blum
