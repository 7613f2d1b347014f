#include "voronoi/segment_labels.hpp"

#include <algorithm>
#include <cstddef>

namespace blum::voronoi {
namespace {

class SegmentSearch {
 public:
  SegmentSearch(const SiteLabels& labels, const Vec3d& from, std::size_t axis)
      : labels_(labels), from_(from), axis_(axis) {}

  /// A place on the segment, and a label that is closest there; all that are have its site.
  struct Place {
    double at = 0;
    Label label;
  };

  /// nullopt where sites tie.
  [[nodiscard]] std::optional<Place> place_at(double at, std::span<const Label> among) const {
    const std::vector<Label> closest = labels_.closest_labels(among, point(at));
    if (closest.empty()) return std::nullopt;
    const auto is_other = [&](const Label& label) { return labels_.site_of(label) != labels_.site_of(closest[0]); };
    if (std::any_of(closest.begin(), closest.end(), is_other)) return std::nullopt;
    return Place{at, closest[0]};
  }

  /// Adds the changes between two places; false where they cannot be told.
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

  /// Near the middle, where no sites tie.
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

}  // namespace blum::voronoi
