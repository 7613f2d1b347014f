#include "solid/clean/mesh_cleaner.hpp"

#include <algorithm>
#include <limits>

#include "blum/core/parallel.hpp"

namespace blum::detail {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t looks_between_reports = 256;
constexpr std::size_t vertices_per_range = 256;
/// Vertices with more triangles are looked at again only when this part of them has changed: one look at the middle of
/// a disc takes as long as its triangles are many, and each of these changes in turn.
constexpr std::size_t many_triangles = 64;
constexpr std::size_t part_to_change = 8;

std::vector<double> heights_of(const ShrinkingSurface& mesh) {
  std::vector<double> out(mesh.triangles().size());
  for (std::uint32_t t = 0; t < out.size(); ++t) {
    const std::array<Vec3d, 3> p = mesh.corners(t);
    out[t] = least_height(p[0], p[1], p[2]);
  }
  return out;
}

}  // namespace

MeshCleaner::MeshCleaner(const MeshView& mesh, double tolerance, const Context& context)
    : mesh_(mesh),
      tolerance_(tolerance),
      context_(context),
      check_(mesh_, context),
      deviations_(mesh.triangles.size(), 0.0),
      heights_(heights_of(mesh_)),
      search_(mesh_, deviations_, tolerance),
      vertex_versions_(mesh.vertices.size(), 0),
      triangle_versions_(mesh.triangles.size(), 0),
      changes_(mesh.vertices.size(), 0) {}

double MeshCleaner::deviation() const {
  double most = 0;
  for (std::uint32_t t = 0; t < deviations_.size(); ++t) {
    if (!mesh_.is_gone(t)) most = std::max(most, deviations_[t]);
  }
  return most;
}

void MeshCleaner::fill_line() {
  std::vector<double> costs(vertex_versions_.size(), infinity);
  parallel_for(context_, costs.size(), vertices_per_range, "vertices", [&](const WorkRange& range) {
    CollapseSearch search(mesh_, deviations_, tolerance_);
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const std::span<const VertexCollapse> ways = search.find(static_cast<std::uint32_t>(k));
      if (!ways.empty()) costs[k] = ways.front().cost;
    }
  });
  std::vector<Waiting> all;
  for (std::uint32_t v = 0; v < costs.size(); ++v) {
    if (costs[v] < infinity) all.push_back({costs[v], Kind::collapse, v, 0});
  }
  line_ = Line({}, std::move(all));
  for (std::uint32_t t = 0; t < heights_.size(); ++t) offer_triangle(t);
}

void MeshCleaner::run() {
  fill_line();
  do {
    while (!line_.empty()) {
      report_progress();
      const Waiting first = line_.top();
      line_.pop();
      handle(first);
    }
  } while (offer_postponed());
  if (context_.progress) context_.progress(1, "steps");
}

void MeshCleaner::report_progress() {
  if (++looks_ % looks_between_reports != 0) return;
  throw_if_cancelled(context_);
  if (!context_.progress) return;
  const auto done = static_cast<double>(looks_);
  shown_ = std::max(shown_, done / (done + static_cast<double>(line_.size())));
  context_.progress(shown_, "steps");
}

void MeshCleaner::handle(const Waiting& first) {
  const std::uint32_t version =
      first.kind == Kind::collapse ? vertex_versions_[first.index] : triangle_versions_[first.index];
  if (first.version != version) return;
  if (first.kind == Kind::collapse) {
    try_vertex(first.index);
  } else {
    try_triangle(first.index);
  }
}

bool MeshCleaner::comes_later(double cost, Kind kind, std::uint32_t index) const {
  return !line_.empty() && Waiting{cost, kind, index, 0} > line_.top();
}

void MeshCleaner::try_vertex(std::uint32_t v) {
  if (mesh_.triangles_at(v).empty()) return;
  const std::span<const VertexCollapse> ways = search_.find(v);
  if (ways.empty()) return;
  if (comes_later(ways.front().cost, Kind::collapse, v)) {
    line_.push({ways.front().cost, Kind::collapse, v, vertex_versions_[v]});
    return;
  }
  for (const VertexCollapse& way : ways) {
    if (!passes(v, search_.star(), way)) continue;
    collapse(v, VertexCollapse(way));
    return;
  }
}

bool MeshCleaner::passes(std::uint32_t v, const Star& star, const VertexCollapse& way) {
  if (!mesh_.may_collapse(star, way.onto)) return false;
  const std::size_t count = star.ring.size();
  step_.old_triangles = star.triangles;
  step_.new_triangles.clear();
  step_.swept.clear();
  step_.border.clear();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t side = (way.onto + k) % count;
    const std::uint32_t a = star.ring[side];
    const std::uint32_t b = star.ring[(side + 1) % count];
    // Next to the target there is the apex of a new triangle further on.
    const std::uint32_t new_apex = k == 0           ? star.ring[(side + 2) % count]
                                   : k + 1 == count ? star.ring[(side + count - 1) % count]
                                                    : way.target;
    const std::uint32_t outer = mesh_.opposite_edge(star.triangles[side], v).apex_right;
    step_.border.push_back({a, b, v, new_apex, outer});
    if (k == 0 || k + 1 == count) continue;
    step_.new_triangles.push_back({way.target, a, b});
    step_.swept.push_back({v, way.target, a, b});
  }
  return check_.passes(step_);
}

void MeshCleaner::collapse(std::uint32_t v, const VertexCollapse& way) {
  const Star star = search_.star();
  mesh_.collapse(v, star, way.onto);
  ++vertex_versions_[v];
  ++collapses_;
  for (const std::uint32_t t : star.triangles) deviations_[t] = way.deviation;
  refresh(star.triangles, star.ring);
}

void MeshCleaner::try_triangle(std::uint32_t t) {
  if (mesh_.is_gone(t)) return;
  const EdgeFlip way = search_.find_flip(t);
  if (!way.is_possible) return;
  if (comes_later(way.cost, Kind::flip, t)) {
    line_.push({way.cost, Kind::flip, t, triangle_versions_[t]});
    return;
  }
  const EdgePair& e = way.edge;
  step_.old_triangles = {e.left, e.right};
  step_.new_triangles = {{e.apex_left, e.a, e.apex_right}, {e.apex_right, e.b, e.apex_left}};
  step_.swept = {{e.a, e.b, e.apex_left, e.apex_right}};
  const auto outer = [&](std::uint32_t of, std::uint32_t corner) { return mesh_.opposite_edge(of, corner).apex_right; };
  step_.border = {{e.apex_left, e.a, e.b, e.apex_right, outer(e.left, e.b)},
                  {e.b, e.apex_left, e.a, e.apex_right, outer(e.left, e.a)},
                  {e.a, e.apex_right, e.b, e.apex_left, outer(e.right, e.b)},
                  {e.apex_right, e.b, e.a, e.apex_left, outer(e.right, e.a)}};
  if (check_.passes(step_)) flip(way);
}

void MeshCleaner::flip(const EdgeFlip& way) {
  const EdgePair& e = way.edge;
  mesh_.flip(e);
  ++flips_;
  deviations_[e.left] = deviations_[e.right] = way.deviation;
  const std::array<std::uint32_t, 2> changed{e.left, e.right};
  const std::array<std::uint32_t, 4> corners{e.a, e.b, e.apex_left, e.apex_right};
  refresh(changed, corners);
}

/// Looks again at what a step has changed the surroundings of.
void MeshCleaner::refresh(std::span<const std::uint32_t> changed, std::span<const std::uint32_t> corners) {
  check_.update(changed);
  for (const std::uint32_t t : changed) {
    ++triangle_versions_[t];
    if (mesh_.is_gone(t)) continue;
    const std::array<Vec3d, 3> p = mesh_.corners(t);
    heights_[t] = least_height(p[0], p[1], p[2]);
  }
  for (const std::uint32_t t : changed) offer_triangle(t);
  for (const std::uint32_t v : corners) offer_changed(v);
}

bool MeshCleaner::has_many_triangles(std::uint32_t v) const {
  return mesh_.triangles_at(v).size() > many_triangles;
}

/// A vertex some of whose triangles have changed, and its triangles.
void MeshCleaner::offer_changed(std::uint32_t v) {
  if (has_many_triangles(v) && ++changes_[v] * part_to_change < mesh_.triangles_at(v).size()) return;
  offer_vertex(v);
  for (const std::uint32_t t : mesh_.triangles_at(v)) offer_triangle(t);
}

/// @return  whether there were any.
bool MeshCleaner::offer_postponed() {
  for (std::uint32_t v = 0; v < changes_.size(); ++v) {
    if (changes_[v] > 0 && !mesh_.triangles_at(v).empty()) offer_vertex(v);
  }
  return !line_.empty();
}

/// With what it costs at least: how far its triangles have moved.
void MeshCleaner::offer_vertex(std::uint32_t v) {
  changes_[v] = 0;
  double most = 0;
  for (const std::uint32_t t : mesh_.triangles_at(v)) most = std::max(most, deviations_[t]);
  line_.push({most / tolerance_, Kind::collapse, v, ++vertex_versions_[v]});
}

void MeshCleaner::offer_triangle(std::uint32_t t) {
  if (mesh_.is_gone(t) || heights_[t] >= tolerance_) return;
  line_.push({deviations_[t] / tolerance_, Kind::flip, t, ++triangle_versions_[t]});
}

}  // namespace blum::detail
