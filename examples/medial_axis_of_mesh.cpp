// Example: the medial axis of a mesh at several angles, its certificate, and how to keep it.
#include <cmath>
#include <cstddef>
#include <iostream>

#include "blum/core/error.hpp"
#include "blum/geometry/shape_catalog.hpp"
#include "blum/io/medial_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/medial_axis/certificate.hpp"
#include "blum/medial_axis/medial_axis.hpp"

int main(int argc, char** argv) try {
  // A mesh from a file, or a bracket that Blum makes.
  const blum::TriangleMesh mesh = argc > 1 ? blum::read_mesh(argv[1]) : blum::make_shape("bracket");

  // One computation for all angles.
  blum::MedialAxisOptions options;
  options.resolution = 96;  // voxels along the longest side
  const blum::MedialAxis axis = blum::medial_axis(mesh, options);
  const blum::MedialAxisReport& report = axis.report();
  std::cout << "solid: " << to_string(report.rule) << ", " << report.reason << '\n';
  if (!report.is_right) std::cout << "something is thinner than a voxel: raise the resolution\n";

  // Axes at rising angles are parts of each other.
  for (const double theta : {20.0, 60.0, 120.0}) {
    const blum::MedialCounts counts = count(axis.extract(theta));
    std::cout << "theta " << theta << ": " << counts.triangles << " triangles in " << counts.sheets << " sheets, "
              << counts.curve_edges << " edges of curves\n";
  }

  const blum::MedialComplex complex = axis.extract(60);

  // Radii and footprints: how thick the solid is where the ball is the largest.
  std::size_t widest = 0;
  for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
    if (complex.vertices[v].radius > complex.vertices[widest].radius) widest = v;
  }
  const blum::MedialVertex& vertex = complex.vertices[widest];
  std::cout << "largest ball: radius " << vertex.radius << ", walls seen " << std::round(vertex.separation_angle)
            << " degrees apart, the closest at site " << vertex.sites[0].value << '\n';

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
