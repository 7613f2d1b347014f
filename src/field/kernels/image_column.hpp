// Blum: columns of images as kernels see them; image_columns.hpp says what for. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "field/kernels/image_shape.hpp"

namespace blum::kernels {

/// One axis of a transform.
template <class Costs_>
struct ColumnPass {
  using Costs = Costs_;

  ImageShape shape;
  Costs costs;
  std::uint32_t length;       ///< rows of a column
  std::uint32_t stride;       ///< voxels between rows
  std::uint32_t mask_stride;  ///< words of the mask between rows
  std::uint32_t columns;
  std::uint32_t band_rows;  ///< of each band but the last
  std::uint32_t bands;
  std::uint32_t* site;  ///< in: nearest in the row or the plane; out: nearest also along the column
  float* slots;         ///< 32 bits per voxel, held as floats: the memory of the distances
  // Per band and column, of the run that comes first in the band, which may go on from the band before:
  std::uint32_t* bottom;  ///< slot of its lowest entry
  std::uint32_t* change;  ///< the row where it ends

  [[nodiscard]] BLUM_HD std::uint32_t band_begin(std::uint32_t band) const { return band * band_rows; }
  [[nodiscard]] BLUM_HD std::uint32_t band_end(std::uint32_t band) const {
    return band + 1 == bands ? length : (band + 1) * band_rows;
  }
};

/// A column as its thread sees it.
template <class Costs, bool along_z>
class Column {
 public:
  using Value = typename Costs::Value;
  using Entry = Parabola<Value>;
  static constexpr std::size_t axis = along_z ? 2 : 1;

  BLUM_HD Column(const ColumnPass<Costs>& pass, std::uint32_t column) : pass_(pass), column_(column) {
    const ImageShape& shape = pass.shape;
    const std::uint32_t other = shape.by_row.quotient(column);  // z or y
    x_ = column - other * shape.size[0];
    other_ = other;
    first_ = along_z ? column : other * shape.plane + x_;
    const std::size_t row = along_z ? std::size_t{other} : std::size_t{other} * shape.size[1];
    mask_ = shape.mask + row * shape.words_per_row + x_ / 32;
  }
  [[nodiscard]] BLUM_HD std::uint32_t length() const { return pass_.length; }
  [[nodiscard]] BLUM_HD std::uint32_t voxel(std::uint32_t row) const { return first_ + row * pass_.stride; }
  [[nodiscard]] BLUM_HD std::uint32_t mask_word(std::uint32_t row) const {
    return mask_[std::size_t{row} * pass_.mask_stride];
  }
  [[nodiscard]] BLUM_HD bool kind_in(std::uint32_t mask_word) const { return ((mask_word >> (x_ % 32)) & 1U) != 0; }
  [[nodiscard]] BLUM_HD bool kind(std::uint32_t row) const { return kind_in(mask_word(row)); }
  /// Whether voxels of a kind are their own sites.
  [[nodiscard]] BLUM_HD bool is_settled(bool kind) const { return kind && !pass_.shape.is_signed; }

  [[nodiscard]] BLUM_HD Value height(const Entry& entry, std::uint32_t row) const {
    return Costs::sum(entry.cost, pass_.costs.square(axis, offset(row, entry.row)));
  }
  [[nodiscard]] BLUM_HD bool hides(const Entry& a, const Entry& b, const Entry& c) const {
    return pass_.costs.hides(axis, a, b, c);
  }
  [[nodiscard]] BLUM_HD Entry wall(std::uint32_t row) const { return {row, voxel(row), 0}; }
  /// The entry of a site that the pass before found for a row.
  [[nodiscard]] BLUM_HD Entry entry(std::uint32_t row, std::uint32_t site) const {
    if constexpr (along_z) {
      const std::uint32_t in_plane = site - row * pass_.shape.plane;
      const std::uint32_t y = pass_.shape.by_row.quotient(in_plane);
      const Value along_x = pass_.costs.square(0, offset(x_, in_plane - y * pass_.shape.size[0]));
      return {row, site, Costs::sum(along_x, pass_.costs.square(1, offset(other_, y)))};
    } else {
      const std::uint32_t row_begin = first_ - x_ + row * pass_.stride;
      return {row, site, pass_.costs.square(0, offset(x_, site - row_begin))};
    }
  }

  [[nodiscard]] BLUM_HD Entry entry_of_slot(std::uint32_t slot) const {
    const std::uint32_t site = bits_of(pass_.slots[voxel(slot)]);
    if constexpr (along_z) return entry(pass_.shape.by_plane.quotient(site), site);
    return entry(pass_.shape.by_row.quotient(site - other_ * pass_.shape.plane), site);
  }
  BLUM_HD void set_slot(std::uint32_t slot, std::uint32_t site) const { pass_.slots[voxel(slot)] = float_of(site); }
  /// The slot after the last entry of the run, or of the part of it in a band, that ends before a row.
  [[nodiscard]] BLUM_HD std::uint32_t top(std::uint32_t end) const {
    const std::uint32_t last = bits_of(pass_.slots[voxel(end - 1)]);
    return (last & is_top) != 0 ? last & ~is_top : end;
  }
  BLUM_HD void set_top(std::uint32_t end, std::uint32_t top) const {
    if (top < end) set_slot(end - 1, top | is_top);
  }
  [[nodiscard]] BLUM_HD std::uint32_t& bottom(std::uint32_t band) const {
    return pass_.bottom[std::size_t{band} * pass_.columns + column_];
  }
  [[nodiscard]] BLUM_HD std::uint32_t& change(std::uint32_t band) const {
    return pass_.change[std::size_t{band} * pass_.columns + column_];
  }

  /// A place between entries: below it come slot - 1, slot - 2, ..., then what lies in the bands before `band`.
  struct Cursor {
    std::uint32_t slot = 0;
    std::uint32_t band = 0;
  };
  /// Takes the next lower entry of a run; false where there is none. The cursor then points at its slot.
  template <bool banded>
  BLUM_HD bool descend(Cursor& at, bool run_kind, Entry& out) const {
    while (at.slot > 0) {
      if (kind(at.slot - 1) != run_kind) {
        out = wall(at.slot - 1);
        at.slot = 0;
        return true;
      }
      if (banded && at.band > 0 && at.slot == bottom(at.band)) {
        --at.band;
        at.slot = top(pass_.band_end(at.band));
        continue;
      }
      out = entry_of_slot(--at.slot);
      return true;
    }
    return false;
  }

 private:
  static constexpr std::uint32_t is_top = 0x80000000U;

  const ColumnPass<Costs>& pass_;
  std::uint32_t column_;
  std::uint32_t x_;
  std::uint32_t other_;  ///< z of a column along y, y of one along z
  std::uint32_t first_;  ///< voxel of row 0
  const std::uint32_t* mask_;
};

}  // namespace blum::kernels
