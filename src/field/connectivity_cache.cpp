#include "field/connectivity_cache.hpp"

#include <cstring>
#include <span>

namespace blum {
namespace {

template <class T>
bool same_bytes(std::span<const T> a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

}  // namespace

bool ConnectivityCache::holds(const MeshView& mesh) const {
  return has_mesh_ && vertex_count_ == mesh.vertices.size() && same_bytes(mesh.triangles, triangles_) &&
         same_bytes(mesh.segments, segments_) && same_bytes(mesh.points, points_);
}

void ConnectivityCache::store(const MeshView& mesh) {
  has_mesh_ = false;
  vertex_count_ = mesh.vertices.size();
  triangles_.assign(mesh.triangles.begin(), mesh.triangles.end());
  segments_.assign(mesh.segments.begin(), mesh.segments.end());
  points_.assign(mesh.points.begin(), mesh.points.end());
  has_mesh_ = true;
}

}  // namespace blum
