#include "certificate/triangle_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "blum/core/inline_list.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/random.hpp"
#include "certificate/segments.hpp"

namespace blum::verifier {
namespace {

enum class Meeting : std::uint8_t { none, crossing, doubtful };

/// Decides if a line meets a triangle, from the projection of the triangle along the line.
Meeting meet(const ProbeLine& line, const std::array<Vec3d, 3>& corners, double& at) {
  constexpr double rounding = 1e-14;
  std::array<double, 3> x{};
  std::array<double, 3> y{};
  std::array<double, 3> z{};
  std::array<double, 3> error{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d q = corners[k] - line.point;
    x[k] = dot(line.across, q);
    y[k] = dot(line.up, q);
    z[k] = dot(line.along, q);
    error[k] = rounding * length(q);
  }
  const auto is_beside = [&](const std::array<double, 3>& c) {
    return (c[0] > error[0] && c[1] > error[1] && c[2] > error[2]) ||
           (c[0] < -error[0] && c[1] < -error[1] && c[2] < -error[2]);
  };
  if (is_beside(x) || is_beside(y)) return Meeting::none;
  std::array<double, 3> weight{};  // weight of the corner opposite to each edge
  bool is_left = false;
  bool is_right = false;
  bool is_doubtful = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = (k + 1) % 3;
    const std::size_t b = (k + 2) % 3;
    weight[k] = x[a] * y[b] - x[b] * y[a];
    const double doubt = (error[a] * error[b]) / rounding;
    if (weight[k] > doubt)
      is_left = true;
    else if (weight[k] < -doubt)
      is_right = true;
    else
      is_doubtful = true;
  }
  if (is_left && is_right) return Meeting::none;
  if (is_doubtful) return Meeting::doubtful;
  at = (weight[0] * z[0] + weight[1] * z[1] + weight[2] * z[2]) / (weight[0] + weight[1] + weight[2]);
  return Meeting::crossing;
}

/// Returns true if the part of a line from `begin` to `end` may meet a box, with room for rounding.
bool may_meet(const ProbeLine& line, const Box3& box, double begin, double end, double slack) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = box.lower[axis] - line.point[axis];
    const double high = box.upper[axis] - line.point[axis];
    if (std::abs(line.along[axis]) < 1e-6) {  // nearly parallel to the slab
      const double room = std::abs(end) < HUGE_VAL ? slack + 1e-6 * end : HUGE_VAL;
      if (low > room || high < -room) return false;
      continue;
    }
    const double a = low / line.along[axis];
    const double b = high / line.along[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin <= end + slack;
}

/// Tests if segments may pierce a triangle. If rounding leaves doubt, the answer is that they may.
class PiercedTriangle {
 public:
  /// @param normal  unit normal.
  /// @param slack   bound on the effects of rounding.
  PiercedTriangle(const std::array<Vec3d, 3>& corners, const Vec3d& normal, double slack)
      : corners_(corners), normal_(normal), slack_(slack) {
    for (const Vec3d& corner : corners) box_.extend(corner);
    const Vec3d more{slack, slack, slack};
    box_ = {box_.lower - more, box_.upper + more};
  }

  [[nodiscard]] bool may_meet(const Box3& box) const {
    const bool is_apart = !(max(box.lower, box_.lower) == min(max(box.lower, box_.lower), min(box.upper, box_.upper)));
    if (is_apart) return false;
    const Vec3d half = 0.5 * (box.upper - box.lower);
    const double reach = std::abs(normal_.x) * half.x + std::abs(normal_.y) * half.y + std::abs(normal_.z) * half.z;
    return std::abs(height(0.5 * (box.lower + box.upper))) <= reach + slack_;
  }

  /// Returns true if the segment from p to q may pierce the triangle.
  [[nodiscard]] bool may_be_pierced(const Vec3d& p, const Vec3d& q) const {
    const double above = height(p);
    const double below = height(q);
    if ((above > slack_ && below > slack_) || (above < -slack_ && below < -slack_)) return false;
    if (std::abs(above) <= slack_ || std::abs(below) <= slack_) {
      if (!may_meet(Box3{min(p, q), max(p, q)})) return false;
      // Only the part next to the plane may meet the triangle.
      const auto next_to_plane = [&](const Vec3d& x, double height, const Vec3d& other, double other_height) {
        if (std::abs(height) <= slack_) return x;
        return x + (other - x) * ((height - std::copysign(slack_, height)) / (height - other_height));
      };
      return !are_beyond_side(next_to_plane(p, above, q, below), next_to_plane(q, below, p, above));
    }
    const Vec3d at = p + (q - p) * (above / (above - below));
    return !are_beyond_side(at, at);
  }

 private:
  /// Returns true if two points lie clearly beyond the same side of the triangle.
  [[nodiscard]] bool are_beyond_side(const Vec3d& p, const Vec3d& q) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d side = corners_[(k + 1) % 3] - corners_[k];
      const Vec3d across = cross(normal_, side);
      const double most = -slack_ * length(side);
      if (dot(across, p - corners_[k]) < most && dot(across, q - corners_[k]) < most) return true;
    }
    return false;
  }
  [[nodiscard]] double height(const Vec3d& p) const { return dot(normal_, p - corners_[0]); }

  const std::array<Vec3d, 3>& corners_;
  Vec3d normal_;
  double slack_;
  Box3 box_;
};

}  // namespace

ProbeLine line_through(const Vec3d& point, std::uint32_t attempt) {
  Random random(0x5eedU + attempt);
  Vec3d along;
  do {
    along = random.in_ball();
  } while (std::min({std::abs(along.x), std::abs(along.y), std::abs(along.z)}) < 0.2);
  along = along / length(along);
  Vec3d across = cross(along, Vec3d{0, 0, 1});
  across = across / length(across);
  return {point, along, across, cross(along, across)};
}

Vec3d closest_point(const Vec3d& p, const std::array<Vec3d, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3d to_p = p - a;
  const Vec3d ab = b - a;
  const Vec3d ac = c - a;
  const Vec3d normal = cross(ab, ac);
  // Barycentric weights of the foot on the plane, times `squared`. An edge is tested, too, if the foot is beyond it, or
  // if rounding leaves doubt about that.
  const double squared = squared_length(normal);
  const double to_b = dot(cross(to_p, ac), normal);
  const double to_c = dot(cross(ab, to_p), normal);
  const double largest = std::max({squared_length(to_p), squared_length(ab), squared_length(ac)});
  const double doubt = 1e-13 * largest * largest;
  Vec3d best = a;
  double best_squared = squared_length(to_p);
  const auto look_at = [&](const Vec3d& other) {
    const double own = squared_length(p - other);
    if (own < best_squared) {
      best = other;
      best_squared = own;
    }
  };
  if (!(squared - to_b - to_c > doubt)) look_at(Segment3{b, c}.closest_point(p));
  if (!(to_b > doubt)) look_at(Segment3{c, a}.closest_point(p));
  if (!(to_c > doubt)) look_at(Segment3{a, b}.closest_point(p));
  // A weighted mean of the corners is a point of the triangle, whatever the rounding.
  if (!(squared > 0)) return best;
  const double share_b = to_b / squared;
  const double share_c = to_c / squared;
  if (share_b >= 0 && share_c >= 0 && share_b + share_c <= 1) look_at(a + ab * share_b + ac * share_c);
  return best;
}

ProbeLine line_between(const Vec3d& from, const Vec3d& to) {
  const Vec3d along = (to - from) / length(to - from);
  std::size_t least = 0;
  for (std::size_t a = 1; a < 3; ++a) {
    if (std::abs(along[a]) < std::abs(along[least])) least = a;
  }
  Vec3d other;
  other[least] = 1;
  const Vec3d across = cross(along, other) / length(cross(along, other));
  return {from, along, across, cross(along, across)};
}

double squared_distance(const Vec3d& p, const std::array<Vec3d, 3>& corners) {
  return squared_length(p - closest_point(p, corners));
}

double distance_from_site(const MeshView& mesh, const SiteTable& sites, const Vec3d& p, SiteId site) {
  if (!site.has_value() || site.value >= sites.size()) return HUGE_VAL;
  const std::array<std::int32_t, 3> vertices = sites.vertices(site);
  std::array<Vec3d, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = mesh.vertices[static_cast<std::size_t>(vertices[k] < 0 ? vertices[0] : vertices[k])];
  }
  return std::sqrt(squared_distance(p, corners));
}

namespace {

constexpr double as_close = 1 + 1e-8;  ///< up to this ratio, squared distances count as equal

/// The closest points of triangles that are about as close to a point as the closest triangle.
class ClosePoints {
 public:
  /// @param best  the least squared distance so far, including this one.
  void add(const Vec3d& point, double squared, std::uint32_t triangle, double best) {
    const auto is_far = [&](const Found& found) { return found.squared > best * as_close; };
    if (found_.is_full()) {
      found_.shrink(static_cast<std::size_t>(std::remove_if(found_.begin(), found_.end(), is_far) - found_.begin()));
    }
    is_full_ = is_full_ || found_.is_full();
    if (!is_full_) found_.push_back({point, squared, triangle});
  }
  /// Counts in `nearest` the other triangles whose closest points coincide with the best one.
  void count(double best, TriangleSearch::Nearest& nearest) const {
    constexpr double as_near = 1e-12;  // squared, relative to the squared distance
    if (is_full_ || found_.empty()) return;
    const Found* closest = std::min_element(found_.begin(), found_.end(),
                                            [](const Found& a, const Found& b) { return a.squared < b.squared; });
    nearest.others = 0;
    for (const Found& found : found_) {
      if (&found == closest || squared_length(found.point - closest->point) > as_near * best) continue;
      ++*nearest.others;
      nearest.other = found.triangle;
    }
  }

 private:
  struct Found {
    Vec3d point;
    double squared = 0;
    std::uint32_t triangle = 0;
  };
  InlineList<Found, 16> found_;
  bool is_full_ = false;
};

}  // namespace

TriangleSearch::TriangleSearch(const MeshView& mesh, std::span<const std::uint32_t> groups, const Context& context) {
  std::vector<Box3> boxes;
  std::vector<std::uint32_t> kept;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t % 65536 == 0) throw_if_cancelled(context);
    if (!groups.empty() && groups[t] == no_group) continue;
    kept.push_back(t);
    Box3& box = boxes.emplace_back();
    for (const std::uint32_t v : mesh.triangles[t]) box.extend(mesh.vertices[v]);
    bounds_.extend(box);
  }
  tree_ = BoxHierarchy(boxes, context);
  for (const std::uint32_t place : tree_.order()) {
    const std::uint32_t t = kept[place];
    const Triangle& corner = mesh.triangles[t];
    corners_.push_back({mesh.vertices[corner[0]], mesh.vertices[corner[1]], mesh.vertices[corner[2]]});
    triangles_.push_back(t);
    groups_.push_back(groups.empty() ? 0 : groups[t]);
  }
  make_flat_boxes(context);
}

void TriangleSearch::make_flat_boxes(const Context& context) {
  constexpr std::size_t most_triangles = 64;
  constexpr std::size_t grain = 1024;
  const std::vector<BoxHierarchy::Places> places = tree_.places();
  flat_boxes_.resize(tree_.node_count() / 2);
  parallel_for(context, flat_boxes_.size(), grain, {}, [&](const WorkRange& range) {
    for (std::size_t pair = range.begin; pair < range.end; ++pair) {
      for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t n = 2 * pair + 1 + k;
        const auto [begin, end] = places[n];
        FlatBox flat;
        flat.box = tree_.node(static_cast<std::uint32_t>(n)).box;
        if (end - begin <= most_triangles) flat = flat_box({corners_.data() + begin, end - begin});
        flat_boxes_[pair].set(k, flat);
      }
    }
  });
}

TriangleSearch::FlatBox TriangleSearch::flat_box(std::span<const Corners> triangles) {
  FlatBox flat;
  flat.origin = triangles[0][0];
  Vec3d normal;
  for (const auto& [a, b, c] : triangles) normal += cross(b - a, c - a);
  const Vec3d across = cross(normal, triangles[0][1] - triangles[0][0]);
  if (length(normal) > 0 && length(across) > 0) {
    flat.axes.columns[0] = normal / length(normal);
    flat.axes.columns[1] = across / length(across);
    flat.axes.columns[2] = cross(flat.axes.columns[0], flat.axes.columns[1]);
  }
  for (const Corners& corners : triangles) {
    for (const Vec3d& v : corners) flat.box.extend(flat.axes.transposed_times(v - flat.origin));
  }
  return flat;
}

void TriangleSearch::TwoFlatBoxes::set(std::size_t k, const FlatBox& flat) {
  boxes.set(k, flat.box);
  for (std::size_t c = 0; c < 3; ++c) {
    origin[c][k] = flat.origin[c];
    for (std::size_t axis = 0; axis < 3; ++axis) axes[axis][c][k] = flat.axes.columns[axis][c];
  }
}

Two TriangleSearch::squared_bounds(const Vec3d& p, std::uint32_t first_child) const {
  const TwoFlatBoxes& both = flat_boxes_[BoxHierarchy::pair_of(first_child)];
  std::array<Two, 3> local{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < 2; ++k) {
      const Vec3d q{p.x - both.origin[0][k], p.y - both.origin[1][k], p.z - both.origin[2][k]};
      local[axis][k] = both.axes[axis][0][k] * q.x + both.axes[axis][1][k] * q.y + both.axes[axis][2][k] * q.z;
    }
  }
  return squared_distances(local, both.boxes);
}

TriangleSearch::Nearest TriangleSearch::nearest(const Vec3d& p, std::uint32_t group) const {
  return nearest_within(p, HUGE_VAL, group);
}

template <class Visit>
void TriangleSearch::search(const Vec3d& p, double best, std::uint32_t group, const Visit& visit) const {
  tree_.search(
      best, [&](std::uint32_t first_child) { return squared_bounds(p, first_child); },
      [&](std::uint32_t place) {
        if (group != no_group && groups_[place] != group) return best;
        const Vec3d closest = verifier::closest_point(p, corners_[place]);
        return best = visit(place, closest, squared_length(p - closest));
      });
}

TriangleSearch::Nearest TriangleSearch::nearest_within(const Vec3d& p, double within, std::uint32_t group) const {
  double best = within * within * as_close;
  const double unknown = best;
  std::uint32_t triangle = 0;
  ClosePoints close;
  search(p, best, group, [&](std::uint32_t place, const Vec3d& closest, double squared) {
    if (squared <= best * as_close) close.add(closest, squared, triangles_[place], std::min(best, squared));
    if (squared < best) {
      best = squared;
      triangle = triangles_[place];
    }
    return best * as_close;
  });
  if (best == unknown && within < HUGE_VAL) return nearest(p, group);  // nothing is within that distance
  Nearest found{std::sqrt(best), triangle, std::nullopt};
  close.count(best, found);
  return found;
}

void TriangleSearch::find_within(const Vec3d& p, double distance, std::uint32_t group,
                                 std::vector<std::uint32_t>& found) const {
  const double most = distance * distance;
  found.clear();
  search(p, most, group, [&](std::uint32_t place, const Vec3d& /*closest*/, double squared) {
    if (squared <= most) found.push_back(triangles_[place]);
    return most;
  });
}

Vec3d TriangleSearch::closest_point_within(const Vec3d& p, double within, std::uint32_t group) const {
  double best = within * within * as_close;
  const double unknown = best;
  Vec3d point = corners_.empty() ? Vec3d{} : verifier::closest_point(p, corners_.front());
  search(p, best, group, [&](std::uint32_t /*place*/, const Vec3d& closest, double squared) {
    if (squared < best) {
      best = squared;
      point = closest;
    }
    return best * as_close;  // among equally close points, finds the same one as nearest_within()
  });
  return best == unknown && within < HUGE_VAL ? closest_point_within(p, HUGE_VAL, group) : point;
}

double TriangleSearch::distance_above(const Vec3d& p, double enough, std::uint32_t group) const {
  constexpr double rounding = 1e-12;
  const double enough_squared = enough > 0 ? enough * enough * (1 - rounding) : -1;
  double best = HUGE_VAL;
  search(p, best, group, [&](std::uint32_t /*place*/, const Vec3d& /*closest*/, double squared) {
    best = std::min(best, squared);
    return best < enough_squared ? -HUGE_VAL : best;  // ends the search
  });
  return std::sqrt(best);
}

bool TriangleSearch::crossings(const ProbeLine& line, std::vector<Crossing>& found, double reach) const {
  found.clear();
  bool is_certain = true;
  const double slack = 1e-9 * (bounds_.diagonal() + length(line.point - bounds_.center()));
  const double begin = reach < HUGE_VAL ? -slack : -HUGE_VAL;
  tree_.visit_where([&](const Box3& box) { return may_meet(line, box, begin, reach, slack); },
                    [&](std::uint32_t place) {
                      double at = 0;
                      const Meeting meeting = meet(line, corners_[place], at);
                      if (meeting == Meeting::crossing) found.push_back({at, triangles_[place]});
                      if (meeting == Meeting::doubtful) is_certain = false;
                      return is_certain;
                    });
  return is_certain;
}

bool TriangleSearch::exact_crossings(const Vec3d& from, const Vec3d& to, std::uint32_t group,
                                     std::vector<Crossing>& found) const {
  found.clear();
  bool is_certain = true;
  const ProbeLine line = line_between(from, to);
  const double reach = length(to - from);
  const double slack = 1e-9 * (bounds_.diagonal() + length(from - bounds_.center()));
  tree_.visit_where([&](const Box3& box) { return may_meet(line, box, -slack, reach, slack); },
                    [&](std::uint32_t place) {
                      if (groups_[place] != group) return true;
                      const auto& [a, b, c] = corners_[place];
                      const std::optional<int> times = exact_crossing(a, b, c, from, to);
                      if (!times) is_certain = false;
                      if (times.value_or(0) != 0) {
                        const Vec3d normal = cross(b - a, c - a);
                        const double above = std::abs(dot(from - a, normal));
                        const double below = std::abs(dot(to - a, normal));
                        found.push_back({above + below > 0 ? reach * above / (above + below) : 0.0, triangles_[place]});
                      }
                      return is_certain;
                    });
  return is_certain;
}

bool TriangleSearch::is_unpierced(const std::array<Vec3d, 3>& triangle, std::uint32_t group) const {
  const Vec3d normal = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  const double size = length(normal);
  if (!(size > 0)) return false;
  const PiercedTriangle target(triangle, normal / size, 1e-12 * (bounds_.diagonal() + length(bounds_.center())));
  bool is_unpierced = true;
  tree_.visit_where([&](const Box3& box) { return target.may_meet(box); },
                    [&](std::uint32_t place) {
                      if (groups_[place] != group) return true;
                      const Corners& corners = corners_[place];
                      for (std::size_t k = 0; k < 3 && is_unpierced; ++k) {
                        is_unpierced = !target.may_be_pierced(corners[k], corners[(k + 1) % 3]);
                      }
                      return is_unpierced;
                    });
  return is_unpierced;
}

}  // namespace blum::verifier
