// Coal (BSD-2), an extension of FCL: contacts and distances of rigid bodies.
#include "peers/collisions.hpp"

#ifdef BLUM_BENCH_COAL
#include <coal/BVH/BVH_model.h>
#include <coal/collision.h>
#include <coal/distance.h>

#include <cstdio>
#include <cstdlib>

namespace blum::bench {
namespace {

using Model = coal::BVHModel<coal::OBBRSS>;

std::shared_ptr<Model> model(const TriangleMesh& mesh) {
  std::vector<coal::Vec3s> vertices;
  for (const Vec3d& p : mesh.vertices) vertices.emplace_back(p.x, p.y, p.z);
  std::vector<coal::Triangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles) triangles.emplace_back(a, b, c);
  auto out = std::make_shared<Model>();
  out->beginModel();
  out->addSubModel(vertices, triangles);
  out->endModel();
  return out;
}

coal::Transform3s place_of(const RigidTransform& place) {
  coal::Matrix3s rotation;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      rotation(r, c) = place.rotation.columns[static_cast<std::size_t>(c)][static_cast<std::size_t>(r)];
    }
  }
  return {rotation, coal::Vec3s(place.translation.x, place.translation.y, place.translation.z)};
}

class Bodies : public PeerBodies {
 public:
  Bodies(const TriangleMesh& first, const TriangleMesh& second) : first_(model(first)), second_(model(second)) {}

  double separation(const RigidTransform& second) override {
    const coal::DistanceRequest request(true);
    coal::DistanceResult result;
    return coal::distance(first_.get(), {}, second_.get(), place_of(second), request, result);
  }

  bool meets(const RigidTransform& second) override {
    const coal::CollisionRequest request(coal::NO_REQUEST, 1);
    coal::CollisionResult result;
    return coal::collide(first_.get(), {}, second_.get(), place_of(second), request, result) > 0;
  }

  void deform(const TriangleMesh& first, const TriangleMesh& second) override {
    first_ = model(first);
    second_ = model(second);
  }

 private:
  std::shared_ptr<Model> first_;
  std::shared_ptr<Model> second_;
};

}  // namespace

std::unique_ptr<PeerBodies> coal_bodies(const TriangleMesh& first, const TriangleMesh& second) {
  // FCL and Coal from PyPI bring two versions of OctoMap. At the end of the process, both would free the same objects.
  static const bool is_set = std::atexit([] {
                               std::fflush(nullptr);
                               std::_Exit(0);
                             }) == 0;
  static_cast<void>(is_set);
  return std::make_unique<Bodies>(first, second);
}

}  // namespace blum::bench

#else

namespace blum::bench {

std::unique_ptr<PeerBodies> coal_bodies(const TriangleMesh&, const TriangleMesh&) {
  return nullptr;
}

}  // namespace blum::bench

#endif
