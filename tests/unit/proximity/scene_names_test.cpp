// Messages of a scene call each object by its name, or by its number if it has no name.
#include <gtest/gtest.h>

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/proximity/scene.hpp"
#include "blum/shapes/generators.hpp"

namespace blum {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

template <class Failing>
std::string message_of(const Failing& failing) {
  try {
    failing();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(SceneOfNames, UsesNamesOfObjectsInMessages) {
  const TriangleMesh box = make_box({});
  TriangleMesh open = box;
  open.triangles.pop_back();
  TriangleMesh huge = box;
  for (Vec3d& p : huge.vertices) p = p * 1e75;
  TriangleMesh heap = box;
  heap.triangles.assign(40000, box.triangles[0]);
  for (const std::string name : {"", "cup.ply", "object 7"}) {
    SCOPED_TRACE(name);
    const std::string called = name.empty() ? "object 1" : "'" + name + "'";
    const std::string before = name.empty() ? "" : called + ": ";
    const ObjectOptions options{.self = true, .name = name};
    ProximityScene scene;
    const ObjectId first = scene.add(box);
    const std::string refused = message_of([&] { scene.add(huge, options); });
    EXPECT_TRUE(refused.starts_with(before + "a coordinate is beyond 1e70")) << refused;
    EXPECT_EQ(scene.size(), 1U);
    const ObjectId second = scene.add(open, options);
    const auto starts = [&](const std::string& wanted, const auto& failing) {
      const std::string message = message_of(failing);
      EXPECT_TRUE(message.starts_with(wanted)) << message;
    };
    starts(called + " is not closed", [&] { static_cast<void>(scene.penetration(first, second)); });
    starts(called + " is not closed", [&] { static_cast<void>(scene.penetration(second, second)); });
    starts(called + " is not closed", [&] { static_cast<void>(scene.penetrations()); });
    starts(called + " is not closed", [&] { static_cast<void>(scene.signed_separations()); });
    starts(before + "a coordinate is beyond", [&] { scene.update(second, huge.vertices); });
    starts(before + "a coordinate is beyond", [&] { scene.update(second, huge); });
    starts(before + "the object has 8 vertices, but the update has 7",
           [&] { scene.update(second, std::span(box.vertices).first(7)); });
    const ObjectMotion far{second, huge.vertices};
    const ObjectMotion rests{second};
    starts(called + " at the end: a coordinate", [&] { static_cast<void>(scene.continuous({&far, 1})); });
    const std::vector<ObjectMotion> twice{rests, rests};
    starts(called + " has two motions", [&] { static_cast<void>(scene.continuous(twice)); });
    scene.update(second, heap);
    starts(called + ": 40000 primitives share vertex",
           [&] { static_cast<void>(scene.separation(second, second, infinite)); });
    scene.update(second, open);
    scene.rename(second, "bowl");
    starts("'bowl' is not closed", [&] { static_cast<void>(scene.penetration(first, second)); });
    scene.rename(second, "");
    starts("object 1 is not closed", [&] { static_cast<void>(scene.penetration(first, second)); });
    starts("the scene has no object 5", [&] { scene.rename(ObjectId(5), "nothing"); });
  }
}

}  // namespace
}  // namespace blum
