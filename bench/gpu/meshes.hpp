// Blum: meshes for the programs for graphics processors. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>

#include "blum/geometry/triangle_mesh.hpp"
#include "blum/shapes/generators.hpp"

namespace blum::bench {

/// A knotted tube of about this many triangles. Noise removes its symmetry.
inline TriangleMesh noisy_knot(int triangles) {
  TorusKnotOptions options;
  options.tube_segments = std::max(8, static_cast<int>(std::sqrt(triangles / 80.0)));
  options.curve_segments = triangles / (2 * options.tube_segments);
  return make_noisy(make_torus_knot(options), 0.002);
}

/// Vertices and triangles of an OFF or OBJ file, without its other records. Requires no zlib.
inline TriangleMesh read_plain_mesh(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot open " + path);
  TriangleMesh mesh;
  std::string word;
  if (path.ends_with(".off")) {
    std::size_t vertices = 0;
    std::size_t faces = 0;
    std::size_t edges = 0;
    in >> word >> vertices >> faces >> edges;
    mesh.vertices.resize(vertices);
    for (Vec3d& v : mesh.vertices) in >> v.x >> v.y >> v.z;
    for (std::size_t f = 0; f < faces; ++f) {
      std::size_t corners = 0;
      Triangle t{};
      in >> corners >> t[0] >> t[1];
      for (std::size_t k = 2; k < corners && in; ++k, t[1] = t[2]) {
        in >> t[2];
        mesh.triangles.push_back(t);
      }
    }
  } else {
    for (std::string line; std::getline(in, line);) {
      Vec3d v;
      Triangle t{};
      if (std::sscanf(line.c_str(), "v %lf %lf %lf", &v.x, &v.y, &v.z) == 3) mesh.vertices.push_back(v);
      if (line.starts_with("f ")) {
        std::size_t count = 0;
        for (std::size_t at = 1; at < line.size() && count < 3; ++count) {
          at = line.find_first_not_of(' ', at);
          if (at == std::string::npos) break;
          t[count] = static_cast<std::uint32_t>(std::stoul(line.substr(at))) - 1;
          at = std::min(line.find(' ', at), line.size());
        }
        if (count == 3) mesh.triangles.push_back(t);
      }
    }
  }
  validate(mesh);
  return mesh;
}

}  // namespace blum::bench
