#include "solid/model/surface_mesh.hpp"

#include <algorithm>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"

namespace blum::detail {
namespace {

/// In a mesh scaled to size 1/2 to 1, predicates are exact for coordinates that are 0 or have at least this magnitude.
constexpr double least_coordinate = 1e-45;

}  // namespace

int scale_of(const Box3& box) {
  double largest = 0;
  for (std::size_t a = 0; a < 3; ++a) largest = std::max({largest, std::abs(box.lower[a]), std::abs(box.upper[a])});
  int exponent = 0;
  std::frexp(largest, &exponent);
  return -exponent;
}

TriangleMesh scaled(TriangleMesh mesh, int exponent) {
  for (Vec3d& v : mesh.vertices) {
    const Vec3d given = v;
    v = scaled(v, exponent);
    for (std::size_t a = 0; a < 3; ++a) {
      if (given[a] == 0 || std::abs(v[a]) >= least_coordinate) continue;
      throw InvalidMesh("a vertex has the coordinate " + exact_text(given[a]) +
                        ", which is too small next to the other coordinates for exact results: round it to 0");
    }
  }
  return mesh;
}

}  // namespace blum::detail
