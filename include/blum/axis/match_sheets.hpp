// Blum: the sheets that two medial axes have in common. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"

namespace blum {

struct SheetMatchOptions {
  /// Largest distance from the other axis at which a point of a sheet lies on the other axis, mesh units, >= 0.
  /// Default: a hundredth of the diagonal of the box around the sheets of both axes.
  std::optional<double> tolerance = {};
  /// A sheet is large if its area is at least this share of the area of its axis, 0 to 1.
  double large_share = 0.01;
  /// If true, the sheets of the column `patch_sheet` (label_patch_sheets()) are compared, which lie between pairs of
  /// patches. Triangles with the same patch on both sides are left out.
  bool of_patches = false;
  /// Number of points that are spread over each axis, 1 to 10,000,000. Each sheet gets points in proportion to its
  /// area, but at least 16.
  int points = 20'000;
};

template <>
struct Description<SheetMatchOptions> {
  static constexpr std::string_view name = "SheetMatchOptions";
  static constexpr std::string_view doc = "Options of the comparison of the sheets of two axes";
  static constexpr std::tuple members{
      Member{"tolerance", &SheetMatchOptions::tolerance, "mesh units",
             "largest distance at which a point of a sheet lies on the other axis; default: 1/100 of the diagonal of "
             "the box around both axes",
             Range::at_least(0)},
      Member{"large_share", &SheetMatchOptions::large_share, "",
             "smallest share of the axis's area that a large sheet has", Range::between(0, 1)},
      Member{"of_patches", &SheetMatchOptions::of_patches, "",
             "true to compare sheets of pairs of patches (column patch_sheet)"},
      Member{"points", &SheetMatchOptions::points, "",
             "number of points that are spread over each axis, with at least 16 points on each sheet",
             Range::between(1, 1e7)},
  };
};

/// Part of a sheet of one axis that lies on a single sheet of the other axis.
struct SheetOverlap {
  std::uint32_t sheet = 0;  ///< Number of the sheet of the other axis.
  double area = 0;          ///< Area of the part, square mesh units.
  double share = 0;         ///< Area of the part, divided by the area of the whole sheet, 0 to 1.
};

template <>
struct Description<SheetOverlap> {
  static constexpr std::string_view name = "SheetOverlap";
  static constexpr std::string_view doc = "Part of a sheet that lies on one sheet of the other axis";
  static constexpr std::tuple members{
      Member{"sheet", &SheetOverlap::sheet, "", "sheet of the other axis"},
      Member{"area", &SheetOverlap::area, "square mesh units", "area of the part"},
      Member{"share", &SheetOverlap::share, "", "area of the part, divided by the area of the whole sheet, 0 to 1"},
  };
};

/// Sheet of one axis, and the sheets of the other axis on which it lies.
struct MatchedSheet {
  std::uint32_t sheet = 0;  ///< Number of the sheet in its axis.
  double area = 0;
  bool large = false;
  /// Governors of the sheet: the patches of the surface on both sides, the smaller number first. The pair of patches
  /// with the largest part of the sheet is chosen. Unset if the axis has no columns `patch_a` and `patch_b`.
  std::optional<std::array<std::uint32_t, 2>> sides;
  double sides_share = 0;  ///< Share of the sheet's area that lies between the patches in `sides`, 0 to 1.
  /// Matching sheet of the other axis. More than half of the area of each of the two sheets lies on the other sheet.
  std::optional<std::uint32_t> partner;
  double on_partner = 0;  ///< Area of the part that lies on the partner.
  double on_other = 0;    ///< Area of the part that lies on any sheet of the other axis.
  /// Largest distance of a point of the sheet from the other axis; unset if the other axis has no sheets.
  std::optional<double> largest_distance;
  std::vector<SheetOverlap> overlaps;  ///< By descending area.
};

template <>
struct Description<MatchedSheet> {
  static constexpr std::string_view name = "MatchedSheet";
  static constexpr std::string_view doc = "Sheet of one axis, and the sheets of the other axis on which it lies";
  static constexpr std::tuple members{
      Member{"sheet", &MatchedSheet::sheet, "", "number of the sheet in its axis"},
      Member{"area", &MatchedSheet::area, "square mesh units", "area of the sheet"},
      Member{"large", &MatchedSheet::large, "", "true if the sheet is large"},
      Member{"sides", &MatchedSheet::sides, "",
             "patches of the surface on both sides, the smaller number first; none if the axis has no patches"},
      Member{"sides_share", &MatchedSheet::sides_share, "",
             "share of the area between the patches in 'sides', 0 to 1; no other pair of patches has a larger share"},
      Member{"partner", &MatchedSheet::partner, "",
             "matching sheet of the other axis: more than half of each of the two sheets lies on the other sheet"},
      Member{"on_partner", &MatchedSheet::on_partner, "square mesh units", "area of the part that lies on the partner"},
      Member{"on_other", &MatchedSheet::on_other, "square mesh units",
             "area of the part that lies on any sheet of the other axis"},
      Member{"largest_distance", &MatchedSheet::largest_distance, "mesh units",
             "largest distance of a point of the sheet from the other axis; none if the other axis has no sheets"},
      Member{"overlaps", &MatchedSheet::overlaps, "", "parts on sheets of the other axis, by descending area"},
  };
};

/// Sheets of one of two axes, by ascending number, and sums over them.
struct MatchedAxis {
  std::vector<MatchedSheet> sheets;
  std::size_t matched = 0;        ///< Sheets with a partner.
  std::size_t large = 0;          ///< Large sheets.
  std::size_t large_matched = 0;  ///< Large sheets with a partner.
  double area = 0;                ///< Area of all sheets.
  double matched_area = 0;        ///< Area of the parts that lie on partners.
  double matched_share = 0;       ///< `matched_area` divided by `area`; 0 if there is no area.
};

template <>
struct Description<MatchedAxis> {
  static constexpr std::string_view name = "MatchedAxis";
  static constexpr std::string_view doc = "Sheets of one of two axes, and sums over them";
  static constexpr std::tuple members{
      Member{"sheets", &MatchedAxis::sheets, "", "sheets, by ascending number"},
      Member{"matched", &MatchedAxis::matched, "", "number of sheets with a partner"},
      Member{"large", &MatchedAxis::large, "", "number of large sheets"},
      Member{"large_matched", &MatchedAxis::large_matched, "", "number of large sheets with a partner"},
      Member{"area", &MatchedAxis::area, "square mesh units", "area of all sheets"},
      Member{"matched_area", &MatchedAxis::matched_area, "square mesh units",
             "area of the parts of sheets that lie on partners"},
      Member{"matched_share", &MatchedAxis::matched_share, "", "matched_area divided by area; 0 if there is no area"},
  };
};

/// Comparison of the sheets of two axes.
struct SheetMatches {
  MatchedAxis first, second;
  double tolerance = 0;  ///< The tolerance that was used, mesh units.
  /// Number of pairs of partners whose patches are compared. Patches are compared if each of the two sheets has more
  /// than half of its area between two patches (MatchedSheet::sides).
  std::size_t compared_sides = 0;
  std::size_t same_sides = 0;  ///< Compared pairs with the same patches.
  /// True if each large sheet of both axes has a partner, and all compared patches of large sheets agree.
  bool same_large_sheets = false;
};

template <>
struct Description<SheetMatches> {
  static constexpr std::string_view name = "SheetMatches";
  static constexpr std::string_view doc = "Comparison of the sheets of two axes";
  static constexpr std::tuple members{
      Member{"first", &SheetMatches::first, "", "sheets of the first axis"},
      Member{"second", &SheetMatches::second, "", "sheets of the second axis"},
      Member{"tolerance", &SheetMatches::tolerance, "mesh units", "the tolerance that was used"},
      Member{"compared_sides", &SheetMatches::compared_sides, "",
             "pairs of partners whose patches are compared, because both sheets lie mostly between two patches"},
      Member{"same_sides", &SheetMatches::same_sides, "", "compared pairs with the same patches"},
      Member{"same_large_sheets", &SheetMatches::same_large_sheets, "",
             "true if each large sheet has a partner, and all compared patches of large sheets agree"},
  };
};

/// Compares the sheets of two medial axes of one solid, for example an axis of medial_axis() with an axis of
/// voronoi_complex().
///
/// Points are spread evenly over each sheet, by area. Each point stands for the same part of its sheet's area. A point
/// lies on the sheet of the closest triangle of the other axis, if this triangle is within the tolerance. Two sheets
/// are partners if more than half of the points of each sheet lie on the other sheet. So no sheet has two partners.
///
/// Shares are exact to about 1 / sqrt(n) for n points on a sheet, and much better where borders are short. Triangles
/// without area get no points, and a sheet without area has no partner. Curves are not compared.
/// The governors of two axes are comparable only if both axes were made from the same mesh with the same options of
/// patches.
/// @param first, second  axes with the column `sheet`. Any other complex with the column `sheet` may be given, too.
/// @return      the same result for any number of threads. If an axis has no sheets, no sheet has a partner.
/// @throws InvalidOption if an option is out of range, or if triangles lack the column `sheet` (with `of_patches`:
/// `patch_sheet`). InvalidMesh with the text of problem_of(); Cancelled. Cost: O(n log n) for n triangles, and about 2
/// us per point.
[[nodiscard]] SheetMatches match_sheets(const Complex& first, const Complex& second,
                                        const SheetMatchOptions& options = {}, const Context& context = {});

}  // namespace blum
