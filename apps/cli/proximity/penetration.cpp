#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "common/summary.hpp"
#include "proximity/queries.hpp"

namespace blum::cli {
namespace {

/// Adds seconds to a phase of this name.
void add_phases(const std::vector<PhaseTime>& from, std::vector<PhaseTime>& to) {
  for (const PhaseTime& one : from) {
    const auto same = [&](const PhaseTime& other) { return other.phase == one.phase; };
    const auto at = std::find_if(to.begin(), to.end(), same);
    if (at == to.end()) {
      to.push_back(one);
    } else {
      at->seconds += one.seconds;
    }
  }
}

bool overlap(const Box3& a, const Box3& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.lower[axis] > b.upper[axis] || b.lower[axis] > a.upper[axis]) return false;
  }
  return true;
}

}  // namespace

std::vector<ScenePenetration> all_penetrations(const ProximityScene& scene, bool is_self,
                                               const PenetrationOptions& options, const Context& context,
                                               std::vector<PhaseTime>& phases) {
  std::vector<ScenePenetration> out;
  const auto count = static_cast<std::uint32_t>(scene.size());
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = is_self ? a : a + 1; b < count; ++b) {
      const Penetrations found = scene.penetration(ObjectId(a), ObjectId(b), options, context);
      for (const Penetration& part : found.parts) out.push_back({ObjectId(a), ObjectId(b), part});
      add_phases(found.phases, phases);
    }
  }
  return out;
}

PrimitivePair pair_of(const ScenePenetration& penetration) {
  const Penetration& part = penetration.part;
  constexpr TriangleFeature inside{SiteKind::face, 0};
  PrimitivePair out{penetration.first,
                    penetration.second,
                    part.deep_triangle,
                    part.surface_triangle,
                    {-part.depth, part.deep_point, part.surface_point, inside, inside}};
  if (!part.is_first_deep) {
    std::swap(out.first, out.second);
    std::swap(out.between.first_point, out.between.second_point);
  }
  return out;
}

ProximityPairs signed_separations(const ProximityScene& scene, std::span<const MeshView> meshes,
                                  const PenetrationOptions& options, const Context& context) {
  std::vector<Box3> boxes;
  for (const MeshView& mesh : meshes) boxes.push_back(bounds(mesh));
  ProximityPairs out = scene.separation(std::numeric_limits<double>::infinity(), context);
  for (PrimitivePair& pair : out.pairs) {
    const ObjectId a = pair.first_object;
    const ObjectId b = pair.second_object;
    if (!overlap(boxes[a.value], boxes[b.value])) continue;
    const Penetrations found = scene.penetration(a, b, options, context);
    if (!found.parts.empty()) pair = pair_of({a, b, found.parts.front()});
    add_phases(found.phases, out.report.phases);
  }
  return out;
}

Columns columns_of(std::span<const ScenePenetration> penetrations) {
  Columns out(penetrations.size());
  const std::span<double> bound = out.add<double>("depth_bound");
  const std::span<double> direction = out.add<double>("direction", 3);
  const std::span<double> area = out.add<double>("area", 2);
  const std::span<double> volume = out.add<double>("volume");
  const std::span<std::int32_t> deep_object = out.add<std::int32_t>("deep_object");
  for (std::size_t n = 0; n < penetrations.size(); ++n) {
    const Penetration& part = penetrations[n].part;
    bound[n] = part.depth_bound;
    for (std::size_t axis = 0; axis < 3; ++axis) direction[3 * n + axis] = part.direction[axis];
    std::copy(part.area.begin(), part.area.end(), &area[2 * n]);
    volume[n] = part.volume;
    deep_object[n] = (part.is_first_deep ? penetrations[n].first : penetrations[n].second).to_file();
  }
  return out;
}

Json json_of(const ScenePenetration& penetration) {
  const Penetration& part = penetration.part;
  Json curves = Json::array();
  for (const std::vector<Vec3d>& curve : part.curves) {
    Json points = Json::array();
    for (const Vec3d& p : curve) points.push_back(to_json(p));
    curves.push_back(std::move(points));
  }
  return {{"object", {penetration.first.value, penetration.second.value}},
          {"depth", part.depth},
          {"depth_bound", part.depth_bound},
          {"direction", to_json(part.direction)},
          {"deep_point", to_json(part.deep_point)},
          {"surface_point", to_json(part.surface_point)},
          {"deep_object", part.is_first_deep ? penetration.first.value : penetration.second.value},
          {"deep_triangle", part.deep_triangle},
          {"surface_triangle", part.surface_triangle},
          {"area", to_json(part.area)},
          {"volume", part.volume},
          {"curves", std::move(curves)}};
}

}  // namespace blum::cli
