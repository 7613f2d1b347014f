#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/shapes/generators.hpp"
#include "shapes/generator_parts.hpp"

namespace blum {
namespace {

using detail::require;
using detail::require_at_least;
using detail::require_positive;
using detail::require_triangle_count;

constexpr std::uint32_t no_vertex = 0xffffffff;

/// A set of cells in a lattice of sizes[0] x sizes[1] x sizes[2] cells.
struct Blocks {
  std::array<int, 3> sizes{};
  std::vector<bool> filled;

  explicit Blocks(const std::array<int, 3>& size)
      : sizes(size),
        filled(static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
               static_cast<std::size_t>(size[2])) {}
  [[nodiscard]] std::size_t cell(int i, int j, int k) const {
    const auto n0 = static_cast<std::size_t>(sizes[0]);
    const auto n1 = static_cast<std::size_t>(sizes[1]);
    return (static_cast<std::size_t>(k) * n1 + static_cast<std::size_t>(j)) * n0 + static_cast<std::size_t>(i);
  }
  [[nodiscard]] bool has(const std::array<int, 3>& c) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (c[a] < 0 || c[a] >= sizes[a]) return false;
    }
    return filled[cell(c[0], c[1], c[2])];
  }
};

/// Returns the boundary of the filled cells. `position` maps a lattice point to its position in space. Adjacent faces
/// share vertices.
template <class Position>
TriangleMesh surface_of(const Blocks& blocks, Position position) {
  TriangleMesh mesh;
  const auto [n0, n1, n2] = blocks.sizes;
  const Blocks points({n0 + 1, n1 + 1, n2 + 1});
  std::vector<std::uint32_t> ids(points.filled.size(), no_vertex);
  const auto vertex = [&](const std::array<int, 3>& p) {
    std::uint32_t& id = ids[points.cell(p[0], p[1], p[2])];
    if (id == no_vertex) {
      id = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(position(p[0], p[1], p[2]));
    }
    return id;
  };
  const auto add_face = [&](const std::array<int, 3>& cell, std::size_t axis, bool upper) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    std::array<int, 3> corner = cell;
    if (upper) ++corner[axis];
    std::array<std::uint32_t, 4> quad{};
    quad[0] = vertex(corner);
    ++corner[u];
    quad[1] = vertex(corner);
    ++corner[v];
    quad[2] = vertex(corner);
    --corner[u];
    quad[3] = vertex(corner);
    if (upper) {
      detail::add_quad(mesh, quad[0], quad[1], quad[2], quad[3]);
    } else {
      detail::add_quad(mesh, quad[0], quad[3], quad[2], quad[1]);
    }
  };
  for (int k = 0; k < n2; ++k) {
    for (int j = 0; j < n1; ++j) {
      for (int i = 0; i < n0; ++i) {
        const std::array<int, 3> cell{i, j, k};
        if (!blocks.has(cell)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (const bool upper : {false, true}) {
            std::array<int, 3> neighbour = cell;
            neighbour[axis] += upper ? 1 : -1;
            if (!blocks.has(neighbour)) add_face(cell, axis, upper);
          }
        }
      }
    }
  }
  return mesh;
}

/// Returns true if cube (x, y, z) belongs to the Menger sponge. The cube does not belong to it if two coordinates have
/// the digit 1 at the same position in base 3.
bool is_in_menger(int x, int y, int z) {
  for (; x > 0 || y > 0 || z > 0; x /= 3, y /= 3, z /= 3) {
    if ((x % 3 == 1) + (y % 3 == 1) + (z % 3 == 1) >= 2) return false;
  }
  return true;
}

}  // namespace

TriangleMesh make_box(const BoxOptions& options) {
  double quads = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    require_positive(options.size[axis], "each side of the box");
    require_at_least(options.segments[axis], 1, "segments along each axis");
    quads += 2.0 * options.segments[axis] * options.segments[(axis + 1) % 3];
  }
  require_triangle_count(2 * quads);
  TriangleMesh mesh;
  const auto at = [&](std::size_t axis, int index) {
    return options.size[axis] * (static_cast<double>(index) / options.segments[axis] - 0.5);
  };
  const auto& n = options.segments;
  // Lattice points on the surface are numbered layer by layer, so that faces share vertices. The bottom and top layers
  // are full; layers between them only have the points on their rim.
  const auto nx = static_cast<std::uint32_t>(n[0]);
  const auto ny = static_cast<std::uint32_t>(n[1]);
  const auto nz = static_cast<std::uint32_t>(n[2]);
  const std::uint32_t layer = (nx + 1) * (ny + 1);
  const std::uint32_t rim = 2 * (nx + ny);
  const auto rim_index = [&](std::uint32_t i, std::uint32_t j) {
    if (j == 0) return i;
    if (i == nx) return nx + j;
    if (j == ny) return nx + ny + (nx - i);
    return 2 * nx + ny + (ny - j);
  };
  const auto vertex = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    if (k == 0) return j * (nx + 1) + i;
    if (k == nz) return layer + (nz - 1) * rim + j * (nx + 1) + i;
    return layer + (k - 1) * rim + rim_index(i, j);
  };
  mesh.vertices.resize(2 * std::size_t{layer} + std::size_t{nz - 1} * rim);
  for (std::uint32_t k = 0; k <= nz; ++k) {
    for (std::uint32_t j = 0; j <= ny; ++j) {
      const bool whole_row = k == 0 || k == nz || j == 0 || j == ny;
      for (std::uint32_t i = 0; i <= nx; i += whole_row ? 1 : nx) {
        mesh.vertices[vertex(i, j, k)] = {at(0, static_cast<int>(i)), at(1, static_cast<int>(j)),
                                          at(2, static_cast<int>(k))};
      }
    }
  }
  mesh.triangles.reserve(static_cast<std::size_t>(2 * quads));
  for (std::uint32_t j = 0; j < ny; ++j) {
    for (std::uint32_t i = 0; i < nx; ++i) {
      detail::add_quad(mesh, vertex(i, j, 0), vertex(i, j + 1, 0), vertex(i + 1, j + 1, 0), vertex(i + 1, j, 0));
      detail::add_quad(mesh, vertex(i, j, nz), vertex(i + 1, j, nz), vertex(i + 1, j + 1, nz), vertex(i, j + 1, nz));
    }
  }
  for (std::uint32_t k = 0; k < nz; ++k) {
    for (std::uint32_t i = 0; i < nx; ++i) {
      detail::add_quad(mesh, vertex(i, 0, k), vertex(i + 1, 0, k), vertex(i + 1, 0, k + 1), vertex(i, 0, k + 1));
      detail::add_quad(mesh, vertex(i, ny, k), vertex(i, ny, k + 1), vertex(i + 1, ny, k + 1), vertex(i + 1, ny, k));
    }
    for (std::uint32_t j = 0; j < ny; ++j) {
      detail::add_quad(mesh, vertex(0, j, k), vertex(0, j, k + 1), vertex(0, j + 1, k + 1), vertex(0, j + 1, k));
      detail::add_quad(mesh, vertex(nx, j, k), vertex(nx, j + 1, k), vertex(nx, j + 1, k + 1), vertex(nx, j, k + 1));
    }
  }
  return mesh;
}

TriangleMesh make_menger(const MengerOptions& options) {
  require(options.level >= 0 && options.level <= 5, "level", "0 to 5", options.level);
  require_positive(options.size, "size");
  int n = 1;
  for (int level = 0; level < options.level; ++level) n *= 3;
  Blocks blocks({n, n, n});
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) blocks.filled[blocks.cell(i, j, k)] = is_in_menger(i, j, k);
    }
  }
  const auto at = [&](int index) { return options.size * (static_cast<double>(index) / n - 0.5); };
  return surface_of(blocks, [&](int i, int j, int k) { return Vec3d{at(i), at(j), at(k)}; });
}

TriangleMesh make_fan_part(const FanPartOptions& options) {
  require_positive(options.size, "size");
  require_at_least(options.resolution, 1, "resolution");
  require_triangle_count(192.0 * options.resolution * options.resolution);
  const int r = options.resolution;
  // The blocks form a hub, a foot plate and a blade with a step. Their axes are radius, angle and height.
  Blocks blocks({4 * r, 6 * r, 3 * r});
  for (int k = 0; k < 3 * r; ++k) {
    for (int j = 0; j < 6 * r; ++j) {
      for (int i = 0; i < 4 * r; ++i) {
        const int radius = i / r;
        const int angle = j / r;
        const int height = k / r;
        const bool is_filled = height == 0 || (height == 1 && (radius == 0 || (angle >= 1 && angle <= 4))) ||
                               (height == 2 && radius <= 1 && angle >= 2 && angle <= 3);
        blocks.filled[blocks.cell(i, j, k)] = is_filled;
      }
    }
  }
  const double unit = options.size / r;
  return surface_of(blocks, [&](int i, int j, int k) {
    const double along = static_cast<double>(j) / (6 * r);
    const double angle = 1.3 * (along - 0.5) + 0.12 * unit / options.size * i * along;
    const double radius = unit * (r + i * (0.8 + 0.2 * along)) / 5;
    // The upper faces become lower towards one side, so that the heights of steps decrease slowly along their edges.
    const double height = unit * k * (1 - 0.55 * along * along) / 5;
    return Vec3d{radius * std::cos(angle) - 0.6 * options.size, radius * std::sin(angle), height - 0.3 * options.size};
  });
}

}  // namespace blum
