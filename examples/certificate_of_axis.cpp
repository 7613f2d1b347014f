// Example: the certificate of a medial axis, and the reasons for rejecting a broken axis.
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
    std::cout << "  body with " << body.solid[1] << " tunnels and " << body.solid[2] << " voids; its axis has "
              << body.axis[1] << " and " << body.axis[2] << ": " << blum::to_string(body.proven) << '\n';
  }
  for (const auto& mismatch : certificate.mismatches) std::cout << "  " << mismatch << '\n';
}

}  // namespace

int main(int argc, char** argv) try {
  // Reads a closed mesh, or makes a torus, which is a solid with one tunnel.
  const blum::TriangleMesh mesh = argc > 1 ? blum::read_mesh(argv[1]) : blum::make_torus();
  const blum::Complex axis = blum::medial_axis(mesh, {.resolution = 64}).simplify(90);

  // Checks topology, radii, footprints and positions against the mesh. The checking code takes no part in the
  // construction.
  const blum::Certificate certificate = blum::certify(axis, mesh);
  show("the axis", certificate);
  std::cout << "  largest error of a radius: " << certificate.geometry.radius_error << '\n';

  // With only half of the triangles, the certificate is refused and states the reasons. The tunnel is lost, and each
  // isolated vertex is a component.
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
