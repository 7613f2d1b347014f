#include "voronoi/planes/plane_regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <stop_token>
#include <utility>

#include "blum/core/gather.hpp"

namespace blum::voronoi {
namespace {

using Index = HalfSpaces::Index;

struct RegionVertex {
  PlaneCorner corner;
  PlacedCorner placed;
};

/// The region of one plane.
class Region {
 public:
  /// @param cancel  after a request to stop, the region is not complete.
  Region(const HalfSpaces& spaces, const ConvexFaces& faces, Index plane, const std::stop_token& cancel)
      : spaces_(spaces), plane_(plane) {
    for (std::uint32_t k = 0; k < 8; ++k) {
      add({plane_, spaces_.box_side(k & 1U), spaces_.box_side(2 + (k >> 1U & 1U)),
           spaces_.box_side(4 + (k >> 2U & 1U))});
    }
    cut(spaces_.floor());
    for (const Index other : order(faces)) {
      // In degenerate solids, a region may take longer than a caller may wait.
      if (cancel.stop_requested()) return;
      cut(other);
    }
  }

  [[nodiscard]] const std::vector<RegionVertex>& vertices() const { return vertices_; }
  [[nodiscard]] bool is_bounded() const {
    return !vertices_.empty() && std::all_of(vertices_.begin(), vertices_.end(), [&](const RegionVertex& v) {
      return v.corner.planes.back() <= spaces_.floor();
    });
  }

 private:
  /// Returns the other planes. Neighbours come first, as they bound the region. Balls above the middle of the plane
  /// reach some planes before others. They come next, so that few later planes cut the region.
  [[nodiscard]] std::vector<Index> order(const ConvexFaces& faces) const {
    const Vec3d& middle = faces.middle[plane_];
    std::vector<double> height(spaces_.plane_count());
    for (Index k = 0; k < height.size(); ++k) {
      height[k] =
          (dot(spaces_.normal(k), middle) + spaces_.offset(k)) / (1 - dot(spaces_.normal(k), spaces_.normal(plane_)));
      // Planes that doubles take for parallel have no height. An order needs a number.
      if (std::isnan(height[k])) height[k] = HUGE_VAL;
    }
    for (const Index k : faces.neighbours[plane_]) height[k] = -HUGE_VAL;
    std::vector<Index> out;
    for (Index k = 0; k < height.size(); ++k) {
      if (k != plane_) out.push_back(k);
    }
    std::sort(out.begin(), out.end(),
              [&](Index a, Index b) { return std::pair(height[a], a) < std::pair(height[b], b); });
    return out;
  }

  void add(const HalfSpaces::Base& base) {
    PlaneCorner corner{{base.begin(), base.end()}, base};
    std::sort(corner.planes.begin(), corner.planes.end());
    vertices_.push_back({std::move(corner), spaces_.place(base)});
  }

  void cut(Index by) {
    std::vector<int> side(vertices_.size());
    bool is_cut = false;
    for (std::size_t k = 0; k < vertices_.size(); ++k) {
      side[k] = spaces_.side(vertices_[k].corner.base, vertices_[k].placed, by);
      is_cut = is_cut || side[k] < 0;
    }
    const std::vector<RegionVertex> made = is_cut ? vertices_on_edges(side, by) : std::vector<RegionVertex>();
    std::vector<RegionVertex> kept;
    for (std::size_t k = 0; k < vertices_.size(); ++k) {
      if (side[k] < 0) continue;
      if (side[k] == 0) insert(vertices_[k].corner.planes, by);
      kept.push_back(std::move(vertices_[k]));
    }
    kept.insert(kept.end(), made.begin(), made.end());
    vertices_ = std::move(kept);
  }

  static void insert(std::vector<Index>& sorted, Index value) {
    sorted.insert(std::lower_bound(sorted.begin(), sorted.end(), value), value);
  }

  [[nodiscard]] std::vector<Index> common(const RegionVertex& a, const RegionVertex& b) const {
    std::vector<Index> out;
    std::set_intersection(a.corner.planes.begin(), a.corner.planes.end(), b.corner.planes.begin(),
                          b.corner.planes.end(), std::back_inserter(out));
    return out;
  }

  /// Returns the vertices in which the border of a half-space crosses edges.
  [[nodiscard]] std::vector<RegionVertex> vertices_on_edges(const std::vector<int>& side, Index by) const {
    std::vector<RegionVertex> out;
    for (std::size_t a = 0; a < side.size(); ++a) {
      if (side[a] >= 0) continue;
      for (std::size_t b = 0; b < side.size(); ++b) {
        if (side[b] <= 0) continue;
        std::vector<Index> planes = common(vertices_[a], vertices_[b]);
        if (planes.size() < 3 || !is_edge(a, b, planes)) continue;
        RegionVertex made;
        made.corner.base = base_of(planes, by);
        insert(planes, by);
        made.corner.planes = std::move(planes);
        made.placed = spaces_.place(made.corner.base);
        out.push_back(std::move(made));
      }
    }
    return out;
  }

  [[nodiscard]] bool is_edge(std::size_t a, std::size_t b, const std::vector<Index>& planes) const {
    for (std::size_t k = 0; k < vertices_.size(); ++k) {
      if (k == a || k == b) continue;
      const std::vector<Index>& own = vertices_[k].corner.planes;
      if (std::includes(own.begin(), own.end(), planes.begin(), planes.end())) return false;
    }
    return true;
  }

  /// Returns the plane of the region, two others that meet in an edge, and the one that cuts the edge. Two borders in
  /// a region are never the same plane, so any two along an edge do.
  [[nodiscard]] HalfSpaces::Base base_of(const std::vector<Index>& planes, Index by) const {
    HalfSpaces::Base out{plane_, 0, 0, by};
    std::size_t count = 1;
    for (const Index k : planes) {
      if (k != plane_ && count < 3) out[count++] = k;
    }
    return out;
  }

  const HalfSpaces& spaces_;
  Index plane_;
  std::vector<RegionVertex> vertices_;
};

}  // namespace

std::vector<PlaneCorner> plane_corners(const HalfSpaces& spaces, const ConvexFaces& faces, bool& is_bounded,
                                       const Context& context) {
  is_bounded = true;
  // An empty list of planes marks a region that is not bounded.
  std::vector<PlaneCorner> all = detail::gather<PlaneCorner>(
      context, spaces.plane_count(), 1, "regions", [&](std::size_t plane, std::vector<PlaneCorner>& out) {
        const Region region(spaces, faces, static_cast<Index>(plane), context.cancel);
        if (!region.is_bounded()) {
          out.emplace_back();
          return;
        }
        for (const RegionVertex& vertex : region.vertices()) {
          // The first of its planes lists a vertex.
          if (vertex.corner.planes.front() == plane) out.push_back(vertex.corner);
        }
      });
  throw_if_cancelled(context);
  is_bounded = std::none_of(all.begin(), all.end(), [](const PlaneCorner& corner) { return corner.planes.empty(); });
  if (!is_bounded) return {};
  std::sort(all.begin(), all.end(), [](const PlaneCorner& a, const PlaneCorner& b) { return a.planes < b.planes; });
  return all;
}

}  // namespace blum::voronoi
