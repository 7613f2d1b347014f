// Example: centrelines of the labels of a voxel image, as branches with lengths and radii, with a check of homotopy.
#include <iostream>

#include "blum/core/error.hpp"
#include "blum/grid/image_generators.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/image_io.hpp"
#include "blum/medial_axis/centreline.hpp"

int main(int argc, char** argv) try {
  // Reads an image, or makes tubes of radius 4 along the twelve edges of a cube of side 20.
  const blum::VoxelImage image =
      argc > 1 ? blum::read_image(argv[1]) : blum::make_tube_image({.nodes = 2, .pitch = 20, .radius = 4});

  // Each label of the image gets its own centreline.
  const blum::Centrelines lines = blum::centreline(image);
  bool is_kept = true;
  for (const blum::Centreline& line : lines.labels) {
    std::cout << "label " << line.label.value_or(0) << ": " << line.voxels << " voxels, " << line.nodes.size()
              << " nodes, " << line.branches.size() << " branches\n";

    double length = 0;
    for (const blum::CentrelineBranch& branch : line.branches) {
      std::cout << "  from node " << branch.nodes[0] << " to " << branch.nodes[1] << ": length " << branch.length
                << ", mean radius " << branch.mean_radius << ", smallest " << branch.min_radius << '\n';
      length += branch.length;
    }
    std::cout << "  total length " << length << '\n';

    // The frame of a cube has 12 - 8 + 1 = 5 tunnels, and the centreline keeps them.
    std::cout << "  " << line.graph_betti[0] << " component, " << line.graph_betti[1] << " tunnels; " << line.homotopy
              << '\n';
    is_kept = is_kept && line.homotopy_kept;
  }

  // Writes all branches as edges with columns, for example for ParaView.
  blum::write_complex("centreline.vtp", blum::complex_of(lines));
  std::cout << "wrote centreline.vtp\n";
  return is_kept ? 0 : 1;
} catch (const blum::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
