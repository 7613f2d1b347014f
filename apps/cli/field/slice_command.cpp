#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "blum/core/error.hpp"
#include "blum/io/field_io.hpp"
#include "blum/io/png_io.hpp"
#include "commands.hpp"
#include "common/files.hpp"
#include "common/options.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"
#include "field/slice_picture.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* examples = R"(Examples:
  blum slice bunny.nrrd -o middle.png
  blum slice bunny.nrrd -o low.png --axis y --index 40
  blum slice bunny.nrrd -o cut.png --axis x --position 0.25
  blum slice bunny.npz -o cells.png --show sites --scale 8)";

struct Arguments {
  std::string input;
  std::string output;
  std::optional<std::string> axis, index, position, show, scale;
  bool quiet = false;
};

std::size_t parse_axis(const std::string& text) {
  if (text == "x") return 0;
  if (text == "y") return 1;
  if (text == "z") return 2;
  throw UsageError("--axis '" + text + "': must be x, y or z");
}

/// If exactly one axis has a single layer, returns that axis; otherwise z.
std::size_t default_axis(const GridSpec& grid) {
  if (std::count(grid.size.begin(), grid.size.end(), 1) != 1) return 2;
  return static_cast<std::size_t>(std::find(grid.size.begin(), grid.size.end(), 1) - grid.size.begin());
}

/// Returns the layer closest to a position along a world axis. The grid's axis must be parallel to the world axis.
std::int64_t layer_at(const GridSpec& grid, std::size_t axis, double position) {
  const std::optional<double> along = along_world(grid, axis);
  if (!along)
    throw UsageError(
        "--position needs layers perpendicular to a world axis, but this field's layers are oblique; use --index");
  const double first = grid.origin[axis];
  const double last = first + *along * static_cast<double>(grid.size[axis] - 1) * grid.spacing[axis];
  const double layer = std::round((position - first) / (*along * grid.spacing[axis]));
  if (!(layer >= 0 && layer < static_cast<double>(grid.size[axis]))) {
    throw UsageError("--position lies outside the field, whose layers lie from " + rounded_text(first) + " to " +
                     rounded_text(last));
  }
  return static_cast<std::int64_t>(layer);
}

void run(const Arguments& a) {
  const fs::path input = a.input;
  const fs::path output = a.output;
  if (input.empty()) throw UsageError("FIELD needs a file name");
  check_extension("--output", output, {".png"});
  const bool sites = a.show && *a.show == "sites";
  if (a.show && !sites && *a.show != "distance") {
    throw UsageError("--show '" + *a.show + "': must be distance or sites");
  }
  std::optional<std::size_t> axis;
  if (a.axis) axis = parse_axis(*a.axis);
  std::optional<std::int64_t> index;
  if (a.index) index = parse_integer("--index", *a.index, 0, std::int64_t{1} << 40);
  std::optional<double> position;
  if (a.position) position = parse_number("--position", *a.position);
  if (index && position) throw UsageError("--index and --position both select the layer; give one");
  std::optional<double> scale;
  if (a.scale) scale = parse_positive("--scale", *a.scale);
  check_outputs({output}, files_of_field(input));

  check_may_be_field(input);
  const Field field = read_field(input);
  if (!axis) axis = default_axis(field.grid);
  const std::int64_t layers = field.grid.size[*axis];
  if (index && *index >= layers) {
    throw UsageError("--index '" + *a.index + "': the field has the layers 0 to " + std::to_string(layers - 1));
  }
  if (position) index = layer_at(field.grid, *axis, *position);
  if (sites && field.site.empty()) {
    throw FileError(
        "'" + input.string() + "' has no closest sites" +
        (file_extension(input) == ".nrrd"
             ? ": it was written without them, or '" + files_of_field(input).back().filename().string() + "' is missing"
             : std::string()));
  }
  const Slice slice = take_slice(field, *axis, index.value_or(layers / 2));
  const double pixels = scale.value_or(default_scale(slice));
  const Picture picture = sites ? sites_picture(slice, pixels, {}) : distance_picture(slice, pixels, {});
  {
    const Interrupt finish_the_file;
    write_png(output, picture);
  }
  if (!a.quiet) {
    warn(field.warnings);
    print("wrote " + output.string() + ": " + std::to_string(picture.width()) + " x " +
          std::to_string(picture.height()) + " pixels, " + slice.place + "\n");
  }
}

}  // namespace

void add_slice_command(const CommandLine& line) {
  auto a = std::make_shared<Arguments>();
  const Command command = line.app.add_subcommand("slice", "Picture of one layer of a field");
  command.add_option("FIELD", a->input, "Field file: .nrrd, .npz or .vti; also a .nrrd of floats from another program")
      .required();
  command.add_option("-o,--output", a->output, "Picture").required().type_name("PNG");
  command
      .add_option("--axis", a->axis,
                  "Axis perpendicular to the layer: x, y or z (default z; for a 2D field, the axis with one layer)")
      .type_name("AXIS");
  command.add_option("--index", a->index, "Number of the layer, counted from 0 (default: the middle layer)")
      .type_name("K");
  command.add_option("--position", a->position, "Position along the axis, in mesh units; the nearest layer is drawn")
      .type_name("P");
  command
      .add_option("--show", a->show,
                  "Values to draw: distance (with contour lines) or sites (Voronoi regions) (default distance)")
      .type_name("WHAT");
  command
      .add_option("--scale", a->scale,
                  "Pixels per grid step (default: a number that gives the longer side 800 to 4096 pixels)")
      .type_name("PIXELS");
  command.add_flag("--quiet", a->quiet, "Print errors only");
  command.footer(examples);
  command.callback([a] { run(*a); });
}

}  // namespace blum::cli
