// Blum: bounds on the distance of a box's second sites, and lists of candidates. SPDX-License-Identifier: Apache-2.0
#if defined(BLUM_FIELD_CPU_SECOND_BOUNDS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BLUM_FIELD_CPU_SECOND_BOUNDS_INL
#undef BLUM_FIELD_CPU_SECOND_BOUNDS_INL
#else
#define BLUM_FIELD_CPU_SECOND_BOUNDS_INL
#endif

#include "field/cpu/gather-inl.hpp"
#include "field/cpu/second_kernel.hpp"
#include "field/cpu/second_scratch.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {

using OfSite = SecondLabels::OfSite;

/// Surface points that bound the distance of the second site. Two sites are "apart" if no site shares labels with both
/// of them. If the sites of two points are apart, one of these sites may be second, for any first site. So the second
/// site is at most as far as the further of the two points. A single point suffices if its site may be second at all
/// nodes of the box. Without points, there is no bound.
struct Bounds {
  std::array<Vec3f, 2> point{};
  std::array<OfSite, 2> labels{};
  std::size_t count = 0;
};

struct BoundedTileTest {
  TileTest first, second;
  std::size_t count;
  Vec center;
  V radius;

  BoundedTileTest(const CenteredBox& tile, const Bounds& bounds)
      : first(tile, bounds.point[0]),
        second(tile, bounds.point[1]),
        count(bounds.count),
        center(first.center),
        radius(first.radius) {}

  HWY_INLINE std::uint32_t keeps(const BoxArrays& boxes, std::size_t at) const {
    if (count == 0) return 0xffff;
    return count == 1 ? first.keeps(boxes, at) : first.keeps(boxes, at) | second.keeps(boxes, at);
  }
};

template <int boxes>
struct BoundedTest : BlockTest<boxes> {
  Domination other;
  std::size_t count;

  BoundedTest(const CenteredBox& box, const Bounds& bounds)
      : BlockTest<boxes>(box, Dominators{{bounds.point[0]}, 1}),
        other(box.center, Dominators{{bounds.point[1]}, 1}, box.half + Vec3f{box_slack, box_slack, box_slack}),
        count(bounds.count) {}
  BoundedTest(const Halving& h, const Bounds& bounds)
      : BlockTest<boxes>(h, Dominators{{bounds.point[0]}, 1}),
        other(h.middle, Dominators{{bounds.point[1]}, 1}, h.reach()),
        count(bounds.count) {}

  /// Replaces the bounds by a single bound that holds for all nodes of the box.
  void bound_by(const Domination& all) {
    this->domination = all;
    count = 1;
  }

  template <class Block>
  HWY_INLINE M keeps(const Block& block) const {
    if (count == 0) return hn::FirstN(d, lanes);
    const M keep = block.keeps(this->domination);
    return count == 1 ? keep : hn::Or(keep, block.keeps(other));
  }
};

HWY_INLINE void load_block(const PlaceList& list, std::size_t b, Columns& out) {
  const float* base = list.records().data()->column.data();
  const std::uint32_t* places = list.places() + b * lanes;
  load_columns_of([&](std::size_t k) { return base + std::size_t{16} * places[k]; }, out);
}

/// Copies the candidates whose bit is set for a child to `out`.
HWY_INLINE void list_child(const PlaceList& parent, const ChildBits& child_bits, std::size_t child, PlaceList& out) {
  out.reset(parent.records(), parent.count());
  const std::uint16_t* words = child_bits.child(child);
  std::size_t count = 0;
  for (std::size_t b = 0; b < child_bits.blocks(); ++b) {
    // All lanes are written; the next block overwrites the unused ones.
    alignas(8) const std::array<std::uint8_t, 8> word{static_cast<std::uint8_t>(words[b] & 0xff),
                                                      static_cast<std::uint8_t>(words[b] >> 8)};
    const auto mask = hn::LoadMaskBits(di, word.data());
    hn::StoreU(hn::Compress(hn::LoadU(di, parent.places() + b * lanes), mask), di, out.places() + count);
    count += static_cast<std::size_t>(std::popcount(words[b]));
  }
  out.finish(count);
}

}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();
#endif
