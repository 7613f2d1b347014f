#include "certificate/homology/elimination.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace blum::verifier {

void tidy(SparseRow& row) {
  std::sort(row.begin(), row.end());
  std::size_t kept = 0;
  for (std::size_t k = 0; k < row.size();) {
    const std::uint32_t column = row[k].first;
    std::int64_t sum = 0;
    for (; k < row.size() && row[k].first == column; ++k) sum += row[k].second;
    if (sum != 0) row[kept++] = {column, sum};
  }
  row.resize(kept);
}

void Elimination::add(SparseRow row) {
  if (over_ == Over::two) {
    std::erase_if(row, [](const auto& entry) { return entry.second % 2 == 0; });
    for (auto& entry : row) entry.second = 1;
  }
  if (gave_up_) return;
  reduce(row);
  if (!gave_up_ && !take(row)) aside_.push_back(std::move(row));
}

void Elimination::reduce(SparseRow& row) {
  constexpr std::int64_t largest = std::int64_t{1} << 30;
  SparseRow sum;
  while (true) {
    // Uses the earliest pivot. Later pivots have no entry in its column, so the column stays 0.
    std::uint32_t first = none;
    std::int64_t value = 0;
    for (const auto& [column, entry] : row) {
      if (column >= order_.size()) break;
      if (order_[column] >= first) continue;
      first = order_[column];
      value = entry;
    }
    if (first == none) return;
    const SparseRow& pivot = pivots_[first];
    const auto at = std::lower_bound(pivot.begin(), pivot.end(), std::pair{column_of_[first], -largest});
    const std::int64_t times = -value * at->second;  // the pivot entry is 1 or -1
    sum.clear();
    auto p = pivot.begin();
    const auto put = [&](std::uint32_t column, std::int64_t entry) {
      if (over_ == Over::two) entry &= 1;
      if (std::abs(entry) > largest) gave_up_ = true;
      if (entry != 0) sum.emplace_back(column, entry);
    };
    for (const auto& [column, entry] : row) {
      for (; p != pivot.end() && p->first < column; ++p) put(p->first, times * p->second);
      const bool is_both = p != pivot.end() && p->first == column;
      put(column, is_both ? entry + times * p->second : entry);
      if (is_both) ++p;
    }
    for (; p != pivot.end(); ++p) put(p->first, times * p->second);
    row.swap(sum);
    steps_ += row.size() + pivot.size();
    if (steps_ > most_steps_) gave_up_ = true;
    if (gave_up_) return;
  }
}

bool Elimination::take(SparseRow& row) {
  if (row.empty()) return true;
  if (row.front().first >= order_.size()) {
    left_.push_back(std::move(row));
    return true;
  }
  for (const auto& [column, entry] : row) {
    if (column >= order_.size()) return false;
    if (std::abs(entry) != 1) continue;
    order_[column] = static_cast<std::uint32_t>(pivots_.size());
    column_of_.push_back(column);
    pivots_.push_back(std::move(row));
    return true;
  }
  return false;
}

bool Elimination::retry() {
  for (bool is_better = true; is_better && !aside_.empty() && !gave_up_;) {
    is_better = false;
    std::vector<SparseRow> again;
    again.swap(aside_);
    for (SparseRow& row : again) {
      reduce(row);
      if (gave_up_) return false;
      if (take(row)) {
        is_better = true;
      } else {
        aside_.push_back(std::move(row));
      }
    }
  }
  return aside_.empty() && !gave_up_;
}

std::size_t rank_modulo_2(const std::vector<SparseRow>& rows, std::size_t columns) {
  using Bits = std::vector<std::uint64_t>;
  constexpr std::size_t width = 64;
  std::vector<Bits> pivots;
  std::vector<std::size_t> column_of;
  for (const SparseRow& row : rows) {
    Bits bits(columns / width + 1, 0);
    for (const auto& [column, entry] : row) {
      if (entry % 2 != 0) bits[column / width] |= std::uint64_t{1} << column % width;
    }
    for (std::size_t p = 0; p < pivots.size(); ++p) {
      if ((bits[column_of[p] / width] >> column_of[p] % width & 1U) == 0) continue;
      for (std::size_t k = 0; k < bits.size(); ++k) bits[k] ^= pivots[p][k];
    }
    const auto word = std::find_if(bits.begin(), bits.end(), [](std::uint64_t b) { return b != 0; });
    if (word == bits.end()) continue;
    column_of.push_back(static_cast<std::size_t>(word - bits.begin()) * width +
                        static_cast<std::size_t>(std::countr_zero(*word)));
    pivots.push_back(std::move(bits));
  }
  return pivots.size();
}

}  // namespace blum::verifier
