// Blum: the headers that most files of the tool include, for the build (BLUM_PCH). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"
