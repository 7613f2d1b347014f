#include "axis/fan.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "blum/core/inline_list.hpp"

namespace blum::detail {
namespace {

/// The cosine that a triangle may turn by at most: 75 degrees.
constexpr double least_cosine = 0.25;
constexpr std::size_t most_ring = 64;

/// A point seen along the normal of a fan, from its centre.
struct Seen {
  double x = 0, y = 0;
  double height = 0, radius = 0;  ///< radius: less that of the centre
};

double cross(const Seen& a, const Seen& b) {
  return a.x * b.y - a.y * b.x;
}
double cross(const Seen& from, const Seen& a, const Seen& b) {
  return (a.x - from.x) * (b.y - from.y) - (a.y - from.y) * (b.x - from.x);
}

struct Difference {
  double height = 0, radius = 0;
  void include(double h, double r) {
    height = std::max(height, std::abs(h));
    radius = std::max(radius, std::abs(r));
  }
};

/// What the ring looks like along a normal.
class View {
 public:
  View(const AxisPoint& centre, std::span<const AxisPoint> ring, const Vec3d& normal) {
    const Vec3d side = std::abs(normal.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    Vec3d u = blum::cross(normal, side);
    u = u / length(u);
    const Vec3d v = blum::cross(normal, u);
    for (const AxisPoint& point : ring) {
      const Vec3d at = point.position - centre.position;
      seen_.push_back({dot(at, u), dot(at, v), dot(at, normal), point.radius - centre.radius});
    }
  }

  /// Whether the fan lies above the plane once, before the centre goes.
  [[nodiscard]] bool is_above_plane(bool is_closed) const {
    for (std::size_t k = 0; k + 1 < seen_.size() + (is_closed ? 1 : 0); ++k) {
      if (!(cross(seen_[k], seen_[(k + 1) % seen_.size()]) > 0)) return false;
    }
    return true;
  }
  /// The same afterwards.
  [[nodiscard]] bool is_unfolded() const {
    for (std::size_t k = 1; k + 1 < seen_.size(); ++k) {
      if (!(cross(seen_[0], seen_[k], seen_[k + 1]) > 0)) return false;
    }
    return true;
  }

  /// Whether the centre of an open fan lies beyond the line between the ends of its ring.
  [[nodiscard]] bool is_tip() const { return cross(seen_[0], seen_[seen_.size() - 1]) > 0; }

  /// At the centre, where the fan covers it afterwards.
  void include_centre(Difference& difference) const {
    for (std::size_t k = 1; k + 1 < seen_.size(); ++k) {
      const double a = cross(seen_[k], seen_[k + 1]);
      const double b = cross(seen_[k + 1], seen_[0]);
      const double c = cross(seen_[0], seen_[k]);
      if (a < 0 || b < 0 || c < 0 || !(a + b + c > 0)) continue;
      const double sum = a + b + c;
      difference.include((a * seen_[0].height + b * seen_[k].height + c * seen_[k + 1].height) / sum,
                         (a * seen_[0].radius + b * seen_[k].radius + c * seen_[k + 1].radius) / sum);
      return;
    }
  }

  /// Where edges from the centre cross those afterwards: between these places both are linear.
  void include_crossings(Difference& difference) const {
    for (std::size_t j = 2; j < seen_.size(); ++j) {
      const Seen& from = seen_[0];
      const Seen& to = seen_[j];
      const Seen along{to.x - from.x, to.y - from.y, to.height - from.height, to.radius - from.radius};
      const double start = cross(from, along);
      for (std::size_t i = 1; i < seen_.size(); ++i) {
        if (i == j) continue;
        const Seen& spoke = seen_[i];
        const double turn = cross(spoke, along);
        // Signs tell mostly that there is no crossing, without dividing.
        if (turn == 0 || (turn > 0 ? !(start > 0 && start <= turn) : !(start < 0 && start >= turn))) continue;
        const double s = start / turn;
        const double t = cross(from, spoke) / turn;
        if (!(s > 0 && s < 1 && t > 0 && t < 1)) continue;
        difference.include(s * spoke.height - (from.height + t * along.height),
                           s * spoke.radius - (from.radius + t * along.radius));
      }
    }
  }

 private:
  InlineList<Seen, most_ring> seen_;
};

/// Whether a triangle faces to where a normal does, roughly.
bool faces(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& normal) {
  const Vec3d own = blum::cross(b - a, c - a);
  return dot(own, normal) > least_cosine * length(own);
}

}  // namespace

Deviation deviation(const AxisPoint& point, const AxisPoint& a, const AxisPoint& b) {
  const Vec3d along = b.position - a.position;
  const double squared = squared_length(along);
  const double t = squared > 0 ? std::clamp(dot(point.position - a.position, along) / squared, 0.0, 1.0) : 0;
  const double distance = length(point.position - (a.position + along * t));
  return {std::max(distance, std::abs(a.radius + (b.radius - a.radius) * t - point.radius)), distance};
}

std::optional<Deviation> deviation(const AxisPoint& centre, std::span<const AxisPoint> ring, bool is_closed) {
  if (ring.size() > most_ring) return std::nullopt;
  Vec3d normal;
  for (std::size_t k = 0; k + 1 < ring.size() + (is_closed ? 1 : 0); ++k) {
    normal += blum::cross(ring[k].position - centre.position, ring[(k + 1) % ring.size()].position - centre.position);
  }
  const double size = length(normal);
  if (!(size > 0)) return std::nullopt;
  normal = normal / size;
  for (std::size_t k = 1; k + 1 < ring.size(); ++k) {
    if (!faces(ring[0].position, ring[k].position, ring[k + 1].position, normal)) return std::nullopt;
  }
  const View view(centre, ring, normal);
  if (!view.is_unfolded()) return std::nullopt;
  // Each point of a triangle moves with its corner, and so no further than that.
  const double moved = length(ring[0].position - centre.position);
  const Deviation bound{std::max(moved, std::abs(ring[0].radius - centre.radius)), moved};
  if (!view.is_above_plane(is_closed)) return bound;
  Difference difference;
  view.include_centre(difference);
  view.include_crossings(difference);
  Deviation out{std::max(difference.height, difference.radius), difference.height};
  if (!is_closed) {
    const Deviation border = deviation(centre, ring.front(), ring.back());
    out.by = std::max(out.by, border.by);
    if (!view.is_tip()) out.beyond = std::max(out.beyond, border.beyond);
  }
  return out.by < bound.by ? out : bound;
}

}  // namespace blum::detail
