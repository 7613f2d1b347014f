// Blum: a small medial axis with all kinds of elements. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "blum/io/medial_io.hpp"
#include "medial_rows.hpp"

namespace blum::test {

/// Three triangles around a seam (one sheet each), their rims, two curve edges that begin at the seam, and an isolated
/// vertex. All numbers differ, and few have a short decimal or binary form.
inline AxisRows sample_complex() {
  AxisRows complex;
  const auto add = [&](const Vec3d& position, MedialRole role) {
    const double i = static_cast<double>(complex.vertices.size());
    VertexRow v;
    v.position = position;
    v.radius = 1.0 / (3.0 + i);
    v.footprints = {position + Vec3d{0, 0, v.radius}, position - Vec3d{std::sin(i), 1e-9, v.radius * 1e6}};
    v.sites = {SiteId(static_cast<std::uint32_t>(7 * complex.vertices.size())), SiteId(0x7fffffff)};
    v.separation_angle = 180.0 / (1.0 + i);
    v.role = role;
    complex.vertices.push_back(v);
  };
  add({0.1, 1.0 / 3.0, -1e-7}, MedialRole::junction);
  add({0, 0, 1}, MedialRole::junction);
  add({1e6, 0, 0.5}, MedialRole::rim);
  add({-1, 1.0 / 7.0, 0.5}, MedialRole::rim);
  add({-1, -1, 0.5}, MedialRole::rim);
  add({0, 0, 2}, MedialRole::curve);
  add({0, 0, 3 + 1e-15}, MedialRole::curve);
  add({5, 5, 5}, MedialRole::curve);
  complex.vertices[7].sites = {SiteId::none(), SiteId::none()};
  complex.edges = {
      {{0, 1}, 120.1F, MedialRole::seam}, {{0, 2}, 20.2F, MedialRole::rim},   {{2, 1}, 30.3F, MedialRole::rim},
      {{1, 3}, 40.4F, MedialRole::rim},   {{3, 0}, 50.5F, MedialRole::rim},   {{0, 4}, 60.6F, MedialRole::rim},
      {{1, 4}, 70.7F, MedialRole::rim},   {{5, 1}, 80.8F, MedialRole::curve}, {{5, 6}, 0.0F, MedialRole::curve}};
  complex.triangles = {{{0, 2, 1}, 1.1F, 0}, {{3, 0, 1}, 2.2F, 2}, {{1, 0, 4}, 0.0F, 1}};
  complex.sheet_count = 3;
  return complex;
}

inline MedialMetadata sample_metadata() {
  MedialMetadata metadata;
  metadata.source = "models/\xC3\xA9t\xC3\xA9 \"1\".obj";
  metadata.version = "1.2.3";
  metadata.site_ids = SiteIds::voxels;
  metadata.theta = 1.0 / 3.0;
  metadata.lambda = 1e-7;
  metadata.spacing = 0.1;
  metadata.solid_rule = "winding";
  GridSpec grid;
  grid.origin = {1e6, -2.5, 1.0 / 7.0};
  grid.spacing = {0.1, 1.0 / 3.0, 1e-7};
  grid.size = {4, 3, 2};
  grid.direction.columns[0] = {0, 1, 0};
  grid.direction.columns[1] = {0.6, 0, -0.8};
  grid.direction.columns[2] = {-0.8, 0, -0.6};
  metadata.grid = grid;
  metadata.label = -9007199254740993;  // not representable as double
  metadata.weld = 1e-6;
  return metadata;
}

}  // namespace blum::test
