// Blum: the result of a search that found no path. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/error.hpp"

namespace blum::cli {

/// No path was found in time. This does not prove that none exists.
class NoPath : public Error {
 public:
  using Error::Error;
};

}  // namespace blum::cli
