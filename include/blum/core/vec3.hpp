// Blum: small vectors and matrices. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace blum {

/// Vector with the components x, y, z. Vec3 is an aggregate of exactly three T, so an array of n vectors can be viewed
/// as T[n][3].
template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  [[nodiscard]] constexpr T& operator[](std::size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  [[nodiscard]] constexpr const T& operator[](std::size_t axis) const { return axis == 0 ? x : axis == 1 ? y : z; }

  constexpr Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
  constexpr Vec3& operator-=(const Vec3& b) { return *this = *this - b; }
  constexpr Vec3& operator*=(T s) { return *this = *this * s; }

  [[nodiscard]] friend constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  [[nodiscard]] friend constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  [[nodiscard]] friend constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  [[nodiscard]] friend constexpr Vec3 operator*(const Vec3& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  [[nodiscard]] friend constexpr Vec3 operator*(T s, const Vec3& a) { return a * s; }
  [[nodiscard]] friend constexpr Vec3 operator/(const Vec3& a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  [[nodiscard]] friend constexpr bool operator==(const Vec3& a, const Vec3& b) = default;
};

using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;

template <class T>
[[nodiscard]] constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
[[nodiscard]] constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T>
[[nodiscard]] constexpr T squared_length(const Vec3<T>& a) {
  return dot(a, a);
}

template <class T>
[[nodiscard]] T length(const Vec3<T>& a) {
  return std::sqrt(squared_length(a));
}

template <class T>
[[nodiscard]] bool is_finite(const Vec3<T>& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Component-wise minimum and maximum.
template <class T>
[[nodiscard]] constexpr Vec3<T> min(const Vec3<T>& a, const Vec3<T>& b) {
  return {b.x < a.x ? b.x : a.x, b.y < a.y ? b.y : a.y, b.z < a.z ? b.z : a.z};
}
template <class T>
[[nodiscard]] constexpr Vec3<T> max(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x < b.x ? b.x : a.x, a.y < b.y ? b.y : a.y, a.z < b.z ? b.z : a.z};
}

/// 3 x 3 matrix, stored as its columns. In the direction matrix of a grid, column a is the unit vector along index axis
/// a.
struct Mat3 {
  Vec3d columns[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

  [[nodiscard]] constexpr Vec3d operator*(const Vec3d& v) const {
    return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z;
  }
  /// Returns the product of the transposed matrix and v.
  [[nodiscard]] constexpr Vec3d transposed_times(const Vec3d& v) const {
    return {dot(columns[0], v), dot(columns[1], v), dot(columns[2], v)};
  }
  [[nodiscard]] friend constexpr bool operator==(const Mat3&, const Mat3&) = default;
};

/// Axis-aligned box. A default-constructed box is empty (lower > upper).
struct Box3 {
  Vec3d lower{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  Vec3d upper{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  [[nodiscard]] bool is_empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
  [[nodiscard]] Vec3d size() const { return upper - lower; }
  [[nodiscard]] Vec3d center() const { return (lower + upper) * 0.5; }
  /// Returns true if a point lies in the box, boundary included.
  [[nodiscard]] bool contains(const Vec3d& p) const {
    return lower.x <= p.x && p.x <= upper.x && lower.y <= p.y && p.y <= upper.y && lower.z <= p.z && p.z <= upper.z;
  }
  [[nodiscard]] double diagonal() const { return is_empty() ? 0.0 : length(size()); }
  /// Returns the largest absolute value of a coordinate of the box's corners.
  [[nodiscard]] double largest_coordinate() const {
    double largest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      largest = std::max({largest, std::abs(lower[axis]), std::abs(upper[axis])});
    }
    return largest;
  }
  void extend(const Vec3d& p) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  void extend(const Box3& b) {
    lower = min(lower, b.lower);
    upper = max(upper, b.upper);
  }
};

}  // namespace blum
