#include "axis/axis_parts.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>

namespace blum::detail {
namespace {

/// Returns the smallest value x for which at least the given share of the weight has values of at most x. The interval
/// from `low` to `high` is halved 50 times. Parts whose values lie entirely outside the current interval are dropped
/// from the sums.
double quantile(std::vector<LinearPart> parts, double share, double low, double high) {
  constexpr int halvings = 50;
  double missing = 0;  // weight
  for (const LinearPart& part : parts) missing += share * part.weight;
  for (int k = 0; k < halvings && low < high; ++k) {
    const double middle = low + 0.5 * (high - low);
    double sum = 0;
    for (const LinearPart& part : parts) sum += part.weight * part.share_up_to(middle);
    (sum >= missing ? high : low) = middle;
    std::erase_if(parts, [&](const LinearPart& part) {
      if (part.values[2] <= low) missing -= part.weight;
      return part.values[2] <= low || part.values[0] > high;
    });
  }
  return high;
}

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Returns which corner (0, 1, 2) of a triangle is the given vertex.
std::uint32_t corner_of(const std::array<std::uint32_t, 3>& triangle, std::uint32_t vertex) {
  return triangle[0] == vertex ? 0 : triangle[1] == vertex ? 1 : 2;
}

}  // namespace

double LinearPart::share_up_to(double value) const {
  const auto [a, b, c] = values;
  if (value >= c) return 1;
  if (value < a) return 0;
  if (is_edge) return (value - a) / (c - a);
  if (value < b) return (value - a) / (b - a) * ((value - a) / (c - a));
  return 1 - (c - value) / (c - b) * ((c - value) / (c - a));
}

void add_quantiles(std::vector<LinearPart> parts, AxisSpread& spread) {
  constexpr double low_share = 0.05;
  double total = 0;
  for (const LinearPart& part : parts) total += part.weight;
  if (!(total > 0)) {
    for (LinearPart& part : parts) part.weight = 1;
  }
  spread.low = quantile(parts, low_share, spread.minimum, spread.maximum);
  spread.median = quantile(std::move(parts), 0.5, spread.minimum, spread.maximum);
}

AxisParts::AxisParts(const Complex& axis, const Context& context)
    : view_(axis), incidence_(axis.view(), context), place_of_sheet_(sheet_count(axis), none) {
  number_sheets();
  find_parts();
  throw_if_cancelled(context);
  glue();
  throw_if_cancelled(context);
  look_around();
}

double AxisParts::edge_length(std::uint32_t edge) const {
  const auto& [a, b] = incidence_.edges()[edge];
  return length(view_.positions[b] - view_.positions[a]);
}

void AxisParts::number_sheets() {
  for (const std::int32_t sheet : view_.sheet) place_of_sheet_[static_cast<std::size_t>(sheet)] = 0;
  for (std::uint32_t sheet = 0; sheet < place_of_sheet_.size(); ++sheet) {
    if (place_of_sheet_[sheet] == none) continue;
    place_of_sheet_[sheet] = static_cast<std::uint32_t>(sheet_numbers_.size());
    sheet_numbers_.push_back(sheet);
  }
}

void AxisParts::find_parts() {
  parts_.reserve(incidence_.edges().size());
  for (std::size_t e = 0; e < incidence_.edges().size(); ++e) {
    const std::span<const std::uint32_t> at = incidence_.triangles_of_edge()[e];
    parts_.push_back(at.empty()                                 ? EdgePart::curve
                     : at.size() == 1                           ? EdgePart::rim
                     : at.size() > 2                            ? EdgePart::seam
                     : view_.sheet[at[0]] == view_.sheet[at[1]] ? EdgePart::inner
                                                                : EdgePart::crease);
  }
}

void AxisParts::glue() {
  detail::UnionFind corners(3 * view_.triangles.size());
  for (std::uint32_t e = 0; e < parts_.size(); ++e) {
    if (parts_[e] != EdgePart::inner) continue;
    const std::span<const std::uint32_t> at = incidence_.triangles_of_edge()[e];
    for (const std::uint32_t v : incidence_.edges()[e]) {
      corners.join(3 * at[0] + corner_of(view_.triangles[at[0]], v), 3 * at[1] + corner_of(view_.triangles[at[1]], v));
    }
  }
  cut_vertex_.resize(3 * view_.triangles.size());
  for (std::uint32_t c = 0; c < cut_vertex_.size(); ++c) cut_vertex_[c] = corners.find(c);
}

void AxisParts::look_around() {
  around_.resize(view_.positions.size());
  for (std::uint32_t e = 0; e < parts_.size(); ++e) {
    for (const std::uint32_t v : incidence_.edges()[e]) {
      around_[v].rims += parts_[e] == EdgePart::rim ? 1 : 0;
      around_[v].seams += parts_[e] == EdgePart::seam ? 1 : 0;
      around_[v].curves += parts_[e] == EdgePart::curve ? 1 : 0;
    }
  }
  std::vector<bool> has_border(cut_vertex_.size(), false);
  for (std::uint32_t t = 0; t < view_.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (parts_[incidence_.sides()[t][k]] == EdgePart::inner) continue;
      has_border[cut_vertex(t, k)] = true;
      has_border[cut_vertex(t, (k + 1) % 3)] = true;
    }
  }
  for (std::uint32_t c = 0; c < cut_vertex_.size(); ++c) {
    if (cut_vertex_[c] != c) continue;
    Around& around = around_[view_.triangles[c / 3][c % 3]];
    ++around.fans;
    around.has_closed_fan = around.has_closed_fan || !has_border[c];
  }
}

std::pair<bool, JunctionKind> AxisParts::junction(std::uint32_t vertex) const {
  const Around& a = around_[vertex];
  constexpr std::pair middle{false, JunctionKind::junction};
  if (a.seams == 0 && a.curves == 0) {
    if (a.fans == 1) return middle;
    return {true, a.fans == 0 ? JunctionKind::point : JunctionKind::contact};
  }
  if (a.seams == 2 && a.curves == 0 && a.rims == 0 && !a.has_closed_fan) return middle;
  if (a.seams == 0 && a.curves == 2 && a.fans == 0) return middle;
  if (a.seams == 0 && a.curves == 1 && a.fans < 2) {
    return {true, a.fans == 0 ? JunctionKind::curve_end : JunctionKind::curve_foot};
  }
  return {true, a.seams == 1 && a.curves == 0 ? JunctionKind::seam_end : JunctionKind::junction};
}

}  // namespace blum::detail
