#include "blum/axis/match_sheets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr double default_tolerance = 0.01;  // of the diagonal of the box around both axes
constexpr std::size_t least_points = 16;    // on each sheet
constexpr std::size_t points_per_range = 256;

void check(const SheetMatchOptions& options) {
  const auto refuse = [](const char* name, double value, const char* range) {
    throw InvalidOption(std::string(name) + " is " + exact_text(value) + ", but must be " + range);
  };
  if (options.tolerance && !(*options.tolerance >= 0 && std::isfinite(*options.tolerance))) {
    refuse("tolerance", *options.tolerance, "at least 0");
  }
  if (!(options.large_share >= 0 && options.large_share <= 1)) refuse("large_share", options.large_share, "0 to 1");
  if (options.points < 1 || options.points > 10'000'000) refuse("points", options.points, "1 to 10,000,000");
}

/// Patches on both sides of a triangle.
using Sides = std::array<std::int32_t, 2>;

/// Returns the numbers of the sheets of all triangles; -1 for a triangle without one.
std::span<const std::int32_t> sheets_of(const Complex& axis, bool of_patches) {
  if (axis.triangles.empty()) return {};
  const std::string_view name = of_patches ? medial_columns::patch_sheet : medial_columns::sheet;
  if (axis.triangle_columns.find(name) != nullptr) return axis.triangle_columns.get<std::int32_t>(name);
  if (!of_patches) throw InvalidOption(missing_medial_column("triangles", name));
  throw InvalidOption("sheets of patches need the triangle column '" + std::string(name) +
                      "', which this axis does not have: make the axis with patches");
}

/// The triangles of an axis that belong to sheets.
class Sheets {
 public:
  Sheets(const Complex& axis, bool of_patches) : mesh_{axis.positions, {}, {}, {}} {
    validate(axis);
    const std::span<const std::int32_t> numbers = sheets_of(axis, of_patches);
    find_sheets(numbers);
    for (std::uint32_t t = 0; t < numbers.size(); ++t) {
      if (numbers[t] >= 0) add(axis, t, place_[static_cast<std::uint32_t>(numbers[t])]);
    }
    find_sides(axis);
  }

  [[nodiscard]] std::vector<MatchedSheet>& list() { return list_; }
  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  /// Returns the index in list() of a triangle of mesh().
  [[nodiscard]] std::uint32_t place_of(std::uint32_t triangle) const { return place_of_[triangle]; }
  /// Returns the triangles of mesh() that belong to a sheet, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& triangles_of(std::size_t place) const { return triangles_[place]; }
  [[nodiscard]] double area_of(std::uint32_t triangle) const { return areas_[triangle]; }

 private:
  /// Lists the sheets by ascending number.
  void find_sheets(std::span<const std::int32_t> numbers) {
    for (const std::int32_t number : numbers) {
      if (number >= 0) place_.try_emplace(static_cast<std::uint32_t>(number), 0);
    }
    for (auto& [number, place] : place_) {
      place = static_cast<std::uint32_t>(list_.size());
      list_.emplace_back().sheet = number;
    }
    triangles_.resize(list_.size());
  }

  void add(const Complex& axis, std::uint32_t t, std::uint32_t place) {
    const auto& [a, b, c] = axis.triangles[t];
    const Vec3d& at = axis.positions[a];
    areas_.push_back(0.5 * length(cross(axis.positions[b] - at, axis.positions[c] - at)));
    list_[place].area += areas_.back();
    triangles_[place].push_back(static_cast<std::uint32_t>(mesh_.triangles.size()));
    mesh_.triangles.push_back(axis.triangles[t]);
    place_of_.push_back(place);
    origin_.push_back(t);
  }

  /// Finds for each sheet the pair of patches with the largest area.
  void find_sides(const Complex& axis) {
    if (mesh_.triangles.empty()) return;
    for (const std::string_view name : medial_columns::patches) {
      if (axis.triangle_columns.find(name) == nullptr) return;
    }
    const auto low = axis.triangle_columns.get<std::int32_t>(medial_columns::patches[0]);
    const auto high = axis.triangle_columns.get<std::int32_t>(medial_columns::patches[1]);
    for (std::size_t s = 0; s < list_.size(); ++s) {
      std::map<Sides, double> areas;
      for (const std::uint32_t t : triangles_[s]) areas[{low[origin_[t]], high[origin_[t]]}] += areas_[t];
      const auto most = std::max_element(areas.begin(), areas.end(),
                                         [](const auto& a, const auto& b) { return a.second < b.second; });
      const auto& [sides, area] = *most;
      if (sides[0] < 0) continue;  // -1 stands for the outside
      list_[s].sides = {static_cast<std::uint32_t>(sides[0]), static_cast<std::uint32_t>(sides[1])};
      list_[s].sides_share = list_[s].area > 0 ? area / list_[s].area : 0;
    }
  }

  TriangleMesh mesh_;
  std::vector<MatchedSheet> list_;
  std::map<std::uint32_t, std::uint32_t> place_;  ///< by number of a sheet: its index in list_
  std::vector<std::uint32_t> place_of_, origin_;  ///< for each triangle of mesh_: its sheet, and its number in the axis
  std::vector<std::vector<std::uint32_t>> triangles_;
  std::vector<double> areas_;
};

/// Point of a sheet.
struct Sample {
  Vec3d position;
  std::uint32_t place = 0;  ///< index of the sheet
};

/// Returns the k-th of a sequence of points that fill a triangle evenly. The steps are powers of the plastic number, so
/// any first points are spread evenly (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences").
Vec3d point_in(const TriangleMesh& mesh, std::uint32_t triangle, std::size_t k) {
  constexpr double first_step = 0.754877666246692760;
  constexpr double second_step = 0.569840290998053266;
  const auto part = [k](double step) {
    const double at = 0.5 + static_cast<double>(k + 1) * step;
    return at - std::floor(at);
  };
  double u = part(first_step);
  double v = part(second_step);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const auto [a, b, c] = triangle_corners(mesh, triangle);
  return a + (b - a) * u + (c - a) * v;
}

/// Adds points of a sheet. Each point stands for the same area. The number of points on a triangle is proportional to
/// the triangle's area.
void add_samples(const Sheets& sheets, std::uint32_t place, double area, std::size_t count, std::vector<Sample>& out) {
  const double step = area / static_cast<double>(count);
  double passed = 0;
  std::size_t k = 0;
  for (const std::uint32_t t : sheets.triangles_of(place)) {
    passed += sheets.area_of(t);
    for (; k < count && (static_cast<double>(k) + 0.5) * step < passed; ++k) {
      out.push_back({point_in(sheets.mesh(), t, k), place});
    }
  }
}

std::vector<Sample> samples_of(Sheets& sheets, double whole_area, std::size_t count) {
  std::vector<Sample> out;
  for (std::uint32_t s = 0; s < sheets.list().size(); ++s) {
    const double area = sheets.list()[s].area;
    if (!(area > 0)) continue;
    const double wanted = std::ceil(static_cast<double>(count) * (area / whole_area));
    add_samples(sheets, s, area, std::max(least_points, static_cast<std::size_t>(wanted)), out);
  }
  return out;
}

/// For each point, the closest sheet of the other axis and the distance to it.
struct Closest {
  std::uint32_t place = none;
  double distance = std::numeric_limits<double>::infinity();
};

std::vector<Closest> closest_of(const std::vector<Sample>& samples, const Sheets& other, const Context& context) {
  std::vector<Closest> out(samples.size());
  if (other.mesh().triangles.empty()) return out;
  validate(other.mesh());
  const Bvh bvh(other.mesh(), SiteTable(other.mesh(), context), context);
  parallel_for(context, samples.size(), points_per_range, "match", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const auto found = bvh.nearest_wanted(samples[k].position, [](std::uint32_t) { return true; });
      if (found) out[k] = {other.place_of(found->primitive), found->distance};
    }
  });
  return out;
}

/// Adds to the sheets of an axis the parts of their area that lie on sheets of the other axis.
void add_overlaps(Sheets& sampled, double whole_area, Sheets& target, int points, double tolerance,
                  const Context& context) {
  const std::vector<Sample> samples = samples_of(sampled, whole_area, static_cast<std::size_t>(points));
  const std::vector<Closest> closest = closest_of(samples, target, context);
  std::vector<std::map<std::uint32_t, std::size_t>> on(sampled.list().size());
  std::vector<std::size_t> count(sampled.list().size(), 0);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const std::uint32_t own = samples[k].place;
    ++count[own];
    if (closest[k].place == none) continue;
    MatchedSheet& sheet = sampled.list()[own];
    sheet.largest_distance = std::max(sheet.largest_distance.value_or(0), closest[k].distance);
    if (closest[k].distance <= tolerance) ++on[own][closest[k].place];
  }
  for (std::size_t s = 0; s < on.size(); ++s) {
    MatchedSheet& sheet = sampled.list()[s];
    for (const auto& [place, points_there] : on[s]) {
      const double share = static_cast<double>(points_there) / static_cast<double>(count[s]);
      sheet.overlaps.push_back({target.list()[place].sheet, share * sheet.area, share});
      sheet.on_other += share * sheet.area;
    }
    std::sort(sheet.overlaps.begin(), sheet.overlaps.end(), [](const SheetOverlap& a, const SheetOverlap& b) {
      return std::tie(b.area, a.sheet) < std::tie(a.area, b.sheet);
    });
  }
}

/// Returns the sheet on which more than half of a sheet lies, or nullptr.
const SheetOverlap* most_of(const MatchedSheet& sheet) {
  const bool is_half = !sheet.overlaps.empty() && sheet.overlaps.front().share > 0.5;
  return is_half ? &sheet.overlaps.front() : nullptr;
}

MatchedSheet* find_sheet(std::vector<MatchedSheet>& list, std::uint32_t number) {
  const auto at =
      std::lower_bound(list.begin(), list.end(), number,
                       [](const MatchedSheet& sheet, std::uint32_t wanted) { return sheet.sheet < wanted; });
  return at != list.end() && at->sheet == number ? &*at : nullptr;
}

void find_partners(SheetMatches& out) {
  out.same_large_sheets = true;
  for (MatchedSheet& own : out.first.sheets) {
    const SheetOverlap* const there = most_of(own);
    MatchedSheet* const other = there == nullptr ? nullptr : find_sheet(out.second.sheets, there->sheet);
    const SheetOverlap* const back = other == nullptr ? nullptr : most_of(*other);
    if (back == nullptr || back->sheet != own.sheet) continue;
    own.partner = other->sheet;
    own.on_partner = there->area;
    other->partner = own.sheet;
    other->on_partner = back->area;
    if (!own.sides || !other->sides || std::min(own.sides_share, other->sides_share) <= 0.5) continue;
    ++out.compared_sides;
    if (own.sides == other->sides) {
      ++out.same_sides;
    } else if (own.large || other->large) {
      out.same_large_sheets = false;
    }
  }
}

void add_up(MatchedAxis& axis) {
  for (const MatchedSheet& sheet : axis.sheets) {
    if (sheet.large) ++axis.large;
    if (!sheet.partner) continue;
    ++axis.matched;
    if (sheet.large) ++axis.large_matched;
    axis.matched_area += sheet.on_partner;
  }
  axis.matched_share = axis.area > 0 ? axis.matched_area / axis.area : 0;
}

/// Computes the area of an axis, and finds its large sheets.
double find_large(std::vector<MatchedSheet>& sheets, double large_share) {
  double area = 0;
  for (const MatchedSheet& sheet : sheets) area += sheet.area;
  for (MatchedSheet& sheet : sheets) sheet.large = sheet.area >= large_share * area;
  return area;
}

double tolerance_for(const Sheets& first, const Sheets& second) {
  Box3 box;
  for (const Sheets* const sheets : {&first, &second}) {
    for (const auto& triangle : sheets->mesh().triangles) {
      for (const std::uint32_t v : triangle) box.extend(sheets->mesh().vertices[v]);
    }
  }
  return box.is_empty() ? 0 : default_tolerance * box.diagonal();
}

}  // namespace

SheetMatches match_sheets(const Complex& first, const Complex& second, const SheetMatchOptions& options,
                          const Context& context) {
  check(options);
  Sheets own(first, options.of_patches);
  Sheets other(second, options.of_patches);
  SheetMatches out;
  out.tolerance = options.tolerance.value_or(tolerance_for(own, other));
  out.first.area = find_large(own.list(), options.large_share);
  out.second.area = find_large(other.list(), options.large_share);
  add_overlaps(own, out.first.area, other, options.points, out.tolerance, context);
  add_overlaps(other, out.second.area, own, options.points, out.tolerance, context);
  out.first.sheets = std::move(own.list());
  out.second.sheets = std::move(other.list());
  find_partners(out);
  for (MatchedAxis* const axis : {&out.first, &out.second}) {
    add_up(*axis);
    if (axis->large_matched < axis->large) out.same_large_sheets = false;
  }
  return out;
}

}  // namespace blum
