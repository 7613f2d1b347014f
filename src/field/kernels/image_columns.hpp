// Blum: the passes along columns of distance transforms of images. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "field/kernels/image_shape.hpp"

namespace blum::kernels {

/// Pass of a transform along one axis, y or z.
template <class Costs_>
struct ColumnPass {
  using Costs = Costs_;

  ImageShape shape;
  Costs costs;
  std::uint32_t length;       ///< rows of a column
  std::uint32_t stride;       ///< distance of two rows in the image, in voxels
  std::uint32_t mask_stride;  ///< distance of two rows in the mask, in words
  std::uint32_t columns;
  std::uint32_t band_rows;  ///< rows of each band except the last one
  std::uint32_t bands;
  /// On input, the closest site in the row (y pass) or plane (z pass). On output, the closest site in the column, too.
  std::uint32_t* site;
  /// One 32-bit slot per voxel. The slots use the memory of the distances, so their type is float.
  float* slots;
  // The following two arrays have one entry per band and column. The two arrays describe the first run (rows of one
  // kind) in the band. This run may continue the last run of the previous band.
  std::uint32_t* bottom;  ///< Slot of the run's lowest entry in the band.
  std::uint32_t* change;  ///< Row at which the run ends.

  [[nodiscard]] BLUM_HD std::uint32_t band_begin(std::uint32_t band) const { return band * band_rows; }
  [[nodiscard]] BLUM_HD std::uint32_t band_end(std::uint32_t band) const {
    return band + 1 == bands ? length : (band + 1) * band_rows;
  }
};

/// One column, with the functions that its thread needs.
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
  /// Returns true if voxels of this kind are their own sites.
  [[nodiscard]] BLUM_HD bool is_settled(bool kind) const { return kind && !pass_.shape.is_signed; }

  [[nodiscard]] BLUM_HD Value height(const Entry& entry, std::uint32_t row) const {
    return Costs::sum(entry.cost, pass_.costs.square(axis, offset(row, entry.row)));
  }
  [[nodiscard]] BLUM_HD bool hides(const Entry& a, const Entry& b, const Entry& c) const {
    return pass_.costs.hides(axis, a, b, c);
  }
  [[nodiscard]] BLUM_HD Entry wall(std::uint32_t row) const { return {row, voxel(row), 0}; }
  /// Returns the entry for the site that the previous pass found for a row.
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
  /// Returns the slot after the last entry of a run, or of the run's part in a band. `end` is the row after the last
  /// row of the run or part.
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

  /// Position between the entries of a run. The next lower entries are in slots slot - 1, slot - 2, ... of the band,
  /// then in the bands before it.
  struct Cursor {
    std::uint32_t slot = 0;
    std::uint32_t band = 0;
  };
  /// Takes the next lower entry of a run. Afterwards the cursor is at that entry's slot. Returns false if no entry is
  /// left.
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
  std::uint32_t other_;  ///< z for columns along y, y for columns along z
  std::uint32_t first_;  ///< linear index of the voxel of row 0
  const std::uint32_t* mask_;
};

// A column pass (along y or z) processes the rows r of a column. For each r it finds the row s that minimises cost(s) +
// w (s - r)^2. The minimum over s is the lower envelope of parabolas (Maurer, Qi, Raghavan 2003). Among equally good
// rows s the lowest wins.
//
// A run consists of consecutive rows of one kind (selected or not). The voxel next to a run is of the other kind. That
// voxel has cost 0 and hides everything beyond it from the run's rows. So each run has a separate envelope: of its own
// rows, and of the voxels next to its ends ("walls", which need no memory). A signed transform thus computes inside and
// outside in one pass, with the work and memory of an unsigned pass. In an unsigned transform, voxels in runs of
// selected voxels are their own sites.
//
// A thread processes a column, or one band of it if there are few columns. Neighbouring threads process neighbouring
// columns, so that a warp reads and writes whole cache lines. The kernels are those of parallel banding (Cao, Tang,
// Mohamed, Tan 2010).
//   BuildEnvelopes  makes the envelopes of each band's rows. Reads 4 + 1/8 bytes per voxel, writes at most 4.
//   MergeBands drops the few parabolas that parabolas of other bands hide. AssignSites walks down the envelopes. Reads
//   at most 4 + 1/8 bytes per voxel, writes 4.
// An entry (a parabola of the envelope) needs 4 bytes, because it is computed again from the linear index of its site.
// Sites are read and written in whole cache lines. Envelopes of neighbouring columns differ in height. So the number of
// 32-byte sectors that 32 threads write is 1 to 4 times that for 32 contiguous entries. (This was counted for balls,
// noise and sparse points of 128^3 voxels.) Most of these writes are combined in the cache.
//
// Entries of a run that begins at row a are in slots a, a + 1, and so on. The last slot of a run (or of its part in a
// band) may not be an entry. If it is not an entry, it contains the slot after the last entry.

/// Builds the envelopes of one band of a column.
template <class Costs, bool along_z>
struct BuildEnvelopes {
  ColumnPass<Costs> pass;

  BLUM_HD void operator()(std::size_t index) const {
    const auto band = pass.bands == 1 ? 0 : static_cast<std::uint32_t>(index / pass.columns);
    const auto column = static_cast<std::uint32_t>(index - std::size_t{band} * pass.columns);
    Builder(pass, column).run(band);
  }

 private:
  using Entry = Parabola<typename Costs::Value>;

  class Builder {
   public:
    BLUM_HD Builder(const ColumnPass<Costs>& pass, std::uint32_t column) : pass_(pass), column_(pass, column) {}

    BLUM_HD void run(std::uint32_t band) {
      const std::uint32_t begin = pass_.band_begin(band);
      const std::uint32_t end = pass_.band_end(band);
      std::uint32_t change = end;
      kind_ = column_.kind(begin);
      start(begin, begin > 0 && column_.kind(begin - 1) != kind_);
      // Rows are read before they are needed, because a thread has little other work while it waits.
      Rows next = read(begin, end);
      for (std::uint32_t first = begin; first < end; first += rows_at_once) {
        const Rows now = next;
        next = read(first + rows_at_once, end);
        for (std::uint32_t k = 0; k < rows_at_once; ++k) {
          const std::uint32_t row = first + k;
          if (row >= end) break;
          const bool kind = column_.kind_in(now.mask_word[k]);
          if (kind != kind_) {
            change = smaller(change, row);
            finish(row, true);
            kind_ = kind;
            start(row, true);
          }
          if (now.site[k] != no_voxel && !column_.is_settled(kind)) push(column_.entry(row, now.site[k]));
        }
      }
      finish(end, end < pass_.length && column_.kind(end) != kind_);
      if (pass_.bands == 1) return;
      column_.bottom(band) = begin;
      column_.change(band) = change;
    }

   private:
    static constexpr std::uint32_t rows_at_once = 4;
    struct Rows {
      std::uint32_t site[rows_at_once];
      std::uint32_t mask_word[rows_at_once];
    };

    [[nodiscard]] BLUM_HD Rows read(std::uint32_t first, std::uint32_t end) const {
      Rows rows{};
      for (std::uint32_t k = 0; k < rows_at_once; ++k) {
        if (first + k >= end) continue;
        rows.site[k] = pass_.site[column_.voxel(first + k)];
        rows.mask_word[k] = column_.mask_word(first + k);
      }
      return rows;
    }

    BLUM_HD void start(std::uint32_t row, bool has_wall) {
      begin_ = row;
      slot_ = row;
      depth_ = 0;
      if (!has_wall) return;
      top_ = column_.wall(row - 1);
      depth_ = 1;
    }
    /// Drops entries that the wall at the end of a run hides, and stores the slot after the last remaining entry.
    BLUM_HD void finish(std::uint32_t row, bool has_wall) {
      if (has_wall) make_room(column_.wall(row));
      column_.set_top(row, slot_);
    }
    BLUM_HD void push(const Entry& entry) {
      make_room(entry);
      second_ = top_;
      top_ = entry;
      ++depth_;
      column_.set_slot(slot_++, entry.site);
    }
    /// Drops the uppermost entries that are nowhere lower than both the entry below them and a new entry.
    BLUM_HD void make_room(const Entry& entry) {
      while (depth_ >= 2 && column_.hides(second_, top_, entry)) {
        top_ = second_;
        --depth_;
        --slot_;
        if (depth_ < 2) return;
        second_ = slot_ - begin_ >= 2 ? column_.entry_of_slot(slot_ - 2) : column_.wall(begin_ - 1);
      }
    }

    const ColumnPass<Costs>& pass_;
    Column<Costs, along_z> column_;
    bool kind_ = false;
    std::uint32_t begin_ = 0;  ///< first row of the run
    std::uint32_t slot_ = 0;   ///< slot after the last entry of the run
    std::uint32_t depth_ = 0;  ///< number of entries, including the wall
    Entry top_, second_;
  };
};

/// Joins the envelopes of runs that extend over several bands. One thread per column processes one band after the
/// other. The thread drops hidden entries at the upper end of the envelope so far, and at the lower end of the next
/// band's envelope.
template <class Costs, bool along_z>
struct MergeBands {
  ColumnPass<Costs> pass;

  BLUM_HD void operator()(std::size_t index) const {
    const Column<Costs, along_z> column(pass, static_cast<std::uint32_t>(index));
    for (std::uint32_t band = 1; band < pass.bands; ++band) {
      const std::uint32_t begin = pass.band_begin(band);
      const bool kind = column.kind(begin);
      if (column.kind(begin - 1) == kind && !column.is_settled(kind)) merge(column, band, begin, kind);
    }
  }

 private:
  using Entry = Parabola<typename Costs::Value>;

  BLUM_HD void merge(const Column<Costs, along_z>& column, std::uint32_t band, std::uint32_t begin, bool kind) const {
    const std::uint32_t change = column.change(band);
    const std::uint32_t top = column.top(change);
    const bool has_wall = change < pass.length && column.kind(change) != kind;
    // Upper envelope: the entries in slots from `above` to `top`, then the wall.
    const auto take = [&](std::uint32_t slot, Entry& out) {
      if (slot < top) {
        out = column.entry_of_slot(slot);
        return true;
      }
      if (slot == top && has_wall) out = column.wall(change);
      return slot == top && has_wall;
    };
    std::uint32_t above = begin;
    Entry b1, b2, a1, a2;
    if (!take(above, b1)) return;
    bool has_b2 = take(above + 1, b2);
    typename Column<Costs, along_z>::Cursor at_a1{begin, band};
    if (!column.template descend<true>(at_a1, kind, a1)) return;
    auto at_a2 = at_a1;
    bool has_a2 = column.template descend<true>(at_a2, kind, a2);
    for (;;) {
      if (has_a2 && column.hides(a2, a1, b1)) {
        column.set_top(pass.band_end(at_a1.band), at_a1.slot);
        a1 = a2;
        at_a1 = at_a2;
        has_a2 = column.template descend<true>(at_a2, kind, a2);
      } else if (has_b2 && column.hides(a1, b1, b2)) {
        ++above;
        b1 = b2;
        has_b2 = take(above + 1, b2);
      } else {
        break;
      }
    }
    column.bottom(band) = above;
  }
};

/// Writes for each row of a band the site of the entry that is lowest there.
template <class Costs, bool along_z, bool banded>
struct AssignSites {
  ColumnPass<Costs> pass;

  BLUM_HD void operator()(std::size_t index) const {
    const auto band = banded ? static_cast<std::uint32_t>(index / pass.columns) : 0;
    Assigner(pass, static_cast<std::uint32_t>(index - std::size_t{band} * pass.columns), band).run();
  }

 private:
  using Entry = Parabola<typename Costs::Value>;
  using Value = typename Costs::Value;

  class Assigner {
   public:
    BLUM_HD Assigner(const ColumnPass<Costs>& pass, std::uint32_t column, std::uint32_t band)
        : pass_(pass), column_(pass, column), band_(band) {}

    BLUM_HD void run() {
      const std::uint32_t begin = pass_.band_begin(band_);
      const std::uint32_t end = pass_.band_end(band_);
      bool kind = column_.kind(end - 1);
      start(end, kind, end < pass_.length && column_.kind(end) != kind);
      for (std::uint32_t row = end; row-- > begin;) {
        const bool row_kind = column_.kind(row);
        if (row_kind != kind) {
          kind = row_kind;
          start(row + 1, kind, true);
        }
        const std::uint32_t voxel = column_.voxel(row);
        if (column_.is_settled(kind)) {
          pass_.site[voxel] = voxel;
        } else {
          go_to(row, kind);
          pass_.site[voxel] = is_empty_ ? no_voxel : best_.site;
        }
      }
    }

   private:
    using Cursor = typename Column<Costs, along_z>::Cursor;

    /// Starts with the last rows of a run, which end before row `end`. The first entry is the wall at `end`, or else
    /// the entry that is lowest at row end - 1.
    BLUM_HD void start(std::uint32_t end, bool kind, bool has_wall) {
      if (column_.is_settled(kind)) return;
      cursor_ = {column_.top(end), band_};
      if (has_wall) {
        best_ = column_.wall(end);
        is_empty_ = false;
      } else {
        is_empty_ = !descend(kind, best_);
        if (banded && end < pass_.length) climb(end - 1, kind);
      }
      has_next_ = descend(kind, next_);
    }
    BLUM_HD bool descend(bool kind, Entry& out) { return column_.template descend<banded>(cursor_, kind, out); }

    /// Searches the later bands of a run for entries that are lower at this row.
    BLUM_HD void climb(std::uint32_t row, bool kind) {
      for (std::uint32_t band = band_ + 1; band < pass_.bands; ++band) {
        const std::uint32_t change = column_.change(band);
        const std::uint32_t top = column_.top(change);
        for (std::uint32_t slot = column_.bottom(band); slot < top; ++slot) {
          if (!offer_from_above(row, column_.entry_of_slot(slot), {slot, band})) return;
        }
        if (change == pass_.length) return;
        if (column_.kind(change) != kind) {
          offer_from_above(row, column_.wall(change), {top, band});
          return;
        }
      }
    }
    /// Offers an entry of a later band. Returns false if the entry is higher than the best entry, so that all entries
    /// above it are higher, too.
    BLUM_HD bool offer_from_above(std::uint32_t row, const Entry& entry, const Cursor& below) {
      const Value height = column_.height(entry, row);
      const Value lowest = is_empty_ ? height : column_.height(best_, row);
      if (is_empty_ || height < lowest) {
        best_ = entry;
        cursor_ = below;
        is_empty_ = false;
        return true;
      }
      return height <= lowest + pass_.costs.slack;
    }

    BLUM_HD void go_to(std::uint32_t row, bool kind) {
      while (has_next_) {
        const Value lowest = column_.height(best_, row);
        const Value height = column_.height(next_, row);
        if (height > lowest) {
          if constexpr (Costs::is_exact) return;
          if (height > lowest + pass_.costs.slack || !look_below(row, kind, lowest)) return;
        }
        best_ = next_;
        has_next_ = descend(kind, next_);
      }
    }
    /// Used if the next entry is higher than the best entry, but only within rounding. Searches further below for an
    /// entry at most as high as `lowest`. If found, makes it the next entry and returns true.
    BLUM_HD bool look_below(std::uint32_t row, bool kind, Value lowest) {
      Cursor cursor = cursor_;
      Entry entry;
      while (column_.template descend<banded>(cursor, kind, entry)) {
        const Value height = column_.height(entry, row);
        if (height > lowest + pass_.costs.slack) return false;
        if (height > lowest) continue;
        next_ = entry;
        cursor_ = cursor;
        return true;
      }
      return false;
    }

    const ColumnPass<Costs>& pass_;
    Column<Costs, along_z> column_;
    std::uint32_t band_;
    bool is_empty_ = true;
    bool has_next_ = false;
    Entry best_, next_;
    Cursor cursor_;  ///< position below next_
  };
};

}  // namespace blum::kernels
