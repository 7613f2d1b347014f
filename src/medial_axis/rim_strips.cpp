#include "medial_axis/rim_strips.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace blum {
namespace {

constexpr double least_cosine = 0.174;  // of 80 degrees
constexpr std::uint32_t first_of_line = 2;

const Vec3d& point(const StripOutline& outline, std::uint32_t number) {
  return number < first_of_line ? outline.rim[number] : outline.line[number - first_of_line];
}

/// How good a triangle is: its area seen along the normal by the square of its longest side; -1 where it is turned too
/// far.
double quality(const StripOutline& outline, const std::array<std::uint32_t, 3>& triangle) {
  const Vec3d& a = point(outline, triangle[0]);
  const Vec3d& b = point(outline, triangle[1]);
  const Vec3d& c = point(outline, triangle[2]);
  const Vec3d normal = cross(b - a, c - a);
  const double along = dot(normal, outline.normal);
  if (!(along > least_cosine * length(normal))) return -1;
  return along / std::max({squared_length(b - a), squared_length(c - b), squared_length(a - c)});
}

/// The triangle at the rim has line[k] as its tip; the others fan out from the rim's ends on both sides.
std::vector<std::array<std::uint32_t, 3>> fans(std::uint32_t line_points, std::uint32_t k) {
  std::vector<std::array<std::uint32_t, 3>> triangles{{1, 0, first_of_line + k}};
  for (std::uint32_t p = 0; p + 1 < line_points; ++p) {
    triangles.push_back({p < k ? 0U : 1U, first_of_line + p, first_of_line + p + 1});
  }
  return triangles;
}

}  // namespace

std::optional<std::vector<std::array<std::uint32_t, 3>>> fill_strip(const StripOutline& outline) {
  const auto line_points = static_cast<std::uint32_t>(outline.line.size());
  std::optional<std::vector<std::array<std::uint32_t, 3>>> best;
  double best_quality = 0;
  for (std::uint32_t k = 0; k < line_points; ++k) {
    std::vector<std::array<std::uint32_t, 3>> triangles = fans(line_points, k);
    double worst = std::numeric_limits<double>::infinity();
    for (const auto& triangle : triangles) worst = std::min(worst, quality(outline, triangle));
    if (worst <= best_quality) continue;
    best_quality = worst;
    best = std::move(triangles);
  }
  return best;
}

bool is_strip_inside(const StripOutline& outline, std::span<const std::array<std::uint32_t, 3>> triangles,
                     FunctionRef<bool(const Vec3d&)> is_inside) {
  for (const auto& triangle : triangles) {
    Vec3d sum{};
    for (const std::uint32_t number : triangle) sum += point(outline, number);
    if (!is_inside(sum / 3.0)) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[k];
      const std::uint32_t b = triangle[(k + 1) % 3];
      const bool is_border = a >= first_of_line && b >= first_of_line;
      if (!is_border && !is_inside((point(outline, a) + point(outline, b)) * 0.5)) return false;
    }
  }
  return true;
}

}  // namespace blum
