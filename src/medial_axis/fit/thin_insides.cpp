#include "medial_axis/fit/thin_insides.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "blum/axis/sheet_decimator.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/core/parallel.hpp"
#include "medial_axis/fit/bend.hpp"
#include "medial_axis/fit/kind.hpp"

namespace blum::detail {
namespace {

/// How far sheets may move, one level after the other: parts of the tolerance.
constexpr std::array levels{1.0 / 256, 1.0 / 16};
/// So many edges from what fitting may move, vertices stay; edges up to this length, in voxels, do not count.
constexpr int rings = 3;
constexpr double no_step = 0.3;
/// What fitting may move, apart from borders: where a sheet bends by more than 18 degrees, where so many degrees more
/// than theta are not seen, and where the radius is below this part of a voxel, unless between parallel walls.
constexpr double least_cosine = 0.95;
constexpr double nearly_theta = 10;
constexpr double least_radius = 0.05;
constexpr double parallel = 170;

class InsideThinner {
 public:
  InsideThinner(AxisLists& lists, const Incidence& incidence, const FitTarget& target, const Context& context)
      : lists_(lists), incidence_(incidence), target_(target), context_(context) {}

  double run() {
    SheetDecimator decimator(input(), target_.tolerance, context_);
    decimator.run(levels);
    lists_.triangle_angles.assign(decimator.triangle_angle().begin(), decimator.triangle_angle().end());
    keep(decimator.cells(), lists_);
    return decimator.moved();
  }

 private:
  [[nodiscard]] DecimatorInput input() const {
    DecimatorInput input{
        .triangles = lists_.triangles, .triangle_angle = lists_.triangle_angles, .borders = lists_.edges};
    input.points.reserve(lists_.vertices.size());
    for (const AxisVertex& vertex : lists_.vertices) input.points.push_back({vertex.position, vertex.radius});
    for (std::size_t e = 0; e < incidence_.edges().size(); ++e) {
      const std::size_t triangles = incidence_.triangles_of_edge()[e].size();
      if (triangles != 0 && triangles != 2) input.borders.push_back(incidence_.edges()[e]);  // the others are listed
    }
    input.border_kind.assign(input.borders.size(), 0);
    input.stays = next_to(movable());
    return input;
  }

  /// What fitting may move.
  [[nodiscard]] std::vector<std::uint8_t> movable() const {
    constexpr std::size_t grain = 1024;
    const std::vector<Kind> kinds = kinds_of(incidence_, lists_.vertices.size());
    std::vector<std::uint8_t> out(kinds.size(), 0);
    parallel_for(context_, out.size(), grain, "borders", [&](const WorkRange& range) {
      for (std::size_t v = range.begin; v < range.end; ++v) {
        const AxisVertex& vertex = lists_.vertices[v];
        const double angle = vertex.separation_angle;
        const bool is_inside = kinds[v].rims + kinds[v].seams + kinds[v].curves == 0 && kinds[v].inner > 0;
        const bool is_shown = angle > target_.theta + nearly_theta &&
                              (vertex.radius >= least_radius * target_.voxel || angle >= parallel);
        const auto flatness = [&] {
          return least_cosine_at(lists_, incidence_, static_cast<std::uint32_t>(v), vertex.position);
        };
        // Between such walls nothing goes far, however these bend.
        const bool is_thin = vertex.radius < least_radius * target_.voxel;
        out[v] = is_inside && is_shown && (is_thin || flatness() >= least_cosine) ? 0 : 1;
      }
    });
    return out;
  }
  /// Some vertices and all next to them. Short edges are gone over first, so that each vertex is reached by the fewest
  /// steps.
  [[nodiscard]] std::vector<std::uint8_t> next_to(std::vector<std::uint8_t> chosen) const {
    const double shortest = no_step * target_.voxel;
    std::vector<std::uint8_t> steps(chosen.size(), rings + 1);
    std::deque<std::pair<std::uint32_t, std::uint8_t>> next;
    const auto reach = [&](std::uint32_t v, std::uint8_t step, bool is_first) {
      if (step >= steps[v]) return;
      steps[v] = step;
      if (is_first) {
        next.emplace_front(v, step);
      } else {
        next.emplace_back(v, step);
      }
    };
    for (std::uint32_t v = 0; v < chosen.size(); ++v) {
      if (chosen[v] != 0) reach(v, 0, false);
    }
    while (!next.empty()) {
      const auto [v, step] = next.front();
      next.pop_front();
      if (step > steps[v]) continue;
      chosen[v] = 1;
      for (const std::uint32_t e : incidence_.edges_of_vertex()[v]) {
        const std::uint32_t other = other_end(incidence_.edges()[e], v);
        const Vec3d way = lists_.vertices[other].position - lists_.vertices[v].position;
        const bool is_short = squared_length(way) <= shortest * shortest;
        reach(other, static_cast<std::uint8_t>(step + (is_short ? 0 : 1)), is_short);
      }
    }
    return chosen;
  }

  AxisLists& lists_;
  const Incidence& incidence_;
  const FitTarget& target_;
  const Context& context_;
};

}  // namespace

double thin_insides(AxisLists& lists, const Incidence& incidence, const FitTarget& target, const Context& context) {
  return InsideThinner(lists, incidence, target, context).run();
}

}  // namespace blum::detail
