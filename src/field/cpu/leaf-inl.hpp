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

/// Node l of a leaf is at (l % 4, l / 4 % 4, l / 16). Four vectors are worked on at a time: `planar` of them differ in
/// x and y only, and that pattern repeats over `slabs` values of z.
constexpr std::size_t leaf_nodes = 64;
constexpr std::size_t pass_vectors = 4;
constexpr std::size_t planar = lanes >= 16 ? 1 : (lanes >= 4 ? 16 / lanes : 4);
constexpr std::size_t slabs = pass_vectors / planar;
constexpr std::size_t pass_nodes = pass_vectors * lanes;
constexpr std::size_t passes = leaf_nodes / pass_nodes;

/// Winners of a leaf so far.
struct LeafState {
  alignas(64) std::array<float, leaf_nodes> squared;
  alignas(64) std::array<std::uint32_t, leaf_nodes> id;
  alignas(
      64) std::array<float, leaf_nodes> side;  ///< affine side function of the winner; only where sides are asked for
};

/// Columns of prepared candidates. Each affine function is its value at the leaf's centre and its gradient.
struct LeafVertex {
  enum { to_site = 0, planes = 3, id = 19, count = 20 };  // c - p; four planes of 4
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

HWY_INLINE void put(LeafColumns& out, int column, std::size_t at, V value, M mask) {
  hn::StoreU(hn::Compress(value, mask), d, out.column(static_cast<std::size_t>(column)) + at);
}
HWY_INLINE void put_affine(LeafColumns& out, int column, std::size_t at, V value, const Vec& gradient, M mask) {
  put(out, column, at, value, mask);
  put(out, column + 1, at, gradient.x, mask);
  put(out, column + 2, at, gradient.y, mask);
  put(out, column + 3, at, gradient.z, mask);
}

HWY_INLINE M valid_lanes(std::size_t first, std::size_t count) {
  const VI index = hn::Add(hn::Set(di, static_cast<std::uint32_t>(first)), hn::Iota(di, 0));
  return hn::RebindMask(d, hn::Lt(index, hn::Set(di, static_cast<std::uint32_t>(count))));
}

/// Moves the candidates that p0 does not beat into leaf columns; returns how many there are.
template <Kind kind>
HWY_INLINE std::size_t prepare(const RecordList& list, const Vec& center, const Dominator& dominator,
                               LeafColumns& out) {
  constexpr int columns_of_kind = kind == vertex_kind ? static_cast<int>(LeafVertex::count)
                                  : kind == edge_kind ? static_cast<int>(LeafEdge::count)
                                                      : static_cast<int>(LeafFace::count);
  out.reset(columns_of_kind, list.count());
  std::size_t kept = 0;
  for (std::size_t first = 0; first < list.count(); first += lanes) {
    Columns columns;
    load_columns(list.data() + first, columns);
    const M valid = valid_lanes(first, list.count());
    M keep;
    if constexpr (kind == vertex_kind) {
      const Vec to_site = center - columns.vec(VertexColumns::position);
      keep = hn::And(valid, dominator.keeps(to_site, dot(to_site, to_site), hn::Zero(d)));
      if (hn::AllFalse(d, keep)) continue;
      put(out, LeafVertex::to_site, kept, to_site.x, keep);
      put(out, LeafVertex::to_site + 1, kept, to_site.y, keep);
      put(out, LeafVertex::to_site + 2, kept, to_site.z, keep);
      for (int plane = 0; plane < 4; ++plane) {
        const Vec e = columns.vec(VertexColumns::direction + 3 * plane);
        put_affine(out, LeafVertex::planes + 4 * plane, kept, hn::Sub(dot(to_site, e), set(plane_slack)), e, keep);
      }
      put(out, LeafVertex::id, kept, columns.column[15], keep);
    } else if constexpr (kind == edge_kind) {
      const Vec to_site = center - columns.vec(EdgeColumns::midpoint);
      const Vec t = columns.vec(EdgeColumns::tangent);
      const Vec b = columns.vec(EdgeColumns::binormal);
      const Vec n = cross(t, b);
      const V across_b = dot(to_site, b);
      const V across_n = dot(to_site, n);
      const Vec to_flat = {hn::MulAdd(across_b, b.x, hn::Mul(across_n, n.x)),
                           hn::MulAdd(across_b, b.y, hn::Mul(across_n, n.y)),
                           hn::MulAdd(across_b, b.z, hn::Mul(across_n, n.z))};
      const V squared = hn::MulAdd(across_b, across_b, square(across_n));
      keep = hn::And(valid, dominator.keeps(to_flat, squared, square(support(t, dominator.reach))));
      if (hn::AllFalse(d, keep)) continue;
      put_affine(out, LeafEdge::across_b, kept, across_b, b, keep);
      put_affine(out, LeafEdge::across_n, kept, across_n, n, keep);
      put_affine(out, LeafEdge::along, kept, dot(to_site, t), t, keep);
      put(out, LeafEdge::half_length, kept, columns.column[EdgeColumns::half_length], keep);
      put(out, LeafEdge::second_b, kept, columns.column[EdgeColumns::second_b], keep);
      put(out, LeafEdge::second_n, kept, columns.column[EdgeColumns::second_n], keep);
      put(out, LeafEdge::first_limit, kept, columns.column[EdgeColumns::first_limit], keep);
      put(out, LeafEdge::side_b, kept, columns.column[EdgeColumns::side_b], keep);
      put(out, LeafEdge::side_n, kept, columns.column[EdgeColumns::side_n], keep);
      put(out, LeafEdge::id, kept, columns.column[15], keep);
    } else {
      const Vec to_site = center - columns.vec(FaceColumns::anchor);
      const Vec n = columns.vec(FaceColumns::normal);
      const V height = dot(to_site, n);
      const Vec to_flat = {hn::Mul(height, n.x), hn::Mul(height, n.y), hn::Mul(height, n.z)};
      keep = hn::And(valid, dominator.keeps(to_flat, square(height), dominator.squared_reach));
      if (hn::AllFalse(d, keep)) continue;
      const Vec u = columns.vec(FaceColumns::minus_u);
      const Vec v = columns.vec(FaceColumns::minus_v);
      put_affine(out, LeafFace::height, kept, height, n, keep);
      put_affine(out, LeafFace::minus_u, kept, dot(to_site, u), u, keep);
      put_affine(out, LeafFace::minus_v, kept, dot(to_site, v), v, keep);
      put(out, LeafFace::id, kept, columns.column[15], keep);
    }
    kept += hn::CountTrue(d, keep);
  }
  return kept;
}

/// Node positions relative to a leaf's centre, for one pass, and the running winners of that pass in registers.
template <bool with_sides>
struct LeafPass {
  V x[planar], y[planar], z[slabs];
  V squared[pass_vectors];
  V id[pass_vectors];
  V side[pass_vectors];

  HWY_INLINE void affine(const LeafColumns& in, int column, std::size_t at, V out[pass_vectors]) const {
    const auto c = static_cast<std::size_t>(column);
    affine(set(in.column(c)[at]), set(in.column(c + 1)[at]), set(in.column(c + 2)[at]), set(in.column(c + 3)[at]), out);
  }
  HWY_INLINE void affine(V base, V gx, V gy, V gz, V out[pass_vectors]) const {
    for (std::size_t p = 0; p < planar; ++p) {
      const V in_plane = hn::MulAdd(gx, x[p], hn::MulAdd(gy, y[p], base));
      for (std::size_t s = 0; s < slabs; ++s) out[s * planar + p] = hn::MulAdd(gz, z[s], in_plane);
    }
  }

  /// Lets a candidate win the nodes where `inside` is negative and it is strictly closer.
  HWY_INLINE void offer(std::size_t k, V inside, V candidate, V candidate_id, V candidate_side) {
    const V wins = hn::And(inside, hn::Sub(candidate, squared[k]));
    squared[k] = hn::IfNegativeThenElse(wins, candidate, squared[k]);
    id[k] = hn::IfNegativeThenElse(wins, candidate_id, id[k]);
    if constexpr (with_sides) side[k] = hn::IfNegativeThenElse(wins, candidate_side, side[k]);
  }

  HWY_INLINE void vertex(const LeafColumns& in, std::size_t at, const std::vector<Vec3f>& vertex_sides) {
    V inside[pass_vectors];
    V value[pass_vectors];
    affine(in, LeafVertex::planes, at, inside);
    for (int plane = 1; plane < 4; ++plane) {
      affine(in, LeafVertex::planes + 4 * plane, at, value);
      for (std::size_t k = 0; k < pass_vectors; ++k) inside[k] = hn::And(inside[k], value[k]);
    }
    const V to_x = set(in.column(LeafVertex::to_site)[at]);
    const V to_y = set(in.column(LeafVertex::to_site + 1)[at]);
    const V to_z = set(in.column(LeafVertex::to_site + 2)[at]);
    if constexpr (with_sides) {
      std::uint32_t vertex_id = 0;
      std::memcpy(&vertex_id, in.column(LeafVertex::id) + at, sizeof(vertex_id));
      const Vec n = set(vertex_sides[vertex_id]);
      affine(dot(Vec{to_x, to_y, to_z}, n), n.x, n.y, n.z, value);
    }
    const V new_id = set(in.column(LeafVertex::id)[at]);
    for (std::size_t p = 0; p < planar; ++p) {
      const V in_plane = hn::MulAdd(hn::Add(to_x, x[p]), hn::Add(to_x, x[p]), square(hn::Add(to_y, y[p])));
      for (std::size_t s = 0; s < slabs; ++s) {
        const V dz = hn::Add(to_z, z[s]);
        const std::size_t k = s * planar + p;
        offer(k, inside[k], hn::MulAdd(dz, dz, in_plane), new_id, value[k]);
      }
    }
  }

  HWY_INLINE void edge(const LeafColumns& in, std::size_t at) {
    V across_b[pass_vectors];
    V across_n[pass_vectors];
    V along[pass_vectors];
    affine(in, LeafEdge::across_b, at, across_b);
    affine(in, LeafEdge::across_n, at, across_n);
    affine(in, LeafEdge::along, at, along);
    const V half_length = set(in.column(LeafEdge::half_length)[at]);
    const V second_b = set(in.column(LeafEdge::second_b)[at]);
    const V second_n = set(in.column(LeafEdge::second_n)[at]);
    const V first_limit = set(in.column(LeafEdge::first_limit)[at]);
    const V new_id = set(in.column(LeafEdge::id)[at]);
    const V slack = set(plane_slack);
    for (std::size_t k = 0; k < pass_vectors; ++k) {
      // Beyond its ends the edge is as far as its end: the excess keeps the distance exact within the slack.
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
    V height[pass_vectors];
    V minus_u[pass_vectors];
    V minus_v[pass_vectors];
    affine(in, LeafFace::height, at, height);
    affine(in, LeafFace::minus_u, at, minus_u);
    affine(in, LeafFace::minus_v, at, minus_v);
    const V new_id = set(in.column(LeafFace::id)[at]);
    const V minus_one = set(-1.0F);
    for (std::size_t k = 0; k < pass_vectors; ++k) {
      const V minus_w = hn::Sub(hn::Sub(minus_one, minus_u[k]), minus_v[k]);
      const V inside = hn::And(hn::And(minus_u[k], minus_v[k]), minus_w);
      offer(k, inside, hn::Mul(height[k], height[k]), new_id, height[k]);
    }
  }
};

/// Node offsets from a leaf's centre along each axis.
struct LeafOffsets {
  std::array<std::array<float, 4>, 3> at{};
};

template <bool with_sides>
HWY_INLINE void start_pass(LeafPass<with_sides>& pass, std::size_t index, const LeafOffsets& offsets) {
  alignas(64) std::array<float, 16> x{};
  alignas(64) std::array<float, 16> y{};
  const std::size_t first = index * pass_nodes;
  for (std::size_t p = 0; p < planar; ++p) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t node = first + p * lanes + lane;
      x[lane] = offsets.at[0][node % 4];
      y[lane] = offsets.at[1][node / 4 % 4];
    }
    pass.x[p] = hn::Load(d, x.data());
    pass.y[p] = hn::Load(d, y.data());
  }
  for (std::size_t s = 0; s < slabs; ++s) pass.z[s] = set(offsets.at[2][(first + s * planar * lanes) / 16]);
  for (std::size_t k = 0; k < pass_vectors; ++k) {
    pass.squared[k] = set(hwy::HighestValue<float>());
    pass.id[k] = hn::BitCast(d, hn::Set(di, dead_record));
    pass.side[k] = hn::Zero(d);
  }
}

template <bool with_sides>
HWY_INLINE void finish_pass(const LeafPass<with_sides>& pass, std::size_t index, LeafState& state) {
  for (std::size_t k = 0; k < pass_vectors; ++k) {
    const std::size_t node = index * pass_nodes + k * lanes;
    hn::Store(pass.squared[k], d, state.squared.data() + node);
    hn::Store(hn::BitCast(di, pass.id[k]), di, state.id.data() + node);
    if constexpr (with_sides) hn::Store(pass.side[k], d, state.side.data() + node);
  }
}

/// What evaluating a leaf reads.
struct LeafInput {
  const Candidates& candidates;
  Vec3f center;
  Vec3f half;
  Vec3f p0;
  LeafOffsets offsets;
};

template <bool with_sides>
HWY_NOINLINE void evaluate_leaf(const FieldJob& job, const LeafInput& input, std::array<LeafColumns, 3>& columns,
                                LeafState& state) {
  const Vec center = set(input.center);
  const Dominator dominator(input.center, input.p0, input.half);
  const std::size_t vertices = prepare<vertex_kind>(input.candidates[vertex_kind], center, dominator, columns[0]);
  const std::size_t edges = prepare<edge_kind>(input.candidates[edge_kind], center, dominator, columns[1]);
  const std::size_t faces = prepare<face_kind>(input.candidates[face_kind], center, dominator, columns[2]);
  for (std::size_t index = 0; index < passes; ++index) {
    LeafPass<with_sides> pass;
    start_pass(pass, index, input.offsets);
    for (std::size_t i = 0; i < vertices; ++i) pass.vertex(columns[0], i, job.vertex_sides);
    for (std::size_t i = 0; i < edges; ++i) pass.edge(columns[1], i);
    for (std::size_t i = 0; i < faces; ++i) pass.face(columns[2], i);
    finish_pass(pass, index, state);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace blum::cpu
HWY_AFTER_NAMESPACE();
#endif
