#include "blum/field/closest_points.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <numeric>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/huge_pages.hpp"
#include "blum/core/inline_list.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/radix_sort.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/pseudonormals.hpp"
#include "blum/geometry/sites.hpp"
#include "field/kernels/morton.hpp"
#include "field/point_search.hpp"
#include "field/sign/policy.hpp"
#include "field/sign/shared_sides.hpp"
#include "field/sign/sides.hpp"

namespace blum {
namespace {

/// Ranges are so short that the first range, which one thread runs alone, costs little. Only winding numbers need
/// longer ranges, in which queries share work.
constexpr std::size_t queries_per_range = 32;
constexpr std::size_t checks_per_range = 32768;
constexpr std::size_t gradients_per_range = 4096;
/// Upper bound on the rounding error of a sum of two distances, relative to the lengths involved.
constexpr double rounding = 1e-12;
constexpr double no_limit = std::numeric_limits<double>::infinity();

double checked_limit(const ClosestPointOptions& options) {
  if (options.max_distance && !(*options.max_distance >= 0)) {
    throw InvalidOption("max_distance is " + std::to_string(*options.max_distance) + "; it must be at least 0");
  }
  return options.max_distance.value_or(no_limit);
}

/// If there are at most this many queries, they are answered in the given order.
constexpr std::size_t few_queries = 64;

/// Returns an order of the queries along a Morton curve, so that consecutive queries lie close together.
std::vector<std::uint32_t> order_along_curve(std::span<const Vec3d> queries) {
  std::vector<std::uint32_t> order(queries.size());
  std::iota(order.begin(), order.end(), 0U);
  if (queries.size() <= few_queries) return order;
  Box3 box;
  for (const Vec3d& query : queries) box.extend(query);
  const Vec3d size = box.size();
  const double longest = std::max({size.x, size.y, size.z});
  if (!(longest > 0)) return order;
  std::vector<detail::KeyedIndex> keyed(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    keyed[i] = {kernels::morton_code((queries[i] - box.center()) / longest), static_cast<std::uint32_t>(i)};
  }
  detail::radix_sort(keyed);
  std::transform(keyed.begin(), keyed.end(), order.begin(), [](const detail::KeyedIndex& one) { return one.index; });
  return order;
}

/// Results are prefetched this many results before they are written.
constexpr std::size_t ahead = 24;

/// Prefetches a result for writing, because results are written in a different order than they are stored.
void prefetch_to_write([[maybe_unused]] const ClosestPoint* point) {
#if defined(__GNUC__)
  __builtin_prefetch(point, 1);
  __builtin_prefetch(&point->triangle, 1);  // the end of the result may be in the next cache line
#endif
}

/// Returns the weight of b for a point p on the line through a and b. The weight is clamped to [0, 1].
double part_between(const Vec3d& a, const Vec3d& b, const Vec3d& p) {
  const double squared = squared_length(b - a);
  return squared > 0 ? std::clamp(dot(p - a, b - a) / squared, 0.0, 1.0) : 0.0;
}

/// Returns the barycentric weights of three corners for a point p. The side between the first two corners must be the
/// longest. Apart from rounding, p must lie in the triangle. The weighted mean of the corners is p, even if the
/// triangle is very narrow.
std::array<double, 3> weights_of(const std::array<Vec3d, 3>& corners, const Vec3d& p) {
  const Vec3d& a = corners[0];
  const Vec3d along = corners[1] - a;
  const double squared = squared_length(along);
  if (!(squared > 0)) return {1, 0, 0};
  double foot = dot(corners[2] - a, along) / squared;
  Vec3d height = corners[2] - a - along * foot;
  // In a narrow triangle, rounding leaves `height` with a component along the side; remove it.
  const double left = dot(height, along) / squared;
  foot += left;
  height -= along * left;
  const double squared_height = squared_length(height);
  const double third = squared_height > 0 ? std::min(dot(p - a, height) / squared_height, 1.0) : 0.0;
  const double second = dot(p - a, along) / squared - third * foot;
  // In a narrow triangle, the division by the small height magnifies rounding and can put p beyond a side. If p is
  // beyond a side, it is treated as a point on this side.
  if (!(third > 0)) {
    const double part = part_between(a, corners[1], p);
    return {1 - part, part, 0};
  }
  if (second < 0) {
    const double part = part_between(a, corners[2], p);
    return {1 - part, 0, part};
  }
  if (second + third > 1) {
    const double part = part_between(corners[1], corners[2], p);
    return {0, 1 - part, part};
  }
  return {std::max(1 - second - third, 0.0), second, third};
}

}  // namespace

using Use = FunctionRef<void(std::span<const FoundPoint>)>;

struct ClosestPointQuery::Data {
  TriangleMesh mesh;  ///< copy of the mesh; `search_` is built from it
  SignMode mode;
  SiteTable sites;
  Bvh bvh;
  sign::Planner planner;
  sign::Plan plan;
  sign::Sides sides;
  double max_distance;
  double longest = 0;           ///< longest side of the mesh's box
  double coordinate_limit = 0;  ///< largest absolute coordinate allowed in a query, mesh units

  Data(const MeshView& given, const ClosestPointOptions& options, const Context& context)
      : mesh(copy_of(given)),
        mode(options.sign),
        sites(mesh, context),
        bvh(mesh, sites, context),
        planner(mode == SignMode::automatic ? bvh.order() : std::span<const std::uint32_t>{}),
        plan(planner.plan(mode, mesh, sites, context)),
        sides(plan, mesh, sites, bvh, context),
        max_distance(checked_limit(options)) {
    measure();
    use_planned_triangles(context);
  }

  /// Does the work of the constructor and of prepare() at the same time.
  static std::unique_ptr<Data> for_many(const MeshView& mesh, std::size_t queries, const ClosestPointOptions& options,
                                        const Context& context) {
    const bool is_worth_it = PointSearch::is_worth_building(queries, mesh.triangles.size());
    if (!is_worth_it || thread_count(context) == 1) {
      auto data = std::make_unique<Data>(mesh, options, context);
      data->prepare(queries, context);
      return data;
    }
    std::unique_ptr<Data> data;
    std::unique_ptr<const PointSearch> search;
    const auto run = [&](const WorkRange& task) {
      if (task.begin == 0) {
        data = std::make_unique<Data>(mesh, options, context);
        return;
      }
      // Progress is reported by one of the tasks only.
      const Context quiet{.threads = context.threads, .cancel = context.cancel};
      search = std::make_unique<const PointSearch>(mesh, SiteTable(mesh, quiet), quiet);
    };
    parallel_for(context, 2, 1, "", run, Start::at_once);
    // The search was built from the given triangles.
    if (data->given_triangles_.empty()) data->search_ = std::move(search);
    data->prepare(queries, context);
    return data;
  }

  void refit(std::span<const Vec3d> vertices, const Context& context) {
    if (vertices.size() != mesh.vertices.size()) {
      throw InvalidMesh("a query for a mesh with " + std::to_string(mesh.vertices.size()) +
                        " vertices cannot be refitted to " + std::to_string(vertices.size()) +
                        " vertices; create a new query");
    }
    MeshView moved = mesh;
    moved.vertices = vertices;
    validate(moved);
    search_.reset();
    normals_.reset();
    is_prepared_ = false;
    std::copy(vertices.begin(), vertices.end(), mesh.vertices.begin());
    // The plan depends on the triangles as they were given.
    if (given_triangles_.empty()) {
      bvh.refit(mesh.vertices, context);
    } else {
      use_triangles(std::exchange(given_triangles_, {}), context);
    }
    measure();
    if (mode == SignMode::none) return;
    plan = planner.plan(mode, mesh, sites, context);
    sides = sign::Sides(plan, mesh, sites, bvh, context);
    use_planned_triangles(context);
  }

  /// If the plan has other triangles than the mesh, replaces the triangles of the mesh by those of the plan.
  void use_planned_triangles(const Context& context) {
    if (plan.triangles.empty()) return;
    given_triangles_ = mesh.triangles;
    use_triangles(std::exchange(plan.triangles, {}), context);
    sides = sign::Sides(plan, mesh, sites, bvh, context);
  }
  void use_triangles(std::vector<Triangle> triangles, const Context& context) {
    mesh.triangles = std::move(triangles);
    sites = SiteTable(mesh, context);
    bvh = Bvh(mesh, sites, context);
  }

  void measure() {
    const Vec3d size = bvh.bounds().size();
    longest = std::max({size.x, size.y, size.z});
    coordinate_limit = longest > 0 ? std::min(longest, 1.0) * 1e140 : 1e140;
  }

  [[nodiscard]] ClosestPoint finished(const Vec3d& query, const std::optional<NearestSite>& nearest) const {
    if (!nearest) return {query, no_limit, SiteId::none(), TriangleId::none()};
    // A point on the surface does not count as inside.
    const bool is_negative = nearest->distance > 0 && sides.is_inside(query, *nearest);
    const double distance = is_negative ? -nearest->distance : nearest->distance;
    return {nearest->point, distance, nearest->site, sites.triangle(nearest->site)};
  }

  /// Finds the signs of queries that lie close together, and reports their results. Queries that need winding numbers
  /// share evaluations if possible.
  void finish(std::span<const PointSearch::Answer> group, Use use) const {
    static_assert(cpu::PointEngine::most_per_group <= sign::most_shared);
    InlineList<FoundPoint, sign::most_shared> found;
    InlineList<sign::SidedPoint, sign::most_shared> open;
    InlineList<std::size_t, sign::most_shared> open_index;
    double extent = 3 * longest;
    for (const PointSearch::Answer& answer : group) {
      if (answer.nearest.site.has_value()) sides.prefetch(answer.nearest.site);
    }
    for (const auto& [query, at, nearest] : group) {
      if (!nearest.site.has_value()) {
        found.push_back({query, at, no_limit, SiteId::none()});
        continue;
      }
      const std::optional<bool> known =
          nearest.distance > 0 ? sides.is_inside_by_site(at, nearest) : std::optional(false);
      if (!known) {
        open.push_back({at, nearest.distance, false});
        open_index.push_back(found.size());
        extent = std::max(extent, nearest.distance + length(at));
      }
      found.push_back(
          {query, nearest.point, known.value_or(false) ? -nearest.distance : nearest.distance, nearest.site});
    }
    if (!open.empty()) sign::decide_sides(*sides.winding(), {&open[0], open.size()}, rounding * extent);
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (open[k].is_inside) found[open_index[k]].distance = -found[open_index[k]].distance;
    }
    use({&found[0], found.size()});
  }

  /// Answers queries in an order in which consecutive queries lie close together. The closest point of each query
  /// bounds the distance of the next query.
  void find(std::span<const Vec3d> queries, std::span<const std::uint32_t> order, Use use) const {
    InlineList<PointSearch::Answer, sign::most_shared> group;
    std::optional<NearestSite> last;
    for (const std::uint32_t index : order) {
      const Vec3d& query = queries[index];
      const double known = last ? with_slack(length(query - last->point), query) : no_limit;
      last = bvh.nearest(query, std::min(max_distance, known));
      group.push_back({index, query, last.value_or(NearestSite{})});
    }
    finish(group.span(), use);
  }

  /// Returns the bound, increased by more than the largest possible rounding error.
  [[nodiscard]] double with_slack(double bound, const Vec3d& q) const {
    return bound * (1 + 1e-9) + 1e-12 * (longest + std::abs(q.x) + std::abs(q.y) + std::abs(q.z));
  }

  /// Returns the batch search for this many queries, or null if there are too few queries to save time. The first call
  /// that returns a search builds this search.
  [[nodiscard]] const PointSearch* search_for(std::size_t queries, const Context& context) const {
    const std::scoped_lock lock(search_mutex_);
    if (is_prepared_) return queries >= PointSearch::fewest ? search_.get() : nullptr;
    const bool is_worth_it = search_ ? PointSearch::is_worth_using(queries, sites)
                                     : PointSearch::is_worth_building(queries, sites.face_count());
    if (is_worth_it && !search_) search_ = std::make_unique<const PointSearch>(mesh, sites, context);
    return is_worth_it ? search_.get() : nullptr;
  }

  /// Returns the normals of the sites. If signs do not need them, the first call computes them.
  [[nodiscard]] const Pseudonormals& normals(const Context& context) const {
    if (sides.normals() != nullptr) return *sides.normals();
    const std::scoped_lock lock(normals_mutex_);
    if (!normals_) normals_.emplace(mesh, sites, context);
    return *normals_;
  }

  /// Returns the gradient at a query on the surface.
  [[nodiscard]] static std::optional<Vec3d> gradient_on_surface(const ClosestPoint& found,
                                                                const Pseudonormals& normals) {
    if (!found.site.has_value()) return std::nullopt;
    const Vec3d& normal = normals.normal(found.site);
    const double size = length(normal);
    return size > 0 ? std::optional(normal / size + Vec3d{}) : std::nullopt;  // + Vec3d{} turns -0 into 0
  }

  void prepare(std::size_t queries, const Context& context) {
    if (!PointSearch::is_worth_building(queries, sites.face_count())) return;
    if (!search_) search_ = std::make_unique<const PointSearch>(mesh, sites, context);
    is_prepared_ = true;
  }

  void check(std::span<const Vec3d> queries, const Context& context) const {
    std::atomic<std::size_t> first_bad{queries.size()};
    parallel_for(context, queries.size(), checks_per_range, "", [&](const WorkRange& range) {
      for (std::size_t i = range.begin; i < range.end; ++i) {
        if (is_in_range(queries[i])) continue;
        std::size_t known = first_bad;
        while (i < known && !first_bad.compare_exchange_weak(known, i)) {
        }
        return;
      }
    });
    const std::size_t bad = first_bad;
    if (bad == queries.size()) return;
    throw InvalidOption("query " + std::to_string(bad) +
                        (is_finite(queries[bad])
                             ? " lies too far from the mesh (more than 1e140 times its longest side)"
                             : " has a coordinate that is not finite"));
  }

  [[nodiscard]] bool is_in_range(const Vec3d& q) const {
    return std::abs(q.x) <= coordinate_limit && std::abs(q.y) <= coordinate_limit && std::abs(q.z) <= coordinate_limit;
  }

 private:
  std::vector<Triangle> given_triangles_;  ///< triangles of the given mesh; empty if `mesh` has the same
  mutable std::mutex normals_mutex_;
  mutable std::optional<Pseudonormals> normals_;
  mutable std::mutex search_mutex_;
  mutable std::unique_ptr<const PointSearch> search_;
  /// If true, search_for() uses `search_` for all calls with at least PointSearch::fewest queries.
  bool is_prepared_ = false;
};

ClosestPointQuery::ClosestPointQuery(const MeshView& mesh, const ClosestPointOptions& options, const Context& context) {
  validate(mesh);
  (void)checked_limit(options);
  data_ = std::make_unique<Data>(mesh, options, context);
}

ClosestPointQuery::ClosestPointQuery(std::unique_ptr<Data> data) : data_(std::move(data)) {}

ClosestPointQuery ClosestPointQuery::for_many(const MeshView& mesh, std::size_t queries,
                                              const ClosestPointOptions& options, const Context& context) {
  validate(mesh);
  (void)checked_limit(options);
  return ClosestPointQuery(Data::for_many(mesh, queries, options, context));
}

ClosestPointQuery::ClosestPointQuery(ClosestPointQuery&&) noexcept = default;
ClosestPointQuery& ClosestPointQuery::operator=(ClosestPointQuery&&) noexcept = default;
ClosestPointQuery::~ClosestPointQuery() = default;

SignRule ClosestPointQuery::sign_rule() const {
  return data_->plan.rule;
}
bool ClosestPointQuery::sign_may_jump() const {
  return data_->plan.method == sign::Method::sums || data_->plan.method == sign::Method::pseudonormals;
}

const std::vector<Warning>& ClosestPointQuery::warnings() const {
  return data_->plan.warnings;
}

const std::string& ClosestPointQuery::sign_reason() const {
  return data_->plan.reason;
}

ClosestPoint ClosestPointQuery::nearest(const Vec3d& query) const {
  return data_->finished(query, data_->bvh.nearest(query, data_->max_distance));
}

std::optional<Vec3d> ClosestPointQuery::gradient(const Vec3d& query, const ClosestPoint& found) const {
  const std::optional<Vec3d> away = blum::gradient(query, found);
  if (away || !found.site.has_value()) return away;
  return Data::gradient_on_surface(found, data_->normals({}));
}

std::vector<std::optional<Vec3d>> ClosestPointQuery::gradients(std::span<const Vec3d> queries,
                                                               std::span<const ClosestPoint> found,
                                                               const Context& context) const {
  if (queries.size() != found.size()) {
    throw InvalidOption("there are " + std::to_string(queries.size()) + " queries and " + std::to_string(found.size()) +
                        " results; gradients need one result for each query");
  }
  std::vector<std::optional<Vec3d>> out(queries.size());
  std::atomic<bool> is_any_on_surface{false};
  parallel_for(context, queries.size(), gradients_per_range, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      out[k] = blum::gradient(queries[k], found[k]);
      if (!out[k] && found[k].site.has_value()) is_any_on_surface.store(true, std::memory_order_relaxed);
    }
  });
  if (!is_any_on_surface) return out;
  const Pseudonormals& normals = data_->normals(context);
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (!out[k]) out[k] = Data::gradient_on_surface(found[k], normals);
  }
  return out;
}

void ClosestPointQuery::refit(std::span<const Vec3d> vertices, const Context& context) {
  data_->refit(vertices, context);
}

void ClosestPointQuery::prepare_for_many(std::size_t queries, const Context& context) {
  data_->prepare(queries, context);
}

void ClosestPointQuery::for_each_nearest(std::span<const Vec3d> queries, Use use, const Context& context) const {
  data_->check(queries, context);
  if (const PointSearch* search = data_->search_for(queries.size(), context)) {
    search->nearest(queries, data_->max_distance, data_->bvh, context,
                    [&](std::span<const PointSearch::Answer> group) { data_->finish(group, use); });
    return;
  }
  const std::vector<std::uint32_t> order = order_along_curve(queries);
  const std::size_t grain = data_->sides.winding() != nullptr ? sign::most_shared : queries_per_range;
  parallel_for(context, order.size(), grain, "closest points", [&](const WorkRange& range) {
    data_->find(queries, std::span(order).subspan(range.begin, range.end - range.begin), use);
  });
}

std::vector<ClosestPoint> ClosestPointQuery::nearest(std::span<const Vec3d> queries, const Context& context) const {
  std::vector<ClosestPoint> results = detail::large_list<ClosestPoint>(queries.size());
  const auto first_face = static_cast<std::uint32_t>(data_->sites.size() - data_->sites.face_count());
  const auto put = [&](std::span<const FoundPoint> group) {
    for (std::size_t k = 0; k < group.size(); ++k) {
      if (k + ahead < group.size()) prefetch_to_write(&results[group[k + ahead].query]);
      const FoundPoint& found = group[k];
      const SiteId site = found.site;
      const TriangleId triangle = !site.has_value()          ? TriangleId::none()
                                  : site.value >= first_face ? TriangleId(site.value - first_face)
                                                             : data_->sites.triangle(site);
      results[found.query] = {found.point, found.distance, site, triangle};
    }
  };
  for_each_nearest(queries, put, context);
  return results;
}

namespace {

/// Answers many queries, each of which finds any number of primitives.
/// @param find  callable: query -> list of the primitives found for it.
template <class Find>
NearPrimitives gathered(std::span<const Vec3d> queries, const Context& context, const Find& find) {
  NearPrimitives out;
  out.first.assign(queries.size() + 1, 0);
  std::vector<std::vector<NearestPrimitive>> parts((queries.size() + queries_per_range - 1) / queries_per_range);
  parallel_for(context, queries.size(), queries_per_range, "closest primitives", [&](const WorkRange& range) {
    std::vector<NearestPrimitive>& part = parts[range.begin / queries_per_range];
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const std::vector<NearestPrimitive> found = find(queries[i]);
      part.insert(part.end(), found.begin(), found.end());
      out.first[i + 1] = found.size();
    }
  });
  for (std::size_t i = 0; i < queries.size(); ++i) out.first[i + 1] += out.first[i];
  out.found.resize(out.first.back());
  parallel_for(context, parts.size(), 1, "", [&](const WorkRange& range) {
    std::vector<NearestPrimitive>& part = parts[range.begin];
    std::copy(part.begin(), part.end(),
              out.found.begin() + static_cast<std::ptrdiff_t>(out.first[range.begin * queries_per_range]));
    part = {};
  });
  return out;
}

}  // namespace

NearPrimitives ClosestPointQuery::within(std::span<const Vec3d> queries, double distance,
                                         const Context& context) const {
  if (!(distance >= 0)) throw InvalidOption("distance is " + std::to_string(distance) + "; it must be at least 0");
  data_->check(queries, context);
  const double limit = std::min(distance, data_->max_distance);
  return gathered(queries, context, [&](const Vec3d& query) { return data_->bvh.within(query, limit); });
}

NearPrimitives ClosestPointQuery::nearest_primitives(std::span<const Vec3d> queries, std::size_t k,
                                                     const Context& context) const {
  data_->check(queries, context);
  return gathered(queries, context,
                  [&](const Vec3d& query) { return data_->bvh.nearest_primitives(query, k, data_->max_distance); });
}

std::vector<ClosestPoint> closest_points(const MeshView& mesh, std::span<const Vec3d> queries,
                                         const ClosestPointOptions& options, const Context& context) {
  return ClosestPointQuery::for_many(mesh, queries.size(), options, context).nearest(queries, context);
}

std::optional<Vec3d> gradient(const Vec3d& query, const ClosestPoint& found) {
  const double rounding = 1e-13 * (length(query) + length(found.point));
  if (!(std::abs(found.distance) > rounding) || !std::isfinite(found.distance)) return std::nullopt;
  // The vector is normalised by its own length, not by the distance. Next to the surface, rounding changes the point
  // more than the distance.
  const Vec3d away = (query - found.point) / std::abs(found.distance);
  const double size = length(away);
  if (!(size > 0)) return std::nullopt;
  return away / std::copysign(size, found.distance) + Vec3d{};  // + Vec3d{} turns -0 into 0
}

std::optional<std::array<double, 3>> barycentric(const MeshView& mesh, const ClosestPoint& found) {
  if (!found.triangle.has_value()) return std::nullopt;
  const Triangle& triangle = mesh.triangles[found.triangle.value];
  for (std::size_t k = 0; k < 3; ++k) {
    if (found.site.value != triangle[k]) continue;
    std::array<double, 3> out{};
    out[k] = 1;
    return out;
  }
  // The triangle is scaled to a size of about 1, so that nothing overflows.
  const Vec3d& origin = mesh.vertices[triangle[0]];
  double size = 0;
  for (const std::uint32_t v : triangle) {
    const Vec3d from = mesh.vertices[v] - origin;
    size = std::max({size, std::abs(from.x), std::abs(from.y), std::abs(from.z)});
  }
  if (!(size > 0)) return std::array<double, 3>{1, 0, 0};
  const auto corner = [&](std::size_t k) { return (mesh.vertices[triangle[k % 3]] - origin) / size; };
  const auto side = [&](std::size_t k) { return squared_length(corner(k + 1) - corner(k)); };
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (side(k) > side(longest)) longest = k;
  }
  const std::array<double, 3> weights =
      weights_of({corner(longest), corner(longest + 1), corner(longest + 2)}, (found.point - origin) / size);
  std::array<double, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) out[(longest + k) % 3] = weights[k];
  return out;
}

}  // namespace blum
