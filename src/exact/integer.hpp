// Blum: fast integers of any size, by Boost. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/multiprecision/cpp_int.hpp>

#include <cstdint>
#include <memory>

namespace blum::detail {

/// An integer of any size. Integers of up to 1024 bits allocate no memory; that is enough for most coordinates.
using Integer = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<1024, 0, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, std::allocator<unsigned long long>>,
    boost::multiprecision::et_off>;

/// An integer of at most `bits` bits beside its sign. Results must not be larger. It allocates no memory, and is faster
/// than an Integer.
template <unsigned bits>
using FixedInteger = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<bits, bits, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, void>,
    boost::multiprecision::et_off>;

/// Returns value * 2^power. Products take the place of shifts, in which static analysis sees undefined ones.
/// @param power  >= 0.
[[nodiscard]] inline Integer times_power(Integer value, int power) {
  constexpr int most = 62;
  for (; power > most; power -= most) value *= std::int64_t{1} << most;
  return value * (std::int64_t{1} << power);
}

}  // namespace blum::detail
