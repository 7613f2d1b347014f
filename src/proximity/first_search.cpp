#include "proximity/first_search.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

#include "blum/core/parallel.hpp"
#include "exact/dyadic.hpp"
#include "proximity/impact_filter.hpp"

namespace blum {
namespace {

using detail::FeatureKinds;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr std::size_t search_grain = 8;
constexpr std::size_t sweep_grain = 32;

/// Positions along an axis of a side of one box, and of the opposite side of another, at the start and the end. The
/// first box is above the second box while the first side is above the second side.
struct Sides {
  double start, other_start;
  double end, other_end;

  [[nodiscard]] double start_gap() const { return start - other_start; }
  [[nodiscard]] double end_gap() const { return end - other_end; }
};

/// Calls visit(sides) for the pairs of sides that may separate two boxes, until a call returns false.
template <class Visit>
bool for_each_sides(const MovingBox& a, const MovingBox& b, const Visit& visit) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!visit(Sides{a.start.lower[axis], b.start.upper[axis], a.end.lower[axis], b.end.upper[axis]})) return false;
    if (!visit(Sides{b.start.lower[axis], a.start.upper[axis], b.end.lower[axis], a.end.upper[axis]})) return false;
  }
  return true;
}

/// Returns a lower bound of the times at which two boxes touch; infinite if they never do. The bound is too low by at
/// most a few units in the last place.
double touch_time(const MovingBox& a, const MovingBox& b) {
  constexpr double margin = 0x1p-50;  // four roundings
  double enter = 0;
  double exit = 1;
  const bool may_touch = for_each_sides(a, b, [&](const Sides& sides) {
    const double from = sides.start_gap();
    const double to = sides.end_gap();
    if (from > 0 && to > 0) return false;
    if (from > 0) enter = std::max(enter, from / (from - to) * (1 - margin));
    if (to > 0) exit = std::min(exit, from / (from - to) * (1 + margin));
    return true;
  });
  return may_touch && enter <= exit ? enter : infinite;
}

/// Returns the sign of the gap between two sides at a time. Exact.
int gap_sign(const Sides& sides, double time) {
  const double from = sides.start_gap();
  const double to = sides.end_gap();
  const double gap = from * (1 - time) + to * time;
  constexpr double rounding = 0x1p-50;  // five roundings
  if (std::abs(gap) > rounding * (std::abs(from) + std::abs(to)) + std::numeric_limits<double>::min()) {
    return gap > 0 ? 1 : -1;
  }
  using detail::Dyadic;
  return ((Dyadic(sides.start) - Dyadic(sides.other_start)) * Dyadic(1 - time) +
          (Dyadic(sides.end) - Dyadic(sides.other_end)) * Dyadic(time))
      .sign();
}

/// Returns true if two boxes are apart along one axis at all times before the given one. Exact.
/// @param time  a multiple of 2^-40.
bool are_apart_before(const MovingBox& a, const MovingBox& b, double time) {
  if (time > 1) return false;
  return !for_each_sides(a, b,
                         [&](const Sides& sides) { return !(sides.start_gap() > 0 && gap_sign(sides, time) >= 0); });
}

/// Returns the part of a motion before a time, up to rounding.
FourMovingPoints until(const FourMovingPoints& points, double time) {
  if (time >= 1) return points;
  FourMovingPoints out = points;
  for (std::size_t k = 0; k < 4; ++k) out.end[k] = points.start[k] * (1 - time) + points.end[k] * time;
  return out;
}

}  // namespace

struct FirstSearch::Side {
  ContactKind kind;
  ObjectId first, second;
  const MovingObject& a;  ///< of the vertices, or of the first edges
  const MovingObject& b;  ///< of the faces, or of the second edges

  [[nodiscard]] bool is_edge() const { return kind == ContactKind::edge_edge; }
  [[nodiscard]] std::size_t count() const {
    return is_edge() ? a.features().edges().size() : a.features().vertices().size();
  }
  [[nodiscard]] std::span<const std::uint32_t> of_a(std::uint32_t k) const {
    if (is_edge()) return a.features().edges()[k];
    return {&a.features().vertices()[k], 1};
  }
  [[nodiscard]] std::span<const std::uint32_t> of_b(std::uint32_t k) const {
    if (is_edge()) return b.features().edges()[k];
    return b.features().faces()[k];
  }
  [[nodiscard]] const MovingBoxBvh& partners() const { return is_edge() ? b.edges() : b.faces(); }

  /// Returns true if two features are compared: each pair once, and no features of one object that share a vertex.
  [[nodiscard]] bool are_compared(std::uint32_t of_first, std::uint32_t of_second) const {
    if (&a != &b) return true;
    if (!is_edge()) {
      return !b.features().is_corner(a.features().vertices()[of_first], b.features().faces()[of_second]);
    }
    const std::vector<Segment>& edges = a.features().edges();
    return of_first < of_second && !share_end(edges[of_first], edges[of_second]);
  }

  [[nodiscard]] FourMovingPoints points(std::uint32_t of_first, std::uint32_t of_second) const {
    return moving_points(a.features(), of_a(of_first), b.features(), of_b(of_second));
  }
};

const FirstSearch::Side& FirstSearch::side_of(const std::vector<Side>& sides, ContactKind kind) {
  return *std::find_if(sides.begin(), sides.end(), [&](const Side& one) { return one.kind == kind; });
}

FirstSearch::FirstSearch(const ImpactOptions& options, const Context& context)
    : options_(options),
      context_(context),
      depth_(detail::time_depth(options.tolerance)),
      step_(std::ldexp(1.0, -depth_)) {}

double FirstSearch::bound(const MovingBox& a, const MovingBox& b) const {
  const double time = touch_time(a, b);
  if (time == infinite) return infinite;
  const double below = std::ldexp(std::floor(std::ldexp(time, depth_)), -depth_);
  // Many boxes touch exactly at a multiple of the step. Rounding must not lower their bounds by a whole step.
  constexpr double margin = 1 + 0x1p-46;
  return time * margin >= below + step_ && are_apart_before(a, b, below + step_) ? below + step_ : below;
}

bool FirstSearch::is_hopeless(ObjectId first, ObjectId second, double bound) const {
  return bound == infinite || !(Rank{bound, first, second} < best_rank_);
}

/// Returns the features of all sides with bounds of their contacts with the whole other object, sorted.
std::vector<FirstSearch::Feature> FirstSearch::features_of(const std::vector<Side>& sides) const {
  std::vector<Feature> all;
  for (const Side& side : sides) {
    const MovingBox whole = side.b.box(side.b.features().vertices());
    for (std::uint32_t k = 0; k < side.count(); ++k) {
      all.push_back({bound(side.a.box(side.of_a(k)), whole), side.kind, k});
    }
  }
  std::erase_if(all, [](const Feature& one) { return one.bound == infinite; });
  std::sort(all.begin(), all.end());
  return all;
}

/// Returns true if a contact at the time of a feature's bound would precede the best contact.
bool FirstSearch::may_precede(const Rank& best, const Side& side, const Feature& feature) {
  return Rank{feature.bound, side.first, side.second, feature.kind, feature.index} < best;
}

FirstSearch::Rank FirstSearch::best_rank() const {
  const std::lock_guard lock(mutex_);
  return best_rank_;
}

void FirstSearch::offer(const Rank& rank, const Side& side) {
  const std::lock_guard lock(mutex_);
  if (!(rank < best_rank_)) return;
  best_rank_ = rank;
  best_ = FirstContact{rank.first, rank.second, rank.kind, {}};
  if (side.is_edge()) {
    best_->features =
        EdgeEdgeCollision{side.a.features().edges()[rank.a], side.b.features().edges()[rank.b], rank.time};
  } else {
    best_->features = VertexFaceCollision{side.a.features().vertices()[rank.a], TriangleId(rank.b), rank.time};
  }
}

/// Tests a pair of features, if it may precede the best contact.
/// @param of_pair  bound of the pair.
/// @param best     the best contact that is known; it is brought up to date.
void FirstSearch::test(const Side& side, std::uint32_t first, std::uint32_t second, double of_pair, Rank& best) {
  Rank rank{of_pair, side.first, side.second, side.kind, first, second};
  if (of_pair == infinite || !(rank < best)) return;
  const FourMovingPoints four = side.points(first, second);
  rank.time = best.time;
  // At the time of the best contact, only pairs that precede it in the order of results are better.
  const double before = best.time > 1 ? detail::after_all_times : best.time + (rank < best ? step_ : 0);
  if (are_apart(until(four, before), side.is_edge() ? 2 : 1, options_.min_separation)) return;
  const auto kinds = side.is_edge() ? FeatureKinds::edge_edge : FeatureKinds::vertex_face;
  const std::optional<double> time = detail::impact(four, kinds, options_, before);
  if (!time) return;
  rank.time = *time;
  offer(rank, side);
  best = best_rank();
}

/// Tests the pairs of a feature that may precede the best contact, those with the least bounds first.
void FirstSearch::look_at(const Side& side, const Feature& feature) {
  const MovingBox box = side.a.box(side.of_a(feature.index));
  Rank best = best_rank();
  const double limit = std::min(best.time, 1.0) + step_;
  std::vector<std::pair<double, std::uint32_t>> partners;  // with their bounds
  side.partners().visit_until(box, limit, [&](std::uint32_t partner) {
    if (!side.are_compared(feature.index, partner)) return limit;
    const double of_pair = bound(box, side.b.box(side.of_b(partner)));
    if (of_pair < limit) partners.emplace_back(of_pair, partner);
    return limit;
  });
  std::sort(partners.begin(), partners.end());
  for (const auto& [of_pair, partner] : partners) test(side, feature.index, partner, of_pair, best);
}

/// Tests all pairs that may precede the best contact, in the order of the hierarchies. For one object, this is faster
/// than look_at() for all features: each feature has few partners, and touches most of them at the start.
void FirstSearch::sweep(const Side& side) {
  const MovingBoxBvh& own = side.is_edge() ? side.a.edges() : side.a.vertices();
  parallel_for(context_, own.block_count(), sweep_grain, "first contact", [&](const WorkRange& range) {
    Rank best = best_rank();
    const auto visit = [&](std::uint32_t first, std::uint32_t second) {
      if (!side.are_compared(first, second)) return;
      test(side, first, second, bound(side.a.box(side.of_a(first)), side.b.box(side.of_b(second))), best);
    };
    for (std::size_t block = range.begin; block < range.end; ++block) {
      if (&own == &side.partners()) {
        own.for_each_self_pair(
            block, [&](std::uint32_t one, std::uint32_t other) { visit(std::min(one, other), std::max(one, other)); });
      } else {
        own.for_each_pair(block, side.partners(), visit);
      }
    }
  });
}

/// Tests the pairs of a few features, because a contact that is known early saves most of the work.
void FirstSearch::probe(const std::vector<Side>& sides, const std::vector<Feature>& features) {
  constexpr std::size_t first_count = 16;
  constexpr std::size_t spread_count = 64;
  const std::size_t stride = std::max<std::size_t>(features.size() / spread_count, 1);
  for (std::size_t k = 0; k < features.size(); k += k + 1 < first_count ? 1 : stride) {
    throw_if_cancelled(context_);
    const Side& side = side_of(sides, features[k].kind);
    if (!may_precede(best_rank_, side, features[k])) return;  // nor may those that follow: they are sorted
    look_at(side, features[k]);
  }
}

void FirstSearch::add(ObjectId first, const MovingObject& a, ObjectId second, const MovingObject& b) {
  const bool is_self = &a == &b;
  std::vector<Side> sides{{ContactKind::vertex_face, first, second, a, b}};
  if (!is_self) sides.push_back({ContactKind::face_vertex, first, second, b, a});
  sides.push_back({ContactKind::edge_edge, first, second, a, b});
  const std::vector<Feature> features = features_of(sides);
  probe(sides, features);
  if (is_self) {
    for (const Side& side : sides) sweep(side);
    return;
  }
  parallel_for(context_, features.size(), search_grain, "first contact", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const Side& side = side_of(sides, features[k].kind);
      if (!may_precede(best_rank(), side, features[k])) return;  // nor may those that follow: they are sorted
      look_at(side, features[k]);
    }
  });
}

}  // namespace blum
