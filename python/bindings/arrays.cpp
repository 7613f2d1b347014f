#include "arrays.hpp"

#include <utility>

namespace blum::python {

template Out<double> handed_over<double>(std::vector<double>, std::size_t);
template Out<double> handed_over<double>(std::vector<Vec3d>, std::size_t);
template Out<std::int32_t> handed_over<std::int32_t>(std::vector<std::int32_t>, std::size_t);
template Out<std::int32_t> handed_over<std::int32_t>(std::vector<std::uint32_t>, std::size_t);
template Out<std::int32_t> handed_over<std::int32_t>(std::vector<Segment>, std::size_t);
template Out<std::int32_t> handed_over<std::int32_t>(std::vector<Triangle>, std::size_t);
template Out<std::uint32_t> handed_over<std::uint32_t>(std::vector<std::uint32_t>, std::size_t);

nb::tuple arrays_of(TriangleMesh mesh) {
  return nb::make_tuple(
      handed_over<double>(std::move(mesh.vertices), 3), handed_over<std::int32_t>(std::move(mesh.triangles), 3),
      handed_over<std::int32_t>(std::move(mesh.segments), 2), handed_over<std::int32_t>(std::move(mesh.points)));
}

}  // namespace blum::python
