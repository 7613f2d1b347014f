#include "medial_axis/surface/solid_paths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace blum::detail {
namespace {

/// Greatest number of stops that pushed() may put between two stops, and greatest depth of its recursion.
constexpr int most_moves = 24;
constexpr int most_depth = 8;
constexpr std::size_t most_landmarks = 48;
/// Greatest number of segments that a search over landmarks tests.
constexpr int most_looks = 200;
/// To scatter points, a cube around two stops is cut into `parts` parts along each axis. `strewn_parts` lists the
/// attempts in order; `has_creases` adds points at creases. A segment of the search is at most `most_parts` parts long.
/// At most `most_looks_at_strewn` segments are tested.
struct StrewnParts {
  int parts;
  bool has_creases;
};
constexpr std::array<StrewnParts, 3> strewn_parts{{{6, false}, {12, false}, {8, true}}};
constexpr std::size_t most_strewn = 6000;
constexpr double most_parts = 2.2;
constexpr int most_looks_at_strewn = 20000;
constexpr double any_length = std::numeric_limits<double>::infinity();
/// Least depth of a stop, relative to its largest coordinate. Because of rounding, points closer to the surface may lie
/// on either side of it.
constexpr double least_depth = 1e-12;
/// Least overlap of the balls around the ends of a segment, relative to its length. It exceeds rounding errors.
constexpr double overlap = 1e-9;

Footprint foot_of(const NearestPoint& nearest) {
  return {nearest.point, nearest.element, 7};
}

/// Returns the unit direction away from the wall closest to a stop.
Vec3d away_from_wall(const Stop& stop) {
  return (stop.at - stop.nearest.point) / stop.nearest.distance;
}

}  // namespace

std::optional<Stop> SolidPaths::stop_at(const Vec3d& at, const Footprint& near) const {
  if (within_ && !holds(*within_, at)) return std::nullopt;
  const NearestPoint nearest = surface_.nearest(at, near);
  const double size = std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)});
  if (!(nearest.distance > least_depth * size) || !surface_.is_inside(at, nearest)) return std::nullopt;
  return Stop{at, nearest};
}

Stop SolidPaths::inside_near(const Vec3d& at, const Stop& near) const {
  if (const auto stop = stop_at(at, foot_of(near.nearest))) return *stop;
  if (const auto stop = pushed_in(at, near)) return *stop;
  const NearestPoint foot = surface_.nearest(at, foot_of(near.nearest));
  return {foot.point, surface_.nearest(foot.point, foot_of(foot))};
}

const SurfacePart* SolidPaths::part_at(std::initializer_list<const Stop*> stops) const {
  if (part_ == nullptr) return nullptr;
  const auto is_there = [&](const Stop* stop) { return holds(part_->box, stop->at); };
  return std::all_of(stops.begin(), stops.end(), is_there) ? part_.get() : nullptr;
}

bool SolidPaths::is_straight(const Stop& a, const Stop& b) const {
  const double size = length(b.at - a.at);
  // A ball lies in the solid if its centre does and its radius is the depth of its centre.
  if (a.nearest.distance + b.nearest.distance >= size * (1 + overlap)) return true;
  return !surface_.first_crossing(a.at, b.at, part_at({&a, &b}));
}

bool SolidPaths::is_open(const Stop& a, const Stop& b, const Stop& c) const {
  const auto holds_others = [](const Stop& ball, const Stop& p, const Stop& q) {
    const double reach = ball.nearest.distance * (1 - overlap);
    return length(p.at - ball.at) <= reach && length(q.at - ball.at) <= reach;
  };
  if (holds_others(a, b, c) || holds_others(b, c, a) || holds_others(c, a, b)) return true;
  return !surface_.crosses(a.at, b.at, c.at, part_at({&a, &b, &c}));
}

bool SolidPaths::can_sweep(const std::array<Stop, 2>& from, const std::array<Stop, 2>& to) const {
  const auto is_swept = [&](std::size_t first, std::size_t second) {
    return is_straight(from[second], to[first]) && is_open(from[first], from[second], to[first]) &&
           is_open(from[second], to[first], to[second]);
  };
  return is_swept(0, 1) || is_swept(1, 0);
}

std::vector<Stop> SolidPaths::pulled_over_open(std::vector<Stop> path) const {
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (std::size_t k = 1; k + 1 < path.size();) {
      const bool goes = is_straight(path[k - 1], path[k + 1]) && is_open(path[k - 1], path[k], path[k + 1]);
      if (goes) path.erase(path.begin() + static_cast<std::ptrdiff_t>(k));
      has_changed = has_changed || goes;
      if (!goes) ++k;
    }
  }
  return path;
}

/// Returns a stop inside the solid for a point outside: the point mirrored at the surface. If the solid is thin, the
/// stop is less deep. It is then moved to the middle of a thin part.
std::optional<Stop> SolidPaths::pushed_in(const Vec3d& outside, const Stop& near) const {
  constexpr int most_tries = 24;
  const NearestPoint foot = surface_.nearest(outside, foot_of(near.nearest));
  Vec3d move = foot.point - outside;
  for (int n = 0; n < most_tries; ++n, move *= 0.25) {
    if (const auto stop = stop_at(foot.point + move, foot_of(foot))) return centred(*stop);
  }
  return std::nullopt;
}

/// Returns a stop at a crease, where a thin part of the solid bends. Take the planes through two stops that are
/// parallel to the walls next to them. The stop is the point of both planes that is closest to the midpoint of the two
/// stops.
std::optional<Stop> SolidPaths::at_crease(const Stop& a, const Stop& b) const {
  constexpr double least_turn = 1e-3;  // squared sine
  if (!(a.nearest.distance > 0 && b.nearest.distance > 0)) return std::nullopt;
  const Vec3d u = (a.nearest.point - a.at) / a.nearest.distance;
  const Vec3d v = (b.nearest.point - b.at) / b.nearest.distance;
  const double cosine = dot(u, v);
  const double turn = 1 - cosine * cosine;
  if (!(turn > least_turn)) return std::nullopt;
  const Vec3d middle = 0.5 * (a.at + b.at);
  const double p = dot(u, a.at - middle);
  const double q = dot(v, b.at - middle);
  const Vec3d x = middle + u * ((p - cosine * q) / turn) + v * ((q - cosine * p) / turn);
  if (squared_length(x - middle) > squared_length(b.at - a.at)) return std::nullopt;
  const std::optional<Stop> stop = stop_at(x, foot_of(a.nearest));
  return stop ? centred(*stop) : pushed_in(x, a);
}

/// Returns the projection of a stop onto the middle plane of a thin part. From there, a segment leads into the part.
std::optional<Stop> SolidPaths::at_mouth(const Stop& thin, const Stop& other) const {
  if (!(thin.nearest.distance > 0)) return std::nullopt;
  const Vec3d u = (thin.nearest.point - thin.at) / thin.nearest.distance;
  return stop_at(other.at - u * dot(u, other.at - thin.at), foot_of(other.nearest));
}

/// Returns a stop that leads a path around the part of a segment that is outside the solid.
std::optional<Stop> SolidPaths::detour(const Stop& a, const Stop& b) const {
  for (const auto& [thin, other] : {std::pair{&b, &a}, std::pair{&a, &b}}) {
    const std::optional<Stop> mouth = at_mouth(*thin, *other);
    if (mouth && is_straight(a, *mouth) && is_straight(*mouth, b)) return mouth;
  }
  if (const std::optional<Stop> crease = at_crease(a, b)) {
    const bool is_thin = a.nearest.distance + b.nearest.distance < 0.5 * length(b.at - a.at);
    const int straight = (is_straight(a, *crease) ? 1 : 0) + (is_straight(*crease, b) ? 1 : 0);
    if (straight >= (is_thin ? 1 : 2)) return crease;
  }
  return outermost_pushed_in(a, b);
}

/// Takes the part of a segment between its first exit from the solid and its last entry. Returns a stop at the middle
/// of that part, or inside the solid next to it.
std::optional<Stop> SolidPaths::outermost_pushed_in(const Stop& a, const Stop& b) const {
  const std::optional<double> leaves = surface_.first_crossing(a.at, b.at, nullptr);
  const std::optional<double> returns = surface_.first_crossing(b.at, a.at, nullptr);
  if (!leaves || !returns) return std::nullopt;
  const Vec3d middle = a.at + (b.at - a.at) * (0.5 * (*leaves + 1 - *returns));
  std::optional<Stop> stop = stop_at(middle, foot_of(a.nearest));
  return stop ? stop : pushed_in(middle, a);
}

/// Adds stops between two stops so that all segments stay in the solid. Returns false if none are found.
/// @param moves  number of stops that may still be tried.
bool SolidPaths::push_in(const Stop& a, const Stop& b, int depth, int& moves, std::vector<Stop>& between) const {
  if (is_straight(a, b)) return true;
  if (depth == 0 || moves-- <= 0) return false;
  const std::optional<Stop> stop = detour(a, b);
  if (!stop || !push_in(a, *stop, depth - 1, moves, between)) return false;
  between.push_back(*stop);
  return push_in(*stop, b, depth - 1, moves, between);
}

std::optional<std::vector<Stop>> SolidPaths::pushed(const Stop& a, const Stop& b) const {
  std::vector<Stop> between;
  int moves = most_moves;
  if (push_in(a, b, most_depth, moves, between)) return between;
  return std::nullopt;
}

std::optional<std::vector<Stop>> SolidPaths::path(const Stop& a, const Stop& b, std::span<const Stop> marks) const {
  if (auto found = pushed(a, b)) return found;
  std::vector<Stop> landmarks(marks.begin(), marks.end());
  if (within_) std::erase_if(landmarks, [&](const Stop& stop) { return !holds(*within_, stop.at); });
  if (auto found = shortest(a, b, landmarks, {any_length, most_looks})) return found;
  if (auto found = along_walls(a, b)) return found;
  for (const Stop& landmark : landmarks) {
    auto found = pushed_or_along_walls(a, landmark);
    if (!found) continue;
    const auto rest = pushed_or_along_walls(landmark, b);
    if (!rest) continue;
    found->push_back(landmark);
    found->insert(found->end(), rest->begin(), rest->end());
    return found;
  }
  std::vector<Stop> more(landmarks.begin(), landmarks.end());
  for (const Stop& landmark : landmarks) {
    for (const Stop* end : {&a, &b}) {
      if (const std::optional<Stop> crease = at_crease(*end, landmark)) more.push_back(*crease);
    }
  }
  if (const std::optional<Stop> crease = at_crease(a, b)) more.push_back(*crease);
  walk(a, b, more);
  walk(b, a, more);
  for (const Stop& landmark : landmarks) {
    if (more.size() > most_landmarks) break;
    walk(landmark, a, more);
    walk(landmark, b, more);
  }
  if (auto found = shortest(a, b, more, {any_length, most_looks})) return found;
  if (gives_up()) return std::nullopt;
  if (auto found = over_strewn(a, b, landmarks)) return found;
  return over_border(a, b);
}

bool SolidPaths::gives_up() const {
  if (needs_more_ == nullptr) return false;
  *needs_more_ = true;
  return true;
}

/// Returns the wall closest to a stop, and the opposite wall if the stop is in a thin part.
std::vector<SolidPaths::Wall> SolidPaths::walls_of(const Stop& stop) const {
  std::vector<Wall> walls;
  const auto add = [&](const Vec3d& at) {
    const NearestPoint foot = surface_.nearest(at, foot_of(stop.nearest));
    walls.push_back({{foot.point, -surface_.outwards(foot.element)}, foot.element});
  };
  add(stop.nearest.point);
  constexpr double thick = 64;
  const Vec3d away = stop.at - stop.nearest.point;
  if (const auto opposite = surface_.first_crossing(stop.at, stop.at + away * thick, nullptr)) {
    add(stop.at + away * (thick * *opposite));
  }
  return walls;
}

/// Returns a path inside the solid that follows a path over its surface.
std::optional<std::vector<Stop>> SolidPaths::along_walls(const Stop& a, const Stop& b) const {
  Box3 box;
  if (within_) {
    box = *within_;
  } else {
    const double reach = 2 * length(b.at - a.at);
    for (const Vec3d& at : {a.at, b.at}) {
      box.extend(at - Vec3d{reach, reach, reach});
      box.extend(at + Vec3d{reach, reach, reach});
    }
  }
  const std::vector<Wall> ends = walls_of(b);
  for (const Wall& from : walls_of(a)) {
    for (const Wall& to : ends) {
      const auto over = surface_.way_over(from.element, to.element, box);
      if (!over) continue;
      std::vector<SurfacePoint> way;
      if (holds(box, from.point.at)) way.push_back(from.point);
      way.insert(way.end(), over->begin(), over->end());
      if (holds(box, to.point.at)) way.push_back(to.point);
      if (auto found = inside_of(way, a, b)) return found;
      if (auto found = pushed_beside(way, a, b)) return found;
    }
  }
  return std::nullopt;
}

std::optional<std::vector<Stop>> SolidPaths::pushed_or_along_walls(const Stop& a, const Stop& b) const {
  auto found = pushed(a, b);
  return found ? found : along_walls(a, b);
}

/// Moves the points of a path over the surface into the solid. The distance is small, and is reduced until all segments
/// stay in the solid. Then it moves the points to the middle of thin parts.
std::optional<std::vector<Stop>> SolidPaths::inside_of(std::span<const SurfacePoint> way, const Stop& a,
                                                       const Stop& b) const {
  const double size = length(b.at - a.at);
  for (double depth = 1e-2 * size; depth > 1e-8 * size; depth *= 0.1) {
    std::vector<Stop> path{a};
    for (const SurfacePoint& point : way) {
      const std::optional<Stop> stop = stop_at(point.at + point.inwards * depth, foot_of(a.nearest));
      if (!stop || !is_straight(path.back(), *stop)) break;
      path.push_back(*stop);
    }
    if (path.size() != way.size() + 1 || !is_straight(path.back(), b)) continue;
    path.push_back(b);
    for (std::size_t k = 1; k + 1 < path.size(); ++k) {
      const Stop middle = centred(path[k], size);
      if (is_straight(path[k - 1], middle) && is_straight(middle, path[k + 1])) path[k] = middle;
    }
    return std::vector<Stop>(path.begin() + 1, path.end() - 1);
  }
  return std::nullopt;
}

/// Moves each point of a path over the surface into the solid, to the middle if the part is thin. Then it joins
/// consecutive points by pushed().
std::optional<std::vector<Stop>> SolidPaths::pushed_beside(std::span<const SurfacePoint> way, const Stop& a,
                                                           const Stop& b) const {
  std::vector<Stop> path{a};
  const auto join = [&](const Stop& to) {
    const std::optional<std::vector<Stop>> between = pushed(path.back(), to);
    if (!between) return false;
    path.insert(path.end(), between->begin(), between->end());
    path.push_back(to);
    return true;
  };
  for (const SurfacePoint& point : way) {
    const std::optional<Stop> stop = pushed_in(point.at - point.inwards * (1e-3 * length(b.at - a.at)), a);
    if (stop && !join(*stop)) return std::nullopt;
  }
  if (!join(b)) return std::nullopt;
  return std::vector<Stop>(path.begin() + 1, path.end() - 1);
}

/// Returns a path over landmarks and points scattered around two stops. Several densities of points are tried. The last
/// attempt adds points at creases, because thin plates that cross are joined only there.
std::optional<std::vector<Stop>> SolidPaths::over_strewn(const Stop& a, const Stop& b,
                                                         std::span<const Stop> landmarks) const {
  for (const auto& [parts, has_creases] : strewn_parts) {
    std::vector<Stop> all = strewn(0.5 * (a.at + b.at), 2 * length(b.at - a.at), parts);
    all.insert(all.end(), landmarks.begin(), landmarks.end());
    const double longest = most_parts * 2 * length(b.at - a.at) / parts;
    if (has_creases) add_creases(longest, all);
    if (const auto found = shortest(a, b, all, {longest, most_looks_at_strewn})) return pulled_tight(a, b, *found);
  }
  return std::nullopt;
}

/// Returns a path just inside the border of the part of the solid in the box. This border consists of elements of the
/// surface and parts of the box's sides. If it is connected, such a path exists.
std::optional<std::vector<Stop>> SolidPaths::over_border(const Stop& a, const Stop& b) const {
  if (!within_) return std::nullopt;
  std::vector<SurfacePoint> points = surface_.points_in(*within_);
  for (const Stop* stop : {&a, &b}) {
    for (const Wall& wall : walls_of(*stop)) points.push_back(wall.point);
  }
  for (std::size_t corner = 0; corner < 8; ++corner) {
    Vec3d at = within_->lower;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1) != 0) at[axis] = within_->upper[axis];
    }
    points.push_back({at, {}});
  }
  const double size = within_->diagonal();
  for (double depth = 1e-3 * size; depth > 1e-8 * size; depth *= 0.1) {
    std::vector<Stop> stops;
    for (const SurfacePoint& point : points) {
      const Vec3d at = max(within_->lower, min(within_->upper, point.at + point.inwards * depth));
      if (const auto stop = stop_at(at, foot_of(a.nearest))) stops.push_back(*stop);
    }
    auto found = shortest(a, b, stops, {any_length, most_looks_at_strewn});
    if (!found) continue;
    return pulled_tight(a, b, *found);
  }
  return std::nullopt;
}

void SolidPaths::add_creases(double longest, std::vector<Stop>& stops) const {
  const std::size_t count = stops.size();
  for (std::size_t m = 0; m < count; ++m) {
    for (std::size_t n = m + 1; n < count && stops.size() < most_strewn; ++n) {
      if (length(stops[n].at - stops[m].at) > 0.6 * longest) continue;
      if (const std::optional<Stop> crease = at_crease(stops[m], stops[n])) stops.push_back(*crease);
    }
  }
}

/// Returns the points of a lattice in a cube. Points outside the solid are moved into it. For points in thin parts, the
/// point in the middle of the part is added.
std::vector<Stop> SolidPaths::strewn(const Vec3d& middle, double side, int parts) const {
  const double step = side / parts;
  std::vector<Stop> stops;
  const auto offset = [&](int k) { return (k + 0.5 - 0.5 * parts) * step; };
  for (int k = 0; k < parts; ++k) {
    for (int j = 0; j < parts; ++j) {
      for (int i = 0; i < parts; ++i) {
        const Vec3d at = middle + Vec3d{offset(i), offset(j), offset(k)};
        if (const auto stop = stop_at(at, {})) {
          stops.push_back(*stop);
          if (const Stop deeper = centred(*stop); deeper.at != stop->at) stops.push_back(deeper);
        } else if (const auto pushed = pushed_in(at, {})) {
          stops.push_back(*pushed);
        }
      }
    }
  }
  return stops;
}

namespace {

/// Removes a stop if it lies in the plane of an earlier stop, to within `apart`, and both closest walls are parallel to
/// that plane.
std::vector<Stop> on_different_planes(std::span<const Stop> stops, double apart) {
  constexpr double parallel = 1e-6;
  std::vector<Stop> found;
  for (const Stop& stop : stops) {
    const Vec3d own = away_from_wall(stop);
    const auto is_same = [&](const Stop& other) {
      return std::abs(dot(own, away_from_wall(other))) > 1 - parallel && std::abs(dot(own, stop.at - other.at)) < apart;
    };
    if (std::none_of(found.begin(), found.end(), is_same)) found.push_back(stop);
  }
  return found;
}

}  // namespace

/// For each three stops, returns the point where three planes meet: each plane contains one stop and is parallel to its
/// closest wall. If the stops are in the middle of three thin plates, the plates meet there.
std::vector<Stop> SolidPaths::where_walls_meet(std::span<const Stop> stops, const Box3& box) const {
  constexpr std::size_t most_stops = 12;
  constexpr double least = 1e-3;  // least volume spanned by the three unit normals
  const std::size_t count = std::min(stops.size(), most_stops);
  const double size = box.diagonal();
  std::vector<Stop> found;
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t m = k + 1; m < count; ++m) {
      for (std::size_t n = m + 1; n < count; ++n) {
        const Vec3d u = away_from_wall(stops[k]);
        const Vec3d v = away_from_wall(stops[m]);
        const Vec3d w = away_from_wall(stops[n]);
        const double volume = dot(u, cross(v, w));
        if (!(std::abs(volume) > least)) continue;
        const Vec3d at = (cross(v, w) * dot(u, stops[k].at) + cross(w, u) * dot(v, stops[m].at) +
                          cross(u, v) * dot(w, stops[n].at)) /
                         volume;
        if (length(at - box.center()) > size) continue;
        if (const auto stop = stop_at(at, {})) found.push_back(*stop);
      }
    }
  }
  return found;
}

std::optional<Hub> SolidPaths::seeing_all(std::span<const Stop> corners, std::size_t least_open) const {
  std::optional<Hub> best;
  // Returns true if a best possible point was found, so that the search can end.
  const auto look_at = [&](std::span<const Stop> stops) {
    for (const Stop& stop : stops) {
      if (!std::all_of(corners.begin(), corners.end(), [&](const Stop& c) { return is_straight(stop, c); })) continue;
      std::size_t open = 0;
      for (std::size_t k = 0; k < corners.size(); ++k) {
        open += is_open(stop, corners[k], corners[(k + 1) % corners.size()]) ? 1 : 0;
      }
      if (open >= least_open && (!best || open > best->open)) best = Hub{stop, open};
      if (open == corners.size()) return true;
    }
    return false;
  };
  Box3 box;
  for (const Stop& corner : corners) box.extend(corner.at);
  const double size = box.diagonal();
  const Vec3d reach{0.25 * size, 0.25 * size, 0.25 * size};
  if (look_at(where_walls_meet(corners, box))) return best;
  if (gives_up()) return best;
  const std::vector<Stop> around = strewn(box.center(), size, 6);
  if (look_at(around) || look_at(where_walls_meet(on_different_planes(around, 1e-3 * size), box))) return best;
  // Thin plates bend and meet at creases of the surface. From points there, segments to more corners stay in the solid.
  std::vector<Stop> creases;
  for (const SurfacePoint& point : surface_.points_in({box.lower - reach, box.upper + reach})) {
    for (double depth = 1e-2 * size; depth > 1e-6 * size; depth *= 0.1) {
      const auto stop = stop_at(point.at + point.inwards * depth, {});
      if (!stop) continue;
      creases.push_back(centred(*stop, size));
      break;
    }
  }
  if (look_at(creases) || best) return best;
  look_at(strewn(box.center(), size, 12));
  return best;
}

/// Removes the stops of a path that a longer segment in the solid can bypass.
std::vector<Stop> SolidPaths::pulled_tight(const Stop& a, const Stop& b, const std::vector<Stop>& between) const {
  std::vector<Stop> all{a};
  all.insert(all.end(), between.begin(), between.end());
  all.push_back(b);
  std::vector<Stop> kept;
  for (std::size_t at = 0; at + 1 < all.size();) {
    std::size_t next = all.size() - 1;
    while (next > at + 1 && !is_straight(all[at], all[next])) --next;
    if (next + 1 < all.size()) kept.push_back(all[next]);
    at = next;
  }
  return kept;
}

/// Moves a stop to the middle between two walls if the solid there is at most 65 times as thick as the stop is deep.
Stop SolidPaths::centred(const Stop& stop) const {
  constexpr double thick = 64;
  return centred(stop, thick * length(stop.at - stop.nearest.point));
}

/// Moves a stop to the middle between its closest wall and the opposite one, if that is at most `reach` away from the
/// stop.
Stop SolidPaths::centred(const Stop& stop, double reach) const {
  const Vec3d away = stop.at - stop.nearest.point;
  const double depth = length(away);
  if (!(depth > 0)) return stop;
  const Vec3d direction = away / depth;
  const std::optional<double> opposite = surface_.first_crossing(stop.at, stop.at + direction * reach, nullptr);
  if (!opposite || !(*opposite * reach > depth)) return stop;
  const auto middle = stop_at(stop.at + direction * (0.5 * (*opposite * reach - depth)), foot_of(stop.nearest));
  return middle && middle->nearest.distance > stop.nearest.distance ? *middle : stop;
}

/// Walks from one stop towards another and adds the points of the walk. Each step is parallel to the wall closest to
/// the current point.
void SolidPaths::walk(const Stop& from, const Stop& towards, std::vector<Stop>& landmarks) const {
  constexpr int most_steps = 12;
  constexpr double before_wall = 0.9;
  Stop at = centred(from);
  for (int step = 0; step < most_steps; ++step) {
    const Vec3d away = away_from_wall(at);
    const Vec3d wish = towards.at - at.at;
    const Vec3d move = wish - away * dot(wish, away);
    if (!(squared_length(move) > 1e-6 * squared_length(wish))) return;
    const std::optional<double> wall = surface_.first_crossing(at.at, at.at + move, nullptr);
    const auto next = stop_at(at.at + move * (wall ? before_wall * *wall : 1), foot_of(at.nearest));
    if (!next) return;
    landmarks.push_back(*next);
    at = centred(*next);
    if (at.at != next->at) landmarks.push_back(at);
    if (is_straight(at, towards)) return;
  }
}

/// Searches the shortest path by Dijkstra's algorithm. It tests if two stops are joined only if the result can shorten
/// a path.
std::optional<std::vector<Stop>> SolidPaths::shortest(const Stop& a, const Stop& b, std::span<const Stop> landmarks,
                                                      const SearchLimits& limits) const {
  constexpr double far = std::numeric_limits<double>::infinity();
  std::vector<Stop> stops(landmarks.begin(), landmarks.end());
  stops.push_back(a);
  stops.push_back(b);
  const std::size_t start = stops.size() - 2;
  const std::size_t goal = stops.size() - 1;
  std::vector<double> way(stops.size(), far);
  std::vector<std::size_t> before(stops.size(), start);
  std::vector<bool> is_done(stops.size(), false);
  way[start] = 0;
  int looks = 0;
  for (std::size_t round = 0; round < stops.size() && looks < limits.looks; ++round) {
    std::size_t next = stops.size();
    for (std::size_t s = 0; s < stops.size(); ++s) {
      if (!is_done[s] && way[s] < far && (next == stops.size() || way[s] < way[next])) next = s;
    }
    if (next == stops.size()) return std::nullopt;
    is_done[next] = true;
    if (next == goal) break;
    for (std::size_t s = 0; s < stops.size(); ++s) {
      const double step = length(stops[s].at - stops[next].at);
      const double longer = way[next] + step;
      if (is_done[s] || longer >= way[s] || step > limits.longest) continue;
      ++looks;
      if (!is_straight(stops[next], stops[s])) continue;
      way[s] = longer;
      before[s] = next;
    }
  }
  if (!is_done[goal]) return std::nullopt;
  std::vector<Stop> path;
  for (std::size_t s = goal; s != start; s = before[s]) {
    if (s != goal) path.push_back(stops[s]);
  }
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace blum::detail
