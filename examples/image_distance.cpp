// Example: exact distance transforms of a labelled voxel image with unequal spacing.
#include <algorithm>
#include <iostream>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/grid/image_generators.hpp"
#include "blum/io/field_io.hpp"
#include "blum/io/image_io.hpp"

int main(int argc, char** argv) try {
  // Reads an image, of which labels 1 to 3 are used, or makes a network of tubes with slices twice as thick as wide.
  const blum::VoxelImage image =
      argc > 1 ? blum::read_image(argv[1]) : blum::make_tube_image({.spacing = {0.5, 0.5, 1}, .labelled = true});

  // All labels in one call; each result is what distance_transform() gives for that label alone.
  std::vector<blum::LabelSelection> labels;
  for (int label = 1; label <= 3; ++label) labels.push_back(blum::LabelSelection::of_label(label));
  const std::vector<blum::Field> fields = blum::distance_transforms(image, labels);

  for (std::size_t k = 0; k < fields.size(); ++k) {
    const float depth = -*std::min_element(fields[k].distance.begin(), fields[k].distance.end());
    const float height = *std::max_element(fields[k].distance.begin(), fields[k].distance.end());
    std::cout << "label " << k + 1 << ": largest depth inside " << depth << ", largest distance outside " << height
              << '\n';
  }

  // The site of a voxel is the closest voxel of the other kind, as a linear index.
  const blum::Field& field = fields.front();
  const auto deepest =
      static_cast<std::size_t>(std::min_element(field.distance.begin(), field.distance.end()) - field.distance.begin());
  std::cout << "deepest voxel of label 1: " << deepest << ", its closest voxel outside: " << field.site[deepest].value
            << '\n';
  blum::write_field("label1.nrrd", field);
  std::cout << "wrote label1.nrrd and label1.site.nrrd\n";
  return 0;
} catch (const blum::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
