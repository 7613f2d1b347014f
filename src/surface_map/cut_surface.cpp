#include "surface_map/cut_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "blum/core/parallel.hpp"
#include "surface_map/triangle_sides.hpp"

namespace blum::surface {
namespace {

constexpr std::size_t triangles_per_range = 256;

class Cutter {
 public:
  /// @param size  greatest length of a side of a piece.
  explicit Cutter(double size) : squared_size_(size * size) {}

  void cut(const std::array<Vec3d, 3>& corners, std::vector<CutPiece>& out) const {
    const double area = length(cross(corners[1] - corners[0], corners[2] - corners[0])) / 2;
    if (area > 0) divide(corners, area, out);
  }

 private:
  void divide(const std::array<Vec3d, 3>& p, double area, std::vector<CutPiece>& out) const {
    const std::array<double, 3> squared = squared_sides(p);
    const std::size_t longest = longest_of(squared);
    if (squared[longest] <= squared_size_) return add(p, area, out);
    const Vec3d& a = p[longest];
    const Vec3d& b = p[(longest + 1) % 3];
    const Vec3d& c = p[(longest + 2) % 3];
    if (2 * area <= squared[longest] / 8 && 4 * area * area <= squared_size_ * squared[longest]) {
      // Halving a needle yields two needles side by side, so it is cut across instead.
      const double part = std::clamp(dot(c - a, b - a) / squared[longest], 0.0, 1.0);
      const Vec3d foot = a + (b - a) * part;
      cut_needle(a, foot, c, area * part, out);
      cut_needle(b, c, foot, area * (1 - part), out);
      return;
    }
    const Vec3d middle = (a + b) * 0.5;
    divide({a, middle, c}, area / 2, out);
    divide({middle, b, c}, area / 2, out);
  }

  /// Cuts a triangle along lines that are parallel to its short side bc.
  void cut_needle(const Vec3d& tip, const Vec3d& b, const Vec3d& c, double area, std::vector<CutPiece>& out) const {
    if (!(area > 0)) return;
    const double longer = std::sqrt(std::max(squared_length(b - tip), squared_length(c - tip)));
    const auto count = static_cast<std::size_t>(std::ceil(longer / std::sqrt(squared_size_)));
    const double one = area / (static_cast<double>(count) * static_cast<double>(count));
    Vec3d last_b = tip;
    Vec3d last_c = tip;
    for (std::size_t k = 0; k < count; ++k) {
      const double at = static_cast<double>(k + 1) / static_cast<double>(count);
      const Vec3d next_b = tip + (b - tip) * at;
      const Vec3d next_c = tip + (c - tip) * at;
      add({last_b, next_b, next_c}, one * static_cast<double>(k + 1), out);
      if (k > 0) add({last_b, next_c, last_c}, one * static_cast<double>(k), out);
      last_b = next_b;
      last_c = next_c;
    }
  }

  static void add(const std::array<Vec3d, 3>& p, double area, std::vector<CutPiece>& out) { out.push_back({p, area}); }

  double squared_size_;
};

/// Returns the size of pieces that yields about the wanted number of pieces. Halving of right-angled isosceles
/// triangles yields pieces with areas of 1/8 to 1/4 of the squared size.
double size_for(const MeshView& mesh, double count) {
  double area = 0;
  double longest_sides = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = triangle_corners(mesh, t);
    area += length(cross(b - a, c - a)) / 2;
    longest_sides += std::max({length(b - a), length(c - b), length(a - c)});
  }
  return std::max(std::sqrt(4 * area / count), longest_sides / count);
}

}  // namespace

std::vector<CutPiece> cut_surface(const MeshView& mesh, double count, double size, const Context& context) {
  const Cutter cutter(std::max(size_for(mesh, count), size));
  std::vector<std::vector<CutPiece>> parts((mesh.triangles.size() + triangles_per_range - 1) / triangles_per_range);
  parallel_for(context, mesh.triangles.size(), triangles_per_range, "", [&](const WorkRange& range) {
    std::vector<CutPiece>& part = parts[range.begin / triangles_per_range];
    for (std::size_t t = range.begin; t < range.end; ++t) cutter.cut(triangle_corners(mesh, t), part);
  });
  std::vector<CutPiece> out;
  for (std::vector<CutPiece>& part : parts) {
    out.insert(out.end(), part.begin(), part.end());
    part = {};
  }
  return out;
}

}  // namespace blum::surface
