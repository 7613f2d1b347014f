// Blum: the subcommands of the tool, one file each. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace blum::cli {

/// Each adds its subcommand to the tool; its work runs when the command line has been read.
void add_field_command(CLI::App& app);
void add_slice_command(CLI::App& app);
/// `arguments` are those of the tool, first to last: the parameters of the shape are taken out of them.
void add_make_command(CLI::App& app, std::vector<std::string>& arguments);
void add_info_command(CLI::App& app);
void add_medial_command(CLI::App& app);
void add_verify_command(CLI::App& app);
void add_reconstruct_command(CLI::App& app);
void add_surface_command(CLI::App& app);
void add_view_command(CLI::App& app);

/// An axis that is not certified: exit status 3.
class NotCertified : public std::runtime_error {
 public:
  /// @param mismatches  why not.  @param rest  what else there is to say.
  explicit NotCertified(const std::vector<std::string>& mismatches, const std::string& rest = "");
};

}  // namespace blum::cli
