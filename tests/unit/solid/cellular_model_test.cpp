// Proves that the cellular model of a solid has the solid's Betti numbers at every resolution.
#include "blum/solid/cellular_model.hpp"

#include <gtest/gtest.h>

#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "blum/solid/solid.hpp"

namespace blum {
namespace {

TEST(CellularModel, CatalogueShapesHaveTheirNumbersAtEveryResolution) {
  for (const ShapeInfo& shape : shape_catalog()) {
    const ShapeParameters parameters = complete_parameters(shape, {});
    const Solid solid = Solid::of(shape.make(parameters));
    if (solid.rule() != SolidRule::polyhedron) continue;
    for (const int resolution : {2, 3, 5, 8, 16, 32}) {
      const CellularModel model = solid.model({.resolution = resolution});
      const CellularModelReport& report = model.report();
      const auto [b0, b1, b2] = *solid.betti();
      std::printf("%-20s %3d cut %6zu failing %5zu boxes %5zu splits %2d stuck %3zu euler %3ld solid %3ld", std::string(shape.name).c_str(), resolution, report.cut_cubes, report.failing_cubes, report.boxes, report.splits, report.failures.size(), long(report.euler), long(b0-b1+b2));
      EXPECT_TRUE(report.passes) << shape.name << " at " << resolution;
      EXPECT_EQ(report.euler, b0 - b1 + b2) << shape.name << " at " << resolution;
      const auto b = model.betti();
      std::printf("  betti %ld %ld %ld\n", long(b[0]), long(b[1]), long(b[2]));
      EXPECT_EQ(b, *solid.betti()) << shape.name << " at " << resolution;
    }
  }
}

}  // namespace
}  // namespace blum
