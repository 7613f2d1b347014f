#include "io/bytes/scalar_type.hpp"

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "blum/core/error.hpp"

namespace blum::volume_io {
namespace {

template <std::size_t size>
void reverse_each(std::span<std::byte> bytes) {
  for (std::size_t at = 0; at + size <= bytes.size(); at += size) {
    std::reverse(bytes.data() + at, bytes.data() + at + size);
  }
}

template <std::size_t index>
VoxelImage::Values make_alternative(std::size_t count) {
  return VoxelImage::Values(std::in_place_index<index>, count);
}

}  // namespace

std::size_t scalar_size(ScalarType type) {
  constexpr std::array<std::size_t, 10> sizes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

ScalarType scalar_type(const VoxelImageView::Values& values) {
  return static_cast<ScalarType>(values.index());
}

VoxelImage::Values make_values(ScalarType type, std::size_t count) {
  static_assert(std::variant_size_v<VoxelImage::Values> == 10);
  using Maker = VoxelImage::Values (*)(std::size_t);
  constexpr std::array<Maker, 10> makers{
      make_alternative<0>, make_alternative<1>, make_alternative<2>, make_alternative<3>, make_alternative<4>,
      make_alternative<5>, make_alternative<6>, make_alternative<7>, make_alternative<8>, make_alternative<9>};
  try {
    return makers[static_cast<std::size_t>(type)](count);
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  throw OutOfMemory("cannot allocate " + std::to_string(count) + " image values of " +
                    std::to_string(scalar_size(type)) + " bytes; use a machine with more memory");
}

std::span<std::byte> as_bytes(VoxelImage::Values& values) {
  return std::visit([](auto& v) { return std::as_writable_bytes(std::span(v)); }, values);
}

std::span<const std::byte> as_bytes(const VoxelImageView::Values& values) {
  return std::visit([](const auto& v) { return std::as_bytes(v); }, values);
}

void to_native(std::span<std::byte> bytes, ScalarType type, std::endian order) {
  if (order == std::endian::native) return;
  switch (scalar_size(type)) {
    case 2:
      return reverse_each<2>(bytes);
    case 4:
      return reverse_each<4>(bytes);
    case 8:
      return reverse_each<8>(bytes);
    default:
      return;
  }
}

Buffer<float> to_float(const VoxelImage::Values& values) {
  return std::visit(
      [](const auto& v) {
        Buffer<float> out(v.size());
        std::transform(v.begin(), v.end(), out.begin(), [](auto value) { return static_cast<float>(value); });
        return out;
      },
      values);
}

}  // namespace blum::volume_io
