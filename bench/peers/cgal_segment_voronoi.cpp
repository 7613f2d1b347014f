// CGAL's Voronoi diagram of segments in the plane. CGAL is GPL: only benchmarks link to it.
#include "peers/segment_voronoi.hpp"

#ifdef BLUM_BENCH_CGAL
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Segment_Delaunay_graph_2.h>
#include <CGAL/Segment_Delaunay_graph_filtered_traits_2.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace blum::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Traits = CGAL::Segment_Delaunay_graph_filtered_traits_without_intersections_2<Kernel>;
using Graph = CGAL::Segment_Delaunay_graph_2<Traits>;
using Parabola = CGAL::Parabola_segment_2<Traits>;

bool is_inside(std::span<const Point2> polygon, const Point2& q) {
  bool inside = false;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const auto& [ax, ay] = polygon[k];
    const auto& [bx, by] = polygon[(k + 1) % polygon.size()];
    if ((ay > q[1]) != (by > q[1]) && q[0] < ax + (bx - ax) * (q[1] - ay) / (by - ay)) inside = !inside;
  }
  return inside;
}

Point2 point(const Kernel::Point_2& p) {
  return {p.x(), p.y()};
}

/// The ends of an edge and a point between them; empty for rays and lines, which leave the polygon.
std::vector<Point2> sample(const CGAL::Object& edge) {
  Kernel::Segment_2 segment;
  Parabola parabola;
  if (CGAL::assign(segment, edge)) {
    return {point(segment.source()), point(CGAL::midpoint(segment.source(), segment.target())),
            point(segment.target())};
  }
  if (!CGAL::assign(parabola, edge)) return {};
  std::vector<Kernel::Point_2> points;
  parabola.generate_points(points, 1e-3);
  if (points.size() < 2) return {};
  const Kernel::Point_2 middle =
      points.size() > 2 ? points[points.size() / 2] : CGAL::midpoint(points.front(), points.back());
  return {point(points.front()), point(middle), point(points.back())};
}

class Numbers {
 public:
  explicit Numbers(std::span<const Point2> polygon) : count_(static_cast<std::uint32_t>(polygon.size())) {
    for (std::uint32_t k = 0; k < count_; ++k) number_[{polygon[k][0], polygon[k][1]}] = k;
  }
  [[nodiscard]] std::uint32_t of(const Graph::Site_2& site) const {
    if (site.is_point()) return count_ + at(site.point());
    const std::uint32_t source = at(site.source());
    const std::uint32_t target = at(site.target());
    return (source + 1) % count_ == target ? source : target;
  }

 private:
  [[nodiscard]] std::uint32_t at(const Kernel::Point_2& p) const { return number_.at({p.x(), p.y()}); }
  std::uint32_t count_;
  std::map<std::pair<double, double>, std::uint32_t> number_;
};

}  // namespace

std::optional<PeerSegmentVoronoi> cgal_segment_voronoi(std::span<const Point2> polygon) {
  PeerSegmentVoronoi out;
  Graph graph;
  out.times = time_runs([&] {
    graph.clear();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const auto& [ax, ay] = polygon[k];
      const auto& [bx, by] = polygon[(k + 1) % polygon.size()];
      graph.insert(Kernel::Point_2(ax, ay), Kernel::Point_2(bx, by));
    }
  });
  const Numbers numbers(polygon);
  for (auto edge = graph.finite_edges_begin(); edge != graph.finite_edges_end(); ++edge) {
    const std::vector<Point2> points = sample(graph.primal(*edge));
    if (points.empty() || !is_inside(polygon, points[1])) continue;
    const double length = std::hypot(points[2][0] - points[0][0], points[2][1] - points[0][1]);
    const auto first = edge->first->vertex(Graph::cw(edge->second));
    const auto second = edge->first->vertex(Graph::ccw(edge->second));
    const auto [low, high] = std::minmax({numbers.of(first->site()), numbers.of(second->site())});
    out.edges.push_back({{low, high}, length});
  }
  return out;
}

}  // namespace blum::bench

#else

namespace blum::bench {

std::optional<PeerSegmentVoronoi> cgal_segment_voronoi(std::span<const Point2>) {
  return std::nullopt;
}

}  // namespace blum::bench

#endif
