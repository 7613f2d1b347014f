// Writes fields and images for other programs, and converts files of other programs that Blum reads.
//   `files_sample all DIR`        writes samples, NAME.expected.json and the raw values NAME.*.bin into DIR.
//   `files_sample image IN OUT`   reads an image; writes its values to OUT.bin, its type and geometry to OUT.json.
//   `files_sample field IN OUT`   reads a field; writes OUT.distance.bin, OUT.site.bin and its geometry to OUT.json.
// The .bin and .json files are written without Blum's writers.
#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "blum/field/reference.hpp"
#include "blum/io/field_io.hpp"
#include "blum/io/image_io.hpp"

namespace {

using namespace blum;

std::string json_list(const Vec3d& v) {
  std::ostringstream out;
  out.precision(17);
  out << "[" << v.x << ", " << v.y << ", " << v.z << "]";
  return out.str();
}

/// Writes the geometry, with the direction as one column per axis.
void write_geometry(const std::filesystem::path& path, const GridSpec& grid, const std::string& more) {
  std::ofstream out(path);
  out << "{\"size\": [" << grid.size[0] << ", " << grid.size[1] << ", " << grid.size[2]
      << "], \"origin\": " << json_list(grid.origin) << ", \"spacing\": " << json_list(grid.spacing)
      << ", \"columns\": [" << json_list(grid.direction.columns[0]) << ", " << json_list(grid.direction.columns[1])
      << ", " << json_list(grid.direction.columns[2]) << "]" << more << "}\n";
}

template <class T>
void write_raw(const std::filesystem::path& path, const T* values, std::size_t count) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
}

std::string with(const std::string& base, const char* ending) {
  return base + ending;
}

void write_expected(const std::string& base, const Field& field) {
  write_geometry(with(base, ".expected.json"), field.grid,
                 std::string(", \"sign_rule\": \"") + std::string(to_string(field.sign_rule)) + "\", \"site_ids\": \"" +
                     std::string(to_string(field.site_ids)) + "\"");
  write_raw(with(base, ".distance.bin"), field.distance.data(), field.distance.size());
  write_raw(with(base, ".site.bin"), field.site.data(), field.site.size());
}

/// A rotation about an oblique axis.
Mat3 rotation() {
  const double c = std::cos(0.7);
  const double s = std::sin(0.7);
  const double e = std::cos(0.3);
  const double f = std::sin(0.3);
  Mat3 m;
  m.columns[0] = {c, s, 0};
  m.columns[1] = {-s * e, c * e, f};
  m.columns[2] = {s * f, -c * f, e};
  return m;
}

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1.5, 1.25, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  mesh.segments = {{1, 4}};
  return mesh;
}

Field mesh_field(const MeshView& mesh, const GridSpec& grid, SiteIds ids) {
  const reference::BruteForce brute(mesh);
  Field field;
  field.grid = grid;
  field.distance = Buffer<float>(grid.node_count());
  field.site = Buffer<SiteId>(grid.node_count());
  field.site_ids = ids;
  field.sign_rule = SignRule::winding;
  field.sign_reason = "an edge is free; \"winding\" is used";
  field.band = 0.6;
  for (std::int64_t k = 0; k < grid.size[2]; ++k) {
    for (std::int64_t j = 0; j < grid.size[1]; ++j) {
      for (std::int64_t i = 0; i < grid.size[0]; ++i) {
        const Vec3d p = grid.position(i, j, k);
        const auto nearest = brute.nearest(p);
        const bool far = nearest.distance > *field.band;
        const double sign = reference::winding_number(mesh, p) > 0.5 ? -1 : 1;
        const auto triangle = brute.sites().triangle(nearest.site);
        const SiteId site = ids == SiteIds::features ? nearest.site : SiteId(triangle.value);
        field.distance[grid.index(i, j, k)] = static_cast<float>(sign * std::min(nearest.distance, *field.band));
        field.site[grid.index(i, j, k)] = far ? SiteId::none() : site;
      }
    }
  }
  return field;
}

void write_fields(const std::filesystem::path& folder) {
  const TriangleMesh mesh = tetrahedron();
  const MeshView view = mesh;
  const SiteTable sites(view);
  GridSpec grid;
  grid.size = {9, 8, 7};
  grid.spacing = {0.2, 0.25, 0.3};
  grid.origin = {-0.3, -0.25, -0.45};
  GridSpec turned = grid;
  turned.direction = rotation();
  GridSpec flat = grid;
  flat.size[2] = 1;
  flat.origin.z = 0.1;
  struct Sample {
    const char* name;
    GridSpec grid;
    SiteIds ids;
  };
  for (const Sample& s : {Sample{"field", grid, SiteIds::features}, Sample{"turned", turned, SiteIds::features},
                          Sample{"flat", flat, SiteIds::features}, Sample{"triangles", grid, SiteIds::triangles},
                          Sample{"voxels", turned, SiteIds::voxels}}) {
    Field field = mesh_field(view, s.grid, s.ids);
    if (s.ids == SiteIds::voxels) {
      for (std::size_t i = 0; i < field.site.size(); ++i) field.site[i] = SiteId(static_cast<std::uint32_t>(i));
    }
    const std::string base = (folder / s.name).string();
    write_expected(base, field);
    for (const char* extension : {".nrrd", ".npz", ".vti"}) {
      write_field(with(base, extension), field, {&view, &sites, "t\xC3\xA9tra.obj", "0.0.0-sample"});
    }
  }
  std::ofstream(folder / "site_vertices.txt") << [&] {
    std::ostringstream out;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      for (const std::int32_t v : sites.vertices(SiteId(static_cast<std::uint32_t>(i)))) out << v << " ";
      out << "\n";
    }
    return out.str();
  }();
}

template <class T>
void write_image_of(const std::filesystem::path& folder, const std::string& type) {
  VoxelImage image;
  image.grid.size = {5, 4, 3};
  image.grid.spacing = {0.5, 0.75, 1.25};
  image.grid.origin = {-3, 2.5, 100};
  image.grid.direction = rotation();
  std::vector<T> values;
  for (int i = 0; i < 60; ++i) values.push_back(static_cast<T>(static_cast<double>(i) * 1.5));
  values[0] = std::numeric_limits<T>::lowest();
  values[1] = std::numeric_limits<T>::max();
  const std::string base = (folder / ("image_" + type)).string();
  write_geometry(with(base, ".expected.json"), image.grid, "");
  write_raw(with(base, ".bin"), values.data(), values.size());
  image.values = std::move(values);
  write_image(with(base, ".nrrd"), image);
  write_image(with(base, ".npy"), image);
}

void write_images(const std::filesystem::path& folder) {
  write_image_of<std::uint8_t>(folder, "uint8");
  write_image_of<std::int8_t>(folder, "int8");
  write_image_of<std::uint16_t>(folder, "uint16");
  write_image_of<std::int16_t>(folder, "int16");
  write_image_of<std::uint32_t>(folder, "uint32");
  write_image_of<std::int32_t>(folder, "int32");
  write_image_of<std::uint64_t>(folder, "uint64");
  write_image_of<std::int64_t>(folder, "int64");
  write_image_of<float>(folder, "float32");
  write_image_of<double>(folder, "float64");
}

void show_image(const std::string& in, const std::string& out) {
  constexpr std::array types{"uint8", "int8",   "uint16", "int16",   "uint32",
                             "int32", "uint64", "int64",  "float32", "float64"};
  const VoxelImage image = read_image(in);
  write_geometry(with(out, ".json"), image.grid, std::string(", \"type\": \"") + types[image.values.index()] + "\"");
  std::visit([&](const auto& v) { write_raw(with(out, ".bin"), v.data(), v.size()); }, image.values);
}

void show_field(const std::string& in, const std::string& out) {
  const Field field = read_field(in);
  write_geometry(with(out, ".json"), field.grid, "");
  write_raw(with(out, ".distance.bin"), field.distance.data(), field.distance.size());
  write_raw(with(out, ".site.bin"), field.site.data(), field.site.size());
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    if (arguments.size() == 2 && arguments[0] == "all") {
      std::filesystem::create_directories(arguments[1]);
      write_fields(arguments[1]);
      write_images(arguments[1]);
    } else if (arguments.size() == 3 && arguments[0] == "image") {
      show_image(arguments[1], arguments[2]);
    } else if (arguments.size() == 3 && arguments[0] == "field") {
      show_field(arguments[1], arguments[2]);
    } else {
      std::cerr << "usage: files_sample all DIR | image IN OUT | field IN OUT\n";
      return 2;
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
