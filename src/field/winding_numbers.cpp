#include "blum/field/winding_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "blum/core/inline_list.hpp"
#include "blum/core/parallel.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/winding_number.hpp"
#include "field/point_search.hpp"
#include "field/sign/shared_sides.hpp"

namespace blum {
namespace {

constexpr std::size_t points_per_range = 256;
/// Upper bound on the rounding error of a sum of two distances, relative to the lengths involved.
constexpr double rounding = 1e-12;
constexpr double no_limit = std::numeric_limits<double>::infinity();
/// Points whose distance is more than this many diagonals of the mesh do not share answers.
constexpr double far_away = 1e6;

void check(const MeshView& mesh, std::span<const Vec3d> points, double max_error) {
  validate(mesh);
  if (!(max_error > 0)) throw InvalidOption("max_error is " + std::to_string(max_error) + "; it must be above 0");
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i])) throw InvalidOption("point " + std::to_string(i) + " is not finite");
  }
}

/// Finds winding numbers of a group: neighbours share rough values, which are then refined one by one.
class NumbersTogether {
 public:
  NumbersTogether(const WindingNumber& winding, const Box3& bounds, double max_error)
      : winding_(winding), bounds_(bounds), max_error_(max_error) {}

  void find(std::span<const PointSearch::Answer> group, std::vector<double>& values) const {
    static_assert(cpu::PointEngine::most_per_group <= sign::most_shared);
    InlineList<sign::NumberedPoint, sign::most_shared> numbered;
    InlineList<std::size_t, sign::most_shared> index;
    double extent = 3 * bounds_.diagonal();
    for (const PointSearch::Answer& answer : group) {
      const Vec3d& at = answer.at;
      const double distance = answer.nearest.site.has_value() ? answer.nearest.distance : 0;
      // A point that cannot share answers must not enlarge the box of the points that can.
      if (!(distance > 0) || !(distance < far_away * bounds_.diagonal())) {
        values[answer.query] = winding_.value(at, max_error_).value;
        continue;
      }
      numbered.push_back({at, distance, 0});
      index.push_back(answer.query);
      extent = std::max(extent, distance + length(at));
    }
    sign::find_rough_numbers(winding_, {numbered.data(), numbered.size()}, rounding * extent);
    for (std::size_t k = 0; k < numbered.size(); ++k) {
      const std::optional<double> fine = winding_.refine(numbered[k].at, numbered[k].number);
      values[index[k]] = fine ? *fine : winding_.value(numbered[k].at, max_error_).value;
    }
  }

 private:
  const WindingNumber& winding_;
  Box3 bounds_;
  double max_error_;
};

}  // namespace

std::vector<double> winding_numbers(const MeshView& mesh, std::span<const Vec3d> points, double max_error,
                                    const Context& context) {
  check(mesh, points, max_error);
  MeshView surface;
  surface.vertices = mesh.vertices;
  surface.triangles = mesh.triangles;
  const SiteTable sites(surface, context);
  const WindingNumber winding(surface, sites, context);
  std::vector<double> values(points.size());
  const bool is_refined =
      winding.is_piecewise_constant() || (winding.has_short_boundary() && max_error >= WindingNumber::refined_error);
  if (is_refined && PointSearch::is_worth_building(points.size(), sites.face_count())) {
    const Bvh bvh(surface, sites, context);
    const NumbersTogether together(winding, bvh.bounds(), max_error);
    const PointSearch search(surface, sites, context);
    search.nearest(points, no_limit, bvh, context,
                   [&](std::span<const PointSearch::Answer> group) { together.find(group, values); });
    return values;
  }
  parallel_for(context, points.size(), points_per_range, "winding numbers", [&](const WorkRange& range) {
    for (std::size_t i = range.begin; i < range.end; ++i) values[i] = winding.value(points[i], max_error).value;
  });
  return values;
}

}  // namespace blum
