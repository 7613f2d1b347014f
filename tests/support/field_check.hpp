// Blum: checks of the precision of fields, node by node, for tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/core/random.hpp"
#include "blum/field/field.hpp"
#include "blum/field/reference.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/winding_number.hpp"

namespace blum::test {

inline double common_diagonal(const MeshView& mesh, const GridSpec& grid) {
  Box3 box = bounds(mesh);
  box.extend(bounds(grid));
  return box.diagonal();
}

inline Vec3d node_position(const GridSpec& grid, std::size_t node) {
  const auto n = static_cast<std::int64_t>(node);
  return grid.position(n % grid.size[0], n / grid.size[0] % grid.size[1], n / (grid.size[0] * grid.size[1]));
}

/// True if two fields have the same distances and sites, bit for bit.
inline bool same_bytes(const Field& a, const Field& b) {
  return a.distance.size() == b.distance.size() &&
         std::memcmp(a.distance.data(), b.distance.data(), a.distance.span().size_bytes()) == 0 &&
         std::memcmp(a.site.data(), b.site.data(), a.site.span().size_bytes()) == 0;
}

/// The largest errors over a set of nodes, as fractions of the diagonal.
struct FieldError {
  double distance = 0;          ///< | |distance| - exact |
  double site = 0;              ///< distance of the reported site minus the exact distance
  std::size_t wrong_signs = 0;  ///< at nodes further than 1e-6 of the diagonal from the surface
  std::size_t missing_sites = 0;
  std::size_t worst_node = 0;
};

inline std::vector<std::size_t> all_nodes(const GridSpec& grid) {
  std::vector<std::size_t> nodes(grid.node_count());
  for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k] = k;
  return nodes;
}

inline std::vector<std::size_t> random_nodes(const GridSpec& grid, std::size_t count, std::uint64_t seed = 1) {
  Random random(seed);
  std::vector<std::size_t> nodes(count);
  for (std::size_t& node : nodes) node = static_cast<std::size_t>(random.below(grid.node_count()));
  return nodes;
}

/// Compares a field with a source of exact distances.
/// @param exact      callable: query -> exact distance to the mesh, in double.
/// @param is_inside  callable: query -> bool, used only if the field is signed.
template <class Exact, class IsInside>
FieldError compare(const Field& field, const MeshView& mesh, const std::vector<std::size_t>& nodes, Exact exact,
                   IsInside is_inside) {
  const double diagonal = common_diagonal(mesh, field.grid);
  const reference::BruteForce reference(mesh);
  std::vector<FieldError> errors(64);
  parallel_for({.threads = 2}, nodes.size(), 256, "", [&](const WorkRange& range) {
    FieldError& error = errors[static_cast<std::size_t>(range.worker)];
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const std::size_t node = nodes[k];
      const Vec3d query = node_position(field.grid, node);
      const double truth = exact(query);
      const double measured = std::abs(static_cast<double>(field.distance[node]));
      double off = std::abs(measured - truth);
      if (field.band && truth >= *field.band * (1 - 1e-6)) {
        off = std::abs(measured - std::min(truth, *field.band));
      } else if (!field.site[node].has_value()) {
        ++error.missing_sites;
      } else if (field.site_ids == SiteIds::features) {
        error.site = std::max(error.site, (reference.site_distance(field.site[node], query) - truth) / diagonal);
      }
      if (off / diagonal > error.distance) {
        error.distance = off / diagonal;
        error.worst_node = node;
      }
      if (field.sign_rule != SignRule::none && truth > 1e-6 * diagonal &&
          std::signbit(field.distance[node]) != is_inside(query)) {
        ++error.wrong_signs;
      }
    }
  });
  FieldError total;
  for (const FieldError& error : errors) {
    if (error.distance > total.distance) total.worst_node = error.worst_node;
    total.distance = std::max(total.distance, error.distance);
    total.site = std::max(total.site, error.site);
    total.wrong_signs += error.wrong_signs;
    total.missing_sites += error.missing_sites;
  }
  return total;
}

/// Checks the precision that docs/theory/fields.md promises.
inline void expect_promise(const FieldError& error) {
  EXPECT_LE(error.distance, 1e-6) << "at node " << error.worst_node;
  EXPECT_LE(error.site, 1e-6);
  EXPECT_EQ(error.wrong_signs, 0U);
  EXPECT_EQ(error.missing_sites, 0U);
}

/// Compares with brute force over all triangles, segments and points, in double.
inline FieldError compare_with_brute_force(const Field& field, const MeshView& mesh,
                                           const std::vector<std::size_t>& nodes) {
  return compare(
      field, mesh, nodes,
      [&](const Vec3d& q) {
        double best = HUGE_VAL;
        for (const Triangle& t : mesh.triangles) {
          best = std::min(
              best, reference::triangle_distance(q, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
        }
        for (const Segment& s : mesh.segments) {
          best = std::min(best, reference::segment_distance(q, mesh.vertices[s[0]], mesh.vertices[s[1]]));
        }
        for (const std::uint32_t p : mesh.points) best = std::min(best, length(q - mesh.vertices[p]));
        return best;
      },
      [&](const Vec3d& q) { return reference::winding_number(mesh, q) > 0.5; });
}

/// Compares with the bounding-volume hierarchy, and signs with the hierarchy of winding numbers. Other tests check both
/// against brute force. They are fast enough for all nodes of large fields.
inline FieldError compare_with_bvh(const Field& field, const MeshView& mesh, const std::vector<std::size_t>& nodes) {
  const SiteTable sites(mesh);
  const Bvh bvh(mesh, sites);
  const WindingNumber winding(mesh, sites);
  return compare(
      field, mesh, nodes, [&](const Vec3d& q) { return bvh.nearest(q)->distance; },
      [&](const Vec3d& q) { return winding.is_inside(q); });
}

}  // namespace blum::test
