#include "medial/axis_graph_file.hpp"

#include "common/common_options.hpp"
#include "common/files.hpp"

namespace blum::cli {
namespace {

namespace fs = std::filesystem;

constexpr double least_share = 0.01;  // smallest share of the axis's area

/// Among sheets with walls (parts between surfaces that face each other), returns the sheet with the smallest low
/// thickness; nullptr if there is none.
const AxisSheet* thinnest_wall(const AxisGraph& graph) {
  const AxisSheet* thinnest = nullptr;
  for (const AxisSheet& sheet : graph.sheets) {
    if (!(sheet.wall_area > 0) || sheet.wall_area < least_share * graph.area) continue;
    if (thinnest == nullptr || sheet.wall_thickness.low < thinnest->wall_thickness.low) thinnest = &sheet;
  }
  return thinnest;
}

}  // namespace

void add_graph_option(const Command& command, std::optional<std::string>& graph, const std::string& help) {
  add_text_option(command, "--graph", graph, "FILE",
                  help + " (" + extension_list(FileContent::graph, FileAccess::write) + ")");
}

std::optional<fs::path> parse_graph(const std::optional<std::string>& text) {
  if (!text) return std::nullopt;
  check_extension("--graph", *text, file_extensions(FileContent::graph, FileAccess::write));
  return fs::path(*text);
}

std::string graph_text(const AxisGraph& graph) {
  std::string text =
      plural(graph.sheets.size(), "sheet", "sheets") + ", " + plural(graph.seams.size(), "seam", "seams") + ", " +
      plural(graph.curves.size(), "curve", "curves") + ", " + plural(graph.junctions.size(), "junction", "junctions");
  if (const AxisSheet* const wall = thinnest_wall(graph)) {
    text += "; thinnest large wall: sheet " + std::to_string(wall->sheet) + ", " +
            rounded_text(wall->wall_thickness.low) + " thick (at least 1 % of the area)";
  }
  return text;
}

Json graph_json(const AxisGraph& graph, const fs::path& file) {
  const AxisSheet* const wall = thinnest_wall(graph);
  return {{"file", file.string()},
          {"sheets", graph.sheets.size()},
          {"seams", graph.seams.size()},
          {"curves", graph.curves.size()},
          {"junctions", graph.junctions.size()},
          {"area", graph.area},
          {"thinnest_wall", wall == nullptr ? Json(nullptr)
                                            : Json{{"sheet", wall->sheet},
                                                   {"thickness", to_json(wall->wall_thickness)},
                                                   {"area", wall->wall_area}}}};
}

}  // namespace blum::cli
