// Blum: the subcommands of the tool, one file each. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/command_line.hpp"

namespace blum::cli {

/// The command-line tool and its arguments. It is passed to the functions that add subcommands.
struct CommandLine {
  const Command& app;
  /// In the order of the command line; a function may remove arguments of its own subcommand.
  std::vector<std::string>& arguments;
};

// Each of the following functions adds its subcommand to the tool. The subcommand runs after the whole command line has
// been read.
void add_field_command(const CommandLine& line);
void add_slice_command(const CommandLine& line);
void add_make_command(const CommandLine& line);
void add_info_command(const CommandLine& line);
void add_formats_command(const CommandLine& line);
void add_medial_command(const CommandLine& line);
void add_verify_command(const CommandLine& line);
void add_match_command(const CommandLine& line);
void add_reconstruct_command(const CommandLine& line);
void add_surface_command(const CommandLine& line);
void add_centreline_command(const CommandLine& line);
void add_proximity_command(const CommandLine& line);
void add_ccd_command(const CommandLine& line);
void add_plan_command(const CommandLine& line);
void add_query_command(const CommandLine& line);
void add_sample_command(const CommandLine& line);
void add_surface_map_command(const CommandLine& line);
void add_hausdorff_command(const CommandLine& line);
void add_clean_command(const CommandLine& line);
void add_voronoi_command(const CommandLine& line);
void add_view_command(const CommandLine& line);

/// All subcommands, in the order of the help. A new subcommand needs a source file, a declaration above, an entry here,
/// and a test.
inline constexpr std::array commands{add_field_command,   add_slice_command,       add_make_command,
                                     add_info_command,    add_formats_command,     add_medial_command,
                                     add_verify_command,  add_match_command,       add_reconstruct_command,
                                     add_surface_command, add_centreline_command,  add_proximity_command,
                                     add_ccd_command,     add_plan_command,        add_query_command,
                                     add_sample_command,  add_surface_map_command, add_hausdorff_command,
                                     add_clean_command,   add_voronoi_command,     add_view_command};

}  // namespace blum::cli
