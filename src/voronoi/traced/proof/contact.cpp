#include "voronoi/traced/proof/contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "blum/core/union_find.hpp"
#include "blum/geometry/closest_point.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/traced/proof/implied_equations.hpp"

namespace blum::voronoi {
namespace {

using Index = TracedSites::Index;

LinearBound operator-(const LinearBound& a, const LinearBound& b) {
  return {{a.value.value - b.value.value, a.value.error + b.value.error},
          a.slope - b.slope,
          a.turned + b.turned,
          a.bend + b.bend};
}

/// Returns the distance of a point from a segment.
double distance_from(const std::array<Vec3d, 2>& ends, const Vec3d& q) {
  const Vec3d along = ends[1] - ends[0];
  const double t = std::clamp(dot(q - ends[0], along) / squared_length(along), 0.0, 1.0);
  return length(ends[0] + along * t - q);
}

}  // namespace

double Tube::reach() const {
  return std::sqrt(half * half + radius * radius);
}

double Tube::change(const Vec3d& slope) const {
  const double axial = std::abs(dot(slope, along));
  return half * axial + radius * length(half > 0 ? slope - along * dot(slope, along) : slope);
}

Contact::Contact(const SiteBounds& bounds, const MeshView& mesh, const std::vector<Index>& members, std::size_t wanted)
    : bounds_(bounds), sites_(bounds.sites()), mesh_(mesh), members_(members) {
  detail::UnionFind joined(static_cast<std::uint32_t>(members.size()));
  for (std::uint32_t a = 0; a < members.size(); ++a) {
    for (std::uint32_t b = a + 1; b < members.size(); ++b) {
      if (sites_.side_between(members[a], members[b]) != nullptr) joined.join(a, b);
    }
  }
  std::vector<std::size_t> number(members.size(), members.size());
  for (std::uint32_t a = 0; a < members.size(); ++a) {
    std::size_t& own = number[joined.find(a)];
    if (own == members.size()) {
      own = groups_.size();
      groups_.push_back({{}, members[a], {}, {}});
    }
    Group& group = groups_[own];
    group.members.push_back(members[a]);
    if (sites_[members[a]].kind > sites_[group.lead].kind) group.lead = members[a];
  }
  for (Group& group : groups_) add_planes(group);
  std::vector<std::vector<Index>> groups;
  for (const Group& group : groups_) groups.push_back(group.members);
  implied_.distance.assign(groups.size(), false);
  implied_.planes.assign(groups.size(), false);
  if (equation_count() > wanted && bounds_.are_corners_exact()) implied_ = implied_equations(sites_, mesh, groups);
}

void Contact::add_planes(Group& group) const {
  std::vector<Vec3d> basis;  // orthonormal
  for (std::size_t a = 0; a < group.members.size(); ++a) {
    for (std::size_t b = a + 1; b < group.members.size(); ++b) {
      const DomainSide* side = sites_.side_between(group.members[a], group.members[b]);
      if (side == nullptr) continue;
      group.planes.push_back({side, group.members[a], group.members[b]});
      Vec3d rest = side->normal;
      for (const Vec3d& e : basis) rest -= e * dot(e, rest);
      constexpr double dependent = 1e-6;
      if (length(rest) < dependent) continue;
      basis.push_back(unit(rest));
      group.basis.push_back(group.planes.back());
    }
  }
}

std::size_t Contact::equation_count() const {
  std::size_t count = 0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (g > 0 && !implied_.distance[g]) ++count;
    if (!implied_.planes[g]) count += groups_[g].basis.size();
  }
  return count;
}

bool Contact::is_regular(const Vec3d& at) const {
  for (const Group& group : groups_) {
    const auto count = [&](SiteKind kind) {
      return std::count_if(group.members.begin(), group.members.end(), [&](Index i) { return sites_[i].kind == kind; });
    };
    if (group.basis.size() < 2 && group.members.size() != group.basis.size() + 1) return false;
    // A face and both edges at one of its corners; the corner, too, if it has a domain.
    if (group.basis.size() == 2 && (count(SiteKind::face) != 1 || count(SiteKind::edge) != 2)) return false;
    if (group.basis.size() > 2) return false;
  }
  // Mirrored lines that are not parallel have the same distance in two planes. Only one is that of the mirror.
  return std::all_of(
      implied_.planes_of_mirrors.begin(), implied_.planes_of_mirrors.end(), [&](const MirrorPlane& plane) {
        const Vec3d across =
            sites_.gradient(groups_[plane.first].lead, at) - sites_.gradient(groups_[plane.second].lead, at);
        return std::abs(dot(across, plane.normal)) > 0.9 * length(across);
      });
}

std::size_t Contact::degree(const Vec3d& at) const {
  if (equation_count() != 3 || !is_regular(at)) return 0;
  if (implied_.mirrors == 1 && !implied_.has_slabs) return degree_in_mirror();
  if (implied_.is_any()) return degree_of_symmetric(at);
  for (const Group& group : groups_) {
    // The curve of the group's own members ends here, and each member has a curve on the wall to the other group.
    if (group.basis.size() == 2) return groups_.size() == 2 ? group.members.size() + 1 : 0;
    if (group.basis.size() > 2 || group.members.size() != group.basis.size() + 1) return 0;
  }
  return 4;
}

/// Returns the number of seams at a junction in a mirror. On each side, the groups of this side have one seam. Their
/// walls meet the mirror in seams, unless both sites are their own images.
std::size_t Contact::degree_in_mirror() const {
  std::vector<std::size_t> half;  // groups of one side, and of the mirror
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (implied_.image[g] >= g) half.push_back(g);
  }
  std::size_t equations = half.size() - 1;
  for (const std::size_t g : half) equations += groups_[g].basis.size();
  if (equations != 2) return 0;
  const auto is_own_image = [&](std::size_t g) { return implied_.image[g] == g; };
  std::size_t seams = 2;
  if (half.size() == 1) return seams + groups_[half[0]].members.size();
  for (std::size_t a = 0; a < half.size(); ++a) {
    // A group with a plane has two members, and the wall between them.
    const std::size_t own = groups_[half[a]].members.size();
    if (own > 2) return 0;
    if (own == 2 && !is_own_image(half[a])) ++seams;
    for (std::size_t b = a + 1; b < half.size(); ++b) {
      if (!is_own_image(half[a]) || !is_own_image(half[b])) seams += own * groups_[half[b]].members.size();
    }
  }
  return seams;
}

/// Returns the number of seams at a junction with implied equations: that of the facets of the convex hull of all
/// gradients.
std::size_t Contact::degree_of_symmetric(const Vec3d& at) const {
  std::vector<Vec3d> slopes;
  for (const Group& group : groups_) {
    if (group.members.size() != 1) return 0;
    slopes.push_back(sites_.gradient(group.lead, at));
  }
  std::set<std::vector<std::size_t>> facets;
  for (std::size_t a = 0; a < slopes.size(); ++a) {
    for (std::size_t b = a + 1; b < slopes.size(); ++b) {
      for (std::size_t c = b + 1; c < slopes.size(); ++c) {
        const Vec3d across = cross(slopes[b] - slopes[a], slopes[c] - slopes[a]);
        std::vector<std::size_t> on;
        std::size_t above = 0, below = 0;
        for (std::size_t k = 0; k < slopes.size(); ++k) {
          // Only slopes of implied equations lie in one plane with others, but for rounding.
          constexpr double rounding = 1e-12, clear = 1e-6;
          const double height = dot(across, slopes[k] - slopes[a]);
          if (std::abs(height) <= rounding) {
            on.push_back(k);
          } else if (std::abs(height) < clear) {
            return 0;
          } else {
            ++(height > 0 ? above : below);
          }
        }
        if (above == 0 || below == 0) facets.insert(on);
      }
    }
  }
  return facets.size();
}

bool Contact::is_at_vertex(std::uint32_t vertex) const {
  return std::all_of(members_.begin(), members_.end(), [&](Index i) {
    const std::vector<std::uint32_t>& own = sites_[i].vertices;
    return std::binary_search(own.begin(), own.end(), vertex);
  });
}

LinearBound Contact::distance(const Group& group, const Vec3d& x, double reach) const {
  LinearBound out = bounds_.distance(group.lead, x, reach);
  // On the other side of a plane, the distance is that of another member. Both have the same gradient in the plane.
  for (const GroupPlane& plane : group.planes) {
    const double height = plane.side->height(x);
    if (height == 0) continue;
    out.value.error += height * height * out.bend;
    out.turned += 2 * std::abs(height) * out.bend;
  }
  return out;
}

std::vector<LinearBound> Contact::equations(const Vec3d& x, double reach) const {
  std::vector<LinearBound> out;
  const LinearBound first = distance(groups_[0], x, reach);
  for (std::size_t g = 1; g < groups_.size(); ++g) {
    if (!implied_.distance[g]) out.push_back(distance(groups_[g], x, reach) - first);
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (implied_.planes[g]) continue;
    for (const GroupPlane& plane : groups_[g].basis) {
      out.push_back(bounds_.height(*plane.side, plane.i, plane.k, x));
    }
  }
  return out;
}

bool Contact::is_between_members(const Group& group, Index i, const DomainSide& side, double height) const {
  constexpr double loose = 16;
  if (std::abs(height) > loose * sites_.tolerance()) return false;
  constexpr double parallel = 1e-9;
  const bool is_plane = std::any_of(group.planes.begin(), group.planes.end(), [&](const GroupPlane& plane) {
    return length(cross(plane.side->normal, side.normal)) <= parallel;
  });
  return is_plane || is_end_of_two(group, i, side);
}

/// Returns true if a side is the end of an edge at which another edge of the group starts. Below such a vertex of a
/// face, with an angle above 180 degrees, both edges and the face share a footprint.
bool Contact::is_end_of_two(const Group& group, Index i, const DomainSide& side) const {
  if (sites_[i].kind != SiteKind::edge) return false;
  const auto is_at_end = [&](std::uint32_t v) { return sites_.vertices()[v] == side.ends[0]; };
  return std::any_of(group.members.begin(), group.members.end(), [&](Index k) {
    const std::vector<std::uint32_t>& own = sites_[k].vertices;
    return k != i && sites_[k].kind == SiteKind::edge && std::any_of(own.begin(), own.end(), is_at_end) &&
           std::abs(dot(side.normal, sites_[i].direction)) > 0.5;
  });
}

bool Contact::is_inside_domain(const Group& group, Index i, const Tube& tube) const {
  const TracedSite& site = sites_[i];
  const double error = bounds_.corner_error() + bounds_.rounding();
  if (site.kind != SiteKind::face) {
    return std::all_of(site.sides.begin(), site.sides.end(), [&](const DomainSide& side) {
      const double height = side.height(tube.centre);
      if (is_between_members(group, i, side, height)) return true;
      const LinearBound above = bounds_.height(side, i, i, tube.centre);
      return height > tube.change(side.normal) + above.value.error + above.error_over(tube.reach());
    });
  }
  // The foot moves at most as far as the point.
  const double way = tube.reach() + error + bounds_.direction_error(i) * (tube.reach() + sites_.extent());
  const Vec3d foot = sites_.foot(i, tube.centre);
  if (sites_.outside(i, tube.centre) > (group.members.size() > 1 ? 16 * sites_.tolerance() : 0)) return false;
  bool is_clear = true;
  sites_.for_each_side(i, tube.centre, way, [&](const DomainSide& side) {
    is_clear =
        is_clear && (distance_from(side.ends, foot) > way || is_between_members(group, i, side, side.height(foot)));
  });
  return is_clear;
}

bool Contact::are_inside_domains(const Tube& tube) const {
  return std::all_of(groups_.begin(), groups_.end(), [&](const Group& group) {
    return std::all_of(group.members.begin(), group.members.end(),
                       [&](Index i) { return is_inside_domain(group, i, tube); });
  });
}

/// Returns true if no point of a triangle is closer than the members, for points inside their domains.
bool Contact::is_part_of_member(std::uint32_t triangle) const {
  const Triangle& corners = mesh_.triangles[triangle];
  const Index face = sites_.face_of(triangle);
  return std::any_of(members_.begin(), members_.end(), [&](Index i) {
    const TracedSite& site = sites_[i];
    if (site.kind == SiteKind::face) return face == i;
    if (site.kind == SiteKind::vertex)
      return std::find(corners.begin(), corners.end(), site.vertices[0]) != corners.end();
    // A triangle of an adjacent face may lie beyond the edge as seen from the domain. Then the line is closer.
    const BorderEdge& edge = sites_.edges()[site.border];
    for (const std::size_t k : {0U, 1U}) {
      if (edge.faces[k] != face) continue;
      return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
        return site.sides[k].height(sites_.vertices()[v]) <= bounds_.corner_error();
      });
    }
    return false;
  });
}

bool Contact::are_closest(const Tube& tube, const Bvh& border) const {
  const double reach = tube.reach();
  std::vector<LinearBound> own;
  double largest = std::numeric_limits<double>::infinity();
  for (const Group& group : groups_) {
    own.push_back(distance(group, tube.centre, reach));
    largest = std::min(largest, own.back().value.value + own.back().value.error);
  }
  const double error = bounds_.corner_error() + bounds_.rounding();
  bool is_proven = true;
  // Farther triangles stay farther: both distances change at most as much as the place.
  border.for_each_within(tube.centre + sites_.origin(), largest + 2 * reach + 4 * error + bounds_.moved(),
                         [&](const NearestPrimitive& found) {
                           if (is_part_of_member(found.primitive)) return true;
                           std::array<Vec3d, 3> corners;
                           for (std::size_t k = 0; k < 3; ++k)
                             corners[k] = sites_.vertices()[mesh_.triangles[found.primitive][k]];
                           const Vec3d way = tube.centre - closest_point_on_triangle(tube.centre, corners);
                           const double size = length(way);
                           // The triangle lies behind the plane through its closest corner at right angles to `slope`.
                           const Vec3d slope = size > 0 ? way / size : Vec3d{};
                           double least = std::numeric_limits<double>::infinity();
                           for (const Vec3d& corner : corners)
                             least = std::min(least, dot(slope, tube.centre - corner));
                           is_proven = std::any_of(own.begin(), own.end(), [&](const LinearBound& d) {
                             const double most =
                                 d.value.value + d.value.error + tube.change(slope - d.slope) + d.error_over(reach);
                             return least - error > most;
                           });
                           return is_proven;
                         });
  return is_proven;
}

}  // namespace blum::voronoi
