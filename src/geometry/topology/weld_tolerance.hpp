// Blum: the part of welding that compares distances. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "blum/core/vec3.hpp"

namespace blum {

/// Joins the clusters of vertices whose distance is at most `tolerance`.
/// @param cluster  for each vertex the smallest vertex at exactly its place; becomes the smallest of its cluster.
void join_close_vertices(std::span<const Vec3d> vertices, double tolerance, std::span<std::uint32_t> cluster);

}  // namespace blum
