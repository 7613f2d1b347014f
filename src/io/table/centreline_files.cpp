#include "blum/io/centreline_io.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "blum/io/atomic_file.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/formats.hpp"
#include "io/format_table.hpp"
#include "io/graph/graph_files.hpp"
#include "io/table/table_files.hpp"

namespace blum {
namespace {

/// Branch of a label's centreline.
struct BranchRow {
  const Centreline* line = nullptr;
  std::size_t branch = 0;

  [[nodiscard]] const CentrelineBranch& operator*() const { return line->branches[branch]; }
  [[nodiscard]] std::string_view kind(std::int32_t node) const {
    return node < 0 ? std::string_view("closed") : to_string(line->nodes[static_cast<std::size_t>(node)].kind);
  }
};

std::vector<BranchRow> rows_of(const Centrelines& lines) {
  std::vector<BranchRow> rows;
  for (const Centreline& line : lines.labels) {
    for (std::size_t b = 0; b < line.branches.size(); ++b) rows.push_back({&line, b});
  }
  return rows;
}

void write_csv(const std::filesystem::path& path, const Centrelines& lines, const CentrelineFileInfo& /*info*/,
               const Context& context) {
  using tables::made_column;
  using Texts = std::span<std::string>;
  const std::vector<BranchRow> rows = rows_of(lines);
  const auto label = [&](std::size_t row, Texts out) {
    const std::optional<std::int64_t>& of_line = rows[row].line->label;
    out[0] = of_line ? std::to_string(*of_line) : "";
  };
  const auto branch = [&](std::size_t row, std::span<std::int64_t> out) {
    out[0] = static_cast<std::int64_t>(rows[row].branch);
  };
  const auto nodes = [&](std::size_t row, Texts out) {
    for (std::size_t k = 0; k < 2; ++k) {
      const std::int32_t node = (*rows[row]).nodes[k];
      out[k] = node < 0 ? "" : std::to_string(node);
      out[2 + k] = rows[row].kind(node);
    }
  };
  const auto lengths = [&](std::size_t row, std::span<double> out) {
    const CentrelineBranch& of = *rows[row];
    std::ranges::copy(std::array{of.length, of.mean_radius, of.min_radius}, out.begin());
  };
  const auto points = [&](std::size_t row, std::span<std::int64_t> out) {
    out[0] = static_cast<std::int64_t>((*rows[row]).points.size());
  };
  const tables::Table table{
      rows.size(),
      {made_column<std::string>("label", {}, label), made_column<std::int64_t>("branch", {}, branch),
       made_column<std::string>("nodes", {4}, nodes, {"first_node", "last_node", "first_kind", "last_kind"}),
       made_column<double>("lengths", {3}, lengths, {"length", "mean_radius", "min_radius"}),
       made_column<std::int64_t>("points", {}, points)}};
  tables::write_csv(path, table, context);
}

/// Returns a JSON object without its closing brace, so that a member can be added.
std::string opened(std::string_view object) {
  if (object.empty()) return "{";
  object = object.substr(0, object.rfind('}'));
  object = object.substr(0, object.find_last_not_of(" \n") + 1);
  return std::string(object) + (object == "{" ? "" : ",");
}

void write_json(const std::filesystem::path& path, const Centrelines& lines, const CentrelineFileInfo& info,
                const Context& /*context*/) {
  // The file is written label by label, so that the text of only one label is in memory.
  AtomicFile file(path);
  file.write(opened(info.head) + "\n \"labels\": [");
  for (std::size_t l = 0; l < lines.labels.size(); ++l) {
    file.write((l == 0 ? "\n  " : ",\n  ") + graph_files::json_of(lines.labels[l]).dump());
  }
  file.write(lines.labels.empty() ? "]\n}\n" : "\n ]\n}\n");
  file.commit();
}

/// Writer of the points of a centreline, starting from its nodes. Each point states the line number of the point before
/// it.
class SwcWriter {
 public:
  explicit SwcWriter(AtomicFile& file) : file_(file) {}

  void write(const Centreline& line) {
    node_line_.assign(line.nodes.size(), 0);
    std::vector<std::vector<std::size_t>> branches(line.nodes.size());
    for (std::size_t b = 0; b < line.branches.size(); ++b) {
      for (const std::int32_t node : line.branches[b].nodes) {
        if (node >= 0) branches[static_cast<std::size_t>(node)].push_back(b);
      }
    }
    std::vector<bool> is_done(line.branches.size(), false);
    for (std::size_t n = 0; n < line.nodes.size(); ++n) {
      if (node_line_[n] == 0) write_tree(line, branches, n, is_done);
    }
    for (const CentrelineBranch& branch : line.branches) {
      if (branch.nodes[0] >= 0) continue;
      std::int64_t at = -1;
      for (std::size_t p = 0; p + 1 < branch.points.size(); ++p) at = add(branch.points[p], branch.radii[p], at);
    }
  }

 private:
  void write_tree(const Centreline& line, const std::vector<std::vector<std::size_t>>& branches, std::size_t root,
                  std::vector<bool>& is_done) {
    node_line_[root] = add(line.nodes[root].position, line.nodes[root].radius, -1);
    std::vector<std::size_t> open{root};
    while (!open.empty()) {
      const std::size_t from = open.back();
      open.pop_back();
      for (const std::size_t b : branches[from]) {
        if (is_done[b]) continue;
        is_done[b] = true;
        if (const auto to = follow(line.branches[b], from)) open.push_back(*to);
      }
    }
  }

  /// Writes a branch, starting at a node.
  /// @return the node at its other end; none if that node has already been written. In that case the branch would close
  /// a loop, which is left open.
  std::optional<std::size_t> follow(const CentrelineBranch& branch, std::size_t from) {
    const bool is_forward = branch.nodes[0] == static_cast<std::int32_t>(from);
    const auto to = static_cast<std::size_t>(branch.nodes[is_forward ? 1 : 0]);
    const std::size_t count = branch.points.size();
    std::int64_t at = node_line_[from];
    for (std::size_t p = 1; p + 1 < count; ++p) {
      const std::size_t point = is_forward ? p : count - 1 - p;
      at = add(branch.points[point], branch.radii[point], at);
    }
    if (node_line_[to] != 0) return std::nullopt;
    const std::size_t last = is_forward ? count - 1 : 0;
    node_line_[to] = add(branch.points[last], branch.radii[last], at);
    return to;
  }

  /// Writes a line. @return the number of the line.
  std::int64_t add(const Vec3d& point, double radius, std::int64_t parent) {
    ++lines_;
    file_.write(std::to_string(lines_) + " 0 " + exact_text(point.x) + ' ' + exact_text(point.y) + ' ' +
                exact_text(point.z) + ' ' + exact_text(radius) + ' ' + std::to_string(parent) + '\n');
    return lines_;
  }

  AtomicFile& file_;
  std::vector<std::int64_t> node_line_;  ///< line number of each node; 0 if not written yet
  std::int64_t lines_ = 0;
};

void write_swc(const std::filesystem::path& path, const Centrelines& lines, const CentrelineFileInfo& info,
               const Context& /*context*/) {
  AtomicFile file(path);
  file.write("# n type x y z radius parent; written by Blum" + (info.version.empty() ? "" : " " + info.version) + "\n");
  SwcWriter writer(file);
  for (const Centreline& line : lines.labels) {
    if (line.label) file.write("# label " + std::to_string(*line.label) + '\n');
    writer.write(line);
  }
  file.commit();
}

void write_as_complex(const std::filesystem::path& path, const Centrelines& lines, const CentrelineFileInfo& /*info*/,
                      const Context& context) {
  write_complex(path, complex_of(lines), {{"content", "centreline"}}, {}, context);
}

}  // namespace

void write_centrelines(const std::filesystem::path& path, const Centrelines& lines, const CentrelineFileInfo& info,
                       const Context& context) {
  formats::code_of(CentrelineFormat::of(path, FileAccess::write)).write(path, lines, info, context);
}

constinit const formats::CentrelineCode formats::centreline_json{write_json};
constinit const formats::CentrelineCode formats::centreline_csv{write_csv};
constinit const formats::CentrelineCode formats::centreline_swc{write_swc};
constinit const formats::CentrelineCode formats::centreline_as_complex{write_as_complex};

}  // namespace blum
