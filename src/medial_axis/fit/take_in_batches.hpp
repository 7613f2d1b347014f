// Blum: contractions that are chosen by many threads and made one after the other. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "blum/core/parallel.hpp"
#include "medial_axis/fit/shrinking_lists.hpp"

namespace blum {

/// An edge that is to be contracted to one of its ends.
struct Contraction {
  std::uint32_t from = 0, to = 0;
};

/// What is to be done at an edge, as it was when it was looked at.
struct ContractionStep {
  bool is_gone = false;                 ///< nothing: the edge was contracted before
  std::array<std::uint32_t, 2> near{};  ///< vertices: while nothing changes around them, the step stays as it is
  std::optional<Contraction> contraction{};
};

/// So many edges are chosen at a time.
inline constexpr std::size_t edges_in_batch = 1024;

/// A list cut into as many strands as a batch has edges, of which each batch gets one each: edges that are next to each
/// other in the list stay in order, as good contractions want, but are not in one batch, as they would be in each
/// other's way.
inline std::vector<std::uint32_t> in_strands(const std::vector<std::uint32_t>& list) {
  const std::size_t batches = (list.size() + edges_in_batch - 1) / edges_in_batch;
  std::vector<std::uint32_t> out;
  out.reserve(list.size());
  for (std::size_t first = 0; first < batches; ++first) {
    for (std::size_t k = first; k < list.size(); k += batches) out.push_back(list[k]);
  }
  return out;
}

/// Makes the steps of `count` edges in their order, as if each were chosen right before it is made. All threads choose
/// those of some hundred edges at a time; one around which something has changed since is chosen again.
/// @param lists    that steps are chosen in.
/// @param step_of  ContractionStep(k, worker), called from many threads, worker being below thread_count().
/// @param make     void(k, step) contracts, or does what else there is to do.
/// @throws Cancelled.
template <class StepOf, class Make>
void take_in_batches(const Context& context, std::size_t count, const ShrinkingLists& lists, const StepOf& step_of,
                     const Make& make) {
  constexpr std::size_t grain = 32;
  const std::size_t batch = thread_count(context) > 1 ? edges_in_batch : 1;
  std::vector<ContractionStep> steps(std::min(batch, count));
  for (std::size_t first = 0; first < count; first += batch) {
    const std::size_t size = std::min(batch, count - first);
    const std::uint32_t before = lists.contractions();
    parallel_for(context, size, grain, {}, [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) steps[k] = step_of(first + k, range.worker);
    });
    for (std::size_t k = 0; k < size; ++k) {
      const auto is_changed = [&](std::uint32_t v) { return lists.changed(v) > before; };
      if (!steps[k].is_gone && std::any_of(steps[k].near.begin(), steps[k].near.end(), is_changed)) {
        steps[k] = step_of(first + k, 0);
      }
      make(first + k, steps[k]);
    }
  }
}

}  // namespace blum
