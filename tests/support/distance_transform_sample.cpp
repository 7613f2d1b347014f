// Runs the distance transform on a raw image of bytes. Programs in other languages compare its result with their own.
//
//   distance_transform_sample IN NX NY NZ SX SY SZ signed|unsigned THREADS OUT
//
// IN contains NX * NY * NZ bytes, x fastest; non-zero bytes are selected. OUT receives the distances (float32), then
// the sites (int32), in the same order. The program prints the seconds of the transform.
#include <chrono>
#include <cstdint>
#include <exception>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/field/distance_transform.hpp"

namespace {

void run(const std::vector<std::string>& arguments) {
  blum::VoxelImage image;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    image.grid.size[axis] = std::stoll(arguments.at(1 + axis));
    image.grid.spacing[axis] = std::stod(arguments.at(4 + axis));
  }
  blum::validate(image.grid);
  std::vector<std::uint8_t> values(image.grid.node_count());
  std::ifstream in(arguments.at(0), std::ios::binary);
  in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size()));
  if (!in) throw blum::FileError(arguments[0] + " does not hold one byte per voxel");
  image.values = std::move(values);

  const bool is_signed = arguments.at(7) == "signed";
  const blum::Context context{.threads = std::stoi(arguments.at(8))};
  const auto start = std::chrono::steady_clock::now();
  const blum::Field field = blum::distance_transform(image, {.is_signed = is_signed}, context);
  std::cout << std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() << "\n";

  std::ofstream out(arguments.at(9), std::ios::binary);
  const auto bytes = static_cast<std::streamsize>(field.distance.size() * sizeof(float));
  out.write(reinterpret_cast<const char*>(field.distance.data()), bytes);
  out.write(reinterpret_cast<const char*>(field.site.data()), bytes);
  if (!out.flush()) throw blum::FileError("cannot write " + arguments[9]);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 11) {
    std::cerr << "usage: distance_transform_sample IN NX NY NZ SX SY SZ signed|unsigned THREADS OUT\n";
    return 2;
  }
  try {
    run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
