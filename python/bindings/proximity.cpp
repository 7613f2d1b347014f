#include <nanobind/stl/optional.h>

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "blum/proximity/continuous_collisions.hpp"
#include "blum/proximity/first_contact.hpp"
#include "call.hpp"
#include "columns.hpp"
#include "contacts.hpp"
#include "structs.hpp"

namespace blum::python {
namespace {

using FourIn = In<double, nb::shape<-1, 4, 3>>;

/// Row of four vertices.
using Four = std::array<std::int32_t, 4>;

Four four(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  return {static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), static_cast<std::int32_t>(c),
          static_cast<std::int32_t>(d)};
}

std::vector<FourMovingPoints> moving_points(const FourIn& start, const FourIn& end) {
  const auto first = rows<std::array<Vec3d, 4>>(start);
  const auto last = rows<std::array<Vec3d, 4>>(end);
  std::vector<FourMovingPoints> points(first.size());
  for (std::size_t k = 0; k < points.size(); ++k) points[k] = {first[k], last[k]};
  return points;
}

/// Returns the times of impacts, NaN if there is no impact.
Out<double> times_of(const std::vector<std::optional<double>>& impacts) {
  std::vector<double> times;
  times.reserve(impacts.size());
  for (const std::optional<double>& time : impacts) times.push_back(time.value_or(std::nan("")));
  return handed_over<double>(std::move(times));
}

/// Returns (vertex_face, face, vertex_face_time, edge_edge, edge_edge_time, box_pairs, exact_tests).
nb::tuple columns_of(ContinuousCollisions found, const MeshView& mesh) {
  std::vector<Four> vertex_face;
  for (const VertexFaceCollision& one : found.vertex_face) {
    const auto& [a, b, c] = mesh.triangles[one.face.value];
    vertex_face.push_back(four(one.vertex, a, b, c));
  }
  std::vector<Four> edge_edge;
  for (const EdgeEdgeCollision& one : found.edge_edge) {
    edge_edge.push_back(four(one.first[0], one.first[1], one.second[0], one.second[1]));
  }
  const Held<VertexFaceCollision> faces = held(std::move(found.vertex_face));
  const Held<EdgeEdgeCollision> edges = held(std::move(found.edge_edge));
  return nb::make_tuple(handed_over<std::int32_t>(std::move(vertex_face), 4),
                        column(*faces.entries, &VertexFaceCollision::face, faces.owner),
                        column(*faces.entries, &VertexFaceCollision::time, faces.owner),
                        handed_over<std::int32_t>(std::move(edge_edge), 4),
                        column(*edges.entries, &EdgeEdgeCollision::time, edges.owner), found.box_pairs,
                        found.exact_tests);
}

template <class Impacts>
void bind_impacts(nb::module_& m, const char* name, const Impacts& impacts) {
  m.def(
      name,
      [impacts](const FourIn& start, const FourIn& end, const nb::dict& given, int threads, nb::object progress) {
        const auto options = options_from<ImpactOptions>(given);
        const std::vector<FourMovingPoints> points = moving_points(start, end);
        return times_of(run({threads, std::move(progress)},
                            [&](const Context& context) { return impacts(points, options, context); }));
      },
      nb::arg("start").noconvert(), nb::arg("end").noconvert(), nb::arg("options"), nb::arg("threads"),
      nb::arg("progress").none());
}

}  // namespace

void bind_proximity(nb::module_& m) {
  bind_options<ImpactOptions>(m);
  m.def(
      "continuous_collisions",
      [](const MeshArrays& mesh, const PointsIn& end, const nb::dict& given, int threads, nb::object progress) {
        const MeshView view = mesh.view();
        const auto options = options_from<ImpactOptions>(given);
        return columns_of(
            run({threads, std::move(progress)},
                [&](const Context& context) { return continuous_collisions(view, vectors(end), options, context); }),
            view);
      },
      nb::arg("mesh"), nb::arg("end").noconvert(), nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  m.def("start_warnings", [](std::size_t pairs) { return result_of(start_warnings(pairs)); }, nb::arg("pairs"));
  m.def(
      "first_contact",
      [](const MeshArrays& mesh, const PointsIn& end, const MeshArrays* other, const std::optional<PointsIn>& other_end,
         const nb::dict& given, int threads, nb::object progress) {
        const auto options = options_from<ImpactOptions>(given);
        return contact_out(run({threads, std::move(progress)}, [&](const Context& context) {
          if (other == nullptr) return first_contact(mesh.view(), vectors(end), options, context);
          const std::span<const Vec3d> last = other_end ? vectors(*other_end) : other->view().vertices;
          return first_contact(mesh.view(), vectors(end), other->view(), last, options, context);
        }));
      },
      nb::arg("mesh"), nb::arg("end").noconvert(), nb::arg("other").none(), nb::arg("other_end").none(),
      nb::arg("options"), nb::arg("threads"), nb::arg("progress").none());
  bind_impacts(m, "vertex_face_impacts",
               [](std::span<const FourMovingPoints> points, const ImpactOptions& options, const Context& context) {
                 return vertex_face_impacts(points, options, context);
               });
  bind_impacts(m, "edge_edge_impacts",
               [](std::span<const FourMovingPoints> points, const ImpactOptions& options, const Context& context) {
                 return edge_edge_impacts(points, options, context);
               });
}

}  // namespace blum::python
