#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "blum/geometry/orient2d.hpp"
#include "geometry/box_scale.hpp"
#include "geometry/topology/shells.hpp"

namespace blum::detail {
namespace {

/// Number of points tested for a shell that touches others. The aim is a point that lies on no other shell.
constexpr std::size_t most_probes_per_shell = 8192;
/// If all tested points of a shell lie on other shells, this many points slightly inside the shell are tested.
/// `inner_depth` is their depth relative to the size of a triangle.
constexpr std::size_t most_inner_points = 64;
constexpr double inner_depth = 1e-7;
/// A round of tests ends after this many comparisons of a triangle with a point, plus 16 for each triangle and each
/// point. Many coincident shells would need a quadratic number of comparisons, without a better answer.
constexpr std::size_t most_meetings = std::size_t{1} << 22;

/// Bound on the error of a triangle's computed middle, along each axis, for coordinates below 2.
constexpr double middle_rounding = 2e-15;

Vec3d middle_of(const std::array<Vec3d, 3>& corners) {
  return corners[0] + ((corners[1] - corners[0]) + (corners[2] - corners[0])) * (1.0 / 3);
}

/// Point of a shell from which a ray is cast to find the shells around it.
struct Query {
  Vec3d point;  ///< in the coordinates of Frame: the ray is parallel to z
  std::uint32_t shell = 0;
  double rounding = 0;  ///< bound on the distance, along each axis, of the point from the exact point of the shell
};

constexpr std::uint32_t no_shell = no_component;
constexpr std::uint32_t several_shells = no_component - 1;

/// Adds a shell to a set. The set only distinguishes three states: no shell, one known shell, or several shells.
void include_shell(std::uint32_t shell, std::uint32_t& set) {
  set = set == no_shell || set == shell ? shell : several_shells;
}
bool has_other_shell(std::uint32_t set, std::uint32_t than) {
  return set != no_shell && set != than;
}

/// Queries at one position. Coincident shells have queries at the same positions; each position is evaluated once.
struct QueryPoint {
  Vec3d point;
  std::uint32_t number = 0;
  std::uint32_t shells = no_shell;  ///< set of the shells with queries here
  double rounding = 0;              ///< largest `rounding` of these queries
};

/// Crossing of the ray of a query point with a triangle of a shell.
struct Crossing {
  std::uint32_t place = 0;
  std::uint32_t outer = 0;
  std::int32_t direction = 0;  ///< 1 if the ray leaves through the triangle, -1 if it enters
};

/// Coordinates in which the axis of shortest extent is the last one, because rays along it meet the fewest shells.
/// Handedness is preserved. Coordinates are scaled by a power of two so that the largest one is 1 to 2, and products
/// neither overflow nor underflow.
struct Frame {
  std::size_t first = 0;
  double scale = 1;
  explicit Frame(const Box3& bounds) {
    const Vec3d extent = bounds.size();
    std::size_t shortest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
      if (extent[axis] < extent[shortest]) shortest = axis;
    }
    first = (shortest + 1) % 3;
    scale = coordinate_scale(bounds);
  }
  [[nodiscard]] Vec3d operator()(const Vec3d& p) const {
    return Vec3d{p[first], p[(first + 1) % 3], p[(first + 2) % 3]} * scale;
  }
  [[nodiscard]] Box3 operator()(const Box3& b) const { return {(*this)(b.lower), (*this)(b.upper)}; }
};

/// Query points, sorted into bins by x and y, and by z within a bin.
class QueryPointGrid {
 public:
  /// @param place_of  receives the index of each query's point.
  QueryPointGrid(const std::vector<Query>& queries, const Box3& bounds, std::vector<std::uint32_t>& place_of)
      : bounds_(bounds) {
    gather(queries, place_of);
    const double wanted = std::ceil(std::sqrt(static_cast<double>(places_.size())));
    side_ = static_cast<std::int64_t>(std::clamp(wanted, 1.0, 1024.0));
    const auto key = [&](const QueryPoint& p) { return std::tuple(bin(p.point), p.point.z, p.number); };
    std::sort(places_.begin(), places_.end(),
              [&](const QueryPoint& a, const QueryPoint& b) { return key(a) < key(b); });
    start_.assign(static_cast<std::size_t>(side_ * side_) + 1, 0);
    for (const QueryPoint& place : places_) ++start_[static_cast<std::size_t>(bin(place.point)) + 1];
    for (std::size_t b = 0; b + 1 < start_.size(); ++b) start_[b + 1] += start_[b];
  }
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] double most_rounding() const { return most_rounding_; }

  /// Calls visit(point) for the points in bins that overlap the x and y range of `columns`, and with z in the range of
  /// `heights`. Stops when a call returns true, and then returns true.
  template <class Visit>
  bool visit_in(const Box3& columns, const Box3& heights, Visit visit) const {
    const std::int64_t x1 = cell(columns.upper.x, 0);
    const std::int64_t y1 = cell(columns.upper.y, 1);
    for (std::int64_t y = cell(columns.lower.y, 1); y <= y1; ++y) {
      for (std::int64_t x = cell(columns.lower.x, 0); x <= x1; ++x) {
        const auto b = static_cast<std::size_t>(y * side_ + x);
        const QueryPoint* end = places_.data() + start_[b + 1];
        const QueryPoint* place = places_.data() + start_[b];
        place =
            std::lower_bound(place, end, heights.lower.z, [](const QueryPoint& q, double z) { return q.point.z < z; });
        for (; place != end && place->point.z <= heights.upper.z; ++place) {
          if (visit(*place)) return true;
        }
      }
    }
    return false;
  }

 private:
  [[nodiscard]] std::int64_t cell(double value, std::size_t axis) const {
    const double extent = bounds_.upper[axis] - bounds_.lower[axis];
    if (!(extent > 0)) return 0;
    const double at = std::floor((value - bounds_.lower[axis]) / extent * static_cast<double>(side_));
    return static_cast<std::int64_t>(std::clamp(at, 0.0, static_cast<double>(side_ - 1)));
  }
  [[nodiscard]] std::int64_t bin(const Vec3d& p) const { return cell(p.y, 1) * side_ + cell(p.x, 0); }

  void gather(const std::vector<Query>& queries, std::vector<std::uint32_t>& place_of) {
    std::vector<std::uint32_t> order(queries.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](std::uint32_t q) {
      const Vec3d& p = queries[q].point;
      return std::tuple(p.x, p.y, p.z);
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    place_of.resize(queries.size());
    for (const std::uint32_t q : order) {
      const Query& query = queries[q];
      if (places_.empty() || places_.back().point != query.point) {
        places_.push_back({query.point, static_cast<std::uint32_t>(places_.size()), no_shell, 0});
      }
      include_shell(query.shell, places_.back().shells);
      places_.back().rounding = std::max(places_.back().rounding, query.rounding);
      most_rounding_ = std::max(most_rounding_, query.rounding);
      place_of[q] = places_.back().number;
    }
  }

  std::vector<QueryPoint> places_;
  Box3 bounds_;
  double most_rounding_ = 0;
  std::int64_t side_ = 1;
  std::vector<std::uint32_t> start_;
};

/// Returns the winding number of a triangle around a point, both projected along z. The point counts as moved
/// infinitesimally along +x, and by infinitely less along +y. So no point lies on an edge, and neighbouring triangles
/// agree about every edge.
int projected_winding(const std::array<Vec3d, 3>& corners, const Vec3d& p) {
  int winding = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& a = corners[k];
    const Vec3d& b = corners[k == 2 ? 0 : k + 1];
    const bool rises = a.y <= p.y;
    if (rises == (b.y <= p.y)) continue;
    const Vec3d& lower = rises ? a : b;
    const Vec3d& upper = rises ? b : a;
    if (orient2d({lower.x, lower.y}, {upper.x, upper.y}, {p.x, p.y}) > 0) winding += rises ? 1 : -1;
  }
  return winding;
}

/// Returns true if a vertical line through a point certainly misses a triangle, even if the point is moved within its
/// rounding. Seen from above, the point lies beyond an edge. A triangle parallel to z projects to a segment;
/// then the point lies beside the line through the segment.
bool passes_beside(const std::array<Vec3d, 3>& corners, const Vec3d& p, double rounding) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& a = corners[k];
    const Vec3d edge = corners[(k + 1) % 3] - a;
    const Vec3d other = corners[(k + 2) % 3] - a;
    const Vec3d offset = p - a;
    const double inner = edge.x * other.y - edge.y * other.x;
    const double left = edge.x * offset.y;
    const double right = edge.y * offset.x;
    const double unknown =
        4e-16 * (std::abs(left) + std::abs(right) + std::abs(edge.x * other.y) + std::abs(edge.y * other.x)) +
        rounding * (std::abs(edge.x) + std::abs(edge.y));
    if ((inner >= 0 && left - right < -unknown) || (inner <= 0 && left - right > unknown)) return true;
  }
  return false;
}

struct Height {
  bool is_above = false;
  bool is_certain = true;
};

/// Finds out if a triangle is above a point, and if the result is certain for all points within the rounding. The
/// triangle's projection must have winding number 1 (counter-clockwise) or -1 around the point.
Height compare_height(const std::array<Vec3d, 3>& corners, const Vec3d& p, double rounding, int winding) {
  const Vec3d a = corners[0] - p;
  const Vec3d b = corners[1] - p;
  const Vec3d c = corners[2] - p;
  const auto magnitude = [](const Vec3d& v) { return Vec3d{std::abs(v.x), std::abs(v.y), std::abs(v.z)}; };
  const Vec3d ma = magnitude(a);
  const Vec3d mb = magnitude(b);
  const Vec3d mc = magnitude(c);
  const double determinant = dot(a, cross(b, c));
  const double permanent =
      ma.x * (mb.y * mc.z + mb.z * mc.y) + ma.y * (mb.z * mc.x + mb.x * mc.z) + ma.z * (mb.x * mc.y + mb.y * mc.x);
  // The gradient of the determinant is the triangle's normal, whose length is twice the area.
  const Vec3d slope = magnitude(cross(corners[1] - corners[0], corners[2] - corners[0]));
  const double unknown = 1e-15 * permanent + rounding * (slope.x + slope.y + slope.z);
  return {determinant * winding > 0, std::abs(determinant) > unknown};
}

class Nesting {
 public:
  Nesting(const MeshView& mesh, ShellSet& set, const Context& context)
      : mesh_(mesh), set_(set), context_(context), bounds_(total_bounds(set)), frame_(bounds_) {
    bounds_ = frame_(bounds_);
  }

  /// Finds the depth and parent of every shell.
  /// @return  number of comparisons of a triangle with a point.
  std::size_t run() {
    choices_.resize(set_.shells.size());
    const std::size_t without_end = std::numeric_limits<std::size_t>::max();
    rounds_[0] = ask(first_vertices(), without_end);
    choose_certain(0);
    if (const std::vector<std::uint32_t> doubtful = without_choice(); !doubtful.empty()) {
      rounds_[1] = ask(many_points(doubtful));
      const std::size_t last = rounds_[1].is_complete ? 1 : 0;
      if (last == 1) choose_certain(1);
      if (const std::vector<std::uint32_t> rest = without_choice(); !rest.empty()) {
        rounds_[2] = ask(inner_points(rest));
        if (rounds_[2].is_complete) choose_common(2);
        choose_first(last);
      }
    }
    set_depths();
    set_parents();
    return meetings_;
  }

 private:
  static Box3 total_bounds(const ShellSet& set) {
    Box3 box;
    for (const Shell& shell : set.shells) box.extend(shell.bounds);
    return box;
  }

  /// Returns one vertex of each shell.
  [[nodiscard]] std::vector<Query> first_vertices() const {
    std::vector<Query> queries;
    std::vector<bool> is_seen(set_.shells.size(), false);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const std::uint32_t shell = set_.of_triangle[t];
      if (shell == no_component || is_seen[shell]) continue;
      is_seen[shell] = true;
      queries.push_back({frame_(mesh_.vertices[mesh_.triangles[t][0]]), shell});
    }
    return queries;
  }

  /// Calls visit(shell, corners in the frame) for about `most` evenly spread triangles of each of the given shells.
  template <class Visit>
  void for_each_of_many(const std::vector<std::uint32_t>& shells, std::size_t most, Visit visit) const {
    std::vector<std::size_t> step(set_.shells.size(), 0);
    for (const std::uint32_t s : shells) step[s] = set_.shells[s].triangles / most + 1;
    std::vector<std::size_t> seen(set_.shells.size(), 0);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const std::uint32_t shell = set_.of_triangle[t];
      if (shell == no_component || step[shell] == 0 || seen[shell]++ % step[shell] != 0) continue;
      visit(shell, corners_of(t));
    }
  }

  [[nodiscard]] std::array<Vec3d, 3> corners_of(std::size_t triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return {frame_(mesh_.vertices[a]), frame_(mesh_.vertices[b]), frame_(mesh_.vertices[c])};
  }

  /// Returns two points for many triangles of the given shells: a corner and the middle.
  [[nodiscard]] std::vector<Query> many_points(const std::vector<std::uint32_t>& shells) const {
    std::vector<Query> queries;
    for_each_of_many(shells, most_probes_per_shell / 2, [&](std::uint32_t shell, const std::array<Vec3d, 3>& corners) {
      queries.push_back({corners[0], shell});
      queries.push_back({middle_of(corners), shell, middle_rounding});
    });
    return queries;
  }

  /// Returns points slightly inside the given shells, below the middles of some triangles. These points are for shells
  /// whose tested points all lie on other shells. The depth of the points is large compared with rounding, and small
  /// compared with features.
  [[nodiscard]] std::vector<Query> inner_points(const std::vector<std::uint32_t>& shells) const {
    std::vector<Query> queries;
    for_each_of_many(shells, most_inner_points, [&](std::uint32_t shell, const std::array<Vec3d, 3>& corners) {
      const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
      const double size = length(normal);
      if (!(size > 0)) return;
      const double inwards = set_.shells[shell].signed_volume > 0 ? -1 : 1;
      queries.push_back({middle_of(corners) + normal * (inwards * inner_depth / std::sqrt(size)), shell});
    });
    return queries;
  }

  /// Results of one round of queries. A place is the index of a query point.
  struct Answers {
    std::vector<std::uint32_t> shell;       ///< shell of each query
    std::vector<std::uint32_t> place;       ///< place of each query
    std::vector<std::uint32_t> touched_by;  ///< per place: set of shells on which it may lie
    /// Nonzero winding numbers of shells around places, sorted by place and outer shell.
    std::vector<Crossing> containers;
    std::vector<std::size_t> start;  ///< per place: index of its first container; the last entry is the total
    bool is_complete = true;

    [[nodiscard]] std::span<const Crossing> around(std::uint32_t place) const {
      return {containers.data() + start[place], containers.data() + start[place + 1]};
    }
    [[nodiscard]] bool is_doubtful(std::size_t query) const {
      return has_other_shell(touched_by[place[query]], shell[query]);
    }
  };

  /// Finds the shells around the queries' points. Stops early after too many comparisons.
  Answers ask(const std::vector<Query>& queries) {
    return ask(queries, meetings_ + most_meetings + 16 * (queries.size() + mesh_.triangles.size()));
  }
  /// @param most  limit on the number of comparisons, including those of earlier rounds.
  Answers ask(const std::vector<Query>& queries, std::size_t most) {
    Answers out;
    for (const Query& query : queries) out.shell.push_back(query.shell);
    const QueryPointGrid grid(queries, bounds_, out.place);
    out.touched_by.assign(grid.size(), no_shell);
    const std::vector<bool> may_contain = find_candidates(grid);
    for (std::size_t t = 0; t < mesh_.triangles.size() && out.is_complete; ++t) {
      if (t % 4096 == 0) throw_if_cancelled(context_);
      const std::uint32_t outer = set_.of_triangle[t];
      if (outer == no_component || !may_contain[outer]) continue;
      out.is_complete = meet(t, grid, most, out);
    }
    sum_up(grid.size(), out);
    return out;
  }

  /// Compares a triangle with the places below it and close to it.
  /// @return  false if there were too many comparisons.
  bool meet(std::size_t triangle, const QueryPointGrid& grid, std::size_t most, Answers& out) {
    const std::uint32_t outer = set_.of_triangle[triangle];
    const Box3 shell = frame_(set_.shells[outer].bounds);
    const std::array<Vec3d, 3> corners = corners_of(triangle);
    Box3 box;
    for (const Vec3d& corner : corners) box.extend(corner);
    Box3 heights = grown(shell, grid.most_rounding());
    heights.upper.z = box.upper.z + grid.most_rounding();
    return !grid.visit_in(grown(box, grid.most_rounding()), heights, [&](const QueryPoint& place) {
      if (++meetings_ > most) return true;
      if (!has_other_shell(place.shells, outer) || !is_within(grown(shell, place.rounding), place.point)) {
        return false;
      }
      const int winding = projected_winding(corners, place.point);
      const Box3 near = grown(box, place.rounding);
      const bool is_beside = is_within(near, place.point) && place.point.z >= near.lower.z;
      if (winding == 0 && (!is_beside || passes_beside(corners, place.point, place.rounding))) return false;
      const Height height = compare_height(corners, place.point, place.rounding, winding);
      // A place on a triangle parallel to z has no winding number in the projection, but it must count as on the
      // triangle.
      if (!height.is_certain) include_shell(outer, out.touched_by[place.number]);
      if (winding != 0 && height.is_above) out.containers.push_back({place.number, outer, winding});
      return false;
    });
  }

  /// Adds up the crossings of each place with each shell to winding numbers.
  static void sum_up(std::size_t places, Answers& answers) {
    std::vector<Crossing>& all = answers.containers;
    std::sort(all.begin(), all.end(), [](const Crossing& a, const Crossing& b) {
      return a.place != b.place ? a.place < b.place : a.outer < b.outer;
    });
    std::vector<Crossing> sums;
    for (const Crossing& crossing : all) {
      if (!sums.empty() && sums.back().place == crossing.place && sums.back().outer == crossing.outer) {
        sums.back().direction += crossing.direction;
      } else {
        sums.push_back(crossing);
      }
    }
    std::erase_if(sums, [](const Crossing& sum) { return sum.direction == 0; });
    all = std::move(sums);
    answers.start.assign(places + 1, 0);
    for (const Crossing& sum : all) ++answers.start[sum.place + 1];
    for (std::size_t p = 0; p < places; ++p) answers.start[p + 1] += answers.start[p];
  }

  /// Place whose containers are the shells around a given shell.
  struct Choice {
    std::optional<std::size_t> round;
    std::uint32_t place = 0;
    friend auto operator<=>(const Choice&, const Choice&) = default;
  };

  [[nodiscard]] std::span<const Crossing> around(const Choice& choice) const {
    return rounds_[*choice.round].around(choice.place);
  }

  /// Returns the shells for which no round has chosen a place, in ascending order.
  [[nodiscard]] std::vector<std::uint32_t> without_choice() const {
    std::vector<std::uint32_t> shells;
    for (std::uint32_t s = 0; s < choices_.size(); ++s) {
      if (!choices_[s].round) shells.push_back(s);
    }
    return shells;
  }

  /// Chooses, for each undecided shell, its first point that certainly lies on no other shell.
  void choose_certain(std::size_t round) {
    const Answers& answers = rounds_[round];
    for (std::size_t query = 0; query < answers.shell.size(); ++query) {
      Choice& choice = choices_[answers.shell[query]];
      if (!choice.round && !answers.is_doubtful(query)) choice = {round, answers.place[query]};
    }
  }

  /// For each shell, finds the shells that surround all of its tested points that lie on no other shell. A container of
  /// the shell surrounds all points inside the shell. A shell inside it does not.
  void choose_common(std::size_t round) {
    Answers& answers = rounds_[round];
    std::vector<std::vector<std::uint32_t>> places(set_.shells.size());
    for (std::size_t query = 0; query < answers.shell.size(); ++query) {
      if (!answers.is_doubtful(query)) places[answers.shell[query]].push_back(answers.place[query]);
    }
    std::map<std::vector<std::uint32_t>, std::uint32_t> known;  // equal shells have the same places
    for (std::uint32_t s = 0; s < places.size(); ++s) {
      if (places[s].empty()) continue;
      std::sort(places[s].begin(), places[s].end());
      const auto [entry, is_new] = known.try_emplace(places[s], 0);
      if (is_new) entry->second = add_common(places[s], answers);
      choices_[s] = {round, entry->second};
    }
  }

  /// Adds a place whose containers are the common containers of the given places.
  /// @return  index of the new place.
  static std::uint32_t add_common(const std::vector<std::uint32_t>& places, Answers& answers) {
    const std::span<const Crossing> first = answers.around(places.front());
    std::vector<Crossing> common(first.begin(), first.end());
    for (const std::uint32_t place : places) {
      const std::span<const Crossing> here = answers.around(place);
      std::erase_if(common, [&](const Crossing& c) {
        return !std::binary_search(here.begin(), here.end(), c,
                                   [](const Crossing& a, const Crossing& b) { return a.outer < b.outer; });
      });
    }
    answers.containers.insert(answers.containers.end(), common.begin(), common.end());
    answers.start.push_back(answers.containers.size());
    return static_cast<std::uint32_t>(answers.start.size() - 2);
  }

  /// Chooses the first point of each undecided shell, although it may lie on another shell.
  void choose_first(std::size_t round) {
    const Answers& answers = rounds_[round];
    for (std::size_t query = 0; query < answers.shell.size(); ++query) {
      Choice& choice = choices_[answers.shell[query]];
      if (!choice.round) choice = {round, answers.place[query]};
    }
  }

  static bool is_within(const Box3& box, const Vec3d& p) {
    return box.lower.x <= p.x && p.x <= box.upper.x && box.lower.y <= p.y && p.y <= box.upper.y;
  }

  /// Returns a flag for each shell: true if its bounding box contains a query of another shell.
  [[nodiscard]] std::vector<bool> find_candidates(const QueryPointGrid& grid) const {
    std::vector<bool> result(set_.shells.size(), false);
    for (std::uint32_t s = 0; s < result.size(); ++s) {
      const Box3 box = grown(frame_(set_.shells[s].bounds), grid.most_rounding());
      result[s] = grid.visit_in(box, box, [&](const QueryPoint& place) {
        return has_other_shell(place.shells, s) && is_within(box, place.point);
      });
    }
    return result;
  }

  /// Sets the depth of each shell: the number of other shells that contain it.
  void set_depths() {
    for (std::uint32_t s = 0; s < choices_.size(); ++s) {
      if (!choices_[s].round) continue;
      const std::span<const Crossing> outers = around(choices_[s]);
      const auto own = std::lower_bound(outers.begin(), outers.end(), s,
                                        [](const Crossing& c, std::uint32_t shell) { return c.outer < shell; });
      const bool is_in_itself = own != outers.end() && own->outer == s;
      set_.shells[s].depth = static_cast<std::uint32_t>(outers.size()) - (is_in_itself ? 1 : 0);
    }
  }

  /// Sets the parent of each shell: the deepest shell around it. If several shells are equally deep, the parent is the
  /// shell with the smallest index.
  void set_parents() {
    std::vector<std::uint32_t> order;
    for (std::uint32_t s = 0; s < choices_.size(); ++s) {
      if (choices_[s].round) order.push_back(s);
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return choices_[a] < choices_[b]; });
    std::array<std::int64_t, 2> deepest{-1, -1};  // around the place chosen for the previous shell
    for (std::size_t k = 0; k < order.size(); ++k) {
      const std::uint32_t s = order[k];
      if (k == 0 || choices_[order[k - 1]] != choices_[s]) deepest = two_deepest(around(choices_[s]));
      set_.shells[s].parent = deepest[0] == s ? deepest[1] : deepest[0];
    }
  }

  /// Returns the two deepest of the given shells; -1 for missing ones.
  [[nodiscard]] std::array<std::int64_t, 2> two_deepest(std::span<const Crossing> outers) const {
    std::array<std::int64_t, 2> best{-1, -1};
    const auto depth = [&](std::int64_t s) { return set_.shells[static_cast<std::size_t>(s)].depth; };
    for (const Crossing& c : outers) {
      if (best[0] < 0 || depth(c.outer) > depth(best[0])) {
        best = {c.outer, best[0]};
      } else if (best[1] < 0 || depth(c.outer) > depth(best[1])) {
        best[1] = c.outer;
      }
    }
    return best;
  }

  const MeshView& mesh_;
  ShellSet& set_;
  const Context& context_;
  Box3 bounds_;
  Frame frame_;
  std::array<Answers, 3> rounds_;
  std::vector<Choice> choices_;  ///< one per shell
  std::size_t meetings_ = 0;
};

}  // namespace

std::size_t nest_shells(const MeshView& mesh, ShellSet& set, const Context& context) {
  if (set.shells.size() < 2) return 0;
  return Nesting(mesh, set, context).run();
}

}  // namespace blum::detail
