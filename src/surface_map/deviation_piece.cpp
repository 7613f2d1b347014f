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
/// Rounding errors of positions, where the largest coordinate is about 1.
constexpr double rounding = 1e-14;
/// A piece is not divided at places that are closer to its corners than this.
constexpr double small = 1e-9;
/// Place on a side, as a share of its length, at which the site that is closest near the end is searched.
constexpr double beside = 1e-4;
/// Greatest number of pairs of sites that are examined for one side.
constexpr int most_tries = 5;
/// Factor that makes up for rounding where a limit of a search was computed.
constexpr double slack = 1 + 1e-9;

double largest(const std::array<double, 3>& values) {
  return std::max({values[0], values[1], values[2]});
}

double sum(const std::array<double, 3>& values) {
  return values[0] + values[1] + values[2];
}

bool is_small(const Vec3d& v) {
  return squared_length(v) < small * small;
}

/// Returns the place between the ends of a segment, 0 to 1, where an affine function is 0. Returns nullopt if there is
/// no such place, or the function is small at an end.
/// @param values  of the function at the ends.
std::optional<double> zero_between(const std::array<Vec3d, 2>& values) {
  const Vec3d change = values[1] - values[0];
  if (is_small(values[0]) || is_small(values[1]) || !(dot(values[0], values[1]) < 0)) return std::nullopt;
  const double place = -dot(values[0], change) / squared_length(change);
  return is_small(values[0] + change * place) ? std::optional(place) : std::nullopt;
}

/// Returns the place, 0 to 1, where a quadratic function changes its sign. Returns nullopt if the function is small at
/// 0 or 1, or has the same sign at both.
/// @param square  factor of the square.
std::optional<double> sign_change(double at_0, double at_1, double square) {
  if (at_0 > 0) return at_1 < 0 ? sign_change(-at_0, -at_1, -square) : std::nullopt;
  if (!(at_0 < -small && at_1 > small)) return std::nullopt;
  const double slope = at_1 - at_0 - square;
  return -2 * at_0 / (slope + std::sqrt(std::max(slope * slope - 4 * square * at_0, 0.0)));
}

std::array<double, 3> distances_from(const Vec3d& point, const std::array<Vec3d, 3>& corners) {
  return {length(corners[0] - point), length(corners[1] - point), length(corners[2] - point)};
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

/// Position and bounds of a corner.
struct DeviationBounds::Corner {
  Vec3d position;
  double value = 0;
  double error = 0;
};

DeviationBounds::Corner DeviationBounds::between(const Corner& a, const Corner& b, double place) {
  return {a.position + (b.position - a.position) * place, a.value + (b.value - a.value) * place,
          a.error + (b.error - a.error) * place};
}

/// Returns a part of a piece.
/// @param share  of the piece's area.
DeviationPiece DeviationBounds::part_of(const DeviationPiece& piece, const std::array<Corner, 3>& corners,
                                        double share) {
  DeviationPiece out = piece;
  for (std::size_t k = 0; k < 3; ++k) {
    out.corners[k] = corners[k].position;
    out.value[k] = corners[k].value;
    out.error[k] = corners[k].error;
  }
  out.area = piece.area * share;
  return out;
}

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
  piece.value.fill(deviation);
  piece.error = distances_from(centroid, piece.corners);
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

void DeviationBounds::set_values(DeviationPiece& piece, const Vec3d& centroid, const Linear& lower,
                                 const Linear& upper) const {
  for (std::size_t k = 0; k < 3; ++k) {
    piece.value[k] = (upper.at[k] + lower.at[k]) / 2;
    piece.error[k] = std::max((upper.at[k] - lower.at[k]) / 2, 0.0);
  }
  if (signs_ == nullptr) return;
  const double at_centroid = piece.sign == 0 ? signs_->nearest(centroid).distance : piece.sign;
  const bool may_jump = signs_->sign_may_jump();
  const bool is_away = std::min({lower.at[0], lower.at[1], lower.at[2]}) > 1e-14;
  if (piece.sign == 0 && !is_away && !may_jump) return set_crossing(piece, centroid, upper, at_centroid);
  // If signs may jump, halves of the piece may have another sign.
  if (!may_jump) piece.sign = at_centroid < 0 ? -1 : 1;
  if (!(at_centroid < 0)) return;
  for (double& value : piece.value) value = -value;
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

/// Returns true if the projection of a point onto the line of an edge lies on the edge. A vertex is always the
/// projection.
bool DeviationBounds::is_on(SiteId site, const Vec3d& point) const {
  const std::array<std::int32_t, 3> v = sites_.vertices(site);
  if (v[1] < 0) return true;
  const Vec3d& first = mesh_.vertices[static_cast<std::size_t>(v[0])];
  const Vec3d side = mesh_.vertices[static_cast<std::size_t>(v[1])] - first;
  const double along = dot(point - first, side);
  const double least = rounding * length(side);
  return along >= -least && along <= squared_length(side) + least;
}

/// Returns true if a vertex or edge is closest to all points of a piece, up to rounding. Let q be the projections of
/// points x of the piece. Each other primitive must lie behind the planes through q with normals x - q, or be further
/// away by the bound of lower_bound(). For a vertex v, (v - q).(x - q) is an affine function of x. So if it is not
/// above 0 at the corners, it is not above 0 in between.
bool DeviationBounds::is_only(const DeviationPiece& piece, SiteId site, const Search& search) const {
  std::array<Vec3d, 3> offset;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!is_on(site, piece.corners[k])) return false;
    offset[k] = offset_from(site, piece.corners[k]);
  }
  const auto is_behind = [&](const Vec3d& v) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (dot(v - (piece.corners[k] - offset[k]), offset[k]) > rounding * 0.1) return false;
    }
    return true;
  };
  return std::all_of(search.found.begin(), search.found.end(), [&](const NearestPrimitive& one) {
    const Triangle v = primitive_vertices(mesh_, one.primitive);
    if (std::all_of(v.begin(), v.end(), [&](std::uint32_t k) { return is_behind(mesh_.vertices[k]); })) return true;
    const Vec3d away = search.centroid - one.point;
    const double size = length(away);
    if (!(size > 0)) return false;
    const Vec3d normal = away / size;
    const double front = front_of(one.primitive, normal, search.centroid);
    for (std::size_t k = 0; k < 3; ++k) {
      if (dot(normal, piece.corners[k] - search.centroid) - front < length(offset[k]) - rounding) return false;
    }
    return true;
  });
}

/// Returns places on a segment, 0 to 1, where the closest site may change from one site to another. The segment may
/// also cross a site there. For all sides of a piece, the same entry is on the same line or curve. Leaves out places
/// that are close to an end.
DeviationBounds::Places DeviationBounds::places_between(const std::array<Vec3d, 2>& ends,
                                                        const std::array<SiteId, 2>& sites) const {
  std::array<std::array<Vec3d, 2>, 2> offset;  // from each site, at each end
  for (std::size_t s = 0; s < 2; ++s) {
    for (std::size_t e = 0; e < 2; ++e) offset[s][e] = offset_from(sites[s], ends[e]);
  }
  // The projections onto a face and its edge, or an edge and its end, are the same where the closest site changes.
  return {zero_between({offset[0][0] - offset[1][0], offset[0][1] - offset[1][1]}),
          sign_change(squared_length(offset[0][0]) - squared_length(offset[1][0]),
                      squared_length(offset[0][1]) - squared_length(offset[1][1]),
                      squared_length(offset[0][1] - offset[0][0]) - squared_length(offset[1][1] - offset[1][0])),
          zero_between(offset[0]), zero_between(offset[1])};
}

/// Finds a place on a side of a piece where the closest site changes, or the side crosses the mesh. Sets the cut there,
/// and where the same line crosses another side. Returns false if no place is found.
bool DeviationBounds::cut_across(const DeviationPiece& piece, std::size_t side, std::array<double, 3>& cut) const {
  const auto ends_of = [&](std::size_t k) { return std::array{piece.corners[k], piece.corners[(k + 1) % 3]}; };
  const std::array<Vec3d, 2> ends = ends_of(side);
  const auto at = [&](double place) { return ends[0] + (ends[1] - ends[0]) * place; };
  // Several sites may be closest to the ends, because earlier cuts ended there.
  std::array<SiteId, 2> sites{bvh_.nearest(at(beside))->site, bvh_.nearest(at(1 - beside))->site};
  double begin = 0;
  double end = 1;
  for (int tries = 0; tries < most_tries; ++tries) {
    const Places places = places_between(ends, sites);
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (!places[k]) continue;
      const Vec3d there = at(*places[k]);
      const std::array<double, 2> distances{length(offset_from(sites[0], there)), length(offset_from(sites[1], there))};
      const double least = std::min(distances[0], distances[1]);
      const bool is_change = std::abs(distances[0] - distances[1]) < small || least < small;
      if (!is_change || bvh_.nearest(there)->distance < least - small) continue;
      cut[side] = *places[k];
      for (const std::size_t other : {(side + 1) % 3, (side + 2) % 3}) {
        const std::optional<double> place = places_between(ends_of(other), sites)[k];
        if (!place) continue;
        cut[other] = *place;
        break;
      }
      return true;
    }
    if (tries == 0 && sites[0] == sites[1]) return false;
    // Between the ends, other sites are closest. The first of them is searched.
    const double middle = begin + (end - begin) / 2;
    const SiteId third = bvh_.nearest(at(middle))->site;
    if (third == sites[0]) {
      begin = middle;
    } else {
      end = middle;
      sites[1] = third;
    }
  }
  return false;
}

/// Returns places on the sides of a piece: it is to be divided through these. They are 0 at corner k and 1 at the next
/// one; 0 means that the side is not divided. If possible, they are on a line on which the closest site changes.
std::array<double, 3> DeviationBounds::cut_of(const DeviationPiece& piece) const {
  std::array<double, 3> out{};
  const std::array<double, 3> squared = squared_sides(piece.corners);
  if (piece.may_cut) {
    std::array<std::size_t, 3> sides{0, 1, 2};
    std::sort(sides.begin(), sides.end(), [&](std::size_t a, std::size_t b) { return squared[a] > squared[b]; });
    for (const std::size_t side : sides) {
      if (cut_across(piece, side, out)) return out;
    }
  }
  out[piece.side < 3 ? piece.side : longest_of(squared)] = 0.5;
  return out;
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

/// Computes the bounds of a piece whose closest site is known. The distance is the length of an affine function, which
/// is convex. So its values at the corners and its tangent at the centroid enclose it.
void DeviationBounds::set_by_site(DeviationPiece& piece) const {
  const Vec3d centroid = centroid_of(piece.corners);
  std::array<Vec3d, 3> offsets;
  for (std::size_t k = 0; k < 3; ++k) offsets[k] = offset_from(piece.site, piece.corners[k]);
  const Vec3d middle = centroid_of(offsets);
  const double distance = length(middle);
  Linear lower;
  Linear upper;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    lower.at[k] = distance > 0 ? dot(offsets[k], middle) / distance : 0;
    upper.at[k] = length(offsets[k]);
    least = std::min(least, lower.at[k]);
  }
  // Rounding in is_only() changes a distance d by up to rounding / d.
  const double error = rounding / std::max(least, std::sqrt(rounding));
  for (std::size_t k = 0; k < 3; ++k) {
    lower.at[k] -= error;
    upper.at[k] += error;
  }
  set_values(piece, centroid, lower, upper);
  choose_bend(piece, offsets);
}

void DeviationBounds::sharpen(DeviationPiece& piece) const {
  piece.is_sharp = true;
  if (piece.site.has_value()) return set_by_site(piece);
  Search search;
  const Linear upper = examine(piece, search);
  const Linear lower = lower_bound(piece, search, upper);
  set_values(piece, search.centroid, lower, upper);
  std::array<Vec3d, 3> offsets;
  for (std::size_t k = 0; k < 3; ++k) offsets[k] = piece.corners[k] - upper.closest[k];
  choose_bend(piece, offsets);
  if (search.is_crowded || search.found.size() > most_for_sites || !(piece.largest_error() > rounding)) return;
  const SiteId site = search.found[0].site;
  if (sites_.site(site).kind != SiteKind::face && is_only(piece, site, search)) {
    piece.site = site;
    return set_by_site(piece);
  }
  piece.may_cut = true;
}

DeviationBounds::Parts DeviationBounds::parts(const DeviationPiece& piece) const {
  const std::array<double, 3> cut = cut_of(piece);
  // The piece is turned so that the first side is cut, and the last one if there are two cuts.
  std::size_t side = 0;
  while (!(cut[side] > 0) || cut[(side + 1) % 3] > 0) ++side;
  std::array<Corner, 3> c;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t at = (side + k) % 3;
    c[k] = {piece.corners[at], piece.value[at], piece.error[at]};
  }
  const double first = cut[side];
  const double last = cut[(side + 2) % 3];
  const Corner on_first = between(c[0], c[1], first);
  Parts out;
  if (last > 0) {
    const Corner on_last = between(c[2], c[0], last);
    out.push_back(part_of(piece, {c[0], on_first, on_last}, first * (1 - last)));
    out.push_back(part_of(piece, {on_first, c[1], c[2]}, 1 - first));
    out.push_back(part_of(piece, {on_first, c[2], on_last}, first * last));
  } else {
    out.push_back(part_of(piece, {c[0], on_first, c[2]}, first));
    out.push_back(part_of(piece, {on_first, c[1], c[2]}, 1 - first));
  }
  for (DeviationPiece& part : out) sharpen(part);
  return out;
}

}  // namespace blum::surface
