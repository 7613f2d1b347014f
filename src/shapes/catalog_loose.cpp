#include "blum/shapes/generators.hpp"
#include "shapes/catalog_parts.hpp"

namespace blum::detail {
namespace {

ShapeInfo soup() {
  return {
      "soup",
      "loose random triangles",
      {count_parameter("triangles", "number of triangles", 100, 1, 50000000),
       length_parameter("size", "side of the cube that contains the centres of triangles", 1),
       length_parameter("triangle_size", "largest distance of a corner from the centre of its triangle", 0.2),
       {"awkward", "fraction of needles, slivers, copies, coplanar and degenerate triangles", 0, 0, 1, false},
       seed_parameter()},
      [](const ShapeParameters& p) {
        const Values v{p};
        return make_soup({v.count("triangles"), v.real("size"), v.real("triangle_size"), v.real("awkward"), v.seed()});
      },
      no_solid()};
}

ShapeInfo segments() {
  return {"segments",
          "random line segments",
          {count_parameter("segments", "number of segments", 100, 1, 50000000),
           length_parameter("size", "side of the cube that contains the centres of segments", 1),
           length_parameter("segment_size", "largest distance of an end from the centre of its segment", 0.2),
           seed_parameter()},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_segments({v.count("segments"), v.real("size"), v.real("segment_size"), v.seed()});
          },
          no_solid()};
}

ShapeInfo points() {
  return {"points",
          "a cloud of random points",
          {count_parameter("points", "number of points", 1000, 1, 50000000),
           length_parameter("size", "side of the cube that contains the points", 1), seed_parameter()},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_points({v.count("points"), v.real("size"), v.seed()});
          },
          no_solid()};
}

}  // namespace

std::vector<ShapeInfo> loose_shapes() {
  return {soup(), segments(), points()};
}

}  // namespace blum::detail
