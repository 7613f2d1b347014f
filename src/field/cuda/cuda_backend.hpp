// Blum: the CUDA back end of distance_field. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "field/backend.hpp"

namespace blum::cuda {

/// Returns a back end on the CUDA device with this index.
/// @throws DeviceError if the CUDA module, the driver or the device is missing.
[[nodiscard]] std::unique_ptr<FieldBackend> make_field_backend(int index);
[[nodiscard]] std::unique_ptr<ImageBackend> make_image_backend(int index);

}  // namespace blum::cuda
