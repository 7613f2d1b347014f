// Blum: the queries of `blum proximity`. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "blum/proximity/impact.hpp"
#include "blum/proximity/scene.hpp"
#include "common_options.hpp"
#include "described.hpp"

namespace blum::cli {

struct ProximityArguments {
  std::vector<std::string> scene;
  std::string query = "separation";
  bool self = false;
  std::optional<std::string> within;
  std::optional<std::string> output;
  std::optional<std::string> threads;
  OptionTexts<ImpactOptions> impact;  ///< of continuous collisions alone
  OptionTexts<SceneOptions> culling;  ///< of all other queries
  ReportOptions report;
};

/// --query continuous: two files are a mesh at the start and the end of a motion.
void run_continuous_query(const ProximityArguments& a);

/// --query separation, nbody or collide: each file is an object.
void run_scene_query(const ProximityArguments& a);

}  // namespace blum::cli
