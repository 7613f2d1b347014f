// Blum: vertices that are taken out of sheets and chains, one after the other. SPDX-License-Identifier: Apache-2.0
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

/// A point of an axis with its radius.
struct AxisPoint {
  Vec3d position;
  double radius = 0;
};

/// Triangles (centre, ring[k], ring[k + 1]) of one sheet around a vertex.
struct Fan {
  std::vector<std::uint32_t> ring;       ///< vertices; of a closed fan, the first one follows the last one
  std::vector<std::uint32_t> triangles;  ///< between ring[k] and ring[k + 1]
  bool is_closed = false;
};

/// How far a sheet or a chain moves, upper bounds.
struct Deviation {
  /// Between what was and what is, either way; and how far radii that are interpolated linearly change.
  double by = 0;
  /// From what is to what was: 0 where only a tip of a sheet goes.
  double beyond = 0;
};

/// How far a sheet moves when the centre of a fan goes to its first ring vertex, so that the other ring vertices are
/// joined to that one. nullopt where triangles would fold over, or turn by much.
/// @param ring  as Fan has it, beginning with the vertex that the centre goes to.
[[nodiscard]] std::optional<Deviation> deviation(const AxisPoint& centre, std::span<const AxisPoint> ring,
                                                 bool is_closed);

/// The same of a point of a chain, which goes: the segment between its neighbours is left.
[[nodiscard]] Deviation deviation(const AxisPoint& point, const AxisPoint& a, const AxisPoint& b);

/// Sheets, and what bounds them, as SheetDecimator takes them.
struct DecimatorInput {
  std::vector<AxisPoint> points{};  ///< of the vertices
  std::span<const std::array<std::uint32_t, 3>> triangles{};
  std::vector<float> triangle_angle{};                  ///< degrees
  std::vector<std::array<std::uint32_t, 2>> borders{};  ///< edges that bound sheets, or lie on none
  std::vector<int> border_kind{};                       ///< only chains of borders of one kind are shortened
  std::vector<std::uint8_t> stays{};                    ///< vertices that are kept; empty for none
};

/// Takes vertices out where sheets and borders stay within a tolerance: see decimate().
class SheetDecimator {
 public:
  /// @param tolerance  mesh units.
  SheetDecimator(DecimatorInput input, double tolerance, const Context& context);

  /// Takes out what moves sheets by less than these parts of the tolerance, one level after the other.
  /// @throws Cancelled.
  void run(std::span<const double> levels);

  /// What is left.
  [[nodiscard]] const ShrinkingComplex& cells() const { return cells_; }
  /// Of each triangle at first: its angle, or a larger one of what went beside it.
  [[nodiscard]] std::span<const float> triangle_angle() const { return input_.triangle_angle; }
  /// How far anything is from where it was at first, at most, mesh units.
  [[nodiscard]] double moved() const { return moved_; }

 private:
  static constexpr std::uint32_t none = 0xffffffffU;

  struct Candidate {
    std::uint32_t to = none;
    double moved = 0;
    double along = 0;  ///< how far the border through the vertex would be from where it was at first
  };
  struct Side {
    std::uint32_t triangle;
    std::array<std::uint32_t, 2> ends;
    Side(std::uint32_t t, std::uint32_t p, std::uint32_t q) : triangle(t), ends{p, q} {}
  };
  /// What is around a vertex that is looked at. Kept, so that no new memory is needed each time.
  struct Look {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> chain;  ///< borders, and their other ends
    std::vector<Side> sides;                                     ///< triangles that no fan has yet
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
  std::vector<double> of_triangle_, of_edge_;  ///< how far they may be from where they were at first
  std::vector<std::uint8_t> is_waiting_;       ///< something around it changed since it was looked at
  std::vector<std::size_t> touched_at_;        ///< taken_ when something around it went last
  std::size_t taken_ = 0;                      ///< vertices
  double moved_ = 0;
  std::vector<std::uint32_t> batch_;
  std::vector<Look> looks_;  ///< of these
};

}  // namespace blum::detail
