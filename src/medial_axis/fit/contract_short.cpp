#include "medial_axis/fit/contract_short.hpp"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "medial_axis/fit/shrinking_lists.hpp"

namespace blum {
namespace {

class ShortEdges {
 public:
  ShortEdges(AxisLists& lists, const Surface& surface, double voxel, const ShortLengths& lengths,
             const Context& context)
      : lists_(lists, surface, context), voxel_(voxel), lengths_(lengths), context_(context) {
    for (const auto& [a, b] : lists_.edges()) {
      const double size = length(lists_.position(a) - lists_.position(b));
      if (size <= limit(a, b)) short_.emplace_back(size, a, b);
    }
    std::sort(short_.begin(), short_.end());
  }

  void run() {
    // What one contraction forbids another one may allow.
    for (bool is_changed = true; is_changed && !short_.empty();) {
      throw_if_cancelled(context_);
      const std::size_t count = short_.size();
      std::vector<std::tuple<double, std::uint32_t, std::uint32_t>> left;
      for (const auto& edge : short_) {
        if (!take(std::get<1>(edge), std::get<2>(edge))) left.push_back(edge);
      }
      short_ = std::move(left);
      is_changed = short_.size() < count;
    }
    lists_.write();
  }

 private:
  [[nodiscard]] double limit(std::uint32_t a, std::uint32_t b) const {
    const int least = std::min(lists_.rank(a), lists_.rank(b));
    const double voxels = least >= ShrinkingLists::on_seam ? lengths_.on_seams
                          : least > 0                      ? lengths_.on_rims
                                                           : lengths_.others;
    return voxels * voxel_;
  }

  /// @return  whether the edge is gone.
  bool take(std::uint32_t a, std::uint32_t b) {
    std::uint32_t from = lists_.now(a);
    std::uint32_t to = lists_.now(b);
    if (from == to) return true;
    if (length(lists_.position(from) - lists_.position(to)) > 2 * limit(from, to)) return false;
    // Seams and curves stay before rims, these before the insides of sheets.
    if (std::pair(lists_.rank(from), to) > std::pair(lists_.rank(to), from)) std::swap(from, to);
    if (!lists_.may_contract(from, to)) {
      std::swap(from, to);
      if (!lists_.may_contract(from, to)) return false;
    }
    lists_.contract(from, to);
    return true;
  }

  ShrinkingLists lists_;
  double voxel_;
  ShortLengths lengths_;
  const Context& context_;
  std::vector<std::tuple<double, std::uint32_t, std::uint32_t>> short_;
};

}  // namespace

void contract_short(AxisLists& lists, const Surface& surface, double voxel, const ShortLengths& lengths,
                    const Context& context) {
  ShortEdges(lists, surface, voxel, lengths, context).run();
}

}  // namespace blum
