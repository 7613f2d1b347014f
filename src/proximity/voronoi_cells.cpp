#include "proximity/voronoi_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "blum/core/parallel.hpp"

namespace blum::detail {
namespace {

/// Primitives that touch more cells than this, and those that touch a cell with more primitives near it, are left to
/// the hierarchy: so memory and time are bounded by the number of primitives.
constexpr std::int64_t most_cells = 512;
constexpr std::size_t most_entries = 256;

constexpr std::int64_t cells_per_axis = std::int64_t{1} << 20;
constexpr std::size_t grain = 256;

/// A unit vector at right angles to a triangle; 0 where it is thin, so that its own corners would not be level.
Vec3d normal_of(const std::array<Vec3d, 3>& p) {
  const Vec3d u = p[1] - p[0];
  const Vec3d v = p[2] - p[0];
  const Vec3d n = cross(u, v);
  const double longest = std::max({dot(u, u), dot(v, v), dot(v - u, v - u)});
  const double square = dot(n, n);
  return square > std::max(1e-4 * longest * longest, 1e-280) ? n / std::sqrt(square) : Vec3d{};
}

double largest_side(const Box3& box) {
  const Vec3d size = box.size();
  return std::max({size.x, size.y, size.z});
}

}  // namespace

/// A primitive in a cell.
struct VoronoiCells::Place {
  std::uint64_t key;
  std::uint32_t row;
  [[nodiscard]] friend auto operator<=>(const Place&, const Place&) = default;
};

VoronoiCells::VoronoiCells(const ScenePrimitives& primitives, double cell_size, double max_distance, bool is_closest,
                           const Context& context)
    : primitives_(primitives), is_left_over_(primitives.size(), 0) {
  if (primitives.size() == 0) return;
  make_cells(cell_size, context);
  fill_cells(max_distance, is_closest, context);
}

void VoronoiCells::make_cells(double cell_size, const Context& context) {
  const Box3 all = bounds(primitives_.mesh());
  const std::size_t count = primitives_.size();
  double sum = 0;
  for (std::uint32_t row = 0; row < count; ++row) sum += largest_side(primitives_.box(row));
  const double extent = largest_side(all);
  origin_ = all.lower;
  side_ = std::max({cell_size * sum / static_cast<double>(count), 2 * extent / static_cast<double>(cells_per_axis),
                    std::numeric_limits<double>::min()});
  rounding_ = 1e-13 * (length(all.lower) + length(all.upper));
  radius_ = 0.5 * std::numbers::sqrt3 * side_ + rounding_;
  std::vector<std::vector<Place>> parts((count + grain - 1) / grain);
  parallel_for(context, count, grain, "cells", [&](const WorkRange& range) {
    std::vector<Place>& out = parts[range.begin / grain];
    for (auto row = static_cast<std::uint32_t>(range.begin); row < range.end; ++row) {
      const std::array<Vec3d, 3> corners = primitives_.corners(row);
      const Box3 box = primitives_.box(row);
      std::array<std::int64_t, 3> low{};
      std::array<std::int64_t, 3> size{};
      std::int64_t cells = 1;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = [&](double x) {
          return std::clamp<std::int64_t>(std::llround(std::floor((x - origin_[axis]) / side_)), 0, cells_per_axis);
        };
        low[axis] = at(box.lower[axis] - rounding_);
        size[axis] = at(box.upper[axis] + rounding_) - low[axis] + 1;
        cells = std::min(cells * size[axis], 2 * most_cells * cells_per_axis);
      }
      if (cells > most_cells) {
        is_left_over_[row] = 1;
        continue;
      }
      const Vec3d normal = normal_of(corners);
      for (std::int64_t n = 0; n < cells; ++n) {
        const std::int64_t x = low[0] + n % size[0];
        const std::int64_t y = low[1] + n / size[0] % size[1];
        const std::int64_t z = low[2] + n / (size[0] * size[1]);
        const auto key = static_cast<std::uint64_t>(x | y << 21 | z << 42);
        if (std::abs(dot(normal, middle(key) - corners[0])) <= radius_) out.push_back({key, row});
      }
    }
  });
  std::vector<Place> places;
  for (const std::vector<Place>& part : parts) places.insert(places.end(), part.begin(), part.end());
  std::sort(places.begin(), places.end());
  row_first_.assign(count + 1, 0);
  for (const Place& place : places) {
    if (keys_.empty() || keys_.back() != place.key) {
      keys_.push_back(place.key);
      cell_first_.push_back(static_cast<std::uint32_t>(rows_.size()));
    }
    rows_.push_back(place.row);
    ++row_first_[place.row + 1];
  }
  for (std::size_t row = 0; row < count; ++row) row_first_[row + 1] += row_first_[row];
  cells_.resize(rows_.size());
  std::vector<std::uint32_t> next(row_first_.begin(), row_first_.end() - 1);
  for (std::uint32_t cell = 0; cell < keys_.size(); ++cell) {
    for (const std::uint32_t row : touching(cell)) cells_[next[row]++] = cell;
  }
}

Vec3d VoronoiCells::middle(std::uint64_t key) const {
  constexpr std::uint64_t mask = (std::uint64_t{1} << 21) - 1;
  return origin_ + Vec3d{static_cast<double>(key & mask) + 0.5, static_cast<double>(key >> 21 & mask) + 0.5,
                         static_cast<double>(key >> 42) + 0.5} *
                       side_;
}

std::span<const std::uint32_t> VoronoiCells::touching(std::uint32_t cell) const {
  const std::size_t end = cell + 1 < cell_first_.size() ? cell_first_[cell + 1] : rows_.size();
  return std::span<const std::uint32_t>(rows_).subspan(cell_first_[cell], end - cell_first_[cell]);
}

std::span<const std::uint32_t> VoronoiCells::cells(std::uint32_t row) const {
  return std::span<const std::uint32_t>(cells_).subspan(row_first_[row], row_first_[row + 1] - row_first_[row]);
}

std::size_t VoronoiCells::left_over() const {
  return static_cast<std::size_t>(std::count(is_left_over_.begin(), is_left_over_.end(), std::uint8_t{1}));
}

std::span<const CellEntry> VoronoiCells::entries(std::uint32_t cell) const {
  return entries_[cell];
}

void VoronoiCells::fill_cells(double max_distance, bool is_closest, const Context& context) {
  const SiteTable sites(primitives_.mesh(), context);
  const Bvh bvh(primitives_.mesh(), sites, context);
  entries_.resize(keys_.size());
  std::vector<std::uint8_t> is_full(keys_.size(), 0);
  parallel_for(context, keys_.size(), grain, "second-order diagram", [&](const WorkRange& range) {
    for (auto cell = static_cast<std::uint32_t>(range.begin); cell < range.end; ++cell) {
      const bool fits = is_closest ? fill_closest(bvh, cell, max_distance, entries_[cell])
                                   : fill_within(bvh, cell, max_distance + radius_, entries_[cell]);
      is_full[cell] = fits ? 0 : 1;
    }
  });
  for (std::uint32_t cell = 0; cell < keys_.size(); ++cell) {
    if (is_full[cell] == 0) continue;
    for (const std::uint32_t row : touching(cell)) is_left_over_[row] = 1;
  }
}

/// The closest one that it is compared with of each primitive that touches the cell tells how far others may be.
/// @return whether there are few enough.
bool VoronoiCells::fill_closest(const Bvh& bvh, std::uint32_t cell, double max_distance,
                                std::vector<CellEntry>& out) const {
  const Vec3d q = middle(keys_[cell]);
  for (std::size_t k = 16; k <= most_entries; k *= 4) {
    const std::vector<NearestPrimitive> near = bvh.nearest_primitives(q, k);
    const bool is_all = near.size() < k;
    if (near.empty()) return true;
    double furthest = 0;  // second-closest distance of any primitive here
    bool is_known = true;
    for (const std::uint32_t row : touching(cell)) {
      const auto found = std::find_if(near.begin(), near.end(), [&](const NearestPrimitive& one) {
        return primitives_.are_compared(row, one.primitive);
      });
      if (found != near.end()) furthest = std::max(furthest, found->distance);
      is_known = is_known && (is_all || found != near.end());
    }
    const double most = max_distance + radius_;
    const double limit = is_known ? std::min(furthest + 2 * radius_, most) : most;
    if (!is_all && near.back().distance <= limit) {
      if (is_known) return fill_within(bvh, cell, limit, out);
      continue;
    }
    for (const NearestPrimitive& one : near) {
      if (one.distance <= limit) out.push_back({one.primitive, one.distance});
    }
    return true;
  }
  return false;
}

bool VoronoiCells::fill_within(const Bvh& bvh, std::uint32_t cell, double distance, std::vector<CellEntry>& out) const {
  bool fits = true;
  bvh.for_each_within(middle(keys_[cell]), distance, [&](const NearestPrimitive& one) {
    out.push_back({one.primitive, one.distance});
    fits = out.size() <= most_entries;
    return fits;
  });
  std::sort(out.begin(), out.end(), [](const CellEntry& a, const CellEntry& b) {
    return std::pair(a.distance, a.row) < std::pair(b.distance, b.row);
  });
  return fits;
}

}  // namespace blum::detail
