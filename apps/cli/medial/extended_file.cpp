#include "medial/extended_file.hpp"

#include <string_view>

#include "blum/io/extended_io.hpp"
#include "blum/io/formats.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/files.hpp"
#include "common/options.hpp"

namespace blum::cli {

namespace fs = std::filesystem;

void add_extend_options(const Command& command, std::optional<std::string>& extend,
                        std::optional<std::string>& length) {
  const std::string names = extension_list(FileContent::extended_axis, FileAccess::write);
  add_text_option(command, "--extend", extend, "FILE",
                  "Also write the sheets, extended from their rims to the surface, as a mesh for shell elements (" +
                      names + "); best with --theta 110");
  add_text_option(command, "--extend-length", length, "N",
                  "With --extend: extend a rim by at most N times its radius; N is above 0 (default 4)");
}

std::optional<fs::path> parse_extend(const std::optional<std::string>& text) {
  if (!text) return std::nullopt;
  check_extension("--extend", *text, file_extensions(FileContent::extended_axis, FileAccess::write));
  return fs::path(*text);
}

ExtendOptions parse_extend_length(const std::optional<std::string>& text, bool has_extend) {
  ExtendOptions options;
  if (!text) return options;
  if (!has_extend) throw UsageError("--extend-length needs --extend");
  options.max_length = parse_positive("--extend-length", *text);
  return options;
}

std::string extended_text(const ExtendReport& report) {
  if (report.rim_vertices == 0) return "nothing: the axis has no rims";
  std::string text = "area from " + rounded_text(report.axis_area) + " to " + rounded_text(report.area) + " by " +
                     plural(report.triangles, "triangle", "triangles") + "; of " +
                     plural(report.rim_vertices, "rim vertex", "rim vertices") + ", " +
                     count_text(report.reached_border) + " now reach the surface";
  if (report.reached_sheet > 0) text += ", " + count_text(report.reached_sheet) + " now reach another sheet";
  if (report.at_border > 0) text += ", " + count_text(report.at_border) + " already were on the surface or a sheet";
  if (report.not_reached > 0) text += ", " + count_text(report.not_reached) + " reach nothing";
  if (report.seam_length > 0) text += "; sheets share edges of length " + rounded_text(report.seam_length);
  return text;
}

Json extended_json(const ExtendReport& report, const fs::path& file) {
  Json json{{"file", file.string()}};
  json.update(to_json(report));
  return json;
}

fs::path beside_axis(const fs::path& file, const fs::path& output, const fs::path& name) {
  fs::path out = file.parent_path() / file.stem();
  out += name.stem().string().substr(output.stem().string().size());
  out += file.extension();
  return out;
}

}  // namespace blum::cli
