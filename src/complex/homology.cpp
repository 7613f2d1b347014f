#include "blum/complex/homology.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <queue>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/union_find.hpp"

namespace blum {
namespace {

using Face = std::array<std::uint32_t, 3>;

/// Returns each triangle once, in ascending order and with ascending corners. One pass sorts the triangles by their
/// first corner. Then those of each first corner are sorted separately, with checks for cancellation in between.
std::vector<Face> distinct_triangles(const ComplexView& complex, const Context& context) {
  std::vector<std::size_t> first(complex.vertex_count + 1, 0);
  const auto rising = [](Face face) {
    std::sort(face.begin(), face.end());
    return face;
  };
  for (const Face& face : complex.triangles) ++first[rising(face)[0] + std::size_t{1}];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Face> out(complex.triangles.size());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (const Face& face : complex.triangles) {
    const Face own = rising(face);
    out[next[own[0]]++] = own;
  }
  for (std::size_t v = 0; v < complex.vertex_count; ++v) {
    if (v % 65536 == 0) throw_if_cancelled(context);
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(first[v]),
              out.begin() + static_cast<std::ptrdiff_t>(first[v + 1]));
  }
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// The cells of a complex without duplicates.
struct Cells {
  std::vector<Face> triangles;
  Incidence incidence;

  Cells(const ComplexView& complex, const Context& context) {
    if (const std::string problem = problem_of(complex); !problem.empty()) {
      throw InvalidOption("not a complex: " + problem);
    }
    triangles = distinct_triangles(complex, context);
    incidence = Incidence({complex.vertex_count, complex.edges, triangles}, context);
  }
};

/// Returns the rank of the boundary map from edges to vertices: the number of vertices minus the number of components.
std::size_t vertex_rank(std::size_t vertex_count, const Incidence& incidence) {
  detail::UnionFind joined(vertex_count);
  std::size_t joins = 0;
  for (const auto& [a, b] : incidence.edges()) joins += joined.join(a, b) ? 1 : 0;
  return joins;
}

/// Removes columns of a matrix one by one, and finds rows that only one remaining column contains.
/// @tparam Columns  has size(), and [k]: the rows of column k, each once.
template <class Columns>
class Peeling {
 public:
  Peeling(const Columns& columns, std::size_t row_count) : columns_(columns), count_(row_count, 0), sum_(row_count, 0) {
    for (std::uint32_t k = 0; k < columns.size(); ++k) {
      for (const std::uint32_t row : columns[k]) {
        ++count_[row];
        sum_[row] += k;
      }
    }
    for (std::uint32_t row = 0; row < row_count; ++row) {
      if (count_[row] == 1) free_.push_back(row);
    }
  }

  struct Free {
    std::uint32_t row = 0;
    std::uint32_t column = 0;  ///< the only remaining column that contains the row
  };
  /// Returns a row that only one remaining column contains; nullopt if no such row exists.
  std::optional<Free> next() {
    while (!free_.empty()) {
      const std::uint32_t row = free_.back();
      free_.pop_back();
      if (count_[row] == 1) return Free{row, static_cast<std::uint32_t>(sum_[row])};
    }
    return std::nullopt;
  }
  void remove(std::uint32_t column) {
    for (const std::uint32_t row : columns_[column]) {
      sum_[row] -= column;
      if (--count_[row] == 1) free_.push_back(row);
    }
  }
  /// Returns the number of remaining columns that contain a row.
  [[nodiscard]] std::uint32_t count(std::uint32_t row) const { return count_[row]; }

 private:
  const Columns& columns_;
  std::vector<std::uint32_t> count_;
  std::vector<std::uint64_t> sum_;  ///< for each row: sum of the indices of its columns; if one is left, its index
  std::vector<std::uint32_t> free_;
};

/// A sparse matrix over Z/2 that computes its rank. For example, its columns are sheets, and its rows are the seams at
/// which they end.
///
/// If a row is in only one remaining column, that column is paired with the row and removed. Pairing repeats until no
/// such row exists (the surface is closed). Then one column is removed without a row, as unpaired, and pairing
/// continues. No column that is removed later contains a paired row. So the paired columns are independent, and only
/// the unpaired columns need elimination. Elimination clears the rows in the order in which they were paired.
class SparseMatrix {
 public:
  /// @param columns  the rows of each column, each once.
  SparseMatrix(const IndexRows& columns, std::size_t row_count, const Context& context)
      : context_(context), columns_(columns), key_(row_count, none) {}

  std::size_t rank() {
    const std::vector<std::uint32_t> set_aside = pair_up();
    for (const std::uint32_t column : set_aside) add_rest(rest_of(column));
    return paired_.size() + rests_.size();
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffU;

  /// Fills paired_ and key_. Returns the unpaired columns.
  std::vector<std::uint32_t> pair_up() {
    Peeling peeling(columns_, key_.size());
    std::vector<bool> is_gone(columns_.size(), false);
    const auto remove = [&](std::uint32_t column) {
      is_gone[column] = true;
      peeling.remove(column);
    };
    std::vector<std::uint32_t> set_aside;
    for (std::uint32_t k = 0; k < columns_.size(); ++k) {
      throw_now_and_then();
      while (const auto free = peeling.next()) {
        key_[free->row] = static_cast<std::uint32_t>(paired_.size());
        paired_.push_back(free->column);
        remove(free->column);
        throw_now_and_then();
      }
      if (is_gone[k]) continue;
      set_aside.push_back(k);
      remove(k);
    }
    return set_aside;
  }

  /// Eliminates all paired rows from an unpaired column. Returns the remaining rows in ascending order.
  std::vector<std::uint32_t> rest_of(std::uint32_t set_aside) {
    using Entry = std::pair<std::uint32_t, std::uint32_t>;  // index in paired_ or none, then the row
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> column;
    const auto add = [&](std::uint32_t f) {
      for (const std::uint32_t e : columns_[f]) column.emplace(key_[e], e);
    };
    add(set_aside);
    std::vector<std::uint32_t> rest;
    while (!column.empty()) {
      throw_now_and_then();
      const auto [key, row] = column.top();
      column.pop();
      if (!column.empty() && column.top().second == row) {
        column.pop();  // a row that occurs twice is 0 modulo 2
      } else if (key == none) {
        rest.push_back(row);
      } else {
        column.emplace(key, row);
        add(paired_[key]);
      }
    }
    return rest;
  }

  /// Reduces a column by the columns in rests_. Adds the result to rests_ unless it is empty.
  void add_rest(std::vector<std::uint32_t> column) {
    std::vector<std::uint32_t> sum;
    while (!column.empty()) {
      throw_now_and_then();
      const auto [other, is_new] = rests_.try_emplace(column.front());
      if (is_new) {
        other->second.swap(column);
        return;
      }
      sum.clear();
      std::set_symmetric_difference(column.begin(), column.end(), other->second.begin(), other->second.end(),
                                    std::back_inserter(sum));
      column.swap(sum);
    }
  }

  void throw_now_and_then() {
    if (++steps_ % 16384 == 0) throw_if_cancelled(context_);
  }

  const Context& context_;
  std::size_t steps_ = 0;
  const IndexRows& columns_;
  std::vector<std::uint32_t> key_;                                       ///< for each row: index in paired_, or none
  std::vector<std::uint32_t> paired_;                                    ///< paired columns, in order of removal
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> rests_;  ///< reduced columns, by their first row
};

/// Computes the dimension of the space of cycles of triangles over Z/2.
///
/// If an edge has exactly two triangles, a cycle contains both of them or neither. So a cycle consists of whole sheets:
/// triangles that are connected through edges of two triangles. A triangle with a free edge (no other triangle has it)
/// is in no cycle. After all such triangles are removed, the remaining sheets end only at seams. At each edge of a
/// seam, a cycle contains an even number of the sheets that end there. Edges at which the same sheets end give the same
/// condition.
class CyclesOfSheets {
 public:
  CyclesOfSheets(const Incidence& incidence, const Context& context)
      : sides_(incidence.sides()),
        edge_count_(incidence.edges().size()),
        left_(sides_, edge_count_),
        context_(context) {}

  std::size_t dimension() {
    remove_open();
    const std::size_t sheet_count = join_sheets();
    const IndexRows seams = distinct_seams();
    const IndexRows columns = detail::rows_of(seams.size(), sheet_count, [&](std::size_t k) { return seams[k]; });
    return sheet_count - SparseMatrix(columns, seams.size(), context_).rank();
  }

 private:
  static constexpr std::uint32_t no_sheet = 0xffffffffU;

  /// Removes triangles with a free edge until no triangle has a free edge.
  void remove_open() {
    sheet_.assign(sides_.size(), 0);
    std::size_t steps = 0;
    while (const auto free = left_.next()) {
      if (++steps % 16384 == 0) throw_if_cancelled(context_);
      sheet_[free->column] = no_sheet;
      left_.remove(free->column);
    }
  }

  /// Numbers the sheets, and returns their number.
  std::size_t join_sheets() {
    detail::UnionFind joined(static_cast<std::uint32_t>(sides_.size()));
    std::vector<std::uint32_t> first(edge_count_, no_sheet);  // first triangle at each edge
    for (std::uint32_t t = 0; t < sides_.size(); ++t) {
      if (sheet_[t] == no_sheet) continue;
      for (const std::uint32_t e : sides_[t]) {
        if (left_.count(e) != 2) continue;
        if (first[e] == no_sheet) {
          first[e] = t;
        } else {
          joined.join(first[e], t);
        }
      }
    }
    throw_if_cancelled(context_);
    std::uint32_t sheets = 0;
    std::vector<std::uint32_t> number(sides_.size(), no_sheet);
    for (std::uint32_t t = 0; t < sides_.size(); ++t) {
      if (sheet_[t] == no_sheet) continue;
      std::uint32_t& of_sheet = number[joined.find(t)];
      if (of_sheet == no_sheet) of_sheet = sheets++;
      sheet_[t] = of_sheet;
    }
    return sheets;
  }

  /// Returns for each edge of a seam the ascending list of sheets that end at it an odd number of times. Equal lists
  /// occur once.
  IndexRows distinct_seams() {
    std::vector<std::array<std::uint32_t, 2>> ends;  // edge, sheet
    for (std::uint32_t t = 0; t < sides_.size(); ++t) {
      if (sheet_[t] == no_sheet) continue;
      for (const std::uint32_t e : sides_[t]) {
        if (left_.count(e) > 2) ends.push_back({e, sheet_[t]});
      }
    }
    std::sort(ends.begin(), ends.end());
    throw_if_cancelled(context_);
    std::vector<std::size_t> first{0};
    std::vector<std::uint32_t> sheets;
    for (std::size_t k = 0; k < ends.size();) {
      const std::uint32_t edge = ends[k][0];
      while (k < ends.size() && ends[k][0] == edge) {
        const std::uint32_t sheet = ends[k][1];
        std::size_t times = 0;
        for (; k < ends.size() && ends[k][0] == edge && ends[k][1] == sheet; ++k) ++times;
        if (times % 2 == 1) sheets.push_back(sheet);
      }
      if (sheets.size() > first.back()) first.push_back(sheets.size());
    }
    return distinct({std::move(first), std::move(sheets)});
  }

  static IndexRows distinct(const IndexRows& lists) {
    std::vector<std::uint32_t> order(lists.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto compare = [&](std::uint32_t a, std::uint32_t b) {
      return std::lexicographical_compare_three_way(lists[a].begin(), lists[a].end(), lists[b].begin(), lists[b].end());
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      const auto compared = compare(a, b);
      return compared < 0 || (compared == 0 && a < b);
    });
    std::vector<std::size_t> first{0};
    std::vector<std::uint32_t> items;
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (k > 0 && compare(order[k - 1], order[k]) == 0) continue;
      items.insert(items.end(), lists[order[k]].begin(), lists[order[k]].end());
      first.push_back(items.size());
    }
    return {std::move(first), std::move(items)};
  }

  using Sides = std::span<const std::array<std::uint32_t, 3>>;
  const Sides sides_;  ///< for each triangle: its edges
  const std::size_t edge_count_;
  Peeling<Sides> left_;               ///< triangles as columns, edges as rows
  std::vector<std::uint32_t> sheet_;  ///< for each triangle: its sheet, or no_sheet if it was removed
  const Context& context_;
};

}  // namespace

BettiNumbers homology(const ComplexView& complex, const Context& context) {
  const Cells cells(complex, context);
  const std::size_t rank_1 = vertex_rank(complex.vertex_count, cells.incidence);
  const std::size_t cycles = CyclesOfSheets(cells.incidence, context).dimension();
  const std::size_t rank_2 = cells.triangles.size() - cycles;
  const auto number = [](std::size_t n) { return static_cast<std::int64_t>(n); };
  return {number(complex.vertex_count - rank_1),
          number(cells.incidence.edges().size()) - number(rank_1) - number(rank_2), number(cycles)};
}

std::int64_t euler_characteristic(const ComplexView& complex, const Context& context) {
  const Cells cells(complex, context);
  const auto number = [](std::size_t n) { return static_cast<std::int64_t>(n); };
  return number(complex.vertex_count) - number(cells.incidence.edges().size()) + number(cells.triangles.size());
}

}  // namespace blum
