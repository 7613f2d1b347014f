#include "medial_axis/cells/collapse.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <queue>

#include "blum/core/gather.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t removals_between_looks = std::size_t{1} << 16U;

/// Queue of free faces, ordered by depth, which is rounded down to whole steps. Faces of one step are popped in the
/// order in which they were pushed.
class DepthQueue {
 public:
  void push(Cell face, double depth) {
    const auto step = static_cast<std::size_t>(std::clamp(depth, 0.0, 65535.0));
    if (step >= steps_.size()) steps_.resize(step + 1);
    steps_[step].cells.push_back(face);
    first_ = std::min(first_, step);
    ++size_;
  }
  [[nodiscard]] bool is_empty() const { return size_ == 0; }
  Cell pop() {
    while (steps_[first_].next == steps_[first_].cells.size()) {
      steps_[first_].cells.clear();
      steps_[first_].next = 0;
      ++first_;
    }
    --size_;
    return steps_[first_].cells[steps_[first_].next++];
  }

 private:
  struct Step {
    std::vector<Cell> cells;
    std::size_t next = 0;
  };
  std::vector<Step> steps_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

struct ImportantFace {
  float importance;
  float depth;
  Cell face;
  [[nodiscard]] friend bool operator>(const ImportantFace& a, const ImportantFace& b) {
    if (a.importance != b.importance) return a.importance > b.importance;
    if (a.depth != b.depth) return a.depth > b.depth;
    return a.face > b.face;
  }
};

class Collapser {
 public:
  Collapser(CellComplex& complex, const CellDepths& depths, double depth_step, const Importance& importance,
            const Context& context)
      : complex_(complex),
        structure_(complex.structure()),
        depth_(depths.of_voxels),
        depth_of_extra_(depths.of_extra),
        per_step_(1 / depth_step),
        importance_(importance),
        context_(context) {}

  void remove_cubes() {
    offer_all(2, 2);
    run([](Cell, Cell, float) {}, [&](Cell cube, Cell) { offer_faces(cube); });
  }

  /// Removes pairs of a square and an edge, or of an edge and a vertex, with importance zero. The function
  /// remove_rest() then removes all other cells by importance.
  void remove_unimportant() {
    level_ = 0;
    offer_all(0, 1);
    run_unimportant([](Cell, Cell, float) {}, next_);
  }
  std::vector<Removal> remove_rest(double most_level) {
    most_level_ = most_level;
    std::vector<Removal> removals;
    run([&](Cell cell, Cell face, float level) { removals.push_back({cell, face, level}); }, next_);
    return removals;
  }

 private:
  /// Returns the mean depth of the voxels around a cell; depths outside the solid are negative.
  [[nodiscard]] double depth_of(Cell cell) const {
    if (structure_.is_extra(cell)) return depth_of_extra_[cell - structure_.first_extra()];
    const CellLattice& lattice = structure_.lattice();
    const auto& nodes = lattice.size();
    const auto [i, j, k] = lattice.place(node_of(cell));
    const CellAxes axes = axes_of(cell);
    double sum = 0;
    int count = 0;
    for (unsigned v = 0; v < 8; ++v) {
      if ((v & axes) != axes) continue;
      const auto x = i - 1 + static_cast<std::int64_t>(v & 1U);
      const auto y = j - 1 + static_cast<std::int64_t>(v >> 1U & 1U);
      const auto z = k - 1 + static_cast<std::int64_t>(v >> 2U);
      sum += depth_[static_cast<std::size_t>((z * (nodes[1] - 1) + y) * (nodes[0] - 1) + x)];
      ++count;
    }
    return sum / count;
  }

  /// Queues a face if it is free.
  void offer(Cell face) {
    if (complex_.contains(face) && complex_.only_coface(face) != face) enter(face);
  }
  void enter(Cell face) {
    const float importance = importance_.of(face);
    const double depth = depth_of(face);
    if (importance > 0) {
      important_.push({importance, static_cast<float>(depth), face});
    } else {
      unimportant_.push(face, depth * per_step_ + 1);
    }
  }
  /// Queues all free cells from `least_dimension` to `most_dimension`, both included, ascending; cells of the lattice
  /// come first.
  void offer_all(int least_dimension, int most_dimension) {
    constexpr std::size_t grain = std::size_t{1} << 16U;
    unsigned wanted = 0;  // bit a: the cells that span `a` from a node
    for (CellAxes axes = 0; axes < 8; ++axes) {
      const int dimension = dimension_of(cell_at(0, axes));
      if (least_dimension <= dimension && dimension <= most_dimension) wanted |= 1U << axes;
    }
    const std::span<const std::uint8_t> bytes = complex_.bytes();
    const std::vector<Cell> free =
        detail::gather<Cell>(context_, bytes.size(), grain, {}, [&](std::size_t node, std::vector<Cell>& found) {
          for (unsigned rest = bytes[node] & wanted; rest != 0; rest &= rest - 1) {
            const Cell cell = cell_at(node, static_cast<CellAxes>(std::countr_zero(rest)));
            if (complex_.only_coface(cell) != cell) found.push_back(cell);
          }
        });
    for (const Cell cell : free) enter(cell);
    for (std::size_t k = 0; k < structure_.extra_count(); ++k) {
      const Cell cell = structure_.first_extra() + static_cast<Cell>(k);
      const int dimension = structure_.dimension(cell);
      if (least_dimension <= dimension && dimension <= most_dimension) offer(cell);
    }
  }
  void offer_faces(Cell cell) {
    structure_.for_each_face(cell, [&](Cell face) { offer(face); });
  }

  template <class Record, class Next>
  void remove(Cell face, const Record& record, const Next& next) {
    if (!complex_.contains(face)) return;
    const Cell cell = complex_.only_coface(face);
    if (cell == face) return;
    complex_.erase(cell);
    complex_.erase(face);
    record(cell, face, level_);
    next(cell, face);
    if (++removals_ % removals_between_looks == 0) throw_if_cancelled(context_);
  }

  template <class Record, class Next>
  void run_unimportant(const Record& record, const Next& next) {
    while (!unimportant_.is_empty()) remove(unimportant_.pop(), record, next);
  }
  template <class Record, class Next>
  void run(const Record& record, const Next& next) {
    run_unimportant(record, next);
    while (!important_.empty()) {
      const ImportantFace first = important_.top();
      if (first.importance > most_level_) return;
      important_.pop();
      level_ = std::max(level_, first.importance);
      remove(first.face, record, next);
      run_unimportant(record, next);
    }
  }

  CellComplex& complex_;
  const CellStructure& structure_;
  std::span<const float> depth_;
  std::span<const float> depth_of_extra_;
  double per_step_;
  const Importance& importance_;
  const Context& context_;
  DepthQueue unimportant_;
  std::priority_queue<ImportantFace, std::vector<ImportantFace>, std::greater<>> important_;
  float level_ = 0;
  double most_level_ = HUGE_VAL;
  std::size_t removals_ = 0;
  /// Offers the faces of both removed cells, which may have become free.
  struct Next {
    Collapser& collapser;
    void operator()(Cell cell, Cell face) const {
      collapser.offer_faces(cell);
      collapser.offer_faces(face);
    }
  };
  Next next_{*this};
};

}  // namespace

void collapse_extra(CellComplex& complex, const Importance& importance) {
  const CellStructure& structure = complex.structure();
  if (structure.extra() == nullptr) return;
  std::vector<Cell> line;
  const auto offer = [&](Cell face) {
    if (structure.is_extra(face) && importance.of(face) == 0) line.push_back(face);
  };
  for (std::size_t k = 0; k < structure.extra_count(); ++k) offer(structure.first_extra() + static_cast<Cell>(k));
  std::size_t next = 0;
  while (next < line.size()) {
    const Cell face = line[next++];
    if (!complex.contains(face)) continue;
    const Cell cell = complex.only_coface(face);
    if (cell == face || !structure.is_extra(cell)) continue;
    complex.erase(cell);
    complex.erase(face);
    structure.for_each_face(cell, offer);
    structure.for_each_face(face, offer);
  }
}

CollapseOrder collapse(CellComplex complex, const CellDepths& depths, double depth_step, const Importance& importance,
                       double most_level, const Context& context) {
  Collapser collapser(complex, depths, depth_step, importance, context);
  collapser.remove_cubes();
  collapser.remove_unimportant();
  CollapseOrder order;
  order.base = complex.clone();
  order.removals = collapser.remove_rest(most_level);
  return order;
}

}  // namespace blum::detail
