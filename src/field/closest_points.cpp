#include "blum/field/closest_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/inline_list.hpp"
#include "blum/core/parallel.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "field/point_search.hpp"
#include "field/sign/policy.hpp"
#include "field/sign/shared_sides.hpp"
#include "field/sign/sides.hpp"

namespace blum {
namespace {

constexpr std::size_t queries_per_range = 512;
/// What rounding may do to the sum of two distances, relative to the lengths involved, generously.
constexpr double rounding = 1e-12;
constexpr double no_limit = std::numeric_limits<double>::infinity();

double checked_limit(const ClosestPointOptions& options) {
  if (options.max_distance && !(*options.max_distance >= 0)) {
    throw InvalidOption("max_distance is " + std::to_string(*options.max_distance) + "; it must be at least 0");
  }
  return options.max_distance.value_or(no_limit);
}

/// Answers come in another order than queries.
void prefetch_to_write([[maybe_unused]] const ClosestPoint* point) {
#if defined(__GNUC__)
  __builtin_prefetch(point, 1);
#endif
}

}  // namespace

struct ClosestPointQuery::Data {
  TriangleMesh mesh;  ///< what `search` is built of
  SiteTable sites;
  Bvh bvh;
  sign::Plan plan;
  sign::Sides sides;
  double max_distance;
  double longest = 0;           ///< side of the mesh's box
  double coordinate_limit = 0;  ///< of queries, mesh units

  Data(const MeshView& given, const ClosestPointOptions& options, const Context& context)
      : mesh{{given.vertices.begin(), given.vertices.end()},
             {given.triangles.begin(), given.triangles.end()},
             {given.segments.begin(), given.segments.end()},
             {given.points.begin(), given.points.end()}},
        sites(mesh, context),
        bvh(mesh, sites, context),
        plan(sign::plan_signs(options.sign, mesh, sites, context)),
        sides(plan, mesh, sites, bvh, context),
        max_distance(checked_limit(options)) {
    const Vec3d size = bvh.bounds().size();
    longest = std::max({size.x, size.y, size.z});
    coordinate_limit = longest > 0 ? std::min(longest, 1.0) * 1e140 : 1e140;
  }

  /// An upper bound on the distance, where one is known, spares work; it does not change the result.
  [[nodiscard]] ClosestPoint closest(const Vec3d& query, double upper_bound) const {
    const std::optional<NearestSite> nearest = bvh.nearest(query, std::min(max_distance, upper_bound));
    return finished(query, nearest);
  }

  [[nodiscard]] ClosestPoint finished(const Vec3d& query, const std::optional<NearestSite>& nearest) const {
    // What lies on the surface is not inside.
    const bool is_negative = nearest && nearest->distance > 0 && sides.is_inside(query, *nearest);
    return with_side(query, nearest, is_negative);
  }

  [[nodiscard]] ClosestPoint with_side(const Vec3d& query, const std::optional<NearestSite>& nearest,
                                       bool is_negative) const {
    if (!nearest) return {query, no_limit, SiteId::none(), TriangleId::none()};
    const double distance = is_negative ? -nearest->distance : nearest->distance;
    return {nearest->point, distance, nearest->site, sites.triangle(nearest->site)};
  }

  /// The same for queries that lie close together: those that need winding numbers share what they can.
  void finish(std::span<const Vec3d> queries, std::span<const PointSearch::Answer> group,
              std::span<ClosestPoint> results) const {
    static_assert(cpu::PointEngine::most_per_group <= sign::most_shared);
    InlineList<sign::SidedPoint, sign::most_shared> open;
    InlineList<std::size_t, sign::most_shared> open_query;
    double extent = 3 * longest;
    for (std::size_t k = 0; k < group.size(); ++k) {
      if (k + 8 < group.size()) prefetch_to_write(&results[group[k + 8].query]);
      const auto& [query, nearest] = group[k];
      const Vec3d& at = queries[query];
      const bool is_off = nearest && nearest->distance > 0;
      const std::optional<bool> known = is_off ? sides.is_inside_by_site(at, *nearest) : std::optional(false);
      results[query] = with_side(at, nearest, known.value_or(false));
      if (known) continue;
      open.push_back({at, nearest->distance, false});
      open_query.push_back(query);
      extent = std::max(extent, nearest->distance + length(at));
    }
    if (open.empty()) return;
    sign::decide_sides(*sides.winding(), {&open[0], open.size()}, rounding * extent);
    for (std::size_t k = 0; k < open.size(); ++k) {
      if (open[k].is_inside) results[open_query[k]].distance = -results[open_query[k]].distance;
    }
  }

  /// A bound, widened by more than rounding can have taken from it.
  [[nodiscard]] double with_slack(double bound, const Vec3d& q) const {
    return bound * (1 + 1e-9) + 1e-12 * (longest + std::abs(q.x) + std::abs(q.y) + std::abs(q.z));
  }

  /// The search for so many queries; null where they are not worth one. It is built by the first that are.
  [[nodiscard]] const PointSearch* search_for(std::size_t queries, const Context& context) const {
    const std::scoped_lock lock(search_mutex_);
    const bool is_worth_it =
        search_ ? PointSearch::is_worth_using(queries, sites) : PointSearch::is_worth_building(queries, sites);
    if (is_worth_it && !search_) search_ = std::make_unique<const PointSearch>(mesh, sites, context);
    return is_worth_it ? search_.get() : nullptr;
  }

  [[nodiscard]] bool is_in_range(const Vec3d& q) const {
    return std::abs(q.x) <= coordinate_limit && std::abs(q.y) <= coordinate_limit && std::abs(q.z) <= coordinate_limit;
  }

 private:
  mutable std::mutex search_mutex_;
  mutable std::unique_ptr<const PointSearch> search_;
};

ClosestPointQuery::ClosestPointQuery(const MeshView& mesh, const ClosestPointOptions& options, const Context& context) {
  validate(mesh);
  (void)checked_limit(options);
  data_ = std::make_unique<const Data>(mesh, options, context);
}

ClosestPointQuery::ClosestPointQuery(ClosestPointQuery&&) noexcept = default;
ClosestPointQuery& ClosestPointQuery::operator=(ClosestPointQuery&&) noexcept = default;
ClosestPointQuery::~ClosestPointQuery() = default;

SignRule ClosestPointQuery::sign_rule() const {
  return data_->plan.rule;
}
const std::string& ClosestPointQuery::sign_reason() const {
  return data_->plan.reason;
}

ClosestPoint ClosestPointQuery::nearest(const Vec3d& query) const {
  return data_->closest(query, no_limit);
}

std::vector<ClosestPoint> ClosestPointQuery::nearest(std::span<const Vec3d> queries, const Context& context) const {
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (!data_->is_in_range(queries[i])) {
      throw InvalidOption("query " + std::to_string(i) +
                          (is_finite(queries[i]) ? " lies too far from the mesh (1e140 times its longest side)"
                                                 : " has a coordinate that is not finite"));
    }
  }
  std::vector<ClosestPoint> results(queries.size());
  if (const PointSearch* search = data_->search_for(queries.size(), context)) {
    search->nearest(queries, data_->max_distance, data_->bvh, context, [&](std::span<const PointSearch::Answer> group) {
      data_->finish(queries, group, results);
    });
    return results;
  }
  parallel_for(context, queries.size(), queries_per_range, "closest points", [&](const WorkRange& range) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      // Queries often come in order: the last answer bounds the next one by the triangle inequality.
      const bool has_last = i > range.begin && results[i - 1].site.has_value();
      const double step = has_last ? length(queries[i] - queries[i - 1]) : 0.0;
      const double last = has_last ? std::abs(results[i - 1].distance) : no_limit;
      results[i] = data_->closest(queries[i], data_->with_slack(last + step, queries[i]));
    }
  });
  return results;
}

std::vector<ClosestPoint> closest_points(const MeshView& mesh, std::span<const Vec3d> queries,
                                         const ClosestPointOptions& options, const Context& context) {
  return ClosestPointQuery(mesh, options, context).nearest(queries, context);
}

}  // namespace blum
