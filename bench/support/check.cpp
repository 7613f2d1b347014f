#include "support/check.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "blum/core/random.hpp"

namespace blum::bench {
namespace {

double distance_of_id(const Shape& shape, const Field& field, SiteId id, const Vec3d& position) {
  if (field.site_ids == SiteIds::features) return shape.brute_force().site_distance(id, position);
  const Triangle& t = shape.mesh.triangles[id.value];
  const auto& v = shape.mesh.vertices;
  return reference::triangle_distance(position, v[t[0]], v[t[1]], v[t[2]]);
}

struct NodeErrors {
  double distance = 0;
  double site = 0;
  bool wrong_side = false;
};

NodeErrors errors_at(const Shape& shape, const Field& field, std::size_t node, const Vec3d& position, double slack) {
  const double exact = shape.brute_force().nearest(position).distance;
  const double expected = field.band ? std::min(exact, *field.band) : exact;
  const double given = static_cast<double>(field.distance[node]);
  NodeErrors errors{.distance = std::abs(std::abs(given) - expected)};
  const SiteId id = field.site[node];
  if (id.has_value()) errors.site = std::abs(distance_of_id(shape, field, id, position) - exact);
  if (field.sign_rule != SignRule::none && exact > slack) {
    errors.wrong_side = (reference::winding_number(shape.mesh, position) > 0.5) != (given < 0);
  }
  return errors;
}

}  // namespace

void spot_check(benchmark::State& state, const Shape& shape, const Field& field, double tolerance) {
  const auto& size = field.grid.size;
  Box3 box = bounds(shape.mesh);
  box.extend(bounds(field.grid));
  const double diagonal = box.diagonal();
  const double sites = static_cast<double>(shape.brute_force().sites().size());
  const int wanted = static_cast<int>(std::clamp(4e7 / sites, 5.0, 100.0));
  Random random(7);
  int checked = 0;
  double worst = 0;
  for (int attempt = 0; checked < wanted && attempt < 1000 * wanted; ++attempt) {
    const auto draw = [&](int axis) {
      return static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(size[static_cast<std::size_t>(axis)])));
    };
    const std::int64_t i = draw(0);
    const std::int64_t j = draw(1);
    const std::int64_t k = draw(2);
    const std::size_t node = field.grid.index(i, j, k);
    if (std::isnan(field.distance[node])) continue;
    const NodeErrors errors = errors_at(shape, field, node, field.grid.position(i, j, k), tolerance * diagonal);
    worst = std::max({worst, errors.distance / diagonal, errors.site / diagonal});
    ++checked;
    if (errors.wrong_side || worst > tolerance) {
      std::ostringstream message;
      message << "WRONG at node " << i << ' ' << j << ' ' << k << ": distance off by " << errors.distance
              << ", site by " << errors.site << (errors.wrong_side ? ", on the wrong side" : "");
      state.SkipWithError(message.str().c_str());
      return;
    }
  }
  state.counters["checked"] = checked;
  state.counters["worst_error"] = worst;
}

}  // namespace blum::bench
