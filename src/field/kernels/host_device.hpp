// Blum: helpers for the bodies of kernels, for host and device alike. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "blum/core/vec3.hpp"

// Kernel functions also run on the host: the tests run them through EmulatedDevice (emulated_device.hpp). Kernel
// functions may use constexpr functions of the standard library and of Vec3 (nvcc --expt-relaxed-constexpr).
#if defined(__CUDACC__)
#define BLUM_HD __host__ __device__
#define BLUM_NOINLINE __noinline__
#else
#define BLUM_HD
#define BLUM_NOINLINE
#endif

namespace blum::kernels {

/// Number of lanes of a warp. Clusters have this many sites, and boxes this many children.
inline constexpr std::uint32_t warp_size = 32;

template <class T>
BLUM_HD constexpr T smaller(T a, T b) {
  return b < a ? b : a;
}
template <class T>
BLUM_HD constexpr T larger(T a, T b) {
  return a < b ? b : a;
}
template <class T>
BLUM_HD constexpr T clamped(T x, T low, T high) {
  return smaller(larger(x, low), high);
}
BLUM_HD inline float root(float x) {
  return sqrtf(x);
}
BLUM_HD inline double root(double x) {
  return sqrt(x);
}
BLUM_HD inline float magnitude(float x) {
  return fabsf(x);
}
BLUM_HD inline double magnitude(double x) {
  return fabs(x);
}
template <class T>
BLUM_HD T norm(const Vec3<T>& v) {
  return root(squared_length(v));
}
BLUM_HD constexpr Vec3f to_float(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
BLUM_HD constexpr Vec3d to_double(const Vec3f& v) {
  return {v.x, v.y, v.z};
}
/// Returns the largest value of v . x over the box |x| <= half.
BLUM_HD inline float support(const Vec3f& v, const Vec3f& half) {
  return magnitude(v.x) * half.x + magnitude(v.y) * half.y + magnitude(v.z) * half.z;
}

BLUM_HD inline std::uint32_t count_bits(std::uint32_t x) {
#if defined(__CUDA_ARCH__)
  return static_cast<std::uint32_t>(__popc(x));
#else
  return static_cast<std::uint32_t>(std::popcount(x));
#endif
}
/// Returns the index of the lowest set bit of x. x must not be 0.
BLUM_HD inline std::uint32_t lowest_bit(std::uint32_t x) {
#if defined(__CUDA_ARCH__)
  return static_cast<std::uint32_t>(__ffs(static_cast<int>(x)) - 1);
#else
  return static_cast<std::uint32_t>(std::countr_zero(x));
#endif
}
/// Returns the index of the highest set bit of x. x must not be 0.
BLUM_HD inline std::uint32_t highest_bit(std::uint32_t x) {
#if defined(__CUDA_ARCH__)
  return static_cast<std::uint32_t>(31 - __clz(static_cast<int>(x)));
#else
  return static_cast<std::uint32_t>(31 - std::countl_zero(x));
#endif
}
/// Returns the number of set bits of the mask below bit `lane`.
BLUM_HD inline std::uint32_t bits_below(std::uint32_t mask, std::uint32_t lane) {
  return count_bits(mask & ((1U << lane) - 1U));
}
/// Returns the bits of a non-negative float. Compared as integers, they have the order of the floats.
BLUM_HD inline std::uint32_t bits_of(float x) {
#if defined(__CUDA_ARCH__)
  return __float_as_uint(x);
#else
  return std::bit_cast<std::uint32_t>(x);
#endif
}
/// Returns the float with these bits. Any bits are allowed.
BLUM_HD inline float float_of(std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
  return __uint_as_float(bits);
#else
  return std::bit_cast<float>(bits);
#endif
}

// Sums and products that are rounded separately. They are used where results must be equal on all devices, so the
// compiler must not fuse them. On the host, no flag with which kernels are tested allows fused operations.
BLUM_HD inline double rounded_sum(double a, double b) {
#if defined(__CUDA_ARCH__)
  return __dadd_rn(a, b);
#else
  return a + b;
#endif
}
BLUM_HD inline double rounded_product(double a, double b) {
#if defined(__CUDA_ARCH__)
  return __dmul_rn(a, b);
#else
  return a * b;
#endif
}

}  // namespace blum::kernels
