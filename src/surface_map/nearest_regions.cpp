#include "surface_map/nearest_regions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blum/geometry/sites.hpp"

namespace blum::surface {
namespace {

using Polygon = InlineList<Vec3d, 16>;
/// Values of a function at the corners of a polygon.
using Values = InlineList<double, 16>;
using Offsets = InlineList<Vec3d, 16>;

/// Where a polygon is divided, values of at most this are treated as 0.
constexpr double small = 1e-14;
/// A polygon is divided only if the values on both sides reach this.
constexpr double least_value = 1e-12;
/// Shortest cut along a curve.
constexpr double short_cut = 1e-6;

/// A vertex, the line of an edge or the plane of a face.
struct Flat {
  SiteKind kind = SiteKind::vertex;
  Vec3d origin;
  Vec3d direction;  ///< of the line, or normal of the plane
  SiteId site;
  std::size_t side = 0;  ///< of an edge: index of the facet's side

  /// Returns a point minus its projection. This is an affine function of the point.
  [[nodiscard]] Vec3d offset(const Vec3d& point) const {
    const Vec3d away = point - origin;
    if (kind == SiteKind::vertex) return away;
    const Vec3d part = direction * dot(away, direction);
    return kind == SiteKind::edge ? away - part : part;
  }
};

Flat vertex_of(const Facet& facet, std::size_t corner) {
  return {SiteKind::vertex, facet.corners[corner], {}, facet.vertices[corner], 0};
}

Flat edge_of(const Facet& facet, std::size_t side) {
  const Facet::Side& s = facet.sides[side];
  return {SiteKind::edge, s.begin, s.along, s.site, side};
}

/// Returns the vertex, edge or plane of a facet that is closest to a point.
Flat closest_flat(const Facet& facet, const Vec3d& point) {
  if (facet.has_plane && std::all_of(facet.sides.begin(), facet.sides.end(), [&](const Facet::Side& side) {
        return dot(point - side.begin, side.inward) >= 0;
      })) {
    return {SiteKind::face, facet.corners[0], facet.normal, facet.face, 0};
  }
  if (facet.sides.empty()) return vertex_of(facet, 0);
  Flat best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < facet.sides.size(); ++k) {
    const Facet::Side& side = facet.sides[k];
    const Vec3d away = point - side.begin;
    const double place = std::clamp(dot(away, side.along), 0.0, side.length);
    const double squared = squared_length(away - side.along * place);
    if (!(squared < least)) continue;
    least = squared;
    if (place <= 0) {
      best = vertex_of(facet, side.ends[0]);
    } else if (place >= side.length) {
      best = vertex_of(facet, side.ends[1]);
    } else {
      best = edge_of(facet, k);
    }
  }
  return best;
}

bool contains(const Facet& facet, SiteId site) {
  if (!site.has_value()) return false;
  const auto here = facet.vertices.begin();
  if (std::find(here, here + static_cast<std::ptrdiff_t>(facet.corners.size()), site) !=
      here + static_cast<std::ptrdiff_t>(facet.corners.size())) {
    return true;
  }
  return std::any_of(facet.sides.begin(), facet.sides.end(),
                     [&](const Facet::Side& side) { return side.site == site; });
}

Vec3d mean_of(const Polygon& polygon) {
  Vec3d sum;
  for (const Vec3d& corner : polygon) sum = sum + corner;
  return sum / static_cast<double>(polygon.size());
}

Offsets offsets_from(const Flat& flat, const Polygon& polygon) {
  Offsets out;
  for (const Vec3d& corner : polygon) out.push_back(flat.offset(corner));
  return out;
}

double largest(const Values& values) {
  return *std::max_element(values.begin(), values.end());
}

double smallest(const Values& values) {
  return *std::min_element(values.begin(), values.end());
}

/// Returns the sign of each value. Values that are treated as 0 have the sign of the previous value.
InlineList<bool, 16> signs_of(const Values& values) {
  bool is_above = false;
  for (const double value : values) {
    if (std::abs(value) > small) is_above = value > 0;
  }
  InlineList<bool, 16> out;
  for (const double value : values) {
    if (std::abs(value) > small) is_above = value > 0;
    out.push_back(is_above);
  }
  return out;
}

/// Returns true if a convex polygon can be divided where an affine function is 0. Rounding must not make it 0 at more
/// than two places of the border.
bool divides(const Values& values) {
  if (!(smallest(values) < -least_value && largest(values) > least_value)) return false;
  const InlineList<bool, 16> signs = signs_of(values);
  int changes = 0;
  for (std::size_t k = 0; k < signs.size(); ++k) changes += signs[k] != signs[(k + 1) % signs.size()] ? 1 : 0;
  return changes == 2;
}

/// Divides a polygon where an affine function is 0. The values must satisfy divides().
std::array<Polygon, 2> divided(const Polygon& polygon, const Values& values) {
  std::array<Polygon, 2> out;
  const InlineList<bool, 16> signs = signs_of(values);
  const std::size_t count = polygon.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t next = (k + 1) % count;
    Polygon& here = out[signs[k] ? 1 : 0];
    Polygon& there = out[signs[k] ? 0 : 1];
    here.push_back(polygon[k]);
    if (signs[k] == signs[next]) continue;
    if (std::abs(values[k]) <= small) {
      there.push_back(polygon[k]);
      continue;
    }
    // The next value is not treated as 0, because it would then have the same sign.
    const Vec3d at = polygon[k] + (polygon[next] - polygon[k]) * (values[k] / (values[k] - values[next]));
    here.push_back(at);
    there.push_back(at);
  }
  return out;
}

/// The search for the part of a polygon with the same closest site as one of its points, the mean of the corners.
class NearestAtMean {
 public:
  NearestAtMean(const Polygon& polygon, std::span<const Facet> facets, double tolerance)
      : polygon_(polygon), facets_(facets), tolerance_(tolerance), mean_(mean_of(polygon)) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < facets.size(); ++i) {
      const Flat here = closest_flat(facets[i], mean_);
      flats_.push_back(here);
      const double squared = squared_length(here.offset(mean_));
      squared_.push_back(squared);
      if (squared < least) {
        least = squared;
        own_ = i;
      }
    }
    offsets_ = offsets_from(flats_[own_], polygon);
    for (const Vec3d& corner : polygon) reach_ = std::max(reach_, length(corner - mean_));
    for (const Vec3d& offset : offsets_) furthest_ = std::max(furthest_, length(offset));
  }

  /// Returns true if the site is closest to all points. Otherwise values() divide the polygon, unless they are empty.
  [[nodiscard]] bool is_only() {
    if (!is_on_own()) return false;
    const Facet& own = facets_[own_];
    if (flats_[own_].kind != SiteKind::face && !is_before(own, offsets_, flats_[own_])) {
      take_front(own);
      return false;
    }
    double worst = tolerance_;
    bool out = true;
    for (std::size_t i = 0; i < facets_.size(); ++i) {
      if (i == own_ || std::sqrt(squared_[i]) > furthest_ + reach_ || is_nowhere_closer(i)) continue;
      out = false;
      take_border(i, worst);
    }
    return out;
  }

  [[nodiscard]] SiteId site() const { return flats_[own_].site; }
  [[nodiscard]] const Values& values() const { return values_; }

 private:
  /// Returns true if the projections of all corners are on the site. Otherwise takes the border that a corner is
  /// furthest beyond.
  bool is_on_own() {
    const Flat& flat = flats_[own_];
    if (flat.kind == SiteKind::vertex) return true;
    const Facet& facet = facets_[own_];
    double worst = tolerance_;
    bool out = true;
    const auto test = [&](const Vec3d& origin, const Vec3d& inward) {
      Values values;
      for (const Vec3d& corner : polygon_) values.push_back(dot(corner - origin, inward));
      if (smallest(values) >= -worst || !divides(values)) {
        out = out && smallest(values) >= -tolerance_;
        return;
      }
      worst = -smallest(values);
      out = false;
      values_ = values;
    };
    if (flat.kind == SiteKind::face) {
      for (const Facet::Side& side : facet.sides) test(side.begin, side.inward);
      if (!out) return false;
      Values heights;
      for (const Vec3d& corner : polygon_) heights.push_back(dot(corner - flat.origin, flat.direction));
      if (!divides(heights)) return true;
      values_ = heights;  // the distance from a plane changes linearly only on one side of it
      return false;
    }
    const Facet::Side& side = facet.sides[flat.side];
    test(side.begin, side.along);
    test(side.begin + side.along * side.length, side.along * -1.0);
    return out;
  }

  /// Returns true if a facet lies behind the planes through the projections of all corners, with the offsets as
  /// normals. For a vertex of the facet, its height over these planes is an affine function of the corner.
  [[nodiscard]] bool is_before(const Facet& facet, const Offsets& offsets, const Flat& flat) const {
    return std::all_of(facet.corners.begin(), facet.corners.end(),
                       [&](const Vec3d& vertex) { return largest(heights(vertex, offsets, flat)) <= tolerance_; });
  }

  [[nodiscard]] Values heights(const Vec3d& vertex, const Offsets& offsets, const Flat& flat) const {
    Values out;
    // The vertex's own offset has the same product as the vertex minus the projection, and smaller rounding errors.
    const Vec3d relative = flat.offset(vertex);
    for (const Vec3d& offset : offsets) out.push_back(dot(relative, offset));
    return out;
  }

  /// Takes the border at which a point of a facet comes closer than the facet's own vertex or edge.
  void take_front(const Facet& facet) {
    double worst = 0;
    for (const Vec3d& vertex : facet.corners) {
      const Values values = heights(vertex, offsets_, flats_[own_]);
      if (!divides(values) || largest(values) <= worst) continue;
      worst = largest(values);
      values_ = values;
    }
  }

  [[nodiscard]] bool is_nowhere_closer(std::size_t other) const {
    const Facet& facet = facets_[other];
    if (is_before(facet, offsets_, flats_[own_])) return true;
    if (is_further(facet, flats_[other])) return true;
    // Another part of the facet may be closest to another corner.
    SiteId tried = flats_[other].site;
    for (const Vec3d& corner : polygon_) {
      const Flat flat = closest_flat(facet, corner);
      if (flat.site == tried) continue;
      tried = flat.site;
      if (is_further(facet, flat)) return true;
    }
    return false;
  }

  /// Returns true if no point of the polygon is closer to a facet than to the site. A lower bound of the
  /// facet's distance is that of its plane, or of a vertex or line that the whole facet is behind. The difference of
  /// both squares is a quadratic function. The function is not above 0 if its polar form is not above 0 for any pair of
  /// corners.
  [[nodiscard]] bool is_further(const Facet& facet, const Flat& flat) const {
    const Offsets others = offsets_from(flat, polygon_);
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
      for (std::size_t j = i; j < polygon_.size(); ++j) {
        if (dot(offsets_[i], offsets_[j]) - dot(others[i], others[j]) > tolerance_) return false;
      }
    }
    return flat.kind == SiteKind::face || is_before(facet, others, flat);
  }

  /// Takes the border between the site and a facet, if a corner is closer to the facet by more than `worst`.
  void take_border(std::size_t other, double& worst) {
    const Facet& facet = facets_[other];
    Flat flat;
    double most = worst;
    std::size_t corner = polygon_.size();
    for (std::size_t k = 0; k < polygon_.size(); ++k) {
      const Flat here = closest_flat(facet, polygon_[k]);
      const double gain = squared_length(offsets_[k]) - squared_length(here.offset(polygon_[k]));
      if (gain <= most) continue;
      most = gain;
      flat = here;
      corner = k;
    }
    if (corner == polygon_.size()) return;
    const Values before = values_;
    values_.shrink(0);
    if (contains(facet, flats_[own_].site) || squared_[other] - squared_[own_] <= tolerance_) {
      take_front(facet);
    } else {
      take_equal(flat, corner);
    }
    if (values_.empty()) {
      values_ = before;
    } else {
      worst = most;
    }
  }

  /// Takes the border at which a flat is as close as the site.
  /// @param corner  is closer to the flat.
  void take_equal(const Flat& flat, std::size_t corner) {
    const Flat& own = flats_[own_];
    if (own.kind == SiteKind::face && flat.kind == SiteKind::face) {
      for (const double sign : {1.0, -1.0}) {
        const auto at = [&](const Vec3d& point) {
          return dot(point - own.origin, own.direction) - sign * dot(point - flat.origin, flat.direction);
        };
        if (!(at(mean_) * at(polygon_[corner]) < 0)) continue;
        Values values;
        for (const Vec3d& point : polygon_) values.push_back(at(point));
        if (divides(values)) values_ = values;
      }
      return;
    }
    const Offsets others = offsets_from(flat, polygon_);
    Values values;
    for (std::size_t k = 0; k < polygon_.size(); ++k) {
      values.push_back(squared_length(offsets_[k]) - squared_length(others[k]));
    }
    if (!divides(values)) return;
    if (is_affine(values, others)) {
      values_ = values;
    } else {
      take_chord(values, others);
    }
  }

  [[nodiscard]] bool is_affine(const Values& values, const Offsets& others) const {
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
      for (std::size_t j = i + 1; j < polygon_.size(); ++j) {
        const double polar = dot(offsets_[i], offsets_[j]) - dot(others[i], others[j]);
        if (std::abs(2 * polar - values[i] - values[j]) > 2 * small) return false;
      }
    }
    return true;
  }

  /// Takes the line through the two points at which a curve of equal distance meets the sides.
  void take_chord(const Values& values, const Offsets& others) {
    InlineList<Vec3d, 16> ends;
    const std::size_t count = polygon_.size();
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t next = (k + 1) % count;
      if (!(values[k] * values[next] < 0)) continue;
      const double square = squared_length(offsets_[next] - offsets_[k]) - squared_length(others[next] - others[k]);
      const double place = zero_of(values[k], values[next], square);
      ends.push_back(polygon_[k] + (polygon_[next] - polygon_[k]) * place);
    }
    if (ends.size() != 2) return;
    const Vec3d along = ends[1] - ends[0];
    Vec3d normal;
    for (std::size_t k = 2; k < count; ++k) {
      normal = normal + cross(polygon_[k - 1] - polygon_[0], polygon_[k] - polygon_[0]);
    }
    const Vec3d across = cross(normal, along);
    const double size = length(across);
    if (!(length(along) > short_cut && size > 0)) return;
    Values distances;
    for (const Vec3d& corner : polygon_) distances.push_back(dot(corner - ends[0], across) / size);
    if (smallest(distances) < -short_cut && largest(distances) > short_cut && divides(distances)) values_ = distances;
  }

  /// Returns the parameter, 0 to 1, at which a quadratic function changes its sign.
  /// @param square  factor of the square.
  static double zero_of(double at_0, double at_1, double square) {
    if (at_0 > 0) return zero_of(-at_0, -at_1, -square);
    const double slope = at_1 - at_0 - square;
    const double root = std::sqrt(std::max(slope * slope - 4 * square * at_0, 0.0));
    return std::clamp(-2 * at_0 / (slope + root), 0.0, 1.0);
  }

  const Polygon& polygon_;
  std::span<const Facet> facets_;
  double tolerance_;
  Vec3d mean_;
  double reach_ = 0;                ///< largest distance of a corner from the mean
  double furthest_ = 0;             ///< largest distance of a corner from the site
  InlineList<Flat, 16> flats_;      ///< for each facet, the part that is closest to the mean
  InlineList<double, 16> squared_;  ///< squares of its distances
  std::size_t own_ = 0;             ///< the closest facet
  Offsets offsets_;                 ///< from the closest flat, for each corner
  Values values_;                   ///< of the border
};

}  // namespace

Facet make_facet(std::span<const Vec3d> corners, std::span<const SiteId> vertices, std::span<const SiteId> sides,
                 SiteId face) {
  // A plane is accurate if the height of the triangle is at least this share of its longest side.
  constexpr double least_height = 0.02;
  Facet out;
  const std::size_t count = corners.size();
  if (count == 0) return out;
  double longest = 0;
  for (std::size_t k = 0; k < count; ++k) {
    out.corners.push_back(corners[k]);
    out.vertices[k] = vertices[k];
  }
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const Vec3d along = corners[(k + 1) % count] - corners[k];
    const double size = length(along);
    longest = std::max(longest, size);
    const std::array<std::uint8_t, 2> ends{static_cast<std::uint8_t>(k), static_cast<std::uint8_t>((k + 1) % count)};
    if (size > 0) out.sides.push_back({corners[k], along / size, {}, size, ends, sides[k]});
  }
  if (count < 3) return out;
  const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double area = length(normal);
  if (!(area > least_height * longest * longest)) return out;
  out.has_plane = true;
  out.face = face;
  out.normal = normal / area;
  for (Facet::Side& side : out.sides) side.inward = cross(out.normal, side.along);
  return out;
}

void divide_by_nearest(const std::array<Vec3d, 3>& triangle, std::span<const Facet> facets, std::size_t most,
                       double tolerance, std::vector<NearestRegion>& out) {
  std::vector<Polygon> open(1);
  for (const Vec3d& corner : triangle) open[0].push_back(corner);
  std::size_t triangles = 1;  // that all parts have together
  while (!open.empty()) {
    const Polygon now = open.back();
    open.pop_back();
    NearestAtMean nearest(now, facets, tolerance);
    const bool is_only = nearest.is_only();
    // A line divides at most two triangles of a part into three each. It adds at most two corners to both parts.
    if (is_only || nearest.values().empty() || triangles + 2 > most || now.size() + 2 > 16) {
      out.push_back({now, is_only ? nearest.site() : SiteId{}});
      continue;
    }
    for (const Polygon& part : divided(now, nearest.values())) {
      if (part.size() > 2) open.push_back(part);
    }
    triangles += 2;
  }
}

}  // namespace blum::surface
