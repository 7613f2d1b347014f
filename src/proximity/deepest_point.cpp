#include "proximity/deepest_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>
#include <vector>

#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_distance.hpp"
#include "proximity/facets.hpp"

namespace blum::detail {
namespace {

/// Parts are cut no further after this many points were looked at: the bound then says how far that went.
constexpr std::size_t most_points = 200000;
/// Sides and triangles of facets that are looked at, in all.
constexpr std::size_t most_of_facets = 100'000'000;

/// A point of a patch, and what of the surface is closest to it.
struct Sample {
  Vec3d point;
  double distance = 0;
  std::uint32_t other = 0;
};

/// A part of a triangle of a patch.
struct Part {
  std::array<Sample, 3> corners;
  std::size_t patch = 0;
  std::size_t triangle = 0;
  double bound = 0;
  [[nodiscard]] friend bool operator<(const Part& a, const Part& b) {
    return std::tuple(a.bound, b.patch, b.triangle) < std::tuple(b.bound, a.patch, a.triangle);
  }
};

/// The surface that a patch lies in.
struct Surface {
  Surface(const TriangleMesh& of_patch, double rounding)
      : mesh(of_patch), sites(of_patch), bvh(of_patch, sites), facets(of_patch, 16 * rounding) {}

  MeshView mesh;
  SiteTable sites;
  Bvh bvh;
  Facets facets;
};

class Search {
 public:
  Search(std::span<const DeepPatch> patches, double known, double tolerance, const Context& context)
      : patches_(patches), known_(known), tolerance_(tolerance), context_(context) {
    for (const DeepPatch& patch : patches) {
      const Box3 box = bounds(patch.surface);
      rounding_ = std::max(rounding_, 1e-14 * (length(box.lower) + length(box.upper)));
      surfaces_.emplace_back(patch.surface, rounding_);
    }
  }

  DeepestPoint run() {
    for (std::size_t p = 0; p < patches_.size(); ++p) {
      for (std::size_t t = 0; t < patches_[p].triangles.size(); ++t) {
        Part part;
        part.patch = p;
        part.triangle = t;
        for (std::size_t c = 0; c < 3; ++c) part.corners[c] = sample(patches_[p].triangles[t][c], part);
        push(part);
      }
    }
    while (!parts_.empty() && !is_done(parts_.top().bound) && points_ < most_points) {
      const Part part = parts_.top();
      parts_.pop();
      if (!cut_along_facets(part)) cut(part);
    }
    best_.bound = std::max({best_.distance, dropped_, parts_.empty() ? 0.0 : parts_.top().bound});
    return best_;
  }

 private:
  [[nodiscard]] bool is_done(double bound) const {
    return bound <= std::max(best_.distance, known_) * (1 + tolerance_) + rounding_;
  }

  Sample sample(const Vec3d& point, const Part& part) {
    const Surface& surface = surfaces_[part.patch];
    const NearestSite found = *surface.bvh.nearest(point);
    const Sample out{point, found.distance, surface.sites.triangle(found.site).value};
    if (out.distance > best_.distance || points_ == 0) {
      best_ = {out.distance, 0, point, found.point, part.patch, part.triangle, out.other};
    }
    constexpr std::size_t points_between_looks = 1024;
    if (++points_ % points_between_looks == 0) throw_if_cancelled(context_);
    return out;
  }

  /// The distance from the surface is nowhere larger than that from one of its triangles, which is largest at a corner;
  /// nor than that of a corner, and the way from there. Where all of the part is over a facet, than from its plane.
  [[nodiscard]] double bound(const Part& part) {
    double least = std::numeric_limits<double>::infinity();
    for (const Sample& from : part.corners) {
      const std::array<Vec3d, 3> other = triangle_corners(surfaces_[part.patch].mesh, from.other);
      double furthest = 0;
      double longest = 0;
      for (const Sample& to : part.corners) {
        furthest = std::max(furthest, triangle_distance({to.point, to.point, to.point}, other).distance);
        longest = std::max(longest, length(to.point - from.point));
      }
      least = std::min({least, furthest, from.distance + longest});
    }
    for (std::size_t k = 0; k < 3 && !is_done(least); ++k) {
      const std::optional<Facets::Lie> lie = lie_to_facet(part, part.corners[k].other);
      if (lie && lie->is_over) least = std::min(least, lie->furthest);
    }
    return least;
  }

  void push(Part part) {
    part.bound = bound(part);
    if (is_done(part.bound)) {
      dropped_ = std::max(dropped_, part.bound);
    } else {
      parts_.push(part);
    }
  }

  /// Cuts a part along a side of a facet of the surface: over a facet the distance from it is linear. Shallow contacts
  /// of large faces have few such parts, but could be halved for long.
  /// @return  whether there is such a side.
  bool cut_along_facets(const Part& part) {
    for (const Sample& corner : part.corners) {
      const std::optional<Facets::Lie> lie = lie_to_facet(part, corner.other);
      if (!lie || !lie->is_crossed) continue;
      cut_along(part, lie->sides);
      return true;
    }
    return false;
  }

  /// @return  nullopt once that has taken too long.
  std::optional<Facets::Lie> lie_to_facet(const Part& part, std::uint32_t triangle) {
    const Facets& facets = surfaces_[part.patch].facets;
    looked_at_ += facets.size(triangle);
    if (looked_at_ > most_of_facets) return std::nullopt;
    return facets.lie(points_of(part), triangle);
  }

  static std::array<Vec3d, 3> points_of(const Part& part) {
    return {part.corners[0].point, part.corners[1].point, part.corners[2].point};
  }

  /// @param sides  of the corners: some above 0, some below.
  void cut_along(const Part& part, const std::array<double, 3>& sides) {
    // The corners of both pieces, around the triangle: those of the cut belong to both.
    std::vector<Sample> above;
    std::vector<Sample> below;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const Sample& corner = part.corners[k];
      if (sides[k] >= 0) above.push_back(corner);
      if (sides[k] <= 0) below.push_back(corner);
      if (!(sides[k] * sides[next] < 0)) continue;
      const double t = sides[k] / (sides[k] - sides[next]);
      const Sample between = sample(corner.point + (part.corners[next].point - corner.point) * t, part);
      above.push_back(between);
      below.push_back(between);
    }
    for (const std::vector<Sample>& piece : {above, below}) {
      for (std::size_t k = 2; k < piece.size(); ++k) {
        Part out = part;
        out.corners = {piece[0], piece[k - 1], piece[k]};
        push(out);
      }
    }
  }

  /// In halves, across the longest side.
  void cut(const Part& part) {
    std::size_t at = 0;
    double longest = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double square = squared_length(part.corners[(k + 1) % 3].point - part.corners[k].point);
      if (square > longest) {
        longest = square;
        at = k;
      }
    }
    const Vec3d middle = (part.corners[at].point + part.corners[(at + 1) % 3].point) * 0.5;
    const Sample between = sample(middle, part);
    Part first = part;
    Part second = part;
    first.corners[(at + 1) % 3] = between;
    second.corners[at] = between;
    push(first);
    push(second);
  }

  std::span<const DeepPatch> patches_;
  std::vector<Surface> surfaces_;
  double known_;
  double tolerance_;
  const Context& context_;
  double rounding_ = 0;  ///< more than distances may be off
  DeepestPoint best_;
  double dropped_ = 0;  ///< largest bound of parts that are not looked at further
  std::size_t points_ = 0;
  std::size_t looked_at_ = 0;  ///< of facets
  std::priority_queue<Part> parts_;
};

}  // namespace

DeepestPoint deepest_point(std::span<const DeepPatch> patches, double known, double tolerance, const Context& context) {
  return Search(patches, known, tolerance, context).run();
}

}  // namespace blum::detail
