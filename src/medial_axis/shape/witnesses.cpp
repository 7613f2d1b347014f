#include "medial_axis/shape/witnesses.hpp"

#include <algorithm>

namespace blum::detail {
namespace {

bool is_deeper(const Stop& a, const Stop& b) {
  if (a.nearest.distance != b.nearest.distance) return a.nearest.distance > b.nearest.distance;
  return a.at[0] != b.at[0] ? a.at[0] < b.at[0] : a.at[1] != b.at[1] ? a.at[1] < b.at[1] : a.at[2] < b.at[2];
}

}  // namespace

Witnesses::Witnesses(const GovernorField& governors, const CellStructure& structure)
    : governors_(governors), structure_(structure), paths_(governors.surface()), known_(structure.extra_count()) {}

std::optional<Stop> Witnesses::witness_of(Cell extra) const {
  const Vec3d& at = structure_.extra()->cell(extra).witness;
  Known& known = known_[extra - structure_.first_extra()];
  if (known.state.load(std::memory_order_acquire) == State::known) {
    return known.nearest ? std::optional(Stop{at, *known.nearest}) : std::nullopt;
  }
  const std::optional<Stop> stop = paths_.stop_at(at, {});
  State expected = State::unknown;  // one thread writes; others computed the same value at the same time
  if (known.state.compare_exchange_strong(expected, State::being_written)) {
    if (stop) known.nearest = stop->nearest;
    known.state.store(State::known, std::memory_order_release);
  }
  return stop;
}

std::optional<Stop> Witnesses::deepest_voxel(Cell cell) const {
  const VoxelSolid& solid = governors_.solid();
  std::optional<std::array<std::int64_t, 3>> deepest;
  const auto depth = [&](const std::array<std::int64_t, 3>& v) {
    return solid.depth[solid.grid.index(v[0], v[1], v[2])];
  };
  for_each_voxel_inside(governors_, structure_.lattice(), cell, [&](const std::array<std::int64_t, 3>& at) {
    if (!deepest || depth(at) > depth(*deepest)) deepest = at;
  });
  if (!deepest) return std::nullopt;
  const Governor g = governors_.at((*deepest)[0], (*deepest)[1], (*deepest)[2]);
  return paths_.stop_at(g.centre, g.foot);
}

/// Calls use(stop) for known points of a cell's component: its own point, and those of the cells that it is a face of.
template <class Use>
void Witnesses::for_each_witness(Cell cell, const Use& use) const {
  const auto offer_cell = [&](Cell other) {
    if (const auto stop = structure_.is_extra(other) ? witness_of(other) : deepest_voxel(other)) use(*stop);
  };
  if (structure_.is_extra(cell)) offer_cell(cell);
  const auto offer_cofaces = [&](Cell below) {
    structure_.for_each_coface(below, [&](Cell coface) {
      // Points of lattice cells are found through their voxels, so only pairs with an extra cell are followed.
      if (structure_.is_extra(below) || structure_.is_extra(coface)) offer_cell(coface);
    });
  };
  offer_cofaces(cell);
  structure_.for_each_coface(cell, [&](Cell coface) {
    if (structure_.is_extra(cell) || structure_.is_extra(coface)) offer_cofaces(coface);
  });
}

std::optional<Stop> Witnesses::home_of(Cell cell) const {
  if (!structure_.is_extra(cell)) return deepest_voxel(cell);
  std::optional<Stop> best;
  for_each_witness(cell, [&](const Stop& stop) {
    if (!best || stop.nearest.distance > best->nearest.distance) best = stop;
  });
  return best;
}

std::vector<Stop> Witnesses::landmarks_of(Cell vertex) const {
  std::vector<Stop> stops;
  if (!structure_.is_extra(vertex)) {
    for_each_voxel_inside(governors_, structure_.lattice(), vertex, [&](const std::array<std::int64_t, 3>& at) {
      const Governor g = governors_.at(at[0], at[1], at[2]);
      if (const auto stop = paths_.stop_at(g.centre, g.foot)) stops.push_back(*stop);
    });
  }
  for_each_witness(vertex, [&](const Stop& stop) {
    const auto is_known = [&](const Stop& other) { return other.at == stop.at; };
    if (std::none_of(stops.begin(), stops.end(), is_known)) stops.push_back(stop);
  });
  std::sort(stops.begin(), stops.end(), is_deeper);
  return stops;
}

}  // namespace blum::detail
