// Example: the medial axis of a mesh at several angles, its certificate, and how to write it.
#include <cmath>
#include <cstddef>
#include <iostream>

#include "blum/certificate/certificate.hpp"
#include "blum/core/error.hpp"
#include "blum/io/medial_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/shape_catalog.hpp"

int main(int argc, char** argv) try {
  // Reads a mesh, or makes a bracket.
  const blum::TriangleMesh mesh = argc > 1 ? blum::read_mesh(argv[1]) : blum::make_shape("bracket");

  // One computation for all angles.
  blum::MedialAxisOptions options;
  options.resolution = 96;  // voxels along the longest side
  const blum::MedialAxis axis = blum::medial_axis(mesh, options);
  const blum::MedialAxisReport& report = axis.report();
  std::cout << "solid: " << to_string(report.rule) << ", " << report.reason << '\n';
  if (!report.topology_matches) std::cout << "the model lacks the solid's topology; the certificate states why\n";

  // The axis of a larger angle is a part of each axis of a smaller angle.
  for (const double theta : {20.0, 60.0, 120.0}) {
    const blum::MedialCounts counts = count(axis.simplify(theta));
    std::cout << "theta " << theta << ": " << counts.triangles << " triangles in " << counts.sheets << " sheets, "
              << counts.curve_edges << " line segments on curves\n";
  }

  const blum::Complex complex = axis.simplify(60);

  // The largest ball shows the thickness of the solid: its radius, and the angle between its footprints.
  const blum::MedialView view(complex);  // its columns
  std::size_t widest = 0;
  for (std::size_t v = 0; v < view.radius.size(); ++v) {
    if (view.radius[v] > view.radius[widest]) widest = v;
  }
  std::cout << "largest ball: radius " << view.radius[widest] << ", separation angle "
            << std::round(view.separation_angle[widest]) << " degrees, closest site " << view.site(widest, 0).value
            << '\n';

  // Checks the axis against the mesh, with code that takes no part in the construction.
  if (report.rule == blum::SolidRule::polyhedron) {
    const blum::Certificate certificate = blum::certify(complex, mesh);
    for (const auto& mismatch : certificate.mismatches) std::cout << "NOT certified: " << mismatch << '\n';
    if (!certificate.holds()) return 1;
    std::cout << "certified: " << certificate.axis[0] << " component, " << certificate.axis[1] << " tunnels, "
              << certificate.axis[2] << " voids\n";
  }

  blum::MedialMetadata metadata;
  metadata.source = "medial_axis_of_mesh";
  metadata.theta = 60;
  metadata.solid_rule = to_string(report.rule);
  metadata.grid = report.grid;  // `blum verify` needs the grid if the solid is known only as voxels
  blum::write_medial("medial.vtp", complex, metadata);
  std::cout << "wrote medial.vtp\n";
  return 0;
} catch (const blum::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
