#include "medial_axis/cells/importance.hpp"

#include <algorithm>

namespace blum::detail {
namespace {

/// Calls visit(cell) for a cell, its faces and their faces. A cell may be visited more than once.
template <class Visit>
void for_each_in_closure(const CellStructure& structure, Cell cell, const Visit& visit) {
  visit(cell);
  structure.for_each_face(cell, [&](Cell face) {
    visit(face);
    structure.for_each_face(face, visit);
  });
}

}  // namespace

Importance::Importance(const CellStructure& structure, std::span<const Entry> entries)
    : words_((structure.lattice().node_count() * 8 + 63) / 64, 0),
      first_(words_.size(), 0),
      first_extra_(structure.first_extra()),
      extra_(structure.extra_count(), 0) {
  for (const Entry& entry : entries) {
    for_each_in_closure(structure, entry.cell, [&](Cell cell) {
      if (cell < first_extra_) words_[cell >> 6U] |= std::uint64_t{1} << (cell & 63U);
    });
  }
  std::uint32_t before = 0;
  for (std::size_t w = 0; w < words_.size(); ++w) {
    first_[w] = before;
    before += bit_count(words_[w]);
  }
  values_.assign(before, 0);
  for (const Entry& entry : entries) {
    for_each_in_closure(structure, entry.cell, [&](Cell cell) {
      float& value = cell < first_extra_ ? values_[rank(cell)] : extra_[cell - first_extra_];
      value = std::max(value, entry.degrees);
    });
  }
}

}  // namespace blum::detail
