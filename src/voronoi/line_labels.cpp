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

  /// A point of the segment, and a label that is closest to it. All labels that are closest to it have the same site.
  struct Place {
    double at = 0;
    Label label;
  };

  /// Returns the closest label at a coordinate; nullopt if labels of different sites are equally close.
  [[nodiscard]] std::optional<Place> place_at(double at, std::span<const Label> among) const {
    const std::vector<Label> closest = labels_.closest_labels(among, point(at));
    if (closest.empty()) return std::nullopt;
    const auto is_other = [&](const Label& label) { return labels_.site_of(label) != labels_.site_of(closest[0]); };
    if (std::any_of(closest.begin(), closest.end(), is_other)) return std::nullopt;
    return Place{at, closest[0]};
  }

  /// Adds the changes of the closest site between two points. Returns false if the changes cannot be decided.
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

  /// Returns a point near the middle that has a single closest site; nullopt if three attempts find none.
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

/// One end of the interval in which a line lies in a domain.
struct IntervalEnd {
  double at = 0;
  double error = 0;
  LabelIndex beyond = outside;
  std::uint32_t edge = outside;  ///< the edge of the mesh in the plane that ends the interval, if any
};

/// A label that may be closest on a line. Positions are relative to the middle of the searched part.
struct Candidate {
  LabelIndex label = outside;
  std::uint32_t site = 0;
  SiteKind kind = SiteKind::face;
  Quadratic squared;
  IntervalEnd low{-infinity, 0, outside, outside};
  IntervalEnd high{infinity, 0, outside, outside};
  bool grazes = false;  ///< true if the line lies in a plane of the domain, up to rounding
};

/// The position at which `label` becomes closest.
struct Change {
  double at = infinity;
  double error = 0;
  LabelIndex label = outside;
  std::uint32_t site = 0;
  bool is_certain = true;  ///< true if the change is certain to happen, unless another change happens before
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

  /// Appends the events of the part. Returns true if all changes are certain.
  bool run(std::vector<LineEvent>& events) {
    LabelIndex current = part_.first;
    std::vector<std::uint32_t> recent;  // sites that ceased to be closest at this position, up to rounding
    double at = low_;
    double error = 0;
    bool is_certain = true;
    // The distances of two labels change their order at most twice. If more changes occur, rounding has made the walk
    // circular.
    const std::size_t most = 4 * candidates_.size() + 16;
    for (std::size_t count = 0; count < most; ++count) {
      const Change next = next_change(current, recent, at, error, is_certain);
      if (!(next.at - next.error <= high_)) return is_certain && is_as_expected(current);
      if (next.at + next.error >= high_ || next.label == outside) {
        return false;  // the change is too close to the end of the part for doubles to decide
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

  /// Returns the position from which on the second label is closer than the first.
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
      // The order of the distances does not change, unless rounding hides a change. In that case the largest difference
      // is 0 up to rounding.
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
    // If the slope changes its sign within the error, the root may not exist.
    if (root * root < 4 * std::abs(a) * error) {
      out.error = std::sqrt(error / std::abs(a));
      out.is_certain = false;
    } else {
      out.error = 2 * error / root;
    }
    return out;
  }

  /// Returns true if a label is certainly further than the current one everywhere between two positions.
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

  /// Cancels a change that lies outside the label's domain. Marks the change as uncertain if it is not certain that it
  /// lies outside.
  /// @param is_next  true if the change crosses a bisector at a convex edge or common end. There the domains overlap.
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

  /// Relation of two labels of the same kind (two faces or two edges) that may be adjacent.
  struct Adjacency {
    std::optional<Bisector> bisector;  ///< bisector at a convex edge or common end; positive on the side of `other`
    bool have_between = false;         ///< true if they share a reflex edge or vertex that is a site
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

  /// Returns the change to a label at a bisector. It is precise even if the edge between the labels is nearly flat.
  [[nodiscard]] Change change_at(const Bisector& bisector, const Candidate& other) const {
    const double slope = bisector.normal[part_.axis];
    if (!(slope > 0)) return {};
    return {-bisector.height(middle_) / slope, labels_.rounding() / slope, other.label, other.site, true};
  }

  /// Returns the change from the current label to another label after position `at`; without a change, its position is
  /// infinity.
  /// @param end  the end of the current site's domain.
  [[nodiscard]] Change change_to(LabelIndex label, const Quadratic& squared, const Candidate& other, double at,
                                 double error, const IntervalEnd& end) const {
    const PlacedLabel& current = labels_[label];
    if (!labels_.are_incident(current.site, other.label)) {
      if (other.low.at - other.low.error > end.at + end.error) return {};
      if (other.high.at + other.high.error < at - error) return {};
      const Adjacency adjacent = adjacency(label, other);
      // Between two faces at a reflex edge, or two edges at a reflex vertex, the edge or vertex itself is closest.
      const bool is_apart =
          other.low.at + other.low.error >= end.at - end.error || other.high.at - other.high.error <= at + error;
      if (adjacent.have_between && is_apart) return {};
      if (!adjacent.bisector && is_further(other, squared, at - error, end.at + end.error)) return {};
      Change change = adjacent.bisector ? change_at(*adjacent.bisector, other) : crossing(squared, other, at);
      if (change.at < infinity) check_domain(other, change, adjacent.bisector.has_value());
      return change;
    }
    // This covers changes from a face to its own edge. add_own_end() covers changes from edges and vertices to incident
    // sites.
    const IntervalEnd& begin = other.low;
    const bool is_wall = current.kind == SiteKind::face && other.kind == SiteKind::edge && begin.beyond != outside &&
                         labels_[begin.beyond].site == current.site;
    if (!is_wall) return {};
    // Between the planes of both triangles at a reflex edge, the edge's domain is never empty, even if it is narrower
    // than rounding.
    const bool is_between = other.high.edge == begin.edge && begin.edge != outside;
    const bool may_be_empty = !is_between && begin.at + begin.error > other.high.at - other.high.error;
    return {begin.at, begin.error, other.label, other.site, !may_be_empty && !other.grazes};
  }

  /// Returns the end of a site's domain: the furthest position that its labels' intervals cover without a gap from
  /// `at`.
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

  /// Adds the change at the end of an edge's or vertex's own domain. Returns false if the end is uncertain.
  bool add_own_end(LabelIndex current) const {
    const Candidate* own = find(current);
    if (own == nullptr || own->grazes) return false;
    if (!(own->high.at < infinity)) return true;
    const LabelIndex beyond = own->high.beyond;
    const bool is_known = beyond != outside;
    // If the end of the edge is not a site, another edge with the same end may become closest.
    const double reach = own->high.at + own->high.error;
    const bool goes_on = !is_known && std::any_of(changes_.begin(), changes_.end(), [&](const Change& change) {
      return change.at - change.error <= reach;
    });
    if (goes_on) return true;
    changes_.push_back({own->high.at, own->high.error, beyond, is_known ? labels_[beyond].site : outside, is_known});
    return true;
  }

  /// @param recent  sites that were closest just before, in order; `current` replaced the last of them.
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
        // Skips the reverse of the previous change, and sites whose domains end at this position.
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
    // Inside the solid, a domain ends only where another site is closest. If no other site is closest there, a change
    // was missed.
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
    // Halves the interval further around the only change in it.
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
