#include "shapes/generator_parts.hpp"

#include <cmath>

#include "blum/core/error.hpp"

namespace blum::detail {
namespace {

constexpr double largest_triangle_count = 50e6;

std::string to_text(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (!text.empty() && text.back() == '.') text.pop_back();
  return text;
}

void add_ring_band(TriangleMesh& mesh, std::uint32_t lower, std::uint32_t upper, std::uint32_t sides) {
  for (std::uint32_t k = 0; k < sides; ++k) {
    const std::uint32_t next = k + 1 == sides ? 0 : k + 1;
    add_quad(mesh, lower + k, lower + next, upper + next, upper + k);
  }
}

}  // namespace

void require(bool holds, const char* what, const char* rule, double value) {
  if (!holds) throw InvalidOption(std::string(what) + " must be " + rule + ", not " + to_text(value));
}

void require_positive(double value, const char* what) {
  require(value > 0 && value <= 1e100, what, "above 0 and at most 1e100", value);
}

void require_at_least(double value, double minimum, const char* what) {
  if (!(value >= minimum)) require(false, what, ("at least " + to_text(minimum)).c_str(), value);
}

void require_triangle_count(double count) {
  require(count <= largest_triangle_count, "the number of triangles", "at most 50 million; choose a coarser shape",
          count);
}

void add_quad(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

TriangleMesh loft(const Vec3d& first_pole, std::span<const Ring> rings, const Vec3d& last_pole) {
  TriangleMesh mesh;
  const auto sides = static_cast<std::uint32_t>(rings.front().points.size());
  mesh.vertices.push_back(first_pole);
  for (const Ring& ring : rings) mesh.vertices.insert(mesh.vertices.end(), ring.points.begin(), ring.points.end());
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(last_pole);
  for (std::uint32_t k = 0; k < sides; ++k) {
    const std::uint32_t next = k + 1 == sides ? 0 : k + 1;
    mesh.triangles.push_back({0, 1 + next, 1 + k});
  }
  for (std::uint32_t ring = 1; ring < rings.size(); ++ring) {
    add_ring_band(mesh, 1 + (ring - 1) * sides, 1 + ring * sides, sides);
  }
  for (std::uint32_t k = 0; k < sides; ++k) {
    const std::uint32_t next = k + 1 == sides ? 0 : k + 1;
    mesh.triangles.push_back({last, last - sides + k, last - sides + next});
  }
  return mesh;
}

TriangleMesh closed_loft(std::span<const Ring> rings) {
  TriangleMesh mesh;
  const auto sides = static_cast<std::uint32_t>(rings.front().points.size());
  for (const Ring& ring : rings) mesh.vertices.insert(mesh.vertices.end(), ring.points.begin(), ring.points.end());
  for (std::uint32_t ring = 0; ring < rings.size(); ++ring) {
    const std::uint32_t next = ring + 1 == rings.size() ? 0 : ring + 1;
    add_ring_band(mesh, ring * sides, next * sides, sides);
  }
  return mesh;
}

TriangleMesh revolve(std::span<const std::array<double, 2>> profile, double first_z, double last_z, int sides) {
  const auto unit = circle(0, 0, 1, sides);
  std::vector<Ring> rings;
  for (const auto& [radius, z] : profile) {
    Ring& ring = rings.emplace_back();
    for (const auto& [x, y] : unit) ring.points.push_back({radius * x, radius * y, z});
  }
  return loft({0, 0, first_z}, rings, {0, 0, last_z});
}

std::vector<std::array<double, 2>> circle(double x, double y, double radius, int sides, double phase) {
  std::vector<std::array<double, 2>> points;
  for (int k = 0; k < sides; ++k) {
    const double angle = phase + 2 * pi * k / sides;
    points.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
  }
  return points;
}

}  // namespace blum::detail
