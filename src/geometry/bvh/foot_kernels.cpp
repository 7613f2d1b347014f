// Feet of perpendiculars on many triangles. Compiled like lane_kernels.cpp, but without fused operations, so that all
// instruction sets give the same bits.
#include <algorithm>
#include <cmath>
#include <cstddef>

#ifdef BLUM_HIGHWAY
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)  // would not make loops of doubles faster
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "geometry/bvh/foot_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#else
#define HWY_BEFORE_NAMESPACE() static_assert(true)
#define HWY_AFTER_NAMESPACE() static_assert(true)
#define HWY_NAMESPACE baseline
#define HWY_ONCE 1
#endif

#include "geometry/distance/face_batch.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::HWY_NAMESPACE {
namespace {

constexpr std::size_t step = FaceBatch::step;

void find_feet(const FaceBatch& in, std::size_t count, double margin, FaceBatchFeet& out) {
  for (std::size_t first = 0; first < count; first += step) {
    // The compiler makes vectors only if results go to local arrays, which nothing else can refer to.
    alignas(64) double point[3][step];
    alignas(64) double squared[step];
    alignas(64) double inside[step];
    for (std::size_t k = 0; k < step; ++k) {
      const std::size_t i = first + k;
      // The terms are those of FaceFoot, in the same order.
      const double x = in.query[0][i] - in.base[0][i];
      const double y = in.query[1][i] - in.base[1][i];
      const double z = in.query[2][i] - in.base[2][i];
      const double s = x * in.u[0][i] + y * in.u[1][i] + z * in.u[2][i];
      const double t = x * in.v[0][i] + y * in.v[1][i] + z * in.v[2][i];
      const double rest_x = x - in.u[0][i] * s - in.v[0][i] * t;
      const double rest_y = y - in.u[1][i] * s - in.v[1][i] * t;
      const double rest_z = z - in.u[2][i] * s - in.v[2][i] * t;
      point[0][k] = in.query[0][i] - rest_x;
      point[1][k] = in.query[1][i] - rest_y;
      point[2][k] = in.query[2][i] - rest_z;
      squared[k] = rest_x * rest_x + rest_y * rest_y + rest_z * rest_z;
      const double altitude = in.altitude[i];
      const double apex = in.apex[i];
      const double other = in.length[i] - apex;
      // A product of single comparisons, because with `&&` the compiler branches.
      double all = altitude > flat_ratio * in.length[i] ? 1.0 : 0.0;
      all *= t > margin ? 1.0 : 0.0;
      all *= s * altitude - t * apex > margin * (altitude + std::abs(apex)) ? 1.0 : 0.0;
      all *= (in.length[i] - s) * altitude - t * other > margin * (altitude + std::abs(other)) ? 1.0 : 0.0;
      inside[k] = all;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) std::copy_n(point[axis], step, out.point[axis].data() + first);
    std::copy_n(squared, step, out.squared.data() + first);
    std::copy_n(inside, step, out.is_inside.data() + first);
  }
}

}  // namespace
}  // namespace blum::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "geometry/bvh/kernel_tables.hpp"

namespace blum {
namespace {

BLUM_KERNEL(find_feet);

}  // namespace

void find_feet(const FaceBatch& batch, std::size_t count, double margin, FaceBatchFeet& out) {
  best_find_feet(batch, count, margin, out);
}

}  // namespace blum
#endif  // HWY_ONCE
