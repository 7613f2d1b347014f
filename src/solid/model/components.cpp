#include "solid/model/components.hpp"

#include <algorithm>

namespace blum::detail {
namespace {

constexpr std::uint32_t none = 0xffffffffU;

}  // namespace

void SquareComponents::join_arcs() {
  inner_ends_.clear();
  for (std::size_t a = 0; a < arcs_.size(); ++a) {
    const auto arc = static_cast<std::uint32_t>(intervals_ + a);
    for (const End& end : arcs_[a]) {
      if (end.on_border) {
        joined_.join(end.id, arc);
      } else {
        inner_ends_.push_back({end.id, arc});
      }
    }
  }
  std::sort(inner_ends_.begin(), inner_ends_.end());
  for (std::size_t k = 0; k + 1 < inner_ends_.size(); ++k) {
    if (inner_ends_[k][0] == inner_ends_[k + 1][0]) joined_.join(inner_ends_[k][1], inner_ends_[k + 1][1]);
  }
}

bool SquareComponents::finish(FunctionRef<bool(std::span<const std::uint32_t>)> is_hole) {
  joined_.reset(intervals_ + arcs_.size());
  for (const auto& [one, other] : corners_) joined_.join(one, other);
  join_arcs();
  component_.assign(intervals_ + arcs_.size(), none);
  count_ = 0;
  loops_.clear();
  for (std::uint32_t k = 0; k < component_.size(); ++k) {
    const std::uint32_t first = joined_.find(k);
    if (first == k) component_[k] = count_++;
    component_[k] = component_[first];
    if (first >= intervals_) {
      const auto shift = static_cast<std::uint32_t>(intervals_);
      loops_.push_back({first - shift, k - shift});
    }
  }
  std::sort(loops_.begin(), loops_.end());
  for (std::size_t i = 0; i < loops_.size();) {
    loop_.clear();
    std::size_t j = i;
    for (; j < loops_.size() && loops_[j][0] == loops_[i][0]; ++j) loop_.push_back(loops_[j][1]);
    if (is_hole(loop_)) return false;
    i = j;
  }
  return true;
}

bool CubeComponents::finish(FunctionRef<std::int64_t(std::uint32_t)> euler_of) {
  std::sort(pieces_.begin(), pieces_.end());
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    const auto [piece, part] = pieces_[k];
    if (k > 0 && pieces_[k - 1].first == piece) {
      joined_.join(pieces_[k - 1].second, part);
    } else {
      euler_[part] += euler_of(piece);
    }
  }
  component_.assign(euler_.size(), none);
  count_ = 0;
  for (std::uint32_t k = 0; k < component_.size(); ++k) {
    const std::uint32_t first = joined_.find(k);
    component_[k] = first == k ? count_++ : component_[first];
    if (first != k) euler_[first] += euler_[k];
  }
  for (std::uint32_t k = 0; k < component_.size(); ++k) {
    if (joined_.find(k) == k && euler_[k] != 2) return false;
  }
  return true;
}

}  // namespace blum::detail
