#include "voronoi/traced/seam_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "blum/core/parallel.hpp"
#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {
namespace {

constexpr std::uint32_t none = TracedStructure::none;
/// Traces that are computed at once. Their number must not depend on the number of threads. In a larger group, more
/// seams are traced from both ends.
constexpr std::size_t group_size = 64;
/// One trace may take this part of the work: traces of a group do not know of each other.
constexpr std::uint64_t share_of_trace = 8;
/// The seams that leave a junction with more sites are found only once.
constexpr std::size_t many_sites = 12;

/// Returns the middle of the longest piece of a curve. Traces have many points near their ends, so it is far from both.
std::pair<Vec3d, Vec3d> middle_of(const std::vector<Vec3d>& points) {
  std::size_t longest = 1;
  const auto size_of = [&](std::size_t k) { return squared_length(points[k] - points[k - 1]); };
  for (std::size_t k = 2; k < points.size(); ++k) {
    if (size_of(k) > size_of(longest)) longest = k;
  }
  return {0.5 * (points[longest] + points[longest - 1]), unit(points[longest] - points[longest - 1])};
}

}  // namespace

const Vec3d& point_next_to(const TracedStructure::Curve& curve, std::uint32_t end, double tolerance) {
  constexpr double apart = 256;
  const std::size_t count = curve.points.size();
  const auto at = [&](std::size_t k) -> const Vec3d& { return curve.points[end == 0 ? k : count - 1 - k]; };
  std::size_t k = 1;
  while (k + 1 < count && length(at(k) - at(0)) < apart * tolerance) ++k;
  return at(k);
}

SeamGraph::SeamGraph(const TracedSites& sites, std::uint64_t most_work, const Context& context)
    : sites_(sites), context_(context), work_{0, most_work}, tracer_(sites, work_) {
  add_vertices();
  add_edges();
}

void SeamGraph::add_vertices() {
  for (std::uint32_t v = 0; v < sites_.vertices().size(); ++v) {
    out_.junctions.push_back({sites_.vertices()[v], 0, {}, v});
    rays_.emplace_back();
  }
}

void SeamGraph::add_edges() {
  for (const BorderEdge& edge : sites_.edges()) {
    Curve curve;
    curve.ends = edge.vertices;
    curve.points = {sites_.vertices()[edge.vertices[0]], sites_.vertices()[edge.vertices[1]]};
    curve.is_edge = true;
    const Vec3d along = unit(curve.points[1] - curve.points[0]);
    curve.directions = {along, -along};
    const Vec3d& first = sites_[edge.faces[0]].direction;
    const Vec3d& second = sites_[edge.faces[1]].direction;
    // Counterclockwise within the solid, the second face comes first.
    if (edge.is_reflex()) {
      curve.ring.germs = {{edge.faces[1], edge.own, second}, {edge.own, edge.faces[0], first}};
    } else {
      curve.ring.germs = {{edge.faces[1], edge.faces[0], unit(first + second)}};
    }
    out_.curves.push_back(std::move(curve));
  }
}

void SeamGraph::start_at_edges() {
  std::vector<Walk> walks;
  for (std::uint32_t k = 0; k < sites_.edges().size(); ++k) {
    const Curve& edge = out_.curves[k];
    constexpr double share = 0.4671;  // not in the middle, where symmetric solids may have junctions
    const Vec3d way = edge.points[1] - edge.points[0];
    const Vec3d middle = edge.points[0] + way * share;
    const double start = std::max(1e-4 * length(way), 64 * sites_.tolerance());
    for (const RegionRing::Germ& germ : edge.ring.germs) {
      walks.push_back({{germ.before, germ.after}, middle + germ.direction * start, germ.direction, edge.directions[0]});
    }
  }
  walk(walks);
}

void SeamGraph::cross(std::span<const Side> sides) {
  std::vector<Walk> walks;
  for (const Side& side : sides) {
    if (auto found = across(side)) walks.push_back(*found);
  }
  walk(walks);
}

std::optional<SeamGraph::Walk> SeamGraph::across(const Side& side) const {
  const Curve& curve = out_.curves[side.curve];
  if (curve.is_edge) return std::nullopt;
  const auto [guess, chord] = middle_of(curve.points);
  const auto at = tracer_.point_in_plane(curve.curve, guess, chord);
  if (!at) throw TraceProblem{"a seam has no middle", guess};
  Vec3d along = tracer_.tangent(curve.curve, *at);
  if (dot(along, chord) < 0) along = -along;
  const RegionRing::Germ& wanted = curve.ring.germs[side.germ];
  for (const RegionRing::Germ& germ : LocalStar(sites_, *at, curve.curve.sites).ray(along).ring.germs) {
    if (germ.before != wanted.before || germ.after != wanted.after) continue;
    return Walk{{germ.before, germ.after}, *at, germ.direction, along};
  }
  throw TraceProblem{"the regions around a seam change", *at};
}

void SeamGraph::walk(std::span<const Walk> walks) {
  std::vector<Traced> traces(walks.size());
  for (std::size_t first = 0; first < walks.size(); first += group_size) {
    const std::size_t size = std::min(group_size, walks.size() - first);
    parallel_for(context_, size, 4, "walls", [&](const WorkRange& range) {
      for (std::size_t k = first + range.begin; k < first + range.end; ++k) traces[k] = trace_walk(walks[k]);
    });
    for (std::size_t k = first; k < first + size; ++k) count(traces[k]);
  }
  for (const auto& [trace, seams, work] : traces) {
    if (trace.end == TraceEnd::failed) throw TraceProblem{"a walk along a wall failed", trace.points.back()};
    if (trace.end == TraceEnd::event) reach(trace.points.back(), trace.sites);
  }
  finish_rays();
}

TraceWork SeamGraph::work_of_trace() const {
  return {0, std::min(work_.left(), work_.most / share_of_trace)};
}

void SeamGraph::count(const Traced& traced) {
  work_.done += traced.work;
  const bool is_long = traced.work > work_.most / share_of_trace;
  if (is_long || work_.is_exhausted()) throw TraceProblem{"tracing is too much work", traced.trace.points.back()};
}

SeamGraph::Traced SeamGraph::trace_walk(const Walk& walk) const {
  const auto& [a, b] = walk.sites;
  // Edges from one vertex have two planes between them; the footprints ahead select one.
  const Vec3d ahead = walk.start + walk.towards * (1e-3 * sites_.distance(a, walk.start));
  const TracedCurve curve{{tracer_.between(a, b, ahead), TracedSurface::plane(walk.normal, walk.start)},
                          {std::min(a, b), std::max(a, b)}};
  TraceWork work = work_of_trace();
  Traced out{SeamTracer(sites_, work).trace(curve, walk.start, walk.towards, {walk.start, {}}), {}, 0};
  out.work = work.done;
  return out;
}

/// Follows the junction or seam at the end of a walk, if it is not known yet.
void SeamGraph::reach(const Vec3d& at, const std::vector<Index>& found) {
  if (is_known(at, found)) return;
  std::vector<LeavingSeam> seams = leaving_seams(sites_, tracer_, at, found);
  constexpr double straight = -0.99;  // cosine
  if (seams.size() == 2 && dot(seams[0].ray.direction, seams[1].ray.direction) < straight &&
      seams[0].ray.sites == seams[1].ray.sites) {
    follow(at, seams);
    return;
  }
  if (seams.size() < 2) throw TraceProblem{"a wall ends at a point without seams", at};
  std::ignore = junction_at(at, found, std::move(seams));
}

bool SeamGraph::is_known(const Vec3d& at, const std::vector<Index>& found) const {
  if (find_junction(at, found) != none) return true;
  const auto curves = seams_of_.find(found);
  if (curves == seams_of_.end()) return false;
  return std::any_of(curves->second.begin(), curves->second.end(), [&](std::uint32_t c) {
    const std::vector<Vec3d>& points = out_.curves[c].points;
    for (std::size_t k = 1; k < points.size(); ++k) {
      const Vec3d way = points[k] - points[k - 1];
      const double share = dot(at - points[k - 1], way) / squared_length(way);
      if (!(share >= 0 && share <= 1)) continue;
      // The curve bends away from the chord by less than a quarter of its length.
      const double away = length(points[k - 1] + way * share - at);
      if (away > 0.25 * length(way) + 64 * sites_.tolerance()) continue;
      const auto own = tracer_.point_in_plane(out_.curves[c].curve, points[k - 1] + way * share, unit(way));
      if (own && length(*own - at) <= 1e-6 * sites_.extent() + sites_.blur(sites_.distance(found[0], at))) return true;
    }
    return false;
  });
}

/// Traces a seam from a point inside it to its ends.
void SeamGraph::follow(const Vec3d& at, const std::vector<LeavingSeam>& seams) {
  std::array<Trace, 2> both;
  for (const std::size_t k : {0U, 1U}) {
    Traced found = trace_seam(at, seams[k], seams[k].ray.sites);
    count(found);
    both[k] = std::move(found.trace);
    if (both[k].end == TraceEnd::event) {
      // The junction's own rays contain this seam.
      std::ignore = junction_at(both[k].points.back(), both[k].sites, std::move(found.seams));
      return;
    }
    if (both[k].end == TraceEnd::closed) {
      add_closed(at, seams[0], both[k]);
      return;
    }
    if (both[k].end != TraceEnd::vertex) throw TraceProblem{"the trace of a seam failed", both[k].points.back()};
  }
  Curve curve;
  curve.ends = {both[0].vertex, both[1].vertex};
  curve.points.assign(both[0].points.rbegin(), both[0].points.rend());
  curve.points.insert(curve.points.end(), both[1].points.begin() + 1, both[1].points.end());
  curve.curve = seams[1].curve;
  curve.ring = seams[1].ray.ring;
  set_directions(curve, direction_from(curve, curve.points[0], point_next_to(curve, 0, sites_.tolerance())));
  add_curve(std::move(curve));
}

void SeamGraph::add_closed(const Vec3d& at, const LeavingSeam& seam, const Trace& trace) {
  const auto junction = static_cast<std::uint32_t>(out_.junctions.size());
  out_.junctions.push_back({at, sites_.distance(seam.ray.sites[0], at), seam.ray.sites, none});
  junctions_by_x_.emplace(at.x, junction);
  rays_.emplace_back();
  Curve curve;
  curve.ends = {junction, junction};
  curve.points = trace.points;
  curve.curve = seam.curve;
  curve.ring = seam.ray.ring;
  set_directions(curve, seam.chord);
  add_curve(std::move(curve));
}

/// Returns the junction at a position. Where curves touch, positions are less precise, so the same sites within a
/// larger distance are the same junction.
std::uint32_t SeamGraph::find_junction(const Vec3d& at, const std::vector<Index>& found) const {
  const double distance = sites_.precision().apart;
  const double larger = std::max(distance, sites_.blur(sites_.distance(found[0], at)));
  const auto end = junctions_by_x_.upper_bound(at.x + larger);
  for (auto it = junctions_by_x_.lower_bound(at.x - larger); it != end; ++it) {
    const Junction& junction = out_.junctions[it->second];
    const double apart = length(junction.at - at);
    if (apart <= distance || (apart <= larger && junction.sites == found)) return it->second;
  }
  return none;
}

std::uint32_t SeamGraph::junction_at(const Vec3d& at, const std::vector<Index>& found, std::vector<LeavingSeam> seams) {
  const std::uint32_t known = find_junction(at, found);
  if (known != none) return known;
  if (seams.empty()) seams = leaving_seams(sites_, tracer_, at, found);
  const auto number = static_cast<std::uint32_t>(out_.junctions.size());
  out_.junctions.push_back({at, sites_.distance(found[0], at), found, none});
  junctions_by_x_.emplace(at.x, number);
  rays_.emplace_back();
  for (LeavingSeam& seam : seams) {
    waiting_.emplace_back(number, static_cast<std::uint32_t>(rays_.back().size()));
    rays_.back().push_back({std::move(seam), none});
  }
  return number;
}

void SeamGraph::finish_rays() {
  while (!waiting_.empty()) {
    std::vector<RayId> group;
    while (!waiting_.empty() && group.size() < group_size) {
      const RayId next = waiting_.front();
      waiting_.pop_front();
      if (rays_[next.first][next.second].curve == none) group.push_back(next);
    }
    std::vector<Traced> traced(group.size());
    parallel_for(context_, group.size(), 2, "seams", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        const Junction& from = out_.junctions[group[k].first];
        traced[k] = trace_seam(from.at, rays_[group[k].first][group[k].second].seam, from.sites);
      }
    });
    for (const Traced& each : traced) count(each);
    for (std::size_t k = 0; k < group.size(); ++k) {
      // Another trace of the group may have arrived from the other end.
      if (rays_[group[k].first][group[k].second].curve == none) add_traced(group[k], std::move(traced[k]));
    }
  }
}

SeamGraph::Traced SeamGraph::trace_seam(const Vec3d& at, const LeavingSeam& seam,
                                        const std::vector<Index>& left) const {
  TraceWork work = work_of_trace();
  const SeamTracer tracer(sites_, work);
  Traced out{tracer.trace(seam.curve, seam.start, seam.ray.direction, {at, left}), {}, 0};
  if (seam.start != at) out.trace.points.insert(out.trace.points.begin(), at);
  // Many seams may arrive at a junction of many sites at once.
  if (out.trace.end == TraceEnd::event && out.trace.sites.size() <= many_sites &&
      find_junction(out.trace.points.back(), out.trace.sites) == none) {
    out.seams = leaving_seams(sites_, tracer, out.trace.points.back(), out.trace.sites);
  }
  out.work = work.done;
  return out;
}

void SeamGraph::add_traced(const RayId& from, Traced traced) {
  const Trace& trace = traced.trace;
  if (trace.end == TraceEnd::failed || trace.end == TraceEnd::border) {
    throw TraceProblem{"the trace of a seam failed", trace.points.back()};
  }
  const LeavingSeam& seam = rays_[from.first][from.second].seam;
  Curve curve;
  curve.points = trace.points;
  curve.ring = seam.ray.ring;
  curve.curve = seam.curve;
  curve.ends = {from.first, trace.end == TraceEnd::closed ? from.first : trace.vertex};
  set_directions(curve, seam.chord);
  const auto number = static_cast<std::uint32_t>(out_.curves.size());
  rays_[from.first][from.second].curve = number;
  if (trace.end == TraceEnd::event) {
    curve.ends[1] = junction_at(trace.points.back(), trace.sites, std::move(traced.seams));
    curve.points.back() = out_.junctions[curve.ends[1]].at;
  }
  if (trace.end != TraceEnd::vertex) take_ray(curve.ends[1], curve, number);
  add_curve(std::move(curve));
}

/// Marks the ray of a junction along which a curve arrives.
void SeamGraph::take_ray(std::uint32_t junction, Curve& curve, std::uint32_t number) {
  Ray* best = nullptr;
  double most = -std::numeric_limits<double>::infinity();
  for (Ray& ray : rays_[junction]) {
    if (ray.curve != none) continue;
    // Several seams may have this tangent. Those between the same sites come first: if junctions are very close, a seam
    // has turned before its direction can be measured.
    constexpr double same_way = 0.99;
    const bool has_same_sites = ray.seam.ray.sites == curve.curve.sites;
    const double cosine = dot(ray.seam.ray.direction, curve.directions[1]);
    if (!has_same_sites && cosine < same_way) continue;
    const double score = cosine + (has_same_sites ? 4 : 0);
    if (score <= most) continue;
    most = score;
    best = &ray;
  }
  if (best == nullptr) {
    throw TraceProblem{"a seam arrives at a junction that has no such seam", out_.junctions[junction].at};
  }
  best->curve = number;
  curve.directions[1] = best->seam.chord;
}

void SeamGraph::add_curve(Curve curve) {
  seams_of_[curve.curve.sites].push_back(static_cast<std::uint32_t>(out_.curves.size()));
  out_.curves.push_back(std::move(curve));
}

/// Returns the direction of a curve at one of its ends, from the end. Its tangent there may not be determined, because
/// two of its sites may have one footprint.
Vec3d SeamGraph::direction_from(const Curve& curve, const Vec3d& end, const Vec3d& next) const {
  const Vec3d chord = unit(next - end);
  const double radius = sites_.distance(curve.curve.sites[0], end);
  const double step = std::min(1e-3 * radius, 0.5 * length(next - end));
  const auto near = tracer_.point_in_plane(curve.curve, end + chord * step, chord);
  return near && length(*near - end) > 0.1 * step ? unit(*near - end) : chord;
}

void SeamGraph::set_directions(Curve& curve, const Vec3d& first) const {
  curve.directions = {first, direction_from(curve, curve.points.back(), point_next_to(curve, 1, sites_.tolerance()))};
}

}  // namespace blum::voronoi
