#include "voronoi/traced/local_star.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "blum/core/sort_unique.hpp"
#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {

LocalStar::LocalStar(const TracedSites& sites, const Vec3d& at, const std::vector<Index>& found)
    : sites_(sites), at_(at) {
  double radius = 0;
  for (const Index i : found) radius = std::max(radius, sites_.distance(i, at_));
  const double tolerance = 8 * sites_.tolerance();
  angle_tolerance_ = std::max(sites_.precision().angle, 4 * tolerance / std::max(radius, tolerance));
  for (const Index i : found) {
    Member member{i, sites_.gradient(i, at_), 0, sites_.sides_at(i, at_, tolerance), {}};
    if (sites_[i].kind == SiteKind::edge) member.across = cross(sites_[i].direction, member.gradient);
    std::erase_if(member.sides, [](const DomainSide* side) { return !side->is_open; });
    while (member.group < groups_.size() && length(groups_[member.group] - member.gradient) > angle_tolerance_) {
      ++member.group;
    }
    if (member.group == groups_.size()) groups_.push_back(member.gradient);
    members_.push_back(std::move(member));
  }
}

double LocalStar::bend(const Member& member, const Vec3d& direction) const {
  if (sites_[member.site].kind == SiteKind::face) return 0;
  if (sites_[member.site].kind == SiteKind::vertex) return squared_length(cross(direction, member.gradient));
  const double size = dot(member.across, direction);
  return size * size;
}

std::vector<const LocalStar::Member*> LocalStar::closest_in(const Vec3d& direction, double tolerance) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3d& gradient : groups_) least = std::min(least, dot(gradient, direction));
  std::vector<double> least_bend(groups_.size(), std::numeric_limits<double>::infinity());
  std::vector<const Member*> out;
  for (const Member& member : members_) {
    if (dot(groups_[member.group], direction) > least + tolerance) continue;
    if (!sites_.leads_inside(member.site, member.sides, direction, tolerance)) continue;
    out.push_back(&member);
    least_bend[member.group] = std::min(least_bend[member.group], bend(member, direction));
  }
  std::erase_if(out, [&](const Member* m) { return bend(*m, direction) > least_bend[m->group] + tolerance; });
  return out;
}

TracedSites::Index LocalStar::site_beside(const std::vector<const Member*>& near, const Vec3d& direction,
                                          const Vec3d& across) const {
  const Vec3d aside = direction + across * 1e-3;
  Index best = near.front()->site;
  double least = std::numeric_limits<double>::infinity();
  double least_bend = least;
  for (const Member* member : near) {
    const bool is_inside = std::all_of(member->sides.begin(), member->sides.end(), [&](const DomainSide* side) {
      return std::abs(dot(side->normal, direction)) > angle_tolerance_ || dot(side->normal, across) >= 0;
    });
    const bool is_corner = sites_[member->site].kind == SiteKind::face && member->sides.size() == 2;
    if (is_corner ? !sites_.leads_inside(member->site, member->sides, aside, 0) : !is_inside) continue;
    const double rate = dot(groups_[member->group], across);
    const double own_bend = bend(*member, aside);
    if (rate > least + 1e-12 || (rate > least - 1e-12 && own_bend >= least_bend)) continue;
    least = rate;
    least_bend = own_bend;
    best = member->site;
  }
  return best;
}

SeamRay LocalStar::ray(const Vec3d& direction) const {
  SeamRay out;
  out.direction = direction;
  const std::vector<const Member*> near = closest_in(direction, angle_tolerance_);
  for (const Member* member : near) out.sites.push_back(member->site);
  detail::sort_unique(out.sites);
  // Axes across the direction, counterclockwise as seen from its tip.
  const std::array<Vec3d, 2> axes = axes_across(direction);
  const Vec3d right = -axes[0];
  const Vec3d up = -axes[1];
  std::vector<double> angles;
  const auto way = [&](double angle) { return right * std::cos(angle) + up * std::sin(angle); };
  // Between many groups, most lines lie where other groups are closer.
  constexpr std::size_t many = 12;
  const auto is_lowest = [&](double angle, const Vec3d& gradient) {
    const Vec3d aside = way(angle);
    const double most = dot(gradient, aside) - 4 * angle_tolerance_;
    return std::all_of(near.begin(), near.end(),
                       [&](const Member* m) { return dot(groups_[m->group], aside) >= most; });
  };
  const auto add_line = [&](const Vec3d& normal, const Vec3d* gradient = nullptr) {
    const double a = dot(normal, right), b = dot(normal, up);
    if (!(std::hypot(a, b) >= 1e-9)) return;  // also without a number
    const double angle = std::atan2(-a, b);
    for (const double own : {angle, angle + (angle > 0 ? -std::numbers::pi : std::numbers::pi)}) {
      if (gradient == nullptr || near.size() <= many || is_lowest(own, *gradient)) angles.push_back(own);
    }
  };
  for (std::size_t a = 0; a < near.size(); ++a) {
    for (std::size_t b = a + 1; b < near.size(); ++b) {
      if (near[a]->group != near[b]->group) {
        add_line(groups_[near[a]->group] - groups_[near[b]->group], &groups_[near[a]->group]);
      } else {
        add_line(near[a]->across - near[b]->across);
        add_line(near[a]->across + near[b]->across);
      }
    }
    for (const DomainSide* side : near[a]->sides) {
      if (std::abs(dot(side->normal, direction)) <= angle_tolerance_) add_line(side->normal);
    }
  }
  std::sort(angles.begin(), angles.end());
  std::vector<double> kept;
  for (const double angle : angles) {
    if (kept.empty() || angle - kept.back() > angle_tolerance_) kept.push_back(angle);
  }
  if (kept.size() > 1 && kept.front() + 2 * std::numbers::pi - kept.back() <= angle_tolerance_) kept.pop_back();
  if (kept.empty()) return out;
  const auto site_at = [&](double angle) { return site_beside(near, direction, way(angle)); };
  std::vector<Index> sectors;  // sector k is counterclockwise of angle k
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const double next = k + 1 < kept.size() ? kept[k + 1] : kept.front() + 2 * std::numbers::pi;
    sectors.push_back(site_at(0.5 * (kept[k] + next)));
  }
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const Index before = sectors[(k + kept.size() - 1) % kept.size()];
    if (before != sectors[k]) out.ring.germs.push_back({before, sectors[k], way(kept[k])});
  }
  return out;
}

void LocalStar::add(const Vec3d& direction, std::vector<SeamRay>& rays) const {
  if (!(length(direction) > 1e-9)) return;
  const Vec3d h = unit(direction);
  for (const SeamRay& known : rays) {
    if (length(known.direction - h) < std::max(sites_.precision().direction, 2 * angle_tolerance_)) return;
  }
  SeamRay found = ray(h);
  if (found.ring.germs.size() > 2) rays.push_back(std::move(found));
}

std::vector<LocalStar::Plane> LocalStar::planes_of_groups() const {
  std::vector<Plane> planes;
  for (const Member& first : members_) {
    for (const DomainSide* side : first.sides) planes.push_back({side->normal, first.group});
    for (const Member& second : members_) {
      if (&second <= &first || second.group != first.group) continue;
      for (const double sign : {1.0, -1.0}) {
        const Vec3d normal = first.across + second.across * sign;
        if (length(first.across) > 0 && length(second.across) > 0 && length(normal) > 1e-6) {
          planes.push_back({unit(normal), first.group});
        }
      }
    }
  }
  return planes;
}

Vec3d LocalStar::widest_normal(const Vec3d& normal, const Vec3d& point) const {
  // Directions of close points are not precise, so the points that are furthest apart give the normal.
  std::vector<Vec3d> in_plane;
  for (const Vec3d& g : groups_) {
    if (std::abs(dot(g - point, normal)) <= angle_tolerance_) in_plane.push_back(g - point);
  }
  Vec3d furthest;
  for (const Vec3d& g : in_plane) {
    if (squared_length(g) > squared_length(furthest)) furthest = g;
  }
  Vec3d widest;
  for (const Vec3d& g : in_plane) {
    const Vec3d across = cross(furthest, g);
    if (squared_length(across) > squared_length(widest)) widest = across;
  }
  if (!(length(widest) > 0)) return normal;
  const Vec3d out = unit(widest);
  return dot(out, normal) < 0 ? -out : out;
}

std::vector<Vec3d> LocalStar::facet_normals() const {
  constexpr std::size_t many = 8;
  std::vector<Vec3d> out;
  // Many gradients may lie in one facet, so no facet is found twice.
  std::vector<std::pair<Vec3d, double>> facets;
  const auto is_in_a_facet = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return std::any_of(facets.begin(), facets.end(), [&](const auto& facet) {
      const auto& [normal, level] = facet;
      return std::abs(dot(a, normal) - level) <= angle_tolerance_ &&
             std::abs(dot(b, normal) - level) <= angle_tolerance_ &&
             std::abs(dot(c, normal) - level) <= angle_tolerance_;
    });
  };
  for (std::size_t a = 0; a < groups_.size(); ++a) {
    for (std::size_t b = a + 1; b < groups_.size(); ++b) {
      for (std::size_t c = b + 1; c < groups_.size(); ++c) {
        const Vec3d normal = cross(groups_[b] - groups_[a], groups_[c] - groups_[a]);
        if (!(length(normal) > 1e-12) || is_in_a_facet(groups_[a], groups_[b], groups_[c])) continue;
        const Vec3d h = groups_.size() > many ? widest_normal(unit(normal), groups_[a]) : unit(normal);
        const double level = dot(groups_[a], h);
        const auto is_lowest = [&](double sign) {
          return std::all_of(groups_.begin(), groups_.end(),
                             [&](const Vec3d& g) { return (dot(g, h) - level) * sign >= -angle_tolerance_; });
        };
        const std::size_t before = out.size();
        if (is_lowest(1)) out.push_back(h);
        if (is_lowest(-1)) out.push_back(-h);
        if (out.size() > before && groups_.size() > many) facets.emplace_back(h, level);
      }
    }
  }
  return out;
}

std::vector<SeamRay> LocalStar::rays() const {
  std::vector<SeamRay> out;
  const auto add_both = [&](const Vec3d& direction) {
    add(direction, out);
    add(-direction, out);
  };
  for (const Vec3d& h : facet_normals()) add(h, out);
  const std::vector<Plane> planes = planes_of_groups();
  for (const Plane& plane : planes) {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (g != plane.group) add_both(cross(plane.normal, groups_[g] - groups_[plane.group]));
    }
    for (const Plane& other : planes) {
      if (&other > &plane) add_both(cross(plane.normal, other.normal));
    }
  }
  return out;
}

}  // namespace blum::voronoi
