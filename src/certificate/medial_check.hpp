// Blum: whether an axis is in the middle of its solid, and all of it. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/context.hpp"
#include "certificate/solid_oracle.hpp"

namespace blum::verifier {

/// Looks at points of sheets and curves, and for what is missing, and adds what is wrong.
/// @param body_of  of each vertex: see AxisParts.
/// @param factor   lengths are this many times what the caller knows; those of the options are the caller's.
[[nodiscard]] MedialCheck check_medial(const MedialView& axis, const KnownSolid& solid,
                                       const std::vector<std::uint32_t>& body_of, const CertificateOptions& options,
                                       double factor, std::vector<std::string>& mismatches, const Context& context);

}  // namespace blum::verifier
