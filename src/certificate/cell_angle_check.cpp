#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/random.hpp"
#include "certificate/allowances.hpp"
#include "certificate/angle.hpp"
#include "certificate/checks.hpp"
#include "certificate/sampling.hpp"

namespace blum::verifier {
namespace {

constexpr double noise = 10;               ///< degrees: footprints at a smaller angle are treated as one footprint
constexpr double nearly = 10;              ///< degrees by which an angle may be below the angles of all corners
constexpr double about = 20;               ///< degrees by which an angle may exceed the largest angle found nearby
constexpr double same = 1e-3;              ///< degrees: rounding of float32
constexpr double most_below = 0.8;         ///< largest share of the area below: see docs/theory/medial-axis.md
constexpr double most_above = 0.2;         ///< largest share of samples above
constexpr double most_curves_above = 0.6;  ///< largest share for curves, which wind within a voxel even in correct axes
constexpr double most_low_rims = 0.25;     ///< largest share of the length of rims and curves
constexpr std::size_t few = 64;            ///< shares of fewer cells or samples are not checked
constexpr std::size_t most_samples = 1'024;
constexpr std::size_t grain = 32;

std::string percent(double share) {
  return rounded_text(std::round(share * 1000) / 10) + " %";
}

/// A cell to be sampled in proportion to its size.
struct Sized {
  double end = 0;  ///< sum of the sizes of all cells up to this one
  std::uint32_t cell = 0;
};

void add(std::vector<Sized>& cells, double size, std::uint32_t cell) {
  if (!(size > 0) || !std::isfinite(size)) return;
  cells.push_back({(cells.empty() ? 0 : cells.back().end) + size, cell});
}

/// Returns the largest angle at p between closest surface points: those of p and of 14 points about `reach` away from
/// p.
double seen_around(const SolidOracle& solid, std::uint32_t body, const Vec3d& p, double reach) {
  std::array<Vec3d, 15> towards;
  std::size_t count = 0;
  towards[count++] = solid.closest_point(p, body) - p;
  for (std::size_t k = 0; k < 14; ++k) {
    Vec3d way;
    if (k < 6) {
      way[k / 2] = k % 2 == 0 ? reach : -reach;
    } else {
      for (std::size_t axis = 0; axis < 3; ++axis) way[axis] = (((k - 6) >> axis) % 2 == 0 ? reach : -reach) / 1.75;
    }
    towards[count++] = solid.closest_point(p + way, body) - p;
  }
  double largest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < i; ++j) largest = std::max(largest, degrees_between(towards[i], towards[j]));
  }
  return largest;
}

class Angles {
 public:
  Angles(const MedialView& axis, const Incidence& incidence, const KnownSolid& solid,
         const std::vector<std::uint32_t>& body_of, double reach)
      : axis_(axis), incidence_(incidence), solid_(*solid.solid), body_of_(body_of), reach_(reach) {}

  /// Measures the area of triangles whose angle is more than `nearly` below the angles of all their corners.
  void compare_with_corners(AngleCheck& check) const {
    double all = 0;
    double below = 0;
    for (std::size_t t = 0; t < axis_.triangles.size(); ++t) {
      const double size = triangle_area(axis_, t);
      if (!std::isfinite(size)) continue;
      const double least = least_angle(axis_.triangles[t]);
      if (least < noise) continue;
      ++check.triangles;
      all += size;
      if (axis_.triangle_angle[t] < least - nearly) below += size;
    }
    if (all > 0) check.below_share = below / all;
  }

  /// Compares the angles of rim and seam edges with those of their triangles. An edge must have the largest angle of
  /// its triangles, or less if vertices were removed.
  void compare_with_triangles(AngleCheck& check) const {
    for (std::size_t n = 0; n < axis_.edges.size(); ++n) {
      const auto triangles = incidence_.triangles_of_edge()[incidence_.edge_of_listed()[n]];
      if (triangles.empty()) continue;
      double largest = 0;
      for (const std::uint32_t t : triangles) largest = std::max<double>(largest, axis_.triangle_angle[t]);
      ++check.borders;
      if (axis_.edge_angle[n] > largest + same) ++check.borders_above;
      if (axis_.edge_angle[n] < largest - about) ++check.borders_below;
    }
  }

  /// Measures the length of rims on sheets whose angles are all at most theta. A correct axis has no such rims: a sheet
  /// that exists only for homotopy is closed, or ends at seams.
  void look_for_low_rims(double theta, AngleCheck& check) const {
    std::vector<float> of_sheet;
    for (std::size_t t = 0; t < axis_.triangles.size(); ++t) {
      const auto sheet = static_cast<std::size_t>(axis_.sheet[t]);
      if (sheet >= of_sheet.size()) of_sheet.resize(sheet + 1, 0);
      of_sheet[sheet] = std::max(of_sheet[sheet], axis_.triangle_angle[t]);
    }
    double all = 0;
    double low = 0;
    for (std::uint32_t e = 0; e < incidence_.edges().size(); ++e) {
      const auto triangles = incidence_.triangles_of_edge()[e];
      if (triangles.size() > 1) continue;
      const auto& [a, b] = incidence_.edges()[e];
      const double size = length(axis_.positions[a] - axis_.positions[b]);
      if (!std::isfinite(size)) continue;
      all += size;
      if (triangles.empty()) continue;
      ++check.rims;
      if (of_sheet[static_cast<std::size_t>(axis_.sheet[triangles[0]])] <= theta) low += size;
    }
    if (all > 0) check.low_rims_share = low / all;
  }

  /// Samples triangles and curves with angles above 0, and compares their angles with those found nearby.
  void compare_with_surface(AngleCheck& check, const Context& context) const {
    std::vector<Sized> triangles;
    for (std::uint32_t t = 0; t < axis_.triangles.size(); ++t) {
      if (axis_.triangle_angle[t] > 0) add(triangles, triangle_area(axis_, t), t);
    }
    std::vector<Sized> curves;
    for (std::uint32_t n = 0; n < axis_.edges.size(); ++n) {
      const auto& [a, b] = axis_.edges[n];
      if (!incidence_.triangles_of_edge()[incidence_.edge_of_listed()[n]].empty() || !(axis_.edge_angle[n] > 0))
        continue;
      add(curves, length(axis_.positions[a] - axis_.positions[b]), n);
    }
    const auto of_triangle = [&](std::uint32_t t) {
      const auto& [a, b, c] = axis_.triangles[t];
      const Vec3d middle = (axis_.positions[a] + axis_.positions[b] + axis_.positions[c]) / 3.0;
      return axis_.triangle_angle[t] > seen_around(solid_, body_of_[a], middle, reach_) + about;
    };
    const auto of_curve = [&](std::uint32_t n) {
      const auto& [a, b] = axis_.edges[n];
      const Vec3d middle = (axis_.positions[a] + axis_.positions[b]) * 0.5;
      return axis_.edge_angle[n] > seen_around(solid_, body_of_[a], middle, reach_) + about;
    };
    std::tie(check.samples, check.above_share) = share_above(triangles, of_triangle, context);
    std::tie(check.curve_samples, check.curves_above_share) = share_above(curves, of_curve, context);
  }

 private:
  template <class Corners>
  [[nodiscard]] double least_angle(const Corners& corners) const {
    double least = 180;
    for (const std::uint32_t v : corners) least = std::min(least, axis_.separation_angle[v]);
    return least;
  }

  /// Returns the number of samples, and the share of them whose angle is too large.
  template <class IsAbove>
  [[nodiscard]] static std::pair<std::size_t, double> share_above(const std::vector<Sized>& cells,
                                                                  const IsAbove& is_above, const Context& context) {
    const std::size_t count = cells.empty() ? 0 : std::min(most_samples, 2 * cells.size());
    std::vector<std::size_t> parts(count / grain + 1, 0);
    parallel_for(context, count, grain, "checking angles", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        Random random(0xa461eULL + k);
        const double at = (static_cast<double>(k) + random.uniform()) / static_cast<double>(count) * cells.back().end;
        const auto end = std::upper_bound(cells.begin(), cells.end() - 1, at,
                                          [](double value, const Sized& cell) { return value < cell.end; });
        if (is_above(end->cell)) ++parts[range.begin / grain];
      }
    });
    std::size_t above = 0;
    for (const std::size_t part : parts) above += part;
    return {count, count > 0 ? static_cast<double>(above) / static_cast<double>(count) : 0};
  }

  const MedialView& axis_;
  const Incidence& incidence_;
  const SolidOracle& solid_;
  const std::vector<std::uint32_t>& body_of_;
  double reach_;
};

/// @param by_voxels  true if the solid consists of voxels, or if voxels define the inside of a mesh. In such solids,
///                   many faces are equally close, and a mesh may have walls that bound nothing. So shares that depend
///                   on positions are reported but cause no mismatches.
void explain(const AngleCheck& check, double theta, bool by_voxels, std::vector<std::string>& mismatches) {
  if (!by_voxels && check.triangles >= few && check.below_share > most_below) {
    mismatches.push_back("of the triangles whose corners have two footprints, " + percent(check.below_share) +
                         " have a smaller separation angle than each of their corners");
  }
  if (!by_voxels && check.samples >= few && check.above_share > most_above) {
    mismatches.push_back("of the sampled triangles, " + percent(check.above_share) +
                         " have a larger separation angle than any point examined near them");
  }
  if (!by_voxels && check.curve_samples >= few && check.curves_above_share > most_curves_above) {
    mismatches.push_back("of the sampled edges of curves, " + percent(check.curves_above_share) +
                         " have a larger separation angle than any point examined near them");
  }
  if (check.borders_above > 0) {
    mismatches.push_back(count_text(check.borders_above) +
                         " edges of rims and seams have a larger separation angle than each of their triangles");
  }
  if (check.borders >= few && 2 * check.borders_below > check.borders) {
    mismatches.push_back("of the " + count_text(check.borders) + " edges of rims and seams, " +
                         count_text(check.borders_below) +
                         " have a separation angle more than 20 degrees below the largest of their triangles");
  }
  if (check.rims >= few && check.low_rims_share > most_low_rims) {
    mismatches.push_back("of the length of rims and curves, " + percent(check.low_rims_share) +
                         " lies on rims of sheets without an angle above " + rounded_text(theta) +
                         " degrees; an axis at this theta has no such sheets");
  }
}

}  // namespace

AngleCheck check_angles(const MedialView& axis, const Incidence& incidence, const KnownSolid& solid,
                        const std::vector<std::uint32_t>& body_of, const CertificateOptions& options, double factor,
                        std::vector<std::string>& mismatches, const Context& context) {
  const Angles angles(axis, incidence, solid, body_of, believed_voxel(solid, options, factor));
  AngleCheck check;
  angles.compare_with_corners(check);
  angles.compare_with_triangles(check);
  if (options.theta && options.labels) angles.look_for_low_rims(*options.theta, check);
  throw_if_cancelled(context);
  angles.compare_with_surface(check, context);
  const std::size_t before = mismatches.size();
  explain(check, options.theta.value_or(0), solid.solid->grain() > 0 || solid.solid->slack() > 0, mismatches);
  check.holds = mismatches.size() == before;
  return check;
}

}  // namespace blum::verifier
