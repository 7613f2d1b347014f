// The Flexible Collision Library (BSD-3): distances between bodies.
#include "peers/collisions.hpp"

#ifdef BLUM_BENCH_FCL
#include <fcl/fcl.h>

namespace blum::bench {
namespace {

std::vector<fcl::Vector3d> vertices(const TriangleMesh& mesh) {
  std::vector<fcl::Vector3d> out;
  for (const Vec3d& p : mesh.vertices) out.emplace_back(p.x, p.y, p.z);
  return out;
}

template <class Volume>
std::shared_ptr<fcl::BVHModel<Volume>> model(const TriangleMesh& mesh) {
  auto out = std::make_shared<fcl::BVHModel<Volume>>();
  std::vector<fcl::Triangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles) triangles.emplace_back(a, b, c);
  out->beginModel();
  out->addSubModel(vertices(mesh), triangles);
  out->endModel();
  return out;
}

template <class Volume>
class Bodies : public PeerBodies {
 public:
  Bodies(const TriangleMesh& first, const TriangleMesh& second)
      : first_(model<Volume>(first)), second_(model<Volume>(second)) {}

  double separation(const RigidTransform& second) override {
    const fcl::DistanceRequestd request(true);
    fcl::DistanceResultd result;
    return fcl::distance(first_.get(), fcl::Transform3d::Identity(), second_.get(), place_of(second), request, result);
  }

  bool meets(const RigidTransform& second) override {
    const fcl::CollisionRequestd request(1, false);
    fcl::CollisionResultd result;
    return fcl::collide(first_.get(), fcl::Transform3d::Identity(), second_.get(), place_of(second), request, result) >
           0;
  }

  void deform(const TriangleMesh& first, const TriangleMesh& second) override {
    if constexpr (std::is_same_v<Volume, fcl::AABBd>) {
      refit(*first_, first);
      refit(*second_, second);
    } else {
      first_ = model<Volume>(first);
      second_ = model<Volume>(second);
    }
  }

 private:
  static fcl::Transform3d place_of(const RigidTransform& given) {
    fcl::Transform3d place = fcl::Transform3d::Identity();
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) {
        place.linear()(r, c) = given.rotation.columns[static_cast<std::size_t>(c)][static_cast<std::size_t>(r)];
      }
    }
    place.translation() = fcl::Vector3d(given.translation.x, given.translation.y, given.translation.z);
    return place;
  }

  static void refit(fcl::BVHModel<Volume>& body, const TriangleMesh& mesh) {
    body.beginReplaceModel();
    body.replaceSubModel(vertices(mesh));
    body.endReplaceModel();
  }

  std::shared_ptr<fcl::BVHModel<Volume>> first_;
  std::shared_ptr<fcl::BVHModel<Volume>> second_;
};

}  // namespace

std::unique_ptr<PeerBodies> fcl_bodies(const TriangleMesh& first, const TriangleMesh& second, FclBodies kind) {
  if (kind == FclBodies::oriented) return std::make_unique<Bodies<fcl::OBBRSSd>>(first, second);
  return std::make_unique<Bodies<fcl::AABBd>>(first, second);
}

}  // namespace blum::bench

#else

namespace blum::bench {

std::unique_ptr<PeerBodies> fcl_bodies(const TriangleMesh&, const TriangleMesh&, FclBodies) {
  return nullptr;
}

}  // namespace blum::bench

#endif
