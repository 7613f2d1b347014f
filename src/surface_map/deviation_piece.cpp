#include "surface_map/deviation_piece.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "blum/core/inline_list.hpp"
#include "blum/geometry/closest_point.hpp"
#include "blum/geometry/orient3d.hpp"
#include "blum/geometry/primitives.hpp"
#include "surface_map/triangle_sides.hpp"

namespace blum::surface {
namespace {

/// Greatest number of primitives that are examined for one piece.
constexpr std::size_t most_primitives = 48;
/// Number of primitives whose distances at the corners are computed.
constexpr std::size_t most_upper = 3;
/// Factor that makes up for rounding where a limit of a search was computed.
constexpr double slack = 1 + 1e-9;

double largest(const std::array<double, 3>& values) {
  return std::max({values[0], values[1], values[2]});
}

double sum(const std::array<double, 3>& values) {
  return values[0] + values[1] + values[2];
}

/// Returns true if two triangles with a common side lie in one plane, and are a convex quadrilateral together.
/// @param side  the common side, from corner `side` of the first triangle to the next one.
/// @param tip   the other corner of the second triangle.
bool are_convex(const std::array<Vec3d, 3>& p, std::size_t side, const Vec3d& tip) {
  if (detail::orient3d(p[0], p[1], p[2], tip) != 0) return false;
  const Vec3d& a = p[side];
  const Vec3d& b = p[(side + 1) % 3];
  const Vec3d& c = p[(side + 2) % 3];
  const Vec3d normal = cross(b - a, c - a);
  const double least = 1e-9 * squared_length(normal);  // so that rounding does no harm
  return dot(cross(b - tip, a - tip), normal) > least && dot(cross(tip - a, c - a), normal) > least &&
         dot(cross(c - b, tip - b), normal) > least;
}

}  // namespace

/// Values at the corners of a piece, linear in between.
struct DeviationBounds::Linear {
  std::array<double, 3> at{};
  std::array<Vec3d, 3> closest{};  ///< of an upper bound: points of one primitive that are closest to the corners
};

/// Primitives that may be closest to a point of a piece.
struct DeviationBounds::Search {
  Vec3d centroid;
  std::array<double, 3> reach{};  ///< distances of the corners from the centroid
  double distance = 0;            ///< of the centroid from the mesh
  double limit = 0;               ///< primitives further from the centroid are not closest to any point of the piece
  InlineList<NearestPrimitive, most_primitives> found;  ///< the closest few to the centroid are first
  bool is_crowded = false;                              ///< true if there are more than `found` can hold
};

double DeviationPiece::largest_error() const {
  return largest(error);
}

double DeviationPiece::mean_error() const {
  return is_sharp ? sum(error) / 3 : std::sqrt(mean_square_error());
}

/// If the piece is not sharp, the errors are distances from the centroid. Their mean square is a twelfth of the sum of
/// those of the corners.
double DeviationPiece::mean_square_error() const {
  if (is_sharp) return mean_square(error);
  return (error[0] * error[0] + error[1] * error[1] + error[2] * error[2]) / 12;
}

std::pair<double, double> DeviationPiece::range() const {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (std::size_t k = 0; k < 3; ++k) {
    low = std::min(low, value[k] - error[k]);
    high = std::max(high, value[k] + error[k]);
  }
  return {low, high};
}

double mean_square(const std::array<double, 3>& v) {
  const double all = sum(v);
  return (all * all + v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / 12;
}

void set_around(DeviationPiece& piece, double deviation) {
  const Vec3d centroid = centroid_of(piece.corners);
  for (std::size_t k = 0; k < 3; ++k) {
    piece.value[k] = deviation;
    piece.error[k] = length(piece.corners[k] - centroid);
  }
}

DeviationBounds::DeviationBounds(const MeshView& mesh, const ClosestPointQuery* signs, const Context& context)
    : mesh_(mesh), sites_(mesh, context), bvh_(mesh, sites_, context), signs_(signs) {
  find_partners();
}

/// Pairs triangles across their longest sides.
void DeviationBounds::find_partners() {
  const std::size_t count = mesh_.triangles.size();
  partner_.resize(count);
  std::iota(partner_.begin(), partner_.end(), 0U);
  struct Side {
    std::uint32_t triangle = 0;
    std::uint32_t corner = 0;  ///< the corner that is not on the side
  };
  std::vector<std::optional<Side>> open(sites_.edge_count());
  for (std::uint32_t t = 0; t < count; ++t) {
    const std::array<Vec3d, 3> p = triangle_corners(mesh_, t);
    const std::size_t side = longest_of(squared_sides(p));
    const EdgeId edge = sites_.triangle_edges()[t][side];
    if (!edge.has_value()) continue;
    const Side here{t, mesh_.triangles[t][(side + 2) % 3]};
    std::optional<Side>& there = open[edge.value];
    if (!there) {
      there = here;
      continue;
    }
    const Vec3d& tip = mesh_.vertices[there->corner];
    if (partner_[there->triangle] != there->triangle || !are_convex(p, side, tip)) continue;
    partner_[t] = there->triangle;
    partner_[there->triangle] = t;
  }
}

Vec3d DeviationBounds::closest_point(const Vec3d& query, std::uint32_t primitive) const {
  const auto on = [&](std::uint32_t one) {
    const Triangle v = primitive_vertices(mesh_, one);
    return closest_point_on_triangle(query, {mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]]});
  };
  const Vec3d own = on(primitive);
  const std::uint32_t partner = partner_of(primitive);
  if (partner == primitive) return own;
  const Vec3d other = on(partner);
  return squared_length(query - other) < squared_length(query - own) ? other : own;
}

void DeviationBounds::collect(Search& search) const {
  search.found.shrink(0);
  bvh_.for_each_within(search.centroid, search.limit, [&](const NearestPrimitive& one) {
    search.is_crowded = search.found.size() == most_primitives;
    if (!search.is_crowded) search.found.push_back(one);
    return !search.is_crowded;
  });
  const auto first = search.found.begin();
  const auto few = static_cast<std::ptrdiff_t>(std::min(most_upper, search.found.size()));
  std::partial_sort(first, first + few, search.found.end(), [](const NearestPrimitive& a, const NearestPrimitive& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.primitive < b.primitive;
  });
}

/// The distance from a primitive is a convex function. So the linear function with its values at the corners is not
/// below it.
DeviationBounds::Linear DeviationBounds::upper_bound(const DeviationPiece& piece, const Search& search) const {
  Linear best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(most_upper, search.found.size()); ++i) {
    // A primitive with the same closest point, or the partner of an earlier one, hardly improves the bound.
    if (i > 0 && (search.found[i].point == search.found[0].point ||
                  partner_of(search.found[i].primitive) == search.found[0].primitive)) {
      continue;
    }
    Linear one;
    for (std::size_t k = 0; k < 3; ++k) {
      one.closest[k] = closest_point(piece.corners[k], search.found[i].primitive);
      one.at[k] = length(piece.corners[k] - one.closest[k]);
    }
    if (!(sum(one.at) < least)) continue;
    least = sum(one.at);
    best = one;
  }
  return best;
}

std::uint32_t DeviationBounds::partner_of(std::uint32_t primitive) const {
  return primitive < partner_.size() ? partner_[primitive] : primitive;
}

/// Returns true if the partner of a primitive is closer to the centroid. The plane before the partner is then before
/// both.
bool DeviationBounds::is_behind_partner(const Search& search, const NearestPrimitive& one) const {
  const std::uint32_t partner = partner_of(one.primitive);
  if (partner == one.primitive) return false;
  return std::any_of(search.found.begin(), search.found.end(), [&](const NearestPrimitive& other) {
    return other.primitive == partner &&
           (other.distance != one.distance ? other.distance < one.distance : partner < one.primitive);
  });
}

/// Returns the height of the highest corner of a primitive along a direction, over an origin.
double DeviationBounds::front_of(std::uint32_t primitive, const Vec3d& direction, const Vec3d& origin) const {
  double out = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t v : primitive_vertices(mesh_, primitive)) {
    out = std::max(out, dot(direction, mesh_.vertices[v] - origin));
  }
  return out;
}

/// Each primitive, together with its partner, lies behind a plane. So the distance from the plane is a lower bound on
/// the distance from the primitive. The least of linear functions is concave, so the linear function with its values at
/// the corners is not above it. The same holds for the distance of the centroid minus the distance from the centroid.
DeviationBounds::Linear DeviationBounds::lower_bound(const DeviationPiece& piece, const Search& search,
                                                     const Linear& upper) const {
  Linear best;  // 0
  const auto take_if_higher = [&](const std::array<double, 3>& at) {
    if (sum(at) > sum(best.at)) best.at = at;
  };
  take_if_higher(
      {search.distance - search.reach[0], search.distance - search.reach[1], search.distance - search.reach[2]});
  if (search.is_crowded) {
    // For all points y, the square of |x - y| is linear in the weights of x, minus the sum of w_i w_j s_ij^2. This sum
    // is at most a third of the longest squared side.
    const double most = largest(squared_sides(piece.corners)) / 3;
    std::array<double, 3> at{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::optional<NearestSite> near = bvh_.nearest(piece.corners[k], upper.at[k] * slack + 1e-300);
      const double distance = near ? near->distance : 0;
      if (distance * distance < most) return best;
      at[k] = std::sqrt(distance * distance - most);
    }
    take_if_higher(at);
    return best;
  }
  std::array<double, 3> at = upper.at;
  for (const NearestPrimitive& one : search.found) {
    if (is_behind_partner(search, one)) continue;
    const Vec3d away = search.centroid - one.point;
    const double size = length(away);
    if (!(size > 0)) return best;
    const Vec3d normal = away / size;
    // The plane goes through the vertices of the primitive, so that rounding of the closest point does no harm.
    double front = front_of(one.primitive, normal, search.centroid);
    const std::uint32_t partner = partner_of(one.primitive);
    if (partner != one.primitive) front = std::max(front, front_of(partner, normal, search.centroid));
    for (std::size_t k = 0; k < 3; ++k) {
      at[k] = std::min(at[k], dot(normal, piece.corners[k] - search.centroid) - front);
    }
  }
  take_if_higher(at);
  return best;
}

void DeviationBounds::set_values(DeviationPiece& piece, const Search& search, const Linear& lower,
                                 const Linear& upper) const {
  for (std::size_t k = 0; k < 3; ++k) {
    piece.value[k] = (upper.at[k] + lower.at[k]) / 2;
    piece.error[k] = std::max((upper.at[k] - lower.at[k]) / 2, 0.0);
  }
  if (signs_ == nullptr) return;
  const double at_centroid = piece.sign == 0 ? signs_->nearest(search.centroid).distance : piece.sign;
  const bool may_jump = signs_->sign_may_jump();
  const bool is_away = std::min({lower.at[0], lower.at[1], lower.at[2]}) > 1e-14;
  if (piece.sign == 0 && !is_away && !may_jump) return set_crossing(piece, search, upper, at_centroid);
  // If signs may jump, halves of the piece may have another sign.
  if (!may_jump) piece.sign = at_centroid < 0 ? -1 : 1;
  if (!(at_centroid < 0)) return;
  for (double& value : piece.value) value = -value;
}

/// Sets the values of a piece on which the sign may change.
void DeviationBounds::set_crossing(DeviationPiece& piece, const Search& search, const Linear& upper,
                                   double at_centroid) {
  const bool is_close = sum(upper.at) < sum(search.reach);
  piece.value.fill(is_close ? 0 : at_centroid);
  piece.error = is_close ? upper.at : search.reach;
}

/// Finds the primitives that may be closest to a point of a piece. Returns an upper bound.
DeviationBounds::Linear DeviationBounds::examine(const DeviationPiece& piece, Search& search) const {
  search.centroid = centroid_of(piece.corners);
  for (std::size_t k = 0; k < 3; ++k) {
    search.reach[k] = length(piece.corners[k] - search.centroid);
    // The piece has bounds already, which limit the search.
    search.limit = std::max(search.limit, std::abs(piece.value[k]) + piece.error[k] + search.reach[k]);
  }
  // If the bounds are those of the centroid's distance alone, a first primitive tightens them.
  const bool is_rough = sum(piece.error) > 0.5 * sum(search.reach);
  if (!is_rough) {
    search.limit = search.limit * slack + 1e-15;
    collect(search);
  }
  if (!is_rough && !search.is_crowded && !search.found.empty()) {
    search.distance = search.found[0].distance;
    return upper_bound(piece, search);
  }
  const auto every = [](std::uint32_t) { return true; };
  const NearestPrimitive nearest = *bvh_.nearest_wanted(search.centroid, every);
  search.distance = nearest.distance;
  search.found.shrink(0);
  search.found.push_back(nearest);
  const Linear first = upper_bound(piece, search);
  search.limit = 0;
  for (std::size_t k = 0; k < 3; ++k) search.limit = std::max(search.limit, first.at[k] + search.reach[k]);
  search.limit = search.limit * slack + 1e-15;
  collect(search);
  if (search.is_crowded) return first;
  return upper_bound(piece, search);
}

void DeviationBounds::sharpen(DeviationPiece& piece) const {
  Search search;
  const Linear upper = examine(piece, search);
  const Linear lower = lower_bound(piece, search, upper);
  set_values(piece, search, lower, upper);
  piece.is_sharp = true;
  // Where the distance bends most, the direction to the closest point changes most.
  double most = 0;
  std::size_t side = 3;
  std::array<Vec3d, 3> away{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (upper.at[k] > 0) away[k] = (piece.corners[k] - upper.closest[k]) / upper.at[k];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const double bend = dot(away[next] - away[k], piece.corners[next] - piece.corners[k]);
    if (bend > most) {
      most = bend;
      side = k;
    }
  }
  piece.side = static_cast<std::uint8_t>(most > piece.largest_error() ? side : 3);
}

std::array<DeviationPiece, 2> DeviationBounds::halves(const DeviationPiece& piece) const {
  const std::size_t side = piece.side < 3 ? piece.side : longest_of(squared_sides(piece.corners));
  const std::size_t next = (side + 1) % 3;
  const Vec3d middle = (piece.corners[side] + piece.corners[next]) * 0.5;
  std::array<DeviationPiece, 2> out;
  for (std::size_t k = 0; k < 2; ++k) {
    out[k].corners = piece.corners;
    const std::size_t moved = k == 0 ? next : side;
    out[k].corners[moved] = middle;
    out[k].value = piece.value;
    out[k].error = piece.error;
    out[k].value[moved] = (piece.value[side] + piece.value[next]) / 2;
    out[k].error[moved] = (piece.error[side] + piece.error[next]) / 2;
    out[k].area = piece.area / 2;
    out[k].sign = piece.sign;
    sharpen(out[k]);
  }
  return out;
}

}  // namespace blum::surface
