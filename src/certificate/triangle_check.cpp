#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "certificate/allowances.hpp"
#include "certificate/body_edges.hpp"
#include "certificate/checks.hpp"

namespace blum::verifier {
namespace {

using Piece = std::array<Stop, 3>;

/// Largest number of points tested in one triangle. In extremely thin walls, no number would suffice. So after
/// `few_points`, an estimate decides if the others would.
constexpr std::size_t most_points = 512;
constexpr std::size_t few_points = 64;

/// Findings about some of the triangles.
struct Findings {
  TriangleCheck check;

  void add(const Findings& other) {
    check.leaving += other.check.leaving;
    check.outside += other.check.outside;
    check.undecided += other.check.undecided;
    if (!(other.check.outside_by > check.outside_by)) return;
    check.outside_by = other.check.outside_by;
    check.where = other.check.where;
  }
};

/// Returns true if the balls around the corners, with the corners' depths as radii, cover a piece up to `allowed`. The
/// balls of both ends of each side must meet, and all three balls must contain the centre. Balls are convex, so they
/// then contain the six parts of the piece that have the centre as a corner.
bool covers(const Piece& piece, double allowed) {
  const Vec3d centre = (piece[0].at + piece[1].at + piece[2].at) / 3.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Stop& a = piece[k];
    const Stop& b = piece[(k + 1) % 3];
    if (a.depth + allowed < length(a.at - centre)) return false;
    if (a.depth + b.depth + 2 * allowed < length(a.at - b.at)) return false;
  }
  return true;
}

/// Returns true if one ball covers a piece up to `allowed`.
bool covers(const Stop& ball, const Piece& piece, double allowed) {
  return std::all_of(piece.begin(), piece.end(),
                     [&](const Stop& corner) { return length(corner.at - ball.at) <= ball.depth + allowed; });
}

class TriangleInBody {
 public:
  TriangleInBody(const SolidOracle& solid, std::uint32_t body, double allowed)
      : solid_(solid), body_(body), allowed_(allowed) {}

  /// Returns the approximate point that is furthest outside. Sets `is_undecided` if too many points would be needed.
  [[nodiscard]] Stop furthest_out(const Piece& triangle, bool& is_undecided) const {
    constexpr double nearly = 1.25;  // only points that may be further out by this factor are searched
    Stop worst = *std::min_element(triangle.begin(), triangle.end(),
                                   [](const Stop& a, const Stop& b) { return a.depth < b.depth; });
    // A sliver coincides with its sides, which are checked as edges.
    if (is_sliver(triangle)) return worst;
    // In thin walls many balls would be needed, so the triangle is first tested against the boundary.
    if (is_clear(triangle, worst)) return worst;
    const std::size_t most = points_for(triangle);
    std::vector<Piece> stack{triangle};
    std::size_t points = 0;
    double covered = 0;  // covered area
    while (!stack.empty()) {
      const Piece piece = stack.back();
      stack.pop_back();
      const double enough = std::max(allowed_, -nearly * worst.depth);
      if (covers(piece, enough)) {
        covered += area(piece);
        continue;
      }
      if (points >= most || (points >= few_points && is_too_slow(covered / area(triangle), points))) {
        is_undecided = true;
        return worst;
      }
      points += 2;
      const Stop centre = stop((piece[0].at + piece[1].at + piece[2].at) / 3.0);
      if (centre.depth < worst.depth) worst = centre;
      if (covers(centre, piece, std::max(allowed_, -nearly * worst.depth))) {
        covered += area(piece);
        continue;
      }
      halve(piece, worst, stack);
    }
    return worst;
  }

 private:
  [[nodiscard]] Stop stop(const Vec3d& at) const { return {at, solid_.depth(at, body_)}; }

  /// Returns true if a triangle is known to leave the body by less than `allowed`, since the boundary does not pass
  /// through it. If corners lie on the boundary, a slightly smaller triangle is tested. Each point of the triangle is
  /// close to a point of the smaller one.
  /// @param worst  the least deep corner.
  [[nodiscard]] bool is_clear(const Piece& triangle, const Stop& worst) const {
    const auto& [a, b, c] = std::array{triangle[0].at, triangle[1].at, triangle[2].at};
    if (worst.depth > 0) return solid_.is_clear({a, b, c}, body_);
    const double closer = 0.5 * allowed_;
    if (worst.depth < -closer) return false;
    const Vec3d centre = (a + b + c) / 3.0;
    const double far = std::max({length(a - centre), length(b - centre), length(c - centre)});
    if (!(closer < 0.5 * far)) return false;
    const double share = closer / far;
    const auto moved = [&](const Vec3d& corner) { return corner + (centre - corner) * share; };
    return solid_.is_clear({moved(a), moved(b), moved(c)}, body_) && stop(centre).depth > 0;
  }
  [[nodiscard]] static double area(const Piece& piece) {
    return 0.5 * length(cross(piece[1].at - piece[0].at, piece[2].at - piece[0].at));
  }
  [[nodiscard]] bool is_sliver(const Piece& triangle) const {
    constexpr double thin = 1e-3;
    const double longest = std::sqrt(std::max({side(triangle, 0), side(triangle, 1), side(triangle, 2)}));
    return 2 * area(triangle) <= thin * allowed_ * longest;
  }

  /// Returns true if balls at all `most_points` points would cover less than a quarter of a triangle, judged by the
  /// area covered so far.
  /// @param covered  covered share of the triangle's area.
  [[nodiscard]] static bool is_too_slow(double covered, std::size_t points) {
    return 4 * covered * static_cast<double>(most_points) < static_cast<double>(points);
  }

  /// Returns `few_points` if far too many balls as large as those of the corners would be needed to cover a triangle.
  /// Few points still find parts that lie well outside. A part that is not halved further has at most the area of a
  /// ball's radius squared.
  [[nodiscard]] std::size_t points_for(const Piece& triangle) const {
    const double deepest = std::max({triangle[0].depth, triangle[1].depth, triangle[2].depth}) + allowed_;
    const bool is_hopeless = area(triangle) > 0.5 * static_cast<double>(most_points) * deepest * deepest;
    return is_hopeless ? few_points : most_points;
  }

  /// Halves a piece across its longest side, if doubles can distinguish the halves.
  void halve(const Piece& piece, Stop& worst, std::vector<Piece>& stack) const {
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (side(piece, k) > side(piece, longest)) longest = k;
    }
    const Stop& a = piece[longest];
    const Stop& b = piece[(longest + 1) % 3];
    const Stop& c = piece[(longest + 2) % 3];
    const Stop middle = stop((a.at + b.at) * 0.5);
    if (middle.at == a.at || middle.at == b.at) return;
    if (middle.depth < worst.depth) worst = middle;
    stack.push_back({a, middle, c});
    stack.push_back({middle, b, c});
  }
  [[nodiscard]] static double side(const Piece& piece, std::size_t k) {
    return squared_length(piece[(k + 1) % 3].at - piece[k].at);
  }

  const SolidOracle& solid_;
  std::uint32_t body_;
  double allowed_;
};

/// Checks one triangle.
/// @param most  largest distance by which the triangle may leave the solid.
Findings look_at(const Piece& corners, const TriangleInBody& body, double allowed, double most) {
  Findings found;
  bool is_undecided = false;
  const Stop worst = body.furthest_out(corners, is_undecided);
  const double out = -worst.depth;
  if (out > allowed) {
    found.check.leaving = 1;
    found.check.outside = out > most ? 1 : 0;
    found.check.outside_by = out;
    found.check.where = worst.at;
  } else if (is_undecided) {
    found.check.undecided = 1;
  }
  return found;
}

}  // namespace

TriangleCheck check_triangles(const MedialView& axis, const KnownSolid& solid, const std::vector<Location>& locations,
                              const AxisParts& parts, const CertificateOptions& options, double factor,
                              std::vector<std::string>& mismatches, const Context& context) {
  constexpr std::size_t grain = 256;
  const SolidOracle& oracle = *solid.solid;
  const double moved = believed_deviation(solid, options, factor);
  std::vector<double> allowed = tolerances(solid);
  std::vector<double> most(allowed.size());
  for (std::uint32_t b = 0; b < allowed.size(); ++b) {
    allowed[b] = more_for_edges * allowed[b] + oracle.slack();
    most[b] = BodyEdges(oracle, b, allowed[b]).corner() + allowed[b] + moved;
  }
  std::vector<Findings> found(axis.triangles.size() / grain + 1);
  parallel_for(context, axis.triangles.size(), grain, "checking triangles", [&](const WorkRange& range) {
    for (std::size_t t = range.begin; t < range.end; ++t) {
      const std::uint32_t body = parts.body_of[axis.triangles[t][0]];
      Piece corners;
      bool is_known = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = axis.triangles[t][k];
        const Vec3d& at = axis.positions[v];
        is_known = is_known && is_finite(at);
        if (is_known) corners[k] = {at, locations[v].body == body ? locations[v].depth : oracle.depth(at, body)};
      }
      if (!is_known || covers(corners, allowed[body])) continue;
      found[range.begin / grain].add(
          look_at(corners, TriangleInBody(oracle, body, allowed[body]), allowed[body], most[body]));
    }
  });
  Findings all;
  for (const Findings& part : found) all.add(part);
  TriangleCheck check = all.check;
  check.triangles = axis.triangles.size();
  check.outside_by /= factor;
  check.where = check.where / factor;
  check.tolerance = *std::max_element(allowed.begin(), allowed.end()) / factor;
  check.allowance = *std::max_element(most.begin(), most.end()) / factor;
  check.holds = check.outside == 0;
  if (!check.holds) {
    mismatches.push_back(count_text(check.outside) + " triangles leave the solid between their edges, by up to " +
                         rounded_text(check.outside_by) + " at " + place_text(check.where) +
                         " (allowed: " + rounded_text(check.allowance) + ")");
  }
  return check;
}

}  // namespace blum::verifier
