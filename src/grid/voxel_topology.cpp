#include "blum/grid/voxel_topology.hpp"

#include <algorithm>
#include <bit>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/core/union_find.hpp"

namespace blum {
namespace {

/// Maximal interval of consecutive voxels in a row: [begin, end).
struct Run {
  std::int32_t begin;
  std::int32_t end;
};

/// Runs of all rows, and their connected components.
class RunComponents {
 public:
  /// @param reach     0: runs of neighbouring rows are connected if they share a face; 1: also if they share only an
  /// edge or corner.
  RunComponents(const VoxelSet& voxels, bool of_background, std::int32_t reach, const Context& context)
      : size_(voxels.size()), reach_(reach) {
    first_.reserve(static_cast<std::size_t>(size_[1] * size_[2]) + 1);
    first_.push_back(0);
    for (std::int64_t k = 0; k < size_[2]; ++k) {
      throw_if_cancelled(context);
      for (std::int64_t j = 0; j < size_[1]; ++j) {
        list_runs(voxels.row(j, k), of_background);
        first_.push_back(runs_.size());
      }
    }
    joined_ = detail::UnionFind(runs_.size() + 1);
    count_ = static_cast<std::int64_t>(runs_.size());
    for (std::int64_t k = 0; k < size_[2]; ++k) {
      throw_if_cancelled(context);
      for (std::int64_t j = 0; j < size_[1]; ++j) join_row(j, k);
    }
  }

  /// Joins the runs that touch the border of the box with the outside, which is a separate component.
  void join_border() {
    ++count_;
    const auto outside = static_cast<std::uint32_t>(runs_.size());
    for (std::int64_t k = 0; k < size_[2]; ++k) {
      for (std::int64_t j = 0; j < size_[1]; ++j) {
        const bool is_border = j == 0 || k == 0 || j == size_[1] - 1 || k == size_[2] - 1;
        for (std::size_t r = first_[row(j, k)]; r < first_[row(j, k) + 1]; ++r) {
          if (is_border || runs_[r].begin == 0 || runs_[r].end == size_[0])
            join(static_cast<std::uint32_t>(r), outside);
        }
      }
    }
  }

  [[nodiscard]] std::int64_t count() const { return count_; }

  /// Adds the runs that are not connected with the outside to a set.
  void add_inner(VoxelSet& voxels) {
    const std::uint32_t outside = joined_.find(static_cast<std::uint32_t>(runs_.size()));
    for (std::int64_t k = 0; k < size_[2]; ++k) {
      for (std::int64_t j = 0; j < size_[1]; ++j) {
        for (std::size_t r = first_[row(j, k)]; r < first_[row(j, k) + 1]; ++r) {
          if (joined_.find(static_cast<std::uint32_t>(r)) == outside) continue;
          for (std::int64_t i = runs_[r].begin; i < runs_[r].end; ++i) voxels.insert(i, j, k);
        }
      }
    }
  }

 private:
  [[nodiscard]] std::size_t row(std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>(k * size_[1] + j);
  }

  void list_runs(std::span<const std::uint64_t> words, bool of_background) {
    std::int64_t at = 0;
    // Returns the first position, starting with `at`, that is in the set (if `is_member`) or not in it. Returns the end
    // of the row if there is none.
    const auto next = [&](bool is_member) {
      const std::uint64_t flip = is_member == of_background ? ~std::uint64_t{0} : 0;
      while (at < size_[0]) {
        const std::uint64_t word = (words[static_cast<std::size_t>(at / 64)] ^ flip) >> (at % 64);
        if (word != 0) return std::min<std::int64_t>(at + std::countr_zero(word), size_[0]);
        at = (at / 64 + 1) * 64;
      }
      return size_[0];
    };
    while ((at = next(true)) < size_[0]) {
      const std::int64_t begin = at;
      at = next(false);
      runs_.push_back({static_cast<std::int32_t>(begin), static_cast<std::int32_t>(at)});
    }
  }

  void join_row(std::int64_t j, std::int64_t k) {
    if (j > 0) join_rows(row(j, k), row(j - 1, k));
    if (k == 0) return;
    join_rows(row(j, k), row(j, k - 1));
    if (reach_ == 0) return;
    if (j > 0) join_rows(row(j, k), row(j - 1, k - 1));
    if (j + 1 < size_[1]) join_rows(row(j, k), row(j + 1, k - 1));
  }

  void join_rows(std::size_t row_a, std::size_t row_b) {
    std::size_t a = first_[row_a];
    std::size_t b = first_[row_b];
    while (a < first_[row_a + 1] && b < first_[row_b + 1]) {
      if (runs_[a].begin < runs_[b].end + reach_ && runs_[b].begin < runs_[a].end + reach_) {
        join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
      }
      if (runs_[a].end < runs_[b].end) {
        ++a;
      } else {
        ++b;
      }
    }
  }

  void join(std::uint32_t a, std::uint32_t b) {
    if (joined_.join(a, b)) --count_;
  }

  std::array<std::int64_t, 3> size_;
  std::int32_t reach_;
  std::vector<Run> runs_;
  std::vector<std::size_t> first_;
  detail::UnionFind joined_{0};
  std::int64_t count_ = 0;
};

/// Access to the rows of a set. Rows outside of its box are empty.
class Rows {
 public:
  explicit Rows(const VoxelSet& voxels) : voxels_(voxels), empty_(voxels.words_per_row(), 0) {}
  [[nodiscard]] std::span<const std::uint64_t> at(std::int64_t j, std::int64_t k) const {
    const auto& size = voxels_.size();
    if (j < 0 || k < 0 || j >= size[1] || k >= size[2]) return empty_;
    return voxels_.row(j, k);
  }

 private:
  const VoxelSet& voxels_;
  std::vector<std::uint64_t> empty_;
};

/// Returns V - E + F - C for the cells of the lattice that start on the line (j, k) along x: vertices, edges, squares
/// and cubes.
std::int64_t euler_of_line(const Rows& rows, std::int64_t j, std::int64_t k) {
  const auto here = rows.at(j, k);
  const auto before_y = rows.at(j - 1, k);
  const auto before_z = rows.at(j, k - 1);
  const auto before_yz = rows.at(j - 1, k - 1);
  std::int64_t sum = 0;
  std::uint64_t carry[4] = {0, 0, 0, 0};
  const auto ends = [&carry](std::uint64_t w, int which) {
    const std::uint64_t both = w | w << 1 | carry[which];
    carry[which] = w >> 63;
    return both;
  };
  for (std::size_t w = 0; w < here.size(); ++w) {
    const std::uint64_t y = here[w] | before_y[w];
    const std::uint64_t z = here[w] | before_z[w];
    const std::uint64_t yz = y | before_z[w] | before_yz[w];
    sum += std::popcount(ends(yz, 0)) - std::popcount(yz);            // + vertices, - edges along x
    sum -= std::popcount(ends(z, 1)) - std::popcount(z);              // - edges along y, + squares xy
    sum -= std::popcount(ends(y, 2)) - std::popcount(y);              // - edges along z, + squares xz
    sum += std::popcount(ends(here[w], 3)) - std::popcount(here[w]);  // + squares yz, - cubes
  }
  return sum;
}

/// For each voxel of a neighbourhood of 27 voxels, returns the set of its neighbours in it, without the voxel itself.
template <bool by_faces>
constexpr std::array<std::uint32_t, 27> make_neighbours() {
  std::array<std::uint32_t, 27> out{};
  for (int a = 0; a < 27; ++a) {
    for (int b = 0; b < 27; ++b) {
      const int x = a % 3 - b % 3;
      const int y = a / 3 % 3 - b / 3 % 3;
      const int z = a / 9 - b / 9;
      const int steps = x * x + y * y + z * z;
      const bool touch = by_faces ? steps == 1 : steps > 0 && x * x <= 1 && y * y <= 1 && z * z <= 1;
      if (touch) out[static_cast<std::size_t>(a)] |= 1U << b;
    }
  }
  return out;
}
constexpr auto face_neighbours = make_neighbours<true>();
constexpr auto all_neighbours = make_neighbours<false>();
constexpr std::uint32_t middle = 1U << 13;

/// Returns the connected component of `set` that contains `seed` (a single bit).
std::uint32_t grow(std::uint32_t seed, std::uint32_t set, const std::array<std::uint32_t, 27>& neighbours) {
  std::uint32_t grown = seed;
  std::uint32_t fresh = seed;
  while (fresh != 0) {
    const auto at = static_cast<std::size_t>(std::countr_zero(fresh));
    fresh &= fresh - 1;
    const std::uint32_t more = neighbours[at] & set & ~grown;
    grown |= more;
    fresh |= more;
  }
  return grown;
}

}  // namespace

std::array<std::int64_t, 3> betti_numbers(const VoxelSet& voxels, const Context& context) {
  const RunComponents solid(voxels, false, 1, context);
  RunComponents rest(voxels, true, 0, context);
  rest.join_border();
  const std::int64_t components = solid.count();
  const std::int64_t voids = rest.count() - 1;
  return {components, components + voids - euler_characteristic(voxels, context), voids};
}

std::int64_t fill_voids(VoxelSet& voxels, const Context& context) {
  RunComponents rest(voxels, true, 0, context);
  rest.join_border();
  if (rest.count() > 1) rest.add_inner(voxels);
  return rest.count() - 1;
}

std::int64_t euler_characteristic(const VoxelSet& voxels, const Context& context) {
  const auto& size = voxels.size();
  const Rows rows(voxels);
  std::vector<std::int64_t> sums(static_cast<std::size_t>(size[2] + 1), 0);
  parallel_for(context, sums.size(), 1, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      for (std::int64_t j = 0; j <= size[1]; ++j) sums[k] += euler_of_line(rows, j, static_cast<std::int64_t>(k));
    }
  });
  std::int64_t total = 0;
  for (const std::int64_t sum : sums) total += sum;
  return total;
}

Neighbourhood neighbourhood(const VoxelSet& voxels, std::int64_t i, std::int64_t j, std::int64_t k) {
  Neighbourhood bits = 0;
  int at = 0;
  for (std::int64_t z = k - 1; z <= k + 1; ++z) {
    for (std::int64_t y = j - 1; y <= j + 1; ++y) {
      for (std::int64_t x = i - 1; x <= i + 1; ++x, ++at) {
        bits |= static_cast<Neighbourhood>(voxels.contains(x, y, z)) << at;
      }
    }
  }
  return bits;
}

bool is_simple(Neighbourhood around) {
  const std::uint32_t others = around & ~middle;
  if (others == 0) return false;
  if (grow(others & (0U - others), others, all_neighbours) != others) return false;
  constexpr std::uint32_t faces = face_neighbours[13];
  constexpr std::uint32_t corners = 1U << 0 | 1U << 2 | 1U << 6 | 1U << 8 | 1U << 18 | 1U << 20 | 1U << 24 | 1U << 26;
  const std::uint32_t missing = ~around & 0x7ffffffU & ~middle & ~corners;
  const std::uint32_t beside = missing & faces;
  if (beside == 0) return false;
  const std::uint32_t component = grow(beside & (0U - beside), missing, face_neighbours);
  return (beside & ~component) == 0;
}

VoxelTopology voxel_topology(const VoxelSet& voxels, const Context& context) {
  return {betti_numbers(voxels, context), euler_characteristic(voxels, context)};
}

}  // namespace blum
