// Blum: the solid as a cellular model with its homotopy type. SPDX-License-Identifier: Apache-2.0
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
  /// Side of a cube, > 0, mesh units; instead of `resolution`.
  std::optional<double> spacing = {};
  /// How far the grid is moved along each axis, 0 to 1 cube. Where a place fails, another choice may pass.
  double shift = 0.381966;
  /// How often a cube that fails is split, 0 to 200.
  int most_splits = 60;
};

template <>
struct Description<CellularModelOptions> {
  static constexpr std::string_view name = "CellularModelOptions";
  static constexpr std::string_view doc = "How fine a cellular model is";
  static constexpr std::tuple members{
      Member{"resolution", &CellularModelOptions::resolution, "",
             "cubes along the longest side of the box around the solid", Range::between(1, 800)},
      Member{"spacing", &CellularModelOptions::spacing, "mesh units", "side of a cube, instead of the resolution",
             Range::positive()},
      Member{"shift", &CellularModelOptions::shift, "cubes",
             "how far the grid is moved along each axis: where a place fails, another choice may pass",
             Range::between(0, 1)},
      Member{"most_splits", &CellularModelOptions::most_splits, "", "how often a cube that fails is split",
             Range::between(0, 200)},
  };
};

/// What keeps a cell from passing.
enum class ModelObstacle : std::uint8_t {
  hole_in_square,  ///< the solid has a hole within a side of the box: an empty needle, say, that no split opens
  slanted_needle,  ///< the same where it runs at a slant, and thousands of splits would not open it
  handle,          ///< a component in the box has a tunnel, or an inner boundary
  void_in_cube     ///< a void lies wholly inside of the box
};

template <>
struct Description<ModelObstacle> {
  static constexpr std::string_view name = "ModelObstacle";
  static constexpr std::array values{NamedValue{ModelObstacle::hole_in_square, "hole in square"},
                                     NamedValue{ModelObstacle::slanted_needle, "slanted needle"},
                                     NamedValue{ModelObstacle::handle, "handle"},
                                     NamedValue{ModelObstacle::void_in_cube, "void in cube"}};
};

/// A box in which a component of the solid is not contractible, and that could not be split further.
struct ModelFailure {
  Vec3d low{};   ///< corner, mesh units
  Vec3d high{};  ///< the corner opposite
  ModelObstacle obstacle = ModelObstacle::handle;
  double cuts = 0;  ///< slanted_needle: splits that it takes to open it in this box; with cubes half as large, half

  /// A split opens a hole where this stays in its plane: as far as it is wide, over how much it slants. Where it takes
  /// more of them than this in one box, they are not begun.
  static constexpr double most_cuts = 8192;
};

template <>
struct Description<ModelFailure> {
  static constexpr std::string_view name = "ModelFailure";
  static constexpr std::string_view doc = "A box in which a component of a solid is not contractible";
  static constexpr std::tuple members{
      Member{"low", &ModelFailure::low, "mesh units", "corner of the box"},
      Member{"high", &ModelFailure::high, "mesh units", "the corner opposite"},
      Member{"obstacle", &ModelFailure::obstacle, "", "what keeps it from passing"},
      Member{"cuts", &ModelFailure::cuts, "", "slanted needle: splits that it takes to open it in this box"},
  };
};

struct CellularModelReport {
  bool passes = false;  ///< whether every component in a cell is contractible: then the model has the homotopy type
  GridSpec grid;        ///< the corners of the cubes
  std::size_t cut_cubes = 0;            ///< cubes that the surface meets
  std::size_t failing_cubes = 0;        ///< of these, cubes that had to be split
  std::size_t boxes = 0;                ///< that these were split into
  int splits = 0;                       ///< largest number of splits that a box comes from
  std::array<std::int64_t, 4> cells{};  ///< vertices, edges, polygons, polyhedra of the model
  std::int64_t euler = 0;               ///< alternating sum of these: components less tunnels plus voids
  std::vector<ModelFailure> failures;   ///< places that do not pass
  std::vector<PhaseTime> phases;        ///< seconds
};

template <>
struct Description<CellularModelReport> {
  static constexpr std::string_view name = "CellularModelReport";
  static constexpr std::string_view doc = "What a cellular model consists of, and whether it passes";
  static constexpr std::tuple members{
      Member{"passes", &CellularModelReport::passes, "",
             "whether every component in a cell is contractible, so that the model has the solid's homotopy type"},
      Member{"grid", &CellularModelReport::grid, "", "the corners of the cubes"},
      Member{"cut_cubes", &CellularModelReport::cut_cubes, "", "cubes that the surface meets"},
      Member{"failing_cubes", &CellularModelReport::failing_cubes, "", "of these, cubes that had to be split"},
      Member{"boxes", &CellularModelReport::boxes, "", "that these were split into"},
      Member{"splits", &CellularModelReport::splits, "", "largest number of splits that a box comes from"},
      Member{"cells", &CellularModelReport::cells, "", "vertices, edges, polygons, polyhedra of the model"},
      Member{"euler", &CellularModelReport::euler, "", "their alternating sum: components less tunnels plus voids"},
      Member{"failures", &CellularModelReport::failures, "", "places that do not pass"},
      Member{"seconds", &CellularModelReport::phases, "s", "wall-clock, of each phase"},
  };
};

/// A regular cell complex with the homotopy type of a polyhedron, at any resolution.
///
/// The solid is cut by a grid of cubes. Each connected component of the solid in a cube is a vertex of the model, each
/// in a square between cubes an edge, each interval of a grid edge inside the solid a polygon, and each grid node
/// inside a polyhedron. Where all components are contractible, which exact local tests decide, the model is homotopy
/// equivalent to the solid; cubes where they are not are split until they are. Walls, gaps and tunnels may be thinner
/// than a cube. The theorem and its proof: docs/theory/solid.md.
class CellularModel {
 public:
  [[nodiscard]] const CellularModelReport& report() const;

  /// The model, collapsed as far as removing free cells from outside goes: vertices, edges and triangles with the same
  /// homotopy type, their corners in the solid. Mesh units. @throws Cancelled; OutOfMemory.
  /// Cost: near-linear in the cells; about 0.3 us and 100 bytes for each.
  [[nodiscard]] Complex complex(const Context& context = {}) const;

  /// Components, tunnels and voids of the model, by the homology of complex(). @throws and cost as that.
  [[nodiscard]] BettiNumbers betti(const Context& context = {}) const;

 private:
  friend class Solid;
  struct Data;
  explicit CellularModel(std::shared_ptr<const Data> data);
  /// Of Solid::model().
  /// @param groups  of the bodies: those of one do not touch each other.
  static CellularModel of(const Solid& solid, const std::vector<std::uint32_t>& groups,
                          const CellularModelOptions& options, const Context& context);
  std::shared_ptr<const Data> data_;
};

}  // namespace blum
