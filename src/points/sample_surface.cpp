#include "blum/points/sample_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <queue>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/radix_sort.hpp"
#include "blum/core/random.hpp"
#include "blum/core/vec3.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t grain = 4096;
constexpr double steepness = 8;       // exponent of a neighbour's weight, as in Yuksel 2015
constexpr double floor_share = 0.65;  // distances below this share of the expected distance count only partly
constexpr double floor_power = 1.5;
/// The share to which distances below the floor count. In Yuksel 2015, this share is 0. If the two sides of a thin
/// plate are closer together than neighbouring points, all points have neighbours below the floor. Neighbours at almost
/// no distance must then be removed first.
constexpr double below_floor = 0.3;

/// Points, sorted into the cells of a grid. A cell is as wide as the distance within which points are neighbours.
class Cells {
 public:
  Cells(std::span<const Vec3d> points, double width) : points_(points), width_(width) {
    for (const Vec3d& p : points) box_.extend(p);
    order_.resize(points.size());
    for (std::uint32_t k = 0; k < points.size(); ++k) order_[k] = {bucket(cell(points[k])), k};
    radix_sort(order_);
    first_.assign(buckets + 1, 0);
    for (const KeyedIndex& item : order_) ++first_[item.key + 1];
    for (std::size_t b = 0; b < buckets; ++b) first_[b + 1] += first_[b];
  }

  /// Calls visit(other, squared distance) for the other points that are closer to a point than the width.
  template <class Visit>
  void for_each_near(std::uint32_t point, const Visit& visit) const {
    const Vec3d& p = points_[point];
    const std::array<std::int64_t, 3> at = cell(p);
    std::array<std::uint32_t, 27> seen{};
    std::size_t count = 0;
    for (int n = 0; n < 27; ++n) {
      const std::uint32_t b = bucket({at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1});
      // Two cells may have the same bucket, which must be visited only once.
      if (std::find(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(count), b) !=
          seen.begin() + static_cast<std::ptrdiff_t>(count)) {
        continue;
      }
      seen[count++] = b;
      for (std::size_t k = first_[b]; k < first_[b + 1]; ++k) {
        const std::uint32_t other = order_[k].index;
        const double squared = squared_length(points_[other] - p);
        if (other != point && squared < width_ * width_) visit(other, squared);
      }
    }
  }

 private:
  static constexpr std::size_t buckets = std::size_t{1} << 20;

  [[nodiscard]] std::array<std::int64_t, 3> cell(const Vec3d& p) const {
    std::array<std::int64_t, 3> out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out[axis] = static_cast<std::int64_t>(std::min(std::floor((p[axis] - box_.lower[axis]) / width_), 1e15));
    }
    return out;
  }
  static std::uint32_t bucket(const std::array<std::int64_t, 3>& at) {
    std::uint64_t hash = 0;
    for (const std::int64_t x : at) {
      hash = (hash ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    return static_cast<std::uint32_t>(hash % buckets);
  }

  std::span<const Vec3d> points_;
  double width_;
  Box3 box_;
  std::vector<KeyedIndex> order_;
  std::vector<std::uint32_t> first_;
};

/// The weight of a neighbour as a function of its squared distance.
class Weight {
 public:
  Weight(double width, double share)
      : width_(width), floor_(width * (1 - std::pow(share, floor_power)) * floor_share) {}
  double operator()(double squared) const {
    const double distance = std::sqrt(squared);
    const double counted = distance < floor_ ? floor_ - below_floor * (floor_ - distance) : distance;
    return std::pow(1 - counted / width_, steepness);
  }

 private:
  double width_;
  double floor_;
};

/// Selects points at nearly equal distances from each other, by weighted sample elimination (Yuksel 2015). Repeatedly,
/// the point with the largest sum of weights is removed. This point has the most and closest neighbours.
/// @param area  area of the surface that the points lie on.
/// @return      indices of `count` points, in rising order.
/// @throws Cancelled. Cost: 0.6 us per point, on one core.
std::vector<std::uint32_t> most_even(std::span<const Vec3d> points, std::size_t count, double area,
                                     const Context& context) {
  // In a lattice of equilateral triangles, `count` points would be this far apart (2 r). Points closer together than
  // this are neighbours.
  const double width = 2 * std::sqrt(area / (2 * std::numbers::sqrt3 * static_cast<double>(count)));
  const Cells cells(points, width);
  const Weight weight(width, static_cast<double>(count) / static_cast<double>(points.size()));
  std::vector<double> sum(points.size());
  parallel_for(
      context, points.size(), grain, "weights",
      [&](const WorkRange& range) {
        for (std::size_t k = range.begin; k < range.end; ++k) {
          cells.for_each_near(static_cast<std::uint32_t>(k),
                              [&](std::uint32_t, double squared) { sum[k] += weight(squared); });
        }
      },
      Start::at_once);
  // The point with the largest sum is on top. If its sum has changed since it was entered, it is entered again with the
  // new sum.
  using Entry = std::tuple<double, std::uint32_t>;
  std::vector<Entry> entries;
  entries.reserve(points.size());
  for (std::uint32_t k = 0; k < points.size(); ++k) entries.emplace_back(sum[k], k);
  std::priority_queue<Entry> heap({}, std::move(entries));
  std::vector<std::uint8_t> is_gone(points.size(), 0);
  for (std::size_t left = points.size(); left > count;) {
    const auto [was, point] = heap.top();
    heap.pop();
    if (was != sum[point]) {  // its sum is smaller now
      heap.emplace(sum[point], point);
      continue;
    }
    is_gone[point] = 1;
    if (--left % grain == 0) throw_if_cancelled(context);
    cells.for_each_near(point, [&](std::uint32_t other, double squared) {
      if (is_gone[other] == 0) sum[other] -= weight(squared);
    });
  }
  std::vector<std::uint32_t> out;
  out.reserve(count);
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    if (is_gone[k] == 0) out.push_back(k);
  }
  return out;
}

}  // namespace
}  // namespace blum::detail

namespace blum {
namespace {

/// Number of points in a block. Each block has its own random numbers, so that points do not depend on the number of
/// threads.
constexpr std::size_t block = 4096;
/// For each point of blue noise, this number of candidates is drawn.
constexpr std::size_t candidates_per_point = 5;
constexpr std::size_t most_points = std::size_t{1} << 31;

Random random_of(std::uint64_t seed, std::size_t number) {
  Random of_seed(seed);
  return Random(of_seed.bits() ^ Random(number).bits());
}

void check_count(std::size_t count) {
  if (count <= most_points) return;
  throw OutOfMemory("more than 2^31 points are requested: request fewer, with several seeds");
}

/// Table of the triangles of a mesh, to draw random points from its surface. Probabilities are proportional to area.
class AreaTable {
 public:
  explicit AreaTable(const MeshView& mesh) : mesh_(mesh) {
    validate(mesh);
    const Box3 box = bounds(mesh);
    scale_ = 1 / std::max(box.diagonal(), 1e-300);  // squares of coordinates may overflow
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

  /// Returns the factor that scales the mesh to a size of about 1.
  [[nodiscard]] double scale() const { return scale_; }
  /// Returns the area of the scaled mesh.
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

/// Returns two random numbers from the standard normal distribution (Box and Muller 1958).
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
    throw InvalidOption("in_box is " + exact_text(options.in_box) + ", but must be 0 to 1: a fraction of all points");
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
  constexpr std::uint64_t of_offsets = 0x6f66667365747300u;  // selects random numbers other than those of the points
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
  const ClosestPointQuery query(mesh, {.sign = options.sign}, context);
  out.closest = query.nearest(out.points, context);
  out.sign_rule = query.sign_rule();
  out.sign_reason = query.sign_reason();
  out.warnings = query.warnings();
  return out;
}

}  // namespace blum
