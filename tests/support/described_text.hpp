// Blum: the members of a described struct, as text. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"

namespace blum::test {

namespace detail {

inline void put(std::ostream& out, double value) {
  out << value << '=' << std::hex << std::bit_cast<std::uint64_t>(value) << std::dec;
}
inline void put(std::ostream& out, const Vec3d& at) {
  for (std::size_t k = 0; k < 3; ++k) {
    put(out, at[k]);
    out << ' ';
  }
}
inline void put(std::ostream& out, const std::string& text) {
  out << text;
}
template <std::integral T>
void put(std::ostream& out, T value) {
  out << +value;
}
template <DescribedEnum T>
void put(std::ostream& out, T value) {
  out << to_string(value);
}
template <DescribedStruct T>
void put(std::ostream& out, const T& value);
template <class T, std::size_t count>
void put(std::ostream& out, const std::array<T, count>& all);
template <class T>
void put(std::ostream& out, const std::vector<T>& all);
template <class T>
void put(std::ostream& out, const std::optional<T>& value) {
  if (value) put(out, *value);
}
template <class T, std::size_t count>
void put(std::ostream& out, const std::array<T, count>& all) {
  for (const T& one : all) {
    put(out, one);
    out << ' ';
  }
}
template <class T>
void put(std::ostream& out, const std::vector<T>& all) {
  for (const T& one : all) {
    put(out, one);
    out << "; ";
  }
}
template <DescribedStruct T>
void put(std::ostream& out, const T& value) {
  for_each_member<T>([&](const auto& entry) {
    out << '\n' << entry.name << ": ";
    put(out, entry.of(value));
  });
}

}  // namespace detail

/// One line per member, with every bit of numbers. Texts are equal exactly if the structs are equal.
template <DescribedStruct T>
[[nodiscard]] std::string described_text(const T& value) {
  std::ostringstream out;
  detail::put(out, value);
  return out.str();
}

}  // namespace blum::test
