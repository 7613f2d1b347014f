#include "solid/model/collapse_cells.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace blum::detail {
namespace {

constexpr std::size_t steps_between_looks = std::size_t{1} << 18U;

class Collapse {
 public:
  Collapse(const ModelCells& cells, const Context& context)
      : cells_(cells), context_(context), is_there_(cells.size(), 1), cofaces_left_(cells.size(), 0) {
    first_coface_.assign(cells.size() + 1, 0);
    for (const std::uint32_t face : cells.faces) ++first_coface_[face + std::size_t{1}];
    for (std::size_t c = 0; c < cells.size(); ++c) {
      cofaces_left_[c] = first_coface_[c + 1];
      first_coface_[c + 1] += first_coface_[c];
    }
    cofaces_.resize(cells.faces.size());
    std::vector<std::uint32_t> next(first_coface_.begin(), first_coface_.end() - 1);
    for (std::uint32_t c = 0; c < cells.size(); ++c) {
      for (const std::uint32_t face : cells.faces_of(c)) cofaces_[next[face]++] = c;
    }
  }

  void run() {
    std::vector<std::uint32_t> line;
    for (int dimension = 2; dimension >= 0; --dimension) {
      for (std::uint32_t c = 0; c < cells_.size(); ++c) {
        if (cells_.dimension[c] == dimension && cofaces_left_[c] == 1) line.push_back(c);
      }
    }
    for (std::size_t k = 0; k < line.size(); ++k) {
      if (k % steps_between_looks == 0) throw_if_cancelled(context_);
      const std::uint32_t face = line[k];
      if (is_there_[face] == 0 || cofaces_left_[face] != 1) continue;
      const std::uint32_t cell = only_coface(face);
      is_there_[face] = is_there_[cell] = 0;
      for (const std::uint32_t gone : {cell, face}) {
        for (const std::uint32_t side : cells_.faces_of(gone)) {
          if (--cofaces_left_[side] == 1 && is_there_[side] != 0) line.push_back(side);
        }
      }
    }
  }

  [[nodiscard]] bool is_there(std::uint32_t cell) const { return is_there_[cell] != 0; }

 private:
  [[nodiscard]] std::uint32_t only_coface(std::uint32_t face) const {
    for (std::uint32_t k = first_coface_[face]; k < first_coface_[face + 1]; ++k) {
      if (is_there_[cofaces_[k]] != 0) return cofaces_[k];
    }
    return face;
  }

  const ModelCells& cells_;
  const Context& context_;
  std::vector<std::uint8_t> is_there_;
  std::vector<std::uint32_t> cofaces_left_;
  std::vector<std::uint32_t> first_coface_;
  std::vector<std::uint32_t> cofaces_;
};

}  // namespace

Complex collapse_cells(const ModelCells& cells, const Context& context) {
  Collapse collapse(cells, context);
  collapse.run();
  Complex out;
  std::vector<std::uint32_t> vertex(cells.size(), 0);
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    if (!collapse.is_there(c) || cells.dimension[c] == 3) continue;
    vertex[c] = static_cast<std::uint32_t>(out.positions.size());
    out.positions.push_back(cells.witness[c]);
  }
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    if (!collapse.is_there(c)) continue;
    for (const std::uint32_t side : cells.faces_of(c)) {
      if (cells.dimension[c] == 1) out.edges.push_back({vertex[c], vertex[side]});
      if (cells.dimension[c] != 2) continue;
      for (const std::uint32_t end : cells.faces_of(side)) {
        out.triangles.push_back({vertex[c], vertex[side], vertex[end]});
      }
    }
  }
  out.vertex_columns = Columns(out.positions.size());
  out.edge_columns = Columns(out.edges.size());
  out.triangle_columns = Columns(out.triangles.size());
  return out;
}

}  // namespace blum::detail
