#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/union_find.hpp"
#include "certificate/checks.hpp"

namespace blum::verifier {
namespace {

constexpr std::uint32_t no_sheet = 0xffffffffU;
constexpr std::uint32_t many_sheets = 0xfffffffeU;

/// Numbers of edges at a vertex, and the sheet around it.
struct Around {
  std::uint32_t rims = 0, seams = 0, curves = 0;
  std::uint32_t sheet = no_sheet;
};

/// Returns the role of an edge with this number of triangles; MedialRole::sheet for an edge that must not be listed.
MedialRole role_of_edge(std::size_t triangles) {
  switch (triangles) {
    case 0:
      return MedialRole::curve;
    case 1:
      return MedialRole::rim;
    case 2:
      return MedialRole::sheet;
    default:
      return MedialRole::seam;
  }
}

MedialRole role_of_vertex(const Around& at) {
  const bool has_surface = at.sheet != no_sheet;
  if (at.curves > 0) {
    const bool is_alone = !has_surface && at.seams == 0 && at.rims == 0;
    return is_alone && at.curves <= 2 ? MedialRole::curve : MedialRole::junction;
  }
  if (at.seams > 0) return at.seams == 2 && at.rims == 0 ? MedialRole::seam : MedialRole::junction;
  if (!has_surface) return MedialRole::curve;
  if (at.sheet == many_sheets || at.rims > 2) return MedialRole::junction;
  return at.rims > 0 ? MedialRole::rim : MedialRole::sheet;
}

/// Returns the number of cells that repeat the vertices of an earlier cell.
template <class Cell>
std::size_t doubled(std::span<const Cell> cells) {
  std::vector<Cell> sorted(cells.begin(), cells.end());
  for (Cell& cell : sorted) std::sort(cell.begin(), cell.end());
  std::sort(sorted.begin(), sorted.end());
  const auto distinct = std::unique(sorted.begin(), sorted.end()) - sorted.begin();
  return cells.size() - static_cast<std::size_t>(distinct);
}

class Labels {
 public:
  Labels(const MedialView& axis, const Incidence& incidence, double factor)
      : axis_(axis), incidence_(incidence), factor_(factor) {}

  /// Checks that the right edges are listed, with the right roles.
  /// @param seam  receives the place and the sheets of the first seam edge with fewer than three triangles.
  void check_edges(LabelCheck& check, std::string& seam) const {
    const std::size_t count = incidence_.edges().size();
    std::vector<bool> is_listed(count, false);
    for (std::size_t n = 0; n < axis_.edges.size(); ++n) {
      const std::uint32_t e = incidence_.edge_of_listed()[n];
      is_listed[e] = true;
      const MedialRole role = role_of_edge(triangles_at(e));
      if (axis_.edge_role(n) == MedialRole::seam && role != MedialRole::seam && seam.empty()) seam = seam_text(e);
      if (role == MedialRole::sheet) {
        ++check.inner_listed;
      } else if (axis_.edge_role(n) != role) {
        ++check.edge_roles;
      }
    }
    for (std::uint32_t e = 0; e < count; ++e) {
      if (!is_listed[e] && triangles_at(e) != 2) ++check.unlisted;
    }
  }

  void check_vertices(LabelCheck& check) const {
    std::vector<Around> around(axis_.positions.size());
    for (std::uint32_t e = 0; e < incidence_.edges().size(); ++e) {
      const MedialRole role = role_of_edge(triangles_at(e));
      for (const std::uint32_t v : incidence_.edges()[e]) {
        around[v].curves += role == MedialRole::curve ? 1 : 0;
        around[v].rims += role == MedialRole::rim ? 1 : 0;
        around[v].seams += role == MedialRole::seam ? 1 : 0;
      }
    }
    for (std::size_t t = 0; t < axis_.triangles.size(); ++t) {
      const auto sheet = static_cast<std::uint32_t>(axis_.sheet[t]);
      for (const std::uint32_t v : axis_.triangles[t]) {
        around[v].sheet = around[v].sheet == no_sheet || around[v].sheet == sheet ? sheet : many_sheets;
      }
    }
    for (std::size_t v = 0; v < around.size(); ++v) {
      if (axis_.role(v) != role_of_vertex(around[v])) ++check.vertex_roles;
    }
  }

  /// Checks that each sheet is connected, and ends only at rims and seams.
  void check_sheets(LabelCheck& check) const {
    std::vector<bool> is_on_seam(axis_.positions.size(), false);
    for (std::uint32_t e = 0; e < incidence_.edges().size(); ++e) {
      if (triangles_at(e) <= 2) continue;
      for (const std::uint32_t v : incidence_.edges()[e]) is_on_seam[v] = true;
    }
    detail::UnionFind joined(axis_.triangles.size());
    for (std::uint32_t e = 0; e < incidence_.edges().size(); ++e) {
      if (triangles_at(e) != 2) continue;
      const std::span<const std::uint32_t> both = incidence_.triangles_of_edge()[e];
      const auto& [a, b] = incidence_.edges()[e];
      if (axis_.sheet[both[0]] == axis_.sheet[both[1]]) {
        joined.join(both[0], both[1]);
      } else if (!is_on_seam[a] && !is_on_seam[b]) {
        ++check.parted;
      }
    }
    count_torn(joined, check);
  }

 private:
  [[nodiscard]] std::size_t triangles_at(std::uint32_t edge) const {
    return incidence_.triangles_of_edge()[edge].size();
  }

  /// Returns the place of an edge, and the sheets of its triangles.
  [[nodiscard]] std::string seam_text(std::uint32_t edge) const {
    const auto& [a, b] = incidence_.edges()[edge];
    std::string text = "a seam at " + place_text((axis_.positions[a] + axis_.positions[b]) / (2 * factor_)) + " has ";
    const std::span<const std::uint32_t> at = incidence_.triangles_of_edge()[edge];
    if (at.empty()) return text + "no sheets; a seam needs three";
    text += at.size() == 1 ? "only the sheet " : "only the sheets ";
    text += std::to_string(axis_.sheet[at[0]]);
    if (at.size() > 1) text += " and " + std::to_string(axis_.sheet[at[1]]);
    return text + "; it needs three";
  }

  void count_torn(detail::UnionFind& joined, LabelCheck& check) const {
    std::vector<std::array<std::uint32_t, 2>> parts;  // sheet, and the first triangle of a connected part of it
    for (std::uint32_t t = 0; t < axis_.triangles.size(); ++t) {
      if (joined.find(t) == t) parts.push_back({static_cast<std::uint32_t>(axis_.sheet[t]), t});
    }
    std::sort(parts.begin(), parts.end());
    const std::size_t numbers = parts.empty() ? 0 : std::size_t{parts.back()[0]} + 1;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const bool is_first = k == 0 || parts[k - 1][0] != parts[k][0];
      check.sheets += is_first ? 1 : 0;
      check.torn += is_first && k + 1 < parts.size() && parts[k + 1][0] == parts[k][0] ? 1 : 0;
    }
    check.gaps = numbers - check.sheets;
  }

  const MedialView& axis_;
  const Incidence& incidence_;
  double factor_;  ///< lengths are this many times the caller's
};

void explain(const LabelCheck& check, std::vector<std::string>& mismatches) {
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) mismatches.push_back(count_text(count) + " " + what);
  };
  add(check.doubled, "cells are listed twice");
  add(check.inner_listed, "listed edges lie inside sheets");
  add(check.unlisted, "edges of rims and seams are not listed");
  add(check.edge_roles, "edges have a role that does not fit their triangles");
  add(check.vertex_roles, "vertices have a role that does not fit their edges and sheets");
  add(check.gaps, "sheet numbers below the largest are not used");
  add(check.torn, "sheets are not connected through edges of two triangles");
  add(check.parted, "edges that are not seams separate two sheets");
}

}  // namespace

LabelCheck check_labels(const MedialView& axis, const Incidence& incidence, double factor,
                        std::vector<std::string>& mismatches, const Context& context) {
  LabelCheck check;
  check.doubled = doubled(axis.edges) + doubled(axis.triangles);
  std::string seam;
  const Labels labels(axis, incidence, factor);
  labels.check_edges(check, seam);
  throw_if_cancelled(context);
  labels.check_vertices(check);
  labels.check_sheets(check);
  const std::size_t before = mismatches.size();
  explain(check, mismatches);
  if (!seam.empty()) mismatches.push_back(seam);
  check.holds = mismatches.size() == before;
  return check;
}

}  // namespace blum::verifier
