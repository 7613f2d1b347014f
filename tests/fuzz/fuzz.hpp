// Blum: shared code of the fuzz targets. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "blum/core/error.hpp"

// The format that a target reads. CMakeLists.txt sets it to the last word of the name of the folder of first inputs.
#ifndef BLUM_FORMAT
#define BLUM_FORMAT ""
#endif

namespace blum::fuzz {

inline void require(bool holds) {
  if (!holds) std::abort();
}

/// Calls `read` with the bytes. Either Blum rejects them with a FormatError, or all requirements of `read` hold.
template <class Read>
int feed(const std::uint8_t* data, std::size_t size, Read read) {
  try {
    read(std::as_bytes(std::span(data, size)));
  } catch (const FormatError&) {
    return 0;  // rejected with a reason
  }
  return 0;
}

}  // namespace blum::fuzz
