#include "blum/axis/sheet_decimator.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "blum/core/parallel.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t most_in_batch = 256;
/// At each step sheets may move by this part of the least radius nearby; by the second one of the tolerance anyway:
/// flat ones do by rounding, and reach out to where the radius is 0.
constexpr double part_of_radius = 0.5;
constexpr double nothing = 1e-6;
/// Rims, seams and curves may move by this part of the tolerance: they say most for the fewest vertices.
constexpr double part_of_borders = 0.4;

/// Whether any vertex of the first fans, or any other end of a border, is of a kind.
template <class Is>
bool is_any_of(std::span<const Fan> fans, std::span<const std::pair<std::uint32_t, std::uint32_t>> chain,
               const Is& is) {
  const auto has = [&](const Fan& fan) { return std::any_of(fan.ring.begin(), fan.ring.end(), is); };
  return std::any_of(fans.begin(), fans.end(), has) ||
         std::any_of(chain.begin(), chain.end(), [&](const auto& border) { return is(border.second); });
}

}  // namespace

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

/// Takes out vertices that are not next to one taken out before, once over all. All threads look at those of a batch
/// as they are before any of it goes; what something goes next to is looked at again. The order, and so the result,
/// does not depend on the threads: those of a batch are far apart in memory, and next to those of the batch before.
/// @return  how many went.
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
    // What went on the other side of a neighbour may forbid to go there.
    if (look.candidate && is_any_of(std::span(look.fans).first(look.fan_count), look.chain, is_touched))
      look_at(v, limit, look);
    if (look.candidate) take(v, look);
  }
}
void SheetDecimator::look_at(std::uint32_t v, double limit, Look& look) const {
  look.candidate = gather(v, look) ? best(v, limit, look) : std::nullopt;
}

/// Finds the fans of a vertex and its neighbours along a chain, if it has two of these or none.
/// @return  whether it may go at all.
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
/// Follows triangles from a ring vertex to another one, or round to the same. They leave `sides`.
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

/// The neighbour that a vertex had best go to.
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

/// How far all cells around a vertex would be from where they were at first; nullopt where that is too far.
std::optional<SheetDecimator::Candidate> SheetDecimator::moved_to(std::uint32_t v, std::uint32_t to, double limit,
                                                                  Look& look) const {
  double along = 0;
  double least_radius = std::min(point(v).radius, point(to).radius);
  for (const auto& [edge, other] : look.chain) along = std::max(along, of_edge_[edge]);
  double before = along;
  for (std::size_t f = 0; f < look.fan_count; ++f) {
    for (const std::uint32_t t : look.fans[f].triangles) before = std::max(before, of_triangle_[t]);
    for (const std::uint32_t r : look.fans[f].ring) least_radius = std::min(least_radius, point(r).radius);
  }
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

/// The angle of a sheet is the largest of its triangles': what goes leaves its own to the triangle beside it.
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
