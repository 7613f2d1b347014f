// Blum: checks of fields of order 2, node by node, for tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/field/field.hpp"
#include "blum/field/reference.hpp"
#include "support/field_check.hpp"

namespace blum::test {

/// For each vertex, the smallest vertex of its component, by a simple slow search.
inline std::vector<std::uint32_t> slow_parts(const MeshView& mesh) {
  std::vector<std::uint32_t> part(mesh.vertices.size());
  for (std::uint32_t v = 0; v < part.size(); ++v) part[v] = v;
  const SiteTable sites(mesh);
  for (bool changed = true; changed;) {
    changed = false;
    for (const Segment& edge : sites.edges()) {
      const std::uint32_t least = std::min(part[edge[0]], part[edge[1]]);
      changed = changed || part[edge[0]] != least || part[edge[1]] != least;
      part[edge[0]] = part[edge[1]] = least;
    }
  }
  return part;
}

/// The largest errors of the second order. Distances are fractions of the diagonal.
struct SecondError {
  double distance = 0;
  double site = 0;               ///< distance of the reported site minus that of the closest allowed second site
  std::size_t not_allowed = 0;   ///< number of second sites that share a label with the first
  std::size_t wrong_absent = 0;  ///< number of nodes with an extra or missing second site, or a wrong value
  std::size_t worst_node = 0;
};

inline void merge(SecondError& all, const SecondError& one) {
  if (one.distance > all.distance) all.worst_node = one.worst_node;
  all.distance = std::max(all.distance, one.distance);
  all.site = std::max(all.site, one.site);
  all.not_allowed += one.not_allowed;
  all.wrong_absent += one.wrong_absent;
}

inline void check_second(const Field& field, const reference::BruteForce& brute, std::span<const std::uint32_t> labels,
                         double diagonal, std::size_t node, SecondError& error) {
  const SiteId first = field.site[node];
  const SiteId second = field.site2[node];
  const float limit = field.band ? static_cast<float>(*field.band) : HUGE_VALF;
  const Vec3d query = node_position(field.grid, node);
  std::optional<reference::Nearest> truth;
  if (first.has_value()) truth = brute.second(query, first, labels);
  if (!second.has_value() && field.distance2[node] != limit) ++error.wrong_absent;
  if (!truth) {
    if (second.has_value()) ++error.wrong_absent;
    return;
  }
  if (!second.has_value()) {
    if (!field.band || truth->distance < *field.band * (1 - 1e-6) - 1e-6 * diagonal) ++error.wrong_absent;
    return;
  }
  if (brute.share_label(first, second, labels)) ++error.not_allowed;
  const double off = std::abs(static_cast<double>(field.distance2[node]) - truth->distance) / diagonal;
  if (off > error.distance) {
    error.distance = off;
    error.worst_node = node;
  }
  error.site = std::max(error.site, (brute.site_distance(second, query) - truth->distance) / diagonal);
}

/// Compares the second order with brute force over all sites, given the first sites that the field reports.
/// @param labels  labels of the rule, one per vertex; empty: each vertex has its own label.
inline SecondError compare_second(const Field& field, const MeshView& mesh, std::span<const std::uint32_t> labels,
                                  const std::vector<std::size_t>& nodes) {
  const reference::BruteForce brute(mesh);
  const double diagonal = common_diagonal(mesh, field.grid);
  std::vector<SecondError> errors(64);
  parallel_for({.threads = 2}, nodes.size(), 16, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      check_second(field, brute, labels, diagonal, nodes[k], errors[static_cast<std::size_t>(range.worker)]);
    }
  });
  SecondError all;
  for (const SecondError& error : errors) merge(all, error);
  return all;
}

inline void expect_promise(const SecondError& error) {
  EXPECT_LE(error.distance, 1e-6) << "at node " << error.worst_node;
  EXPECT_LE(error.site, 1e-6);
  EXPECT_EQ(error.not_allowed, 0U);
  EXPECT_EQ(error.wrong_absent, 0U);
}

inline bool same_second_bytes(const Field& a, const Field& b) {
  return a.distance2.size() == b.distance2.size() && a.site2.size() == b.site2.size() &&
         std::memcmp(a.distance2.data(), b.distance2.data(), a.distance2.span().size_bytes()) == 0 &&
         std::memcmp(a.site2.data(), b.site2.data(), a.site2.span().size_bytes()) == 0;
}

}  // namespace blum::test
