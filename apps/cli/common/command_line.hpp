// Blum: the command line as the commands see it. SPDX-License-Identifier: Apache-2.0
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

/// An option of a command, once it was added. CLI11 holds it, which command_line.cpp alone includes: its header takes
/// longer to compile than a command.
class CommandOption {
 public:
  explicit CommandOption(CLI::Option& option) : option_(&option) {}
  CommandOption required() const;
  /// What the help calls the value.
  CommandOption type_name(const std::string& name) const;
  /// One value each time it is given, of an option that may be given several times.
  CommandOption one_value_each() const;

 private:
  CLI::Option* option_;
};

/// The tool, or a subcommand of it.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}
  [[nodiscard]] Command add_subcommand(const std::string& name, const std::string& help) const;
  /// @param value  is set when the command line is read, and must live until then.
  CommandOption add_option(const std::string& name, std::string& value, const std::string& help) const;
  CommandOption add_option(const std::string& name, std::optional<std::string>& value, const std::string& help) const;
  CommandOption add_option(const std::string& name, std::vector<std::string>& values, const std::string& help) const;
  /// @param set  is called with the value.
  CommandOption add_option_function(const std::string& name, const std::function<void(const std::string&)>& set,
                                    const std::string& help) const;
  void add_flag(const std::string& name, bool& value, const std::string& help) const;
  /// @param set  is called where the flag is given.
  void add_flag_function(const std::string& name, std::function<void()> set, const std::string& help) const;
  /// One of its own subcommands must be given.
  void require_subcommand() const;
  /// What the help ends with.
  void footer(const std::string& text) const;
  /// What the command does.
  void callback(std::function<void()> run) const;

 private:
  CLI::App* app_;
};

/// What the tool says of itself.
struct ToolTexts {
  std::string name, about, version, footer;
};

/// Reads a command line and does what it asks for; prints help and version where these are asked for.
/// @param add_commands  adds the subcommands, and may change the arguments, which are read after it.
/// @throws UsageError, and what the command throws.
void run_command_line(const ToolTexts& texts, const std::function<void(const Command&)>& add_commands,
                      std::vector<std::string>& arguments);

}  // namespace blum::cli
