#include "blum/surface_map/surface_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/core/scale.hpp"
#include "blum/field/closest_points.hpp"
#include "surface_map/weighted_statistics.hpp"

namespace blum {
namespace {

using surface::LongSum;

constexpr std::size_t triangles_per_range = 256;
/// Greatest number of pieces. This number takes about 100 gigabytes.
constexpr std::size_t most_pieces = 1'000'000'000;

/// Small triangles, each represented by its centroid. *Scaled* lengths are those of the mesh times a scale.
struct Pieces {
  std::vector<Vec3d> centroid;      ///< mesh units
  std::vector<double> area;         ///< scaled
  std::vector<double> mean_square;  ///< mean squared distance of a piece's points from its centroid, scaled
  double largest_radius = 0;        ///< largest distance of a corner from its centroid, scaled

  void append(const Pieces& more) {
    centroid.insert(centroid.end(), more.centroid.begin(), more.centroid.end());
    area.insert(area.end(), more.area.begin(), more.area.end());
    mean_square.insert(mean_square.end(), more.mean_square.begin(), more.mean_square.end());
    largest_radius = std::max(largest_radius, more.largest_radius);
  }
};

class Cutter {
 public:
  /// @param size  greatest length of a side of a piece, scaled.
  Cutter(double scale, double size) : scale_(scale), squared_size_(size * size) {}

  void cut(const std::array<Vec3d, 3>& corners, Pieces& out) const {
    const double area = length(cross(corners[1] - corners[0], corners[2] - corners[0])) / 2;
    if (area > 0) divide(corners, area, out);
  }

 private:
  void divide(const std::array<Vec3d, 3>& p, double area, Pieces& out) const {
    const std::array<double, 3> squared = squared_sides(p);
    const auto longest = static_cast<std::size_t>(std::max_element(squared.begin(), squared.end()) - squared.begin());
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
  void cut_needle(const Vec3d& tip, const Vec3d& b, const Vec3d& c, double area, Pieces& out) const {
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

  static std::array<double, 3> squared_sides(const std::array<Vec3d, 3>& p) {
    return {squared_length(p[1] - p[0]), squared_length(p[2] - p[1]), squared_length(p[0] - p[2])};
  }

  void add(const std::array<Vec3d, 3>& p, double area, Pieces& out) const {
    const std::array<double, 3> squared = squared_sides(p);
    const Vec3d centroid = (p[0] + p[1] + p[2]) / 3.0;
    out.centroid.push_back(centroid / scale_);
    out.area.push_back(area);
    out.mean_square.push_back((squared[0] + squared[1] + squared[2]) / 36);
    for (const Vec3d& corner : p) out.largest_radius = std::max(out.largest_radius, length(corner - centroid));
  }

  double scale_;
  double squared_size_;
};

/// Sums of areas and of longest sides over all triangles, scaled.
struct Extent {
  double area = 0;
  double longest_sides = 0;
};

Extent extent_of(const MeshView& mesh, double scale) {
  Extent out;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = triangle_corners(mesh, t);
    out.area += length(cross((b - a) * scale, (c - a) * scale)) / 2;
    out.longest_sides += std::max({length((b - a) * scale), length((c - b) * scale), length((a - c) * scale)});
  }
  return out;
}

Pieces pieces_of(const MeshView& mesh, double scale, double size, const Context& context) {
  const Cutter cutter(scale, size);
  std::vector<Pieces> parts((mesh.triangles.size() + triangles_per_range - 1) / triangles_per_range);
  parallel_for(context, mesh.triangles.size(), triangles_per_range, "", [&](const WorkRange& range) {
    Pieces& part = parts[range.begin / triangles_per_range];
    for (std::size_t t = range.begin; t < range.end; ++t) {
      std::array<Vec3d, 3> corners = triangle_corners(mesh, t);
      for (Vec3d& corner : corners) corner *= scale;
      cutter.cut(corners, part);
    }
  });
  Pieces out;
  for (Pieces& part : parts) {
    out.append(part);
    part = {};
  }
  return out;
}

}  // namespace

SurfaceDeviation surface_deviation(const MeshView& mesh, const MeshView& other, const DeviationOptions& options,
                                   const Context& context) {
  validate(mesh);
  if (options.pieces < 1 || options.pieces > most_pieces) {
    throw InvalidOption("pieces is " + std::to_string(options.pieces) + ", but must be 1 to " +
                        std::to_string(most_pieces));
  }
  const double scale = scale_to_one(bounds(mesh).largest_coordinate());
  const Extent extent = extent_of(mesh, scale);
  if (!(extent.area > 0)) throw InvalidMesh("no triangle of the mesh has an area, so there is no surface to measure");
  const ClosestPointQuery query(other, {options.sign, {}}, context);
  // Halving of right-angled isosceles triangles yields pieces with areas of 1/8 to 1/4 of `size` squared. Needles are
  // only cut across their lengths.
  const auto count = static_cast<double>(options.pieces);
  const double size = std::max(std::sqrt(4 * extent.area / count), extent.longest_sides / count);
  const Pieces pieces = pieces_of(mesh, scale, size, context);
  const std::vector<ClosestPoint> found = query.nearest(pieces.centroid, context);

  SurfaceDeviation out;
  std::vector<double> values(found.size());
  LongSum areas;
  LongSum mean;
  double magnitude = 0;
  double largest = 0;
  double mean_move = 0;
  double square_move = 0;
  out.smallest = HUGE_VAL;
  out.largest = -HUGE_VAL;
  for (std::size_t k = 0; k < found.size(); ++k) {
    values[k] = found[k].distance;
    const double value = values[k] * scale;
    areas.add(pieces.area[k]);
    mean.add(pieces.area[k] * value);
    magnitude += pieces.area[k] * std::abs(value);
    largest = std::max(largest, std::abs(value));
    mean_move += pieces.area[k] * std::sqrt(pieces.mean_square[k]);
    square_move += pieces.area[k] * pieces.mean_square[k];
    out.smallest = std::min(out.smallest, values[k]);
    out.largest = std::max(out.largest, values[k]);
  }
  const double sum = areas.value();
  out.mean = mean.value() / sum / scale;
  const double rounding = 4e-15 * (bounds(mesh).largest_coordinate() * scale + largest);
  // If the sign may change at points that are not on the other mesh, it may differ within a piece.
  const bool may_jump = query.sign_may_jump();
  out.mean_error = (mean_move / sum + rounding + (may_jump ? 2 * magnitude / sum : 0)) / scale;
  out.rms = surface::root_mean_square(values, pieces.area, largest / scale, sum);
  out.rms_error = (std::sqrt(square_move / sum) + rounding) / scale;
  out.percentiles = surface::percentiles(values, pieces.area, sum, SurfaceDeviation::percents);
  out.percentile_error = (pieces.largest_radius + rounding + (may_jump ? 2 * largest : 0)) / scale;
  out.area = extent.area / scale / scale;
  out.pieces = found.size();
  out.sign_rule = query.sign_rule();
  out.sign_reason = query.sign_reason();
  out.warnings = query.warnings();
  return out;
}

}  // namespace blum
