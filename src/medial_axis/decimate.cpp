#include "blum/medial_axis/decimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "medial_axis/fan.hpp"
#include "medial_axis/shrinking_complex.hpp"

namespace blum {
namespace {

constexpr std::uint32_t none = 0xffffffffU;
constexpr std::size_t most_in_batch = 256;
/// What goes first: vertices that move sheets by these parts of the tolerance.
constexpr std::array levels{1.0 / 256, 1.0 / 16, 1.0 / 4, 0.8};
/// At each step sheets may move by this part of the least radius nearby; by the second one of the tolerance anyway:
/// flat ones do by rounding, and reach out to where the radius is 0.
constexpr double part_of_radius = 0.5;
constexpr double nothing = 1e-6;
/// Rims, seams and curves may move by this part of the tolerance: they say most for the fewest vertices.
constexpr double part_of_borders = 0.4;

/// The edges that bound sheets: those that are listed, and those where sheets of two numbers meet.
std::vector<std::array<std::uint32_t, 2>> borders_of(const Complex& axis, const Context& context) {
  std::vector<std::array<std::uint32_t, 2>> borders = axis.edges;
  const Incidence incidence(axis.view(), context);
  std::vector<bool> is_listed(incidence.edges().size(), false);
  for (const std::uint32_t e : incidence.edge_of_listed()) is_listed[e] = true;
  const auto sheets = axis.triangle_columns.get<std::int32_t>(medial_columns::sheet);
  for (std::size_t e = 0; e < is_listed.size(); ++e) {
    const auto triangles = incidence.triangles_of_edge()[e];
    if (is_listed[e] || triangles.empty()) continue;
    const bool is_inner = triangles.size() == 2 && sheets[triangles[0]] == sheets[triangles[1]];
    if (!is_inner) borders.push_back(incidence.edges()[e]);
  }
  return borders;
}

class Decimator {
 public:
  Decimator(const Complex& axis, double tolerance, const Context& context)
      : axis_(axis),
        view_(axis),
        tolerance_(tolerance),
        context_(context),
        borders_(borders_of(axis, context)),
        cells_({axis.positions.size(), borders_, axis.triangles}),
        of_triangle_(axis.triangles.size(), 0),
        of_edge_(borders_.size(), 0),
        angle_(view_.triangle_angle.begin(), view_.triangle_angle.end()),
        is_waiting_(axis.positions.size(), 1),
        touched_at_(axis.positions.size(), 0),
        looks_(most_in_batch) {}

  DecimatedAxis run() {
    for (const double level : levels) {
      std::fill(is_waiting_.begin(), is_waiting_.end(), 1);
      while (sweep(level * tolerance_) > 0) {
      }
    }
    return {result(), moved_};
  }

 private:
  struct Candidate {
    std::uint32_t to = none;
    double moved = 0;
    double along = 0;  ///< how far the border through the vertex would be from where it was at first
  };
  struct Side {
    std::uint32_t triangle;
    std::array<std::uint32_t, 2> ends;
    Side(std::uint32_t t, std::uint32_t p, std::uint32_t q) : triangle(t), ends{p, q} {}
  };
  /// What is around a vertex that is looked at. Kept, so that no new memory is needed each time.
  struct Look {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> chain;  ///< borders, and their other ends
    std::vector<Side> sides;                                     ///< triangles that no fan has yet
    std::vector<Fan> fans;
    std::size_t fan_count = 0;
    std::vector<AxisPoint> ring;
    std::vector<std::pair<double, std::uint32_t>> targets;
    LinkScratch links;
    std::optional<Candidate> candidate;
  };

  [[nodiscard]] AxisPoint point(std::uint32_t v) const { return {axis_.positions[v], view_.radius[v]}; }

  /// Takes out vertices that are not next to one taken out before, once over all. All threads look at those of a batch
  /// as they are before any of it goes; what something goes next to is looked at again. The order, and so the result,
  /// does not depend on the threads: those of a batch are far apart in memory, and next to those of the batch before.
  /// @return  how many went.
  std::size_t sweep(double limit) {
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
  [[nodiscard]] std::vector<std::uint32_t> waiting_vertices() const {
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t v = 0; v < is_waiting_.size(); ++v) {
      if (is_waiting_[v] != 0 && cells_.has_vertex(v)) waiting.push_back(v);
    }
    return waiting;
  }
  void take_batch(double limit) {
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
      if (look.candidate && is_any_around(look, is_touched)) look_at(v, limit, look);
      if (look.candidate) take(v, look);
    }
  }
  template <class Is>
  [[nodiscard]] static bool is_any_around(const Look& look, const Is& is) {
    const auto has = [&](const Fan& fan) { return std::any_of(fan.ring.begin(), fan.ring.end(), is); };
    return std::any_of(look.fans.begin(), look.fans.begin() + static_cast<std::ptrdiff_t>(look.fan_count), has) ||
           std::any_of(look.chain.begin(), look.chain.end(), [&](const auto& border) { return is(border.second); });
  }

  void look_at(std::uint32_t v, double limit, Look& look) const {
    look.candidate = gather(v, look) ? best(v, limit, look) : std::nullopt;
  }

  /// Finds the fans of a vertex and its neighbours along a chain, if it has two of these or none.
  /// @return  whether it may go at all.
  bool gather(std::uint32_t v, Look& look) const {
    auto& chain = look.chain;
    auto& sides = look.sides;
    chain.clear();
    cells_.for_each_edge(v, [&](std::uint32_t e, std::uint32_t other) { chain.emplace_back(e, other); });
    if (!chain.empty() && (chain.size() != 2 || chain[0].second == chain[1].second)) return false;
    if (!chain.empty() && kind_of(chain[0].first) != kind_of(chain[1].first)) return false;
    sides.clear();
    cells_.for_each_triangle(v,
                             [&](std::uint32_t t, std::uint32_t p, std::uint32_t q) { sides.emplace_back(t, p, q); });
    look.fan_count = 0;
    if (sides.empty()) return !chain.empty();
    if (chain.empty()) return add_fan(look, sides.front().ends[0], none) && sides.empty();
    while (!sides.empty()) {
      const std::uint32_t from = chain[0].second;
      if (!add_fan(look, from, chain[1].second)) return false;
    }
    return true;
  }
  /// The role of a border; sheets that meet without a seam have one of their own.
  [[nodiscard]] int kind_of(std::uint32_t edge) const {
    return edge < axis_.edges.size() ? static_cast<int>(view_.edge_role(edge)) : -1;
  }

  /// Follows triangles from a ring vertex to another one, or round to the same. They leave `sides`.
  static bool add_fan(Look& look, std::uint32_t from, std::uint32_t to) {
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
  [[nodiscard]] std::optional<Candidate> best(std::uint32_t v, double limit, Look& look) const {
    auto& targets = look.targets;
    targets.clear();
    if (look.chain.empty()) {
      for (const std::uint32_t to : look.fans[0].ring) {
        double sum = 0;
        for (const std::uint32_t other : look.fans[0].ring) {
          sum += squared_length(axis_.positions[to] - axis_.positions[other]);
        }
        targets.emplace_back(sum, to);
      }
    } else {
      for (const auto& [edge, to] : look.chain) {
        targets.emplace_back(squared_length(axis_.positions[to] - axis_.positions[v]), to);
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
  [[nodiscard]] std::optional<Candidate> moved_to(std::uint32_t v, std::uint32_t to, double limit, Look& look) const {
    double along = 0;
    double least_radius = std::min(view_.radius[v], view_.radius[to]);
    for (const auto& [edge, other] : look.chain) along = std::max(along, of_edge_[edge]);
    double before = along;
    for (std::size_t f = 0; f < look.fan_count; ++f) {
      for (const std::uint32_t t : look.fans[f].triangles) before = std::max(before, of_triangle_[t]);
      for (const std::uint32_t r : look.fans[f].ring) least_radius = std::min(least_radius, view_.radius[r]);
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

  [[nodiscard]] bool is_border(std::uint32_t a, std::uint32_t b) const {
    bool found = false;
    cells_.for_each_edge(a, [&](std::uint32_t, std::uint32_t other) { found = found || other == b; });
    return found;
  }

  [[nodiscard]] std::optional<Deviation> deviation_of(std::uint32_t v, Fan& fan, std::uint32_t to,
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

  void take(std::uint32_t v, const Look& look) {
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
  void touch(std::uint32_t v) {
    touched_at_[v] = taken_;
    is_waiting_[v] = 1;
  }

  /// The angle of a sheet is the largest of its triangles': what goes leaves its own to the triangle beside it.
  void pass_angle_on(const Fan& fan) {
    const std::size_t count = fan.triangles.size();
    const auto pass = [&](std::uint32_t from, std::uint32_t to) { angle_[to] = std::max(angle_[to], angle_[from]); };
    if (count > 1) pass(fan.triangles[0], fan.triangles[1]);
    if (fan.is_closed && count > 2) pass(fan.triangles[count - 1], fan.triangles[count - 2]);
    if (count > 1) return;
    cells_.for_each_triangle(fan.ring[0], [&](std::uint32_t t, std::uint32_t p, std::uint32_t q) {
      if (p == fan.ring[1] || q == fan.ring[1]) pass(fan.triangles[0], t);
    });
  }

  [[nodiscard]] Complex result() const {
    Complex out = cells_.rest_of(axis_);
    const auto angles = out.triangle_columns.edit<float>(medial_columns::separation_angle);
    std::size_t k = 0;
    for (std::uint32_t t = 0; t < angle_.size(); ++t) {
      if (cells_.has_triangle(t)) angles[k++] = angle_[t];
    }
    give_borders_angles(out);
    return out;
  }

  /// Rims and seams have the largest angle of the triangles that are left at them.
  static void give_borders_angles(Complex& axis) {
    const auto of_triangle = axis.triangle_columns.get<float>(medial_columns::separation_angle);
    std::vector<std::pair<std::array<std::uint32_t, 2>, float>> sides;
    sides.reserve(3 * axis.triangles.size());
    for (std::size_t t = 0; t < axis.triangles.size(); ++t) {
      const auto& [a, b, c] = axis.triangles[t];
      for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
        sides.push_back({{std::min(p, q), std::max(p, q)}, of_triangle[t]});
      }
    }
    std::sort(sides.begin(), sides.end());
    const auto angles = axis.edge_columns.edit<float>(medial_columns::separation_angle);
    for (std::size_t e = 0; e < axis.edges.size(); ++e) {
      const std::array<std::uint32_t, 2> edge{std::min(axis.edges[e][0], axis.edges[e][1]),
                                              std::max(axis.edges[e][0], axis.edges[e][1])};
      // The last of an edge's sides has the largest angle.
      const auto after = std::upper_bound(sides.begin(), sides.end(), edge,
                                          [](const auto& value, const auto& side) { return value < side.first; });
      if (after != sides.begin() && std::prev(after)->first == edge) angles[e] = std::prev(after)->second;
    }
  }

  const Complex& axis_;
  MedialView view_;
  double tolerance_;
  const Context& context_;
  std::vector<std::array<std::uint32_t, 2>> borders_;
  ShrinkingComplex cells_;
  std::vector<double> of_triangle_, of_edge_;  ///< how far they may be from where they were at first
  std::vector<float> angle_;
  std::vector<std::uint8_t> is_waiting_;  ///< something around it changed since it was looked at
  std::vector<std::size_t> touched_at_;   ///< taken_ when something around it went last
  std::size_t taken_ = 0;                 ///< vertices
  double moved_ = 0;
  std::vector<std::uint32_t> batch_;
  std::vector<Look> looks_;  ///< of these
};

}  // namespace

DecimatedAxis decimate(const Complex& axis, double tolerance, const Context& context) {
  if (!(tolerance >= 0 && std::isfinite(tolerance))) {
    throw InvalidOption("tolerance is " + exact_text(tolerance) + ", but must be at least 0");
  }
  if (const std::string problem = problem_of_medial(axis); !problem.empty()) {
    throw InvalidOption("triangles cannot be taken from what is no medial axis: " + problem);
  }
  if (tolerance == 0) return {axis, 0};
  return Decimator(axis, tolerance, context).run();
}

}  // namespace blum
