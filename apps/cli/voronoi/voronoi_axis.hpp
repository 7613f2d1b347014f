// Blum: medial axes from walls of Voronoi diagrams, for the tool. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/io/draft.hpp"
#include "blum/voronoi/voronoi_patches.hpp"
#include "common/solid_input.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// Texts of the options --theta and --decimate, and of --graph, --patch-angle and --patch-fit, which apply to all
/// parts.
struct VoronoiAxisTexts {
  std::optional<std::string> theta, decimate, graph, patch_angle, patch_fit;

  void add_to(const Command& command);
  /// Returns the name of the first given option that is only for medial axes. Returns an empty text if none is given.
  [[nodiscard]] std::string given() const;
};

struct VoronoiAxisOptions {
  double theta = 1;     ///< degrees; the default is above the angles by which rounding to 32 bits bends faces
  double decimate = 0;  ///< mesh units; 0 keeps all vertices
  std::optional<std::filesystem::path> graph;
  std::optional<VoronoiPatchOptions> patches;  ///< without a value, sites are not joined
};

/// @throws UsageError.
[[nodiscard]] VoronoiAxisOptions parse_axis_options(const VoronoiAxisTexts& texts);

/// Axis in a draft file. It was read from the file and certified as `blum verify` does.
struct VoronoiAxis {
  std::vector<Draft> drafts;  ///< files of the axis and of its graph
  Json json;                  ///< counts, deviation, graph, certificate
  TextTable table;
  std::vector<std::string> mismatches;  ///< reasons why it is not certified
  std::vector<Warning> warnings;
  std::vector<PhaseTime> phases;
};

/// @param walls   result of voronoi_complex() for VoronoiPart::medial_axis. If `options.patches` is given, it has the
///                columns of add_patch_columns().
/// @param source, weld  metadata of the file: name of the input and weld tolerance.
[[nodiscard]] VoronoiAxis make_voronoi_axis(const Complex& walls, const SolidInput& input,
                                            const VoronoiAxisOptions& options, const std::filesystem::path& source,
                                            const std::optional<double>& weld, const std::filesystem::path& output,
                                            const Context& context);

}  // namespace blum::cli
