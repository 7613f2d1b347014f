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
  /// Shift of the grid along each axis, in sides of a cube, 0 to 1. If a cube fails the test, another shift may avoid
  /// this.
  double shift = 0.381966;
  /// Largest number of successive splits that lead from a failing cube to a box, 0 to 200.
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
             "shift of the grid along each axis; if a cube fails the test, another may help", Range::between(0, 1)},
      Member{"most_splits", &CellularModelOptions::most_splits, "", "most successive splits of a cube that fails",
             Range::between(0, 200)},
  };
};

/// Reason why a box does not pass the test of CellularModel.
enum class ModelObstacle : std::uint8_t {
  hole_in_square,  ///< The cross-section of the solid with a side of the box has a hole. For example, it is the
                   ///< cross-section of an empty needle that no split opens.
  slanted_needle,  ///< A hole as in `hole_in_square`, but of a slanted needle. Opening the needle would take more than
                   ///< ModelFailure::most_cuts splits.
  handle,          ///< A component of the solid in the box has a tunnel, or an inner boundary.
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

/// Box in which a component of the solid is not contractible. The box could not be split further.
struct ModelFailure {
  Vec3d low{};   ///< Corner, mesh units.
  Vec3d high{};  ///< Opposite corner.
  ModelObstacle obstacle = ModelObstacle::handle;
  double cuts = 0;  ///< For `slanted_needle`: number of splits that would open the needle in this box. A box of half
                    ///< the size needs half this number.

  /// Largest number of splits of a box that are made to open a slanted needle. If more splits are needed, none is made.
  /// Each split opens a part of the needle. The length of this part is the needle's width divided by its slant.
  static constexpr double most_cuts = 8192;
};

template <>
struct Description<ModelFailure> {
  static constexpr std::string_view name = "ModelFailure";
  static constexpr std::string_view doc = "Box in which a component of a solid is not contractible";
  static constexpr std::tuple members{
      Member{"low", &ModelFailure::low, "mesh units", "corner of the box"},
      Member{"high", &ModelFailure::high, "mesh units", "opposite corner"},
      Member{"obstacle", &ModelFailure::obstacle, "", "reason why the component is not contractible"},
      Member{"cuts", &ModelFailure::cuts, "", "slanted needle: number of splits that would open it in this box"},
  };
};

struct CellularModelReport {
  /// True if, in every cube and box, each component of the solid is contractible. This proves the homotopy type.
  bool passes = false;
  GridSpec grid;                        ///< Grid whose nodes are the corners of the cubes.
  std::size_t cut_cubes = 0;            ///< Number of cubes that the surface meets.
  std::size_t failing_cubes = 0;        ///< Number of cubes that had to be split.
  std::size_t boxes = 0;                ///< Number of boxes into which failing cubes were split.
  int splits = 0;                       ///< Largest number of successive splits that led to a box.
  std::array<std::int64_t, 4> cells{};  ///< Numbers of vertices, edges, polygons and polyhedra of the model.
  std::int64_t euler = 0;               ///< Alternating sum of `cells`: components - tunnels + voids.
  std::vector<ModelFailure> failures;   ///< Boxes that do not pass.
  std::vector<PhaseTime> phases;        ///< Seconds.
};

template <>
struct Description<CellularModelReport> {
  static constexpr std::string_view name = "CellularModelReport";
  static constexpr std::string_view doc = "Counts of a cellular model, and the result of its check";
  static constexpr std::tuple members{
      Member{"passes", &CellularModelReport::passes, "",
             "true if every component in a cell is contractible: then the model has the solid's homotopy type"},
      Member{"grid", &CellularModelReport::grid, "", "grid whose nodes are the corners of the cubes"},
      Member{"cut_cubes", &CellularModelReport::cut_cubes, "", "cubes that the surface meets"},
      Member{"failing_cubes", &CellularModelReport::failing_cubes, "", "number of cubes that had to be split"},
      Member{"boxes", &CellularModelReport::boxes, "", "number of boxes from these splits"},
      Member{"splits", &CellularModelReport::splits, "", "largest number of successive splits"},
      Member{"cells", &CellularModelReport::cells, "", "vertices, edges, polygons, polyhedra of the model"},
      Member{"euler", &CellularModelReport::euler, "", "alternating sum of the cells: components - tunnels + voids"},
      Member{"failures", &CellularModelReport::failures, "", "boxes that fail the test"},
      Member{"seconds", &CellularModelReport::phases, "s", "wall-clock time of each phase"},
  };
};

/// Regular cell complex with the homotopy type of a polyhedron, at any resolution.
///
/// A grid of cubes cuts the solid. The model has a vertex for each connected component of the solid in a cube. It has
/// an edge for each connected component in a square between two cubes. It has a polygon for each interval of a grid
/// edge inside the solid, and a polyhedron for each grid node inside. If all components are contractible, the model is
/// homotopy equivalent to the solid. An exact test in each cube decides if the components in it are contractible. A
/// cube that fails the test is split into boxes until every box passes, or until CellularModelOptions::most_splits is
/// reached. Walls, gaps and tunnels may be thinner than a cube. Theorem and proof: docs/theory/solid.md.
class CellularModel {
 public:
  [[nodiscard]] const CellularModelReport& report() const;

  /// Collapses the model from outside until no free cell is left, and returns the result in mesh units. The result
  /// consists of vertices, edges and triangles, and has the homotopy type of the model. All vertices lie in the solid.
  /// @throws Cancelled; OutOfMemory.
  /// Cost: near-linear in the number of cells of the model; about 0.3 us and 100 bytes per cell.
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
  /// @param groups  group number of each body. Bodies of one group do not touch each other.
  static CellularModel of(const Solid& solid, const std::vector<std::uint32_t>& groups,
                          const CellularModelOptions& options, const Context& context);
  std::shared_ptr<const Data> data_;
};

}  // namespace blum
