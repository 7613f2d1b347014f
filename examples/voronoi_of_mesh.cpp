// Example: the Voronoi diagram inside a closed mesh: its regions, whether it is certified, and a medial axis of it.
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
  // A mesh from a file, or a box of 1 x 2 x 3, whose volume is 6.
  const blum::TriangleMesh mesh = argc > 1 ? blum::read_mesh(argv[1]) : blum::make_box({.size = {1, 2, 3}});

  // Walls between the regions of faces, reflex edges and reflex vertices, and the surface, as one complex.
  const blum::VoronoiComplex diagram = blum::voronoi_complex(mesh);
  const blum::VoronoiReport& report = diagram.report;
  std::cout << report.faces << " faces, " << report.reflex_edges << " reflex edges, " << report.reflex_vertices
            << " reflex vertices\n";
  if (!report.certified) {
    std::cout << "not certified: " << report.failing.size() << " cubes do not pass\n";
    return 1;
  }
  std::cout << "certified: components, tunnels, voids " << report.found[0] << ' ' << report.found[1] << ' '
            << report.found[2] << "; within " << report.hausdorff_bound << " of the exact walls\n";

  // What is closest to each site. Sites are numbered as voronoi_sites() lists them.
  const std::vector<blum::VoronoiSite> sites = blum::voronoi_sites(mesh);
  double volume = 0;
  for (const blum::VoronoiRegion& region : blum::voronoi_regions(diagram.complex)) {
    const auto site = static_cast<std::size_t>(region.site);
    std::cout << "region of " << blum::to_string(sites[site].kind) << ' ' << site << ": volume " << region.volume
              << ", surface " << region.surface_area << ", " << region.neighbours.size() << " neighbours\n";
    volume += region.volume;
  }
  std::cout << "all regions together: volume " << volume << '\n';

  // Of the walls, those with two footprints; and of these what is seen at more than 120 degrees: of a box, where all
  // but the middle sheet has 90.
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
