#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "blum/geometry/orient2d.hpp"
#include "geometry/shells.hpp"

namespace blum::detail {
namespace {

/// A shell that touches others is looked at from many of its points, of which one lies on none of them.
constexpr std::size_t most_probes_per_shell = 8192;
/// Looking from many points ends when triangles and points have met this often, and 16 times for each of them besides:
/// heaps of shells that lie upon each other would take the square of their number, and say no more in the end.
constexpr std::size_t most_meetings = std::size_t{1} << 22;

/// A point of a shell that we look outwards from.
struct Query {
  Vec3d point;  ///< permuted: the ray goes along z
  std::uint32_t shell = 0;
  std::uint32_t probe = 0;  ///< counts all queries of a round
};

/// A triangle of one shell above a query of another one.
struct Crossing {
  std::uint32_t probe = 0;
  std::uint32_t inner = 0;
  std::uint32_t outer = 0;
  std::int32_t direction = 0;  ///< 1 where the ray leaves through the triangle, -1 where it enters
};

/// Puts the axis of shortest extent last, keeping the handedness: rays along it meet the fewest shells.
struct Frame {
  std::size_t first = 0;
  explicit Frame(const Vec3d& extent) {
    std::size_t shortest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
      if (extent[axis] < extent[shortest]) shortest = axis;
    }
    first = (shortest + 1) % 3;
  }
  [[nodiscard]] Vec3d operator()(const Vec3d& p) const { return {p[first], p[(first + 1) % 3], p[(first + 2) % 3]}; }
  [[nodiscard]] Box3 operator()(const Box3& b) const { return {(*this)(b.lower), (*this)(b.upper)}; }
};

/// Queries binned by x and y; within a bin sorted by z.
class QueryGrid {
 public:
  QueryGrid(std::vector<Query> queries, const Box3& bounds) : queries_(std::move(queries)), bounds_(bounds) {
    const double wanted = std::ceil(std::sqrt(static_cast<double>(queries_.size())));
    side_ = static_cast<std::int64_t>(std::clamp(wanted, 1.0, 1024.0));
    std::sort(queries_.begin(), queries_.end(), [&](const Query& a, const Query& b) {
      const std::int64_t bin_a = bin(a.point);
      const std::int64_t bin_b = bin(b.point);
      if (bin_a != bin_b) return bin_a < bin_b;
      return a.point.z != b.point.z ? a.point.z < b.point.z : a.probe < b.probe;
    });
    start_.assign(static_cast<std::size_t>(side_ * side_) + 1, 0);
    for (const Query& q : queries_) ++start_[static_cast<std::size_t>(bin(q.point)) + 1];
    for (std::size_t b = 0; b + 1 < start_.size(); ++b) start_[b + 1] += start_[b];
  }

  /// Calls visit(query) for those in bins that the x and y range of the first box touches, with z in the range of the
  /// second; stops when it returns true.
  template <class Visit>
  bool visit_in(const Box3& columns, const Box3& heights, Visit visit) const {
    const std::int64_t x1 = cell(columns.upper.x, 0);
    const std::int64_t y1 = cell(columns.upper.y, 1);
    for (std::int64_t y = cell(columns.lower.y, 1); y <= y1; ++y) {
      for (std::int64_t x = cell(columns.lower.x, 0); x <= x1; ++x) {
        const auto b = static_cast<std::size_t>(y * side_ + x);
        const Query* end = queries_.data() + start_[b + 1];
        const Query* query = queries_.data() + start_[b];
        query = std::lower_bound(query, end, heights.lower.z, [](const Query& q, double z) { return q.point.z < z; });
        for (; query != end && query->point.z <= heights.upper.z; ++query) {
          if (visit(*query)) return true;
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

  std::vector<Query> queries_;
  Box3 bounds_;
  std::int64_t side_ = 1;
  std::vector<std::uint32_t> start_;
};

/// Winding number of a triangle's projection around a point's. The point counts as moved by infinitely little along +x
/// and by infinitely less along +y: no point is on an edge then, and neighbouring triangles agree about every edge.
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

struct Height {
  bool is_above = false;
  bool is_certain = true;
};

/// Whether a triangle that turns counter-clockwise (winding 1) or clockwise (-1) from above lies above a point.
Height compare_height(const std::array<Vec3d, 3>& corners, const Vec3d& p, int winding) {
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
  return {determinant * winding > 0, std::abs(determinant) > 1e-15 * permanent};
}

class Nesting {
 public:
  Nesting(const MeshView& mesh, ShellSet& set, const Context& context)
      : mesh_(mesh), set_(set), context_(context), bounds_(total_bounds(set)), frame_(bounds_.size()) {
    bounds_ = frame_(bounds_);
  }

  /// @return  how often a triangle met a point.
  std::size_t run() {
    const std::size_t without_end = std::numeric_limits<std::size_t>::max();
    const Answers first = ask(first_vertices(), without_end);
    const std::vector<std::uint32_t> doubtful = keep_certain(first);
    if (!doubtful.empty()) {
      std::vector<Query> queries = many_points(doubtful);
      const std::size_t most = most_meetings + 16 * (queries.size() + mesh_.triangles.size());
      const Answers more = ask(std::move(queries), most);
      keep_first(more.is_complete ? more : first, more.is_complete ? keep_certain(more) : doubtful);
    }
    set_depths();
    return meetings_;
  }

 private:
  static constexpr std::uint32_t no_probe = 0xffffffffU;

  static Box3 total_bounds(const ShellSet& set) {
    Box3 box;
    for (const Shell& shell : set.shells) box.extend(shell.bounds);
    return box;
  }

  /// One vertex of each shell.
  [[nodiscard]] std::vector<Query> first_vertices() const {
    std::vector<Query> queries;
    std::vector<bool> is_seen(set_.shells.size(), false);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const std::uint32_t shell = set_.of_triangle[t];
      if (shell == no_component || is_seen[shell]) continue;
      is_seen[shell] = true;
      add_query(mesh_.vertices[mesh_.triangles[t][0]], shell, queries);
    }
    return queries;
  }

  /// A corner and the middle of many triangles of these shells, spread evenly.
  [[nodiscard]] std::vector<Query> many_points(const std::vector<std::uint32_t>& shells) const {
    std::vector<std::size_t> step(set_.shells.size(), 0);
    for (const std::uint32_t s : shells) step[s] = set_.shells[s].triangles / (most_probes_per_shell / 2) + 1;
    std::vector<std::size_t> seen(set_.shells.size(), 0);
    std::vector<Query> queries;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const std::uint32_t shell = set_.of_triangle[t];
      if (shell == no_component || step[shell] == 0 || seen[shell]++ % step[shell] != 0) continue;
      const Triangle& corner = mesh_.triangles[t];
      const Vec3d a = mesh_.vertices[corner[0]];
      add_query(a, shell, queries);
      add_query(a + ((mesh_.vertices[corner[1]] - a) + (mesh_.vertices[corner[2]] - a)) * (1.0 / 3), shell, queries);
    }
    return queries;
  }

  void add_query(const Vec3d& point, std::uint32_t shell, std::vector<Query>& queries) const {
    queries.push_back({frame_(point), shell, static_cast<std::uint32_t>(queries.size())});
  }

  /// What was found above the points of a round.
  struct Answers {
    std::vector<std::uint32_t> shell;  ///< of each point
    std::vector<bool> is_doubtful;     ///< each point: it may lie on another shell
    std::vector<Crossing> found;
    bool is_complete = true;
  };

  /// Finds the crossings above points of shells; gives up after so many meetings.
  Answers ask(std::vector<Query> queries, std::size_t most) {
    Answers out;
    for (const Query& query : queries) out.shell.push_back(query.shell);
    out.is_doubtful.assign(queries.size(), false);
    const QueryGrid grid(std::move(queries), bounds_);
    const std::vector<bool> may_contain = find_candidates(grid);
    const std::size_t before = meetings_;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (t % 4096 == 0) throw_if_cancelled(context_);
      const std::uint32_t outer = set_.of_triangle[t];
      if (outer == no_component || !may_contain[outer]) continue;
      std::array<Vec3d, 3> corners;
      Box3 box;
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = frame_(mesh_.vertices[mesh_.triangles[t][k]]);
        box.extend(corners[k]);
      }
      Box3 heights = frame_(set_.shells[outer].bounds);
      heights.upper.z = box.upper.z;
      out.is_complete = !grid.visit_in(box, heights, [&](const Query& query) {
        if (++meetings_ - before > most) return true;
        if (query.shell == outer || !is_within(frame_(set_.shells[outer].bounds), query.point)) return false;
        const int winding = projected_winding(corners, query.point);
        const bool is_beside = is_within(box, query.point) && query.point.z >= box.lower.z;
        if (winding == 0 && !is_beside) return false;
        const Height height = compare_height(corners, query.point, winding);
        // A point on an upright wall has no winding number in the projection, but must not count as beyond the wall.
        if (!height.is_certain) out.is_doubtful[query.probe] = true;
        if (winding != 0 && height.is_above) out.found.push_back({query.probe, query.shell, outer, winding});
        return false;
      });
      if (!out.is_complete) break;
    }
    return out;
  }

  /// Keeps the crossings of each shell's first point of which there is no doubt that it lies on no other shell.
  /// @return  the shells that have none, rising.
  std::vector<std::uint32_t> keep_certain(const Answers& answers) {
    std::vector<bool> is_asked(set_.shells.size(), false);
    std::vector<std::uint32_t> chosen(set_.shells.size(), no_probe);
    for (std::uint32_t probe = 0; probe < answers.shell.size(); ++probe) {
      const std::uint32_t shell = answers.shell[probe];
      is_asked[shell] = true;
      if (chosen[shell] == no_probe && !answers.is_doubtful[probe]) chosen[shell] = probe;
    }
    keep(answers, chosen);
    std::vector<std::uint32_t> doubtful;
    for (std::uint32_t s = 0; s < chosen.size(); ++s) {
      if (is_asked[s] && chosen[s] == no_probe) doubtful.push_back(s);
    }
    return doubtful;
  }

  /// Keeps the crossings of the first point of these shells, doubtful as it is.
  void keep_first(const Answers& answers, const std::vector<std::uint32_t>& shells) {
    std::vector<bool> is_wanted(set_.shells.size(), false);
    for (const std::uint32_t s : shells) is_wanted[s] = true;
    std::vector<std::uint32_t> chosen(set_.shells.size(), no_probe);
    for (std::uint32_t probe = 0; probe < answers.shell.size(); ++probe) {
      const std::uint32_t shell = answers.shell[probe];
      if (is_wanted[shell] && chosen[shell] == no_probe) chosen[shell] = probe;
    }
    keep(answers, chosen);
  }

  void keep(const Answers& answers, const std::vector<std::uint32_t>& chosen) {
    for (const Crossing& crossing : answers.found) {
      if (chosen[crossing.inner] == crossing.probe) crossings_.push_back(crossing);
    }
  }

  static bool is_within(const Box3& box, const Vec3d& p) {
    return box.lower.x <= p.x && p.x <= box.upper.x && box.lower.y <= p.y && p.y <= box.upper.y;
  }

  /// The shells whose box holds a query of another shell.
  [[nodiscard]] std::vector<bool> find_candidates(const QueryGrid& grid) const {
    std::vector<bool> result(set_.shells.size(), false);
    for (std::uint32_t s = 0; s < result.size(); ++s) {
      const Box3 box = frame_(set_.shells[s].bounds);
      result[s] =
          grid.visit_in(box, box, [&](const Query& query) { return query.shell != s && is_within(box, query.point); });
    }
    return result;
  }

  void set_depths() {
    std::sort(crossings_.begin(), crossings_.end(), [](const Crossing& a, const Crossing& b) {
      return a.inner != b.inner ? a.inner < b.inner : a.outer < b.outer;
    });
    std::vector<Crossing> containments;  // direction holds the winding number
    for (const Crossing& crossing : crossings_) {
      const bool is_same = !containments.empty() && containments.back().inner == crossing.inner &&
                           containments.back().outer == crossing.outer;
      if (is_same) {
        containments.back().direction += crossing.direction;
      } else {
        containments.push_back(crossing);
      }
    }
    for (const Crossing& c : containments) {
      if (c.direction != 0) ++set_.shells[c.inner].depth;
    }
    for (const Crossing& c : containments) {
      if (c.direction == 0) continue;
      std::int64_t& parent = set_.shells[c.inner].parent;
      const bool is_deeper =
          parent < 0 || set_.shells[c.outer].depth > set_.shells[static_cast<std::size_t>(parent)].depth;
      if (is_deeper) parent = c.outer;
    }
  }

  const MeshView& mesh_;
  ShellSet& set_;
  const Context& context_;
  Box3 bounds_;
  Frame frame_;
  std::vector<Crossing> crossings_;
  std::size_t meetings_ = 0;
};

}  // namespace

std::size_t nest_shells(const MeshView& mesh, ShellSet& set, const Context& context) {
  if (set.shells.size() < 2) return 0;
  return Nesting(mesh, set, context).run();
}

}  // namespace blum::detail
