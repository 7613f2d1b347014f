#include "blum/axis/sheet_decimator.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "blum/core/inline_list.hpp"
#include "blum/core/parallel.hpp"

namespace blum::detail {
namespace {

/// Cosine of the largest angle by which a triangle may turn: 75 degrees.
constexpr double least_cosine = 0.25;
constexpr std::size_t most_ring = 64;

/// Point relative to the centre of a fan: x and y in the plane across the fan's normal, and height along the normal.
struct Seen {
  double x = 0, y = 0;
  double height = 0, radius = 0;  ///< `radius`: difference from the radius at the centre
};

double cross(const Seen& a, const Seen& b) {
  return a.x * b.y - a.y * b.x;
}
double cross(const Seen& from, const Seen& a, const Seen& b) {
  return (a.x - from.x) * (b.y - from.y) - (a.y - from.y) * (b.x - from.x);
}

struct Difference {
  double height = 0, radius = 0;
  void include(double h, double r) {
    height = std::max(height, std::abs(h));
    radius = std::max(radius, std::abs(r));
  }
};

/// Ring of a fan as projected along a normal.
class View {
 public:
  View(const AxisPoint& centre, std::span<const AxisPoint> ring, const Vec3d& normal) {
    const Vec3d side = std::abs(normal.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    Vec3d u = blum::cross(normal, side);
    u = u / length(u);
    const Vec3d v = blum::cross(normal, u);
    for (const AxisPoint& point : ring) {
      const Vec3d at = point.position - centre.position;
      seen_.push_back({dot(at, u), dot(at, v), dot(at, normal), point.radius - centre.radius});
    }
  }

  /// Returns true if the projection of the fan does not overlap itself before the centre is removed.
  [[nodiscard]] bool is_above_plane(bool is_closed) const {
    for (std::size_t k = 0; k + 1 < seen_.size() + (is_closed ? 1 : 0); ++k) {
      if (!(cross(seen_[k], seen_[(k + 1) % seen_.size()]) > 0)) return false;
    }
    return true;
  }
  /// Returns true if the projection of the triangles that replace the fan does not overlap itself.
  [[nodiscard]] bool is_unfolded() const {
    for (std::size_t k = 1; k + 1 < seen_.size(); ++k) {
      if (!(cross(seen_[0], seen_[k], seen_[k + 1]) > 0)) return false;
    }
    return true;
  }

  /// Returns true if the centre of an open fan lies outside the new triangles, beyond the line between the ring's ends.
  [[nodiscard]] bool is_tip() const { return cross(seen_[0], seen_[seen_.size() - 1]) > 0; }

  /// Includes the difference at the centre, if the new triangles cover it.
  void include_centre(Difference& difference) const {
    for (std::size_t k = 1; k + 1 < seen_.size(); ++k) {
      const double a = cross(seen_[k], seen_[k + 1]);
      const double b = cross(seen_[k + 1], seen_[0]);
      const double c = cross(seen_[0], seen_[k]);
      if (a < 0 || b < 0 || c < 0 || !(a + b + c > 0)) continue;
      const double sum = a + b + c;
      difference.include((a * seen_[0].height + b * seen_[k].height + c * seen_[k + 1].height) / sum,
                         (a * seen_[0].radius + b * seen_[k].radius + c * seen_[k + 1].radius) / sum);
      return;
    }
  }

  /// Includes the differences where edges from the centre cross new edges. Between these points both surfaces are
  /// linear.
  void include_crossings(Difference& difference) const {
    for (std::size_t j = 2; j < seen_.size(); ++j) {
      const Seen& from = seen_[0];
      const Seen& to = seen_[j];
      const Seen along{to.x - from.x, to.y - from.y, to.height - from.height, to.radius - from.radius};
      const double start = cross(from, along);
      for (std::size_t i = 1; i < seen_.size(); ++i) {
        if (i == j) continue;
        const Seen& spoke = seen_[i];
        const double turn = cross(spoke, along);
        // Mostly, the signs alone show that the edges do not cross, so no division is needed.
        if (turn == 0 || (turn > 0 ? !(start > 0 && start <= turn) : !(start < 0 && start >= turn))) continue;
        const double s = start / turn;
        const double t = cross(from, spoke) / turn;
        if (!(s > 0 && s < 1 && t > 0 && t < 1)) continue;
        difference.include(s * spoke.height - (from.height + t * along.height),
                           s * spoke.radius - (from.radius + t * along.radius));
      }
    }
  }

 private:
  InlineList<Seen, most_ring> seen_;
};

/// Returns true if a triangle's normal is within 75 degrees of the given normal.
bool faces(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& normal) {
  const Vec3d own = blum::cross(b - a, c - a);
  return dot(own, normal) > least_cosine * length(own);
}

constexpr std::size_t most_in_batch = 256;
/// Each removal may move sheets beyond their previous extent by at most this fraction of the least radius nearby. A
/// distance of `nothing` times the tolerance is always allowed. Rounding causes such distances in flat sheets, also
/// where the radius is 0.
constexpr double part_of_radius = 0.5;
constexpr double nothing = 1e-6;
/// The total displacement of a cell is also limited by this fraction of the largest radius around it. A tolerance above
/// the radius of a thin part would move its axis to its surface.
constexpr double part_of_largest_radius = 0.15;
/// Rims, seams and curves may move by this fraction of the limit for sheets. This fraction is small because a coarse
/// border is more visible than a coarse sheet.
constexpr double part_of_borders = 0.4;

/// Returns true if `is` holds for any ring vertex of the fans, or for the other end of any border edge in the chain.
template <class Is>
bool is_any_of(std::span<const Fan> fans, std::span<const std::pair<std::uint32_t, std::uint32_t>> chain,
               const Is& is) {
  const auto has = [&](const Fan& fan) { return std::any_of(fan.ring.begin(), fan.ring.end(), is); };
  return std::any_of(fans.begin(), fans.end(), has) ||
         std::any_of(chain.begin(), chain.end(), [&](const auto& border) { return is(border.second); });
}

}  // namespace

Deviation deviation(const AxisPoint& point, const AxisPoint& a, const AxisPoint& b) {
  const Vec3d along = b.position - a.position;
  const double squared = squared_length(along);
  const double t = squared > 0 ? std::clamp(dot(point.position - a.position, along) / squared, 0.0, 1.0) : 0;
  const double distance = length(point.position - (a.position + along * t));
  return {std::max(distance, std::abs(a.radius + (b.radius - a.radius) * t - point.radius)), distance};
}

std::optional<Deviation> deviation(const AxisPoint& centre, std::span<const AxisPoint> ring, bool is_closed) {
  if (ring.size() > most_ring) return std::nullopt;
  Vec3d normal;
  for (std::size_t k = 0; k + 1 < ring.size() + (is_closed ? 1 : 0); ++k) {
    normal += blum::cross(ring[k].position - centre.position, ring[(k + 1) % ring.size()].position - centre.position);
  }
  const double size = length(normal);
  if (!(size > 0)) return std::nullopt;
  normal = normal / size;
  for (std::size_t k = 1; k + 1 < ring.size(); ++k) {
    if (!faces(ring[0].position, ring[k].position, ring[k + 1].position, normal)) return std::nullopt;
  }
  const View view(centre, ring, normal);
  if (!view.is_unfolded()) return std::nullopt;
  // Points of a triangle move at most as far as the corner that moves.
  const double moved = length(ring[0].position - centre.position);
  const Deviation bound{std::max(moved, std::abs(ring[0].radius - centre.radius)), moved};
  if (!view.is_above_plane(is_closed)) return bound;
  Difference difference;
  view.include_centre(difference);
  view.include_crossings(difference);
  Deviation out{std::max(difference.height, difference.radius), difference.height};
  if (!is_closed) {
    const Deviation border = deviation(centre, ring.front(), ring.back());
    out.by = std::max(out.by, border.by);
    if (!view.is_tip()) out.beyond = std::max(out.beyond, border.beyond);
  }
  return out.by < bound.by ? out : bound;
}

SheetDecimator::SheetDecimator(DecimatorInput input, double tolerance, const Context& context)
    : input_(std::move(input)),
      tolerance_(tolerance),
      context_(context),
      cells_({input_.points.size(), input_.borders, input_.triangles}),
      of_triangle_(input_.triangles.size(), 0),
      of_edge_(input_.borders.size(), 0),
      is_waiting_(input_.points.size(), 0),
      touched_at_(input_.points.size(), 0),
      looks_(most_in_batch) {}

void SheetDecimator::run(std::span<const double> levels) {
  for (const double level : levels) {
    for (std::uint32_t v = 0; v < is_waiting_.size(); ++v) is_waiting_[v] = may_wait(v) ? 1 : 0;
    while (sweep(level * tolerance_) > 0) {
    }
  }
}

/// Visits all waiting vertices once, and removes those that may be removed and whose neighbourhood did not change
/// during this sweep. The vertices are visited in batches. Threads examine all vertices of a batch before any of them
/// is removed. A vertex is examined again if a removal in the batch changed the neighbourhood of a neighbour. The order
/// of removals, and so the result, does not depend on the number of threads. Vertices of one batch are far apart in
/// memory; each follows a vertex of the previous batch.
/// @return  number of removed vertices.
std::size_t SheetDecimator::sweep(double limit) {
  const std::vector<std::uint32_t> waiting = waiting_vertices();
  const std::size_t batches = (waiting.size() + most_in_batch - 1) / most_in_batch;
  const std::size_t at_first = taken_;
  const auto is_touched = [&](std::uint32_t v) { return touched_at_[v] > at_first; };
  for (std::size_t batch = 0; batch < batches; ++batch) {
    batch_.clear();
    for (std::size_t k = batch; k < waiting.size(); k += batches) {
      if (!is_touched(waiting[k])) batch_.push_back(waiting[k]);
    }
    take_batch(limit);
  }
  return taken_ - at_first;
}
std::vector<std::uint32_t> SheetDecimator::waiting_vertices() const {
  std::vector<std::uint32_t> waiting;
  for (std::uint32_t v = 0; v < is_waiting_.size(); ++v) {
    if (is_waiting_[v] != 0 && cells_.has_vertex(v)) waiting.push_back(v);
  }
  return waiting;
}
void SheetDecimator::take_batch(double limit) {
  constexpr std::size_t grain = 16;
  parallel_for(context_, batch_.size(), grain, {}, [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) look_at(batch_[k], limit, looks_[k]);
  });
  const std::size_t at_first = taken_;
  const auto is_touched = [&](std::uint32_t v) { return touched_at_[v] > at_first; };
  for (std::size_t k = 0; k < batch_.size(); ++k) {
    const std::uint32_t v = batch_[k];
    if (is_touched(v)) continue;
    Look& look = looks_[k];
    is_waiting_[v] = 0;
    // A removal next to a neighbour may have made this contraction invalid.
    if (look.candidate && is_any_of(std::span(look.fans).first(look.fan_count), look.chain, is_touched))
      look_at(v, limit, look);
    if (look.candidate) take(v, look);
  }
}
void SheetDecimator::look_at(std::uint32_t v, double limit, Look& look) const {
  look.candidate = gather(v, look) ? best(v, limit, look) : std::nullopt;
}

/// Finds the border edges at a vertex, which must be none or two, and the fans of triangles around it.
/// @return  true if the vertex may be removed at all.
bool SheetDecimator::gather(std::uint32_t v, Look& look) const {
  auto& chain = look.chain;
  auto& sides = look.sides;
  chain.clear();
  cells_.for_each_edge(v, [&](std::uint32_t e, std::uint32_t other) { chain.emplace_back(e, other); });
  if (!chain.empty() && (chain.size() != 2 || chain[0].second == chain[1].second)) return false;
  if (!chain.empty() && input_.border_kind[chain[0].first] != input_.border_kind[chain[1].first]) return false;
  sides.clear();
  cells_.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t p, std::uint32_t q) { sides.emplace_back(t, p, q); });
  look.fan_count = 0;
  if (sides.empty()) return !chain.empty();
  if (chain.empty()) return add_fan(look, sides.front().ends[0], none) && sides.empty();
  while (!sides.empty()) {
    const std::uint32_t from = chain[0].second;
    if (!add_fan(look, from, chain[1].second)) return false;
  }
  return true;
}
/// Adds the fan of triangles from ring vertex `from` to ring vertex `to`, or around to `from` if `to` is none. The
/// triangles are removed from `sides`.
bool SheetDecimator::add_fan(Look& look, std::uint32_t from, std::uint32_t to) {
  auto& sides = look.sides;
  if (look.fan_count == look.fans.size()) look.fans.emplace_back();
  Fan& fan = look.fans[look.fan_count++];
  fan.ring.assign(1, from);
  fan.triangles.clear();
  fan.is_closed = to == none;
  const std::uint32_t last = fan.is_closed ? from : to;
  for (std::uint32_t at = from;;) {
    const auto next =
        std::find_if(sides.begin(), sides.end(), [&](const Side& s) { return s.ends[0] == at || s.ends[1] == at; });
    if (next == sides.end()) return false;
    at = next->ends[0] == at ? next->ends[1] : next->ends[0];
    fan.triangles.push_back(next->triangle);
    sides.erase(next);
    if (at == last) break;
    if (std::find(fan.ring.begin(), fan.ring.end(), at) != fan.ring.end()) return false;
    fan.ring.push_back(at);
  }
  if (!fan.is_closed) fan.ring.push_back(to);
  return !fan.is_closed || fan.ring.size() > 2;
}

/// Returns the contraction of a vertex to its preferred valid neighbour; nullopt if none is valid.
std::optional<SheetDecimator::Candidate> SheetDecimator::best(std::uint32_t v, double limit, Look& look) const {
  auto& targets = look.targets;
  targets.clear();
  if (look.chain.empty()) {
    for (const std::uint32_t to : look.fans[0].ring) {
      double sum = 0;
      for (const std::uint32_t other : look.fans[0].ring) {
        sum += squared_length(point(to).position - point(other).position);
      }
      targets.emplace_back(sum, to);
    }
  } else {
    for (const auto& [edge, to] : look.chain) {
      targets.emplace_back(squared_length(point(to).position - point(v).position), to);
    }
  }
  std::sort(targets.begin(), targets.end());
  for (const auto& [order, to] : targets) {
    const std::optional<Candidate> moved = moved_to(v, to, limit, look);
    if (moved && cells_.may_contract(v, to, look.links)) return moved;
  }
  return std::nullopt;
}

/// Returns bounds on how far the cells around a vertex would be from the original axis after its contraction; nullopt
/// if that is too far.
std::optional<SheetDecimator::Candidate> SheetDecimator::moved_to(std::uint32_t v, std::uint32_t to, double limit,
                                                                  Look& look) const {
  double along = 0;
  double least_radius = std::min(point(v).radius, point(to).radius);
  double largest_radius = std::max(point(v).radius, point(to).radius);
  for (const auto& [edge, other] : look.chain) along = std::max(along, of_edge_[edge]);
  double before = along;
  for (std::size_t f = 0; f < look.fan_count; ++f) {
    for (const std::uint32_t t : look.fans[f].triangles) before = std::max(before, of_triangle_[t]);
    for (const std::uint32_t r : look.fans[f].ring) {
      least_radius = std::min(least_radius, point(r).radius);
      largest_radius = std::max(largest_radius, point(r).radius);
    }
  }
  limit = std::min(limit, std::max(part_of_largest_radius * largest_radius, nothing * tolerance_));
  if (before > limit) return std::nullopt;
  const double most_beyond = std::max(part_of_radius * least_radius, nothing * tolerance_);
  double by = 0;
  if (!look.chain.empty()) {
    const std::uint32_t other = look.chain[0].second == to ? look.chain[1].second : look.chain[0].second;
    if (is_border(to, other)) return std::nullopt;
    const Deviation own = deviation(point(v), point(to), point(other));
    if (look.fan_count == 0 && own.beyond > most_beyond) return std::nullopt;
    by = own.by;
    along += own.by;
    if (along > part_of_borders * limit) return std::nullopt;
  }
  for (std::size_t f = 0; f < look.fan_count && before + by <= limit; ++f) {
    const std::optional<Deviation> own = deviation_of(v, look.fans[f], to, look.ring);
    if (!own || own->beyond > most_beyond) return std::nullopt;
    by = std::max(by, own->by);
  }
  return before + by <= limit ? std::optional(Candidate{to, before + by, along}) : std::nullopt;
}

bool SheetDecimator::is_border(std::uint32_t a, std::uint32_t b) const {
  bool found = false;
  cells_.for_each_edge(a, [&](std::uint32_t, std::uint32_t other) { found = found || other == b; });
  return found;
}

std::optional<Deviation> SheetDecimator::deviation_of(std::uint32_t v, Fan& fan, std::uint32_t to,
                                                      std::vector<AxisPoint>& ring) const {
  if (fan.is_closed) {
    const auto at = std::find(fan.ring.begin(), fan.ring.end(), to) - fan.ring.begin();
    std::rotate(fan.ring.begin(), fan.ring.begin() + at, fan.ring.end());
    std::rotate(fan.triangles.begin(), fan.triangles.begin() + at, fan.triangles.end());
  } else if (fan.ring.front() != to) {
    std::reverse(fan.ring.begin(), fan.ring.end());
    std::reverse(fan.triangles.begin(), fan.triangles.end());
  }
  ring.clear();
  for (const std::uint32_t r : fan.ring) ring.push_back(point(r));
  return deviation(point(v), ring, fan.is_closed);
}

void SheetDecimator::take(std::uint32_t v, const Look& look) {
  const Candidate& candidate = *look.candidate;
  ++taken_;
  for (std::size_t f = 0; f < look.fan_count; ++f) {
    const Fan& fan = look.fans[f];
    pass_angle_on(fan);
    for (const std::uint32_t t : fan.triangles) of_triangle_[t] = candidate.moved;
    for (const std::uint32_t r : fan.ring) touch(r);
  }
  for (const auto& [edge, other] : look.chain) {
    of_edge_[edge] = candidate.along;
    touch(other);
  }
  moved_ = std::max(moved_, candidate.moved);
  cells_.contract(v, candidate.to);
}
void SheetDecimator::touch(std::uint32_t v) {
  touched_at_[v] = taken_;
  is_waiting_[v] = may_wait(v) ? 1 : 0;
}

/// Passes the angle of each removed triangle on to its neighbour. So the largest angle of a sheet is preserved.
void SheetDecimator::pass_angle_on(const Fan& fan) {
  const std::size_t count = fan.triangles.size();
  const auto pass = [&](std::uint32_t from, std::uint32_t to) {
    input_.triangle_angle[to] = std::max(input_.triangle_angle[to], input_.triangle_angle[from]);
  };
  if (count > 1) pass(fan.triangles[0], fan.triangles[1]);
  if (fan.is_closed && count > 2) pass(fan.triangles[count - 1], fan.triangles[count - 2]);
  if (count > 1) return;
  cells_.for_each_triangle(fan.ring[0], [&](std::uint32_t t, std::uint32_t p, std::uint32_t q) {
    if (p == fan.ring[1] || q == fan.ring[1]) pass(fan.triangles[0], t);
  });
}

}  // namespace blum::detail
