#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/summary.hpp"
#include "proximity/queries.hpp"

namespace blum::cli {

Columns columns_of(std::span<const Penetration> penetrations) {
  Columns out(penetrations.size());
  const std::span<double> bound = out.add<double>("depth_bound");
  const std::span<double> direction = out.add<double>("direction", 3);
  const std::span<double> area = out.add<double>("area", 2);
  const std::span<double> volume = out.add<double>("volume");
  const std::span<std::int32_t> deep_object = out.add<std::int32_t>("deep_object");
  for (std::size_t n = 0; n < penetrations.size(); ++n) {
    const Penetration& part = penetrations[n];
    bound[n] = part.depth_bound;
    for (std::size_t axis = 0; axis < 3; ++axis) direction[3 * n + axis] = part.direction[axis];
    std::copy(part.area.begin(), part.area.end(), &area[2 * n]);
    volume[n] = part.volume;
    deep_object[n] = (part.is_first_deep ? part.first_object : part.second_object).to_file();
  }
  return out;
}

Json penetration_json(const Penetration& part) {
  Json curves = Json::array();
  for (const std::vector<Vec3d>& curve : part.curves) {
    Json points = Json::array();
    for (const Vec3d& p : curve) points.push_back(to_json(p));
    curves.push_back(std::move(points));
  }
  return {{"object", {part.first_object.value, part.second_object.value}},
          {"depth", part.depth},
          {"depth_bound", part.depth_bound},
          {"direction", to_json(part.direction)},
          {"deep_point", to_json(part.deep_point)},
          {"surface_point", to_json(part.surface_point)},
          {"deep_object", part.is_first_deep ? part.first_object.value : part.second_object.value},
          {"deep_triangle", part.deep_triangle},
          {"surface_triangle", part.surface_triangle},
          {"area", to_json(part.area)},
          {"volume", part.volume},
          {"curves", std::move(curves)}};
}

}  // namespace blum::cli
