// Blum: the CUDA back end of distance_field. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "field/backend.hpp"

namespace blum::cuda {

/// A back end on the CUDA device with this index.
/// @throws DeviceError where there is no CUDA module, no driver or no such device.
[[nodiscard]] std::unique_ptr<FieldBackend> make_backend(int index);

}  // namespace blum::cuda
