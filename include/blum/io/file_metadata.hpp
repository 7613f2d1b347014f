// Blum: what files say in words. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blum {

/// What a file says besides its numbers: keys, each with a text, in their order. Texts are UTF-8.
using FileMetadata = std::vector<std::pair<std::string, std::string>>;

/// The text of a key; empty where there is none.
[[nodiscard]] std::string_view find_value(const FileMetadata& metadata, std::string_view key);

}  // namespace blum
