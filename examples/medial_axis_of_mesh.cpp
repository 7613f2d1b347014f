// Example: the medial axis of a mesh at several angles, its certificate, and how to keep it.
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
  // A mesh from a file, or a bracket that Blum makes.
  const blum::TriangleMesh mesh = argc > 1 ? blum::read_mesh(argv[1]) : blum::make_shape("bracket");

  // One computation for all angles.
  blum::MedialAxisOptions options;
  options.resolution = 96;  // voxels along the longest side
  const blum::MedialAxis axis = blum::medial_axis(mesh, options);
  const blum::MedialAxisReport& report = axis.report();
  std::cout << "solid: " << to_string(report.rule) << ", " << report.reason << '\n';
  if (!report.topology_matches) std::cout << "something is thinner than a voxel: raise the resolution\n";

  // Axes at rising angles are parts of each other.
  for (const double theta : {20.0, 60.0, 120.0}) {
    const blum::MedialCounts counts = count(axis.simplify(theta));
    std::cout << "theta " << theta << ": " << counts.triangles << " triangles in " << counts.sheets << " sheets, "
              << counts.curve_edges << " edges of curves\n";
  }

  const blum::Complex complex = axis.simplify(60);

  // Radii and footprints: how thick the solid is where the ball is the largest.
  const blum::MedialView view(complex);  // its columns
  std::size_t widest = 0;
  for (std::size_t v = 0; v < view.radius.size(); ++v) {
    if (view.radius[v] > view.radius[widest]) widest = v;
  }
  std::cout << "largest ball: radius " << view.radius[widest] << ", walls seen "
            << std::round(view.separation_angle[widest]) << " degrees apart, the closest at site "
            << view.site(widest, 0).value << '\n';

  // Checked against the mesh, by code that shares nothing with the construction.
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
  metadata.grid = report.grid;  // for `blum verify`, where the solid is known as voxels only
  blum::write_medial("medial.vtp", complex, metadata);
  std::cout << "wrote medial.vtp\n";
  return 0;
} catch (const blum::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
