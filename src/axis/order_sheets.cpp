#include "blum/axis/order_sheets.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "blum/complex/medial_columns.hpp"

namespace blum::detail {
namespace {

/// A key is considered if its area is at least this share of the largest area of a key. In symmetrical sheets, one area
/// is often equal to, twice or three times another. This share is far from 1, 1/2 and 1/3, so rounding decides nothing.
constexpr double good_part = 0.41;

/// Weight of vertices with a footprint on an edge between patches. It is below 1 because the footprint could belong to
/// either patch.
constexpr double weight_of_shared = 0.2;
/// Sheets with less than this share of the total area get the last numbers. Such a sheet may exist on one grid only,
/// and would otherwise change the numbers of larger sheets.
constexpr double least_part = 0.001;

constexpr std::uint64_t unknown = std::numeric_limits<std::uint64_t>::max();

/// Sums of areas by key.
class Areas {
 public:
  void add(std::uint64_t key, double area) { areas_[key] += area; }

  /// Returns the smallest key whose area is at least the share `good_part` of the largest; unknown if no key has area.
  [[nodiscard]] std::uint64_t smallest() const {
    double most = 0;
    for (const auto& [key, area] : areas_) most = std::max(most, area);
    std::uint64_t least = unknown;
    for (const auto& [key, area] : areas_) {
      if (area >= good_part * most) least = std::min(least, key);
    }
    return least;
  }

 private:
  std::unordered_map<std::uint64_t, double> areas_;
};

double area_of(const Complex& axis, std::uint32_t triangle) {
  const auto& [a, b, c] = axis.triangles[triangle];
  const Vec3d& at = axis.positions[a];
  return 0.5 * length(cross(axis.positions[b] - at, axis.positions[c] - at));
}

std::span<const std::int32_t> sheets_of(const Complex& axis) {
  return axis.triangle_columns.get<std::int32_t>(medial_columns::sheet);
}

/// Gives sheets new numbers.
/// @param order  old numbers of the sheets, in the order of the new ones.
void renumber(Complex& axis, const std::vector<std::uint32_t>& order) {
  std::vector<std::int32_t> number(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) number[order[k]] = static_cast<std::int32_t>(k);
  for (std::int32_t& sheet : axis.triangle_columns.edit<std::int32_t>(medial_columns::sheet)) {
    sheet = number[static_cast<std::size_t>(sheet)];
  }
}

/// Traits that distinguish sheets.
struct Traits {
  double area = 0;
  Vec3d centroid;
  bool is_crumb = false;
  std::uint64_t pair = unknown;
  /// Weighted sum of the centroid's distances from all anchors. Mirrored sheets may be equally far from one anchor, but
  /// their weighted sums differ.
  double distance = 0;
};

class Sorter {
 public:
  Sorter(const Complex& axis, const PatchNumbers& patches)
      : axis_(axis), patches_(patches), sheets_(sheet_count(axis)) {
    find_pairs();
    measure();
  }

  std::vector<std::uint32_t> sorted() const {
    std::vector<std::uint32_t> order(sheets_.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto rank = [&](std::uint32_t s) {
      return std::make_tuple(sheets_[s].is_crumb, sheets_[s].pair, sheets_[s].distance, s);
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return rank(a) < rank(b); });
    return order;
  }

 private:
  /// The pair of patches of a vertex's footprints (the smaller number in the high bits), and the vertex's weight in its
  /// sheet.
  struct Sides {
    std::uint64_t pair = unknown;  ///< unknown without two footprints on known patches
    double weight = 1;
  };
  [[nodiscard]] std::vector<Sides> sides_of_vertices() const {
    const MedialView view(axis_);
    std::vector<Sides> sides(axis_.positions.size());
    for (std::size_t v = 0; v < sides.size(); ++v) {
      if (view.footprint(v, 0) == view.footprint(v, 1)) continue;
      const SiteId first = view.site(v, 0);
      const SiteId second = view.site(v, 1);
      const auto [low, high] = std::minmax({patches_.at(first), patches_.at(second)});
      if (high != PatchNumbers::none) sides[v].pair = std::uint64_t{low} << 32U | high;
      if (patches_.is_shared(first) || patches_.is_shared(second)) sides[v].weight = weight_of_shared;
    }
    return sides;
  }

  void find_pairs() {
    const std::vector<Sides> sides = sides_of_vertices();
    const std::span<const std::int32_t> sheet_of = sheets_of(axis_);
    std::vector<Areas> areas(sheets_.size());
    for (std::uint32_t t = 0; t < axis_.triangles.size(); ++t) {
      const auto sheet = static_cast<std::size_t>(sheet_of[t]);
      const double third = area_of(axis_, t) / 3;
      for (const std::uint32_t v : axis_.triangles[t]) {
        if (sides[v].pair != unknown) areas[sheet].add(sides[v].pair, sides[v].weight * third);
        sheets_[sheet].centroid += third * axis_.positions[v];
      }
      sheets_[sheet].area += 3 * third;
    }
    for (std::size_t s = 0; s < areas.size(); ++s) sheets_[s].pair = areas[s].smallest();
  }

  void measure() {
    double all = 0;
    for (const Traits& sheet : sheets_) all += sheet.area;
    for (Traits& sheet : sheets_) {
      if (sheet.area > 0) sheet.centroid = sheet.centroid / sheet.area;
      sheet.is_crumb = !(sheet.area >= least_part * all);
      double weight = 1;
      for (const Vec3d& anchor : patches_.anchors()) {
        sheet.distance += weight * length(sheet.centroid - anchor);
        weight *= std::numbers::phi - 1;
      }
    }
  }

  const Complex& axis_;
  const PatchNumbers& patches_;
  std::vector<Traits> sheets_;
};

}  // namespace

void order_sheets(Complex& axis, const PatchNumbers& patches) {
  if (patches.is_empty()) return;
  renumber(axis, Sorter(axis, patches).sorted());
}

void order_sheets_as(Complex& axis, std::span<const std::int32_t> before) {
  const std::span<const std::int32_t> sheet_of = sheets_of(axis);
  std::vector<Areas> areas(sheet_count(axis));
  for (std::uint32_t t = 0; t < axis.triangles.size(); ++t) {
    areas[static_cast<std::size_t>(sheet_of[t])].add(static_cast<std::uint64_t>(before[t]), area_of(axis, t));
  }
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  for (std::uint32_t s = 0; s < areas.size(); ++s) order.emplace_back(areas[s].smallest(), s);
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> sheets;
  for (const auto& [first, sheet] : order) sheets.push_back(sheet);
  renumber(axis, sheets);
}

}  // namespace blum::detail
