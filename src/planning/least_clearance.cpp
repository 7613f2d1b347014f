#include "planning/least_clearance.hpp"

#include <algorithm>
#include <limits>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"

namespace blum::detail {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Best-first search over intervals of all motions.
class LeastSearch {
 public:
  explicit LeastSearch(std::span<MotionTests> motions) : motions_(motions) {}

  LeastClearance run(double tolerance) {
    for (std::size_t motion = 0; motion < motions_.size(); ++motion) {
      for (std::size_t pair = 0; pair < motions_[motion].pairs(); ++pair) add(motion, pair, {});
    }
    while (!open_.empty() && !is_narrow(open_.front(), tolerance)) {
      std::pop_heap(open_.begin(), open_.end(), is_after);
      const Item item = open_.back();
      open_.pop_back();
      const double middle = item.at.middle();
      add(item.motion, item.pair, {item.at.from, middle});
      add(item.motion, item.pair, {middle, item.at.to});
    }
    out_.at_least = open_.empty() ? infinity : std::max(0.0, open_.front().least);
    for (const Item& item : open_) out_.intervals.push_back({item.motion, item.at, std::max(0.0, item.least)});
    return std::move(out_);
  }

 private:
  struct Item {
    double least = 0;  ///< lower bound of the distance
    std::size_t motion = 0, pair = 0;
    TimeInterval at;
  };
  static bool is_after(const Item& a, const Item& b) { return a.least > b.least; }

  /// Adds an interval with the bound that the distance at its middle gives.
  void add(std::size_t motion, std::size_t pair, const TimeInterval& at) {
    const MotionTests::Least found = motions_[motion].least_during(pair, at, smallest_);
    if (found.closest && found.closest->distance < smallest_) {
      smallest_ = found.closest->distance;
      out_.closest = found.closest;
      out_.motion = motion;
      out_.time = at.middle();
    }
    open_.push_back({found.bound, motion, pair, at});
    std::push_heap(open_.begin(), open_.end(), is_after);
  }

  [[nodiscard]] bool is_narrow(const Item& item, double tolerance) const {
    const MotionTests& tests = motions_[item.motion];
    const double enough = std::min((1 - tolerance) * smallest_, smallest_ - 16 * tests.error(item.pair));
    return smallest_ == 0 || item.least >= enough || item.at.is_single();
  }

  std::span<MotionTests> motions_;
  std::vector<Item> open_;  ///< a heap, smallest lower bound first
  double smallest_ = infinity;
  LeastClearance out_;
};

}  // namespace

LeastClearance least_clearance(std::span<MotionTests> motions, double tolerance) {
  return LeastSearch(motions).run(tolerance);
}

void check_tolerance(double tolerance) {
  if (tolerance > 0 && tolerance < 1) return;
  throw InvalidOption("motion: tolerance must be above 0 and below 1, not " + exact_text(tolerance));
}

}  // namespace blum::detail
