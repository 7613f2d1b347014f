#include "common/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <optional>
#include <regex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "common/options.hpp"

namespace blum::cli {

CommandOption CommandOption::required() const {
  option_->required();
  return *this;
}

CommandOption CommandOption::type_name(const std::string& name) const {
  option_->type_name(name);
  return *this;
}

CommandOption CommandOption::one_value_each() const {
  option_->allow_extra_args(false);
  return *this;
}

Command Command::add_subcommand(const std::string& name, const std::string& help) const {
  return Command(*app_->add_subcommand(name, help));
}

CommandOption Command::add_option(const std::string& name, std::string& value, const std::string& help) const {
  return CommandOption(*app_->add_option(name, value, help));
}

CommandOption Command::add_option(const std::string& name, std::optional<std::string>& value,
                                  const std::string& help) const {
  return CommandOption(*app_->add_option(name, value, help));
}

CommandOption Command::add_option(const std::string& name, std::vector<std::string>& values,
                                  const std::string& help) const {
  return CommandOption(*app_->add_option(name, values, help));
}

CommandOption Command::add_option_function(const std::string& name, const std::function<void(const std::string&)>& set,
                                           const std::string& help) const {
  return CommandOption(*app_->add_option_function<std::string>(name, set, help));
}

void Command::add_flag(const std::string& name, bool& value, const std::string& help) const {
  app_->add_flag(name, value, help);
}

void Command::add_flag_function(const std::string& name, std::function<void()> set, const std::string& help) const {
  app_->add_flag_callback(name, std::move(set), help);
}

bool Command::has_option(const std::string& name) const {
  return app_->get_option_no_throw(name) != nullptr;
}

void Command::require_subcommand() const {
  app_->require_subcommand(1);
}

void Command::footer(const std::string& text) const {
  app_->footer(text);
}

namespace {

/// Replaces names of members in a message of the library, for example "max_cubes", by the names of the options that set
/// them.
std::string with_option_names(std::string text, const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      std::string member = name;
      std::replace(member.begin(), member.end(), '-', '_');
      if (member == name) continue;  // A name that is a single word may have another meaning in the message.
      text = std::regex_replace(text, std::regex("\\b" + member + "\\b"), "--" + name);
    }
  }
  return text;
}

}  // namespace

void Command::callback(std::function<void()> run) const {
  app_->callback([app = app_, run = std::move(run)] {
    try {
      run();
    } catch (const InvalidOption& error) {
      throw InvalidOption(with_option_names(error.what(), *app));
    }
  });
}

namespace {

/// If a subcommand is expected, rejects a word that is neither an option nor a subcommand.
void check_command(const CLI::App& app, std::span<const std::string> arguments) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const bool is_tool = app.get_parent() == nullptr;
  if (names.empty() || (arguments.empty() && is_tool)) return;
  // Only the tool itself, and commands with queries, have subcommands.
  const std::string kind = is_tool ? "command" : "query";
  const std::string all = std::string("the ") + (is_tool ? "commands" : "queries") + " are " + join_words(names);
  if (arguments.empty()) throw UsageError("a " + kind + " is missing; " + all);
  if (arguments[0].empty() || arguments[0][0] == '-') return;
  if (std::find(names.begin(), names.end(), arguments[0]) != names.end()) {
    return check_command(*app.get_subcommand(arguments[0]), arguments.subspan(1));
  }
  throw UsageError("there is no " + kind + " '" + arguments[0] + "'" + hint(similar_words(arguments[0], names)) + "; " +
                   all);
}

/// Returns the subcommand that was given on the command line. Appends its name and the names of its parents to `name`.
const CLI::App* used_command(const CLI::App* app, std::string& name) {
  for (auto used = app->get_subcommands(); !used.empty(); used = app->get_subcommands()) {
    app = used.front();
    name += " " + app->get_name();
  }
  return app;
}

/// Describes the first argument that CLI11 did not accept. For a misspelt option, adds similar options. Returns an
/// empty text if all were accepted.
std::string leftover_text(const CLI::App& command) {
  const std::vector<std::string> left = command.remaining(true);
  if (left.empty()) return {};
  const std::string word = left.front().substr(0, left.front().find('='));
  if (word.size() < 2 || word[0] != '-') {
    const CLI::Option* theta = command.get_option_no_throw("--theta");
    const bool is_angle = theta != nullptr && theta->count() == 1 && looks_like_number(word);
    return "'" + left.front() + "' was not expected" +
           (is_angle ? "; for several angles, use --theta " + theta->results().front() + "," + word : "");
  }
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  if (word.size() == 2) {  // a single letter: suggest options that start with it
    std::erase_if(names, [&](const std::string& name) { return name[2] != word[1]; });
    return "there is no option " + word + hint(names);
  }
  return "there is no option " + word + hint(similar_words(word, names));
}

/// If CLI11 ended to print help or version, prints it. Throws UsageError for all other errors.
void finish(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
    app.exit(error);
    std::fflush(stdout);
    return;
  }
  std::string message = error.what();
  while (!message.empty() && (message.back() == '\n' || message.back() == ' ')) message.pop_back();
  message = std::regex_replace(message, std::regex("^(\\S+): At Most 1 required but received \\d+$"),
                               "$1 may be given only once");
  std::string name = "blum";
  const CLI::App& command = *used_command(&app, name);
  // If an option is misspelt, CLI11 may report that the option is missing. So misspelt options are reported first.
  const std::string leftover = leftover_text(command);
  const bool only_leftover = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
  if (!leftover.empty()) message = only_leftover ? leftover : leftover + "; also: " + message;
  throw UsageError(message + "; see `" + name + " --help`");
}

}  // namespace

void run_command_line(const ToolTexts& texts, const std::function<void(const Command&)>& add_commands,
                      std::vector<std::string>& arguments) {
  CLI::App app{texts.about, texts.name};
  app.set_version_flag("--version", texts.version, "Print the version");
  app.set_help_flag("-h,--help", "Print this help");
  app.footer(texts.footer);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  add_commands(Command(app));
  check_command(app, arguments);
  if (arguments.empty()) arguments.emplace_back("--help");
  std::reverse(arguments.begin(), arguments.end());  // CLI11 reads arguments starting from the last one
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    finish(app, error);
  }
}

}  // namespace blum::cli
