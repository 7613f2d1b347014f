// Writes a small medial axis for other programs, and converts axes of other programs that Blum reads.
//   `medial_files_sample all DIR`       writes axis.{vtp,ply,obj,ma,npz} and the empty axes empty.*; also
//                                       axis.expected.json, without Blum's writers.
//   `medial_files_sample show IN OUT`   reads an axis; writes its contents to OUT, as JSON.
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "medial_sample.hpp"

namespace {

using namespace blum;
using test::AxisRows;
using test::EdgeRow;
using test::TriangleRow;
using test::VertexRow;

void show(std::ostream& out, const Vec3d& v) {
  out << "[" << v.x << ", " << v.y << ", " << v.z << "]";
}

template <class Items, class Show>
void show_list(std::ostream& out, const char* name, const Items& items, Show show_item) {
  out << "\"" << name << "\": [";
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) out << ", ";
    show_item(items[i]);
  }
  out << "]";
}

void show_complex(std::ostream& out, const AxisRows& complex) {
  show_list(out, "vertices", complex.vertices, [&](const VertexRow& v) {
    out << "{\"position\": ";
    show(out, v.position);
    out << ", \"radius\": " << v.radius << ", \"separation_angle\": " << v.separation_angle
        << ", \"role\": " << static_cast<int>(v.role) << ", \"sites\": [" << v.sites[0].to_file() << ", "
        << v.sites[1].to_file() << "], \"footprints\": [";
    show(out, v.footprints[0]);
    out << ", ";
    show(out, v.footprints[1]);
    out << "]}";
  });
  out << ",\n";
  show_list(out, "edges", complex.edges, [&](const EdgeRow& e) {
    out << "{\"vertices\": [" << e.vertices[0] << ", " << e.vertices[1]
        << "], \"separation_angle\": " << e.separation_angle << ", \"role\": " << static_cast<int>(e.role) << "}";
  });
  out << ",\n";
  show_list(out, "triangles", complex.triangles, [&](const TriangleRow& t) {
    out << "{\"vertices\": [" << t.vertices[0] << ", " << t.vertices[1] << ", " << t.vertices[2]
        << "], \"separation_angle\": " << t.separation_angle << ", \"sheet\": " << t.sheet << "}";
  });
}

void write_json(const std::filesystem::path& path, const AxisRows& complex) {
  std::ofstream out(path);
  out.precision(std::numeric_limits<double>::max_digits10);
  out << "{";
  show_complex(out, complex);
  out << "}\n";
}

void write_samples(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const AxisRows complex = test::sample_complex();
  for (const char* extension : {".vtp", ".ply", ".obj", ".ma", ".npz"}) {
    write_medial(folder / (std::string("axis") + extension), complex, test::sample_metadata());
    write_medial(folder / (std::string("empty") + extension), AxisRows{}, test::sample_metadata());
  }
  write_json(folder / "axis.expected.json", complex);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    if (arguments.size() == 2 && arguments[0] == "all") {
      write_samples(arguments[1]);
    } else if (arguments.size() == 3 && arguments[0] == "show") {
      write_json(arguments[2], read_medial(arguments[1]).complex);
    } else {
      std::cerr << "usage: medial_files_sample all DIR | show IN OUT\n";
      return 2;
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
