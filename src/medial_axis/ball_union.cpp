#include "blum/medial_axis/ball_union.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/ids.hpp"
#include "blum/core/parallel.hpp"

namespace blum {
namespace {

/// Blocks of at most this many nodes are not cut any further.
constexpr std::int64_t leaf_nodes = 64;
/// Blocks of at most this many nodes are done by one worker.
constexpr std::int64_t local_nodes = std::int64_t{1} << 18;
/// Balls between two looks at whether the caller has asked to stop.
constexpr std::size_t balls_per_look = std::size_t{1} << 16;
constexpr double largest_length = 1e150;

void check(std::span<const Ball> balls) {
  if (balls.empty()) throw InvalidOption("there are no balls: a union of balls needs at least one");
  if (balls.size() > max_id_count) {
    throw InvalidOption("there are " + std::to_string(balls.size()) + " balls; at most " +
                        std::to_string(max_id_count));
  }
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Vec3d& c = balls[i].centre;
    if (!(std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}) <= largest_length) || !is_finite(c)) {
      throw InvalidOption("the centre of ball " + std::to_string(i) + " is not finite, or beyond 1e150");
    }
    if (!(balls[i].radius >= 0 && balls[i].radius <= largest_length)) {
      throw InvalidOption("the radius of ball " + std::to_string(i) + " must be 0 to 1e150, in mesh units");
    }
  }
}

/// Nodes from `begin` to before `end` along each axis.
struct Block {
  std::array<std::int64_t, 3> begin{};
  std::array<std::int64_t, 3> end{};

  [[nodiscard]] std::int64_t side(std::size_t axis) const { return end[axis] - begin[axis]; }
  [[nodiscard]] std::int64_t node_count() const { return side(0) * side(1) * side(2); }
};

/// The ball around the nodes of a block.
struct Reach {
  Vec3d centre;
  double radius = 0;
};

Reach reach_of(const GridSpec& grid, const Block& block) {
  const Vec3d first = grid.position(block.begin[0], block.begin[1], block.begin[2]);
  const Vec3d last = grid.position(block.end[0] - 1, block.end[1] - 1, block.end[2] - 1);
  const Vec3d sides{static_cast<double>(block.side(0) - 1) * grid.spacing.x,
                    static_cast<double>(block.side(1) - 1) * grid.spacing.y,
                    static_cast<double>(block.side(2) - 1) * grid.spacing.z};
  // A direction may be 1e-6 off from orthonormal.
  return {(first + last) * 0.5, 0.5 * length(sides) * (1 + 1e-5)};
}

/// Halves the longest sides of a block, so that what comes of it is about as long as wide. Calls visit(part).
template <class Visit>
void for_each_part(const GridSpec& grid, const Block& block, const Visit& visit) {
  const auto extent = [&](std::size_t axis) { return static_cast<double>(block.side(axis) - 1) * grid.spacing[axis]; };
  const double longest = std::max({extent(0), extent(1), extent(2)});
  unsigned halved = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) halved |= extent(axis) > 0.6 * longest ? 1U << axis : 0U;
  for (unsigned part = 0; part < 8; ++part) {
    if ((part & ~halved) != 0) continue;
    Block child = block;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((halved >> axis & 1U) == 0) continue;
      const std::int64_t middle = block.begin[axis] + (block.side(axis) + 1) / 2;
      ((part >> axis & 1U) != 0 ? child.begin : child.end)[axis] = middle;
    }
    visit(child);
  }
}

/// Leaves out the balls that are nowhere in a block closer than the one that is closest to its centre.
class Filter {
 public:
  explicit Filter(const Context& context) : context_(context) {}

  /// Calls keep(k) for each k in [0, count) whose ball has to be looked at. Keeps any where the caller asked to stop.
  /// @param ball  k -> ball.
  template <class BallAt, class Keep>
  void run(const Reach& reach, std::size_t count, const BallAt& ball, const Keep& keep) {
    to_centre_.resize(count);
    std::size_t best = 0;
    double best_value = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < count; ++k) {
      if (k % balls_per_look == 0 && context_.cancel.stop_requested()) return;
      to_centre_[k] = length(ball(k).centre - reach.centre);
      const double value = to_centre_[k] - ball(k).radius;
      if (value < best_value) {
        best_value = value;
        best = k;
      }
    }
    const Ball closest = ball(best);  // a copy: keep() may move the balls
    for (std::size_t k = 0; k < count; ++k) {
      if (k % balls_per_look == 0 && context_.cancel.stop_requested()) return;
      const double behind = to_centre_[k] - ball(k).radius - best_value;
      if (k == best || (behind < 2 * reach.radius && may_catch_up(reach, best, closest, k, ball(k), behind))) keep(k);
    }
  }

 private:
  /// Whether a ball that is this much further from the centre than the closest one may be closer somewhere in reach.
  [[nodiscard]] bool may_catch_up(const Reach& reach, std::size_t best, const Ball& closest, std::size_t k,
                                  const Ball& other, double behind) const {
    const double apart = length(other.centre - closest.centre);
    if (apart <= closest.radius - other.radius) return false;  // it lies in the closest one
    // The difference of the two distances changes by |u - v| per length, u and v the directions from the two centres;
    // and |u - v| <= 2 apart / (|x - centre| + |x - other centre|) everywhere.
    const double sum = to_centre_[best] + to_centre_[k] - 2 * reach.radius;
    return behind * sum < 2 * apart * reach.radius || sum <= 0;
  }

  const Context& context_;
  std::vector<double> to_centre_;
};

/// Blocks, and the balls that have to be looked at in them.
struct Task {
  Block block;
  std::vector<std::uint32_t> balls;
};

/// Cuts the grid into blocks that one worker each does, level by level, each with its own part of the balls.
std::vector<Task> cut_grid(std::span<const Ball> balls, const GridSpec& grid, const Context& context) {
  Task whole{{{0, 0, 0}, grid.size}, std::vector<std::uint32_t>(balls.size())};
  std::iota(whole.balls.begin(), whole.balls.end(), 0U);
  std::vector<Task> tasks;
  tasks.push_back(std::move(whole));
  while (tasks.front().block.node_count() > local_nodes) {
    std::vector<Task> parts;
    std::vector<std::size_t> parents;
    for (std::size_t t = 0; t < tasks.size(); ++t) {
      for_each_part(grid, tasks[t].block, [&](const Block& block) {
        parts.push_back({block, {}});
        parents.push_back(t);
      });
    }
    parallel_for(context, parts.size(), 1, "", [&](const WorkRange& range) {
      const std::vector<std::uint32_t>& all = tasks[parents[range.begin]].balls;
      Task& part = parts[range.begin];
      Filter(context).run(
          reach_of(grid, part.block), all.size(), [&](std::size_t k) -> const Ball& { return balls[all[k]]; },
          [&](std::size_t k) { part.balls.push_back(all[k]); });
    });
    tasks = std::move(parts);
  }
  return tasks;
}

/// Fills blocks, octant by octant, with the balls of the blocks around them on a stack.
class BlockFiller {
 public:
  BlockFiller(const GridSpec& grid, const Context& context, std::span<float> values)
      : grid_(grid), context_(context), filter_(context), values_(values) {}

  void fill(const Task& task, std::span<const Ball> balls) {
    stack_.clear();
    for (const std::uint32_t ball : task.balls) stack_.push_back(balls[ball]);
    fill(task.block, 0);
  }

 private:
  using Coordinates = std::array<double, leaf_nodes>;

  /// Fills a block from the balls of the stack from `begin` on.
  void fill(const Block& block, std::size_t begin) {
    if (context_.cancel.stop_requested()) return;
    const std::size_t end = stack_.size();
    filter_.run(
        reach_of(grid_, block), end - begin, [&](std::size_t k) -> const Ball& { return stack_[begin + k]; },
        [&](std::size_t k) { stack_.push_back(stack_[begin + k]); });
    if (block.node_count() <= leaf_nodes) {
      fill_leaf(block, end);
    } else {
      for_each_part(grid_, block, [&](const Block& part) { fill(part, end); });
    }
    stack_.resize(end);
  }

  void fill_leaf(const Block& block, std::size_t begin) {
    Coordinates x{};
    Coordinates y{};
    Coordinates z{};
    const std::size_t count = read_positions(block, x, y, z);
    Coordinates best{};
    best.fill(std::numeric_limits<double>::infinity());
    for (std::size_t k = begin; k < stack_.size(); ++k) {
      if ((k - begin) % balls_per_look == 0 && context_.cancel.stop_requested()) return;
      const Vec3d centre = stack_[k].centre;
      const double radius = stack_[k].radius;
      for (std::size_t node = 0; node < count; ++node) {
        const double dx = x[node] - centre.x;
        const double dy = y[node] - centre.y;
        const double dz = z[node] - centre.z;
        const double value = std::sqrt(dx * dx + dy * dy + dz * dz) - radius;
        best[node] = value < best[node] ? value : best[node];
      }
    }
    write(block, best);
  }

  std::size_t read_positions(const Block& block, Coordinates& x, Coordinates& y, Coordinates& z) const {
    std::size_t count = 0;
    for (std::int64_t k = block.begin[2]; k < block.end[2]; ++k) {
      for (std::int64_t j = block.begin[1]; j < block.end[1]; ++j) {
        for (std::int64_t i = block.begin[0]; i < block.end[0]; ++i) {
          const Vec3d p = grid_.position(i, j, k);
          x[count] = p.x;
          y[count] = p.y;
          z[count++] = p.z;
        }
      }
    }
    return count;
  }

  void write(const Block& block, const Coordinates& best) {
    const double* next = best.data();
    for (std::int64_t k = block.begin[2]; k < block.end[2]; ++k) {
      for (std::int64_t j = block.begin[1]; j < block.end[1]; ++j) {
        for (std::int64_t i = block.begin[0]; i < block.end[0]; ++i) {
          values_[grid_.index(i, j, k)] = static_cast<float>(*next++);
        }
      }
    }
  }

  const GridSpec& grid_;
  const Context& context_;
  Filter filter_;
  std::span<float> values_;
  std::vector<Ball> stack_;
};

}  // namespace

Box3 bounds(std::span<const Ball> balls) {
  Box3 box;
  for (const Ball& ball : balls) {
    const Vec3d reach{ball.radius, ball.radius, ball.radius};
    box.extend({ball.centre - reach, ball.centre + reach});
  }
  return box;
}

Field ball_union_field(std::span<const Ball> balls, const GridSpec& grid, const Context& context) {
  check(balls);
  validate(grid);
  (void)thread_count(context);
  Field field;
  field.grid = grid;
  field.distance = Buffer<float>(grid.node_count());
  field.sign_reason = "negative inside a ball";
  const std::vector<Task> tasks = cut_grid(balls, grid, context);
  parallel_for(context, tasks.size(), 1, "balls", [&](const WorkRange& range) {
    BlockFiller(grid, context, field.distance.span()).fill(tasks[range.begin], balls);
  });
  return field;
}

}  // namespace blum
