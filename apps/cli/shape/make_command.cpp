#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/parameters.hpp"
#include "blum/grid/image_generators.hpp"
#include "blum/io/image_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum make --list                                 list all shapes with their parameters
  blum make torus --list                           list the parameters of one shape
  blum make torus -o torus.obj --ring-radius 2 --tube-radius 0.5
  blum make sphere -o rough.ply --noise 0.02
  blum make ball -o ball.nrrd)";

struct Arguments {
  std::string shape;
  std::string output;
  bool list = false;
  std::vector<std::pair<std::string, std::string>> parameters;  ///< (name without dashes, value as text)
  ReportOptions report;
};

/// Returns the catalogue's name of a shape: torus_knot for `torus-knot` and `Torus_Knot`.
std::string plain_name(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](char c) {
    if (c == '-') return '_';
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return name;
}

/// Returns the option for a parameter: --ring-radius for `ring_radius`.
std::string option_name(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name;
}

/// Removes `--name value` and `--name=value` from the arguments and returns them, except for options of the command
/// itself.
std::vector<std::pair<std::string, std::string>> take_parameters(std::vector<std::string>& arguments,
                                                                 const Command& command) {
  std::vector<std::pair<std::string, std::string>> parameters;
  std::vector<std::string> rest = {"make"};
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    const bool takes_value = argument == "-o" || argument == "--output" || argument == "--json";
    if (name.size() < 3 || !name.starts_with("--") || command.has_option(name)) {
      rest.push_back(argument);
      if (takes_value && i + 1 < arguments.size()) rest.push_back(arguments[++i]);
    } else if (equals != std::string::npos) {
      parameters.emplace_back(name.substr(2), argument.substr(equals + 1));
    } else if (i + 1 < arguments.size()) {
      parameters.emplace_back(name.substr(2), arguments[++i]);
    } else {
      throw UsageError(name + " needs a value; see `blum make --list`");
    }
  }
  arguments = std::move(rest);
  return parameters;
}

/// Shape from the catalogue of meshes or that of images.
struct Recipe {
  std::string name;
  std::string description;
  std::vector<Parameter> parameters;
  const ShapeInfo* mesh = nullptr;
  const ImageInfo* image = nullptr;  ///< exactly one of these two pointers is set
};

/// Names of two additional parameters that every mesh has: they add noise.
constexpr const char* noise_name = "noise";
constexpr const char* noise_seed_name = "noise_seed";
std::vector<Parameter> noise_parameters() {
  return {{noise_name, "largest random displacement of a vertex, in mesh units", 0, 0, 1e6, false},
          {noise_seed_name, "seed of the noise", 1, 0, 1e9, true}};
}

std::vector<Recipe> recipes() {
  std::vector<Recipe> all;
  for (const ShapeInfo& shape : shape_catalog()) {
    all.push_back({shape.name, shape.description, shape.parameters, &shape, nullptr});
  }
  for (const ImageInfo& image : image_catalog()) {
    all.push_back({image.name, image.description, image.parameters, nullptr, &image});
  }
  std::sort(all.begin(), all.end(), [](const Recipe& a, const Recipe& b) { return a.name < b.name; });
  return all;
}

/// Finds a shape by its name. The suffix `_image` may be omitted: `ball` finds `ball_image`. @throws UsageError.
Recipe find(const std::string& given) {
  const std::string name = plain_name(given);
  std::vector<std::string> names;
  for (Recipe& recipe : recipes()) {
    if (recipe.name == name || (recipe.image != nullptr && recipe.name == name + "_image")) return std::move(recipe);
    names.push_back(recipe.name);
  }
  const std::vector<std::string> similar = similar_words(name, names);
  throw UsageError("there is no shape '" + given + "'" + hint(similar) + "; `blum make --list` lists all shapes");
}

double read_parameter(const Parameter& parameter, const std::string& given, const std::string& text) {
  const double value = parse_number("--" + given, text);
  if (value < parameter.minimum || value > parameter.maximum) {
    throw UsageError("--" + given + " '" + text + "': must be between " + rounded_text(parameter.minimum) + " and " +
                     rounded_text(parameter.maximum));
  }
  if (parameter.integer && value != std::trunc(value)) {
    throw UsageError("--" + given + " '" + text + "': must be a whole number");
  }
  return value;
}

ParameterValues read_parameters(const Recipe& recipe, const Arguments& a) {
  std::vector<Parameter> known = recipe.parameters;
  if (recipe.mesh != nullptr) {
    for (const Parameter& parameter : noise_parameters()) known.push_back(parameter);
  }
  std::vector<std::string> names;
  for (const Parameter& parameter : known) names.push_back(option_name(parameter.name));
  ParameterValues values;
  for (const auto& [given, text] : a.parameters) {
    const std::string name = plain_name(given);
    const auto found = std::find_if(known.begin(), known.end(), [&](const Parameter& p) { return p.name == name; });
    if (found == known.end()) {
      throw UsageError(recipe.name + " has no parameter --" + given + "; it has " + join_words(names));
    }
    if (!values.emplace(name, read_parameter(*found, given, text)).second) {
      throw UsageError("--" + given + " is given twice");
    }
  }
  return values;
}

// ---- Listing ----

Json parameters_json(const std::vector<Parameter>& parameters) {
  Json json = Json::array();
  for (const Parameter& p : parameters) {
    json.push_back({{"name", p.name},
                    {"description", p.description},
                    {"default", p.default_value},
                    {"minimum", p.minimum},
                    {"maximum", p.maximum},
                    {"integer", p.integer}});
  }
  return json;
}

std::string parameters_text(const std::vector<Parameter>& parameters) {
  TextTable table;
  for (const Parameter& p : parameters) {
    table.add("    " + option_name(p.name) + " " + rounded_text(p.default_value),
              p.description + " (" + rounded_text(p.minimum) + " to " + rounded_text(p.maximum) +
                  (p.integer ? ", whole)" : ")"));
  }
  return table.text();
}

void list(const Arguments& a) {
  Json shapes = Json::array();
  std::string text;
  std::vector<Recipe> shown = recipes();
  if (!a.shape.empty()) shown = {find(a.shape)};
  for (const Recipe& recipe : shown) {
    const char* kind = recipe.mesh != nullptr ? "mesh" : "image";
    shapes.push_back({{"name", recipe.name},
                      {"kind", kind},
                      {"description", recipe.description},
                      {"parameters", parameters_json(recipe.parameters)}});
    text += recipe.name + " (" + kind + "): " + recipe.description + "\n" + parameters_text(recipe.parameters) + "\n";
  }
  text += "every mesh\n" + parameters_text(noise_parameters());
  report(a.report, answer_json("make", {{"shapes", shapes}, {"every_mesh", parameters_json(noise_parameters())}}),
         text);
}

// ---- Making ----

Json made_json(const Recipe& recipe, const ParameterValues& parameters, const fs::path& output,
               const std::optional<std::array<std::int64_t, 3>>& betti) {
  Json given = Json::object();
  for (const auto& [name, value] : parameters) given[name] = value;
  return answer_json("make", {{"shape", recipe.name},
                              {"kind", recipe.mesh != nullptr ? "mesh" : "image"},
                              {"parameters", std::move(given)},
                              {"betti", to_json(betti)},
                              {"outputs", Json::array({output.string()})}});
}

void make_mesh(const Arguments& a, const Recipe& recipe, ParameterValues given) {
  double noise = 0;
  double seed = 1;
  if (const auto at = given.find(noise_name); at != given.end()) noise = at->second;
  if (const auto at = given.find(noise_seed_name); at != given.end()) seed = at->second;
  given.erase(noise_name);
  given.erase(noise_seed_name);
  const ParameterValues parameters = complete_parameters(recipe.name, recipe.parameters, given);
  TriangleMesh mesh = make_shape(recipe.name, parameters);
  if (noise > 0) mesh = make_noisy(mesh, noise, static_cast<std::uint64_t>(seed));
  {
    const Interrupt finish_the_file;
    write_mesh(a.output, mesh);
  }
  Json json = made_json(recipe, parameters, a.output, recipe.mesh->betti(parameters));
  json["noise"] = noise;
  json["vertices"] = mesh.vertices.size();
  json["triangles"] = mesh.triangles.size();
  json["segments"] = mesh.segments.size();
  json["points"] = mesh.points.size();
  json["bounds"] = to_json(bounds(mesh));
  report(a.report, json,
         "wrote " + a.output + ": " + recipe.name + ", " + plural(mesh.vertices.size(), "vertex", "vertices") + ", " +
             plural(mesh.triangles.size(), "triangle", "triangles") + "\n");
}

void make_voxels(const Arguments& a, const Recipe& recipe, const ParameterValues& given) {
  const ParameterValues parameters = complete_parameters(recipe.name, recipe.parameters, given);
  const VoxelImage image = make_image(recipe.name, parameters);
  {
    const Interrupt finish_the_file;
    write_image(a.output, image);
  }
  Json json = made_json(recipe, parameters, a.output, recipe.image->betti(parameters));
  json["grid"] = to_json(image.grid);
  report(a.report, json, "wrote " + a.output + ": " + recipe.name + ", " + size_text(image.grid) + " voxels\n");
}

void make(const Arguments& a) {
  const Recipe recipe = find(a.shape);
  const ParameterValues given = read_parameters(recipe, a);
  const bool is_mesh = recipe.mesh != nullptr;
  if (a.output.empty()) {
    throw UsageError(std::string("--output is required; give ") +
                     (is_mesh ? "an .obj, .off, .stl or .ply file" : "an .nrrd or .npy file"));
  }
  check_extension("--output", a.output,
                  file_extensions(is_mesh ? FileContent::mesh : FileContent::image, FileAccess::write));
  std::vector<fs::path> files = a.report.files();
  files.emplace_back(a.output);
  check_outputs(files, {});
  is_mesh ? make_mesh(a, recipe, given) : make_voxels(a, recipe, given);
}

void run(const Arguments& a) {
  if (a.list) {
    if (!a.output.empty()) throw UsageError("--list and --output cannot be used together");
    if (!a.parameters.empty()) throw UsageError("--list takes no parameters");
    check_outputs(a.report.files(), {});
    return list(a);
  }
  if (a.shape.empty()) throw UsageError("SHAPE is required; `blum make --list` lists all shapes");
  make(a);
}

}  // namespace

void add_make_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command = line.app.add_subcommand("make", "Make a sample mesh or image");
  command.add_option("SHAPE", a->shape, "Name of a shape; its parameters follow as --NAME VALUE");
  command
      .add_option(
          "-o,--output", a->output,
          extensions_help({FileContent::mesh, FileContent::image}, FileAccess::write) + ", depending on the shape")
      .type_name("FILE");
  command.add_flag("--list", a->list, "List all shapes, or SHAPE alone, with parameters, defaults and ranges");
  add_report_options(command, a->report, "Write the summary or the list as JSON; - is standard output");
  if (!line.arguments.empty() && line.arguments[0] == "make") a->parameters = take_parameters(line.arguments, command);
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
