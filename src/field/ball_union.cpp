#include "blum/field/ball_union.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/ids.hpp"
#include "blum/core/parallel.hpp"

namespace blum {
namespace {

/// Blocks of at most this many nodes are not split further.
constexpr std::int64_t leaf_nodes = 8;
/// A block of at most this many nodes is one worker's task.
constexpr std::int64_t local_nodes = std::int64_t{1} << 18;
/// Limit of coordinates and radii: up to it, float32 can represent all distances.
constexpr double largest_length = 1e37;

void check(std::span<const Ball> balls) {
  if (balls.empty()) throw InvalidOption("there are no balls: a union of balls needs at least one");
  if (balls.size() > max_id_count) {
    throw InvalidOption("there are " + std::to_string(balls.size()) + " balls, but the limit is " +
                        std::to_string(max_id_count));
  }
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Vec3d& c = balls[i].centre;
    if (!(std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}) <= largest_length) || !is_finite(c)) {
      throw InvalidOption("the centre of ball " + std::to_string(i) + " is not finite, or beyond 1e37");
    }
    if (!(balls[i].radius >= 0 && balls[i].radius <= largest_length)) {
      throw InvalidOption("the radius of ball " + std::to_string(i) + " must be 0 to 1e37, in mesh units");
    }
  }
}

/// Block of nodes. Along each axis its node indices are at least `begin` and below `end`.
struct Block {
  std::array<std::int64_t, 3> begin{};
  std::array<std::int64_t, 3> end{};

  [[nodiscard]] std::int64_t side(std::size_t axis) const { return end[axis] - begin[axis]; }
  [[nodiscard]] std::int64_t node_count() const { return side(0) * side(1) * side(2); }
};

/// Ball that contains all nodes of a block.
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
  // The factor leaves room for error: direction vectors may deviate from orthonormal by 1e-6.
  return {(first + last) * 0.5, 0.5 * length(sides) * (1 + 1e-5)};
}

/// Halves a block along each axis on which it is longer than 60 % of its longest side. Calls visit(part) for each part.
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

/// Balls as one array per coordinate.
struct BallRows {
  std::vector<double> x, y, z, radius;

  [[nodiscard]] std::size_t size() const { return x.size(); }
  void resize(std::size_t size) {
    for (std::vector<double>* row : {&x, &y, &z, &radius}) row->resize(size);
  }
  void push_back(const Ball& ball) {
    x.push_back(ball.centre.x);
    y.push_back(ball.centre.y);
    z.push_back(ball.centre.z);
    radius.push_back(ball.radius);
  }
  [[nodiscard]] Ball operator[](std::size_t k) const { return {{x[k], y[k], z[k]}, radius[k]}; }
};

/// Removes balls that cannot be the closest ball anywhere in a block. Compares each ball with the ball closest to the
/// block's centre.
class Filter {
 public:
  /// Calls keep(ball), in order, for each ball in [begin, end) that may be closest somewhere in a block. keep may
  /// append balls to `balls`.
  template <class Keep>
  void run(const Reach& reach, const BallRows& balls, std::size_t begin, std::size_t end, const Keep& keep) {
    measure(reach, balls, begin, end);
    const std::size_t best = smallest_value(end - begin);
    compare(reach, balls, begin, end, best);
    lead_[best] = -1;
    for (std::size_t k = 0; k < end - begin; ++k) {
      if (lead_[k] < 0) keep(balls[begin + k]);
    }
  }

 private:
  /// Measures the distance from the block's centre to each ball's centre (`to_centre_`), and to each ball (`value_`,
  /// negative inside the ball).
  void measure(const Reach& reach, const BallRows& balls, std::size_t begin, std::size_t end) {
    const std::size_t count = end - begin;
    if (to_centre_.size() < count) {
      to_centre_.resize(count);
      value_.resize(count);
      lead_.resize(count);
    }
    const double* const x = balls.x.data() + begin;
    const double* const y = balls.y.data() + begin;
    const double* const z = balls.z.data() + begin;
    const double* const radius = balls.radius.data() + begin;
    for (std::size_t k = 0; k < count; ++k) {
      const double dx = x[k] - reach.centre.x;
      const double dy = y[k] - reach.centre.y;
      const double dz = z[k] - reach.centre.z;
      to_centre_[k] = std::sqrt(dx * dx + dy * dy + dz * dz);
      value_[k] = to_centre_[k] - radius[k];
    }
  }

  /// Returns the index of the first smallest value. This is faster than std::min_element, in which each comparison
  /// depends on the previous comparison.
  [[nodiscard]] std::size_t smallest_value(std::size_t count) const {
    constexpr std::size_t lanes = 8;
    std::array<double, lanes> least{};
    least.fill(std::numeric_limits<double>::infinity());
    std::size_t k = 0;
    for (; k + lanes <= count; k += lanes) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        least[lane] = value_[k + lane] < least[lane] ? value_[k + lane] : least[lane];
      }
    }
    double smallest = *std::min_element(least.begin(), least.end());
    for (; k < count; ++k) smallest = std::min(smallest, value_[k]);
    return static_cast<std::size_t>(std::find(value_.begin(), value_.end(), smallest) - value_.begin());
  }

  /// Sets `lead_` for each ball. `lead_` is negative if, somewhere in the block, the ball may be closer than the best
  /// ball. The best ball is the closest ball at the block's centre.
  ///
  /// For two balls, the difference of their distances changes along a path by at most |u - v| per unit of length. Let
  /// `one` and `other` be the two centres. Then u and v are the unit directions from them to the point x. The length |u
  /// - v| is at most 2, and at most 2 apart / (|x - one| + |x - other|) (Dunkl, Williams 1964). Here `apart` is the
  /// distance between the centres.
  void compare(const Reach& reach, const BallRows& balls, std::size_t begin, std::size_t end, std::size_t best) {
    const Ball closest = balls[begin + best];
    const double best_value = value_[best];
    const double best_sum = to_centre_[best] - 2 * reach.radius;
    const double four = 4 * reach.radius * reach.radius;
    const double* const x = balls.x.data() + begin;
    const double* const y = balls.y.data() + begin;
    const double* const z = balls.z.data() + begin;
    const double* const radius = balls.radius.data() + begin;
    const double* const value = value_.data();
    const double* const to_centre = to_centre_.data();
    double* const lead = lead_.data();
    for (std::size_t k = 0; k < end - begin; ++k) {
      const double dx = x[k] - closest.centre.x;
      const double dy = y[k] - closest.centre.y;
      const double dz = z[k] - closest.centre.z;
      const double squared_apart = dx * dx + dy * dy + dz * dz;
      const double behind = value[k] - best_value;
      const double sum = to_centre[k] + best_sum;
      const double catching_up = sum > 0 ? behind * behind * sum * sum - four * squared_apart : -1;
      const double near = behind - 2 * reach.radius;
      const double deeper = closest.radius > radius[k] ? closest.radius - radius[k] : 0;
      const double inside = deeper * deeper - squared_apart;  // at least 0 if the ball lies inside the closest ball
      const double lead_or_near = catching_up > near ? catching_up : near;
      lead[k] = inside > lead_or_near ? inside : lead_or_near;
    }
  }

  std::vector<double> to_centre_;
  std::vector<double> value_;
  std::vector<double> lead_;  ///< per ball: negative if it may be the closest ball somewhere in the block
};

/// A block, and the balls that may be closest in it.
struct Task {
  Block block;
  BallRows balls;
};

/// Splits the grid, level by level, into blocks, one per task. Each task lists only the balls that may be closest in
/// its block.
std::vector<Task> cut_grid(std::span<const Ball> balls, const GridSpec& grid, const Context& context) {
  std::vector<Task> tasks(1);
  tasks[0].block.end = grid.size;
  for (const Ball& ball : balls) tasks[0].balls.push_back(ball);
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
      const BallRows& all = tasks[parents[range.begin]].balls;
      Task& part = parts[range.begin];
      Filter().run(reach_of(grid, part.block), all, 0, all.size(),
                   [&](const Ball& ball) { part.balls.push_back(ball); });
    });
    tasks = std::move(parts);
  }
  return tasks;
}

/// Fills blocks, octant by octant. A stack contains the candidate balls of the current block and of all blocks that
/// contain it.
class BlockFiller {
 public:
  BlockFiller(const GridSpec& grid, const Context& context, std::span<float> values)
      : grid_(grid), context_(context), values_(values) {}

  void fill(const Task& task) {
    stack_ = task.balls;
    fill(task.block, 0);
  }

 private:
  using Coordinates = std::array<double, leaf_nodes>;

  /// Fills a block. The block's candidates are the balls of the stack with indices from `begin` to the end.
  void fill(const Block& block, std::size_t begin) {
    if (context_.cancel.stop_requested()) return;
    const std::size_t end = stack_.size();
    filter_.run(reach_of(grid_, block), stack_, begin, end, [&](const Ball& ball) { stack_.push_back(ball); });
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
    read_positions(block, x, y, z);
    Coordinates best{};
    best.fill(std::numeric_limits<double>::infinity());
    for (std::size_t k = begin; k < stack_.size(); ++k) {
      const auto [centre, radius] = stack_[k];
      for (std::size_t node = 0; node < best.size(); ++node) {
        const double dx = x[node] - centre.x;
        const double dy = y[node] - centre.y;
        const double dz = z[node] - centre.z;
        const double value = std::sqrt(dx * dx + dy * dy + dz * dz) - radius;
        best[node] = value < best[node] ? value : best[node];
      }
    }
    write(block, best);
  }

  void read_positions(const Block& block, Coordinates& x, Coordinates& y, Coordinates& z) const {
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
  BallRows stack_;
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
  field.sign_rule = SignRule::balls;
  field.sign_reason = "a point is inside if it lies in a ball";
  const std::vector<Task> tasks = cut_grid(balls, grid, context);
  parallel_for(context, tasks.size(), 1, "balls", [&](const WorkRange& range) {
    BlockFiller(grid, context, field.distance.span()).fill(tasks[range.begin]);
  });
  return field;
}

}  // namespace blum
