// Blum: cellular models with the homotopy type of a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/betti_numbers.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/core/vec3.hpp"
#include "blum/grid/grid_spec.hpp"

namespace blum {

class Solid;

struct CellularModelOptions {
  /// Cubes along the longest side of the box around the solid, 1 to 800.
  int resolution = 64;
  /// Side of a cube, > 0, mesh units. Replaces `resolution`.
  std::optional<double> spacing = {};
  /// Shift of the grid along each axis, 0 to 1 cube. If a place fails, another shift may pass.
  double shift = 0.381966;
  /// Largest number of splits of a failing cube, 0 to 200.
  int most_splits = 60;
};

template <>
struct Description<CellularModelOptions> {
  static constexpr std::string_view name = "CellularModelOptions";
  static constexpr std::string_view doc = "Resolution of a cellular model";
  static constexpr std::tuple members{
      Member{"resolution", &CellularModelOptions::resolution, "",
             "cubes along the longest side of the box around the solid", Range::between(1, 800)},
      Member{"spacing", &CellularModelOptions::spacing, "mesh units", "side of a cube, instead of the resolution",
             Range::positive()},
      Member{"shift", &CellularModelOptions::shift, "cubes",
             "shift of the grid along each axis: if a place fails, another shift may pass", Range::between(0, 1)},
      Member{"most_splits", &CellularModelOptions::most_splits, "", "largest number of splits of a cube that fails",
             Range::between(0, 200)},
  };
};

/// Reason why a cell does not pass.
enum class ModelObstacle : std::uint8_t {
  hole_in_square,  ///< The solid has a hole within a side of the box, for example an empty needle that no split opens.
  slanted_needle,  ///< Such a hole is slanted, and thousands of splits would not open it.
  handle,          ///< A component in the box has a tunnel, or an inner boundary.
  void_in_cube     ///< A void lies wholly inside the box.
};

template <>
struct Description<ModelObstacle> {
  static constexpr std::string_view name = "ModelObstacle";
  static constexpr std::array values{NamedValue{ModelObstacle::hole_in_square, "hole in square"},
                                     NamedValue{ModelObstacle::slanted_needle, "slanted needle"},
                                     NamedValue{ModelObstacle::handle, "handle"},
                                     NamedValue{ModelObstacle::void_in_cube, "void in cube"}};
};

/// Box in which a component of the solid is not contractible, and that could not be split further.
struct ModelFailure {
  Vec3d low{};   ///< Corner, mesh units.
  Vec3d high{};  ///< Opposite corner.
  ModelObstacle obstacle = ModelObstacle::handle;
  double cuts = 0;  ///< For `slanted_needle`: splits to open it in this box; half as many at half the size.

  /// A split opens a hole over the length for which the hole stays in its plane: its width divided by its slant. If one
  /// box needs more splits than this, none is made.
  static constexpr double most_cuts = 8192;
};

template <>
struct Description<ModelFailure> {
  static constexpr std::string_view name = "ModelFailure";
  static constexpr std::string_view doc = "Box in which a component of a solid is not contractible";
  static constexpr std::tuple members{
      Member{"low", &ModelFailure::low, "mesh units", "corner of the box"},
      Member{"high", &ModelFailure::high, "mesh units", "opposite corner"},
      Member{"obstacle", &ModelFailure::obstacle, "", "reason why it does not pass"},
      Member{"cuts", &ModelFailure::cuts, "", "slanted needle: splits that open it in this box"},
  };
};

struct CellularModelReport {
  bool passes = false;        ///< True if every component in a cell is contractible, which proves the homotopy type.
  GridSpec grid;              ///< Corners of the cubes.
  std::size_t cut_cubes = 0;  ///< Cubes that the surface meets.
  std::size_t failing_cubes = 0;        ///< Cubes of these that had to be split.
  std::size_t boxes = 0;                ///< Boxes into which these were split.
  int splits = 0;                       ///< Largest number of splits that led to a box.
  std::array<std::int64_t, 4> cells{};  ///< Vertices, edges, polygons and polyhedra of the model.
  std::int64_t euler = 0;               ///< Their alternating sum: components less tunnels plus voids.
  std::vector<ModelFailure> failures;   ///< Places that do not pass.
  std::vector<PhaseTime> phases;        ///< Seconds.
};

template <>
struct Description<CellularModelReport> {
  static constexpr std::string_view name = "CellularModelReport";
  static constexpr std::string_view doc = "Counts of a cellular model, and the result of its check";
  static constexpr std::tuple members{
      Member{"passes", &CellularModelReport::passes, "",
             "whether every component in a cell is contractible, so that the model has the solid's homotopy type"},
      Member{"grid", &CellularModelReport::grid, "", "corners of the cubes"},
      Member{"cut_cubes", &CellularModelReport::cut_cubes, "", "cubes that the surface meets"},
      Member{"failing_cubes", &CellularModelReport::failing_cubes, "", "those of these that had to be split"},
      Member{"boxes", &CellularModelReport::boxes, "", "boxes of these cubes after splitting"},
      Member{"splits", &CellularModelReport::splits, "", "largest number of splits of a box"},
      Member{"cells", &CellularModelReport::cells, "", "vertices, edges, polygons, polyhedra of the model"},
      Member{"euler", &CellularModelReport::euler, "", "their alternating sum: components - tunnels + voids"},
      Member{"failures", &CellularModelReport::failures, "", "places that do not pass"},
      Member{"seconds", &CellularModelReport::phases, "s", "wall-clock time of each phase"},
  };
};

/// Regular cell complex with the homotopy type of a polyhedron, at any resolution.
///
/// A grid of cubes cuts the solid. The model has a vertex for each connected component of the solid in a cube, and an
/// edge for each in a square between cubes. It has a polygon for each interval of a grid edge inside the solid, and a
/// polyhedron for each grid node inside. If all components are contractible, the model is homotopy equivalent to the
/// solid. Exact local tests decide this, and cubes that fail are split until they pass. Walls, gaps and tunnels may be
/// thinner than a cube. Theorem and proof: docs/theory/solid.md.
class CellularModel {
 public:
  [[nodiscard]] const CellularModelReport& report() const;

  /// Returns the model after collapses from outside, as far as free cells exist. The result has vertices, edges and
  /// triangles with the same homotopy type, and their corners lie in the solid. Mesh units.
  /// @throws Cancelled; OutOfMemory.
  /// Cost: near-linear in the cells; about 0.3 us and 100 bytes each.
  [[nodiscard]] Complex complex(const Context& context = {}) const;

  /// Returns the components, tunnels and voids of the model, from the homology of complex().
  /// @throws as complex().
  /// Cost: that of complex().
  [[nodiscard]] BettiNumbers betti(const Context& context = {}) const;

 private:
  friend class Solid;
  struct Data;
  explicit CellularModel(std::shared_ptr<const Data> data);
  /// Computes Solid::model().
  /// @param groups  group of each body. Bodies of one group do not touch each other.
  static CellularModel of(const Solid& solid, const std::vector<std::uint32_t>& groups,
                          const CellularModelOptions& options, const Context& context);
  std::shared_ptr<const Data> data_;
};

}  // namespace blum
