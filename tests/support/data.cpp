// Blum: paths of real shapes and images for tests. SPDX-License-Identifier: Apache-2.0
#include "support/data.hpp"

#include <cstdlib>

namespace blum::test {

std::filesystem::path data_directory() {
  const char* const chosen = std::getenv("BLUM_DATA_DIR");
  return chosen != nullptr && *chosen != '\0' ? chosen : BLUM_DATA_DIR;
}

}  // namespace blum::test
