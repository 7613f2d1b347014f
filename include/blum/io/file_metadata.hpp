// Blum: metadata of files, as texts. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blum {

/// Texts that a file holds in addition to its numbers: a list of pairs of key and text. Texts are UTF-8.
using FileMetadata = std::vector<std::pair<std::string, std::string>>;

/// Returns the text of a key; empty if the key is missing.
[[nodiscard]] std::string_view find_value(const FileMetadata& metadata, std::string_view key);

}  // namespace blum
