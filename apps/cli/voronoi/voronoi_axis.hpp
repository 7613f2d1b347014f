// Blum: medial axes from walls of Voronoi diagrams, as the tool writes them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/io/draft.hpp"
#include "common/solid_input.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// --theta, --decimate and, for all parts, --graph.
struct VoronoiAxisTexts {
  std::optional<std::string> theta, decimate, graph;

  void add_to(const Command& command);
  /// The first one that is given and for medial axes alone; empty where none is.
  [[nodiscard]] std::string given() const;
};

struct VoronoiAxisOptions {
  double theta = 1;     ///< degrees; faces bent by rounding to 32 bits are seen at less
  double decimate = 0;  ///< mesh units; 0 keeps all vertices
  std::optional<std::filesystem::path> graph;
};

/// @throws UsageError.
[[nodiscard]] VoronoiAxisOptions parse_axis_options(const VoronoiAxisTexts& texts);

/// An axis in a file that has not its name yet, certified from there as `blum verify` does.
struct VoronoiAxis {
  std::vector<Draft> drafts;  ///< the axis, its graph
  Json json;                  ///< counts, deviation, graph, certificate
  TextTable table;
  std::vector<std::string> mismatches;  ///< why it is not certified
  std::vector<Warning> warnings;
  std::vector<PhaseTime> phases;
};

/// @param walls   what voronoi_complex() makes for its part medial_axis.
/// @param source, weld  for the file.
[[nodiscard]] VoronoiAxis make_voronoi_axis(const Complex& walls, const SolidInput& input,
                                            const VoronoiAxisOptions& options, const std::filesystem::path& source,
                                            const std::optional<double>& weld, const std::filesystem::path& output,
                                            const Context& context);

}  // namespace blum::cli
