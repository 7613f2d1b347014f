#include <cmath>

#include "blum/geometry/generators.hpp"
#include "geometry/catalog_parts.hpp"

namespace blum::detail {
namespace {

ShapeInfo box() {
  return {
      "box",
      "a box",
      {length_parameter("size_x", "side along x", 1), length_parameter("size_y", "side along y", 1),
       length_parameter("size_z", "side along z", 1), count_parameter("segments", "parts of each edge", 1, 1, 2041)},
      [](const ShapeParameters& p) {
        const Values v{p};
        const int n = v.whole("segments");
        return make_box({{v.real("size_x"), v.real("size_y"), v.real("size_z")}, {n, n, n}});
      },
      always(1, 0, 0)};
}

ShapeInfo void_cube() {
  return {"void_cube",
          "a cube with a spherical void",
          {length_parameter("size", "side of the cube", 1),
           length_parameter("void_radius", "radius of the void, below size / 2", 0.3),
           count_parameter("segments", "parts of each edge of the cube", 8, 1, 2041),
           count_parameter("frequency", "fineness of the void: 20 frequency^2 triangles", 12, 1, 1581)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_void_cube({v.real("size"), v.real("void_radius"), v.whole("segments"), v.whole("frequency")});
          },
          always(1, 0, 1)};
}

ShapeInfo nested_shells() {
  return {"nested_shells",
          "spheres in each other: solid, void, solid, ...",
          {count_parameter("shells", "number of shells", 3, 1, 1000), length_parameter("radius", "largest radius", 1),
           count_parameter("frequency", "fineness: 20 frequency^2 triangles each", 8, 1, 1581)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_nested_shells({v.whole("shells"), v.real("radius"), v.whole("frequency")});
          },
          [](const ShapeParameters& p) -> Betti {
            const std::int64_t shells = Values{p}.whole("shells");
            return {{(shells + 1) / 2, 0, shells / 2}};
          }};
}

ShapeInfo bodies() {
  return {"bodies",
          "separate equal bodies on a cubic lattice",
          {count_parameter("count", "number of bodies", 27, 1, 4000000), length_parameter("size", "of each body", 0.5),
           length_parameter("spacing", "between centres, above size", 1),
           count_parameter("frequency", "0: boxes; else spheres of 20 frequency^2 triangles", 0, 0, 1581)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_bodies({v.whole("count"), v.real("size"), v.real("spacing"), v.whole("frequency")});
          },
          [](const ShapeParameters& p) -> Betti { return {{Values{p}.whole("count"), 0, 0}}; }};
}

ShapeInfo menger() {
  return {"menger",
          "the Menger sponge",
          {count_parameter("level", "how often it is refined", 2, 0, 5), length_parameter("size", "of the whole", 1)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_menger({v.whole("level"), v.real("size")});
          },
          [](const ShapeParameters& p) -> Betti {
            // 20 copies meet in 24 squares, which are Sierpinski carpets; 8 copies of a carpet meet in 8 segments.
            std::int64_t sponge = 1;  // Euler characteristics
            std::int64_t carpet = 1;
            for (int level = 0; level < Values{p}.whole("level"); ++level) {
              sponge = 20 * sponge - 24 * carpet;
              carpet = 8 * carpet - 8;
            }
            return {{1, 1 - sponge, 0}};
          }};
}

ShapeInfo fan_part() {
  return {"fan_part",
          "a sector of a fan: curved and flat faces that meet in sharp edges, like a CAD model",
          {length_parameter("size", "of the whole", 1),
           count_parameter("resolution", "parts of the smallest block; 9 gives about 13,000 triangles", 9, 1, 500)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_fan_part({v.real("size"), v.whole("resolution")});
          },
          always(1, 0, 0)};
}

}  // namespace

std::vector<ShapeInfo> machined_shapes() {
  return {box(), void_cube(), nested_shells(), bodies(), menger(), fan_part()};
}

}  // namespace blum::detail
