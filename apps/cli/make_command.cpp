#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/geometry/shape_catalog.hpp"
#include "blum/io/mesh_io.hpp"
#include "commands.hpp"
#include "files.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "summary.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum make --list                                 every shape with its parameters
  blum make torus --list                           those of one shape
  blum make torus -o torus.obj --ring-radius 2 --tube-radius 0.5)";

struct Arguments {
  std::string shape;
  std::string output;
  bool list = false;
  std::vector<std::pair<std::string, std::string>> parameters;  ///< name without dashes, value as text
  ReportOptions report;
};

/// `torus-knot` and `Torus_Knot` are one name.
std::string plain_name(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](char c) {
    if (c == '-') return '_';
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return name;
}

/// `ring_radius` as an option: --ring-radius.
std::string option_name(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name;
}

bool is_own_option(const std::string& name) {
  constexpr const char* own[] = {"--output", "--list", "--json", "--quiet", "--help"};
  return std::find(std::begin(own), std::end(own), name) != std::end(own);
}

/// Takes `--name value` and `--name=value` out of the arguments, unless they are the command's own options.
std::vector<std::pair<std::string, std::string>> take_parameters(std::vector<std::string>& arguments) {
  std::vector<std::pair<std::string, std::string>> parameters;
  std::vector<std::string> rest = {"make"};
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    const bool takes_value = argument == "-o" || argument == "--output" || argument == "--json";
    if (name.size() < 3 || name.substr(0, 2) != "--" || is_own_option(name)) {
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

const ShapeInfo& find(const std::string& given) {
  const std::string name = plain_name(given);
  std::vector<std::string> names;
  for (const ShapeInfo& shape : shape_catalog()) {
    if (shape.name == name) return shape;
    names.push_back(shape.name);
  }
  const std::vector<std::string> similar = similar_words(name, names);
  throw UsageError("there is no shape '" + given + "'" +
                   (similar.empty() ? "" : "; did you mean " + join_words(similar, "or") + "?") +
                   " (`blum make --list` lists all)");
}

ShapeParameters read_parameters(const ShapeInfo& shape, const Arguments& a) {
  ShapeParameters values;
  std::vector<std::string> names;
  for (const ShapeParameter& parameter : shape.parameters) names.push_back(option_name(parameter.name));
  for (const auto& [given, text] : a.parameters) {
    const std::string name = plain_name(given);
    const auto known = std::find_if(shape.parameters.begin(), shape.parameters.end(),
                                    [&](const ShapeParameter& parameter) { return parameter.name == name; });
    if (known == shape.parameters.end()) {
      throw UsageError(shape.name + " has no parameter --" + given + "; it has " +
                       (names.empty() ? "none" : join_words(names)));
    }
    const double value = parse_number("--" + given, text);
    if (value < known->minimum || value > known->maximum) {
      throw UsageError("--" + given + " '" + text + "': must be between " + number_text(known->minimum) + " and " +
                       number_text(known->maximum));
    }
    if (known->integer && value != std::trunc(value)) {
      throw UsageError("--" + given + " '" + text + "': must be a whole number");
    }
    if (!values.emplace(name, value).second) throw UsageError("--" + given + " is given twice");
  }
  return values;
}

// ---- Listing ----

Json shape_json(const ShapeInfo& shape) {
  Json parameters = Json::array();
  for (const ShapeParameter& p : shape.parameters) {
    parameters.push_back({{"name", p.name},
                          {"description", p.description},
                          {"default", p.default_value},
                          {"minimum", p.minimum},
                          {"maximum", p.maximum},
                          {"integer", p.integer}});
  }
  return {{"name", shape.name}, {"kind", "mesh"}, {"description", shape.description}, {"parameters", parameters}};
}

std::string shape_text(const ShapeInfo& shape) {
  TextTable table;
  for (const ShapeParameter& p : shape.parameters) {
    table.add("    " + option_name(p.name) + " " + number_text(p.default_value),
              p.description + " (" + number_text(p.minimum) + " to " + number_text(p.maximum) +
                  (p.integer ? ", whole)" : ")"));
  }
  return shape.name + ": " + shape.description + "\n" + table.text();
}

void list(const Arguments& a) {
  Json shapes = Json::array();
  std::string text;
  for (const ShapeInfo& shape : shape_catalog()) {
    if (!a.shape.empty() && &shape != &find(a.shape)) continue;
    shapes.push_back(shape_json(shape));
    text += (text.empty() ? "" : "\n") + shape_text(shape);
  }
  report(a.report, {{"blum_version", BLUM_VERSION}, {"shapes", shapes}}, text);
}

// ---- Making ----

void make(const Arguments& a) {
  const ShapeInfo& shape = find(a.shape);
  const ShapeParameters given = read_parameters(shape, a);
  const ShapeParameters parameters = complete_parameters(shape, given);
  const fs::path output = a.output;
  check_extension("--output", output, {".obj", ".off", ".stl", ".ply"});
  std::vector<fs::path> files = a.report.files();
  files.push_back(output);
  check_outputs(files, {});

  const TriangleMesh mesh = make_shape(shape.name, parameters);
  {
    const Interrupt finish_the_file;
    write_mesh(output, mesh);
  }
  const std::optional<std::array<std::int64_t, 3>> betti = shape.betti(parameters);
  Json json = {{"blum_version", BLUM_VERSION},
               {"command", "make"},
               {"shape", shape.name},
               {"parameters", Json(parameters)},
               {"vertices", mesh.vertices.size()},
               {"triangles", mesh.triangles.size()},
               {"segments", mesh.segments.size()},
               {"points", mesh.points.size()},
               {"bounds", to_json(bounds(mesh))},
               {"betti", betti ? Json(*betti) : Json(nullptr)},
               {"outputs", Json::array({output.string()})}};
  report(a.report, json,
         "wrote " + output.string() + ": " + shape.name + ", " + plural(mesh.vertices.size(), "vertex", "vertices") +
             ", " + plural(mesh.triangles.size(), "triangle", "triangles") + "\n");
}

void run(const Arguments& a) {
  if (a.list) {
    if (!a.output.empty()) throw UsageError("--list and --output cannot be used together");
    if (!a.parameters.empty()) throw UsageError("--list takes no parameters");
    check_outputs(a.report.files(), {});
    return list(a);
  }
  if (a.shape.empty()) throw UsageError("SHAPE is required; `blum make --list` lists all");
  static_cast<void>(find(a.shape));
  if (a.output.empty()) throw UsageError("--output is required; name a .obj, .off, .stl or .ply file");
  make(a);
}

}  // namespace

void add_make_command(CLI::App& app, std::vector<std::string>& arguments) {
  auto a = std::make_shared<Arguments>();
  if (!arguments.empty() && arguments[0] == "make") a->parameters = take_parameters(arguments);
  CLI::App* command = app.add_subcommand("make", "Make a shape to test with or to start from");
  command->add_option("SHAPE", a->shape, "Name of a shape; its parameters are given as --name value");
  command->add_option("-o,--output", a->output, "Mesh file: .obj, .off, .stl or .ply")->type_name("FILE");
  command->add_flag("--list", a->list, "List all shapes, or one, with parameters, defaults and ranges");
  command->add_option("--json", a->report.json, "Write what was made (or the list) as JSON; - is standard output")
      ->type_name("FILE");
  command->add_flag("--quiet", a->report.quiet, "Say nothing but errors");
  command->footer(examples);
  command->callback([a] { run(*a); });
}

}  // namespace blum::cli
