#include "voronoi/traced/traced_structure.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>

#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {
namespace {

using Index = TracedSites::Index;
using Junction = TracedStructure::Junction;
using Curve = TracedStructure::Curve;
constexpr std::uint32_t none = TracedStructure::none;

/// Stops the tracing. Caught in traced_structure().
struct Problem {
  std::string text;
  Vec3d place;
};

/// Points by their place, for a search within a small distance.
class PlaceIndex {
 public:
  explicit PlaceIndex(const TracedSites& sites) : sites_(sites), distance_(16 * sites.tolerance()) {}

  /// Returns the junction at a place. Where curves touch, places are less precise, so the same sites within a larger
  /// distance are the same junction.
  [[nodiscard]] std::uint32_t find(const Vec3d& at, double radius, const std::vector<Index>& found,
                                   const std::vector<Junction>& all) const {
    const double larger = std::max(distance_, sites_.blur(radius));
    const auto lowest = by_x_.lower_bound(at.x - larger);
    for (auto it = lowest; it != by_x_.end() && it->first <= at.x + larger; ++it) {
      const double apart = length(all[it->second].at - at);
      if (apart <= distance_ || (apart <= larger && all[it->second].sites == found)) return it->second;
    }
    return none;
  }
  void add(const Vec3d& at, std::uint32_t k) { by_x_.emplace(at.x, k); }

 private:
  const TracedSites& sites_;
  const double distance_;
  std::multimap<double, std::uint32_t> by_x_;
};

class Builder {
 public:
  Builder(const TracedSites& sites, const Context& context)
      : sites_(sites), context_(context), tracer_(sites), places_(sites) {}

  TracedStructure build() {
    add_vertices();
    add_edges();
    for (const BorderEdge& edge : sites_.edges()) start_at(edge);
    finish_rays();
    // Sheets may have several boundaries. The others are found from within.
    for (std::uint32_t k = 0; k < out_.curves.size(); ++k) {
      cross_sheets_of(k);
      finish_rays();
    }
    link_germs();
    find_loops();
    return std::move(out_);
  }

 private:
  struct Ray {
    SeamRay ray;
    Vec3d start;  ///< a point of the seam: the junction, or a point near it
    Vec3d chord;  ///< direction of a point of the seam; seams with one tangent differ in it
    std::uint32_t curve = none;
  };

  /// Returns the seams that leave a point. Several seams may have one tangent, and sites may be equally close only to
  /// first order. A plane near the point shows which seams exist.
  [[nodiscard]] std::vector<Ray> rays_at(const Vec3d& at, const std::vector<Index>& found) const {
    std::vector<Ray> out;
    const double radius = sites_.distance(found[0], at);
    for (SeamRay& ray : LocalStar(sites_, at, found).rays()) {
      if (ray.sites.size() < 4 && ray.ring.germs.size() == 3 && has_three_footprints(at, ray.sites)) {
        const Vec3d direction = ray.direction;
        out.push_back({std::move(ray), at, direction, none});
        continue;
      }
      // Seams that part by the square of the step must be clearly apart.
      double step = std::clamp(8 * std::sqrt(sites_.tolerance() * radius), 0.02 * radius, 0.25 * radius);
      constexpr int most_tries = 8;
      bool is_any = false;
      for (int k = 0; k < most_tries && !is_any; ++k, step *= 0.25) {
        for (const Vec3d& start :
             tracer_.seam_points(ray.sites, at + ray.direction * step, ray.direction, 0.2 * step)) {
          const TracedSites::Closest closest = sites_.closest(start, sites_.tolerance());
          if (!std::includes(ray.sites.begin(), ray.sites.end(), closest.sites.begin(), closest.sites.end())) continue;
          const auto curve = tracer_.curve_of(closest.sites, start, ray.direction);
          if (!curve) continue;
          Vec3d along = tracer_.tangent(*curve, start);
          if (dot(along, ray.direction) < 0) along = -along;
          SeamRay own = LocalStar(sites_, start, closest.sites).ray(along);
          if (own.ring.germs.size() < 3) continue;
          own.direction = ray.direction;
          out.push_back({std::move(own), start, unit(start - at), none});
          is_any = true;
        }
      }
    }
    return out;
  }

  [[nodiscard]] bool has_three_footprints(const Vec3d& at, const std::vector<Index>& found) const {
    if (found.size() != 3) return false;
    const auto apart = [&](std::size_t a, std::size_t b) {
      return length(sites_.gradient(found[a], at) - sites_.gradient(found[b], at)) > 1e-5;
    };
    return apart(0, 1) && apart(0, 2) && apart(1, 2);
  }

  void add_vertices() {
    for (std::uint32_t v = 0; v < sites_.vertices().size(); ++v) {
      out_.junctions.push_back({sites_.vertices()[v], 0, {}, v});
      rays_.emplace_back();
    }
  }

  void add_edges() {
    for (const BorderEdge& edge : sites_.edges()) {
      Curve curve;
      curve.ends = edge.vertices;
      curve.points = {sites_.vertices()[edge.vertices[0]], sites_.vertices()[edge.vertices[1]]};
      curve.is_edge = true;
      const Vec3d first = sites_[edge.faces[0]].direction;
      const Vec3d second = sites_[edge.faces[1]].direction;
      // Within the solid, the second face comes first.
      if (edge.is_reflex()) {
        curve.ring.germs = {{edge.faces[1], edge.own, second}, {edge.own, edge.faces[0], first}};
      } else {
        curve.ring.germs = {{edge.faces[1], edge.faces[0], unit(first + second)}};
      }
      out_.curves.push_back(std::move(curve));
    }
  }

  /// Walks along the walls that end at the middle of an edge.
  void start_at(const BorderEdge& edge) {
    const Vec3d& a = sites_.vertices()[edge.vertices[0]];
    const Vec3d& b = sites_.vertices()[edge.vertices[1]];
    const Vec3d along = unit(b - a);
    const Vec3d first = sites_[edge.faces[0]].direction;
    const Vec3d second = sites_[edge.faces[1]].direction;
    constexpr double share = 0.4671;  // not in the middle, where symmetric solids may have junctions
    const Vec3d middle = a + (b - a) * share;
    const double start = std::max(1e-4 * length(b - a), 64 * sites_.tolerance());
    if (edge.is_reflex()) {
      walk(edge.own, edge.faces[0], middle + first * start, first, TracedSurface::plane(along, middle));
      walk(edge.own, edge.faces[1], middle + second * start, second, TracedSurface::plane(along, middle));
      return;
    }
    const Vec3d way = unit(first + second);
    walk(edge.faces[0], edge.faces[1], middle + way * start, way, TracedSurface::plane(along, middle));
  }

  /// Follows a wall in a plane to its border, and traces the seam there.
  void walk(Index a, Index b, const Vec3d& start, const Vec3d& towards, const TracedSurface& plane) {
    // Edges from one vertex have two planes between them; the footprints ahead select one.
    const Vec3d ahead = start + towards * (1e-3 * sites_.distance(a, start));
    const TracedCurve curve{{tracer_.between(a, b, ahead), plane}, {std::min(a, b), std::max(a, b)}};
    const Trace trace = tracer_.trace(curve, start, towards, {});
    if (trace.end == TraceEnd::failed) throw Problem{"a walk along a wall failed", trace.points.back()};
    if (trace.end == TraceEnd::event) reach(trace.points.back(), trace.sites);
  }

  /// Adds a junction, or traces the seam through a point.
  void reach(const Vec3d& at, const std::vector<Index>& found) {
    if (places_.find(at, sites_.distance(found[0], at), found, out_.junctions) != none) return;
    const std::vector<Ray> rays = rays_at(at, found);
    if (rays.size() == 2 && dot(rays[0].ray.direction, rays[1].ray.direction) < -0.99 &&
        rays[0].ray.sites == rays[1].ray.sites) {
      follow(at, rays);
      return;
    }
    if (rays.size() < 2) throw Problem{"a wall ends at a point without seams", at};
    std::ignore = junction_at(at, found);
  }

  [[nodiscard]] TracedCurve curve_of(const Ray& ray) const {
    const auto curve = tracer_.curve_of(ray.ray.sites, ray.start, ray.ray.direction);
    if (!curve) throw Problem{"sites do not determine a seam", ray.start};
    return *curve;
  }

  [[nodiscard]] Trace traced(const Vec3d& at, const Ray& ray, const std::vector<Index>& left) const {
    Trace out = tracer_.trace(curve_of(ray), ray.start, ray.ray.direction, left);
    if (ray.start != at) out.points.insert(out.points.begin(), at);
    if (out.end == TraceEnd::failed || out.end == TraceEnd::border)
      throw Problem{"the trace of a seam failed", out.points.back()};
    return out;
  }

  /// Traces a seam from a point inside it to its ends.
  void follow(const Vec3d& at, const std::vector<Ray>& rays) {
    std::array<Trace, 2> both;
    for (const std::size_t k : {0U, 1U}) {
      both[k] = traced(at, rays[k], rays[k].ray.sites);
      if (both[k].end == TraceEnd::event) {
        std::ignore = junction_at(both[k].points.back(), both[k].sites);
        return;
      }
      if (both[k].end == TraceEnd::closed) {
        add_closed(at, rays[0], both[k]);
        return;
      }
    }
    const std::array<std::uint32_t, 2> ends{both[0].vertex, both[1].vertex};
    for (const Curve& known : out_.curves) {
      if (known.is_edge || known.curve.sites != rays[1].ray.sites) continue;
      if (known.ends == ends || known.ends == std::array{ends[1], ends[0]}) return;
    }
    Curve curve;
    curve.ends = ends;
    curve.points.assign(both[0].points.rbegin(), both[0].points.rend());
    curve.points.insert(curve.points.end(), both[1].points.begin() + 1, both[1].points.end());
    curve.curve = curve_of(rays[1]);
    curve.ring = rays[1].ray.ring;
    set_directions(curve, direction_from(curve, curve.points[0], next_to(curve, 0)));
    out_.curves.push_back(std::move(curve));
  }

  void add_closed(const Vec3d& at, const Ray& ray, const Trace& trace) {
    const auto junction = static_cast<std::uint32_t>(out_.junctions.size());
    out_.junctions.push_back({at, sites_.distance(ray.ray.sites[0], at), ray.ray.sites, none});
    rays_.emplace_back();
    places_.add(at, junction);
    Curve curve;
    curve.ends = {junction, junction};
    curve.points = trace.points;
    curve.curve = curve_of(ray);
    curve.ring = ray.ray.ring;
    set_directions(curve, ray.chord);
    out_.curves.push_back(std::move(curve));
  }

  std::uint32_t junction_at(const Vec3d& at, const std::vector<Index>& found) {
    const std::uint32_t known = places_.find(at, sites_.distance(found[0], at), found, out_.junctions);
    if (known != none) return known;
    const auto number = static_cast<std::uint32_t>(out_.junctions.size());
    out_.junctions.push_back({at, sites_.distance(found[0], at), found, none});
    places_.add(at, number);
    rays_.emplace_back();
    rays_.back() = rays_at(at, found);
    for (std::uint32_t k = 0; k < rays_.back().size(); ++k) waiting_.emplace_back(number, k);
    return number;
  }

  void finish_rays() {
    while (!waiting_.empty()) {
      const auto [junction, k] = waiting_.front();
      waiting_.pop_front();
      if (rays_[junction][k].curve == none) trace_ray(junction, k);
      throw_if_cancelled(context_);
    }
  }

  void trace_ray(std::uint32_t from, std::uint32_t k) {
    const Vec3d at = out_.junctions[from].at;
    const Ray ray = rays_[from][k];
    const Trace trace = traced(at, ray, out_.junctions[from].sites);
    const auto number = static_cast<std::uint32_t>(out_.curves.size());
    Curve curve;
    curve.points = trace.points;
    curve.ring = ray.ray.ring;
    curve.curve = curve_of(ray);
    curve.ends = {from, trace.vertex};
    set_directions(curve, ray.chord);
    if (trace.end == TraceEnd::event) {
      curve.ends[1] = junction_at(trace.points.back(), trace.sites);
      curve.points.back() = out_.junctions[curve.ends[1]].at;
    }
    rays_[from][k].curve = number;
    if (trace.end == TraceEnd::closed) {
      curve.ends[1] = from;
      take_ray(from, curve, number);
    } else if (trace.end == TraceEnd::event) {
      take_ray(curve.ends[1], curve, number);
    }
    out_.curves.push_back(std::move(curve));
  }

  /// Returns the direction of a curve at one of its ends, from the end. Its tangent there may not be determined,
  /// because two of its sites may have one footprint.
  [[nodiscard]] Vec3d direction_from(const Curve& curve, const Vec3d& end, const Vec3d& next) const {
    const Vec3d chord = unit(next - end);
    const double radius = sites_.distance(curve.curve.sites[0], end);
    const double step = std::min(1e-3 * radius, 0.5 * length(next - end));
    const auto near = tracer_.point_in_plane(curve.curve, end + chord * step, chord);
    return near && length(*near - end) > 0.1 * step ? unit(*near - end) : chord;
  }

  void set_directions(Curve& curve, const Vec3d& first) const {
    curve.directions = {first, direction_from(curve, curve.points.back(), next_to(curve, 1))};
  }

  /// Returns the first point of a curve that is clearly apart from one of its ends.
  [[nodiscard]] const Vec3d& next_to(const Curve& curve, std::uint32_t end) const {
    constexpr double apart = 256;
    const std::size_t count = curve.points.size();
    const auto at = [&](std::size_t k) -> const Vec3d& { return curve.points[end == 0 ? k : count - 1 - k]; };
    std::size_t k = 1;
    while (k + 1 < count && length(at(k) - at(0)) < apart * sites_.tolerance()) ++k;
    return at(k);
  }

  /// Marks the ray of a junction along which a curve arrives.
  void take_ray(std::uint32_t junction, Curve& curve, std::uint32_t number) {
    const std::size_t count = curve.points.size();
    const Vec3d& end = curve.points[count - 1];
    const Vec3d back = curve.directions[1];
    Ray* best = nullptr;
    double most = 0;
    for (Ray& ray : rays_[junction]) {
      const double cosine = dot(ray.ray.direction, back);
      if (ray.curve != none || cosine < 0.99) continue;
      // Of several seams with one tangent, the one between the same sites.
      const double score = cosine + (ray.ray.sites == curve.curve.sites ? 1 : 0);
      if (score <= most) continue;
      most = score;
      best = &ray;
    }
    if (best == nullptr) throw Problem{"a seam arrives at a junction that has no such seam", end};
    best->curve = number;
    curve.directions[1] = best->chord;
  }

  /// Walks from a curve across its sheets, to their other boundaries.
  void cross_sheets_of(std::uint32_t k) {
    const Curve curve = out_.curves[k];
    if (curve.is_edge) return;
    // Traces have many points near their ends, so the longest piece is far from both.
    std::size_t middle = 1;
    const auto size_of = [&](std::size_t m) { return squared_length(curve.points[m] - curve.points[m - 1]); };
    for (std::size_t m = 2; m < curve.points.size(); ++m) {
      if (size_of(m) > size_of(middle)) middle = m;
    }
    const Vec3d guess = 0.5 * (curve.points[middle] + curve.points[middle - 1]);
    const Vec3d chord = unit(curve.points[middle] - curve.points[middle - 1]);
    const auto at = tracer_.point_in_plane(curve.curve, guess, chord);
    if (!at) throw Problem{"a seam has no middle", guess};
    Vec3d along = tracer_.tangent(curve.curve, *at);
    if (dot(along, chord) < 0) along = -along;
    const SeamRay ray = LocalStar(sites_, *at, curve.curve.sites).ray(along);
    if (ray.ring.germs.size() != curve.ring.germs.size()) throw Problem{"regions around a seam change", *at};
    for (const RegionRing::Germ& germ : ray.ring.germs) {
      walk(germ.before, germ.after, *at, germ.direction, TracedSurface::plane(along, *at));
    }
  }

  /// One side of a curve at one of its ends.
  struct GermEnd {
    std::uint32_t curve = 0;
    std::uint32_t germ = 0;
    std::uint32_t end = 0;
    Vec3d ray;         ///< direction of the curve away from the end
    Index before = 0;  ///< as seen along the ray
    Index after = 0;
    Vec3d direction;  ///< of the wall, across the ray
  };

  [[nodiscard]] std::size_t slot(std::uint32_t curve, std::uint32_t germ, std::uint32_t end) const {
    return 2 * (first_germ_[curve] + germ) + end;
  }

  /// Returns the sides of curves at all junctions.
  std::vector<std::vector<GermEnd>> germ_ends() {
    std::vector<std::vector<GermEnd>> out(out_.junctions.size());
    for (std::uint32_t c = 0; c < out_.curves.size(); ++c) {
      const Curve& curve = out_.curves[c];
      const std::size_t count = curve.points.size();
      for (const std::uint32_t end : {0U, 1U}) {
        const Vec3d& at = end == 0 ? curve.points[0] : curve.points[count - 1];
        const Vec3d& next = next_to(curve, end);
        const bool is_inside = !curve.is_edge && out_.junctions[curve.ends[end]].vertex == none;
        const Vec3d ray = is_inside ? curve.directions[end] : unit(next - at);
        const RegionRing& ring = curve.ring;
        for (std::uint32_t g = 0; g < ring.germs.size(); ++g) {
          const RegionRing::Germ& germ = ring.germs[g];
          GermEnd found{c, g, end, ray, germ.before, germ.after, germ.direction};
          if (end == 1) std::swap(found.before, found.after);
          found.direction = direction_at(curve, at, next, ray, germ);
          out[curve.ends[end]].push_back(found);
        }
      }
    }
    return out;
  }

  /// Returns the direction of a wall across a curve near its end.
  [[nodiscard]] Vec3d direction_at(const Curve& curve, const Vec3d& at, const Vec3d& next, const Vec3d& ray,
                                   const RegionRing::Germ& germ) const {
    if (curve.is_edge) return germ.direction;
    // Close to the end, but not at it: there, other sites are as close.
    Vec3d x = at + 0.5 * (next - at);
    if (const auto found = tracer_.point_in_plane(curve.curve, x, ray)) x = *found;
    Vec3d along = tracer_.tangent(curve.curve, x);
    if (dot(along, ray) < 0) along = -along;
    const SeamRay there = LocalStar(sites_, x, curve.curve.sites).ray(along);
    for (const RegionRing::Germ& other : there.ring.germs) {
      if ((other.before == germ.before && other.after == germ.after) ||
          (other.before == germ.after && other.after == germ.before)) {
        return other.direction;
      }
    }
    throw Problem{"regions around a seam change near its end", x};
  }

  void link_germs() {
    std::size_t count = 0;
    for (const Curve& curve : out_.curves) {
      first_germ_.push_back(count);
      count += curve.ring.germs.size();
    }
    link_.assign(2 * count, none_slot);
    const std::vector<std::vector<GermEnd>> at = germ_ends();
    for (std::size_t j = 0; j < at.size(); ++j) {
      for (const GermEnd& own : at[j]) {
        const GermEnd* best = nullptr;
        double least = std::numeric_limits<double>::infinity();
        for (const GermEnd& other : at[j]) {
          if (other.before != own.after || other.after != own.before) continue;
          if (&other == &own || (other.curve == own.curve && other.end == own.end)) continue;
          double angle = std::atan2(dot(other.ray, own.direction), dot(other.ray, own.ray));
          if (angle <= 0) angle += 2 * std::numbers::pi;
          if (angle >= least) continue;
          least = angle;
          best = &other;
        }
        if (best == nullptr) throw Problem{"a sheet ends at a junction", out_.junctions[j].at};
        link_[slot(own.curve, own.germ, own.end)] = slot(best->curve, best->germ, best->end);
      }
    }
    for (std::size_t k = 0; k < link_.size(); ++k) {
      if (link_[link_[k]] == k) continue;
      throw Problem{"sheets at a junction do not match", {}};
    }
  }

  void find_loops() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> owner;  // (curve, germ)
    for (std::uint32_t c = 0; c < out_.curves.size(); ++c) {
      for (std::uint32_t g = 0; g < out_.curves[c].ring.germs.size(); ++g) owner.emplace_back(c, g);
    }
    std::vector<bool> is_done(owner.size(), false);
    for (std::size_t k = 0; k < owner.size(); ++k) {
      if (is_done[k]) continue;
      const RegionRing::Germ& germ = out_.curves[owner[k].first].ring.germs[owner[k].second];
      TracedStructure::Sheet sheet{germ.before, germ.after, {{}}};
      if (sites_[sheet.first].number > sites_[sheet.second].number) std::swap(sheet.first, sheet.second);
      std::size_t at = 2 * k;  // the start of the curve
      do {
        const auto [curve, g] = owner[at / 2];
        is_done[at / 2] = true;
        sheet.loops.front().push_back({curve, at % 2 == 0});
        at = link_[at ^ 1U];
      } while (at != 2 * k && sheet.loops.front().size() <= owner.size());
      out_.sheets.push_back(std::move(sheet));
    }
  }

  static constexpr std::size_t none_slot = static_cast<std::size_t>(-1);

  const TracedSites& sites_;
  const Context& context_;
  const SeamTracer tracer_;
  PlaceIndex places_;
  TracedStructure out_;
  std::vector<std::vector<Ray>> rays_;                           ///< of each junction
  std::deque<std::pair<std::uint32_t, std::uint32_t>> waiting_;  ///< (junction, ray)
  std::vector<std::size_t> first_germ_;
  std::vector<std::size_t> link_;
};

}  // namespace

TracedResult traced_structure(const TracedSites& sites, const Context& context) {
  TracedResult out;
  try {
    out.structure = Builder(sites, context).build();
  } catch (const Problem& problem) {
    out.problem = problem.text;
    out.place = problem.place;
  }
  return out;
}

}  // namespace blum::voronoi
