// Blum: conversion of arrays between Python and C++. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::python {

namespace nb = nanobind;

/// Input array: contiguous, on the CPU, of exactly this type. The Python code of the package guarantees this.
template <class T, class Shape>
using In = nb::ndarray<const T, Shape, nb::c_contig, nb::device::cpu>;
using PointsIn = In<double, nb::shape<-1, 3>>;
using TrianglesIn = In<std::int32_t, nb::shape<-1, 3>>;
using SegmentsIn = In<std::int32_t, nb::shape<-1, 2>>;
using IndicesIn = In<std::int32_t, nb::shape<-1>>;

/// Output array. It keeps the memory that it shows alive.
template <class T>
using Out = nb::ndarray<nb::numpy, T>;

/// Returns an n x 3 array of doubles as vectors.
[[nodiscard]] inline std::span<const Vec3d> vectors(const PointsIn& array) {
  static_assert(sizeof(Vec3d) == 3 * sizeof(double));
  return {reinterpret_cast<const Vec3d*>(array.data()), array.shape(0)};
}

/// Returns the elements of an array as rows of another type of the same size. Negative indices become indices far out
/// of range, which every range check rejects.
template <class Row, class Array>
[[nodiscard]] std::span<const Row> rows(const Array& array) {
  return {reinterpret_cast<const Row*>(array.data()), array.shape(0)};
}

/// Returns a view of memory that `owner` keeps alive.
/// @param strides  in elements; empty: contiguous.
template <class T>
[[nodiscard]] Out<T> view_of(T* data, std::initializer_list<std::size_t> shape, nb::handle owner,
                             std::initializer_list<std::int64_t> strides = {}) {
  static T nothing{};
  T* const start = data == nullptr ? &nothing : data;  // An empty array needs an address, too.
  return Out<T>(start, shape.size(), shape.begin(), owner, strides.size() == 0 ? nullptr : strides.begin());
}

/// List that Python keeps alive while an array shows a part of it.
template <class Entry>
struct Held {
  std::vector<Entry>* entries;  ///< Never nullptr.
  nb::capsule owner;
};
template <class Entry>
[[nodiscard]] Held<Entry> held(std::vector<Entry> entries) {
  auto kept = std::make_unique<std::vector<Entry>>(std::move(entries));
  std::vector<Entry>* const list = kept.get();
  nb::capsule owner(list, [](void* memory) noexcept { delete static_cast<std::vector<Entry>*>(memory); });
  (void)kept.release();  // The capsule owns it from here on.
  return {list, std::move(owner)};
}

/// Passes a list to Python without a copy.
/// @param width  elements T per entry; 0: an array with one axis.
template <class T, class Entry>
[[nodiscard]] Out<T> handed_over(std::vector<Entry> entries, std::size_t width = 0) {
  static_assert(sizeof(Entry) % sizeof(T) == 0);
  const Held<Entry> kept = held(std::move(entries));
  T* const data = reinterpret_cast<T*>(kept.entries->data());
  const std::size_t length = kept.entries->size();
  return width == 0 ? view_of<T>(data, {length}, kept.owner) : view_of<T>(data, {length, width}, kept.owner);
}

// Compiled once, in arrays.cpp.
extern template Out<double> handed_over<double>(std::vector<double>, std::size_t);
extern template Out<double> handed_over<double>(std::vector<Vec3d>, std::size_t);
extern template Out<std::int32_t> handed_over<std::int32_t>(std::vector<std::int32_t>, std::size_t);
extern template Out<std::int32_t> handed_over<std::int32_t>(std::vector<std::uint32_t>, std::size_t);
extern template Out<std::int32_t> handed_over<std::int32_t>(std::vector<Segment>, std::size_t);
extern template Out<std::int32_t> handed_over<std::int32_t>(std::vector<Triangle>, std::size_t);
extern template Out<std::uint32_t> handed_over<std::uint32_t>(std::vector<std::uint32_t>, std::size_t);

/// Returns values at the nodes of a grid as an array [z, y, x].
/// @param size  nodes along x, y, z.
template <class T>
[[nodiscard]] Out<T> grid_view(T* data, const std::array<std::int64_t, 3>& size, nb::handle owner) {
  return view_of<T>(
      data, {static_cast<std::size_t>(size[2]), static_cast<std::size_t>(size[1]), static_cast<std::size_t>(size[0])},
      owner);
}
template <class T>
[[nodiscard]] Out<T> grid_handed_over(std::vector<T> values, const std::array<std::int64_t, 3>& size) {
  const Held<T> kept = held(std::move(values));
  return grid_view<T>(kept.entries->data(), size, kept.owner);
}

/// Arrays of a mesh, used without a copy.
struct MeshArrays {
  PointsIn vertices;
  TrianglesIn triangles;
  SegmentsIn segments;
  IndicesIn points;

  [[nodiscard]] MeshView view() const {
    return {vectors(vertices), rows<Triangle>(triangles), rows<Segment>(segments), rows<std::uint32_t>(points)};
  }
};

/// Returns (vertices, triangles, segments, points).
[[nodiscard]] nb::tuple arrays_of(TriangleMesh mesh);

[[nodiscard]] inline std::array<double, 3> triple(const Vec3d& v) {
  return {v.x, v.y, v.z};
}
[[nodiscard]] inline Vec3d vector(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace blum::python
