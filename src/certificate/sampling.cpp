#include "certificate/sampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "certificate/triangle_search.hpp"

namespace blum::verifier {
namespace {

using Corners = std::array<Vec3d, 3>;

double area(const Corners& t) {
  return 0.5 * length(cross(t[1] - t[0], t[2] - t[0]));
}

/// Halves a triangle across its longest side until no side is longer than `step`, or doubles cannot distinguish the
/// halves. Calls use(piece) for each piece, and stops when use() returns false.
template <class Use>
void cut(const Corners& whole, double step, const Use& use) {
  std::vector<Corners> stack{whole};
  while (!stack.empty()) {
    const Corners piece = stack.back();
    stack.pop_back();
    std::size_t longest = 0;
    std::array<double, 3> sides{};
    for (std::size_t k = 0; k < 3; ++k) {
      sides[k] = length(piece[(k + 1) % 3] - piece[k]);
      if (sides[k] > sides[longest]) longest = k;
    }
    if (sides[longest] <= step) {
      if (!use(piece)) return;
      continue;
    }
    const Vec3d& a = piece[longest];
    const Vec3d& b = piece[(longest + 1) % 3];
    const Vec3d& c = piece[(longest + 2) % 3];
    const Vec3d middle = (a + b) * 0.5;
    if (middle == a || middle == b) {
      if (!use(piece)) return;
      continue;
    }
    stack.push_back({a, middle, c});
    stack.push_back({middle, b, c});
  }
}

/// Triangles to sample.
class SampledTriangles {
 public:
  SampledTriangles(std::vector<Corners> triangles, const Context& context)
      : triangles_(std::move(triangles)), context_(context) {}

  /// Returns `step` if it needs few enough samples, otherwise about the smallest larger step that does.
  [[nodiscard]] double affordable(double step) const {
    double total = 0;
    for (const Corners& t : triangles_) total += area(t);
    const std::size_t most = std::max(most_samples, triangles_.size());
    // No piece is larger than an equilateral triangle with `step` as its side.
    step = std::max(step, std::sqrt(total / (0.43 * static_cast<double>(most))));
    while (!is_affordable(step, most)) step *= 1.25;
    return step;
  }

  [[nodiscard]] std::vector<Sample> samples(double step) const {
    std::vector<Sample> list;
    for (const Corners& t : triangles_) {
      cut(t, step, [&](const Corners& piece) {
        if (list.size() % 1024 == 0) throw_if_cancelled(context_);
        list.push_back({(piece[0] + piece[1] + piece[2]) / 3.0, area(piece)});
        return true;
      });
    }
    return list;
  }

 private:
  [[nodiscard]] bool is_affordable(double step, std::size_t most) const {
    std::size_t count = 0;
    for (const Corners& t : triangles_) {
      cut(t, step, [&](const Corners&) {
        if (count % 1024 == 0) throw_if_cancelled(context_);
        return ++count <= most;
      });
      if (count > most) return false;
    }
    return true;
  }

  std::vector<Corners> triangles_;
  const Context& context_;
};

}  // namespace

Samples samples_of_triangles(const MeshView& mesh, std::span<const std::uint32_t> groups, double step,
                             const Context& context) {
  std::vector<Corners> triangles;
  std::vector<bool> is_named(mesh.vertices.size(), false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!groups.empty() && groups[t] == no_group) continue;
    Corners& corners = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = mesh.vertices[mesh.triangles[t][k]];
      is_named[mesh.triangles[t][k]] = true;
    }
  }
  const SampledTriangles sampled(std::move(triangles), context);
  step = sampled.affordable(step);
  Samples result{sampled.samples(step), step};
  // Balls reach corners last, so corners are samples, too.
  for (std::size_t v = 0; v < is_named.size(); ++v) {
    if (is_named[v]) result.list.push_back({mesh.vertices[v], 0});
  }
  return result;
}

}  // namespace blum::verifier
