#include "medial/centreline_files.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "blum/core/exact_text.hpp"
#include "blum/io/atomic_file.hpp"
#include "blum/io/complex_io.hpp"
#include "common/files.hpp"

namespace blum::cli {
namespace {

constexpr std::string_view csv_head =
    "label,branch,first_node,last_node,first_kind,last_kind,length,mean_radius,min_radius,points\n";

std::string label_text(const Centreline& line) {
  return line.label ? std::to_string(*line.label) : std::string();
}

std::string_view kind_text(const Centreline& line, std::int32_t node) {
  return node < 0 ? std::string_view("closed") : to_string(line.nodes[static_cast<std::size_t>(node)].kind);
}

void write_csv(AtomicFile& file, const Centrelines& lines) {
  file.write(csv_head);
  for (const Centreline& line : lines.labels) {
    for (std::size_t b = 0; b < line.branches.size(); ++b) {
      const CentrelineBranch& branch = line.branches[b];
      std::string row = label_text(line) + ',' + std::to_string(b);
      for (const std::int32_t node : branch.nodes) row += ',' + (node < 0 ? std::string() : std::to_string(node));
      for (const std::int32_t node : branch.nodes) row += ',' + std::string(kind_text(line, node));
      for (const double value : {branch.length, branch.mean_radius, branch.min_radius}) row += ',' + exact_text(value);
      file.write(row + ',' + std::to_string(branch.points.size()) + '\n');
    }
  }
}

void write_json(AtomicFile& file, const Centrelines& lines, const Json& head) {
  // Label by label, so that the text of one is in memory, and not of all.
  std::string text = head.dump(1);
  text.resize(text.rfind('\n'));
  file.write(text + ",\n \"labels\": [");
  for (std::size_t l = 0; l < lines.labels.size(); ++l) {
    file.write((l == 0 ? "\n  " : ",\n  ") + to_json(lines.labels[l]).dump());
  }
  file.write(lines.labels.empty() ? "]\n}\n" : "\n ]\n}\n");
}

/// Writes the points of a centreline from its nodes outwards, each with the line of the point before it.
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

  /// Writes a branch from a node on. @return the node at its other end; none where it was there before: the branch
  /// closes a loop, which is cut.
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

  /// @return the number of the line.
  std::int64_t add(const Vec3d& point, double radius, std::int64_t parent) {
    ++lines_;
    file_.write(std::to_string(lines_) + " 0 " + exact_text(point.x) + ' ' + exact_text(point.y) + ' ' +
                exact_text(point.z) + ' ' + exact_text(radius) + ' ' + std::to_string(parent) + '\n');
    return lines_;
  }

  AtomicFile& file_;
  std::vector<std::int64_t> node_line_;  ///< of each node; 0: not written yet
  std::int64_t lines_ = 0;
};

void write_swc(AtomicFile& file, const Centrelines& lines) {
  file.write("# n type x y z radius parent; written by Blum " BLUM_VERSION "\n");
  SwcWriter writer(file);
  for (const Centreline& line : lines.labels) {
    if (line.label) file.write("# label " + std::to_string(*line.label) + '\n');
    writer.write(line);
  }
}

}  // namespace

std::vector<std::string> centreline_extensions() {
  return {".json", ".csv", ".swc", ".vtp", ".ply", ".npz"};
}

void write_centrelines(const std::filesystem::path& path, const Centrelines& lines, const Json& head,
                       const Context& context) {
  const std::string extension = file_extension(path);
  if (extension == ".vtp" || extension == ".ply" || extension == ".npz") {
    write_complex(path, complex_of(lines), {{"content", "centreline"}}, {}, context);
    return;
  }
  AtomicFile file(path);
  if (extension == ".csv") {
    write_csv(file, lines);
  } else if (extension == ".swc") {
    write_swc(file, lines);
  } else {
    write_json(file, lines, head);
  }
  file.commit();
}

}  // namespace blum::cli
