#include "medial_axis/topology_repair.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <queue>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "medial_axis/spread_voxels.hpp"

namespace blum {
namespace {

constexpr std::size_t steps_between_looks = std::size_t{1} << 16U;

using Place = std::array<std::int64_t, 3>;

/// A voxel in line, deepest first.
struct Waiting {
  float depth;
  std::uint32_t voxel;
  [[nodiscard]] friend bool operator<(const Waiting& a, const Waiting& b) {
    return a.depth != b.depth ? a.depth < b.depth : a.voxel > b.voxel;
  }
};

class Chooser {
 public:
  Chooser(std::span<const float> depth, VoxelSet& voxels, const Context& context)
      : depth_(depth), voxels_(voxels), size_(voxels.size()), context_(context), is_waiting_(depth.size(), false) {}

  [[nodiscard]] BettiNumbers betti() const { return betti_numbers(voxels_, context_); }

  void take_deeper_than(double limit) { blum::take_deeper_than(depth_, limit, voxels_, context_); }

  /// Takes in simple voxels deeper than `limit`, the deepest first, until none is left.
  void grow(double limit) {
    limit_ = limit;
    for_each([&](const Place& at) {
      if (voxels_.contains(at[0], at[1], at[2])) offer_around(at);
    });
    take_in_line();
  }

  /// Takes in one voxel that is not simple, and then simple ones again.
  void force(const Place& at) {
    take(at);
    take_in_line();
  }

  void start_at_deepest(double limit) {
    voxels_ = VoxelSet(size_);
    limit_ = limit;
    Place deepest{1, 1, 1};
    for_each([&](const Place& at) {
      if (depth_[index(at)] > depth_[index(deepest)]) deepest = at;
    });
    force(deepest);
  }

  /// Takes in simple voxels of those that a thin part of the solid may pass through: no deep voxel is near, so that the
  /// part may miss the centres of all voxels, or of some. @param half  of a voxel's diagonal.
  void reach_into_thin_parts(double half) {
    constexpr int near = 3;
    VoxelSet touched(size_);
    blum::take_deeper_than(depth_, -half, touched, context_);
    VoxelSet deep(size_);
    blum::take_deeper_than(depth_, half, deep, context_);
    const VoxelSet thick = spread(deep, near, context_);
    VoxelSet lost(size_);
    for_each_word([&](std::size_t w, std::int64_t j, std::int64_t k) {
      lost.row(j, k)[w] = touched.row(j, k)[w] & ~thick.row(j, k)[w] & ~voxels_.row(j, k)[w];
    });
    if (lost.count() == 0) return;
    // Such voxels hang together with the others through those near by that the solid passes, too.
    VoxelSet allowed = spread(lost, near + 1, context_);
    for_each_word([&](std::size_t w, std::int64_t j, std::int64_t k) { allowed.row(j, k)[w] &= touched.row(j, k)[w]; });
    limit_ = -half;
    allowed_ = &allowed;
    // Those that are not next to the set yet are not simple; they are offered again when a neighbour is taken in.
    for_each([&](const Place& at) {
      if (allowed.contains(at[0], at[1], at[2])) offer(at);
    });
    take_in_line();
    allowed_ = nullptr;
  }

  /// Leaves out simple voxels whose centre is outside, the outermost first.
  void shrink() {
    std::priority_queue<Waiting> line;  // by falling -depth
    const auto offer = [&](const Place& at) {
      const std::size_t v = index(at);
      if (depth_[v] > 0 || !voxels_.contains(at[0], at[1], at[2])) return;
      line.push({-depth_[v], static_cast<std::uint32_t>(v)});
    };
    for_each(offer);
    while (!line.empty()) {
      const Place at = voxels_.place(line.top().voxel);
      line.pop();
      look();
      if (!voxels_.contains(at[0], at[1], at[2])) continue;
      if (!is_simple(neighbourhood(voxels_, at[0], at[1], at[2]))) continue;
      voxels_.erase(at[0], at[1], at[2]);
      for_each_around(at, offer);
    }
  }

  /// The voxels next to the set that are deeper than the limit and were not simple, deepest first.
  [[nodiscard]] std::vector<Place> left_over() const {
    std::vector<Waiting> found;
    for_each([&](const Place& at) {
      const std::size_t v = index(at);
      if (!(depth_[v] > limit_) || voxels_.contains(at[0], at[1], at[2])) return;
      if ((neighbourhood(voxels_, at[0], at[1], at[2]) & ~(1U << 13U)) == 0) return;
      found.push_back({depth_[v], static_cast<std::uint32_t>(v)});
    });
    std::sort(found.begin(), found.end(), [](const Waiting& a, const Waiting& b) { return b < a; });
    std::vector<Place> places;
    for (const Waiting& w : found) places.push_back(voxels_.place(w.voxel));
    return places;
  }

  RepairReport report() const {
    RepairReport report;
    for_each([&](const Place& at) {
      const float depth = depth_[index(at)];
      const bool is_in = voxels_.contains(at[0], at[1], at[2]);
      if (is_in == (depth > 0)) return;
      ++(is_in ? report.added : report.removed);
      report.deviation = std::max(report.deviation, std::abs(static_cast<double>(depth)));
    });
    report.betti = betti();
    return report;
  }

 private:
  [[nodiscard]] std::size_t index(const Place& at) const {
    return static_cast<std::size_t>((at[2] * size_[1] + at[1]) * size_[0] + at[0]);
  }

  template <class Visit>
  void for_each_word(const Visit& visit) const {
    for (std::int64_t k = 0; k < size_[2]; ++k) {
      for (std::int64_t j = 0; j < size_[1]; ++j) {
        for (std::size_t w = 0; w < voxels_.words_per_row(); ++w) visit(w, j, k);
      }
    }
  }
  /// All voxels but those of the outermost layer.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::int64_t k = 1; k + 1 < size_[2]; ++k) {
      throw_if_cancelled(context_);
      for (std::int64_t j = 1; j + 1 < size_[1]; ++j) {
        for (std::int64_t i = 1; i + 1 < size_[0]; ++i) visit(Place{i, j, k});
      }
    }
  }
  template <class Visit>
  void for_each_around(const Place& at, const Visit& visit) const {
    for (int n = 0; n < 27; ++n) {
      const Place next{at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1};
      const auto is_within = [&](std::size_t a) { return next[a] > 0 && next[a] + 1 < size_[a]; };
      if (n != 13 && is_within(0) && is_within(1) && is_within(2)) visit(next);
    }
  }

  void offer(const Place& at) {
    const std::size_t v = index(at);
    if (is_waiting_[v] || !(depth_[v] > limit_) || voxels_.contains(at[0], at[1], at[2])) return;
    if (allowed_ != nullptr && !allowed_->contains(at[0], at[1], at[2])) return;
    is_waiting_[v] = true;
    line_.push({depth_[v], static_cast<std::uint32_t>(v)});
  }
  void offer_around(const Place& at) {
    for_each_around(at, [&](const Place& next) { offer(next); });
  }
  void take(const Place& at) {
    voxels_.insert(at[0], at[1], at[2]);
    offer_around(at);
  }
  void take_in_line() {
    while (!line_.empty()) {
      const std::uint32_t v = line_.top().voxel;
      line_.pop();
      is_waiting_[v] = false;
      look();
      const Place at = voxels_.place(v);
      if (voxels_.contains(at[0], at[1], at[2])) continue;
      if (is_simple(neighbourhood(voxels_, at[0], at[1], at[2]))) take(at);
    }
  }
  void look() {
    if (++looks_ % steps_between_looks == 0) throw_if_cancelled(context_);
  }

  std::span<const float> depth_;
  VoxelSet& voxels_;
  std::array<std::int64_t, 3> size_;
  const Context& context_;
  double limit_ = 0;
  const VoxelSet* allowed_ = nullptr;  ///< nullptr: all
  std::priority_queue<Waiting> line_;
  std::vector<bool> is_waiting_;
  std::size_t looks_ = 0;
};

/// Grows from a set of the right topology that thresholds give, if one does.
bool grow_from_threshold(Chooser& chooser, const BettiNumbers& wanted, double tolerance) {
  for (const double part : {0.5, 1.0, 0.25, 0.75}) {
    chooser.take_deeper_than(part * tolerance);
    if (chooser.betti() != wanted) continue;
    chooser.grow(0);
    return true;
  }
  for (const double part : {0.5, 1.0, 0.25}) {
    chooser.take_deeper_than(-part * tolerance);
    if (chooser.betti() != wanted) continue;
    chooser.shrink();
    return true;
  }
  return false;
}

/// Takes in the deepest voxel that brings one handle, or one void, more and changes nothing else.
bool add_feature(Chooser& chooser, VoxelSet& voxels, const BettiNumbers& have, const BettiNumbers& wanted) {
  constexpr int most_trials = 200;
  int trials = 0;
  for (const std::array<std::int64_t, 3>& at : chooser.left_over()) {
    if (++trials > most_trials) return false;
    voxels.insert(at[0], at[1], at[2]);
    const BettiNumbers with = chooser.betti();
    voxels.erase(at[0], at[1], at[2]);
    const bool is_handle = with[1] == have[1] + 1 && with[2] == have[2] && have[1] < wanted[1];
    const bool is_void = with[2] == have[2] + 1 && with[1] == have[1] && have[2] < wanted[2];
    if (with[0] != have[0] || !(is_handle || is_void)) continue;
    chooser.force(at);
    return true;
  }
  return false;
}

bool grow_from_deepest(Chooser& chooser, VoxelSet& voxels, const BettiNumbers& wanted, double limit) {
  chooser.start_at_deepest(limit);
  while (true) {
    const BettiNumbers have = chooser.betti();
    if (have == wanted) return true;
    if (!add_feature(chooser, voxels, have, wanted)) return false;
  }
}

}  // namespace

void take_deeper_than(std::span<const float> depth, double limit, VoxelSet& voxels, const Context& context) {
  const Place size = voxels.size();
  voxels = VoxelSet(size);
  parallel_for(context, static_cast<std::size_t>(size[2]), 1, "", [&](const WorkRange& range) {
    for (auto k = static_cast<std::int64_t>(range.begin); k < static_cast<std::int64_t>(range.end); ++k) {
      if (k == 0 || k + 1 == size[2]) continue;
      for (std::int64_t j = 1; j + 1 < size[1]; ++j) {
        for (std::int64_t i = 1; i + 1 < size[0]; ++i) {
          const auto voxel = static_cast<std::size_t>((k * size[1] + j) * size[0] + i);
          if (static_cast<double>(depth[voxel]) > limit) voxels.insert(i, j, k);
        }
      }
    }
  });
}

RepairReport choose_voxels(std::span<const float> depth, const BettiNumbers& wanted, double tolerance, VoxelSet& voxels,
                           const Context& context) {
  Chooser chooser(depth, voxels, context);
  chooser.take_deeper_than(0);
  if (chooser.betti() != wanted && !grow_from_threshold(chooser, wanted, tolerance) &&
      !grow_from_deepest(chooser, voxels, wanted, 0)) {
    (void)grow_from_deepest(chooser, voxels, wanted, -tolerance);
    chooser.shrink();
  }
  chooser.reach_into_thin_parts(0.5 * tolerance);
  RepairReport report = chooser.report();
  report.is_right = report.betti == wanted;
  return report;
}

}  // namespace blum
