#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "medial_axis/certificate/shells.hpp"
#include "medial_axis/certificate/solid.hpp"
#include "medial_axis/certificate/triangle_search.hpp"

namespace blum::verifier {
namespace {

using Corners = std::array<Vec3d, 3>;

double area(const Corners& t) {
  return 0.5 * length(cross(t[1] - t[0], t[2] - t[0]));
}

/// Halves a triangle across its longest side until no side is longer than the step, and calls use(piece).
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
    stack.push_back({a, middle, c});
    stack.push_back({middle, b, c});
  }
}

/// Triangles to take samples of.
class SampledTriangles {
 public:
  SampledTriangles(std::vector<Corners> triangles, const Context& context)
      : triangles_(std::move(triangles)), context_(context) {}

  /// The step, or the smallest larger one, about, that needs few enough samples.
  [[nodiscard]] double affordable(double step) const {
    double total = 0;
    for (const Corners& t : triangles_) total += area(t);
    const std::size_t most = std::max(most_samples, triangles_.size());
    // No piece is larger than a triangle of three sides as long as the step.
    step = std::max(step, std::sqrt(total / (0.43 * static_cast<double>(most))));
    while (!is_affordable(step, most)) step *= 1.25;
    return step;
  }

  [[nodiscard]] std::vector<Sample> samples(double step) const {
    std::vector<Sample> list;
    for (const Corners& t : triangles_) {
      if (list.size() % 1024 == 0) throw_if_cancelled(context_);
      cut(t, step, [&](const Corners& piece) {
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
      if (count % 1024 == 0) throw_if_cancelled(context_);
      cut(t, step, [&](const Corners&) { return ++count <= most; });
      if (count > most) return false;
    }
    return true;
  }

  std::vector<Corners> triangles_;
  const Context& context_;
};

class MeshSolid : public Solid {
 public:
  MeshSolid(const MeshView& mesh, const ClosedShells& shells, const TriangleSearch& shell_search,
            const Context& context)
      : mesh_(mesh), shells_(shells), body_of_(shells.of_triangle) {
    for (std::uint32_t& group : body_of_) {
      if (group != no_group) group = shells_.shells[group].body;
    }
    search_ = shells_.shells.size() == 1 ? shell_search : TriangleSearch(mesh, body_of_, context);
  }

  [[nodiscard]] double diagonal() const override { return search_.bounds().diagonal(); }

  [[nodiscard]] Place locate(const Vec3d& p) const override {
    if (const std::optional<std::uint32_t> shell = innermost_around(p)) {
      const ClosedShell& around = shells_.shells[*shell];
      const double own = distance(p, around.body);
      return {around.body, own, around.depth % 2 == 0 ? 0 : own};
    }
    const TriangleSearch::Nearest nearest = search_.nearest(p);
    const std::uint32_t body = body_of_[nearest.triangle];
    return {body, nearest.distance, nearest.distance};
  }

  [[nodiscard]] double distance(const Vec3d& p, std::uint32_t body) const override {
    return search_.nearest(p, body).distance;
  }

  [[nodiscard]] Samples samples(double step, const Context& context) const override {
    std::vector<Corners> triangles;
    std::vector<bool> is_named(mesh_.vertices.size(), false);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (body_of_[t] == no_group) continue;
      Corners& corners = triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = mesh_.vertices[mesh_.triangles[t][k]];
        is_named[mesh_.triangles[t][k]] = true;
      }
    }
    const SampledTriangles sampled(std::move(triangles), context);
    step = sampled.affordable(step);
    Samples result{sampled.samples(step), step};
    // Corners are what balls fill last.
    for (std::size_t v = 0; v < is_named.size(); ++v) {
      if (is_named[v]) result.list.push_back({mesh_.vertices[v], 0});
    }
    return result;
  }

 private:
  /// The innermost shell around a point; nullopt where there is none, or the point lies on the surface.
  [[nodiscard]] std::optional<std::uint32_t> innermost_around(const Vec3d& p) const {
    constexpr std::uint32_t most_lines = 24;
    const double nothing = 1e-13 * diagonal();
    std::vector<Crossing> crossings;
    std::vector<std::uint32_t> ahead;
    std::vector<std::uint32_t> all;
    for (std::uint32_t attempt = 0; attempt < most_lines; ++attempt) {
      if (!search_.crossings(line_through(p, attempt), crossings)) continue;
      ahead.clear();
      all.clear();
      bool is_certain = true;
      for (const Crossing& crossing : crossings) {
        is_certain = is_certain && std::abs(crossing.at) > nothing;
        const std::uint32_t shell = shells_.of_triangle[crossing.triangle];
        all.push_back(shell);
        if (crossing.at > 0) ahead.push_back(shell);
      }
      if (!is_certain || !odd_ones(all).empty()) continue;
      std::optional<std::uint32_t> innermost;
      for (const std::uint32_t shell : odd_ones(ahead)) {
        if (!innermost || shells_.shells[shell].depth > shells_.shells[*innermost].depth) innermost = shell;
      }
      return innermost;
    }
    return std::nullopt;
  }

  /// Those that are named an odd number of times.
  static std::vector<std::uint32_t> odd_ones(std::vector<std::uint32_t>& shells) {
    std::sort(shells.begin(), shells.end());
    std::vector<std::uint32_t> odd;
    for (const std::uint32_t shell : shells) {
      if (!odd.empty() && odd.back() == shell) {
        odd.pop_back();
      } else {
        odd.push_back(shell);
      }
    }
    return odd;
  }

  MeshView mesh_;
  ClosedShells shells_;
  std::vector<std::uint32_t> body_of_;  ///< of each triangle
  TriangleSearch search_;               ///< bodies are its groups
};

}  // namespace

KnownSolid solid_of_mesh(const MeshView& mesh, const Context& context) {
  ClosedShells shells = find_shells(mesh, context);
  const TriangleSearch search(mesh, shells.of_triangle, context);
  nest(shells, mesh, search, context);
  const BettiNumbers betti = betti_numbers(shells);
  return {std::make_unique<MeshSolid>(mesh, shells, search, context), betti};
}

}  // namespace blum::verifier
