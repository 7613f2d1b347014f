#include "voronoi/line_labels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace blum::voronoi {
namespace {

class SegmentSearch {
 public:
  SegmentSearch(const SiteLabels& labels, const Vec3d& from, std::size_t axis)
      : labels_(labels), from_(from), axis_(axis) {}

  /// A place on the segment, and a label that is closest there. All labels that are closest there have its site.
  struct Place {
    double at = 0;
    Label label;
  };

  /// Returns nullopt if sites tie.
  [[nodiscard]] std::optional<Place> place_at(double at, std::span<const Label> among) const {
    const std::vector<Label> closest = labels_.closest_labels(among, point(at));
    if (closest.empty()) return std::nullopt;
    const auto is_other = [&](const Label& label) { return labels_.site_of(label) != labels_.site_of(closest[0]); };
    if (std::any_of(closest.begin(), closest.end(), is_other)) return std::nullopt;
    return Place{at, closest[0]};
  }

  /// Adds the changes between two places. Returns false if they cannot be decided.
  bool add_changes(const Place& begin, const Place& end, std::span<const Label> among, SegmentLabels& out) const {
    const std::vector<Label> left = labels_left(begin, end, among);
    if (is_one_site(left)) return true;
    if (is_one_change(begin, end, left)) {
      out.sites.push_back(labels_.site_of(end.label));
      out.changes.push_back({begin.at, end.at});
      return true;
    }
    const std::optional<Place> middle = place_between(begin.at, end.at, left);
    return middle && add_changes(begin, *middle, left, out) && add_changes(*middle, end, left, out);
  }

 private:
  [[nodiscard]] Vec3d point(double at) const {
    Vec3d out = from_;
    out[axis_] = at;
    return out;
  }

  [[nodiscard]] std::vector<Label> labels_left(const Place& begin, const Place& end,
                                               std::span<const Label> among) const {
    const Vec3d q = point(begin.at);
    const Vec3d r = point(end.at);
    std::vector<Label> dominators;
    for (const Label& label : {begin.label, end.label}) {
      if (labels_.is_attained(label, q, r)) dominators.push_back(label);
    }
    if (dominators.empty() && labels_.is_attained(begin.label, end.label, q, r)) {
      dominators.push_back(begin.label);
    }
    const auto is_ruled_out = [&](const Label& label) {
      return labels_.is_apart(label, q, r) || std::any_of(dominators.begin(), dominators.end(), [&](const Label& by) {
               return !(by == label) && labels_.compare_polar(label, by, q, q) > 0 &&
                      labels_.compare_polar(label, by, q, r) > 0 && labels_.compare_polar(label, by, r, r) > 0;
             });
    };
    std::vector<Label> left;
    std::copy_if(among.begin(), among.end(), std::back_inserter(left),
                 [&](const Label& label) { return !is_ruled_out(label); });
    return left;
  }

  [[nodiscard]] bool is_one_site(const std::vector<Label>& left) const {
    return std::all_of(left.begin(), left.end(),
                       [&](const Label& label) { return labels_.site_of(label) == labels_.site_of(left[0]); });
  }

  [[nodiscard]] bool is_one_change(const Place& begin, const Place& end, const std::vector<Label>& left) const {
    if (left.size() != 2 || begin.label == end.label) return false;
    if (labels_.are_incident(begin.label, end.label)) return true;
    return labels_.compare_distances(begin.label, end.label, point(begin.at)) < 0 &&
           labels_.compare_distances(begin.label, end.label, point(end.at)) > 0;
  }

  /// Returns a place near the middle at which no sites tie.
  [[nodiscard]] std::optional<Place> place_between(double begin, double end, std::span<const Label> among) const {
    for (const double part : {0.5, 0.4375, 0.59375}) {
      const double at = begin + (end - begin) * part;
      if (!(begin < at && at < end)) return std::nullopt;
      if (const std::optional<Place> found = place_at(at, among)) return found;
    }
    return std::nullopt;
  }

  const SiteLabels& labels_;
  Vec3d from_;
  std::size_t axis_;
};

constexpr double infinity = std::numeric_limits<double>::infinity();

/// One end of the interval in which a line runs through a domain.
struct IntervalEnd {
  double at = 0;
  double error = 0;
  LabelIndex beyond = outside;
  std::uint32_t edge = outside;  ///< the edge of the mesh that lies in the plane there
};

/// A label along a line; s is measured from a point of the line.
struct Candidate {
  LabelIndex label = outside;
  std::uint32_t site = 0;
  SiteKind kind = SiteKind::face;
  Quadratic squared;
  IntervalEnd low{-infinity, 0, outside, outside};
  IntervalEnd high{infinity, 0, outside, outside};
  bool grazes = false;  ///< true if the line runs along a plane of its domain, or nearly
};

/// The place at which a label takes over from the closest one.
struct Change {
  double at = infinity;
  double error = 0;
  LabelIndex label = outside;
  std::uint32_t site = 0;
  bool is_certain = true;  ///< true if it happens, given that nothing happens before
};

class EnvelopeWalk {
 public:
  EnvelopeWalk(const LabelGeometry& labels, const LinePart& part, std::span<const LabelIndex> among)
      : labels_(labels),
        part_(part),
        middle_(part.origin - labels.centre()),
        base_(part.low + (part.high - part.low) / 2),
        low_(part.low - base_),
        high_(part.high - base_) {
    middle_[part.axis] = base_ - labels.centre()[part.axis];
    for (const LabelIndex label : among) add_candidate(label);
  }

  /// Returns true if all changes are certain.
  bool run(std::vector<LineEvent>& events) {
    LabelIndex current = part_.first;
    std::vector<std::uint32_t> recent;  // sites that ended here, up to rounding
    double at = low_;
    double error = 0;
    bool is_certain = true;
    // Two labels change their order at most twice. With more changes, rounding made the walk go in circles.
    const std::size_t most = 4 * candidates_.size() + 16;
    for (std::size_t count = 0; count < most; ++count) {
      const Change next = next_change(current, recent, at, error, is_certain);
      if (!(next.at - next.error <= high_)) return is_certain && is_as_expected(current);
      if (next.at + next.error >= high_ || next.label == outside) {
        return false;  // too close to the end for doubles to decide
      }
      events.push_back({base_ + next.at, next.error + labels_.rounding(), current, next.label});
      if (next.at - next.error > at + error) recent.clear();
      recent.push_back(labels_[current].site);
      current = next.label;
      at = next.at;
      error = next.error;
    }
    return false;
  }

 private:
  [[nodiscard]] bool is_as_expected(LabelIndex current) const {
    return part_.last == outside || labels_[part_.last].site == labels_[current].site;
  }

  void add_candidate(LabelIndex label) {
    const PlacedLabel& placed = labels_[label];
    Candidate out;
    out.label = label;
    out.site = placed.site;
    out.kind = placed.kind;
    for (const DomainPlane& plane : labels_.planes(label)) {
      const double height = plane.height(middle_);
      const double slope = plane.normal[part_.axis];
      const double reach = std::abs(slope) * (high_ - low_);
      if (reach <= 4 * labels_.rounding()) {
        if (height + reach < -4 * labels_.rounding()) return;
        if (height - reach < 4 * labels_.rounding()) out.grazes = true;
        continue;
      }
      const IntervalEnd end{-height / slope, labels_.rounding() / std::abs(slope), plane.beyond, plane.edge};
      if (slope > 0 && end.at > out.low.at) out.low = end;
      if (slope < 0 && end.at < out.high.at) out.high = end;
    }
    if (out.low.at - out.low.error > out.high.at + out.high.error) return;
    if (out.low.at - out.low.error > high_ || out.high.at + out.high.error < low_) return;
    out.squared = placed.along(middle_, part_.axis);
    candidates_.push_back(out);
  }

  [[nodiscard]] const Candidate* find(LabelIndex label) const {
    const auto found =
        std::find_if(candidates_.begin(), candidates_.end(), [&](const Candidate& c) { return c.label == label; });
    return found == candidates_.end() ? nullptr : &*found;
  }

  /// Returns the place at which the second label becomes as close as the first, and closer beyond it.
  [[nodiscard]] Change crossing(const Quadratic& first, const Candidate& second, double from) const {
    const Quadratic difference = first - second.squared;
    const auto& [a, b, c] = difference;
    const double discriminant = b * b - 4 * a * c;
    Change out;
    out.label = second.label;
    out.site = second.site;
    const double distance = std::sqrt(std::max(0.0, first.at(from)));
    double error = labels_.rounding_of_squares(distance + (high_ - low_));
    if (!(discriminant > 0)) {
      // Their order does not change, unless rounding hides a change: then the largest difference is 0 up to rounding.
      if (a < 0 && discriminant > 4 * a * error) {
        out.at = -b / (2 * a);
        out.error = std::sqrt(error / -a);
        out.is_certain = false;
      }
      return out;
    }
    const double root = std::sqrt(discriminant);
    if (b > 0) {
      out.at = -2 * c / (b + root);
    } else if (a != 0) {
      out.at = (root - b) / (2 * a);
    } else {
      return out;
    }
    error = labels_.rounding_of_squares(std::sqrt(std::max(0.0, first.at(out.at))));
    // If the slope changes within the error, the root may not exist.
    if (root * root < 4 * std::abs(a) * error) {
      out.error = std::sqrt(error / std::abs(a));
      out.is_certain = false;
    } else {
      out.error = 2 * error / root;
    }
    return out;
  }

  /// Returns true if a label is certainly further than the current one everywhere between two places.
  [[nodiscard]] bool is_further(const Candidate& other, const Quadratic& squared, double from, double to) const {
    from = std::max({from, other.low.at - other.low.error, low_});
    to = std::min({to, other.high.at + other.high.error, high_});
    const Quadratic difference = other.squared - squared;
    const double distance = std::sqrt(std::max({0.0, squared.at(from), squared.at(to)}));
    const double error = 4 * labels_.rounding_of_squares(distance);
    if (!(difference.at(from) > error && difference.at(to) > error)) return false;
    const double lowest = -difference.b / (2 * difference.a);
    return !(difference.a > 0 && lowest > from && lowest < to) || difference.at(lowest) > error;
  }

  [[nodiscard]] bool is_flat(const Candidate& candidate, const IntervalEnd& end) const {
    return end.beyond != outside && labels_[end.beyond].site == candidate.site;
  }

  /// Removes a change outside of the label's domain, and marks one for which this is uncertain.
  /// @param is_next  true if the change is across a convex edge, where the domains overlap.
  void check_domain(const Candidate& candidate, Change& change, bool is_next) const {
    for (const int side : {-1, 1}) {
      const IntervalEnd& end = side < 0 ? candidate.low : candidate.high;
      const double inside = side < 0 ? change.at - end.at : end.at - change.at;
      const double error = change.error + end.error;
      if (inside < -error) {
        change.at = infinity;
        return;
      }
      const bool is_shared = is_next && side < 0;
      if (inside < error && !is_flat(candidate, end) && !is_shared) change.is_certain = false;
    }
    if (candidate.grazes) change.is_certain = false;
  }

  /// Relation of two labels of one kind that are next to each other.
  struct Adjacency {
    std::optional<Bisector> bisector;  ///< across a convex edge or a common end, to the side of the other label
    bool have_between = false;         ///< true if they share an edge or vertex that is a site itself
  };
  [[nodiscard]] Adjacency adjacency(LabelIndex current, const Candidate& other) const {
    const PlacedLabel& face = labels_[current];
    Adjacency out;
    if (face.kind == SiteKind::edge && other.kind == SiteKind::edge) {
      out.bisector = labels_.bisector(other.label, current);
      for (const DomainPlane& of_current : labels_.ends(current)) {
        for (const DomainPlane& of_other : labels_.ends(other.label)) {
          if (of_current.beyond != outside && of_current.beyond == of_other.beyond) out.have_between = true;
        }
      }
      return out;
    }
    if (face.kind != SiteKind::face || other.kind != SiteKind::face) return out;
    for (const Bisector& bisector : labels_.bisectors(other.label)) {
      if (bisector.other != outside && labels_[bisector.other].site == face.site) out.bisector = bisector;
    }
    for (const DomainPlane& side : labels_.planes(other.label)) {
      if (side.beyond == outside || labels_[side.beyond].kind != SiteKind::edge) continue;
      for (const DomainPlane& wall : labels_.planes(side.beyond)) {
        if (wall.beyond != outside && labels_[wall.beyond].site == face.site) out.have_between = true;
      }
    }
    return out;
  }

  /// Returns the change to a label across a bisector. It is precise however flat the edge between them is.
  [[nodiscard]] Change change_at(const Bisector& bisector, const Candidate& other) const {
    const double slope = bisector.normal[part_.axis];
    if (!(slope > 0)) return {};
    return {-bisector.height(middle_) / slope, labels_.rounding() / slope, other.label, other.site, true};
  }

  /// Returns a change from the current label to another one behind a place, if one exists.
  /// @param end  the furthest place that the current label's domain reaches.
  [[nodiscard]] Change change_to(LabelIndex label, const Quadratic& squared, const Candidate& other, double at,
                                 double error, const IntervalEnd& end) const {
    const PlacedLabel& current = labels_[label];
    if (!labels_.are_incident(current.site, other.label)) {
      if (other.low.at - other.low.error > end.at + end.error) return {};
      if (other.high.at + other.high.error < at - error) return {};
      const Adjacency adjacent = adjacency(label, other);
      // Between the two sides of a reflex edge or vertex, that site itself is closest.
      const bool is_apart =
          other.low.at + other.low.error >= end.at - end.error || other.high.at - other.high.error <= at + error;
      if (adjacent.have_between && is_apart) return {};
      if (!adjacent.bisector && is_further(other, squared, at - error, end.at + end.error)) return {};
      Change change = adjacent.bisector ? change_at(*adjacent.bisector, other) : crossing(squared, other, at);
      if (change.at < infinity) check_domain(other, change, adjacent.bisector.has_value());
      return change;
    }
    // A face changes to its own edge here. Changes from edges and vertices follow from their own domains (add_own_end).
    const IntervalEnd& begin = other.low;
    const bool is_wall = current.kind == SiteKind::face && other.kind == SiteKind::edge && begin.beyond != outside &&
                         labels_[begin.beyond].site == current.site;
    if (!is_wall) return {};
    // The planes of both triangles of a reflex edge leave room between them, even if it is less than rounding.
    const bool is_between = other.high.edge == begin.edge && begin.edge != outside;
    const bool may_be_empty = !is_between && begin.at + begin.error > other.high.at - other.high.error;
    return {begin.at, begin.error, other.label, other.site, !may_be_empty && !other.grazes};
  }

  /// Returns the furthest place behind another one that a site's domain reaches without a gap.
  [[nodiscard]] IntervalEnd end_of_domain(std::uint32_t site, double at, double error) const {
    IntervalEnd end{at, error, outside, outside};
    for (bool grows = true; grows;) {
      grows = false;
      for (const Candidate& own : candidates_) {
        if (own.site != site || own.low.at - own.low.error > end.at + end.error) continue;
        if (own.high.at <= end.at) continue;
        end = own.high;
        grows = true;
      }
    }
    return end;
  }

  /// Adds the end of the domain of an edge or vertex. Returns false if the end is uncertain.
  bool add_own_end(LabelIndex current) const {
    const Candidate* own = find(current);
    if (own == nullptr || own->grazes) return false;
    if (!(own->high.at < infinity)) return true;
    const LabelIndex beyond = own->high.beyond;
    const bool is_known = beyond != outside;
    // If its end is not a site, another edge with this end may continue.
    const double reach = own->high.at + own->high.error;
    const bool goes_on = !is_known && std::any_of(changes_.begin(), changes_.end(), [&](const Change& change) {
      return change.at - change.error <= reach;
    });
    if (goes_on) return true;
    changes_.push_back({own->high.at, own->high.error, beyond, is_known ? labels_[beyond].site : outside, is_known});
    return true;
  }

  /// @param recent  sites that were closest up to here; `current` took over from the last of them.
  Change next_change(LabelIndex current, const std::vector<std::uint32_t>& recent, double at, double error,
                     bool& is_certain) const {
    const PlacedLabel& placed = labels_[current];
    const Quadratic squared = placed.along(middle_, part_.axis);
    const IntervalEnd end = end_of_domain(placed.site, at, error);
    std::vector<Change>& changes = changes_;
    changes.clear();
    for (const Candidate& other : candidates_) {
      if (other.site == placed.site) continue;
      const Change change = change_to(current, squared, other, at, error, end);
      if (!(change.at < infinity) || change.at + change.error < at - error) continue;
      if (change.at - change.error > end.at + end.error) continue;
      if (change.at - change.error <= at + error) {
        // Skips the change just passed, seen from its other side, and sites that have ended here.
        if (!recent.empty() && other.site == recent.back()) continue;
        const bool was_recent = std::find(recent.begin(), recent.end(), other.site) != recent.end();
        if (was_recent && other.high.at - other.high.error <= at + error) continue;
        is_certain = false;
        if (change.at <= at) continue;
      }
      changes.push_back(change);
    }
    if (placed.kind != SiteKind::face && !add_own_end(current)) is_certain = false;
    Change first;
    for (const Change& change : changes) {
      if (change.at < first.at) first = change;
    }
    // In the solid, a domain ends only where something else is closest.
    if (!(first.at < infinity) && end.at + end.error < high_) is_certain = false;
    if (!(first.at - first.error <= high_)) return first;
    if (!first.is_certain) is_certain = false;
    for (const Change& change : changes) {
      if (change.site != first.site && change.at - change.error <= first.at + first.error) is_certain = false;
    }
    return first;
  }

  const LabelGeometry& labels_;
  const LinePart& part_;
  Vec3d middle_;
  double base_ = 0;
  double low_ = 0, high_ = 0;
  std::vector<Candidate> candidates_;
  mutable std::vector<Change> changes_;
};

}  // namespace

std::optional<SegmentLabels> labels_along(const SiteLabels& labels, std::span<const Label> among, const Vec3d& from,
                                          const Vec3d& to, std::size_t axis) {
  const SegmentSearch search(labels, from, axis);
  const std::optional<SegmentSearch::Place> begin = search.place_at(from[axis], among);
  const std::optional<SegmentSearch::Place> end = search.place_at(to[axis], among);
  if (!begin || !end) return std::nullopt;
  SegmentLabels out;
  out.sites.push_back(labels.site_of(begin->label));
  if (!search.add_changes(*begin, *end, among, out)) return std::nullopt;
  return out;
}

bool LineLabels::add_events(const LinePart& part, std::span<const LabelIndex> among,
                            std::vector<LineEvent>& events) const {
  parts_.fetch_add(1, std::memory_order_relaxed);
  const std::size_t begin = events.size();
  EnvelopeWalk walk(labels_, part, among);
  if (walk.run(events)) return true;
  std::vector<LineEvent> exact;
  if (add_exact_events(part, among, exact)) {
    exact_parts_.fetch_add(1, std::memory_order_relaxed);
    events.resize(begin);
    events.insert(events.end(), exact.begin(), exact.end());
    return true;
  }
  undecided_.fetch_add(1, std::memory_order_relaxed);
  return false;
}

bool LineLabels::add_exact_events(const LinePart& part, std::span<const LabelIndex> among,
                                  std::vector<LineEvent>& events) const {
  std::vector<Label> labels;
  for (const LabelIndex label : among) labels.push_back(exact_.all()[label]);
  Vec3d from = part.origin;
  Vec3d to = part.origin;
  from[part.axis] = part.low;
  to[part.axis] = part.high;
  const auto found = labels_along(exact_, labels, from, to, part.axis);
  if (!found || found->sites.front() != labels_[part.first].site) return false;
  if (part.last != outside && found->sites.back() != labels_[part.last].site) return false;
  const auto label_of = [&](std::uint32_t site) {
    return *std::find_if(among.begin(), among.end(), [&](LabelIndex k) { return labels_[k].site == site; });
  };
  LabelIndex current = part.first;
  for (std::size_t k = 0; k < found->changes.size(); ++k) {
    const LabelIndex next = label_of(found->sites[k + 1]);
    auto [low, high] = found->changes[k];
    // Halves the interval further, to the only change in it.
    while (high - low > labels_.rounding()) {
      const double middle = low + (high - low) / 2;
      if (!(low < middle && middle < high)) break;
      Vec3d q = part.origin;
      q[part.axis] = middle;
      (is_behind_change(exact_, labels_, current, next, q) ? high : low) = middle;
    }
    events.push_back({low + (high - low) / 2, high - low + labels_.rounding(), current, next});
    current = next;
  }
  return true;
}

bool is_behind_change(const SiteLabels& exact, const LabelGeometry& labels, LabelIndex before, LabelIndex after,
                      const Vec3d& q) {
  const Label& first = exact.all()[before];
  const Label& second = exact.all()[after];
  if (labels.are_incident(labels[before].site, after)) {
    return first.kind > second.kind ? exact.is_in_domain(second, q) : !exact.is_in_domain(first, q);
  }
  return exact.compare_distances(second, first, q) < 0;
}

}  // namespace blum::voronoi
