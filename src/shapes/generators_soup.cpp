#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/shapes/generators.hpp"
#include "shapes/generator_parts.hpp"

namespace blum {
namespace {

/// Appends move(x) for each item x of `added`. `added` may be a part of `all`.
template <class T, class Move>
void extend(std::vector<T>& all, std::span<const T> added, const Move& move) {
  std::vector<T> moved(added.size());
  std::transform(added.begin(), added.end(), moved.begin(), move);
  all.insert(all.end(), moved.begin(), moved.end());
}

using detail::require;
using detail::require_positive;
using detail::require_triangle_count;

using Corners = std::array<Vec3d, 3>;

Vec3d center_in(Random& random, double size) {
  return (random.in_cube() - Vec3d{0.5, 0.5, 0.5}) * size;
}

Corners ordinary(Random& random, const SoupOptions& options) {
  const Vec3d center = center_in(random, options.size);
  Corners corners;
  for (Vec3d& p : corners) p = center + random.in_ball() * options.triangle_size;
  return corners;
}

/// Returns a triangle with one short side. The limit of its length is random: 1e-9 to 1e-1 times options.triangle_size.
Corners needle(Random& random, const SoupOptions& options) {
  Corners corners = ordinary(random, options);
  corners[2] = corners[1] + random.in_ball() * (options.triangle_size * std::pow(10.0, -random.uniform(1, 9)));
  return corners;
}

/// Returns a triangle with one corner close to the opposite side.
Corners sliver(Random& random, const SoupOptions& options) {
  Corners corners = ordinary(random, options);
  const Vec3d on_side = corners[0] + (corners[1] - corners[0]) * random.uniform();
  corners[2] = on_side + random.in_ball() * (options.triangle_size * std::pow(10.0, -random.uniform(1, 9)));
  return corners;
}

/// Returns a copy of a random earlier triangle, with its corners in a random order.
Corners copy_of_earlier(Random& random, const TriangleMesh& mesh, const SoupOptions& options) {
  if (mesh.triangles.empty()) return ordinary(random, options);
  const Triangle& source = mesh.triangles[random.below(mesh.triangles.size())];
  const std::size_t turn = random.below(3);
  const bool mirrored = random.below(2) == 1;
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) corners[mirrored ? 2 - k : k] = mesh.vertices[source[(k + turn) % 3]];
  return corners;
}

Corners on_common_plane(Random& random, const SoupOptions& options) {
  Corners corners = ordinary(random, options);
  for (Vec3d& p : corners) p.z = 0.125 * options.size;
  return corners;
}

Corners degenerate(Random& random, const SoupOptions& options) {
  Corners corners = ordinary(random, options);
  corners[2] = corners[1];
  if (random.below(2) == 1) corners[1] = corners[2] = corners[0];
  return corners;
}

Corners awkward(Random& random, const TriangleMesh& mesh, const SoupOptions& options) {
  switch (random.below(5)) {
    case 0:
      return needle(random, options);
    case 1:
      return sliver(random, options);
    case 2:
      return copy_of_earlier(random, mesh, options);
    case 3:
      return on_common_plane(random, options);
    default:
      return degenerate(random, options);
  }
}

TriangleMesh subdivide_once(const TriangleMesh& mesh) {
  const SiteTable sites(mesh);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  TriangleMesh finer;
  finer.vertices = mesh.vertices;
  finer.points = mesh.points;
  for (const Segment& edge : sites.edges()) {
    // Each coordinate is halved before the addition, because the sum of two coordinates may overflow.
    finer.vertices.push_back(mesh.vertices[edge[0]] * 0.5 + mesh.vertices[edge[1]] * 0.5);
  }
  finer.triangles.reserve(4 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corner = mesh.triangles[t];
    Triangle middle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const EdgeId edge = sites.triangle_edges()[t][k];
      middle[k] = edge.has_value() ? first + edge.value : corner[k];
    }
    finer.triangles.push_back({corner[0], middle[0], middle[2]});
    finer.triangles.push_back({middle[0], corner[1], middle[1]});
    finer.triangles.push_back({middle[2], middle[1], corner[2]});
    finer.triangles.push_back(middle);
  }
  const auto edges = sites.edges();
  for (const Segment& segment : mesh.segments) {
    const Segment sorted{std::min(segment[0], segment[1]), std::max(segment[0], segment[1])};
    const auto found = std::lower_bound(edges.begin(), edges.end(), sorted);
    const std::uint32_t middle =
        sorted[0] == sorted[1] ? sorted[0] : first + static_cast<std::uint32_t>(found - edges.begin());
    finer.segments.push_back({segment[0], middle});
    finer.segments.push_back({middle, segment[1]});
  }
  return finer;
}

}  // namespace

TriangleMesh make_soup(const SoupOptions& options) {
  require(options.triangles >= 1, "triangles", "at least 1", static_cast<double>(options.triangles));
  require_positive(options.size, "size");
  require_positive(options.triangle_size, "triangle_size");
  require(options.awkward >= 0 && options.awkward <= 1, "awkward", "0 to 1", options.awkward);
  require_triangle_count(static_cast<double>(options.triangles));
  Random random(options.seed);
  TriangleMesh mesh;
  mesh.vertices.reserve(3 * options.triangles);
  mesh.triangles.reserve(options.triangles);
  for (std::size_t t = 0; t < options.triangles; ++t) {
    const bool is_awkward = random.uniform() < options.awkward;
    const Corners corners = is_awkward ? awkward(random, mesh, options) : ordinary(random, options);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TriangleMesh make_segments(const SegmentsOptions& options) {
  require(options.segments >= 1, "segments", "at least 1", static_cast<double>(options.segments));
  require_positive(options.size, "size");
  require_positive(options.segment_size, "segment_size");
  require_triangle_count(static_cast<double>(options.segments));
  Random random(options.seed);
  TriangleMesh mesh;
  for (std::uint32_t s = 0; s < options.segments; ++s) {
    const Vec3d center = center_in(random, options.size);
    mesh.vertices.push_back(center + random.in_ball() * options.segment_size);
    mesh.vertices.push_back(center + random.in_ball() * options.segment_size);
    mesh.segments.push_back({2 * s, 2 * s + 1});
  }
  return mesh;
}

TriangleMesh make_points(const PointsOptions& options) {
  require(options.points >= 1, "points", "at least 1", static_cast<double>(options.points));
  require_positive(options.size, "size");
  require_triangle_count(static_cast<double>(options.points));
  Random random(options.seed);
  TriangleMesh mesh;
  for (std::uint32_t p = 0; p < options.points; ++p) {
    mesh.vertices.push_back(center_in(random, options.size));
    mesh.points.push_back(p);
  }
  return mesh;
}

TriangleMesh make_noisy(const MeshView& mesh, double amplitude, std::uint64_t seed) {
  require(amplitude >= 0 && amplitude <= 1e100, "amplitude", "0 to 1e100", amplitude);
  TriangleMesh noisy;
  append(noisy, mesh);
  Random random(seed);
  for (Vec3d& p : noisy.vertices) p += random.in_ball() * amplitude;
  return noisy;
}

TriangleMesh make_subdivided(const MeshView& mesh, int levels) {
  require(levels >= 0 && levels <= 12, "levels", "0 to 12", levels);
  validate(mesh);
  const double parts = std::pow(4.0, levels);
  require_triangle_count(static_cast<double>(mesh.triangles.size()) * parts);
  require_triangle_count(static_cast<double>(mesh.segments.size()) * std::pow(2.0, levels));
  TriangleMesh result;
  append(result, mesh);
  for (int level = 0; level < levels; ++level) result = subdivide_once(result);
  return result;
}

void append(TriangleMesh& mesh, const MeshView& other, const Vec3d& offset) {
  const std::size_t first = mesh.vertices.size();
  if (first + other.vertices.size() > max_id_count)
    throw InvalidMesh("the joined mesh has more than 2^31 - 1 vertices");
  const auto shift = static_cast<std::uint32_t>(first);
  extend(mesh.vertices, other.vertices, [&](const Vec3d& p) { return p + offset; });
  extend(mesh.triangles, other.triangles,
         [&](const Triangle& t) { return Triangle{t[0] + shift, t[1] + shift, t[2] + shift}; });
  extend(mesh.segments, other.segments, [&](const Segment& s) { return Segment{s[0] + shift, s[1] + shift}; });
  extend(mesh.points, other.points, [&](std::uint32_t p) { return p + shift; });
}

void reverse_triangles(TriangleMesh& mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

}  // namespace blum
