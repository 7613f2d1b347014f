// Blum: removal of vertices from sheets and chains, one after the other. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "blum/axis/shrinking_complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"

namespace blum::detail {

/// Position and radius of a vertex of an axis.
struct AxisPoint {
  Vec3d position;
  double radius = 0;
};

/// Triangles (centre, ring[k], ring[k + 1]) of one sheet around a vertex, the centre.
struct Fan {
  /// Vertices around the centre. In a closed fan, the last vertex is followed by the first.
  std::vector<std::uint32_t> ring;
  std::vector<std::uint32_t> triangles;  ///< Triangle k lies between ring[k] and ring[k + 1].
  bool is_closed = false;
};

/// Upper bounds on how far a sheet or a chain of edges moves.
struct Deviation {
  /// Bound on the distance between the old and the new shape, in both directions, and on the change of linearly
  /// interpolated radii.
  double by = 0;
  /// Bound on the distance of the new shape from the old shape; 0 if only a tip of a sheet is removed.
  double beyond = 0;
};

/// Returns how far a sheet moves when the centre of a fan moves to the first ring vertex. After the move, triangles
/// join the first ring vertex to the other ring vertices. Returns nullopt if triangles would fold over or turn by more
/// than about 75 degrees.
/// @param ring  as Fan::ring, starting with the vertex to which the centre moves.
[[nodiscard]] std::optional<Deviation> deviation(const AxisPoint& centre, std::span<const AxisPoint> ring,
                                                 bool is_closed);

/// Returns how far a chain of edges moves when one of its points is removed, and its neighbours `a` and `b` are joined.
[[nodiscard]] Deviation deviation(const AxisPoint& point, const AxisPoint& a, const AxisPoint& b);

/// Sheets and their borders, as input of SheetDecimator.
struct DecimatorInput {
  std::vector<AxisPoint> points{};  ///< Position and radius of each vertex.
  std::span<const std::array<std::uint32_t, 3>> triangles{};
  std::vector<float> triangle_angle{};                  ///< Separation angle of each triangle, degrees.
  std::vector<std::array<std::uint32_t, 2>> borders{};  ///< Edges that bound sheets, or belong to no sheet.
  /// Kind of each border. A vertex between borders of two kinds stays.
  std::vector<int> border_kind{};
  /// Nonzero for vertices that must stay; empty if there are none.
  std::vector<std::uint8_t> stays{};
};

/// Removes vertices while sheets and borders stay within a tolerance of their original shape; see decimate().
class SheetDecimator {
 public:
  /// @param tolerance  mesh units.
  SheetDecimator(DecimatorInput input, double tolerance, const Context& context);

  /// For each level in turn, removes vertices as long as sheets move by at most this level. Levels are fractions of the
  /// tolerance.
  /// @throws Cancelled.
  void run(std::span<const double> levels);

  /// Returns the remaining cells.
  [[nodiscard]] const ShrinkingComplex& cells() const { return cells_; }
  /// Returns an angle for each triangle of the input: its own angle, or the larger angle of a removed triangle that was
  /// next to it.
  [[nodiscard]] std::span<const float> triangle_angle() const { return input_.triangle_angle; }
  /// Returns an upper bound on how far sheets and borders have moved, mesh units.
  [[nodiscard]] double moved() const { return moved_; }

 private:
  static constexpr std::uint32_t none = 0xffffffffU;

  struct Candidate {
    std::uint32_t to = none;
    double moved = 0;
    double along = 0;  ///< Bound on how far the border through the vertex has moved.
  };
  struct Side {
    std::uint32_t triangle;
    std::array<std::uint32_t, 2> ends;
    Side(std::uint32_t t, std::uint32_t p, std::uint32_t q) : triangle(t), ends{p, q} {}
  };
  /// Surroundings of a vertex that is examined. The object is reused, so that its memory is allocated only once.
  struct Look {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> chain;  ///< Borders at the vertex, each with its other end.
    std::vector<Side> sides;                                     ///< Triangles at the vertex that are not in a fan yet.
    std::vector<Fan> fans;
    std::size_t fan_count = 0;
    std::vector<AxisPoint> ring;
    std::vector<std::pair<double, std::uint32_t>> targets;
    LinkScratch links;
    std::optional<Candidate> candidate;
  };

  [[nodiscard]] const AxisPoint& point(std::uint32_t v) const { return input_.points[v]; }
  [[nodiscard]] bool may_wait(std::uint32_t v) const { return input_.stays.empty() || input_.stays[v] == 0; }
  std::size_t sweep(double limit);
  [[nodiscard]] std::vector<std::uint32_t> waiting_vertices() const;
  void take_batch(double limit);
  void look_at(std::uint32_t v, double limit, Look& look) const;
  bool gather(std::uint32_t v, Look& look) const;
  static bool add_fan(Look& look, std::uint32_t from, std::uint32_t to);
  [[nodiscard]] std::optional<Candidate> best(std::uint32_t v, double limit, Look& look) const;
  [[nodiscard]] std::optional<Candidate> moved_to(std::uint32_t v, std::uint32_t to, double limit, Look& look) const;
  [[nodiscard]] bool is_border(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] std::optional<Deviation> deviation_of(std::uint32_t v, Fan& fan, std::uint32_t to,
                                                      std::vector<AxisPoint>& ring) const;
  void take(std::uint32_t v, const Look& look);
  void touch(std::uint32_t v);
  void pass_angle_on(const Fan& fan);

  DecimatorInput input_;
  double tolerance_;
  const Context& context_;
  ShrinkingComplex cells_;
  std::vector<double> of_triangle_, of_edge_;  ///< Bounds on how far triangles and borders have moved.
  /// Nonzero for vertices that are still to be examined at the current level.
  std::vector<std::uint8_t> is_waiting_;
  std::vector<std::size_t> touched_at_;  ///< Value of `taken_` at the last removal next to the vertex.
  std::size_t taken_ = 0;                ///< Number of removed vertices.
  double moved_ = 0;
  std::vector<std::uint32_t> batch_;
  std::vector<Look> looks_;  ///< One for each vertex of the batch.
};

}  // namespace blum::detail
