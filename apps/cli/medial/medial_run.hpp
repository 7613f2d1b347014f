// Blum: what `blum medial` gathers while it works. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "blum/core/phase_timer.hpp"
#include "blum/io/draft.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// What a run gathers for its summary.
struct MedialRun {
  Json solids = Json::array();
  std::vector<PhaseTime> phases;
  std::vector<Draft> drafts;
  std::vector<Draft> graphs;    ///< of each draft, where graphs are asked for
  std::vector<Draft> extended;  ///< of each draft, where extended axes are asked for
  std::vector<bool> is_kept;    ///< of each draft: whether it becomes a file
  std::vector<Warning> warnings;
  std::vector<std::string> mismatches;
  TextTable table;
};

}  // namespace blum::cli
