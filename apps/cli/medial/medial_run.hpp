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
  std::vector<Draft> graphs;    ///< if --graph is given: one for each draft
  std::vector<Draft> extended;  ///< if --extend is given: one for each draft
  std::vector<bool> is_kept;    ///< for each draft: true if it becomes a file
  std::vector<Warning> warnings;
  std::vector<std::string> mismatches;
  TextTable table;
};

}  // namespace blum::cli
