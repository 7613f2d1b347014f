// Blum: state of a run of `blum medial`. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "blum/core/phase_timer.hpp"
#include "blum/io/draft.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// Results of a run, for its files and its summary.
struct MedialRun {
  Json solids = Json::array();
  std::vector<PhaseTime> phases;
  std::vector<Draft> drafts;
  std::vector<Draft> graphs;    ///< one for each draft if --graph is given
  std::vector<Draft> extended;  ///< one for each draft if --extend is given
  std::vector<bool> is_kept;    ///< for each draft: true if it becomes a file
  std::vector<Warning> warnings;
  std::vector<std::string> mismatches;
  TextTable table;
};

}  // namespace blum::cli
