#include "certificate/homology/complement.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "blum/complex/incidence.hpp"
#include "certificate/homology/generating_cycles.hpp"

namespace blum::verifier {
namespace {

/// Returns the triangles of shells with handles.
std::vector<std::array<std::uint32_t, 3>> triangles_with_handles(const MeshView& mesh, const ClosedShells& shells) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t shell = shells.of_triangle[t];
    if (shell == no_group || shells.shells[shell].genus == 0) continue;
    triangles.push_back({mesh.triangles[t][0], mesh.triangles[t][1], mesh.triangles[t][2]});
  }
  return triangles;
}

/// Returns the body of the shell at each vertex.
std::vector<std::uint32_t> bodies_of_vertices(const MeshView& mesh, const ClosedShells& shells) {
  std::vector<std::uint32_t> body_of_vertex(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t shell = shells.of_triangle[t];
    if (shell == no_group) continue;
    for (const std::uint32_t v : mesh.triangles[t]) body_of_vertex[v] = shells.shells[shell].body;
  }
  return body_of_vertex;
}

}  // namespace

Complement::Complement(std::vector<Vec3d> points, std::vector<Step> steps,
                       const std::vector<std::uint32_t>& body_of_path, std::vector<Void> voids)
    : points_(std::move(points)), path_count_(body_of_path.size()), voids_(std::move(voids)) {
  for (Step& step : steps) {
    if (step.ends[0] < step.ends[1]) continue;
    std::swap(step.ends[0], step.ends[1]);
    step.times = -step.times;
  }
  std::sort(steps.begin(), steps.end(),
            [](const Step& a, const Step& b) { return std::tie(a.ends, a.path) < std::tie(b.ends, b.path); });
  for (std::size_t k = 0; k < steps.size();) {
    const Step& step = steps[k];
    std::int32_t times = 0;
    for (; k < steps.size() && steps[k].ends == step.ends && steps[k].path == step.path; ++k) times += steps[k].times;
    if (times == 0) continue;
    if (segments_.empty() || segments_.back().ends != step.ends) {
      segments_.push_back({step.ends, body_of_path[step.path]});
      first_.push_back(uses_.size());
    }
    uses_.push_back({step.path, times});
    first_.back() = uses_.size();
  }
}

Complement complement_of_mesh(const MeshView& mesh, const ClosedShells& shells,
                              const std::function<std::vector<Vec3d>(std::uint32_t)>& points_of_void,
                              const Context& context) {
  std::vector<Complement::Void> voids;
  for (std::uint32_t s = 0; s < shells.shells.size(); ++s) {
    const ClosedShell& shell = shells.shells[s];
    if (shell.depth % 2 == 1) voids.push_back({points_of_void(s), shell.body});
  }
  const auto triangles = triangles_with_handles(mesh, shells);
  if (triangles.empty()) return {{}, {}, {}, std::move(voids)};
  const Incidence incidence({mesh.vertices.size(), {}, triangles}, context);
  const GeneratingCycles cycles(
      {mesh.vertices.size(), incidence.edges(), {incidence.sides().front().data(), 3 * incidence.sides().size()}, 3},
      context);
  const std::vector<std::uint32_t> body_of_vertex = bodies_of_vertices(mesh, shells);
  std::vector<Complement::Step> steps;
  std::vector<std::uint32_t> body_of_path;
  for (const std::uint32_t closing : cycles.closing()) {
    const auto path = static_cast<std::uint32_t>(body_of_path.size());
    body_of_path.push_back(body_of_vertex[incidence.edges()[closing][0]]);
    cycles.walk(closing, [&](std::uint32_t e, int sign) { steps.push_back({incidence.edges()[e], path, sign}); });
  }
  return {{mesh.vertices.begin(), mesh.vertices.end()}, std::move(steps), body_of_path, std::move(voids)};
}

}  // namespace blum::verifier
