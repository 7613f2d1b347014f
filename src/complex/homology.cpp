#include "blum/complex/homology.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
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

/// Triangles with rising corners, each once and in rising order: sorted by their first corner in one pass, then each of
/// these parts, so that a caller who wants to stop need not wait for all.
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

/// What a complex is made of, each cell once.
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

/// Rank of the map from edges to vertices: vertices less components.
std::size_t vertex_rank(std::size_t vertex_count, const Incidence& incidence) {
  detail::UnionFind joined(vertex_count);
  std::size_t joins = 0;
  for (const auto& [a, b] : incidence.edges()) joins += joined.join(a, b) ? 1 : 0;
  return joins;
}

/// Lists of numbers, one after the other.
struct Lists {
  std::vector<std::size_t> first{0};
  std::vector<std::uint32_t> all;

  [[nodiscard]] std::size_t count() const { return first.size() - 1; }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t k) const {
    return std::span(all).subspan(first[k], first[k + 1] - first[k]);
  }
  void close() { first.push_back(all.size()); }
};

/// Rows and columns changed over. @param row_count  numbers are below this
Lists transposed(const Lists& lists, std::size_t row_count) {
  Lists out;
  out.first.assign(row_count + 1, 0);
  for (const std::uint32_t row : lists.all) ++out.first[row + std::size_t{1}];
  std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
  out.all.resize(lists.all.size());
  std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
  for (std::size_t k = 0; k < lists.count(); ++k) {
    for (const std::uint32_t row : lists[k]) out.all[next[row]++] = static_cast<std::uint32_t>(k);
  }
  return out;
}

/// A matrix over Z/2 and its rank: of the boundaries of surfaces, say, seams as rows.
///
/// A column with a row that no other column has is paired with that row and removed, over and over. Where none
/// has one (the surface is closed) a column is set aside, and it goes on. Each paired row is no row of columns
/// removed later: paired columns are independent, and only those set aside need elimination, rows that were paired
/// first coming first.
class SparseMatrix {
 public:
  /// @param columns  the rows of each, none twice.
  SparseMatrix(const Lists& columns, std::size_t row_count, const Context& context)
      : context_(context), columns_(columns), key_(row_count, none) {}

  std::size_t rank() {
    const std::vector<std::uint32_t> set_aside = pair_up();
    for (const std::uint32_t column : set_aside) add_rest(rest_of(column));
    return paired_.size() + rests_.size();
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffU;

  /// Fills paired_ and key_; returns the columns set aside.
  std::vector<std::uint32_t> pair_up() {
    std::vector<std::uint32_t> count(key_.size(), 0);
    std::vector<std::uint64_t> sum(key_.size(), 0);  // of the columns that have a row: the last one is the sum
    for (std::uint32_t f = 0; f < columns_.count(); ++f) {
      for (const std::uint32_t e : columns_[f]) {
        ++count[e];
        sum[e] += f;
      }
    }
    std::vector<std::uint32_t> free;
    for (std::uint32_t e = 0; e < count.size(); ++e) {
      if (count[e] == 1) free.push_back(e);
    }
    std::vector<bool> is_gone(columns_.count(), false);
    const auto remove = [&](std::uint32_t f) {
      is_gone[f] = true;
      for (const std::uint32_t e : columns_[f]) {
        --count[e];
        sum[e] -= f;
        if (count[e] == 1) free.push_back(e);
      }
    };
    std::vector<std::uint32_t> set_aside;
    for (std::uint32_t f = 0; f < columns_.count(); ++f) {
      throw_now_and_then();
      while (!free.empty()) {
        const std::uint32_t e = free.back();
        free.pop_back();
        if (count[e] != 1) continue;
        const auto last = static_cast<std::uint32_t>(sum[e]);
        key_[e] = static_cast<std::uint32_t>(paired_.size());
        paired_.push_back(last);
        remove(last);
        throw_now_and_then();
      }
      if (is_gone[f]) continue;
      set_aside.push_back(f);
      remove(f);
    }
    return set_aside;
  }

  /// A column that was set aside, freed of all paired rows: the rows that remain, rising.
  std::vector<std::uint32_t> rest_of(std::uint32_t set_aside) {
    using Entry = std::pair<std::uint32_t, std::uint32_t>;  // when the row was paired, and the row
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
        column.pop();  // twice is not at all
      } else if (key == none) {
        rest.push_back(row);
      } else {
        column.emplace(key, row);
        add(paired_[key]);
      }
    }
    return rest;
  }

  /// Reduces a column by those before it, and keeps it if anything is left.
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
  const Lists& columns_;
  std::vector<std::uint32_t> key_;                                       ///< of each row: its place in paired_
  std::vector<std::uint32_t> paired_;                                    ///< columns, in order of removal
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> rests_;  ///< by their first row
};

/// The dimension of the cycles of triangles over Z/2.
///
/// A cycle has none of two triangles at an edge or both, so it is made of whole sheets: triangles that are joined
/// across edges with two of them. A triangle with an edge of its own is in no cycle; what is left when none has one is
/// sheets that end at seams, and at each edge of a seam an even number of them. Seams that the same sheets end at
/// say the same.
class CyclesOfSheets {
 public:
  CyclesOfSheets(const Incidence& incidence, const Context& context)
      : sides_(incidence.sides()), count_(incidence.edges().size(), 0), context_(context) {}

  std::size_t dimension() {
    remove_open();
    const std::size_t sheet_count = join_sheets();
    const Lists seams = distinct_seams();
    const Lists columns = transposed(seams, sheet_count);
    return sheet_count - SparseMatrix(columns, seams.count(), context_).rank();
  }

 private:
  static constexpr std::uint32_t no_sheet = 0xffffffffU;

  /// Removes triangles with an edge of their own, until there is none. Fills count_ and sheet_.
  void remove_open() {
    std::vector<std::uint64_t> sum(count_.size(), 0);  // of the triangles at an edge: the last one is the sum
    for (std::uint32_t t = 0; t < sides_.size(); ++t) {
      for (const std::uint32_t e : sides_[t]) {
        ++count_[e];
        sum[e] += t;
      }
    }
    std::vector<std::uint32_t> free;
    for (std::uint32_t e = 0; e < count_.size(); ++e) {
      if (count_[e] == 1) free.push_back(e);
    }
    sheet_.assign(sides_.size(), 0);
    for (std::size_t steps = 1; !free.empty(); ++steps) {
      if (steps % 16384 == 0) throw_if_cancelled(context_);
      const std::uint32_t own = free.back();
      free.pop_back();
      if (count_[own] != 1) continue;
      const auto t = static_cast<std::uint32_t>(sum[own]);
      sheet_[t] = no_sheet;
      for (const std::uint32_t e : sides_[t]) {
        sum[e] -= t;
        if (--count_[e] == 1) free.push_back(e);
      }
    }
  }

  /// Numbers the sheets; returns how many there are.
  std::size_t join_sheets() {
    detail::UnionFind joined(static_cast<std::uint32_t>(sides_.size()));
    std::vector<std::uint32_t> first(count_.size(), no_sheet);  // triangle at an edge
    for (std::uint32_t t = 0; t < sides_.size(); ++t) {
      if (sheet_[t] == no_sheet) continue;
      for (const std::uint32_t e : sides_[t]) {
        if (count_[e] != 2) continue;
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

  /// For each seam the sheets that end at it an odd number of times, rising; each list once.
  Lists distinct_seams() {
    std::vector<std::array<std::uint32_t, 2>> ends;  // edge, sheet
    for (std::uint32_t t = 0; t < sides_.size(); ++t) {
      if (sheet_[t] == no_sheet) continue;
      for (const std::uint32_t e : sides_[t]) {
        if (count_[e] > 2) ends.push_back({e, sheet_[t]});
      }
    }
    std::sort(ends.begin(), ends.end());
    throw_if_cancelled(context_);
    Lists all;
    for (std::size_t k = 0; k < ends.size();) {
      const std::uint32_t edge = ends[k][0];
      while (k < ends.size() && ends[k][0] == edge) {
        const std::uint32_t sheet = ends[k][1];
        std::size_t times = 0;
        for (; k < ends.size() && ends[k][0] == edge && ends[k][1] == sheet; ++k) ++times;
        if (times % 2 == 1) all.all.push_back(sheet);
      }
      if (all.all.size() > all.first.back()) all.close();
    }
    return distinct(all);
  }

  static Lists distinct(const Lists& lists) {
    std::vector<std::uint32_t> order(lists.count());
    std::iota(order.begin(), order.end(), 0U);
    const auto compare = [&](std::uint32_t a, std::uint32_t b) {
      return std::lexicographical_compare_three_way(lists[a].begin(), lists[a].end(), lists[b].begin(), lists[b].end());
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      const auto compared = compare(a, b);
      return compared < 0 || (compared == 0 && a < b);
    });
    Lists out;
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (k > 0 && compare(order[k - 1], order[k]) == 0) continue;
      out.all.insert(out.all.end(), lists[order[k]].begin(), lists[order[k]].end());
      out.close();
    }
    return out;
  }

  std::span<const std::array<std::uint32_t, 3>> sides_;  ///< the edges of each triangle
  std::vector<std::uint32_t> count_;                     ///< of triangles at each edge
  std::vector<std::uint32_t> sheet_;                     ///< of each triangle
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
