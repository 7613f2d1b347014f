#include "medial_axis/surface/voxel_surface.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

namespace blum::detail {
namespace {

constexpr std::int64_t branching = 2;  // number of blocks, along each axis, that a block of the next level consists of
constexpr int most_steps = 64;
/// Squared cosine of 45 degrees. If the direction to the footprint turns by more in one step, the new footprint is on
/// another wall, unless the step follows the surface.
constexpr double most_turned = 0.5;

std::int64_t blocks(std::int64_t size, std::int64_t side) {
  return (size + side - 1) / side;
}

/// Sets, in a row of blocks, the bits of those voxels that a row of voxels lacks. In each block, bits `shift` and
/// `shift` + 1 may be set.
void add_missing(std::span<const std::uint64_t> row, std::int64_t length, unsigned shift, std::uint8_t* blocks) {
  for (std::size_t w = 0; w < row.size(); ++w) {
    const std::int64_t left = length - 64 * static_cast<std::int64_t>(w);
    if (left <= 0) break;
    const std::uint64_t within = left >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << left) - 1;
    std::uint64_t missing = ~row[w] & within;
    for (std::uint8_t* block = blocks + 32 * w; missing != 0; missing >>= 2U, ++block) {
      *block |= static_cast<std::uint8_t>((missing & 3U) << shift);
    }
  }
}

}  // namespace

/// For each axis: squared distances of a query along that axis from a voxel, the one before it and the one after it.
/// Bit n of `allowed` is set if voxel n of the three may be chosen.
struct VoxelSurface::Axes {
  std::array<std::array<double, 3>, 3> squared{};
  std::array<unsigned, 3> allowed{};
};

/// The query, and the closest voxel found so far.
struct VoxelSurface::Search {
  Vec3d query;  ///< in coordinates of local()
  double squared = std::numeric_limits<double>::infinity();
  std::uint32_t voxel = 0;
};

VoxelSurface::VoxelSurface(const VoxelSet& voxels, const GridSpec& grid) : voxels_(voxels), grid_(grid) {
  VoxelIndex size = voxels.size();
  do {
    Level level;
    for (std::size_t a = 0; a < 3; ++a) level.size[a] = blocks(size[a], branching);
    level.parts.assign(static_cast<std::size_t>(level.size[0] * level.size[1] * level.size[2]), 0);
    for (std::int64_t k = 0; k < size[2]; ++k) {
      for (std::int64_t j = 0; j < size[1]; ++j) {
        std::uint8_t* blocks = level.parts.data() + level.index({0, j / branching, k / branching});
        const auto shift = static_cast<unsigned>(2 * (j & 1) + 4 * (k & 1));
        if (levels_.empty()) {
          add_missing(voxels.row(j, k), size[0], shift, blocks);
          continue;
        }
        const std::uint8_t* from = levels_.back().parts.data() + levels_.back().index({0, j, k});
        for (std::int64_t i = 0; i < size[0]; ++i) {
          if (from[i] != 0) blocks[i / 2] |= static_cast<std::uint8_t>(1U << (shift + (i & 1)));
        }
      }
    }
    size = level.size;
    levels_.push_back(std::move(level));
  } while (std::max({size[0], size[1], size[2]}) > 1);
}

unsigned VoxelSurface::others_in_row(const VoxelIndex& middle) const {
  const VoxelIndex& size = voxels_.size();
  if (middle[1] < 0 || middle[1] >= size[1] || middle[2] < 0 || middle[2] >= size[2]) return 0;
  const std::span<const std::uint64_t> row = voxels_.row(middle[1], middle[2]);
  // Rows end in unused bits. So if the next voxel exists, the word that contains it also exists.
  const std::int64_t first = middle[0] - 1;
  const auto word = static_cast<std::size_t>(std::max<std::int64_t>(first, 0) / 64);
  const auto shift = static_cast<unsigned>(std::max<std::int64_t>(first, 0) % 64);
  std::uint64_t selected = row[word] >> shift;
  if (shift > 61 && word + 1 < row.size()) selected |= row[word + 1] << (64 - shift);
  unsigned others = static_cast<unsigned>(~selected & 7U);
  if (first < 0) others = others << 1U & 7U;
  const std::int64_t left = size[0] - first;  // number of voxels of the row from `first` to its end
  if (left < 3) others &= (1U << static_cast<unsigned>(left)) - 1;
  return others;
}

Vec3d VoxelSurface::local(const Vec3d& world) const {
  return grid_.direction.transposed_times(world - grid_.origin) + grid_.spacing * 0.5;
}

Vec3d VoxelSurface::world(const Vec3d& local) const {
  return grid_.origin + grid_.direction * (local - grid_.spacing * 0.5);
}

Vec3d VoxelSurface::closest_in(const VoxelIndex& lower, std::int64_t side, const Vec3d& query) const {
  Vec3d out;
  for (std::size_t a = 0; a < 3; ++a) {
    const double low = static_cast<double>(lower[a]) * grid_.spacing[a];
    const double high = static_cast<double>(lower[a] + side) * grid_.spacing[a];
    out[a] = std::clamp(query[a], low, high);
  }
  return out;
}

Footprint VoxelSurface::footprint(SiteId site, const Vec3d& centre, bool is_inside) const {
  if (is_inside) return {world(closest_in(voxels_.place(site.value), 1, local(centre))), site.value, 7};
  // The element of a voxel outside the solid is the voxel itself. The footprint is its point closest to the solid.
  const VoxelIndex& size = voxels_.size();
  const Vec3d at = local(centre);
  VoxelIndex own{};
  for (std::size_t a = 0; a < 3; ++a) {
    own[a] = std::clamp(static_cast<std::int64_t>(at[a] / grid_.spacing[a]), std::int64_t{0}, size[a] - 1);
  }
  const VoxelIndex other = voxels_.place(site.value);
  const Vec3d goal = closest_in(other, 1, at);
  return {world(closest_in(own, 1, goal)), static_cast<std::uint32_t>((own[2] * size[1] + own[1]) * size[0] + own[0]),
          7};
}

std::optional<Vec3d> VoxelSurface::rough_footprint(SiteId site) const {
  const auto [i, j, k] = voxels_.place(site.value);
  return Vec3d{static_cast<double>(i) * grid_.spacing.x, static_cast<double>(j) * grid_.spacing.y,
               static_cast<double>(k) * grid_.spacing.z};
}

Footprint VoxelSurface::follow(const Footprint& start, const Vec3d& query, double reach) const {
  const Vec3d at = local(query);
  const Vec3d from = local(start.point);
  VoxelIndex best = voxels_.place(start.element);
  Vec3d best_point = closest_in(best, 1, at);
  double best_squared = squared_length(at - best_point);
  for (int step = 0; step < most_steps; ++step) {
    const int next = closer_neighbour(best, at, best_squared);
    if (next < 0) break;
    const VoxelIndex to{best[0] + next % 3 - 1, best[1] + next / 3 % 3 - 1, best[2] + next / 9 - 1};
    const Vec3d point = closest_in(to, 1, at);
    if (squared_length(point - from) > reach * reach) break;
    best = to;
    best_point = point;
    best_squared = squared_length(at - point);
  }
  const VoxelIndex& size = voxels_.size();
  return {world(best_point), static_cast<std::uint32_t>((best[2] * size[1] + best[1]) * size[0] + best[0]), 7};
}

int VoxelSurface::closer_neighbour(const VoxelIndex& voxel, const Vec3d& query, double squared) const {
  Axes axes;
  for (std::size_t a = 0; a < 3; ++a) {
    const double low = static_cast<double>(voxel[a]) * grid_.spacing[a];
    const double high = low + grid_.spacing[a];
    const auto square = [](double value) { return value * value; };
    axes.squared[a] = {square(std::max({low - grid_.spacing[a] - query[a], query[a] - low, 0.0})),
                       square(std::max({low - query[a], query[a] - high, 0.0})),
                       square(std::max({high - query[a], query[a] - high - grid_.spacing[a], 0.0}))};
    axes.allowed[a] = 7;
  }
  const int best = closest_of(voxel, axes, squared);
  if (best < 0) return best;
  const VoxelIndex to{voxel[0] + best % 3 - 1, voxel[1] + best / 3 % 3 - 1, voxel[2] + best / 9 - 1};
  const Vec3d from_foot = query - closest_in(voxel, 1, query);
  const Vec3d from_next = query - closest_in(to, 1, query);
  const double next_squared = squared_length(from_next);
  const double cosine_scaled = dot(from_foot, from_next);
  if (cosine_scaled > 0 && cosine_scaled * cosine_scaled >= most_turned * squared * next_squared) return best;
  // This step turns too far around a corner to stay on the same wall. For such a step, only voxels that touch the
  // footprint on the side of the query are allowed.
  for (std::size_t a = 0; a < 3; ++a) {
    const double low = static_cast<double>(voxel[a]) * grid_.spacing[a];
    axes.allowed[a] = 2U | (query[a] <= low ? 1U : 0U) | (query[a] >= low + grid_.spacing[a] ? 4U : 0U);
  }
  return closest_of(voxel, axes, squared);
}

int VoxelSurface::closest_of(const VoxelIndex& voxel, const Axes& axes, double squared) const {
  const auto& [part, allowed] = axes;
  int best = -1;
  double least = squared * (1 - 1e-12);
  for (int row = 0; row < 9; ++row) {
    if ((allowed[1] >> (row % 3) & allowed[2] >> (row / 3) & 1U) == 0) continue;
    const double across = part[1][static_cast<std::size_t>(row % 3)] + part[2][static_cast<std::size_t>(row / 3)];
    if (across >= least) continue;
    unsigned others = others_in_row({voxel[0], voxel[1] + row % 3 - 1, voxel[2] + row / 3 - 1}) & allowed[0];
    for (; others != 0; others &= others - 1) {
      const int n = std::countr_zero(others);
      const double sum = across + part[0][static_cast<std::size_t>(n)];
      if (sum >= least) continue;
      least = sum;
      best = 3 * row + n;
    }
  }
  return best;
}

void VoxelSurface::search(Search& best, std::size_t level, const VoxelIndex& block) const {
  unsigned parts = levels_[level].parts[levels_[level].index(block)];
  // Squared distances of the query along each axis from the first and the second part of the block.
  const auto side = static_cast<double>(std::int64_t{1} << level);
  std::array<std::array<double, 2>, 3> squares{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double length = side * grid_.spacing[a];
    const double middle = static_cast<double>(branching * block[a] + 1) * length;
    const double past = best.query[a] - middle;
    const double first = std::max({past, -past - length, 0.0});
    const double second = std::max({-past, past - length, 0.0});
    squares[a] = {first * first, second * second};
  }
  struct Part {
    double squared;
    VoxelIndex at;
  };
  std::array<Part, 8> nearer;
  std::size_t count = 0;
  for (; parts != 0; parts &= parts - 1) {
    const auto n = static_cast<std::size_t>(std::countr_zero(parts));
    const double squared = squares[0][n & 1U] + squares[1][n >> 1U & 1U] + squares[2][n >> 2U];
    if (squared > best.squared) continue;
    const auto bit = static_cast<std::int64_t>(n);
    const VoxelIndex at{branching * block[0] + (bit & 1), branching * block[1] + (bit >> 1 & 1),
                        branching * block[2] + (bit >> 2)};
    if (level > 0) {
      std::size_t place = count++;
      for (; place > 0 && nearer[place - 1].squared > squared; --place) nearer[place] = nearer[place - 1];
      nearer[place] = {squared, at};
      continue;
    }
    const VoxelIndex& size = voxels_.size();
    const auto voxel = static_cast<std::uint32_t>((at[2] * size[1] + at[1]) * size[0] + at[0]);
    if (squared == best.squared && voxel >= best.voxel) continue;
    best.squared = squared;
    best.voxel = voxel;
  }
  for (std::size_t p = 0; p < count && nearer[p].squared <= best.squared; ++p) search(best, level - 1, nearer[p].at);
}

NearestPoint VoxelSurface::nearest(const Vec3d& query, const Footprint& near) const {
  Search best;
  best.query = local(query);
  // The distance of the known footprint, plus a margin for rounding, bounds the search.
  best.squared = squared_length(query - near.point) * (1 + 1e-9);
  best.voxel = near.element;
  search(best, levels_.size() - 1, {0, 0, 0});
  const Vec3d point = closest_in(voxels_.place(best.voxel), 1, best.query);
  return {world(point), length(best.query - point), SiteId(best.voxel), best.voxel};
}

}  // namespace blum::detail
