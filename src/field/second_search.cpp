#include "field/second_search.hpp"

#include <algorithm>
#include <array>

namespace blum {
namespace {

void offer_site(double distance, SiteId site, SecondSite& best) {
  if (distance < best.distance || (distance == best.distance && site.value < best.site.value)) best = {distance, site};
}

/// The closest of the ends of an edge and the edge itself.
void offer_edge(const MeshView& mesh, const SiteTable& sites, const Segment& ends, const Vec3d& query,
                SecondSite& best) {
  const Vec3d& a = mesh.vertices[ends[0]];
  const Vec3d& b = mesh.vertices[ends[1]];
  const Vec3d along = b - a;
  const double from_a = dot(query - a, along);
  const double from_b = dot(b - query, along);
  if (from_a <= 0) return offer_site(length(query - a), SiteId(ends[0]), best);
  if (from_b <= 0) return offer_site(length(query - b), SiteId(ends[1]), best);
  // From the nearer end, so that rounding does not grow with the edge's length.
  const double squared = from_a + from_b;
  const Vec3d point = from_a < from_b ? a + along * (from_a / squared) : b - along * (from_b / squared);
  const auto found = std::lower_bound(sites.edges().begin(), sites.edges().end(), ends);
  const auto edge = static_cast<std::uint32_t>(found - sites.edges().begin());
  offer_site(length(query - point), sites.id({SiteKind::edge, edge}), best);
}

std::array<std::uint32_t, 3> vertices_of(const MeshView& mesh, std::size_t primitive) {
  if (primitive < mesh.triangles.size()) return mesh.triangles[primitive];
  primitive -= mesh.triangles.size();
  if (primitive < mesh.segments.size()) {
    const Segment& s = mesh.segments[primitive];
    return {s[0], s[1], s[1]};
  }
  const std::uint32_t v = mesh.points[primitive - mesh.segments.size()];
  return {v, v, v};
}

}  // namespace

SecondSearch::SecondSearch(const MeshView& mesh, const SiteTable& sites, const SecondLabels& labels,
                           const Context& context)
    : mesh_(mesh), sites_(sites), labels_(labels), bvh_(mesh, sites, context) {}

void SecondSearch::offer(const NearestPrimitive& found, const Vec3d& query, const SecondLabels::OfSite& first,
                         SecondSite& best) const {
  // What is left of a primitive without its excluded corners: all of it, an edge, a corner or nothing.
  std::array<std::uint32_t, 3> left{};
  std::size_t count = 0;
  bool is_whole = true;
  for (const std::uint32_t v : vertices_of(mesh_, found.primitive)) {
    const std::uint32_t label = labels_.of_vertex(v);
    if (label == first[0] || label == first[1] || label == first[2]) {
      is_whole = false;
    } else if (std::find(left.begin(), left.begin() + count, v) == left.begin() + count) {
      left[count++] = v;
    }
  }
  if (count == 0) return;
  if (is_whole) return offer_site(found.distance, found.site, best);
  if (count == 1) return offer_site(length(query - mesh_.vertices[left[0]]), SiteId(left[0]), best);
  offer_edge(mesh_, sites_, {std::min(left[0], left[1]), std::max(left[0], left[1])}, query, best);
}

SecondSite SecondSearch::find(const Vec3d& query, SiteId first, double first_distance, double limit) const {
  const SecondLabels::OfSite labels = labels_.of_site(sites_, first);
  SecondSite best;
  if (!labels_.has_second(labels)) return best;
  const Box3& box = bvh_.bounds();
  const double furthest = length(max(box.upper - query, query - box.lower));
  const double end = std::min(limit, furthest * (1 + 1e-9));
  double radius = std::min(end, 1.25 * first_distance + 1e-3 * box.diagonal());
  while (true) {
    bvh_.for_each_within(query, radius, [&](const NearestPrimitive& found) {
      offer(found, query, labels, best);
      return true;
    });
    if (best.distance <= radius || radius >= end) break;
    // What was found outside of the ball is in the next one, and nothing further can be closer.
    radius = std::min({end, best.distance, 2 * radius});
  }
  return best.distance <= limit ? best : SecondSite{};
}

}  // namespace blum
