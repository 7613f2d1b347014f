#include "medial_axis/shape/fill_polygon.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace blum {
namespace {

bool has(const PolygonFiller::Places& places, std::uint32_t place) {
  return std::find(places.begin(), places.end(), place) != places.end();
}

}  // namespace

/// A corner of a polygon and those next to it.
struct PolygonFiller::Ear {
  double squared_length = 0;  ///< of what joins the two next to the corner
  std::size_t corner = 0;     ///< in the polygon
  std::uint32_t before = 0, place = 0, after = 0;
};

/// A corner, and new places on a way between those next to it.
struct PolygonFiller::Detour {
  Ear over;
  Places places;
};

std::vector<PolygonFiller::Ear> PolygonFiller::ears_of(const Places& polygon, const std::vector<Places>& sides) const {
  const std::size_t size = polygon.size();
  std::vector<Ear> ears;
  for (std::size_t k = 0; k < size; ++k) {
    Ear ear{0, k, polygon[k == 0 ? size - 1 : k - 1], polygon[k], polygon[k + 1 == size ? 0 : k + 1]};
    const auto has_both = [&](const Places& side) { return has(side, ear.before) && has(side, ear.after); };
    if (std::any_of(sides.begin(), sides.end(), has_both)) continue;
    ear.squared_length = squared_length(stop_of_(ear.after).at - stop_of_(ear.before).at);
    ears.push_back(ear);
  }
  std::sort(ears.begin(), ears.end(), [](const Ear& a, const Ear& b) {
    return a.squared_length != b.squared_length ? a.squared_length < b.squared_length : a.corner < b.corner;
  });
  return ears;
}

bool PolygonFiller::is_joined(const Ear& ear) const {
  return paths_.is_straight(stop_of_(ear.before), stop_of_(ear.after));
}

bool PolygonFiller::is_open(const Ear& ear) const {
  return is_joined(ear) && paths_.is_open(stop_of_(ear.before), stop_of_(ear.place), stop_of_(ear.after));
}

/// A corner to cut off, and new places on a way between the two next to it, the shortest ears first. A way that runs
/// over a corner of the polygon, or through the ball around it, leaves about the same one to fill.
std::optional<PolygonFiller::Detour> PolygonFiller::detour(const Places& polygon, std::span<const Ear> ears) {
  for (const Ear& ear : ears) {
    if (!add_ || budget_.detours-- <= 0) return std::nullopt;
    const auto path = paths_.path(stop_of_(ear.before), stop_of_(ear.after), {});
    const auto is_corner = [&](const Stop& stop) {
      return std::any_of(polygon.begin(), polygon.end(), [&](std::uint32_t place) {
        return length(stop_of_(place).at - stop.at) < stop.nearest.distance;
      });
    };
    if (!path || path->empty() || std::any_of(path->begin(), path->end(), is_corner)) continue;
    Detour found{ear, {}};
    for (const Stop& stop : *path) found.places.push_back(add_(stop));
    return found;
  }
  return std::nullopt;
}

/// Triangles around a new vertex that all corners of a polygon can be joined to; those that the surface comes through
/// are filled in the same way. @return  whether there is a place for it.
/// @param least_open  how many of the triangles none of the surface may come through.
bool PolygonFiller::fan_out(const Places& polygon, std::size_t least_open) {
  if (!add_ || budget_.fans-- <= 0) return false;
  std::vector<Stop> corners;
  for (const std::uint32_t place : polygon) corners.push_back(stop_of_(place));
  const std::optional<Hub> middle = paths_.seeing_all(corners, least_open);
  if (!middle) return false;
  const std::uint32_t hub = add_(middle->stop);
  for (std::size_t k = 0; k < polygon.size(); ++k) fill({hub, polygon[k], polygon[(k + 1) % polygon.size()]}, {});
  return true;
}

bool PolygonFiller::fill(Places polygon, const std::vector<Places>& sides) {
  bool stays = true;
  while (polygon.size() > 3) {
    const std::vector<Ear> ears = ears_of(polygon, sides);
    auto ear = std::find_if(ears.begin(), ears.end(), [&](const Ear& e) { return is_open(e); });
    if (ear == ears.end() && fan_out(polygon, polygon.size() - 1)) return stays;
    if (ear == ears.end()) is_all_open_ = false;
    if (ear == ears.end()) ear = std::find_if(ears.begin(), ears.end(), [&](const Ear& e) { return is_joined(e); });
    if (ear == ears.end() && !ears.empty()) {
      if (const auto found = detour(polygon, ears)) {
        const auto& [over, path] = *found;
        Places cut_off{over.before, over.place, over.after};
        cut_off.insert(cut_off.end(), path.rbegin(), path.rend());
        // What is left over of the polygon has the path as well.
        std::vector<Places> sides_there = sides;
        Places& shared = sides_there.emplace_back(path);
        shared.push_back(over.before);
        shared.push_back(over.after);
        stays = fill(std::move(cut_off), sides_there) && stays;
        const auto at = polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(over.corner));
        polygon.insert(at, path.begin(), path.end());
        continue;
      }
      if (fan_out(polygon, 0)) return stays;
      ear = ears.begin();
      stays = false;
    }
    if (ear == ears.end()) {  // a vertex in the middle joins no two of them
      if (!add_) return false;
      Vec3d sum;
      for (const std::uint32_t place : polygon) sum += stop_of_(place).at;
      const std::uint32_t middle =
          add_(paths_.inside_near(sum / static_cast<double>(polygon.size()), stop_of_(polygon[0])));
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        triangles_.insert(triangles_.end(), {middle, polygon[k], polygon[(k + 1) % polygon.size()]});
      }
      return false;
    }
    triangles_.insert(triangles_.end(), {ear->before, ear->place, ear->after});
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(ear->corner));
  }
  if (!paths_.is_open(stop_of_(polygon[0]), stop_of_(polygon[1]), stop_of_(polygon[2]))) {
    if (fan_out(polygon, 2)) return stays;
    is_all_open_ = false;
  }
  triangles_.insert(triangles_.end(), polygon.begin(), polygon.end());
  return stays;
}

}  // namespace blum
