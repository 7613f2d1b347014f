// Example: the certificate of a medial axis: what was checked, what it shows, and what it says of an axis that is
// wrong.
#include <iostream>

#include "blum/certificate/certificate.hpp"
#include "blum/complex/complex.hpp"
#include "blum/core/error.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/generators.hpp"

namespace {

void show(const char* what, const blum::Certificate& certificate) {
  std::cout << what << ": " << (certificate.holds() ? "holds" : "does NOT hold") << '\n';
  for (const blum::BodyCheck& body : certificate.bodies) {
    std::cout << "  a body with " << body.solid[1] << " tunnels and " << body.solid[2] << " voids; the axis in it has "
              << body.axis[1] << " and " << body.axis[2] << ": " << blum::to_string(body.proven) << '\n';
  }
  for (const auto& mismatch : certificate.mismatches) std::cout << "  " << mismatch << '\n';
}

}  // namespace

int main(int argc, char** argv) try {
  // A closed mesh from a file, or a ring: a solid with one tunnel.
  const blum::TriangleMesh mesh = argc > 1 ? blum::read_mesh(argv[1]) : blum::make_torus();
  const blum::Complex axis = blum::medial_axis(mesh, {.resolution = 64}).simplify(90);

  // Topology, radii, footprints and places of the axis, against the mesh, by code that has no part in making it.
  const blum::Certificate certificate = blum::certify(axis, mesh);
  show("the axis", certificate);
  std::cout << "  radii are off by at most " << certificate.geometry.radius_error << '\n';

  // Half of the triangles alone is caught, and the certificate says why: the tunnel is gone, and vertices of no
  // triangle are components by themselves.
  blum::Complex half;
  half.positions = axis.positions;
  half.triangles = axis.triangles;
  half.triangles.resize(half.triangles.size() / 2);
  const blum::Certificate refusal = blum::certify_topology(half, mesh);
  show("half of it", refusal);
  return certificate.holds() && !refusal.holds() ? 0 : 1;
} catch (const blum::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
