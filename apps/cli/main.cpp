#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "commands.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "summary.hpp"

namespace blum::cli {
namespace {

constexpr int exit_failure = 1;
constexpr int exit_usage = 2;
constexpr int exit_not_certified = 3;

constexpr const char* examples = R"(Examples:
  blum make torus_knot -o knot.ply                 a shape to start from
  blum info knot.ply                               what it is
  blum field knot.ply -o knot.nrrd                 its exact signed distance field
  blum slice knot.nrrd -o knot.png                 a picture of it
  blum slice knot.nrrd -o cells.png --show sites   the Voronoi diagram
  blum medial knot.ply -o axis.vtp                 its medial axis, certified
  blum view knot.ply knot.nrrd axis.vtp --open     all of it in a browser

`blum COMMAND --help` says more. Exit status: 0 done, 2 bad usage, 3 not certified, 1 any
other failure; Ctrl-C ends by SIGINT (130 in a shell).
Existing output files are only ever replaced by complete ones.)";

/// A word of the command line that is neither an option nor a command, where a command is due.
void check_command(const CLI::App& app, const std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments[0].empty() || arguments[0][0] == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), arguments[0]) != names.end()) return;
  throw UsageError("there is no command '" + arguments[0] + "'" + hint(similar_words(arguments[0], names)) +
                   "; the commands are " + join_words(names));
}

/// What CLI11 could make nothing of, with a hint for a misspelt option; empty where there is nothing.
std::string leftover_text(const CLI::App& command) {
  const std::vector<std::string> left = command.remaining(true);
  if (left.empty()) return {};
  const std::string word = left.front().substr(0, left.front().find('='));
  if (word.size() < 2 || word[0] != '-') {
    const CLI::Option* theta = command.get_option_no_throw("--theta");
    const bool is_angle = theta != nullptr && theta->count() == 1 && looks_like_number(word);
    return "'" + left.front() + "' was not expected" +
           (is_angle ? "; for several angles, --theta " + theta->results().front() + "," + word : "");
  }
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  if (word.size() == 2) {  // one letter: what begins with it
    std::erase_if(names, [&](const std::string& name) { return name[2] != word[1]; });
    return "there is no option " + word + hint(names);
  }
  return "there is no option " + word + hint(similar_words(word, names));
}

int fail(const std::string& message, int status) {
  std::fflush(stdout);
  std::fprintf(stderr, "blum: error: %s\n", message.c_str());
  return status;
}

/// CLI11's own exits: help and version are no errors.
int finish(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success)) {
    std::string message = error.what();
    while (!message.empty() && (message.back() == '\n' || message.back() == ' ')) message.pop_back();
    const auto used = app.get_subcommands();
    const std::string command = used.empty() ? "blum" : "blum " + used.front()->get_name();
    // A misspelt option leaves what it should have set missing: the first is the cause, and is said first.
    const std::string leftover = leftover_text(used.empty() ? app : *used.front());
    const bool only_leftover = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
    if (!leftover.empty()) message = only_leftover ? leftover : leftover + "; also: " + message;
    return fail(message + "; see `" + command + " --help`", exit_usage);
  }
  app.exit(error);  // prints the help or the version
  std::fflush(stdout);
  return 0;
}

void add_commands(CLI::App& app, std::vector<std::string>& arguments) {
  app.set_version_flag("--version", "blum " BLUM_VERSION, "Print the version");
  app.set_help_flag("-h,--help", "Print this help");
  app.footer(examples);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  const CommandLine line{app, arguments};
  for (const auto& add : commands) add(line);
}

int run(std::vector<std::string> arguments) {
  CLI::App app{"Exact distance fields, Voronoi diagrams and medial axes of meshes and voxel images", "blum"};
  try {
    add_commands(app, arguments);
    check_command(app, arguments);
    prepare_weld(arguments);
    if (arguments.empty()) arguments.emplace_back("--help");
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the back
    app.parse(arguments);
    return 0;
  } catch (const CLI::ParseError& error) {
    return finish(app, error);
  } catch (const NotCertified& error) {
    return fail(error.what(), exit_not_certified);
  } catch (const UsageError& error) {
    return fail(error.what(), exit_usage);
  } catch (const InvalidOption& error) {
    return fail(error.what(), exit_usage);
  } catch (const Cancelled&) {
    static_cast<void>(fail("cancelled", exit_failure));
    end_by_last_signal();
    return exit_failure;
  } catch (const std::bad_alloc&) {
    return fail("out of memory; use a coarser grid or a machine with more memory", exit_failure);
  } catch (const std::exception& error) {
    return fail(error.what(), exit_failure);
  }
}

/// Each step of the long computations takes and gives back arrays of megabytes. By default, glibc gives these back to
/// the system at once, which then clears their pages for the next step: a tenth of the time. Kept, they may be a
/// quarter more.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int mebibyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 1024 * mebibyte);
  mallopt(M_TRIM_THRESHOLD, 2047 * mebibyte);
  mallopt(M_TOP_PAD, 128 * mebibyte);
#endif
}

}  // namespace
}  // namespace blum::cli

int main(int count, char** values) {
  try {
    blum::cli::keep_freed_memory();
    return blum::cli::run(std::vector<std::string>(values + std::min(count, 1), values + count));
  } catch (...) {
    std::fputs("blum: error: unexpected failure\n", stderr);
    return 1;
  }
}
