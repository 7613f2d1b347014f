#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/grid/image_generators.hpp"

namespace blum {
namespace {

using Betti = std::optional<std::array<std::int64_t, 3>>;

Parameter count_parameter(std::string name, std::string description, int value, int minimum, int maximum) {
  return {std::move(name),
          std::move(description),
          static_cast<double>(value),
          static_cast<double>(minimum),
          static_cast<double>(maximum),
          true};
}

/// Returns the given parameters of a shape, followed by those of the grid.
std::vector<Parameter> with_spacing(std::vector<Parameter> parameters) {
  for (const char* axis : {"x", "y", "z"}) {
    parameters.push_back({std::string("spacing_") + axis,
                          std::string("distance of neighbouring voxels along ") + axis + ", in world units", 1, 1e-6,
                          1e6, false});
  }
  return parameters;
}

Vec3d spacing(const ParameterValues& p) {
  return {p.at("spacing_x"), p.at("spacing_y"), p.at("spacing_z")};
}
int whole(const ParameterValues& p, const char* name) {
  return static_cast<int>(p.at(name));
}

ImageInfo ball() {
  return {"ball_image", "a ball, or a hollow ball, in the middle of a cubic image",
          with_spacing({count_parameter("size", "voxels along each side", 64, 8, 1024),
                        {"radius", "radius of the ball, as a fraction of half the shortest side", 0.7, 0.3, 0.9, false},
                        {"inner_radius", "radius of a void, as a fraction of the radius; 0: none", 0, 0, 0.7, false}}),
          [](const ParameterValues& p) {
            return make_ball_image({whole(p, "size"), spacing(p), p.at("radius"), p.at("inner_radius")});
          },
          [](const ParameterValues& p) -> Betti { return {{1, 0, p.at("inner_radius") > 0 ? 1 : 0}}; }};
}

ImageInfo tubes() {
  return {"tube_image", "a network of tubes along the lines of a cubic lattice",
          with_spacing({count_parameter("nodes", "nodes along each axis", 3, 1, 50),
                        count_parameter("pitch", "voxels from node to node", 20, 6, 500),
                        {"radius", "radius of the tubes, in voxels, at most pitch / 2 - 2", 4, 1, 248, false},
                        count_parameter("labelled", "1: tubes along x, y, z have labels 1, 2, 3; 0: all have label 1",
                                        0, 0, 1)}),
          [](const ParameterValues& p) {
            return make_tube_image(
                {whole(p, "nodes"), whole(p, "pitch"), p.at("radius"), spacing(p), whole(p, "labelled") == 1});
          },
          [](const ParameterValues& p) -> Betti {
            const std::int64_t n = whole(p, "nodes");  // the shape is a graph of n^3 nodes and 3 n^2 (n - 1) edges
            return {{1, 3 * n * n * (n - 1) - n * n * n + 1, 0}};
          }};
}

ImageInfo balls() {
  return {"balls_image", "balls on a lattice, each with its own label",
          with_spacing({count_parameter("count", "number of balls", 8, 1, 65535),
                        count_parameter("pitch", "voxels between centres", 16, 6, 500),
                        {"radius", "radius of each ball, in voxels, at most pitch / 2 - 1", 5.5, 1, 249, false}}),
          [](const ParameterValues& p) {
            return make_balls_image({whole(p, "count"), whole(p, "pitch"), p.at("radius"), spacing(p)});
          },
          [](const ParameterValues& p) -> Betti { return {{whole(p, "count"), 0, 0}}; }};
}

ImageInfo noise() {
  return {"noise_image", "random voxels",
          with_spacing({count_parameter("size", "voxels along each side", 64, 1, 1024),
                        {"density", "fraction of voxels that are set", 0.01, 0, 1, false},
                        {"seed", "seed of the random numbers", 1, 0, 4294967295.0, true}}),
          [](const ParameterValues& p) {
            return make_noise_image(
                {whole(p, "size"), p.at("density"), spacing(p), static_cast<std::uint64_t>(p.at("seed"))});
          },
          [](const ParameterValues&) -> Betti { return std::nullopt; }};
}

}  // namespace

const std::vector<ImageInfo>& image_catalog() {
  static const std::vector<ImageInfo> catalog = {ball(), balls(), noise(), tubes()};
  return catalog;
}

const ImageInfo& find_image(std::string_view name) {
  std::string message = "there is no image '" + std::string(name) + "'; known images:";
  for (const ImageInfo& image : image_catalog()) {
    if (image.name == name) return image;
    message += ' ' + image.name;
  }
  throw InvalidOption(message);
}

VoxelImage make_image(std::string_view name, const ParameterValues& parameters) {
  const ImageInfo& image = find_image(name);
  return image.make(complete_parameters(image.name, image.parameters, parameters));
}

}  // namespace blum
