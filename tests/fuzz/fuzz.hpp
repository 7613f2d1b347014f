// Blum: what the fuzz targets share. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "blum/core/error.hpp"

// The format that a target reads (CMakeLists.txt): the last word of the name of its folder of first inputs.
#ifndef BLUM_FORMAT
#define BLUM_FORMAT ""
#endif

namespace blum::fuzz {

inline void require(bool holds) {
  if (!holds) std::abort();
}

/// Calls `read` with the bytes: either Blum refuses them with an error of its own, or what `read` requires holds.
template <class Read>
int feed(const std::uint8_t* data, std::size_t size, Read read) {
  try {
    read(std::as_bytes(std::span(data, size)));
  } catch (const FormatError&) {
    return 0;  // refused with a reason
  }
  return 0;
}

}  // namespace blum::fuzz
