#include "blum/grid/image_generators.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"

namespace blum {
namespace {

void require(bool holds, const std::string& message) {
  if (!holds) throw InvalidOption(message);
}

GridSpec make_grid(std::int64_t nx, std::int64_t ny, std::int64_t nz, const Vec3d& spacing) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    require(spacing[axis] > 0 && spacing[axis] <= 1e100, "each spacing must be above 0 and at most 1e100");
  }
  const double voxels = static_cast<double>(nx) * static_cast<double>(ny) * static_cast<double>(nz);
  require(voxels <= 0x1p30, "the image would have more than 2^30 voxels; choose a smaller one");
  return {{}, spacing, {nx, ny, nz}, {}};
}

/// Returns an image whose voxel (i, j, k) has the value value(i, j, k).
template <class T, class Value>
VoxelImage fill(const GridSpec& grid, Value value) {
  std::vector<T> values(grid.node_count());
  std::size_t voxel = 0;
  for (std::int64_t k = 0; k < grid.size[2]; ++k) {
    for (std::int64_t j = 0; j < grid.size[1]; ++j) {
      for (std::int64_t i = 0; i < grid.size[0]; ++i) values[voxel++] = static_cast<T>(value(i, j, k));
    }
  }
  return {grid, std::move(values)};
}

/// Returns the distance from x to the closest of the values 0, pitch, ..., (count - 1) * pitch.
double distance_to_lattice(double x, double pitch, int count) {
  const double nearest = std::clamp(std::round(x / pitch), 0.0, static_cast<double>(count - 1));
  return std::abs(x - nearest * pitch);
}

/// Returns the distance from x to the interval [0, (count - 1) * pitch].
double distance_to_range(double x, double pitch, int count) {
  return std::max({0.0, -x, x - pitch * (count - 1)});
}

}  // namespace

VoxelImage make_ball_image(const BallImageOptions& options) {
  require(options.size >= 8 && options.size <= 1024, "size must be 8 to 1024 voxels");
  require(options.radius >= 0.3 && options.radius <= 0.9, "radius must be 0.3 to 0.9 of half the shortest side");
  require(options.inner_radius >= 0 && options.inner_radius <= 0.7, "inner_radius must be 0 to 0.7 of the radius");
  const std::int64_t n = options.size;
  const GridSpec grid = make_grid(n, n, n, options.spacing);
  const Vec3d& h = options.spacing;
  const double outer = options.radius * 0.5 * static_cast<double>(n) * std::min({h.x, h.y, h.z});
  const double inner = options.inner_radius * outer;
  const double coarsest = std::max({h.x, h.y, h.z});
  require(outer >= coarsest, "the ball is smaller than a voxel; choose a larger radius or more even spacing");
  if (inner > 0) {
    require(
        outer - inner >= 3 * coarsest && inner >= coarsest,
        "the wall of a hollow ball must be three voxels thick, and its void as wide as one; choose a larger size or "
        "another inner_radius");
  }
  const double middle = 0.5 * static_cast<double>(n - 1);
  return fill<std::uint8_t>(grid, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    const Vec3d p{(static_cast<double>(i) - middle) * h.x, (static_cast<double>(j) - middle) * h.y,
                  (static_cast<double>(k) - middle) * h.z};
    const double distance = length(p);
    return distance <= outer && !(inner > 0 && distance <= inner) ? 1 : 0;
  });
}

VoxelImage make_tube_image(const TubeImageOptions& options) {
  require(options.nodes >= 1 && options.nodes <= 50, "nodes must be 1 to 50");
  require(options.pitch >= 6 && options.pitch <= 500, "pitch must be 6 to 500 voxels");
  require(options.radius >= 1 && options.radius <= 0.5 * options.pitch - 2,
          "radius must be 1 to pitch / 2 - 2 voxels, or tunnels close");
  const int margin = static_cast<int>(std::ceil(options.radius)) + 2;
  const std::int64_t n = std::int64_t{options.nodes - 1} * options.pitch + 1 + 2 * margin;
  const double squared_radius = options.radius * options.radius;
  return fill<std::uint8_t>(make_grid(n, n, n, options.spacing), [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    const Vec3d p{static_cast<double>(i - margin), static_cast<double>(j - margin), static_cast<double>(k - margin)};
    Vec3d lattice;
    Vec3d range;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lattice[axis] = distance_to_lattice(p[axis], options.pitch, options.nodes);
      range[axis] = distance_to_range(p[axis], options.pitch, options.nodes);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Vec3d to_line = lattice;
      to_line[axis] = range[axis];
      if (squared_length(to_line) <= squared_radius) return options.labelled ? static_cast<int>(axis) + 1 : 1;
    }
    return 0;
  });
}

VoxelImage make_balls_image(const BallsImageOptions& options) {
  require(options.count >= 1 && options.count <= 65535, "count must be 1 to 65535");
  require(options.pitch >= 6 && options.pitch <= 500, "pitch must be 6 to 500 voxels");
  require(options.radius >= 1 && options.radius <= 0.5 * options.pitch - 1,
          "radius must be 1 to pitch / 2 - 1 voxels, or balls touch");
  std::int64_t side = 1;
  while (side * side * side < options.count) ++side;
  const std::int64_t layers = (options.count + side * side - 1) / (side * side);
  const std::int64_t pitch = options.pitch;
  const GridSpec grid = make_grid(side * pitch + 1, side * pitch + 1, layers * pitch + 1, options.spacing);
  const double squared_radius = options.radius * options.radius;
  return fill<std::uint16_t>(grid, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    const std::int64_t x = std::min(i / pitch, side - 1);
    const std::int64_t y = std::min(j / pitch, side - 1);
    const std::int64_t z = std::min(k / pitch, layers - 1);
    const std::int64_t label = (z * side + y) * side + x + 1;
    const auto offset = [&](std::int64_t index, std::int64_t cell) {
      return static_cast<double>(index - cell * pitch) - 0.5 * static_cast<double>(pitch);
    };
    const Vec3d p{offset(i, x), offset(j, y), offset(k, z)};
    return label <= options.count && squared_length(p) <= squared_radius ? label : 0;
  });
}

VoxelImage make_noise_image(const NoiseImageOptions& options) {
  require(options.size >= 1 && options.size <= 1024, "size must be 1 to 1024 voxels");
  require(options.density >= 0 && options.density <= 1, "density must be 0 to 1");
  Random random(options.seed);
  const std::int64_t n = options.size;
  return fill<std::uint8_t>(make_grid(n, n, n, options.spacing), [&](std::int64_t, std::int64_t, std::int64_t) {
    return random.uniform() < options.density ? 1 : 0;
  });
}

}  // namespace blum
