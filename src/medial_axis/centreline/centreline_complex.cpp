#include <cstddef>
#include <cstdint>

#include "blum/medial_axis/centreline.hpp"

namespace blum {
namespace {

/// Builds a complex from centrelines, branch by branch.
class Builder {
 public:
  explicit Builder(const Centrelines& lines) {
    for (const Centreline& line : lines.labels) {
      const auto first_node = static_cast<std::uint32_t>(out_.positions.size());
      for (const CentrelineNode& node : line.nodes) add_vertex(node.position, node.radius);
      for (const CentrelineBranch& branch : line.branches) add(branch, line.label.value_or(0), first_node);
    }
  }

  Complex finish() {
    out_.vertex_columns = Columns(out_.positions.size());
    out_.vertex_columns.add({"radius", 1, std::move(radius_)});
    out_.edge_columns = Columns(out_.edges.size());
    out_.edge_columns.add({"label", 1, std::move(label_)});
    out_.edge_columns.add({"branch", 1, std::move(branch_)});
    out_.edge_columns.add({"length", 1, std::move(length_)});
    out_.edge_columns.add({"mean_radius", 1, std::move(mean_)});
    out_.edge_columns.add({"min_radius", 1, std::move(least_)});
    return std::move(out_);
  }

 private:
  std::uint32_t add_vertex(const Vec3d& position, double radius) {
    out_.positions.push_back(position);
    radius_.push_back(radius);
    return static_cast<std::uint32_t>(out_.positions.size() - 1);
  }

  void add(const CentrelineBranch& branch, std::int64_t label, std::uint32_t first_node) {
    const std::size_t count = branch.points.size();
    const bool is_closed = branch.nodes[0] < 0;
    const std::uint32_t start = is_closed ? add_vertex(branch.points[0], branch.radii[0])
                                          : first_node + static_cast<std::uint32_t>(branch.nodes[0]);
    const std::uint32_t end = is_closed ? start : first_node + static_cast<std::uint32_t>(branch.nodes[1]);
    std::uint32_t at = start;
    for (std::size_t p = 1; p < count; ++p) {
      const std::uint32_t next = p + 1 == count ? end : add_vertex(branch.points[p], branch.radii[p]);
      if (next == at) continue;
      out_.edges.push_back({at, next});
      label_.push_back(label);
      branch_.push_back(branches_);
      length_.push_back(branch.length);
      mean_.push_back(branch.mean_radius);
      least_.push_back(branch.min_radius);
      at = next;
    }
    ++branches_;
  }

  Complex out_;
  std::vector<double> radius_;
  std::vector<std::int64_t> label_;
  std::vector<std::int32_t> branch_;
  std::vector<double> length_;
  std::vector<double> mean_;
  std::vector<double> least_;
  std::int32_t branches_ = 0;
};

}  // namespace

Complex complex_of(const Centrelines& lines) {
  return Builder(lines).finish();
}

}  // namespace blum
