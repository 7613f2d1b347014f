#include "field/sign/shared_sides.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "blum/core/inline_list.hpp"

namespace blum::sign {
namespace {

/// Fewer have too little in common for a bound on the gradient, which costs as much as several of their answers.
constexpr std::size_t few = 48;
/// The same where answers cost next to nothing.
constexpr std::size_t few_triangles = 256;
/// Changes of the winding number over a group beyond which smaller groups are better.
constexpr double large_change = 1;

/// A point that has asked for itself.
struct Asked {
  Vec3d at;
  double distance = 0;
  double reach = 0;  ///< as far as this the winding number stays on its side of 1/2
  bool is_inside = false;
};

/// Answers that others may share.
class Answers {
 public:
  Answers(const WindingNumber& winding, double gradient, double slack)
      : winding_(winding), gradient_(gradient * (1 + 1e-9)), slack_(slack) {}

  [[nodiscard]] bool of(const SidedPoint& point) {
    for (std::size_t k = asked_.size(); k-- > 0;) {
      const Asked& one = asked_[k];
      const double free = std::min(one.distance + point.distance - slack_, one.reach);
      if (free > 0 && squared_length(point.at - one.at) < free * free * (1 - 1e-12)) return one.is_inside;
    }
    const WindingNumber::Decision found = winding_.decide(point.at);
    if (asked_.size() < most) {
      const double reach = gradient_ > 0 ? found.margin / gradient_ : HUGE_VAL;
      asked_.push_back({point.at, point.distance, reach, found.is_inside});
    }
    return found.is_inside;
  }

 private:
  static constexpr std::size_t most = 48;

  const WindingNumber& winding_;
  double gradient_;
  double slack_;
  InlineList<Asked, most> asked_;
};

Box3 box_around(std::span<const SidedPoint> points) {
  Box3 box;
  for (const SidedPoint& point : points) box.extend(point.at);
  return box;
}

}  // namespace

void decide_sides(const WindingNumber& winding, std::span<SidedPoint> points, double slack) {
  if (points.size() <= few || winding.triangle_count() <= few_triangles) {
    for (SidedPoint& point : points) point.is_inside = winding.is_inside(point.at);
    return;
  }
  const Box3 box = box_around(points);
  const double enough = large_change / box.diagonal();
  const double gradient = winding.gradient_bound(box, enough);
  if (!(gradient <= enough)) {
    decide_sides(winding, points.first(points.size() / 2), slack);
    decide_sides(winding, points.subspan(points.size() / 2), slack);
    return;
  }
  std::array<std::uint16_t, most_shared> order;
  for (std::size_t k = 0; k < points.size(); ++k) order[k] = static_cast<std::uint16_t>(k);
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(points.size());
  std::sort(order.begin(), end, [&](std::uint16_t a, std::uint16_t b) {
    return points[a].distance > points[b].distance || (points[a].distance == points[b].distance && a < b);
  });
  Answers answers(winding, gradient, slack);
  for (auto k = order.begin(); k != end; ++k) points[*k].is_inside = answers.of(points[*k]);
}

}  // namespace blum::sign
