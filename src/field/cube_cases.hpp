// Blum: how the tetrahedra of a cube are cut by a level. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace blum {

/// An edge of one of the six tetrahedra around the diagonal of a cube. Corner c of a cube is at (c & 1, c >> 1 & 1,
/// c >> 2 & 1); an edge goes from corner `from` to corner `from | step`, which share no bits.
struct CubeEdge {
  std::uint8_t from = 0;
  std::uint8_t step = 0;  ///< 1 to 7
};

/// The triangles that part the corners inside from those outside, facing outside.
struct CubeCase {
  std::uint8_t triangle_count = 0;
  std::array<std::array<CubeEdge, 3>, 12> triangles{};  ///< two at most in each tetrahedron
};

namespace detail {

struct Corner3 {
  int x, y, z;
};

/// The middle of an edge between two corners, doubled.
constexpr Corner3 doubled_middle(unsigned a, unsigned b) {
  return {static_cast<int>((a & 1U) + (b & 1U)), static_cast<int>((a >> 1 & 1U) + (b >> 1 & 1U)),
          static_cast<int>((a >> 2 & 1U) + (b >> 2 & 1U))};
}

constexpr Corner3 minus(const Corner3& a, const Corner3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// Six times the signed volume of p, q, r and the origin.
constexpr int volume(const Corner3& p, const Corner3& q, const Corner3& r) {
  return p.x * (q.y * r.z - q.z * r.y) + p.y * (q.z * r.x - q.x * r.z) + p.z * (q.x * r.y - q.y * r.x);
}

/// A corner inside and one outside.
using Pair = std::array<unsigned, 2>;

/// The corners of a tetrahedron, ascending, are joined by steps: the smaller one's bits are among the larger one's.
constexpr CubeEdge edge_of(const Pair& pair) {
  const unsigned from = pair[0] & pair[1];
  return {static_cast<std::uint8_t>(from), static_cast<std::uint8_t>((pair[0] | pair[1]) ^ from)};
}

/// Adds the triangle through the middles of three edges, turned towards the outer end of the first.
constexpr void add_triangle(CubeCase& cube, const Pair& a, const Pair& b, const Pair& c) {
  const Corner3 p = doubled_middle(a[0], a[1]);
  const Corner3 q = doubled_middle(b[0], b[1]);
  const Corner3 r = doubled_middle(c[0], c[1]);
  const Corner3 outer = doubled_middle(a[1], a[1]);
  const bool faces_outer = volume(minus(q, p), minus(r, p), minus(outer, p)) > 0;
  cube.triangles[cube.triangle_count++] = {edge_of(a), edge_of(faces_outer ? b : c), edge_of(faces_outer ? c : b)};
}

constexpr void add_tetrahedron(CubeCase& cube, unsigned inside_corners, const std::array<unsigned, 4>& corners) {
  std::array<unsigned, 4> in{};
  std::array<unsigned, 4> out{};
  std::size_t ins = 0;
  std::size_t outs = 0;
  for (const unsigned corner : corners) ((inside_corners >> corner & 1U) != 0 ? in[ins++] : out[outs++]) = corner;
  if (ins == 1) add_triangle(cube, {in[0], out[0]}, {in[0], out[1]}, {in[0], out[2]});
  if (ins == 3) add_triangle(cube, {in[0], out[0]}, {in[1], out[0]}, {in[2], out[0]});
  if (ins == 2) {
    add_triangle(cube, {in[0], out[0]}, {in[0], out[1]}, {in[1], out[1]});
    add_triangle(cube, {in[0], out[0]}, {in[1], out[1]}, {in[1], out[0]});
  }
}

/// Each tetrahedron goes from corner 0 to corner 7 along the three axes in one of their six orders.
constexpr CubeCase make_cube_case(unsigned inside_corners) {
  CubeCase cube;
  for (unsigned first = 0; first < 3; ++first) {
    for (unsigned second = 0; second < 3; ++second) {
      if (second == first) continue;
      add_tetrahedron(cube, inside_corners, {0, 1U << first, 1U << first | 1U << second, 7});
    }
  }
  return cube;
}

constexpr std::array<CubeCase, 256> make_cube_cases() {
  std::array<CubeCase, 256> cases{};
  for (unsigned inside_corners = 0; inside_corners < 256; ++inside_corners) {
    cases[inside_corners] = make_cube_case(inside_corners);
  }
  return cases;
}

}  // namespace detail

/// By the corners that are inside: bit c is corner c.
inline constexpr std::array<CubeCase, 256> cube_cases = detail::make_cube_cases();

}  // namespace blum
