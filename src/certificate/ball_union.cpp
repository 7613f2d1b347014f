#include "certificate/ball_union.hpp"

#include <cmath>

namespace blum::verifier {

BallUnion::BallUnion(const std::vector<Ball>& balls, const Context& context) {
  std::vector<Box3> boxes;
  boxes.reserve(balls.size());
  for (const Ball& ball : balls) boxes.push_back({ball.centre, ball.centre});
  tree_ = BoxHierarchy(boxes, context);
  std::vector<double> radii;
  for (const std::uint32_t place : tree_.order()) {
    balls_.push_back(balls[place]);
    radii.push_back(balls[place].radius);
  }
  const std::vector<double> largest = tree_.node_maxima(radii);
  largest_.resize(largest.size() / 2);
  for (std::size_t n = 1; n < largest.size(); ++n) {
    largest_[BoxHierarchy::pair_of(n)][BoxHierarchy::place_in_pair(n)] = largest[n];
  }
}

Two BallUnion::gaps(const Vec3d& p, std::uint32_t first_child) const {
  const Two squared = squared_distances(p, tree_.two_boxes(first_child));
  const Two& largest = largest_[BoxHierarchy::pair_of(first_child)];
  return {std::sqrt(squared[0]) - largest[0], std::sqrt(squared[1]) - largest[1]};
}

double BallUnion::gap(const Vec3d& p, std::uint32_t& first) const {
  if (balls_.empty()) return HUGE_VAL;
  double best = gap_to(p, first);
  if (best <= 0) return best;
  tree_.search(
      best, [&](std::uint32_t first_child) { return gaps(p, first_child); },
      [&](std::uint32_t place) {
        const double own = gap_to(p, place);
        if (own < best) {
          best = own;
          first = place;
        }
        return best <= 0 ? -HUGE_VAL : best;  // in the union: the search ends
      });
  return best;
}

bool BallUnion::holds(const Vec3d& p, double margin) const {
  double wanted = -margin;  // nothing is below -infinity: the search ends
  tree_.search(
      wanted, [&](std::uint32_t first_child) { return gaps(p, first_child); },
      [&](std::uint32_t place) {
        if (gap_to(p, place) < wanted) wanted = -HUGE_VAL;
        return wanted;
      });
  return wanted < -margin;
}

}  // namespace blum::verifier
