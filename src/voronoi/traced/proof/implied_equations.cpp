#include "voronoi/traced/proof/implied_equations.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>

namespace blum::voronoi {
namespace {

using Index = TracedSites::Index;
/// A sum of two doubles and its rounding error. Equal sums have equal pairs (Knuth 1969).
using ExactSum = std::pair<double, double>;

ExactSum exact_sum(double a, double b) {
  const double sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

/// A reflection that maps coordinates to coordinates: across an axis, or across a plane x_a - sign x_b = const.
struct Mirror {
  std::size_t a, b;  ///< axes; the same for a reflection across an axis
  double sign;       ///< -1 for a reflection across an axis

  /// Returns the constant for which q is the image of p, if there is one.
  [[nodiscard]] std::optional<ExactSum> between(const Vec3d& p, const Vec3d& q) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (k != a && k != b && p[k] != q[k]) return std::nullopt;
    }
    const ExactSum offset = exact_sum(q[a], -sign * p[b]);
    return offset == exact_sum(p[a], -sign * q[b]) ? std::optional(offset) : std::nullopt;
  }

  [[nodiscard]] Vec3d normal() const {
    Vec3d out;
    out[a] = 1;
    if (a == b) return out;
    out[b] = -sign;
    return out / std::numbers::sqrt2;
  }
};

constexpr std::array<Mirror, 9> mirrors{
    {{0, 0, -1}, {1, 1, -1}, {2, 2, -1}, {0, 1, 1}, {0, 1, -1}, {1, 2, 1}, {1, 2, -1}, {2, 0, 1}, {2, 0, -1}}};

class Symmetry {
 public:
  Symmetry(const TracedSites& traced, const MeshView& mesh, const std::vector<std::vector<Index>>& groups)
      : traced_(traced), mesh_(mesh), groups_(groups), is_kept_(groups.size(), false) {
    out_.distance.assign(groups.size(), false);
    out_.planes.assign(groups.size(), false);
    for (std::size_t g = 0; g < groups.size(); ++g) out_.image.push_back(g);
  }

  ImpliedEquations find() {
    find_slabs();
    for (const Mirror& mirror : mirrors) find_mirrored(mirror);
    return std::move(out_);
  }

 private:
  /// Returns -1 or 1 if a group is a face at right angles to an axis, exactly, and faces against it or along it.
  /// Otherwise returns 0.
  [[nodiscard]] int facing(std::size_t group, std::size_t axis) const {
    if (groups_[group].size() != 1) return 0;
    const TracedSite& site = traced_[groups_[group][0]];
    if (site.kind != SiteKind::face) return 0;
    // Directions are rounded, so that of a face that leans by less than 1e-8 may look like an axis.
    const double place = corner(group)[axis];
    const auto is_in_plane = [&](std::uint32_t v) { return mesh_.vertices[v][axis] == place; };
    if (!std::all_of(site.vertices.begin(), site.vertices.end(), is_in_plane)) return 0;
    return site.direction[axis] > 0 ? 1 : -1;
  }

  [[nodiscard]] const Vec3d& corner(std::size_t group) const {
    return mesh_.vertices[traced_[groups_[group][0]].vertices[0]];
  }

  struct Slab {
    std::size_t low, high;  ///< groups
    std::size_t axis;
  };

  [[nodiscard]] std::optional<Slab> slab_across(std::size_t axis) const {
    std::optional<std::size_t> low, high;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (facing(g, axis) > 0) low = g;
      if (facing(g, axis) < 0) high = g;
    }
    return low && high ? std::optional(Slab{*low, *high, axis}) : std::nullopt;
  }

  /// Leaves out the distance of one of two groups. The other one must stay, since it implies the first one.
  bool imply_one_of(std::size_t a, std::size_t b) {
    if (out_.distance[a] || out_.distance[b]) return false;
    for (const std::size_t g : {std::max(a, b), std::min(a, b)}) {
      if (g == 0 || is_kept_[g]) continue;
      out_.distance[g] = true;
      is_kept_[a + b - g] = true;
      return true;
    }
    return false;
  }

  void find_slabs() {
    std::optional<Slab> first;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::optional<Slab> slab = slab_across(axis);
      if (!slab) continue;
      if (!first) {
        first = slab;
        is_kept_[slab->low] = is_kept_[slab->high] = true;
        continue;
      }
      // Both widths are equal: high + low of the other = low + high of the other.
      if (exact_sum(corner(slab->high)[axis], corner(first->low)[first->axis]) ==
          exact_sum(corner(slab->low)[axis], corner(first->high)[first->axis])) {
        out_.has_slabs |= imply_one_of(slab->low, slab->high);
      }
    }
  }

  /// Returns corners that determine a site's plane, line or point.
  [[nodiscard]] std::vector<std::uint32_t> corners_of(const TracedSite& site) const {
    if (site.kind != SiteKind::face) return site.vertices;
    const Triangle& corners = mesh_.triangles[site.triangle_or_element];
    return {corners[0], corners[1], corners[2]};
  }

  /// Returns true if corners of a site are mirrored corners of another one.
  /// @param offset  of the mirror; set by the first corner.
  [[nodiscard]] bool is_image(const TracedSite& site, const TracedSite& other, const Mirror& mirror,
                              std::optional<ExactSum>& offset) const {
    if (site.kind != other.kind) return false;
    const std::vector<std::uint32_t> corners = corners_of(site);
    return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
      return std::any_of(other.vertices.begin(), other.vertices.end(), [&](std::uint32_t w) {
        const std::optional<ExactSum> own = mirror.between(mesh_.vertices[v], mesh_.vertices[w]);
        if (!own) return false;
        if (!offset) offset = own;
        return *own == *offset;
      });
    });
  }

  /// Returns the offset of a mirror for which one group is the image of another.
  [[nodiscard]] std::optional<ExactSum> offset_between(std::size_t a, std::size_t b, const Mirror& mirror) const {
    if (groups_[a].size() != groups_[b].size()) return std::nullopt;
    std::optional<ExactSum> offset;
    for (const Index i : groups_[a]) {
      const bool has_image = std::any_of(groups_[b].begin(), groups_[b].end(), [&](Index k) {
        std::optional<ExactSum> own = offset;
        if (!is_image(traced_[i], traced_[k], mirror, own)) return false;
        offset = own;
        return true;
      });
      if (!has_image) return std::nullopt;
    }
    return offset;
  }

  void find_mirrored(const Mirror& mirror) {
    std::optional<ExactSum> first;
    MirrorPlane plane{0, 0, mirror.normal()};
    bool is_used = false;
    for (std::size_t a = 0; a < groups_.size(); ++a) {
      for (std::size_t b = a + 1; b < groups_.size(); ++b) {
        const std::optional<ExactSum> offset = offset_between(a, b, mirror);
        if (!offset || (first && *offset != *first)) continue;
        if (!first) {
          if (out_.distance[a] || out_.distance[b]) continue;
          first = offset;
          plane.first = a;
          plane.second = b;
          is_kept_[a] = is_kept_[b] = true;
        } else if (!imply_one_of(a, b)) {
          continue;
        } else {
          is_used = true;
        }
        is_used = is_used || groups_[b].size() > 1;
        if (!out_.planes[a]) out_.planes[b] = groups_[b].size() > 1;
        out_.image[a] = b;
        out_.image[b] = a;
      }
    }
    if (!is_used) return;
    ++out_.mirrors;
    out_.planes_of_mirrors.push_back(plane);
  }

  const TracedSites& traced_;
  const MeshView& mesh_;
  const std::vector<std::vector<Index>>& groups_;
  ImpliedEquations out_;
  std::vector<bool> is_kept_;  ///< groups whose distances imply others, so that they are not implied themselves
};

}  // namespace

ImpliedEquations implied_equations(const TracedSites& traced, const MeshView& mesh,
                                   const std::vector<std::vector<TracedSites::Index>>& groups) {
  return Symmetry(traced, mesh, groups).find();
}

}  // namespace blum::voronoi
