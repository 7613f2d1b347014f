// The three passes of the distance transform, compiled once per instruction set.
//
// A column pass (y or z) processes the rows r of a column. For each r it finds the row s that minimises f(s) + w (r -
// s)^2, where f is the result of the earlier passes. The smallest minimiser s(r) never decreases as r grows (the matrix
// is totally monotone: Aggarwal, Klawe, Moran, Shor, Wilber 1987). So rows are solved coarse to fine. For each row, the
// search is limited to the rows between the minimisers of the two nearest rows already solved. The average is log2(n) +
// 2 candidates per row. Vector lanes contain neighbouring columns; the search for a row covers the union of the lanes'
// ranges. If the ranges differ too much, the columns are solved one by one.
//
// In a signed transform, a voxel of the other kind (selected or not) has cost f = 0. The smallest minimiser then never
// decreases among rows of the same kind, and between rows of different kinds it decreases by at most one. The reason:
// between rows r1 < r2 of different kinds, the kind changes somewhere, between rows e and e + 1. Then s(r1) <= e + 1
// and s(r2) >= e, because nothing beyond the change is closer.
#include "field/cpu/distance_transform_kernels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include <hwy/cache_control.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/cpu/distance_transform_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "field/cpu/distance_transform_rows-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::detail::HWY_NAMESPACE {
namespace {

/// Arithmetic of squared distances, in int32 or double. In a column with both kinds of voxels, the cost f of a selected
/// voxel is stored as ~f (int32) or -f (double). For a selected row, all costs are flipped again. After flipping, costs
/// of voxels of the row's own kind are positive, and those of the other kind negative.
template <class T>
struct Costs;

template <>
struct Costs<std::int32_t> {
  /// Cost without a site; adding the square of an axis length still fits in int32.
  static constexpr std::int32_t far = std::int32_t{1} << 30;
  static const std::int32_t* table(const SquareTable& squares) { return squares.integers.data(); }
  static std::int32_t* scratch(PassScratch& scratch) { return scratch.integer_costs.data(); }
  template <class D, class VI>
  static HWY_INLINE hn::Vec<D> from_int(D, VI value) {
    return value;
  }
  template <class D, class V>
  static HWY_INLINE V to_int(D, V value) {
    return value;
  }
  template <class D, class V>
  static HWY_INLINE V flip(D d, V cost) {
    return hn::Xor(cost, hn::Set(d, -1));
  }
  /// Returns the mask with which an xor flips all costs for this row. In int32 it has all bits set if the row's own
  /// cost is flipped, else none.
  template <class D, class V>
  static HWY_INLINE V flip_mask(D, V cost) {
    return hn::ShiftRight<31>(cost);
  }
};

template <>
struct Costs<double> {
  static constexpr double far = 1e300;
  static const double* table(const SquareTable& squares) { return squares.doubles.data(); }
  static double* scratch(PassScratch& scratch) { return scratch.double_costs.data(); }
  template <class D, class VI>
  static HWY_INLINE hn::Vec<D> from_int(D d, VI value) {
    return hn::PromoteTo(d, value);
  }
  template <class D, class V>
  static HWY_INLINE hn::Vec<hn::Rebind<std::int32_t, D>> to_int(D, V value) {
    return hn::DemoteTo(hn::Rebind<std::int32_t, D>(), value);
  }
  template <class D, class V>
  static HWY_INLINE V flip(D, V cost) {
    return hn::Neg(cost);
  }
  template <class D, class V>
  static HWY_INLINE V flip_mask(D d, V cost) {
    return hn::And(cost, hn::SignBit(d));
  }
};

/// Neighbouring columns along one axis, as stored in scratch memory: lane l of row r is at r * stride + l.
struct Columns {
  std::size_t length = 0;      ///< Number of rows.
  std::size_t stride = 0;      ///< Step between rows in scratch.
  std::size_t first = 0;       ///< Linear index of the voxel of row 0, lane 0.
  std::size_t row_stride = 0;  ///< Step between rows in the image.
  std::size_t x = 0;           ///< x coordinate of lane 0.
  std::size_t y = 0;           ///< y coordinate of the columns; used in the z pass only.
  std::size_t lanes = 0;       ///< Number of columns. Further lanes of a vector repeat the last column.
  std::size_t mask_word = 0;   ///< Index of the mask's first word for row 0.
  std::size_t mask_stride = 0;
  bool mixed = false;         ///< In a signed transform: the columns contain both kinds of voxels.
  bool all_selected = false;  ///< In a signed transform: all voxels of the columns are selected.
  std::size_t lowest_candidate = 0;
  std::size_t highest_candidate = 0;
};

HWY_INLINE std::uint32_t column_bits(const TransformPlan& plan, const Columns& columns, std::size_t row) {
  const std::uint64_t* words = plan.mask + columns.mask_word + row * columns.mask_stride;
  return static_cast<std::uint32_t>(words[columns.x / 64] >> (columns.x % 64));
}

/// Sets `mixed` and `all_selected`.
void classify(const TransformPlan& plan, Columns& columns) {
  if (!plan.is_signed) return;
  const std::uint32_t lanes = (std::uint32_t{1} << columns.lanes) - 1;
  std::uint32_t any = 0;
  std::uint32_t all = lanes;
  for (std::size_t row = 0; row < columns.length; ++row) {
    const std::uint32_t bits = column_bits(plan, columns, row);
    any |= bits;
    all &= bits;
  }
  any &= lanes;
  columns.mixed = any != 0 && all != lanes;
  columns.all_selected = all == lanes;
}

/// Copies the columns' results of the previous pass into scratch, with their costs. Finds the range of rows that can be
/// closest.
template <class D, bool kFinal, bool kMixed>
void load_columns(const TransformPlan& plan, PassScratch& scratch, Columns& columns) {
  using T = hn::TFromD<D>;
  using Cost = Costs<T>;
  using DI = hn::Rebind<std::int32_t, D>;
  using DU = hn::Rebind<std::uint32_t, D>;
  const D d;
  const DI di;
  const DU du;
  const std::size_t width = hn::Lanes(d);
  T* costs = Cost::scratch(scratch);
  std::int32_t* partials = scratch.partial_sites.data();
  HWY_ALIGN std::int32_t lane_x[16];
  HWY_ALIGN std::int32_t lane_bits[16];
  HWY_ALIGN std::int32_t buffer[16];
  for (std::size_t lane = 0; lane < width; ++lane) {
    const std::size_t inside = std::min(lane, columns.lanes - 1);
    lane_x[lane] = static_cast<std::int32_t>(columns.x + inside);
    lane_bits[lane] = std::int32_t{1} << inside;
  }
  const auto x = hn::Load(di, lane_x);
  const auto own_bit = hn::Load(di, lane_bits);
  const auto none = hn::Set(di, static_cast<std::int32_t>(no_site));
  const auto x_mask = hn::Set(di, static_cast<std::int32_t>((std::uint32_t{1} << plan.x_bits) - 1));
  const auto x_weight = hn::Set(d, static_cast<T>(plan.weight[0]));
  const auto y_weight = hn::Set(d, static_cast<T>(plan.weight[1]));
  const auto y = hn::Set(di, static_cast<std::int32_t>(columns.y));

  const bool next_columns = columns.x + 2 * width <= plan.size[0];
  std::size_t lowest = columns.length;
  std::size_t highest = 0;
  for (std::size_t row = 0; row < columns.length; ++row) {
    const auto* in = reinterpret_cast<const std::int32_t*>(plan.partial) + columns.first + row * columns.row_stride;
    // The rows of a column are far apart in memory, so the processor does not prefetch them by itself.
    if constexpr (kFinal) hwy::Prefetch(in + (next_columns ? width : 0));
    if (columns.lanes < width) {
      for (std::size_t lane = 0; lane < width; ++lane) {
        // Copied as bytes, because distances may be written over these integers next.
        std::memcpy(buffer + lane, in + std::min(lane, columns.lanes - 1), sizeof(*in));
      }
      in = buffer;
    }
    const auto partial = hn::LoadU(di, in);
    const auto site_x = kFinal ? hn::And(partial, x_mask) : partial;
    const auto dx = Cost::from_int(d, hn::Sub(x, site_x));
    auto cost = hn::Mul(hn::Mul(dx, dx), x_weight);
    if constexpr (kFinal) {
      const auto site_y = hn::BitCast(di, hn::ShiftRightSame(hn::BitCast(du, partial), static_cast<int>(plan.x_bits)));
      const auto dy = Cost::from_int(d, hn::Sub(y, site_y));
      cost = hn::Add(cost, hn::Mul(hn::Mul(dy, dy), y_weight));
    }
    const auto is_none = hn::Eq(partial, none);
    if (!hn::AllTrue(di, is_none)) {
      lowest = std::min(lowest, row);
      highest = row;
    }
    // Each int32 lane mask (-1 or 0) is widened to the width of a cost.
    const auto zero = hn::Zero(d);
    cost = hn::IfThenElse(hn::Ne(Cost::from_int(d, hn::VecFromMask(di, is_none)), zero), hn::Set(d, Cost::far), cost);
    if constexpr (kMixed) {
      const auto bits = hn::Set(di, static_cast<std::int32_t>(column_bits(plan, columns, row)));
      const auto selected = hn::And(bits, own_bit);
      cost = hn::IfThenElse(hn::Ne(Cost::from_int(d, selected), zero), Cost::flip(d, cost), cost);
    }
    hn::StoreU(cost, d, costs + row * columns.stride);
    hn::StoreU(partial, di, partials + row * columns.stride);
  }
  columns.lowest_candidate = kMixed ? 0 : lowest;
  columns.highest_candidate = kMixed ? columns.length - 1 : highest;
}

/// Solves the columns of one vector. Reads scratch and writes the image.
template <class D, bool kFinal, bool kMixed>
class Sweep {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using DI = hn::Rebind<std::int32_t, D>;
  using VI = hn::Vec<DI>;
  using DF = hn::Rebind<float, D>;
  using Cost = Costs<T>;
  static constexpr bool one_lane = hn::MaxLanes(D()) == 1;

 public:
  /// @param lane  first lane of the columns that the vector contains.
  Sweep(const TransformPlan& plan, const SquareTable& squares, PassScratch& scratch, const Columns& columns,
        std::size_t lane)
      : plan_(plan),
        columns_(columns),
        lane_(lane),
        lanes_(std::min(columns.lanes - lane, hn::Lanes(D()))),
        costs_(Cost::scratch(scratch) + lane),
        partials_(scratch.partial_sites.data() + lane),
        squares_(Cost::table(squares) + columns.length - 1),
        lowest_(scratch.lowest.data()),
        highest_(scratch.highest.data()) {}

  /// Solves all rows. Returns false if this would take more than about `budget` candidates, or if the caller has
  /// cancelled.
  bool run(std::size_t budget) {
    constexpr std::size_t candidates_between_checks = std::size_t{1} << 22U;
    const std::size_t n = columns_.length;
    std::size_t spent = 0;
    std::size_t next_check = std::min(budget, candidates_between_checks);
    for (std::size_t step = std::bit_floor(n); step > 0; step /= 2) {
      // Row p - 1 lies between rows p - step - 1 and p + step - 1. Each of these is already solved or outside the
      // column.
      for (std::size_t p = step; p <= n; p += 2 * step) {
        std::size_t low = p == step ? columns_.lowest_candidate : static_cast<std::size_t>(lowest_[p - step - 1]);
        std::size_t high = p + step > n ? columns_.highest_candidate : static_cast<std::size_t>(highest_[p + step - 1]);
        if constexpr (kMixed) {
          low = std::max<std::size_t>(low, 1) - 1;
          high = std::min(high + 1, n - 1);
        }
        solve(p - 1, low, high, step > 1);
        spent += high - low + 1;
        if (spent > next_check) {
          if (spent > budget || plan_.context->cancel.stop_requested()) return false;
          next_check = std::min(budget, spent + candidates_between_checks);
        }
      }
    }
    return true;
  }

 private:
  HWY_INLINE void solve(std::size_t row, std::size_t low, std::size_t high, bool keep_range) {
    const D d;
    const T* squares = squares_ - row;
    const T* costs = costs_ + low * columns_.stride;
    const V own_cost = hn::LoadU(d, costs_ + row * columns_.stride);
    [[maybe_unused]] const V flip = Cost::flip_mask(d, own_cost);
    const V one = hn::Set(d, T{1});
    V candidate = hn::Set(d, static_cast<T>(low));
    V closest = candidate;
    V best = hn::Set(d, std::numeric_limits<T>::max());
    for (std::size_t s = low; s <= high; ++s, costs += columns_.stride) {
      V cost = hn::LoadU(d, costs);
      if constexpr (kMixed) cost = hn::Max(hn::Xor(cost, flip), hn::Zero(d));
      cost = hn::Add(cost, hn::Set(d, squares[s]));
      closest = hn::IfThenElse(hn::Lt(cost, best), candidate, closest);
      best = hn::Min(best, cost);
      candidate = hn::Add(candidate, one);
    }
    const VI closest_row = Cost::to_int(d, closest);
    if (keep_range) {
      lowest_[row] = hn::GetLane(hn::MinOfLanes(DI(), closest_row));
      highest_[row] = hn::GetLane(hn::MaxOfLanes(DI(), closest_row));
    }
    VI negative = hn::Set(DI(), columns_.all_selected ? -1 : 0);
    VI partial = gather(partials_, 1, closest_row);
    if constexpr (kMixed) {
      negative = kind(Cost::to_int(d, hn::IfThenElse(hn::Lt(own_cost, hn::Zero(d)), hn::Set(d, T{-1}), hn::Zero(d))));
      partial = replace_other_kind(partial, closest_row, negative);
    }
    if constexpr (kFinal) {
      finish_z(row, best, closest_row, partial, negative);
    } else {
      finish_y(row, closest_row, partial);
    }
  }

  /// Returns all ones in lanes with negative values, else 0.
  static HWY_INLINE VI kind(VI value) { return hn::ShiftRight<31>(value); }

  /// Returns words[(row * stride + lane) * step], with a separate row for each lane.
  HWY_INLINE VI gather(const std::int32_t* words, std::size_t step, VI row) const {
    const DI di;
    const std::size_t stride = columns_.stride * step;
    if constexpr (one_lane) {
      return hn::Set(di, words[static_cast<std::size_t>(hn::GetLane(row)) * stride]);
    } else {
      const VI lane = hn::Mul(hn::Iota(di, 0), hn::Set(di, static_cast<std::int32_t>(step)));
      return hn::GatherIndex(di, words, hn::Add(hn::Mul(row, hn::Set(di, static_cast<std::int32_t>(stride))), lane));
    }
  }

  /// In lanes whose closest row is of the other kind, replaces the partial site by that row. The sign bit of a cost
  /// indicates the kind.
  HWY_INLINE VI replace_other_kind(VI partial, VI closest_row, VI negative) const {
    const DI di;
    // NOLINTNEXTLINE(bugprone-sizeof-expression): T may be std::int32_t itself
    constexpr std::size_t words = sizeof(T) / sizeof(std::int32_t);
    constexpr std::size_t high_word = std::endian::native == std::endian::little ? words - 1 : 0;
    const auto* signs = reinterpret_cast<const std::int32_t*>(costs_) + high_word;
    const VI other = hn::Xor(kind(gather(signs, words, closest_row)), negative);
    VI self = hn::Add(hn::Set(di, static_cast<std::int32_t>(columns_.x + lane_)), hn::Iota(di, 0));
    if constexpr (kFinal) self = hn::Or(self, hn::Set(di, static_cast<std::int32_t>(columns_.y << plan_.x_bits)));
    return hn::IfThenElse(hn::MaskFromVec(other), self, partial);
  }

  HWY_INLINE void finish_y(std::size_t row, VI closest_row, VI partial) const {
    const DI di;
    const VI packed = hn::Or(hn::ShiftLeftSame(closest_row, static_cast<int>(plan_.x_bits)), partial);
    const VI none = hn::Set(di, static_cast<std::int32_t>(no_site));
    auto* out = reinterpret_cast<std::int32_t*>(plan_.partial) + columns_.first + lane_ + row * columns_.row_stride;
    store(di, hn::IfThenElse(hn::Eq(partial, none), none, packed), out);
  }

  HWY_INLINE void finish_z(std::size_t row, V best, VI closest_row, VI partial, VI negative) const {
    const DI di;
    const DF df;
    const hn::Rebind<std::uint32_t, D> du;
    const VI x_mask = hn::Set(di, static_cast<std::int32_t>((std::uint32_t{1} << plan_.x_bits) - 1));
    const VI x = hn::And(partial, x_mask);
    const VI y = hn::BitCast(di, hn::ShiftRightSame(hn::BitCast(du, partial), static_cast<int>(plan_.x_bits)));
    const VI size_x = hn::Set(di, static_cast<std::int32_t>(plan_.size[0]));
    const VI size_y = hn::Set(di, static_cast<std::int32_t>(plan_.size[1]));
    VI site = hn::Add(hn::Mul(hn::Add(hn::Mul(closest_row, size_y), y), size_x), x);
    auto distance = root(best);
    if (plan_.has_band) {
      const auto band = hn::Set(df, plan_.band);
      const auto beyond = hn::Gt(distance, band);
      distance = hn::IfThenElse(beyond, band, distance);
      site = hn::Or(site, hn::BitCast(di, hn::VecFromMask(df, beyond)));
    }
    distance = hn::Or(distance, hn::And(hn::BitCast(df, negative), hn::SignBit(df)));
    const std::size_t out = columns_.first + lane_ + row * columns_.row_stride;
    store(df, distance, plan_.distance + out);
    if (plan_.site != nullptr) store(di, site, reinterpret_cast<std::int32_t*>(plan_.site) + out);
  }

  /// Converts squared distances to distances.
  HWY_INLINE hn::Vec<DF> root(V best) const {
    const DF df;
    if constexpr (std::is_same_v<T, double>) {
      return hn::DemoteTo(df, hn::Mul(hn::Sqrt(best), hn::Set(D(), plan_.unit)));
    } else {
      if (plan_.exact_in_float) {
        return hn::Mul(hn::Sqrt(hn::ConvertTo(df, best)), hn::Set(df, static_cast<float>(plan_.unit)));
      }
      return root_in_double(best);
    }
  }

  HWY_INLINE hn::Vec<DF> root_in_double(V best) const {
    const DF df;
    HWY_ALIGN std::int32_t squared[16];
    HWY_ALIGN float distance[16];
    hn::Store(best, D(), squared);
    const std::size_t width = hn::Lanes(D());
    for (std::size_t i = 0; i < width; ++i) {
      distance[i] = static_cast<float>(std::sqrt(static_cast<double>(squared[i])) * plan_.unit);
    }
    return hn::Load(df, distance);
  }

  template <class DT, class VT>
  HWY_INLINE void store(DT dt, VT value, hn::TFromD<DT>* out) const {
    if (lanes_ == hn::Lanes(dt)) {
      // Results are written past the caches if they fill whole cache lines. Cache lines of results are not read again
      // soon, and their old content need not be read.
      constexpr bool whole_line = kFinal && hn::MaxLanes(dt) * sizeof(*out) == 64;
      if (whole_line && reinterpret_cast<std::uintptr_t>(out) % 64 == 0) {
        hn::Stream(value, dt, out);
      } else {
        hn::StoreU(value, dt, out);
      }
    } else {
      HWY_ALIGN hn::TFromD<DT> buffer[16];
      hn::Store(value, dt, buffer);
      for (std::size_t lane = 0; lane < lanes_; ++lane) out[lane] = buffer[lane];
    }
  }

  const TransformPlan& plan_;
  const Columns& columns_;
  std::size_t lane_;
  std::size_t lanes_;
  const T* costs_;
  const std::int32_t* partials_;
  const T* squares_;
  std::int32_t* lowest_;
  std::int32_t* highest_;
};

/// Solves at most one vector of columns: together, or one by one if that is cheaper.
template <class D, bool kFinal, bool kMixed>
void solve_columns(const TransformPlan& plan, const SquareTable& squares, PassScratch& scratch, Columns& columns) {
  load_columns<D, kFinal, kMixed>(plan, scratch, columns);
  // These columns contain no site, and the results already state this.
  if (columns.lowest_candidate > columns.highest_candidate) return;
  const std::size_t lanes = columns.lanes;
  const std::size_t one_column = columns.length * (static_cast<std::size_t>(std::bit_width(columns.length)) + 2);
  if (Sweep<D, kFinal, kMixed>(plan, squares, scratch, columns, 0).run(lanes == 1 ? SIZE_MAX : lanes * one_column)) {
    return;
  }
  using One = hn::CappedTag<hn::TFromD<D>, 1>;
  for (std::size_t lane = 0; lane < lanes && !plan.context->cancel.stop_requested(); ++lane) {
    Sweep<One, kFinal, kMixed>(plan, squares, scratch, columns, lane).run(SIZE_MAX);
  }
}

template <class T, bool kFinal>
void columns_of(const TransformPlan& plan, const SquareTable& squares, PassScratch& scratch, Columns columns,
                std::size_t x_end) {
  using Wide = hn::CappedTag<T, 16>;
  using One = hn::CappedTag<T, 1>;
  // Gathers need scratch offsets that fit in 32 bits. A few very long columns should not be padded to a whole vector.
  constexpr std::size_t longest_wide_column = std::size_t{1} << 24U;
  const std::size_t width = columns.length <= longest_wide_column ? hn::Lanes(Wide()) : 1;
  columns.stride = width;
  for (; columns.x < x_end; columns.x += width, columns.first += width) {
    columns.lanes = std::min(width, x_end - columns.x);
    classify(plan, columns);
    if (width == 1) {
      columns.mixed ? solve_columns<One, kFinal, true>(plan, squares, scratch, columns)
                    : solve_columns<One, kFinal, false>(plan, squares, scratch, columns);
    } else {
      columns.mixed ? solve_columns<Wide, kFinal, true>(plan, squares, scratch, columns)
                    : solve_columns<Wide, kFinal, false>(plan, squares, scratch, columns);
    }
    if (plan.context->cancel.stop_requested()) return;
  }
}

void columns_y(const TransformPlan& plan, const SquareTable& squares, PassScratch& scratch, std::size_t z,
               std::size_t x_begin, std::size_t x_end) {
  Columns columns;
  columns.length = plan.size[1];
  columns.row_stride = plan.size[0];
  columns.first = z * plan.size[1] * plan.size[0] + x_begin;
  columns.x = x_begin;
  columns.mask_word = z * plan.size[1] * plan.mask_words_per_row;
  columns.mask_stride = plan.mask_words_per_row;
  plan.integer ? columns_of<std::int32_t, false>(plan, squares, scratch, columns, x_end)
               : columns_of<double, false>(plan, squares, scratch, columns, x_end);
}

void columns_z(const TransformPlan& plan, const SquareTable& squares, PassScratch& scratch, std::size_t y,
               std::size_t x_begin, std::size_t x_end) {
  Columns columns;
  columns.length = plan.size[2];
  columns.row_stride = plan.size[1] * plan.size[0];
  columns.first = y * plan.size[0] + x_begin;
  columns.x = x_begin;
  columns.y = y;
  columns.mask_word = y * plan.mask_words_per_row;
  columns.mask_stride = plan.size[1] * plan.mask_words_per_row;
  plan.integer ? columns_of<std::int32_t, true>(plan, squares, scratch, columns, x_end)
               : columns_of<double, true>(plan, squares, scratch, columns, x_end);
  hwy::FlushStream();  // makes streamed values visible before other threads see this task as done
}

}  // namespace
}  // namespace blum::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace blum::detail {
namespace {
HWY_EXPORT(rows);
HWY_EXPORT(columns_y);
HWY_EXPORT(columns_z);
}  // namespace

SquareTable::SquareTable(std::size_t length, double weight, bool integer) {
  const std::size_t entries = 2 * length - 1;
  if (integer) {
    integers = Buffer<std::int32_t>(entries);
  } else {
    doubles = Buffer<double>(entries);
  }
  for (std::size_t i = 0; i < entries; ++i) {
    const double offset = static_cast<double>(i) - static_cast<double>(length - 1);
    const double square = weight * (offset * offset);
    if (integer) {
      integers[i] = static_cast<std::int32_t>(square);
    } else {
      doubles[i] = square;
    }
  }
}

PassScratch::PassScratch(std::size_t row_length, std::size_t column_length, bool integer)
    : next_selected((row_length + 15) / 16),
      next_other((row_length + 15) / 16),
      partial_sites(16 * column_length),
      lowest(column_length),
      highest(column_length) {
  if (integer) {
    integer_costs = Buffer<std::int32_t>(16 * column_length);
  } else {
    double_costs = Buffer<double>(16 * column_length);
  }
}

void transform_rows(const TransformPlan& plan, PassScratch& scratch, std::size_t begin, std::size_t end) {
  HWY_DYNAMIC_DISPATCH(rows)(plan, scratch, begin, end);
}

void transform_columns_y(const TransformPlan& plan, const SquareTable& squares, PassScratch& scratch, std::size_t z,
                         std::size_t x_begin, std::size_t x_end) {
  HWY_DYNAMIC_DISPATCH(columns_y)(plan, squares, scratch, z, x_begin, x_end);
}

void transform_columns_z(const TransformPlan& plan, const SquareTable& squares, PassScratch& scratch, std::size_t y,
                         std::size_t x_begin, std::size_t x_end) {
  HWY_DYNAMIC_DISPATCH(columns_z)(plan, squares, scratch, y, x_begin, x_end);
}

}  // namespace blum::detail
#endif
