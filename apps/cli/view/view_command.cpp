#include <spawn.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"
#include "view/frames_scene.hpp"
#include "view/view_page.hpp"
#include "view/view_scene.hpp"
#include "view/view_server.hpp"

namespace blum::cli {
namespace {

constexpr const char* examples = R"(Examples:
  blum view part.stl                              print an address and serve the page until Ctrl-C
  blum view part.ply part.nrrd axis.npz --open    a mesh, its field and its medial axis, in a browser
  blum view map.npz other.ply                     a surface map as colours, with the other mesh
  blum view part.ply axis.npz -o part.html        write one file, for a browser without a network
  blum view f*.ply --frames --pairs pairs.json    meshes as frames of a moving scene, with close pairs

The page lists files that cannot be read. Exit status 1: no file could be read.
The server answers only this machine. It serves only the page and the contents of the given files.)";

struct Arguments {
  std::vector<std::string> inputs;
  std::optional<std::string> output, pairs, port, weld;
  bool frames = false;
  bool open = false;
  bool quiet = false;
};

void check(const Arguments& a) {
  for (const std::string& input : a.inputs) {
    if (input.empty()) throw UsageError("FILE needs a file name");
  }
  exclude(a.output.has_value(), "--output", a.port.has_value(), "--port", "a written page is not served");
  exclude(a.output.has_value(), "--output", a.open, "--open", "only a served page is opened");
  if (a.frames && a.inputs.size() < 2) throw UsageError("--frames needs at least two meshes, in their order");
  if (a.pairs && !a.frames) throw UsageError("--pairs needs --frames");
  std::vector<std::filesystem::path> outputs;
  if (a.output) {
    check_extension("--output", *a.output, {".html", ".htm"});
    outputs.emplace_back(*a.output);
  }
  std::vector<std::filesystem::path> inputs(a.inputs.begin(), a.inputs.end());
  if (a.pairs) inputs.emplace_back(*a.pairs);
  check_outputs(outputs, inputs);
}

/// Opens a page in the desktop's browser. If there is no browser, users can still open the address printed on the
/// terminal.
void open_browser(const std::string& url) {
  std::string program = "xdg-open";
  std::string address = url;
  char* const arguments[] = {program.data(), address.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ) != 0) {
    warn_of("no browser could be opened (xdg-open was not found); open " + url);
  }
}

std::string kind_text(const Json& item) {
  if (item["kind"].text() == "axis" || item["kind"].text() == "mesh") return item["content"].text();
  if (item["kind"].text() == "map") return "surface map";
  if (item["kind"].text() == "frames") return std::to_string(item["frames"].size()) + " frames";
  return item["kind"].text();
}

std::string shown_text(const Scene& scene) {
  std::string names;
  for (const Json& item : scene.header["items"]) {
    if (item["kind"].text() == "error") continue;
    names += (names.empty() ? "" : ", ") + item["name"].text() + " (" + kind_text(item) + ")";
  }
  return names;
}

void run(const Arguments& a) {
  check(a);
  const std::optional<std::uint16_t> port =
      a.port ? std::optional(static_cast<std::uint16_t>(parse_integer("--port", *a.port, 0, 65535))) : std::nullopt;
  const std::optional<double> weld = parse_weld(a.weld);
  Progress progress(!a.quiet);
  const Interrupt interrupt;
  const Context context = make_context(0, progress, interrupt);
  std::optional<ViewServer> server;
  if (!a.output) server.emplace(port.value_or(0));  // started before the work, because the port may be in use
  const Scene scene = [&] {
    const Unattended reading;
    const std::vector<std::filesystem::path> files(a.inputs.begin(), a.inputs.end());
    if (a.frames) return make_frames_scene(files, a.pairs, weld, a.output.has_value(), context);
    return make_scene(files, weld, a.output.has_value(), context);
  }();
  progress.clear();
  if (scene.problems.size() == a.inputs.size()) throw FileError(join_words(scene.problems));
  for (const std::string& problem : scene.problems) warn_of(problem);
  if (a.output) {
    write_page(*a.output, scene);
    if (!a.quiet) print("wrote " + *a.output + ": " + shown_text(scene) + "\n");
    return;
  }
  print("serving " + shown_text(scene) + "\nopen " + server->url() + " in a browser; Ctrl-C ends the server\n");
  if (a.open) open_browser(server->url());
  server->serve(scene, interrupt.token());
}

}  // namespace

void add_view_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command =
      line.app.add_subcommand("view", "Show files in a browser: meshes, images, fields, medial axes, surface maps");
  command
      .add_option("FILE", a->inputs, "Meshes, images, fields, medial axes, diagrams and surface maps, in any mixture")
      .required();
  add_text_option(command, "-o,--output", a->output, "HTML",
                  "Write the page with its data to a file, instead of serving it");
  command.add_flag("--frames", a->frames, "The files are meshes, one for each frame of a moving scene, in their order");
  add_text_option(command, "--pairs", a->pairs, "JSON",
                  "With --frames: file with the close pairs and durations of each frame (docs/guide/viewer.md)");
  add_text_option(command, "--port", a->port, "P", "Port of the server, 0 to 65535 (default 0: a free port)");
  command.add_flag("--open", a->open, "Open the served page in the desktop's browser");
  add_weld_option(command, a->weld);
  command.add_flag("--quiet", a->quiet, "Print only errors, warnings and the address of the page");
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
