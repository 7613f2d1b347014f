// Blum: the parsed command line, as commands read it. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace blum::cli {

/// Handle of an option of a command. CLI11 owns the option. Only command_line.cpp includes CLI11, because its header
/// takes longer to compile than a command.
class CommandOption {
 public:
  explicit CommandOption(CLI::Option& option) : option_(&option) {}
  CommandOption required() const;
  /// Sets the name that the help shows for the value.
  CommandOption type_name(const std::string& name) const;
  /// Allows the option to be repeated, with one value each time.
  CommandOption one_value_each() const;

 private:
  CLI::Option* option_;
};

/// The tool or one of its subcommands.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}
  [[nodiscard]] Command add_subcommand(const std::string& name, const std::string& help) const;
  /// @param value  receives the value when the command line is read. It must live until then.
  CommandOption add_option(const std::string& name, std::string& value, const std::string& help) const;
  CommandOption add_option(const std::string& name, std::optional<std::string>& value, const std::string& help) const;
  CommandOption add_option(const std::string& name, std::vector<std::string>& values, const std::string& help) const;
  /// @param set  called with the value.
  CommandOption add_option_function(const std::string& name, const std::function<void(const std::string&)>& set,
                                    const std::string& help) const;
  void add_flag(const std::string& name, bool& value, const std::string& help) const;
  /// @param set  called if the flag is given.
  void add_flag_function(const std::string& name, std::function<void()> set, const std::string& help) const;
  /// Returns true if the command has an option or flag of this name, with dashes.
  [[nodiscard]] bool has_option(const std::string& name) const;
  /// Requires that one of the command's subcommands is given.
  void require_subcommand() const;
  /// Sets the text at the end of the help.
  void footer(const std::string& text) const;
  /// Sets the function that runs the command.
  void callback(std::function<void()> run) const;

 private:
  CLI::App* app_;
};

/// Texts of the tool's help and version.
struct ToolTexts {
  std::string name, about, version, footer;
};

/// Reads a command line and runs the command that it requests. Prints help or version if requested.
/// @param add_commands  adds the subcommands. It may change the arguments, because they are read afterwards.
/// @throws UsageError for an invalid command line, and all exceptions of the command.
void run_command_line(const ToolTexts& texts, const std::function<void(const Command&)>& add_commands,
                      std::vector<std::string>& arguments);

}  // namespace blum::cli
