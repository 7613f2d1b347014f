#include "medial_axis/cells/extra_incidence.hpp"

#include <algorithm>
#include <utility>

namespace blum {
namespace {

using Pair = std::array<Cell, 2>;

/// The second items of pairs, in a row for each first one.
IndexRows rows_of(std::vector<Pair> pairs, std::size_t rows) {
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::size_t> first(rows + 1, 0);
  std::vector<std::uint32_t> items;
  items.reserve(pairs.size());
  for (const auto& [row, item] : pairs) {
    ++first[row + std::size_t{1}];
    items.push_back(item);
  }
  for (std::size_t r = 0; r < rows; ++r) first[r + 1] += first[r];
  return {std::move(first), std::move(items)};
}

}  // namespace

ExtraIncidence::ExtraIncidence(BodyCells cells)
    : first_(cells.first),
      cells_(std::move(cells.extra)),
      faces_(std::move(cells.faces)),
      mixed_(cells.lattice),
      replaced_(std::move(cells.replaced)) {
  std::vector<Pair> cofaces;        // of extra cells
  std::vector<Pair> extra_cofaces;  // of cells of the voxels
  std::vector<Pair> extra_faces;
  for (std::uint32_t k = 0; k < cells_.size(); ++k) {
    for (const Cell face : faces_[k]) {
      if (face >= first_) {
        cofaces.push_back({face - first_, first_ + k});
      } else {
        extra_cofaces.push_back({face, first_ + k});
      }
    }
  }
  for (const auto& [extra, plain] : cells.cofaces) {
    cofaces.push_back({extra, plain});
    extra_faces.push_back({plain, first_ + extra});
  }
  cofaces_ = rows_of(std::move(cofaces), cells_.size());
  for (const auto* pairs : {&extra_cofaces, &extra_faces}) {
    for (const Pair& pair : *pairs) mixed_.insert(pair[0]);
  }
  mixed_.finish();
  for (auto* pairs : {&extra_cofaces, &extra_faces}) {
    for (Pair& pair : *pairs) pair[0] = mixed_.number(pair[0]);
  }
  cofaces_of_mixed_ = rows_of(std::move(extra_cofaces), mixed_.size());
  faces_of_mixed_ = rows_of(std::move(extra_faces), mixed_.size());
}

}  // namespace blum
