#include "medial_axis/importance.hpp"

namespace blum {

Importance::Importance(std::size_t node_count, std::span<const Entry> entries)
    : words_((node_count * 8 + 63) / 64, 0), first_(words_.size(), 0) {
  values_.reserve(entries.size());
  for (const Entry& entry : entries) {
    words_[entry.cell >> 6U] |= std::uint64_t{1} << (entry.cell & 63U);
    values_.push_back(entry.degrees);
  }
  std::uint32_t before = 0;
  for (std::size_t w = 0; w < words_.size(); ++w) {
    first_[w] = before;
    before += static_cast<std::uint32_t>(std::popcount(words_[w]));
  }
}

}  // namespace blum
