#include "field/sign/shared_sides.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "blum/core/inline_list.hpp"

namespace blum::sign {
namespace {

/// For at most this many points, sharing does not pay: the bound on the gradient costs as much as evaluating several
/// points.
constexpr std::size_t few = 48;
/// For at most this many triangles, evaluation is so cheap that answers are not shared.
constexpr std::size_t few_triangles = 256;
/// If the winding number may change by more than this over a group, the group is split.
constexpr double large_change = 1;

/// Answer of an evaluated point. The answer also holds for another point if the winding number changes by less than
/// `margin` between the two points.
template <class Value>
struct Answer {
  Value value;
  double margin = 0;
};

/// Evaluates which side of the surface a point is on.
struct AskSide {
  const WindingNumber& winding;

  using Point = SidedPoint;
  static void take(SidedPoint& point, bool side) { point.is_inside = side; }
  [[nodiscard]] Answer<bool> operator()(const SidedPoint& point) const {
    const WindingNumber::Decision found = winding.decide(point.at, point.distance);
    return {found.is_inside, found.margin};
  }
  /// Returns the rounding error of evaluating the point itself. A point takes over an answer only if this error could
  /// not change the answer. So all points get the answers that they would get alone.
  [[nodiscard]] double rounding_at(const SidedPoint& point) const {
    return winding.rounding_at(point.at, point.distance);
  }
};

/// Evaluates a winding number roughly.
struct AskNumber {
  const WindingNumber& winding;

  using Point = NumberedPoint;
  static void take(NumberedPoint& point, double number) { point.number = number; }
  [[nodiscard]] Answer<double> operator()(const NumberedPoint& point) const {
    const WindingNumber::Estimate found = winding.estimate(point.at, 0.6 * WindingNumber::rough_error);
    return {found.value, (1 - 1e-9) * WindingNumber::rough_error - found.error};
  }
  /// No margin is needed: any number within the allowed error may be shared.
  [[nodiscard]] static double rounding_at(const NumberedPoint& /*point*/) { return 0; }
};

/// Answers of a group of points. Points may take over the answers of others.
template <class Ask>
class SharedAnswers {
 public:
  using Point = typename Ask::Point;
  using Value = decltype(std::declval<Ask>()(Point{}).value);

  SharedAnswers(const Ask& ask, std::span<const Point> points, double gradient, double slack)
      : ask_(ask), points_(points), gradient_(gradient * (1 + 1e-9)), slack_(slack) {
    reach_.fill(-HUGE_VAL);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double rounding = ask.rounding_at(points[k]);
      // Without a boundary, winding numbers are whole, so every answer has a margin of nearly 1/2.
      needed_[k] = gradient_ > 0 ? rounding / gradient_ : rounding < 0.25 ? 0.0 : HUGE_VAL;
    }
  }

  /// Returns the answer of a point. Must be called once for each point.
  [[nodiscard]] Value of(std::size_t k) {
    if (const std::optional<std::size_t> other = sharing(k)) {
      const double way = length(points_[k].at - points_[*other].at) * (1 + 1e-12);
      reach_[k] = gradient_ > 0 ? reach_[*other] - way : everywhere;
      return value_[k] = value_[*other];
    }
    const Answer<Value> found = ask_(points_[k]);
    if (!asked_.is_full()) asked_.push_back(static_cast<std::uint16_t>(k));
    reach_[k] = gradient_ > 0 ? found.margin / gradient_ : everywhere;
    return value_[k] = found.value;
  }

 private:
  static constexpr double everywhere = std::numeric_limits<double>::max();
  /// Neighbours are searched at most this many steps away in the order of the points.
  static constexpr std::size_t most_steps = 12;

  /// Returns a point whose answer also holds for k. Neighbours in the order are tried first, then the evaluated points.
  [[nodiscard]] std::optional<std::size_t> sharing(std::size_t k) const {
    for (std::size_t step = 1; step <= most_steps; ++step) {
      if (k >= step && holds(k - step, k)) return k - step;
      if (k + step < points_.size() && holds(k + step, k)) return k + step;
    }
    for (std::size_t n = asked_.size(); n-- > 0;) {
      if (holds(asked_[n], k)) return asked_[n];
    }
    return std::nullopt;
  }

  /// Returns true if the answer of the point `from` also holds for the point `to`.
  [[nodiscard]] bool holds(std::size_t from, std::size_t to) const {
    const double free = std::min(points_[from].distance + points_[to].distance - slack_, reach_[from] - needed_[to]);
    return free > 0 && squared_length(points_[to].at - points_[from].at) < free * free * (1 - 1e-12);
  }

  const Ask& ask_;
  std::span<const Point> points_;
  double gradient_;
  double slack_;
  /// Per point: distance within which its answer holds, unless a triangle lies between. Negative if the point has no
  /// answer yet.
  std::array<double, most_shared> reach_;
  /// Per point: part of another point's reach that must remain if the answer of that point is taken over.
  std::array<double, most_shared> needed_;
  std::array<Value, most_shared> value_;
  InlineList<std::uint16_t, 64> asked_;
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
    for (Point& point : points) Ask::take(point, ask(point).value);
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
  SharedAnswers<Ask> answers(ask, points, gradient, slack);
  for (auto k = order.begin(); k != end; ++k) Ask::take(points[*k], answers.of(*k));
}

}  // namespace

void decide_sides(const WindingNumber& winding, std::span<SidedPoint> points, double slack) {
  share(AskSide{winding}, points, slack);
}

void find_rough_numbers(const WindingNumber& winding, std::span<NumberedPoint> points, double slack) {
  share(AskNumber{winding}, points, slack);
}

}  // namespace blum::sign
