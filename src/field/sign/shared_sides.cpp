#include "field/sign/shared_sides.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "blum/core/inline_list.hpp"

namespace blum::sign {
namespace {

/// Fewer have too little in common for a bound on the gradient, which costs as much as several of their answers.
constexpr std::size_t few = 48;
/// The same where answers cost next to nothing.
constexpr std::size_t few_triangles = 256;
/// Changes of the winding number over a group beyond which smaller groups are better.
constexpr double large_change = 1;

/// What a point is told that asks for itself, and by how much the winding number may change for another point to be
/// told the same.
template <class Value>
struct Answer {
  Value value;
  double margin = 0;
};

/// Asks for the side of a point.
struct AskSide {
  const WindingNumber& winding;

  using Point = SidedPoint;
  static void take(SidedPoint& point, bool side) { point.is_inside = side; }
  [[nodiscard]] Answer<bool> operator()(const Vec3d& at) const {
    const WindingNumber::Decision found = winding.decide(at);
    return {found.is_inside, found.margin};
  }
};

/// Asks for a rough winding number.
struct AskNumber {
  const WindingNumber& winding;

  using Point = NumberedPoint;
  static void take(NumberedPoint& point, double number) { point.number = number; }
  [[nodiscard]] Answer<double> operator()(const Vec3d& at) const {
    const WindingNumber::Estimate found = winding.estimate(at, 0.6 * WindingNumber::rough_error);
    return {found.value, (1 - 1e-9) * WindingNumber::rough_error - found.error};
  }
};

/// Answers of a group that others of it may share.
template <class Ask>
class SharedAnswers {
 public:
  using Point = typename Ask::Point;
  using Value = decltype(std::declval<Ask>()(Vec3d{}).value);

  SharedAnswers(const Ask& ask, double gradient, double slack)
      : ask_(ask), gradient_(gradient * (1 + 1e-9)), slack_(slack) {}

  [[nodiscard]] Value of(const Point& point) {
    for (std::size_t k = known_.size(); k-- > 0;) {
      const Known& one = known_[k];
      const double free = std::min(one.distance + point.distance - slack_, one.reach);
      if (free > 0 && squared_length(point.at - one.at) < free * free * (1 - 1e-12)) return one.value;
    }
    const Answer<Value> found = ask_(point.at);
    if (!known_.is_full()) {
      const double reach = gradient_ > 0 ? found.margin / gradient_ : HUGE_VAL;
      known_.push_back({point.at, point.distance, reach, found.value});
    }
    return found.value;
  }

 private:
  struct Known {
    Vec3d at;
    double distance = 0;
    double reach = 0;  ///< as far as this the answer holds, unless a triangle lies between
    Value value;
  };

  const Ask& ask_;
  double gradient_;
  double slack_;
  InlineList<Known, 48> known_;
};

template <class Point>
Box3 box_around(std::span<const Point> points) {
  Box3 box;
  for (const Point& point : points) box.extend(point.at);
  return box;
}

template <class Ask>
void share(const Ask& ask, std::span<typename Ask::Point> points, double slack) {
  using Point = typename Ask::Point;
  if (points.size() <= few || ask.winding.triangle_count() <= few_triangles) {
    for (Point& point : points) Ask::take(point, ask(point.at).value);
    return;
  }
  const Box3 box = box_around<Point>(points);
  const double enough = large_change / box.diagonal();
  const double gradient = ask.winding.gradient_bound(box, enough);
  if (!(gradient <= enough)) {
    share(ask, points.first(points.size() / 2), slack);
    share(ask, points.subspan(points.size() / 2), slack);
    return;
  }
  std::array<std::uint16_t, most_shared> order;
  for (std::size_t k = 0; k < points.size(); ++k) order[k] = static_cast<std::uint16_t>(k);
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(points.size());
  std::sort(order.begin(), end, [&](std::uint16_t a, std::uint16_t b) {
    return points[a].distance > points[b].distance || (points[a].distance == points[b].distance && a < b);
  });
  SharedAnswers<Ask> answers(ask, gradient, slack);
  for (auto k = order.begin(); k != end; ++k) Ask::take(points[*k], answers.of(points[*k]));
}

}  // namespace

void decide_sides(const WindingNumber& winding, std::span<SidedPoint> points, double slack) {
  share(AskSide{winding}, points, slack);
}

void find_rough_numbers(const WindingNumber& winding, std::span<NumberedPoint> points, double slack) {
  share(AskNumber{winding}, points, slack);
}

}  // namespace blum::sign
