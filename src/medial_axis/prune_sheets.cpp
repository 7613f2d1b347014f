#include "blum/medial_axis/prune_sheets.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <queue>
#include <utility>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "medial_axis/label_sheets.hpp"

namespace blum {
namespace {

using VertexPair = std::array<std::uint32_t, 2>;

constexpr std::uint32_t none = 0xffffffffU;
constexpr std::size_t steps_between_looks = std::size_t{1} << 16U;

VertexPair ordered(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

class Pruner {
 public:
  Pruner(const MedialComplex& axis, double theta, const Context& context)
      : axis_(axis), theta_(theta), context_(context) {
    find_edges();
    find_sheets();
  }

  void prune() {
    Line line;
    for (std::uint32_t s = 0; s < angle_of_sheet_.size(); ++s) offer(s, line);
    while (!line.empty()) {
      const std::uint32_t sheet = line.top().second;
      line.pop();
      is_in_line_[sheet] = false;
      if (is_sheet_gone_[sheet] || !consume(sheet)) continue;
      is_sheet_gone_[sheet] = true;
      trim(sheet);
      for (const std::uint32_t t : triangles_of_sheet_[sheet]) {
        for (const std::uint32_t e : sides_[t]) {
          for (const std::uint32_t other : triangles_of_edge(e)) offer(axis_.triangles[other].sheet, line);
        }
      }
    }
    trim_curves();
  }

  [[nodiscard]] MedialComplex result() const {
    MedialComplex out;
    std::vector<std::uint32_t> number(axis_.vertices.size(), none);
    for (std::uint32_t v = 0; v < number.size(); ++v) {
      if (is_vertex_gone_[v]) continue;
      number[v] = static_cast<std::uint32_t>(out.vertices.size());
      out.vertices.push_back(axis_.vertices[v]);
    }
    for (std::uint32_t t = 0; t < axis_.triangles.size(); ++t) {
      if (is_triangle_gone_[t]) continue;
      MedialTriangle triangle = axis_.triangles[t];
      for (std::uint32_t& v : triangle.vertices) v = number[v];
      out.triangles.push_back(triangle);
    }
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      if (is_edge_gone_[e] || triangle_count_[e] > 0) continue;
      out.edges.push_back({{number[edges_[e][0]], number[edges_[e][1]]}, angle_of_edge_[e], MedialRole::curve});
    }
    label_sheets(out);
    return out;
  }

 private:
  /// By rising angle, then number.
  using Waiting = std::pair<float, std::uint32_t>;
  using Line = std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>>;

  void find_edges() {
    for (const MedialTriangle& t : axis_.triangles) {
      for (std::size_t k = 0; k < 3; ++k) edges_.push_back(ordered(t.vertices[k], t.vertices[(k + 1) % 3]));
    }
    for (const MedialEdge& edge : axis_.edges) edges_.push_back(ordered(edge.vertices[0], edge.vertices[1]));
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    angle_of_edge_.assign(edges_.size(), 0);
    for (const MedialEdge& edge : axis_.edges) {
      angle_of_edge_[edge_of(edge.vertices[0], edge.vertices[1])] = edge.separation_angle;
    }
    first_triangle_.assign(edges_.size() + 1, 0);
    first_edge_.assign(axis_.vertices.size() + 1, 0);
    sides_.reserve(axis_.triangles.size());
    for (const MedialTriangle& t : axis_.triangles) {
      std::array<std::uint32_t, 3> own{};
      for (std::size_t k = 0; k < 3; ++k) {
        own[k] = edge_of(t.vertices[k], t.vertices[(k + 1) % 3]);
        angle_of_edge_[own[k]] = std::max(angle_of_edge_[own[k]], t.separation_angle);
        ++first_triangle_[own[k] + 1];
      }
      sides_.push_back(own);
    }
    for (const VertexPair& edge : edges_) {
      for (const std::uint32_t v : edge) ++first_edge_[v + 1];
    }
    for (std::size_t e = 0; e + 1 < first_triangle_.size(); ++e) first_triangle_[e + 1] += first_triangle_[e];
    for (std::size_t v = 0; v + 1 < first_edge_.size(); ++v) first_edge_[v + 1] += first_edge_[v];
    around_edge_.resize(first_triangle_.back());
    around_vertex_.resize(first_edge_.back());
    std::vector<std::uint32_t> next(first_triangle_.begin(), first_triangle_.end() - 1);
    for (std::uint32_t t = 0; t < sides_.size(); ++t) {
      for (const std::uint32_t e : sides_[t]) around_edge_[next[e]++] = t;
    }
    next.assign(first_edge_.begin(), first_edge_.end() - 1);
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      for (const std::uint32_t v : edges_[e]) around_vertex_[next[v]++] = e;
    }
    for (std::size_t e = 0; e < edges_.size(); ++e)
      triangle_count_.push_back(first_triangle_[e + 1] - first_triangle_[e]);
    for (std::size_t v = 0; v < axis_.vertices.size(); ++v) edge_count_.push_back(first_edge_[v + 1] - first_edge_[v]);
    is_triangle_gone_.assign(axis_.triangles.size(), false);
    is_edge_gone_.assign(edges_.size(), false);
    is_vertex_gone_.assign(axis_.vertices.size(), false);
  }

  void find_sheets() {
    triangles_of_sheet_.resize(axis_.sheet_count);
    angle_of_sheet_.assign(axis_.sheet_count, 0);
    for (std::uint32_t t = 0; t < axis_.triangles.size(); ++t) {
      const MedialTriangle& triangle = axis_.triangles[t];
      triangles_of_sheet_[triangle.sheet].push_back(t);
      float& angle = angle_of_sheet_[triangle.sheet];
      angle = std::max(angle, triangle.separation_angle);
    }
    is_sheet_gone_.assign(axis_.sheet_count, false);
    is_in_line_.assign(axis_.sheet_count, false);
  }

  [[nodiscard]] std::uint32_t edge_of(std::uint32_t a, std::uint32_t b) const {
    return static_cast<std::uint32_t>(std::lower_bound(edges_.begin(), edges_.end(), ordered(a, b)) - edges_.begin());
  }
  [[nodiscard]] std::vector<std::uint32_t> triangles_of_edge(std::uint32_t e) const {
    std::vector<std::uint32_t> out;
    for (std::uint32_t k = first_triangle_[e]; k < first_triangle_[e + 1]; ++k) {
      if (!is_triangle_gone_[around_edge_[k]]) out.push_back(around_edge_[k]);
    }
    return out;
  }

  void offer(std::uint32_t sheet, Line& line) {
    if (is_sheet_gone_[sheet] || is_in_line_[sheet] || angle_of_sheet_[sheet] > theta_) return;
    is_in_line_[sheet] = true;
    line.emplace(angle_of_sheet_[sheet], sheet);
  }
  void look() {
    if (++steps_ % steps_between_looks == 0) throw_if_cancelled(context_);
  }

  /// The triangle that is a sheet's last one at an edge that no other has; none where there is no such triangle.
  [[nodiscard]] std::uint32_t free_triangle(std::uint32_t e, std::uint32_t sheet) const {
    if (is_edge_gone_[e] || triangle_count_[e] != 1) return none;
    for (std::uint32_t k = first_triangle_[e]; k < first_triangle_[e + 1]; ++k) {
      const std::uint32_t t = around_edge_[k];
      if (!is_triangle_gone_[t]) return axis_.triangles[t].sheet == sheet ? t : none;
    }
    return none;
  }

  void set_pair(std::uint32_t e, std::uint32_t t, bool is_gone) {
    is_edge_gone_[e] = is_gone;
    is_triangle_gone_[t] = is_gone;
    for (const std::uint32_t side : sides_[t]) triangle_count_[side] += is_gone ? -1U : 1U;
    for (const std::uint32_t v : edges_[e]) edge_count_[v] += is_gone ? -1U : 1U;
  }

  /// Collapses a sheet from its rim; puts everything back unless all of it goes.
  bool consume(std::uint32_t sheet) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> gone;
    std::vector<std::uint32_t> line;
    for (const std::uint32_t t : triangles_of_sheet_[sheet])
      line.insert(line.end(), sides_[t].begin(), sides_[t].end());
    for (std::size_t next = 0; next < line.size(); ++next) {
      look();
      const std::uint32_t t = free_triangle(line[next], sheet);
      if (t == none) continue;
      set_pair(line[next], t, true);
      gone.emplace_back(line[next], t);
      line.insert(line.end(), sides_[t].begin(), sides_[t].end());
    }
    if (gone.size() == triangles_of_sheet_[sheet].size()) return true;
    for (; !gone.empty(); gone.pop_back()) set_pair(gone.back().first, gone.back().second, false);
    return false;
  }

  /// Removes curves from a free end on, as long as `goes` says so of their edges.
  template <class Goes>
  void trim_from(std::uint32_t vertex, const Goes& goes) {
    while (vertex != none && !is_vertex_gone_[vertex] && edge_count_[vertex] == 1) {
      look();
      std::uint32_t edge = none;
      for (std::uint32_t k = first_edge_[vertex]; k < first_edge_[vertex + 1]; ++k) {
        if (!is_edge_gone_[around_vertex_[k]]) edge = around_vertex_[k];
      }
      if (edge == none || triangle_count_[edge] > 0 || !goes(edge)) return;
      is_edge_gone_[edge] = true;
      is_vertex_gone_[vertex] = true;
      --edge_count_[vertex];
      const std::uint32_t other = edges_[edge][0] == vertex ? edges_[edge][1] : edges_[edge][0];
      --edge_count_[other];
      vertex = other;
    }
  }

  /// What a sheet leaves behind besides its neighbours is nobody's: it goes from its free ends.
  void trim(std::uint32_t sheet) {
    std::vector<std::uint32_t> own;
    for (const std::uint32_t t : triangles_of_sheet_[sheet]) own.insert(own.end(), sides_[t].begin(), sides_[t].end());
    std::sort(own.begin(), own.end());
    const auto is_own = [&](std::uint32_t e) { return std::binary_search(own.begin(), own.end(), e); };
    for (const std::uint32_t e : own) {
      for (const std::uint32_t v : edges_[e]) trim_from(v, is_own);
    }
  }
  void trim_curves() {
    const auto is_weak = [&](std::uint32_t e) { return angle_of_edge_[e] <= theta_; };
    for (std::uint32_t v = 0; v < edge_count_.size(); ++v) trim_from(v, is_weak);
  }

  const MedialComplex& axis_;
  double theta_;
  const Context& context_;
  std::vector<VertexPair> edges_;  ///< sorted
  std::vector<float> angle_of_edge_;
  std::vector<std::array<std::uint32_t, 3>> sides_;  ///< of triangles
  std::vector<std::uint32_t> first_triangle_, around_edge_;
  std::vector<std::uint32_t> first_edge_, around_vertex_;
  std::vector<std::uint32_t> triangle_count_;  ///< that are left, per edge
  std::vector<std::uint32_t> edge_count_;      ///< that are left, per vertex
  std::vector<bool> is_triangle_gone_, is_edge_gone_, is_vertex_gone_;
  std::vector<std::vector<std::uint32_t>> triangles_of_sheet_;
  std::vector<float> angle_of_sheet_;
  std::vector<bool> is_sheet_gone_, is_in_line_;
  std::size_t steps_ = 0;
};

}  // namespace

MedialComplex prune_sheets(const MedialComplex& axis, double theta, const Context& context) {
  if (!(theta >= 0 && theta <= 180)) {
    throw InvalidOption("theta is " + exact_text(theta) + " degrees, but must be 0 to 180");
  }
  Pruner pruner(axis, theta, context);
  pruner.prune();
  return pruner.result();
}

}  // namespace blum
