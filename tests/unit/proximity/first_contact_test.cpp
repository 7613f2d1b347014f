// The first contact is the first of all collisions: by time, then in the order in which collisions are listed.
#include "blum/proximity/first_contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>
#include <stop_token>
#include <tuple>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/proximity/scene.hpp"
#include "blum/shapes/generators.hpp"
#include "support/random_transform.hpp"

namespace blum {
namespace {

/// Objects, kind, and vertices or face of both features.
using Place = std::tuple<std::uint32_t, std::uint32_t, int, std::vector<std::uint32_t>, std::vector<std::uint32_t>>;

struct Contact {
  double time;
  Place place;

  friend bool operator==(const Contact&, const Contact&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Contact& one) {
    return out << "time " << one.time << ", objects " << std::get<0>(one.place) << " " << std::get<1>(one.place)
               << ", kind " << std::get<2>(one.place) << ", first feature from vertex "
               << std::get<3>(one.place).front();
  }
};

Contact contact(const ObjectCollisions& pair, ContactKind kind, const VertexFaceCollision& one) {
  return {one.time, {pair.first.value, pair.second.value, static_cast<int>(kind), {one.vertex}, {one.face.value}}};
}

/// Lists all collisions, sorts them by time and then by place, and returns the first.
std::optional<Contact> first_of_all(const SceneCollisions& all) {
  std::vector<Contact> list;
  for (const ObjectCollisions& pair : all.objects) {
    for (const auto& one : pair.vertex_face) list.push_back(contact(pair, ContactKind::vertex_face, one));
    for (const auto& one : pair.face_vertex) list.push_back(contact(pair, ContactKind::face_vertex, one));
    for (const auto& [a, b, time] : pair.edge_edge) {
      list.push_back({time, {pair.first.value, pair.second.value, 2, {a[0], a[1]}, {b[0], b[1]}}});
    }
  }
  const auto key = [](const Contact& one) { return std::tie(one.time, one.place); };
  const auto least =
      std::min_element(list.begin(), list.end(), [&](const Contact& x, const Contact& y) { return key(x) < key(y); });
  return least == list.end() ? std::nullopt : std::optional(*least);
}

std::optional<Contact> as_contact(const std::optional<FirstContact>& found) {
  return found ? first_of_all(collisions_of(*found)) : std::nullopt;
}

/// Checks the first contact for several numbers of threads. @return true if there is one.
bool expect_first(const ProximityScene& scene, const std::vector<ObjectMotion>& motions,
                  const ImpactOptions& options = {}) {
  const std::optional<Contact> expected = first_of_all(scene.continuous(motions, options));
  for (const int threads : {1, 2, 5}) {
    EXPECT_EQ(as_contact(scene.first_contact(motions, options, {.threads = threads})), expected);
  }
  return expected.has_value();
}

std::vector<Vec3d> moved(std::vector<Vec3d> vertices, const Vec3d& by) {
  for (Vec3d& p : vertices) p += by;
  return vertices;
}

/// Bodies of curved and flat faces deform, rotate and rest. Tolerances up to 1 make many times equal.
TEST(FirstContact, IsTheFirstOfAllCollisions) {
  Random random(1);
  int contacts = 0;
  int rounds = 0;
  for (const double min_separation : {0.0, 0.05}) {
    for (const double tolerance : {0x1p-40, 1e-6, 0.01, 1.0}) {
      for (int round = 0; round < 4; ++round, ++rounds) {
        const ImpactOptions options{.tolerance = tolerance, .min_separation = min_separation};
        const TriangleMesh ball = make_sphere({.frequency = 3});
        const TriangleMesh block = make_box({.segments = {2, 2, 2}});
        ProximityScene scene;
        const ObjectId a = scene.add(ball);
        const ObjectId b = scene.add(block);
        const ObjectId c = scene.add(block);
        scene.update(a, test::random_transform(random, 3));
        scene.update(b, test::random_transform(random, 3));
        scene.update(c, test::random_transform(random, 3));
        std::vector<Vec3d> squeezed = ball.vertices;
        for (Vec3d& p : squeezed) p = {2.5 * p.x, 0.5 * p.y, p.z};
        const std::vector<ObjectMotion> motions{{a, squeezed, test::random_transform(random, 1)},
                                                {b, {}, test::random_transform(random, 1)}};
        contacts += expect_first(scene, motions, options) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(contacts, rounds / 2);
}

/// Grids of faces meet at many points at once. Some of these times are multiples of the step of reported times. Faces
/// are aligned or moved aside, and their coordinates are exact or rounded.
TEST(FirstContact, IsTheFirstOfManyEqualTimes) {
  const TriangleMesh block = make_box({.segments = {3, 4, 5}});
  for (const double scale : {1.0, 0.1, 1.0 / 3}) {
    for (const double fall : {4.0, 3.0, 7.0, 2.5}) {
      for (const Vec3d& aside : {Vec3d{0, 0, 0}, Vec3d{0.5, 0, 0}, Vec3d{0.25, 0.125, 0}, Vec3d{0.03, 0.01, 0}}) {
        TriangleMesh low = block;
        for (Vec3d& p : low.vertices) p *= scale;
        TriangleMesh high = block;
        for (Vec3d& p : high.vertices) p = Vec3d{p.x + aside.x, p.y + aside.y, p.z + 3} * scale;
        ProximityScene scene;
        scene.add(low);
        const ObjectId falling = scene.add(high);
        const std::vector<Vec3d> end = moved(high.vertices, Vec3d{0, 0, -fall * scale});
        EXPECT_TRUE(expect_first(scene, {{falling, end, {}}}));
        if (fall == 4.0) {
          EXPECT_TRUE(expect_first(scene, {{falling, end, {}}}, {.min_separation = 0.1}));
        }
      }
    }
  }
}

/// At time 0, blocks touch or overlap, so only the order decides.
TEST(FirstContact, MayBeAtTheStart) {
  const TriangleMesh block = make_box({.segments = {3, 3, 3}});
  for (const double above : {1.0, 0.5, 0.0}) {
    ProximityScene scene;
    scene.add(block);
    const TriangleMesh other{moved(block.vertices, Vec3d{0, 0, above}), block.triangles};
    const ObjectId moving = scene.add(other);
    const std::vector<Vec3d> end = moved(other.vertices, Vec3d{0.25, 0, 0.5});
    ASSERT_TRUE(expect_first(scene, {{moving, end, {}}}));
    EXPECT_EQ(scene.first_contact(std::vector<ObjectMotion>{{moving, end, {}}})->time(), 0.0);
  }
}

/// Triangles whose corners are small integers: nearly all contacts are degenerate, and many times are equal.
TEST(FirstContact, IsTheFirstForDegenerateSoups) {
  Random random(2);
  int contacts = 0;
  for (int round = 0; round < 60; ++round) {
    const auto soup = [&](std::size_t triangles, double lift) {
      TriangleMesh mesh;
      for (std::uint32_t t = 0; t < triangles; ++t) {
        for (int k = 0; k < 3; ++k) {
          const double x = static_cast<double>(random.below(4));
          const double y = static_cast<double>(random.below(4));
          mesh.vertices.push_back({x, y, static_cast<double>(random.below(3)) + lift});
        }
        mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
      }
      return mesh;
    };
    const TriangleMesh low = soup(6, 0);
    const TriangleMesh high = soup(6, 4);
    TriangleMesh last = soup(6, -4);
    if (round % 2 == 0) last.vertices = moved(high.vertices, Vec3d{1, 0, -5});
    ProximityScene scene;
    scene.add(low, {.self = round % 3 == 0});
    const ObjectId falling = scene.add(high, {.self = round % 3 == 1});
    contacts += expect_first(scene, {{falling, last.vertices, {}}}) ? 1 : 0;
    if (round % 3 != 2) continue;
    const std::vector<ObjectMotion> motions{{falling, last.vertices, {}}};
    EXPECT_EQ(as_contact(first_contact(low, low.vertices, high, last.vertices)),
              as_contact(scene.first_contact(motions)));
  }
  EXPECT_GT(contacts, 40);
}

/// One call for one mesh finds the first of its collisions with itself.
TEST(FirstContact, OfAMeshWithItself) {
  const TriangleMesh mesh = make_organic({.frequency = 6});
  for (const double squeeze : {-0.5, 0.1, 0.9}) {
    std::vector<Vec3d> end = mesh.vertices;
    for (Vec3d& p : end) p.z *= squeeze;
    const ContinuousCollisions all = continuous_collisions(mesh, end);
    SceneCollisions listed;
    listed.objects.push_back({ObjectId(0), ObjectId(0), all.vertex_face, {}, all.edge_edge});
    EXPECT_EQ(as_contact(first_contact(mesh, end)), first_of_all(listed));
  }
}

TEST(FirstContact, IsNothingIfNothingMeets) {
  const TriangleMesh block = make_box();
  const std::vector<Vec3d> far = moved(block.vertices, Vec3d{5, 0, 0});
  EXPECT_FALSE(first_contact(block, block.vertices));
  EXPECT_FALSE(first_contact(block, block.vertices, TriangleMesh{far, block.triangles}, far));
  // Both pass the same place, but at different times.
  const std::vector<Vec3d> early = moved(block.vertices, Vec3d{0, 0, 2});
  const std::vector<Vec3d> late = moved(block.vertices, Vec3d{0, 0, 8});
  EXPECT_FALSE(first_contact(block, late, TriangleMesh{early, block.triangles}, moved(late, Vec3d{0, 0, 3})));
}

TEST(FirstContact, RejectsInvalidMotions) {
  const TriangleMesh block = make_box();
  const std::vector<Vec3d> few(3);
  EXPECT_THROW(static_cast<void>(first_contact(block, few)), InvalidMesh);
  EXPECT_THROW(static_cast<void>(first_contact(block, block.vertices, block, few)), InvalidMesh);
  EXPECT_THROW(static_cast<void>(first_contact(block, block.vertices, {.tolerance = 0})), InvalidOption);
  Context stopped;
  std::stop_source source;
  source.request_stop();
  stopped.cancel = source.get_token();
  EXPECT_THROW(static_cast<void>(first_contact(block, block.vertices, {}, stopped)), Cancelled);
}

}  // namespace
}  // namespace blum
