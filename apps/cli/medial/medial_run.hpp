// Blum: what `blum medial` gathers while it works. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
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

  /// Takes over what another one gathered.
  void add(MedialRun&& part) {
    for (const Json& solid : part.solids) solids.push_back(solid);
    phases.insert(phases.end(), part.phases.begin(), part.phases.end());
    const auto take = [](auto& all, auto& some) {
      for (auto&& one : some) all.push_back(std::move(one));
    };
    take(drafts, part.drafts);
    take(graphs, part.graphs);
    take(extended, part.extended);
    is_kept.insert(is_kept.end(), part.is_kept.begin(), part.is_kept.end());
    take(warnings, part.warnings);
    take(mismatches, part.mismatches);
    table.add(part.table);
  }
};

}  // namespace blum::cli
