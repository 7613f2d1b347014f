#include "voronoi/planes/plane_structure.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "blum/core/parallel.hpp"
#include "voronoi/planes/plane_regions.hpp"

namespace blum::voronoi {
namespace {

using Index = HalfSpaces::Index;

constexpr std::size_t corners_per_range = 64;

class Builder {
 public:
  Builder(const HalfSpaces& spaces, const std::vector<PlaneCorner>& corners) : spaces_(spaces), corners_(corners) {}

  /// Adds the sheets. Returns false if the vertices of one do not form a loop, or a plane has no polygon.
  bool add_sheets(PlaneStructure& out) {
    std::vector<std::vector<std::uint32_t>> of_plane(spaces_.plane_count());
    for (std::uint32_t k = 0; k < corners_.size(); ++k) {
      for (const Index plane : corners_[k].planes) {
        if (plane != spaces_.floor()) of_plane[plane].push_back(k);
      }
    }
    for (Index plane = 0; plane < of_plane.size(); ++plane) {
      std::map<Index, std::vector<std::uint32_t>> shared;
      for (const std::uint32_t k : of_plane[plane]) {
        for (const Index other : corners_[k].planes) {
          if (other > plane) shared[other].push_back(k);
        }
      }
      bool has_surface = false;
      for (const auto& [other, members] : shared) {
        if (members.size() < 3) continue;
        PlaneSheet sheet{plane, other, loop(plane, other, members)};
        if (sheet.junctions.size() != members.size()) return false;
        turn(sheet, out);
        const bool is_surface = other == spaces_.floor();
        has_surface = has_surface || is_surface;
        (is_surface ? out.surface : out.sheets).push_back(std::move(sheet));
      }
      if (!has_surface) return false;
    }
    return true;
  }

 private:
  /// Returns the vertices of a sheet in the order of its border; fewer if they do not form one loop.
  [[nodiscard]] std::vector<std::uint32_t> loop(Index first, Index second,
                                                const std::vector<std::uint32_t>& members) const {
    std::map<Index, std::vector<std::uint32_t>> touching;
    for (std::uint32_t k = 0; k < members.size(); ++k) {
      for (const Index plane : corners_[members[k]].planes) {
        if (plane != first && plane != second) touching[plane].push_back(k);
      }
    }
    std::vector<std::vector<std::uint32_t>> neighbours(members.size());
    const auto link = [&](std::uint32_t a, std::uint32_t b) {
      if (std::find(neighbours[a].begin(), neighbours[a].end(), b) == neighbours[a].end()) neighbours[a].push_back(b);
    };
    for (const auto& [plane, both] : touching) {
      if (both.size() != 2) continue;
      link(both[0], both[1]);
      link(both[1], both[0]);
    }
    std::vector<std::uint32_t> out;
    std::uint32_t before = 0;
    std::uint32_t at = 0;
    do {
      if (neighbours[at].size() != 2 || out.size() == members.size()) return {};
      out.push_back(members[at]);
      const std::uint32_t next =
          neighbours[at][0] == before && !(out.size() == 1) ? neighbours[at][1] : neighbours[at][0];
      before = at;
      at = next;
    } while (at != 0);
    return out;
  }

  /// Turns a sheet so that it is counterclockwise as seen from the region of its second plane, or from inside.
  void turn(PlaneSheet& sheet, const PlaneStructure& out) const {
    Vec3d towards = spaces_.normal(sheet.first);
    if (sheet.second != spaces_.floor()) towards = towards - spaces_.normal(sheet.second);
    Vec3d area;
    const Vec3d& start = out.junctions[sheet.junctions[0]].at;
    for (std::size_t k = 1; k + 1 < sheet.junctions.size(); ++k) {
      area += cross(out.junctions[sheet.junctions[k]].at - start, out.junctions[sheet.junctions[k + 1]].at - start);
    }
    if (dot(area, towards) < 0) std::reverse(sheet.junctions.begin() + 1, sheet.junctions.end());
  }

  const HalfSpaces& spaces_;
  const std::vector<PlaneCorner>& corners_;
};

}  // namespace

std::optional<PlaneStructure> plane_structure(const ConvexFaces& faces, const Context& context) {
  const HalfSpaces& spaces = faces.spaces;
  bool is_bounded = false;
  const std::vector<PlaneCorner> corners = plane_corners(spaces, faces, is_bounded, context);
  if (!is_bounded) return std::nullopt;
  PlaneStructure out;
  for (Index plane = 0; plane < spaces.plane_count(); ++plane) out.normals.push_back(spaces.normal(plane));
  out.junctions.resize(corners.size());
  parallel_for(context, corners.size(), corners_per_range, "junctions", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const PlacedCorner placed = spaces.place_exactly(corners[k].base);
      out.junctions[k] = {placed.at, placed.height, placed.condition, corners[k].planes};
    }
  });
  if (!Builder(spaces, corners).add_sheets(out)) return std::nullopt;
  return out;
}

}  // namespace blum::voronoi
