#include "blum/shapes/generators.hpp"
#include "shapes/catalog_parts.hpp"

namespace blum::detail {
namespace {

constexpr int largest_frequency = 1581;  // 20 f^2 triangles are fewer than 50 million

ShapeParameter frequency_parameter(int value) {
  return count_parameter("frequency", "parts of each edge of the icosahedron from which the shape is made", value, 1,
                         largest_frequency);
}

ShapeInfo sphere() {
  return {"sphere",
          "a sphere of nearly equal triangles",
          {length_parameter("radius", "radius", 1), frequency_parameter(16)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_sphere({v.real("radius"), v.whole("frequency")});
          },
          always(1, 0, 0)};
}

ShapeInfo ellipsoid() {
  return {"ellipsoid",
          "an ellipsoid",
          {length_parameter("radius_x", "half axis along x", 1), length_parameter("radius_y", "half axis along y", 0.6),
           length_parameter("radius_z", "half axis along z", 0.3), frequency_parameter(16)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_ellipsoid({{v.real("radius_x"), v.real("radius_y"), v.real("radius_z")}, v.whole("frequency")});
          },
          always(1, 0, 0)};
}

ShapeInfo uv_sphere() {
  return {"uv_sphere",
          "a sphere of longitudes and latitudes",
          {length_parameter("radius", "radius", 1), count_parameter("longitudes", "sectors", 48, 3, 100000),
           count_parameter("latitudes", "bands from pole to pole", 24, 2, 100000)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_uv_sphere({v.real("radius"), v.whole("longitudes"), v.whole("latitudes")});
          },
          always(1, 0, 0)};
}

ShapeInfo cylinder() {
  return {"cylinder",
          "a cylinder with flat ends",
          {length_parameter("radius", "radius", 0.5), length_parameter("height", "height", 1),
           count_parameter("sides", "sides around", 48, 3, 1000000),
           count_parameter("stacks", "bands along the height", 1, 1, 1000000)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_cylinder({v.real("radius"), v.real("height"), v.whole("sides"), v.whole("stacks")});
          },
          always(1, 0, 0)};
}

ShapeInfo torus() {
  return {"torus",
          "a torus in the xy plane",
          {length_parameter("ring_radius", "radius of the centre line", 1),
           length_parameter("tube_radius", "radius of the tube, below ring_radius", 0.3),
           count_parameter("ring_segments", "segments around the ring", 96, 3, 1000000),
           count_parameter("tube_segments", "segments around the tube", 32, 3, 1000000)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_torus(
                {v.real("ring_radius"), v.real("tube_radius"), v.whole("ring_segments"), v.whole("tube_segments")});
          },
          always(1, 1, 0)};
}

ShapeInfo torus_knot() {
  return {"torus_knot",
          "a tube around a (p, q) torus knot",
          {count_parameter("p", "turns around the axis; no common factor with q", 2, 1, 20),
           count_parameter("q", "turns around the tube of the torus", 3, 1, 20),
           length_parameter("ring_radius", "radius of the torus", 1),
           length_parameter("wind_radius", "radius of the torus's tube, below ring_radius", 0.4),
           length_parameter("tube_radius", "radius of the knot's own tube", 0.15),
           count_parameter("curve_segments", "segments along the knot", 400, 16, 1000000),
           count_parameter("tube_segments", "segments around the knot's tube", 24, 3, 1000000)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_torus_knot({v.whole("p"), v.whole("q"), v.real("ring_radius"), v.real("wind_radius"),
                                    v.real("tube_radius"), v.whole("curve_segments"), v.whole("tube_segments")});
          },
          always(1, 1, 0)};
}

ShapeInfo linked_tori() {
  return {"linked_tori",
          "a chain of tori that pass through each other",
          {count_parameter("count", "links", 2, 1, 1000),
           length_parameter("ring_radius", "radius of each link's centre line", 1),
           length_parameter("tube_radius", "radius of the tube, below ring_radius / 3", 0.2),
           count_parameter("ring_segments", "segments around each ring", 96, 8, 100000),
           count_parameter("tube_segments", "segments around the tube", 32, 3, 100000)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_linked_tori({v.whole("count"), v.real("ring_radius"), v.real("tube_radius"),
                                     v.whole("ring_segments"), v.whole("tube_segments")});
          },
          [](const ShapeParameters& p) -> Betti {
            const std::int64_t count = Values{p}.whole("count");
            return {{count, count, 0}};
          }};
}

ShapeInfo ridged_rod() {
  return {"ridged_rod",
          "a rod whose radius varies along its length like a cosine",
          {length_parameter("length", "length", 4), length_parameter("radius", "mean radius", 0.5),
           length_or_zero("ridge_height", "half the difference between ridge and groove, below radius", 0.1),
           count_parameter("ridges", "ridges along the length", 12, 0, 100000),
           count_parameter("sides", "sides around", 48, 3, 100000),
           count_parameter("segments_per_ridge", "bands of each ridge", 12, 4, 100000)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_ridged_rod({v.real("length"), v.real("radius"), v.real("ridge_height"), v.whole("ridges"),
                                    v.whole("sides"), v.whole("segments_per_ridge")});
          },
          always(1, 0, 0)};
}

ShapeInfo spoon() {
  return {"spoon",
          "a spoon-like solid: a thin bowl and a bent handle",
          {length_parameter("length", "length", 6),
           length_parameter("bowl_width", "width of the bowl, at most length / 3", 1.4),
           length_parameter("bowl_depth", "depth of the bowl, at most bowl_width", 0.4),
           length_parameter("handle_width", "width of the handle, at most bowl_width", 0.35),
           length_parameter("thickness", "thickness, at most handle_width", 0.12),
           count_parameter("stations", "cross-sections along the length", 160, 16, 1000000),
           count_parameter("sides", "points around each cross-section, even", 40, 8, 100000)},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_spoon({v.real("length"), v.real("bowl_width"), v.real("bowl_depth"), v.real("handle_width"),
                               v.real("thickness"), v.whole("stations"), v.whole("sides")});
          },
          always(1, 0, 0)};
}

ShapeInfo organic() {
  return {"organic",
          "an animal-like body with rough skin, like a scanned model; with holes, an open surface",
          {length_parameter("radius", "typical radius", 1),
           frequency_parameter(59),
           {"detail", "amplitude of the finest bumps, in radii", 0.006, 0, 0.05, false},
           count_parameter("holes", "holes in the surface", 0, 0, 12),
           seed_parameter()},
          [](const ShapeParameters& p) {
            const Values v{p};
            return make_organic({v.real("radius"), v.whole("frequency"), v.real("detail"), v.whole("holes"), v.seed()});
          },
          [](const ShapeParameters& p) -> Betti {
            if (Values{p}.whole("holes") > 0) return std::nullopt;
            return {{1, 0, 0}};
          }};
}

}  // namespace

std::vector<ShapeInfo> round_shapes() {
  return {sphere(),     ellipsoid(),   uv_sphere(),  cylinder(), torus(),
          torus_knot(), linked_tori(), ridged_rod(), spoon(),    organic()};
}

}  // namespace blum::detail
