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
/// Greatest number of primitives for which a piece is divided where its closest site changes. If there are more, most
/// parts of the piece would have several closest sites, too.
constexpr std::size_t most_for_sites = 16;
/// Rounding errors of positions and of squares of distances, where the largest coordinate is about 1.
constexpr double rounding = 1e-14;
/// If the bounds of a piece with one closest site differ by at most this, its values are treated as linear.
constexpr double straight = 1e-9;
/// Factor that makes up for rounding where a limit of a search was computed.
constexpr double slack = 1 + 1e-9;

double largest(const std::array<double, 3>& values) {
  return std::max({values[0], values[1], values[2]});
}

double sum(const std::array<double, 3>& values) {
  return values[0] + values[1] + values[2];
}

double squared_distance_of_triangle(const std::array<Vec3d, 3>& corners) {
  return squared_length(closest_point_on_triangle({}, corners));
}

std::array<double, 3> distances_from(const Vec3d& point, const std::array<Vec3d, 3>& corners) {
  return {length(corners[0] - point), length(corners[1] - point), length(corners[2] - point)};
}

/// Computes the means of values that change linearly.
void set_means(DeviationPiece& piece) {
  piece.is_round = false;
  piece.mean_value = sum(piece.value) / 3;
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

/// If the piece is not sharp, the errors are distances from the centroid. The mean square of the errors is a twelfth of
/// the sum of the squares at the corners.
double DeviationPiece::mean_square_error() const {
  if (is_sharp) return mean_square_of(error);
  return (error[0] * error[0] + error[1] * error[1] + error[2] * error[2]) / 12;
}

double DeviationPiece::mean_square(double unit) const {
  if (is_round) return round_square / unit / unit;
  return mean_square_of({value[0] / unit, value[1] / unit, value[2] / unit});
}

std::pair<double, double> DeviationPiece::values() const {
  const auto [low, high] = std::minmax({value[0], value[1], value[2]});
  return is_round ? std::pair(std::min(low, inner), std::max(high, inner)) : std::pair(low, high);
}

std::pair<double, double> DeviationPiece::range() const {
  if (is_round) {
    const auto [low, high] = values();
    return {low - error[0], high + error[0]};
  }
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (std::size_t k = 0; k < 3; ++k) {
    low = std::min(low, value[k] - error[k]);
    high = std::max(high, value[k] + error[k]);
  }
  return {low, high};
}

double mean_square_of(const std::array<double, 3>& v) {
  const double all = sum(v);
  return (all * all + v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / 12;
}

void set_around(DeviationPiece& piece, double deviation) {
  const Vec3d centroid = centroid_of(piece.corners);
  piece.value.fill(deviation);
  piece.error = distances_from(centroid, piece.corners);
  set_means(piece);
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

/// The distance from a primitive is a convex function. So the linear function with the same values at the corners is
/// not below this distance.
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
/// the primitive and the partner.
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
/// the distance from the primitive. The least of linear functions is concave, so the linear function with the same
/// values at the corners is not above it. The distance of the centroid minus the distance from the centroid is also
/// concave.
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

/// Sets values and errors.
/// @param least  lower bound on all distances.
void DeviationBounds::set_values(DeviationPiece& piece, const Vec3d& centroid, const Linear& lower, const Linear& upper,
                                 double least) const {
  for (std::size_t k = 0; k < 3; ++k) {
    piece.value[k] = (upper.at[k] + lower.at[k]) / 2;
    piece.error[k] = std::max((upper.at[k] - lower.at[k]) / 2, 0.0);
  }
  if (signs_ != nullptr) set_sign(piece, centroid, lower, upper, least);
  set_means(piece);
}

void DeviationBounds::set_sign(DeviationPiece& piece, const Vec3d& centroid, const Linear& lower, const Linear& upper,
                               double least) const {
  const double at_centroid = piece.sign == 0 ? signs_->nearest(centroid).distance : piece.sign;
  const bool may_jump = signs_->sign_may_jump();
  if (piece.sign == 0 && !(least > 1e-14) && !may_jump && !is_one_sided(piece, lower, upper)) {
    return set_crossing(piece, centroid, upper, at_centroid);
  }
  // If signs may jump, halves of the piece may have another sign.
  if (!may_jump && least > 1e-14) piece.sign = at_centroid < 0 ? -1 : 1;
  if (!(at_centroid < 0)) return;
  for (double& value : piece.value) value = -value;
}

/// Returns true if the sign of the centroid holds wherever the lower bound is above 0. These points are connected. The
/// distances of all other points are at most the gap between the bounds, which is added to the errors.
bool DeviationBounds::is_one_sided(DeviationPiece& piece, const Linear& lower, const Linear& upper) {
  double gap = 0;
  for (std::size_t k = 0; k < 3; ++k) gap = std::max(gap, upper.at[k] - lower.at[k]);
  if (!(sum(lower.at) > 0 && gap <= straight)) return false;
  for (double& error : piece.error) error += gap;
  return true;
}

/// Sets the values of a piece on which the sign may change.
void DeviationBounds::set_crossing(DeviationPiece& piece, const Vec3d& centroid, const Linear& upper,
                                   double at_centroid) {
  const std::array<double, 3> reach = distances_from(centroid, piece.corners);
  const bool is_close = sum(upper.at) < sum(reach);
  piece.value.fill(is_close ? 0 : at_centroid);
  piece.error = is_close ? upper.at : reach;
}

/// Finds the primitives that may be closest to a point of a piece. Returns an upper bound.
DeviationBounds::Linear DeviationBounds::examine(const DeviationPiece& piece, Search& search) const {
  search.centroid = centroid_of(piece.corners);
  search.reach = distances_from(search.centroid, piece.corners);
  for (std::size_t k = 0; k < 3; ++k) {
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

/// Returns a point minus its projection onto the line through an edge, the plane of a face, or a vertex. This is an
/// affine function of the point.
Vec3d DeviationBounds::offset_from(SiteId site, const Vec3d& point) const {
  const std::array<std::int32_t, 3> v = sites_.vertices(site);
  const auto corner = [&](std::size_t k) { return mesh_.vertices[static_cast<std::size_t>(v[k])]; };
  const Vec3d away = point - corner(0);
  if (v[1] < 0) return away;
  const Vec3d side = corner(1) - corner(0);
  if (v[2] < 0) return away - side * (dot(away, side) / squared_length(side));
  const Vec3d normal = cross(side, corner(2) - corner(0));
  return normal * (dot(away, normal) / squared_length(normal));
}

/// Divides the side on which the distance bends most. There, the direction from the closest point changes most.
void DeviationBounds::choose_bend(DeviationPiece& piece, const std::array<Vec3d, 3>& offsets) const {
  double most = piece.largest_error();
  std::array<Vec3d, 3> away{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double distance = length(offsets[k]);
    if (distance > 0) away[k] = offsets[k] / distance;
  }
  piece.side = 3;
  piece.may_cut = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const double bend = dot(away[next] - away[k], piece.corners[next] - piece.corners[k]);
    if (!(bend > most)) continue;
    most = bend;
    piece.side = static_cast<std::uint8_t>(k);
  }
}

RoundValues DeviationBounds::round_values(const DeviationPiece& piece) const {
  std::array<Vec3d, 3> offsets;
  for (std::size_t k = 0; k < 3; ++k) offsets[k] = offset_from(piece.site, piece.corners[k]);
  return RoundValues(offsets);
}

/// Computes the bounds of a piece whose closest site is known. The distance is the length of an affine function, which
/// is convex. So the distance lies between the linear function with its values at the corners and its tangent at the
/// centroid. If these differ, the piece is round.
void DeviationBounds::set_by_site(DeviationPiece& piece) const {
  const Vec3d centroid = centroid_of(piece.corners);
  std::array<Vec3d, 3> offsets;
  for (std::size_t k = 0; k < 3; ++k) offsets[k] = offset_from(piece.site, piece.corners[k]);
  const Vec3d middle = centroid_of(offsets);
  const double distance = length(middle);
  Linear lower;
  Linear upper;
  double gap = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    lower.at[k] = distance > 0 ? dot(offsets[k], middle) / distance : 0;
    upper.at[k] = length(offsets[k]);
    gap = std::max(gap, upper.at[k] - lower.at[k]);
  }
  const double least = std::sqrt(squared_distance_of_triangle(offsets));
  // Rounding of the squares in divide_by_nearest() changes a distance d by up to rounding / d.
  const double error = 2 * rounding / std::max(least, std::sqrt(rounding));
  for (std::size_t k = 0; k < 3; ++k) {
    lower.at[k] -= error;
    upper.at[k] += error;
  }
  set_values(piece, centroid, lower, upper, least - error);
  choose_bend(piece, offsets);
  // If the sign may change, only small pieces have narrow bounds.
  if (gap > straight && (signs_ == nullptr || least > 2 * error)) set_round(piece, RoundValues(offsets), error);
}

void DeviationBounds::set_round(DeviationPiece& piece, const RoundValues& round, double error) {
  if (!round.is_accurate()) return;
  const RoundValues::Mean mean = round.mean();
  const double all = error + round.value_error() + mean.error;
  if (!(all < piece.largest_error())) return;
  const double sign = piece.mean_value < 0 ? -1 : 1;
  piece.is_round = true;
  piece.error.fill(all);
  for (std::size_t k = 0; k < 3; ++k) piece.value[k] = sign * round.at_corners()[k];
  piece.mean_value = sign * mean.value;
  piece.round_square = round.mean_square();
  piece.inner = sign * round.lowest();
}

void DeviationBounds::sharpen(DeviationPiece& piece) const {
  piece.is_sharp = true;
  if (piece.site.has_value()) return set_by_site(piece);
  Search search;
  const Linear upper = examine(piece, search);
  const Linear lower = lower_bound(piece, search, upper);
  set_values(piece, search.centroid, lower, upper, std::min({lower.at[0], lower.at[1], lower.at[2]}));
  std::array<Vec3d, 3> offsets;
  for (std::size_t k = 0; k < 3; ++k) offsets[k] = piece.corners[k] - upper.closest[k];
  choose_bend(piece, offsets);
  piece.may_cut = !search.is_crowded && search.found.size() <= most_for_sites && piece.largest_error() > rounding;
}

/// Returns a primitive with its partner as one facet.
Facet DeviationBounds::facet_of(std::uint32_t primitive) const {
  std::array<std::uint32_t, 4> v{};
  std::size_t count = 0;
  const auto add = [&](std::uint32_t vertex) {
    if (std::find(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(count), vertex) ==
        v.begin() + static_cast<std::ptrdiff_t>(count)) {
      v[count++] = vertex;
    }
  };
  for (const std::uint32_t vertex : primitive_vertices(mesh_, primitive)) add(vertex);
  const std::uint32_t partner = partner_of(primitive);
  if (partner != primitive) {
    // The other corner of the partner lies between the ends of the longest side.
    const std::size_t side = longest_of(squared_sides(triangle_corners(mesh_, primitive)));
    const Triangle& own = mesh_.triangles[primitive];
    count = 0;
    add(own[(side + 1) % 3]);
    add(own[(side + 2) % 3]);
    add(own[side]);
    for (const std::uint32_t vertex : mesh_.triangles[partner]) add(vertex);
  }
  std::array<Vec3d, 4> corners;
  std::array<SiteId, 4> vertices;
  std::array<SiteId, 4> sides;
  for (std::size_t k = 0; k < count; ++k) {
    corners[k] = mesh_.vertices[v[k]];
    vertices[k] = SiteId(v[k]);
    if (count > 1) sides[k] = edge_between(v[k], v[(k + 1) % count]);
  }
  const bool is_flat = primitive < mesh_.triangles.size() && count > 2;
  const SiteId face = is_flat ? sites_.id({SiteKind::face, primitive}) : SiteId{};
  const std::size_t side_count = count > 2 ? count : count - 1;
  return make_facet(std::span(corners).first(count), std::span(vertices).first(count),
                    std::span(sides).first(side_count), face);
}

SiteId DeviationBounds::edge_between(std::uint32_t a, std::uint32_t b) const {
  const Segment wanted{std::min(a, b), std::max(a, b)};
  const std::span<const Segment> edges = sites_.edges();
  const auto at = std::lower_bound(edges.begin(), edges.end(), wanted);
  if (at == edges.end() || *at != wanted) return {};
  return sites_.id({SiteKind::edge, static_cast<std::uint32_t>(at - edges.begin())});
}

/// Appends the parts of a piece that have one closest site, and the remaining parts. Appends none if the whole piece
/// remains.
void DeviationBounds::add_regions(const DeviationPiece& piece, std::size_t most,
                                  std::vector<DeviationPiece>& out) const {
  Search search;
  static_cast<void>(examine(piece, search));
  if (search.is_crowded || search.found.size() > most_for_sites) return;
  std::vector<Facet> facets;
  for (const NearestPrimitive& one : search.found) {
    if (!is_behind_partner(search, one)) facets.push_back(facet_of(one.primitive));
  }
  std::vector<NearestRegion> regions;
  divide_by_nearest(piece.corners, facets, most, rounding, regions);
  if (regions.size() == 1 && !regions[0].site.has_value()) return;
  const Vec3d normal = cross(piece.corners[1] - piece.corners[0], piece.corners[2] - piece.corners[0]);
  const double largest_value = std::max(std::abs(piece.range().first), std::abs(piece.range().second));
  for (const NearestRegion& region : regions) {
    const auto& corners = region.corners;
    for (std::size_t k = 2; k < corners.size(); ++k) {
      DeviationPiece part = piece;
      part.corners = {corners[0], corners[k - 1], corners[k]};
      part.area = piece.area *
                  (dot(cross(corners[k - 1] - corners[0], corners[k] - corners[0]), normal) / squared_length(normal));
      if (!(part.area > 0)) continue;
      part.value.fill(0);
      part.error.fill(largest_value);
      part.site = region.site;
      out.push_back(part);
    }
  }
}

/// Appends the halves of a piece.
void DeviationBounds::add_halves(const DeviationPiece& piece, std::vector<DeviationPiece>& out) {
  const std::size_t side = piece.side < 3 ? piece.side : longest_of(squared_sides(piece.corners));
  const std::size_t next = (side + 1) % 3;
  DeviationPiece half = piece;
  half.area = piece.area / 2;
  for (const auto& [changed, kept] : {std::pair(next, side), std::pair(side, next)}) {
    half.corners = piece.corners;
    half.value = piece.value;
    half.error = piece.error;
    half.corners[changed] = piece.corners[kept] + (piece.corners[changed] - piece.corners[kept]) * 0.5;
    half.value[changed] = (piece.value[changed] + piece.value[kept]) / 2;
    half.error[changed] = (piece.error[changed] + piece.error[kept]) / 2;
    out.push_back(half);
  }
}

std::vector<DeviationPiece> DeviationBounds::parts(const DeviationPiece& piece, std::size_t most) const {
  std::vector<DeviationPiece> out;
  if (piece.may_cut && most > least_parts) add_regions(piece, most, out);
  if (out.empty()) add_halves(piece, out);
  for (DeviationPiece& part : out) sharpen(part);
  return out;
}

}  // namespace blum::surface
