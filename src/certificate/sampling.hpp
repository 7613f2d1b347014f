// Blum: samples of sheets, curves and bodies, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/context.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/random.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "certificate/solid_oracle.hpp"

namespace blum::verifier {

/// Returns samples of triangles and all their corners, as for SolidOracle::samples().
/// @param groups  for each triangle; triangles of no_group are left out. If empty, all triangles are sampled.
/// @throws Cancelled.
[[nodiscard]] Samples samples_of_triangles(const MeshView& mesh, std::span<const std::uint32_t> groups, double step,
                                           const Context& context);

/// Returns the area of a triangle of an axis.
[[nodiscard]] inline double triangle_area(const MedialView& axis, std::size_t t) {
  const auto& [a, b, c] = axis.triangles[t];
  return 0.5 * length(cross(axis.positions[b] - axis.positions[a], axis.positions[c] - axis.positions[a]));
}

/// Triangles or edges that are sampled in proportion to their sizes.
class Spread {
 public:
  void add(double size, std::uint32_t cell) {
    if (!(size > 0) || !std::isfinite(size)) return;
    total_ += size;
    cells_.push_back(cell);
    ends_.push_back(total_);
  }
  [[nodiscard]] double total() const { return total_; }
  [[nodiscard]] const std::vector<std::uint32_t>& cells() const { return cells_; }
  /// Returns the cell at a given fraction, 0 to 1, of the total size.
  [[nodiscard]] std::uint32_t at(double share) const {
    const auto end = std::upper_bound(ends_.begin(), ends_.end(), share * total_);
    return cells_[std::min(static_cast<std::size_t>(end - ends_.begin()), cells_.size() - 1)];
  }

 private:
  double total_ = 0;
  std::vector<std::uint32_t> cells_;
  std::vector<double> ends_;
};

/// Returns a random point of a triangle, with uniform density.
[[nodiscard]] inline Vec3d random_point(const std::array<Vec3d, 3>& corners, Random& random) {
  double u = random.uniform();
  double v = random.uniform();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v;
}

/// Statistics of the distances (offsets) of samples.
struct Offsets {
  std::size_t count = 0, close = 0, not_near = 0, off = 0;
  double furthest = 0;
  Vec3d where;

  /// @param allowed  largest offset that the claims of the file allow.
  /// @param near     largest offset that the solid allows at the sample; at most `allowed`.
  void add(double offset, double close_enough, double near, double allowed, const Vec3d& at) {
    ++count;
    if (offset <= close_enough) ++close;
    if (!(offset <= near)) ++not_near;
    if (!(offset <= allowed)) ++off;
    if (!(offset < HUGE_VAL) || offset <= furthest) return;
    furthest = offset;
    where = at;
  }
  void add(const Offsets& other) {
    count += other.count;
    close += other.close;
    not_near += other.not_near;
    off += other.off;
    if (other.furthest <= furthest) return;
    furthest = other.furthest;
    where = other.where;
  }
};

/// Returns the sum of the statistics that add(offsets, k) adds, for all k below `count`.
/// @param phase  as for parallel_for().
/// @throws Cancelled.
template <class Add>
[[nodiscard]] Offsets gathered_offsets(std::size_t count, std::string_view phase, const Add& add,
                                       const Context& context) {
  constexpr std::size_t grain = 64;
  std::vector<Offsets> parts(count / grain + 1);
  parallel_for(context, count, grain, phase, [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) add(parts[range.begin / grain], k);
  });
  Offsets all;
  for (const Offsets& part : parts) all.add(part);
  return all;
}

}  // namespace blum::verifier
