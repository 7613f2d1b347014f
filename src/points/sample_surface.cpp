#include "blum/points/sample_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/random.hpp"
#include "points/sample_elimination.hpp"

namespace blum {
namespace {

/// Each block of points has random numbers of its own, so that they do not depend on threads.
constexpr std::size_t block = 4096;
/// Blue noise is chosen from so many times as many points.
constexpr std::size_t candidates_per_point = 5;
constexpr std::size_t most_points = std::size_t{1} << 31;

Random random_of(std::uint64_t seed, std::size_t number) {
  Random of_seed(seed);
  return Random(of_seed.bits() ^ Random(number).bits());
}

void check_count(std::size_t count) {
  if (count <= most_points) return;
  throw OutOfMemory("more than 2^31 points are asked for: ask for fewer, with several seeds");
}

/// Triangles by area.
class AreaTable {
 public:
  explicit AreaTable(const MeshView& mesh) : mesh_(mesh) {
    validate(mesh);
    const Box3 box = bounds(mesh);
    scale_ = 1 / std::max(box.diagonal(), 1e-300);  // squares of coordinates may be beyond all numbers
    sums_.reserve(mesh.triangles.size());
    double sum = 0;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const double area = length(twice_area(t));
      if (!(area > 0)) continue;
      sum += area;
      sums_.push_back(sum);
      triangles_.push_back(t);
    }
    if (triangles_.empty()) throw InvalidMesh("no triangle of the mesh has an area, so there is no surface to sample");
  }

  /// What brings the mesh to about 1.
  [[nodiscard]] double scale() const { return scale_; }
  /// Of the mesh times its scale.
  [[nodiscard]] double scaled_area() const { return 0.5 * sums_.back(); }

  void sample(Random& random, Vec3d& point, Vec3d& normal, TriangleId& triangle) const {
    const double at = random.uniform() * sums_.back();
    const auto found = std::upper_bound(sums_.begin(), sums_.end() - 1, at) - sums_.begin();
    const std::uint32_t t = triangles_[static_cast<std::size_t>(found)];
    const auto [a, b, c] = triangle_corners(mesh_, t);
    double u = random.uniform();
    double v = random.uniform();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    point = a + (b - a) * u + (c - a) * v;
    const Vec3d n = twice_area(t);
    normal = n / length(n);
    triangle = TriangleId(t);
  }

 private:
  [[nodiscard]] Vec3d twice_area(std::uint32_t t) const {
    const auto [a, b, c] = triangle_corners(mesh_, t);
    return cross((b - a) * scale_, (c - a) * scale_);
  }

  const MeshView& mesh_;
  double scale_ = 1;
  std::vector<double> sums_;
  std::vector<std::uint32_t> triangles_;
};

SurfaceSamples sample(const AreaTable& table, std::size_t count, std::uint64_t seed, const Context& context) {
  SurfaceSamples out{std::vector<Vec3d>(count), std::vector<Vec3d>(count), std::vector<TriangleId>(count)};
  parallel_for(context, count, block, "points of the surface", [&](const WorkRange& range) {
    Random random = random_of(seed, range.begin / block);
    for (std::size_t k = range.begin; k < range.end; ++k) {
      table.sample(random, out.points[k], out.normals[k], out.triangles[k]);
    }
  });
  return out;
}

/// Two numbers of a normal distribution (Box and Muller 1958).
std::array<double, 2> normal_pair(Random& random) {
  const double radius = std::sqrt(-2 * std::log(1 - random.uniform()));
  const double angle = 2 * std::numbers::pi * random.uniform();
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

void check(const NearSampleOptions& options) {
  if (options.sigma && !(*options.sigma > 0 && std::isfinite(*options.sigma))) {
    throw InvalidOption("sigma is " + exact_text(*options.sigma) + ", but must be above 0");
  }
  if (!(options.in_box >= 0 && options.in_box <= 1)) {
    throw InvalidOption("in_box is " + exact_text(options.in_box) + ", but must be 0 to 1: a part of all points");
  }
}

}  // namespace

SurfaceSamples sample_surface(const MeshView& mesh, std::size_t count, const SampleOptions& options,
                              const Context& context) {
  check_count(count);
  const AreaTable table(mesh);
  if (!options.blue_noise || count == 0) return sample(table, count, options.seed, context);
  check_count(candidates_per_point * count);
  const SurfaceSamples all = sample(table, candidates_per_point * count, options.seed, context);
  std::vector<Vec3d> scaled = all.points;
  for (Vec3d& p : scaled) p = p * table.scale();
  SurfaceSamples out;
  for (const std::uint32_t k : detail::most_even(scaled, count, table.scaled_area(), context)) {
    out.points.push_back(all.points[k]);
    out.normals.push_back(all.normals[k]);
    out.triangles.push_back(all.triangles[k]);
  }
  return out;
}

NearSamples sample_near(const MeshView& mesh, std::size_t count, const NearSampleOptions& options,
                        const Context& context) {
  check(options);
  check_count(count);
  const auto in_box = static_cast<std::size_t>(std::llround(options.in_box * static_cast<double>(count)));
  const AreaTable table(mesh);
  NearSamples out;
  out.points = sample(table, count - in_box, options.seed, context).points;
  const Box3 box = bounds(mesh);
  const double sigma = options.sigma.value_or(0.01 * box.diagonal());
  constexpr std::uint64_t of_offsets = 0x6f66667365747300u;  // other random numbers than those of the points
  parallel_for(context, out.points.size(), block, "offsets", [&](const WorkRange& range) {
    Random random = random_of(options.seed ^ of_offsets, range.begin / block);
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const auto [x, y] = normal_pair(random);
      out.points[k] += Vec3d{x, y, normal_pair(random)[0]} * sigma;
    }
  });
  const Vec3d size = box.size() * 1.1;
  const Vec3d lower = box.center() - size * 0.5;
  Random random = random_of(~(options.seed ^ of_offsets), 0);
  for (std::size_t k = 0; k < in_box; ++k) {
    const Vec3d at = random.in_cube();
    out.points.push_back(lower + Vec3d{at.x * size.x, at.y * size.y, at.z * size.z});
  }
  out.closest = closest_points(mesh, out.points, {.sign = options.sign}, context);
  return out;
}

}  // namespace blum
