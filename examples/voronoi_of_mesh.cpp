// Example: the certified Voronoi diagram inside a closed mesh, its regions, and its medial axis.
#include <iostream>
#include <vector>

#include "blum/axis/collapse_axis.hpp"
#include "blum/core/error.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "blum/voronoi/voronoi_regions.hpp"
#include "blum/voronoi/voronoi_sites.hpp"

int main(int argc, char** argv) try {
  // Reads a mesh, or makes a box of 1 x 2 x 3, whose volume is 6.
  const blum::TriangleMesh mesh = argc > 1 ? blum::read_mesh(argv[1]) : blum::make_box({.size = {1, 2, 3}});

  // The complex holds the surface, and the walls between regions of faces, reflex edges and reflex vertices.
  const blum::VoronoiComplex diagram = blum::voronoi_complex(mesh);
  const blum::VoronoiReport& report = diagram.report;
  std::cout << report.faces << " faces, " << report.reflex_edges << " reflex edges, " << report.reflex_vertices
            << " reflex vertices\n";
  if (!report.certified) {
    std::cout << "not certified: " << report.failing.size() << " cubes fail the local test\n";
    return 1;
  }
  std::cout << "certified: components, tunnels, voids " << report.found[0] << ' ' << report.found[1] << ' '
            << report.found[2] << "; "
            << (report.traced ? "chords of curved walls are within " : "distance from the exact diagram at most ")
            << (report.traced ? report.chord : report.hausdorff_bound) << '\n';

  // A region contains the points that are closest to one site. voronoi_sites() lists the sites by number.
  const std::vector<blum::VoronoiSite> sites = blum::voronoi_sites(mesh, report);
  double volume = 0;
  for (const blum::VoronoiRegion& region : blum::voronoi_regions(diagram.complex)) {
    const auto site = static_cast<std::size_t>(region.site);
    std::cout << "region of " << blum::to_string(sites[site].kind) << ' ' << site << ": volume " << region.volume
              << ", surface " << region.surface_area << ", " << region.neighbours.size() << " neighbours\n";
    volume += region.volume;
  }
  std::cout << "volume of all regions: " << volume << '\n';

  // The medial axis consists of the walls with two footprints. Theta 120 removes parts with smaller separation angles.
  // In a box, all walls except the middle sheet have 90 degrees.
  const blum::VoronoiComplex walls = blum::voronoi_complex(mesh, {.part = blum::VoronoiPart::medial_axis});
  const blum::Complex axis = blum::collapse_axis(walls.complex, 120);
  std::cout << "medial axis: " << walls.complex.triangles.size() << " triangles, " << axis.triangles.size()
            << " at theta 120\n";
  blum::write_complex("axis.vtp", axis);
  std::cout << "wrote axis.vtp\n";
  return 0;
} catch (const blum::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
