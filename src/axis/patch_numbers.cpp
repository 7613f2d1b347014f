#include "blum/axis/patch_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "blum/geometry/surface_patches.hpp"

namespace blum::detail {
namespace {

/// Largest bends at edges inside flat and inside smooth patches, in degrees.
constexpr double flat = 1;
constexpr double smooth = 30;
/// A flat patch gets its own number if it has at least this share of the surface's area. No face of a regular prism, or
/// of a box made of squares, has exactly this share, so rounding decides nothing.
constexpr double least_part = 0.00437;
/// Least distance of an anchor from the point, line or plane through the earlier anchors, as a fraction of `reach_`.
constexpr double apart = 0.0937;

/// Returns for each patch the lowest index that one of its faces has in the input.
std::vector<std::uint32_t> first_faces(const SurfacePatches& patches, const PatchedMesh& part) {
  std::vector<std::uint32_t> first(patches.patches().size(), PatchNumbers::none);
  for (std::uint32_t t = 0; t < part.triangle_of.size(); ++t) {
    const std::uint32_t patch = patches.of_face(t);
    if (patch != SurfacePatches::none) first[patch] = std::min(first[patch], part.triangle_of[t]);
  }
  return first;
}

/// Returns for each triangle of the mesh the number of its patch: even for flat patches, odd for smooth ones.
std::vector<std::uint32_t> numbers_of_faces(const PatchedMesh& part, const SiteTable& own, const Context& context) {
  const SurfacePatches flats(part.mesh, own, flat, context);
  const SurfacePatches rest(part.mesh, own, smooth, context);
  const std::vector<std::uint32_t> first_of_flat = first_faces(flats, part);
  const std::vector<std::uint32_t> first_of_rest = first_faces(rest, part);
  double area = 0;
  for (const SurfacePatch& patch : rest.patches()) area += patch.area;
  std::vector<std::uint32_t> numbers(part.mesh.triangles.size(), PatchNumbers::none);
  for (std::uint32_t t = 0; t < numbers.size(); ++t) {
    const std::uint32_t patch = flats.of_face(t);
    if (patch == SurfacePatches::none) continue;
    const bool is_large = flats.patches()[patch].area >= least_part * area;
    numbers[t] = is_large ? 2 * first_of_flat[patch] : 2 * first_of_rest[rest.of_face(t)] + 1;
  }
  return numbers;
}

/// Returns the distance of a point from one, two or three others: from the point, the line or the plane through them.
double distance_from(const std::vector<Vec3d>& others, const Vec3d& point) {
  const Vec3d way = point - others[0];
  if (others.size() == 1) return length(way);
  const Vec3d along = others[1] - others[0];
  if (others.size() == 2) return length(cross(along, way)) / length(along);
  const Vec3d normal = cross(along, others[2] - others[0]);
  return std::abs(dot(normal, way)) / length(normal);
}

}  // namespace

void PatchNumbers::add(const PatchedMesh& part, const SiteTable& own, const Context& context) {
  const std::vector<std::uint32_t> of_face = numbers_of_faces(part, own, context);
  std::vector<std::uint32_t> of_own(own.size(), none);
  std::vector<bool> is_shared(own.size(), false);
  const auto offer = [&](SiteId site, std::uint32_t number) {
    std::uint32_t& known = of_own[site.value];
    if (number == none || number == known) return;
    if (known != none) is_shared[site.value] = true;
    known = std::min(known, number);
  };
  for (std::uint32_t t = 0; t < of_face.size(); ++t) {
    offer(own.id({SiteKind::face, t}), of_face[t]);
    for (const std::uint32_t v : part.mesh.triangles[t]) offer(own.id({SiteKind::vertex, v}), of_face[t]);
    for (const EdgeId e : own.triangle_edges()[t]) {
      if (e != EdgeId::none()) offer(own.id({SiteKind::edge, e.value}), of_face[t]);
    }
  }
  for (std::uint32_t site = 0; site < of_own.size(); ++site) {
    // A site without triangles may have no counterpart in the input.
    if (of_own[site] == none) continue;
    const std::size_t to = part.input_site(SiteId(site)).value;
    number_of_[to] = std::min(number_of_[to], of_own[site]);
    if (is_shared[site]) is_shared_[to] = true;
  }
  for (std::uint32_t v = 0; v < part.vertex_of.size(); ++v) {
    const bool is_used = of_own[v] != none;
    if (is_used && part.vertex_of[v] != PatchedMesh::no_vertex) {
      vertices_.emplace_back(part.vertex_of[v], part.mesh.vertices[v]);
    }
  }
}

void PatchNumbers::choose_anchors() {
  std::sort(vertices_.begin(), vertices_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [id, at] : vertices_) reach_ = std::max(reach_, length(at - vertices_.front().second));
  for (const auto& [id, at] : vertices_) {
    if (anchors_.empty() || (anchors_.size() < 4 && distance_from(anchors_, at) > apart * reach_)) {
      anchors_.push_back(at);
    }
  }
  vertices_ = {};
}

}  // namespace blum::detail
