// Blum: evaluates the candidates of a leaf of 4 x 4 x 4 nodes. SPDX-License-Identifier: Apache-2.0
#if defined(BLUM_FIELD_CPU_LEAF_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef BLUM_FIELD_CPU_LEAF_INL
#undef BLUM_FIELD_CPU_LEAF_INL
#else
#define BLUM_FIELD_CPU_LEAF_INL
#endif

#include "field/cpu/halving-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace blum::cpu {
namespace HWY_NAMESPACE {

/// Nodes of a leaf. Node l is at (l % 4, l / 4 % 4, l / 16). One pass computes four vectors of nodes. The first
/// `planar` vectors differ in x and y only; this pattern repeats for `slabs` values of z.
constexpr std::size_t leaf_nodes = 64;
constexpr std::size_t pass_vectors = 4;
constexpr std::size_t planar = lanes >= 16 ? 1 : (lanes >= 4 ? 16 / lanes : 4);
constexpr std::size_t slabs = pass_vectors / planar;
constexpr std::size_t pass_nodes = pass_vectors * lanes;
constexpr std::size_t passes = leaf_nodes / pass_nodes;

/// Closest sites of a leaf's nodes found so far.
struct LeafState {
  alignas(64) std::array<float, leaf_nodes> squared;
  alignas(64) std::array<std::uint32_t, leaf_nodes> id;
  /// For each node: affine side function of the closest site, if requested.
  alignas(64) std::array<float, leaf_nodes> side;
};

/// Layout of prepared candidates as columns. Each affine function is stored as its value at the centre of the leaf's
/// parent box, and its gradient.
struct LeafVertex {
  enum { to_site = 0, planes = 3, id = 19, count = 20 };  // centre - p; four planes of 4 values each
};
struct LeafEdge {
  enum {
    across_b = 0,
    across_n = 4,
    along = 8,
    half_length = 12,
    second_b,
    second_n,
    first_limit,
    side_b,
    side_n,
    id,
    count
  };
};
struct LeafFace {
  enum { height = 0, minus_u = 4, minus_v = 8, id = 12, count };
};

/// Writes blocks of candidates, relative to the centre of a box of 8 x 8 x 8 nodes, for the box's leaves to read.
struct LeafStore {
  LeafColumns& out;

  HWY_INLINE void put(int column, std::size_t b, V value) const {
    hn::Store(value, d, out.column(static_cast<std::size_t>(column)) + b * lanes);
  }
  HWY_INLINE void put(int column, std::size_t b, V value, const Vec& gradient) const {
    put(column, b, value);
    put(column + 1, b, gradient.x);
    put(column + 2, b, gradient.y);
    put(column + 3, b, gradient.z);
  }
  HWY_INLINE void operator()(std::size_t b, const VertexBlock& block, V id) const {
    put(LeafVertex::to_site, b, block.to_site.x);
    put(LeafVertex::to_site + 1, b, block.to_site.y);
    put(LeafVertex::to_site + 2, b, block.to_site.z);
    for (int k = 0; k < 4; ++k) {
      const Vec& e = block.direction[k];
      put(LeafVertex::planes + 4 * k, b, hn::Sub(dot(block.to_site, e), set(plane_slack)), e);
    }
    put(LeafVertex::id, b, id);
  }
  HWY_INLINE void operator()(std::size_t b, const EdgeBlock& block, V id) const {
    put(LeafEdge::across_b, b, block.across_b, block.b);
    put(LeafEdge::across_n, b, block.across_n, block.n);
    put(LeafEdge::along, b, block.along, block.t);
    put(LeafEdge::half_length, b, block.half_length);
    put(LeafEdge::second_b, b, block.second_b);
    put(LeafEdge::second_n, b, block.second_n);
    put(LeafEdge::first_limit, b, block.first_limit);
    // The edge's pseudonormal is the sum of the normals of its two faces. In the frame of b and n, it is side *
    // (second_n, 1 - second_b), of squared length 2 (1 - second_b).
    const V rest = hn::Sub(set(1.0F), block.second_b);
    const V scale = hn::Div(block.side, hn::Sqrt(hn::Max(hn::Add(rest, rest), set(1e-12F))));
    put(LeafEdge::side_b, b, hn::Mul(scale, block.second_n));
    put(LeafEdge::side_n, b, hn::Mul(scale, rest));
    put(LeafEdge::id, b, id);
  }
  HWY_INLINE void operator()(std::size_t b, const FaceBlock& block, V id) const {
    put(LeafFace::height, b, block.height, block.n);
    put(LeafFace::minus_u, b, block.minus_u, block.gradient_u);
    put(LeafFace::minus_v, b, block.minus_v, block.gradient_v);
    put(LeafFace::id, b, id);
  }
};

/// Finds the candidates of a block that no dominator of a leaf beats (is closer than). All values are evaluated at the
/// leaf's centre. `offset` is its position relative to the point that the columns are relative to.
struct LeafDomination {
  Domination domination;
  Vec offset;

  HWY_INLINE V at(const LeafColumns& in, int column, std::size_t b) const {
    return hn::Load(d, in.column(static_cast<std::size_t>(column)) + b * lanes);
  }
  HWY_INLINE Vec vec(const LeafColumns& in, int column, std::size_t b) const {
    return {at(in, column, b), at(in, column + 1, b), at(in, column + 2, b)};
  }
  template <Kind kind>
  HWY_INLINE std::uint32_t keeps(const LeafColumns& in, std::size_t b) const {
    if constexpr (kind == vertex_kind) {
      const Vec to_site = vec(in, LeafVertex::to_site, b) + offset;
      return bits(domination.keeps(to_site, dot(to_site, to_site), hn::Zero(d)));
    } else if constexpr (kind == edge_kind) {
      const Vec gradient_b = vec(in, LeafEdge::across_b + 1, b);
      const Vec gradient_n = vec(in, LeafEdge::across_n + 1, b);
      const V at_b = hn::Add(at(in, LeafEdge::across_b, b), dot(gradient_b, offset));
      const V at_n = hn::Add(at(in, LeafEdge::across_n, b), dot(gradient_n, offset));
      const Vec to_flat = {hn::MulAdd(at_b, gradient_b.x, hn::Mul(at_n, gradient_n.x)),
                           hn::MulAdd(at_b, gradient_b.y, hn::Mul(at_n, gradient_n.y)),
                           hn::MulAdd(at_b, gradient_b.z, hn::Mul(at_n, gradient_n.z))};
      const V along_flat = square(support(vec(in, LeafEdge::along + 1, b), domination.reach));
      return bits(domination.keeps(to_flat, hn::MulAdd(at_b, at_b, square(at_n)), along_flat));
    } else {
      const Vec n = vec(in, LeafFace::height + 1, b);
      const V height = hn::Add(at(in, LeafFace::height, b), dot(n, offset));
      const Vec to_flat = {hn::Mul(height, n.x), hn::Mul(height, n.y), hn::Mul(height, n.z)};
      return bits(domination.keeps(to_flat, square(height), domination.squared_reach));
    }
  }
};

/// Positions of the nodes of a pass, relative to the centre of the leaf's parent box. Affine functions are evaluated at
/// these positions.
struct LatticeNodes {
  static constexpr std::size_t vectors = pass_vectors;
  V x[planar], y[planar], z[slabs];

  HWY_INLINE void affine(V base, V gx, V gy, V gz, V out[vectors]) const {
    for (std::size_t p = 0; p < planar; ++p) {
      const V in_plane = hn::MulAdd(gx, x[p], hn::MulAdd(gy, y[p], base));
      for (std::size_t s = 0; s < slabs; ++s) out[s * planar + p] = hn::MulAdd(gz, z[s], in_plane);
    }
  }
  /// Computes the squared lengths of positions + offset.
  HWY_INLINE void squared_lengths(const Vec& offset, V out[vectors]) const {
    for (std::size_t p = 0; p < planar; ++p) {
      const V in_plane = hn::MulAdd(hn::Add(offset.x, x[p]), hn::Add(offset.x, x[p]), square(hn::Add(offset.y, y[p])));
      for (std::size_t s = 0; s < slabs; ++s) {
        const V dz = hn::Add(offset.z, z[s]);
        out[s * planar + p] = hn::MulAdd(dz, dz, in_plane);
      }
    }
  }
};

/// Positions of a leaf's nodes relative to the centre of its parent box, for each pass.
struct LeafPattern {
  using Pass = LatticeNodes;
  Pass pass[passes];

  LeafPattern() = default;
  /// @param first_node  position of the first node, relative to the centre of the parent box.
  LeafPattern(const Vec3d& first_node, const Vec3d& spacing) {
    std::array<std::array<float, 4>, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < 4; ++k) {
        at[axis][k] = static_cast<float>(first_node[axis] + static_cast<double>(k) * spacing[axis]);
      }
    }
    for (std::size_t index = 0; index < passes; ++index) {
      const std::size_t first = index * pass_nodes;
      for (std::size_t p = 0; p < planar; ++p) {
        alignas(64) std::array<float, 16> x{};
        alignas(64) std::array<float, 16> y{};
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          const std::size_t node = first + p * lanes + lane;
          x[lane] = at[0][node % 4];
          y[lane] = at[1][node / 4 % 4];
        }
        pass[index].x[p] = hn::Load(d, x.data());
        pass[index].y[p] = hn::Load(d, y.data());
      }
      for (std::size_t s = 0; s < slabs; ++s) pass[index].z[s] = set(at[2][(first + s * planar * lanes) / 16]);
    }
  }
};

/// Evaluates candidates at the nodes of one pass. Offers each of them to the derived class, which keeps the winners.
template <class Winners, bool with_sides>
struct LeafEvaluation {
  static constexpr std::size_t vectors = LatticeNodes::vectors;
  LatticeNodes nodes;

  HWY_INLINE void offer(std::size_t k, V inside, V candidate, V candidate_id, V candidate_side) {
    static_cast<Winners*>(this)->take(k, inside, candidate, candidate_id, candidate_side);
  }

  HWY_INLINE void affine(const LeafColumns& in, int column, std::size_t at, V out[vectors]) const {
    const auto c = static_cast<std::size_t>(column);
    nodes.affine(set(in.column(c)[at]), set(in.column(c + 1)[at]), set(in.column(c + 2)[at]), set(in.column(c + 3)[at]),
                 out);
  }

  HWY_INLINE void vertex(const LeafColumns& in, std::size_t at, const std::vector<Vec3f>& vertex_sides) {
    V inside[vectors];
    V value[vectors];
    affine(in, LeafVertex::planes, at, inside);
    for (int plane = 1; plane < 4; ++plane) {
      affine(in, LeafVertex::planes + 4 * plane, at, value);
      for (std::size_t k = 0; k < vectors; ++k) inside[k] = hn::And(inside[k], value[k]);
    }
    const Vec to_site{set(in.column(LeafVertex::to_site)[at]), set(in.column(LeafVertex::to_site + 1)[at]),
                      set(in.column(LeafVertex::to_site + 2)[at])};
    if constexpr (with_sides) {
      std::uint32_t vertex_id = 0;
      std::memcpy(&vertex_id, in.column(LeafVertex::id) + at, sizeof(vertex_id));
      const Vec n = set(vertex_sides[vertex_id]);
      nodes.affine(dot(to_site, n), n.x, n.y, n.z, value);
    }
    const V new_id = set(in.column(LeafVertex::id)[at]);
    V squared[vectors];
    nodes.squared_lengths(to_site, squared);
    for (std::size_t k = 0; k < vectors; ++k) offer(k, inside[k], squared[k], new_id, value[k]);
  }

  HWY_INLINE void edge(const LeafColumns& in, std::size_t at) {
    V across_b[vectors];
    V across_n[vectors];
    V along[vectors];
    affine(in, LeafEdge::across_b, at, across_b);
    affine(in, LeafEdge::across_n, at, across_n);
    affine(in, LeafEdge::along, at, along);
    const V half_length = set(in.column(LeafEdge::half_length)[at]);
    const V second_b = set(in.column(LeafEdge::second_b)[at]);
    const V second_n = set(in.column(LeafEdge::second_n)[at]);
    const V first_limit = set(in.column(LeafEdge::first_limit)[at]);
    const V new_id = set(in.column(LeafEdge::id)[at]);
    const V slack = set(plane_slack);
    for (std::size_t k = 0; k < vectors; ++k) {
      // Beyond an end, the distance from the edge is that from the end. The term `beyond` keeps the distance exact also
      // within the slack beyond the ends.
      const V excess = hn::Sub(hn::Abs(along[k]), half_length);
      const V beyond = hn::Max(excess, hn::Zero(d));
      const V across =
          hn::MulAdd(across_b[k], across_b[k], hn::MulAdd(across_n[k], across_n[k], hn::Mul(beyond, beyond)));
      const V second = hn::MulAdd(second_b, across_b[k], hn::MulSub(second_n, across_n[k], slack));
      const V inside = hn::And(hn::And(hn::Sub(excess, slack), hn::Sub(across_b[k], first_limit)), second);
      V new_side = across;
      if constexpr (with_sides) {
        new_side = hn::MulAdd(set(in.column(LeafEdge::side_b)[at]), across_b[k],
                              hn::Mul(set(in.column(LeafEdge::side_n)[at]), across_n[k]));
      }
      offer(k, inside, across, new_id, new_side);
    }
  }

  HWY_INLINE void face(const LeafColumns& in, std::size_t at) {
    V height[vectors];
    V minus_u[vectors];
    V minus_v[vectors];
    affine(in, LeafFace::height, at, height);
    affine(in, LeafFace::minus_u, at, minus_u);
    affine(in, LeafFace::minus_v, at, minus_v);
    const V new_id = set(in.column(LeafFace::id)[at]);
    const V minus_one = set(-1.0F);
    for (std::size_t k = 0; k < vectors; ++k) {
      const V minus_w = hn::Sub(hn::Sub(minus_one, minus_u[k]), minus_v[k]);
      const V inside = hn::And(hn::And(minus_u[k], minus_v[k]), minus_w);
      offer(k, inside, hn::Mul(height[k], height[k]), new_id, height[k]);
    }
  }

 private:
  friend Winners;
  explicit LeafEvaluation(const LatticeNodes& of_pass) : nodes(of_pass) {}
};

/// Closest candidates of one pass found so far, in registers.
template <bool with_sides>
struct LeafPass : LeafEvaluation<LeafPass<with_sides>, with_sides> {
  static constexpr std::size_t vectors = LatticeNodes::vectors;
  V squared[vectors];
  V id[vectors];
  V side[vectors];

  explicit LeafPass(const LatticeNodes& of_pass) : LeafEvaluation<LeafPass<with_sides>, with_sides>(of_pass) {
    for (std::size_t k = 0; k < vectors; ++k) {
      squared[k] = set(hwy::HighestValue<float>());
      id[k] = hn::BitCast(d, hn::Set(di, dead_record));
      side[k] = hn::Zero(d);
    }
  }

  /// Makes a candidate the winner at those nodes where `inside` is negative and the candidate is closer than the winner
  /// so far.
  HWY_INLINE void take(std::size_t k, V inside, V candidate, V candidate_id, V candidate_side) {
    const V wins = hn::And(inside, hn::Sub(candidate, squared[k]));
    squared[k] = if_sign_bit(wins, candidate, squared[k]);
    id[k] = if_sign_bit(wins, candidate_id, id[k]);
    if constexpr (with_sides) side[k] = if_sign_bit(wins, candidate_side, side[k]);
  }
};

template <bool with_sides>
HWY_INLINE void finish_pass(const LeafPass<with_sides>& pass, std::size_t index, LeafState& state) {
  for (std::size_t k = 0; k < pass_vectors; ++k) {
    const std::size_t node = index * pass_nodes + k * lanes;
    hn::Store(pass.squared[k], d, state.squared.data() + node);
    hn::Store(hn::BitCast(di, pass.id[k]), di, state.id.data() + node);
    if constexpr (with_sides) hn::Store(pass.side[k], d, state.side.data() + node);
  }
}

/// Data that a box of 8 x 8 x 8 nodes passes to its leaves. These data are prepared candidates, and bits that mark the
/// candidates of each leaf.
struct LeafInput {
  const std::array<LeafColumns, 3>& columns;
  std::array<ChildBits, kind_count>& bits;
  std::size_t child;
};

/// Returns the number of candidates of the leaf, not counting slivers (faces too flat for float32).
HWY_INLINE std::size_t candidate_count(const LeafInput& input) {
  std::size_t count = 0;
  for (std::size_t kind = 0; kind < sliver_kind; ++kind) {
    const std::uint16_t* words = input.bits[kind].child(input.child);
    for (std::size_t b = 0; b < input.bits[kind].blocks(); ++b) {
      count += static_cast<std::size_t>(std::popcount(words[b]));
    }
  }
  return count;
}

/// Clears the bits of candidates that the leaf's dominators beat.
template <Kind kind>
HWY_INLINE void dominate(const LeafInput& input, const LeafDomination& domination) {
  std::uint16_t* words = input.bits[kind].child(input.child);
  for (std::size_t b = 0; b < input.bits[kind].blocks(); ++b) {
    if (words[b] != 0) words[b] = static_cast<std::uint16_t>(words[b] & domination.keeps<kind>(input.columns[kind], b));
  }
}

/// Calls use(index) for every candidate of a kind, in order.
template <Kind kind, class Use>
HWY_INLINE void for_each_candidate(const LeafInput& input, Use use) {
  const std::uint16_t* words = input.bits[kind].child(input.child);
  for (std::size_t b = 0; b < input.bits[kind].blocks(); ++b) {
    for (std::uint32_t word = words[b]; word != 0; word &= word - 1) {
      use(b * lanes + static_cast<std::size_t>(std::countr_zero(word)));
    }
  }
}

template <bool with_sides>
HWY_NOINLINE void evaluate_leaf(const FieldJob& job, const LeafInput& input, const LeafPattern& pattern,
                                LeafState& state) {
  for (std::size_t index = 0; index < passes; ++index) {
    LeafPass<with_sides> pass(pattern.pass[index]);
    for_each_candidate<vertex_kind>(input, [&](std::size_t i) { pass.vertex(input.columns[0], i, job.vertex_sides); });
    for_each_candidate<edge_kind>(input, [&](std::size_t i) { pass.edge(input.columns[1], i); });
    for_each_candidate<face_kind>(input, [&](std::size_t i) { pass.face(input.columns[2], i); });
    finish_pass(pass, index, state);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();
#endif
