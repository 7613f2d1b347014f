#include "blum/shapes/generators.hpp"
#include "shapes/catalog_parts.hpp"

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
           count_parameter("frequency", "fineness of the void, which has 20 frequency^2 triangles", 12, 1, 1581)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_void_cube({v.real("size"), v.real("void_radius"), v.whole("segments"), v.whole("frequency")});
          },
          always(1, 0, 1)};
}

ShapeInfo nested_shells() {
  return {"nested_shells",
          "nested spheres that bound, from outside to inside, solid, void, solid, ...",
          {count_parameter("shells", "number of shells", 3, 1, 1000), length_parameter("radius", "largest radius", 1),
           count_parameter("frequency", "fineness of the shells, each of 20 frequency^2 triangles", 8, 1, 1581)},
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
  return {
      "bodies",
      "separate equal bodies on a cubic lattice",
      {count_parameter("count", "number of bodies", 27, 1, 4000000), length_parameter("size", "size of each body", 0.5),
       length_parameter("spacing", "distance between centres, above size", 1),
       count_parameter("frequency", "0: bodies are boxes; otherwise spheres of 20 frequency^2 triangles", 0, 0, 1581)},
      [](const ShapeParameters& p) {
        const Values v{p};
        return make_bodies({v.whole("count"), v.real("size"), v.real("spacing"), v.whole("frequency")});
      },
      [](const ShapeParameters& p) -> Betti { return {{Values{p}.whole("count"), 0, 0}}; }};
}

ShapeInfo wedge() {
  return {"wedge",
          "a triangular prism with one sharp edge",
          {{"angle", "angle between the faces that meet in the sharp edge, in degrees", 30, 1e-6, 179.999, false},
           length_parameter("length", "length of the faces that meet in the sharp edge", 1),
           length_parameter("width", "length of the sharp edge", 1)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_wedge({v.real("angle"), v.real("length"), v.real("width")});
          },
          always(1, 0, 0)};
}

ShapeInfo star() {
  return {"star",
          "an extruded star",
          {count_parameter("spikes", "number of spikes", 5, 2, 2000),
           length_parameter("outer_radius", "radius of the tips", 1),
           length_parameter("inner_radius", "radius of the corners between tips, below outer_radius", 0.4),
           length_parameter("thickness", "thickness along z", 0.3)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_star({v.whole("spikes"), v.real("outer_radius"), v.real("inner_radius"), v.real("thickness")});
          },
          always(1, 0, 0)};
}

ShapeInfo plate() {
  return {
      "plate",
      "a plate with a grid of round holes",
      {count_parameter("holes_x", "holes along x", 3, 0, 3000), count_parameter("holes_y", "holes along y", 2, 0, 3000),
       length_parameter("pitch", "distance between hole centres", 1),
       length_parameter("hole_radius", "radius of each hole, below pitch / 2", 0.3),
       length_parameter("thickness", "thickness along z", 0.25),
       count_parameter("hole_segments", "sides of each hole, a multiple of 4", 32, 4, 100000)},
      [](const ShapeParameters& p) {
        const Values v{p};
        return make_plate({v.whole("holes_x"), v.whole("holes_y"), v.real("pitch"), v.real("hole_radius"),
                           v.real("thickness"), v.whole("hole_segments")});
      },
      [](const ShapeParameters& p) -> Betti {
        const Values v{p};
        return {{1, std::int64_t{v.whole("holes_x")} * v.whole("holes_y"), 0}};
      }};
}

ShapeInfo bracket() {
  return {
      "bracket",
      "an L-shaped bracket with holes and ribs",
      {length_parameter("length", "length of the foot, along x", 3),
       length_parameter("height", "height of the wall, along z", 3), length_parameter("width", "width along y", 3),
       length_parameter("thickness", "thickness of foot and wall", 0.4),
       count_parameter("holes", "holes in the foot; the wall has the same number", 2, 0, 10000),
       length_parameter("hole_radius", "radius of each hole", 0.3),
       count_parameter("ribs", "1: ribs between foot and wall; 0: none", 1, 0, 1),
       count_parameter("hole_segments", "sides of each hole, a multiple of 4", 32, 4, 100000)},
      [](const ShapeParameters& p) {
        const Values v{p};
        return make_bracket({v.real("length"), v.real("height"), v.real("width"), v.real("thickness"), v.whole("holes"),
                             v.real("hole_radius"), v.whole("ribs") == 1, v.whole("hole_segments")});
      },
      [](const ShapeParameters& p) -> Betti { return {{1, 2 * Values{p}.whole("holes"), 0}}; }};
}

ShapeInfo gear() {
  return {"gear",
          "a spur gear or drive wheel with a bore and round openings",
          {count_parameter("teeth", "number of teeth", 20, 4, 2000),
           length_parameter("root_radius", "radius between teeth", 0.85),
           length_parameter("tip_radius", "radius of the tips, above root_radius", 1),
           length_or_zero("bore_radius", "radius of the bore; 0: none", 0.2),
           count_parameter("openings", "round holes between bore and teeth", 5, 0, 1000),
           length_parameter("opening_radius", "radius of each opening", 0.13),
           length_parameter("thickness", "thickness along z", 0.3),
           count_parameter("hole_segments", "sides of each hole", 32, 3, 10000)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_gear({v.whole("teeth"), v.real("root_radius"), v.real("tip_radius"), v.real("bore_radius"),
                              v.whole("openings"), v.real("opening_radius"), v.real("thickness"),
                              v.whole("hole_segments")});
          },
          [](const ShapeParameters& p) -> Betti {
            const Values v{p};
            return {{1, v.whole("openings") + (v.real("bore_radius") > 0 ? 1 : 0), 0}};
          }};
}

ShapeInfo menger() {
  return {"menger",
          "the Menger sponge",
          {count_parameter("level", "number of refinements", 2, 0, 5), length_parameter("size", "overall size", 1)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_menger({v.whole("level"), v.real("size")});
          },
          [](const ShapeParameters& p) -> Betti {
            // A sponge consists of 20 copies of the next coarser one, which meet in 24 squares: Sierpinski carpets. A
            // carpet consists of 8 copies of the coarser one, which meet in 8 segments.
            std::int64_t sponge = 1;  // Euler characteristic; below, that of a carpet
            std::int64_t carpet = 1;
            for (int level = 0; level < Values{p}.whole("level"); ++level) {
              sponge = 20 * sponge - 24 * carpet;
              carpet = 8 * carpet - 8;
            }
            return {{1, 1 - sponge, 0}};
          }};
}

ShapeInfo fan_part() {
  return {
      "fan_part",
      "a sector of a fan: curved and flat faces that meet in sharp edges, like a CAD model",
      {length_parameter("size", "overall size", 1),
       count_parameter("resolution", "parts of each edge of the smallest block; 8 gives 12,288 triangles", 8, 1, 500)},
      [](const ShapeParameters& p) {
        const Values v{p};
        return make_fan_part({v.real("size"), v.whole("resolution")});
      },
      always(1, 0, 0)};
}

}  // namespace

std::vector<ShapeInfo> machined_shapes() {
  return {box(),       wedge(),         star(),   plate(),  bracket(), gear(),
          void_cube(), nested_shells(), bodies(), menger(), fan_part()};
}

}  // namespace blum::detail
