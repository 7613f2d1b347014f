#include "solid/clean/step_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "blum/core/union_find.hpp"
#include "blum/geometry/orient3d.hpp"
#include "blum/geometry/space_order.hpp"
#include "blum/geometry/triangle_contact.hpp"

namespace blum::detail {
namespace {

double magnitude(const Vec3d& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

ContactTriangle for_contact(const ShrinkingSurface& mesh, const Triangle& t) {
  return {{mesh.point(t[0]), mesh.point(t[1]), mesh.point(t[2])}, t};
}

/// Whether all of `b` but corners of an edge of `a` lies certainly beyond that edge, seen in a's plane. The function
/// det(edge, n, x - corner) is 0 at both ends of the edge whatever n is, so that the rest of `a` on one side and the
/// rest of `b` on the other leaves nothing in common but these ends. Answers nearly all pairs of neighbours in a plane,
/// where signs of determinants take long.
bool lies_beyond_an_edge(const ContactTriangle& a, const ContactTriangle& b) {
  constexpr double rounding = 1e-14;
  const Vec3d normal = cross(a.points[1] - a.points[0], a.points[2] - a.points[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& from = a.points[k];
    const std::size_t next = (k + 1) % 3;
    const Vec3d edge = a.points[next] - from;
    const Vec3d outwards = cross(edge, normal);
    const double error = rounding * magnitude(edge) * magnitude(normal);
    const auto side = [&](const Vec3d& p) {
      const Vec3d way = p - from;
      const double value = dot(outwards, way);
      const double uncertain = error * magnitude(way);
      return value > uncertain ? 1 : value < -uncertain ? -1 : 0;
    };
    if (side(a.points[(k + 2) % 3]) >= 0) continue;
    bool beyond = true;
    for (std::size_t j = 0; j < 3 && beyond; ++j) {
      const bool is_end = b.corners[j] == a.corners[k] || b.corners[j] == a.corners[next];
      beyond = is_end || side(b.points[j]) > 0;
    }
    if (beyond) return true;
  }
  return false;
}

bool are_apart(const ContactTriangle& a, const ContactTriangle& b) {
  return lies_beyond_an_edge(a, b) || lies_beyond_an_edge(b, a) || contact(a, b) == Contact::none;
}

/// Whether a point lies in a closed tetrahedron that has a volume.
bool holds(const std::array<Vec3d, 4>& corners, const Vec3d& p) {
  const int way = orient3d(corners[0], corners[1], corners[2], corners[3]);
  if (way == 0) return false;
  for (std::size_t k = 0; k < 4; ++k) {
    std::array<Vec3d, 4> with = corners;
    with[k] = p;
    if (way * orient3d(with[0], with[1], with[2], with[3]) < 0) return false;
  }
  return true;
}

std::vector<Box3> boxes_of(const ShrinkingSurface& mesh) {
  std::vector<Box3> out(mesh.triangles().size());
  for (std::uint32_t t = 0; t < out.size(); ++t) {
    if (mesh.is_gone(t)) continue;
    for (const Vec3d& p : mesh.corners(t)) out[t].extend(p);
  }
  return out;
}

/// The shell of each vertex; empty where there is but one.
std::vector<std::uint32_t> shells_of(const ShrinkingSurface& mesh) {
  std::uint32_t vertices = 0;
  for (const Triangle& t : mesh.triangles()) vertices = std::max({vertices, t[0] + 1, t[1] + 1, t[2] + 1});
  UnionFind joined(vertices);
  for (const Triangle& t : mesh.triangles()) {
    joined.join(t[0], t[1]);
    joined.join(t[1], t[2]);
  }
  std::vector<std::uint32_t> out(vertices);
  for (std::uint32_t v = 0; v < vertices; ++v) out[v] = joined.find(v);
  const std::uint32_t first = out[mesh.triangle(0)[0]];
  const bool is_one = std::all_of(mesh.triangles().begin(), mesh.triangles().end(),
                                  [&](const Triangle& t) { return out[t[0]] == first; });
  return is_one ? std::vector<std::uint32_t>() : out;
}

}  // namespace

TriangleBoxes::TriangleBoxes(std::span<const Box3> boxes, const Context& context) : leaf_of_(boxes.size()) {
  std::vector<std::uint32_t> there;
  for (std::uint32_t k = 0; k < boxes.size(); ++k) {
    if (!boxes[k].is_empty()) there.push_back(k);
  }
  at_leaf_ = space_order(there.size(), [&](std::size_t k) { return boxes[there[k]].center(); }, context);
  while (leaves_ < there.size()) leaves_ *= 2;
  nodes_.resize(2 * leaves_);
  for (std::uint32_t leaf = 0; leaf < at_leaf_.size(); ++leaf) {
    at_leaf_[leaf] = there[at_leaf_[leaf]];
    leaf_of_[at_leaf_[leaf]] = leaf;
    nodes_[leaves_ + leaf] = boxes[at_leaf_[leaf]];
  }
  for (std::size_t node = leaves_ - 1; node > 0; --node) {
    nodes_[node] = nodes_[2 * node];
    nodes_[node].extend(nodes_[2 * node + 1]);
  }
}

void TriangleBoxes::replace(std::uint32_t index, const Box3& box) {
  std::size_t node = leaves_ + leaf_of_[index];
  nodes_[node] = box;
  for (node /= 2; node > 0; node /= 2) {
    Box3 around = nodes_[2 * node];
    around.extend(nodes_[2 * node + 1]);
    if (around.lower == nodes_[node].lower && around.upper == nodes_[node].upper) return;
    nodes_[node] = around;
  }
}

StepCheck::StepCheck(const ShrinkingSurface& mesh, const Context& context)
    : mesh_(mesh),
      context_(context),
      boxes_(boxes_of(mesh), context),
      triangles_at_build_(mesh.triangles_left()),
      shell_of_(shells_of(mesh)),
      mark_(mesh.triangles().size(), 0) {
  context_.progress = {};
}

Box3 StepCheck::box_of(std::uint32_t t) const {
  Box3 box;
  if (mesh_.is_gone(t)) return box;
  for (const Vec3d& p : mesh_.corners(t)) box.extend(p);
  return box;
}

void StepCheck::update(std::span<const std::uint32_t> triangles) {
  for (const std::uint32_t t : triangles) boxes_.replace(t, box_of(t));
  // Triangles grow while others go: an order of those that are left keeps questions short.
  if (2 * mesh_.triangles_left() > triangles_at_build_) return;
  boxes_ = TriangleBoxes(boxes_of(mesh_), context_);
  triangles_at_build_ = mesh_.triangles_left();
}

bool StepCheck::is_clear(const Triangle& triangle) const {
  const ContactTriangle own = for_contact(mesh_, triangle);
  Box3 box;
  for (const Vec3d& p : own.points) box.extend(p);
  return boxes_.for_each_touching(box, [&](std::uint32_t other) {
    return mark_[other] == current_ || are_apart(own, for_contact(mesh_, mesh_.triangle(other)));
  });
}

/// Whether a triangle turns about an edge past the one on its other side: then the solid would be where it is not now.
bool StepCheck::turns_over_a_neighbour(const BorderEdge& edge) const {
  const Vec3d& a = mesh_.point(edge.a);
  const Vec3d& b = mesh_.point(edge.b);
  const Vec3d& from = mesh_.point(edge.old_apex);
  const Vec3d& to = mesh_.point(edge.new_apex);
  const Vec3d& outer = mesh_.point(edge.outer_apex);
  const int way = orient3d(a, b, from, to);
  return way != 0 && orient3d(a, b, from, outer) == way && orient3d(a, b, outer, to) == way;
}

bool StepCheck::jumps_over_a_shell(const SurfaceStep& step) const {
  if (shell_of_.empty()) return false;
  const std::uint32_t own = shell_of_[step.new_triangles.front()[0]];
  for (const std::array<std::uint32_t, 4>& swept : step.swept) {
    std::array<Vec3d, 4> corners;
    Box3 box;
    for (std::size_t k = 0; k < 4; ++k) {
      corners[k] = mesh_.point(swept[k]);
      box.extend(corners[k]);
    }
    const bool none = boxes_.for_each_touching(box, [&](std::uint32_t other) {
      const Triangle& t = mesh_.triangle(other);
      return shell_of_[t[0]] == own || !(holds(corners, mesh_.point(t[0])) || holds(corners, mesh_.point(t[1])) ||
                                         holds(corners, mesh_.point(t[2])));
    });
    if (!none) return true;
  }
  return false;
}

bool StepCheck::passes(const SurfaceStep& step) {
  ++current_;
  for (const std::uint32_t t : step.old_triangles) mark_[t] = current_;
  for (const Triangle& t : step.new_triangles) {
    if (has_no_area({mesh_.point(t[0]), mesh_.point(t[1]), mesh_.point(t[2])})) return false;
  }
  for (const BorderEdge& edge : step.border) {
    if (turns_over_a_neighbour(edge)) return false;
  }
  for (std::size_t i = 0; i < step.new_triangles.size(); ++i) {
    const ContactTriangle own = for_contact(mesh_, step.new_triangles[i]);
    for (std::size_t j = i + 1; j < step.new_triangles.size(); ++j) {
      if (!are_apart(own, for_contact(mesh_, step.new_triangles[j]))) return false;
    }
  }
  for (const Triangle& t : step.new_triangles) {
    if (!is_clear(t)) return false;
  }
  return !jumps_over_a_shell(step);
}

}  // namespace blum::detail
