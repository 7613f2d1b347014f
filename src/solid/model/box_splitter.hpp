// Blum: splitting a cube until all components in its parts are balls. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/solid/cellular_model.hpp"
#include "solid/model/box_cells.hpp"
#include "solid/model/box_surface.hpp"
#include "solid/model/components.hpp"
#include "solid/model/surface_mesh.hpp"

namespace blum::detail {

/// A box, and data about the surface in it.
struct SplitBox {
  BoxCell box;
  std::vector<std::uint32_t> triangles;        ///< all triangles that meet the box, and perhaps others
  std::uint8_t inside = 0;                     ///< bit k is set if corner k of corner_of() is inside the solid
  int splits = 0;                              ///< number of cuts between the cube and this box
  std::optional<ModelObstacle> obstacle = {};  ///< set if the box fails and cannot be split further
  double cuts_left = 0;                        ///< for ModelObstacle::slanted_needle: cuts needed to open the hole
};

/// Splits boxes that fail. A box passes if no component of the solid in its six faces has a hole, and spheres bound all
/// components in the box. If a box passes, components in each rectangle that it shares with a neighbouring box have no
/// hole, either. The box also passes if its faces are divided into these rectangles.
class BoxSplitter {
 public:
  /// @param finer  boxes that pass are also split if they are too large for these boxes: see body_cells(). Must stay
  ///               valid.
  BoxSplitter(const SurfaceMesh& mesh, double spacing, int most_splits, std::span<const Box3> finer)
      : mesh_(mesh), spacing_(spacing), most_splits_(most_splits), finer_(finer) {}

  /// Returns the boxes into which a box is split. Each of them passes or has an obstacle. Stops early if the caller
  /// cancels.
  /// @param most_boxes  limit on the number of boxes.
  [[nodiscard]] std::vector<SplitBox> split(SplitBox box, std::size_t most_boxes, const Context& context);

 private:
  /// A cut of a box.
  struct Cut {
    std::size_t axis = 0;
    double at = 0;
    ModelObstacle obstacle = ModelObstacle::handle;
    double along_hole = 0;  ///< number of cuts needed to open the hole; 0 without a hole
  };
  /// A hole of a face.
  struct Hole {
    Vec3d middle;
    double cuts = 0;  ///< number of cuts needed to open the hole: its shift across the box divided by its width
  };
  /// An edge of the box, also called side. The intervals of a side are its parts inside the solid.
  struct Side {
    std::size_t axis = 0;
    std::size_t corner = 0;  ///< index of the edge's lower end
    std::vector<std::uint32_t> crossings;
    std::uint32_t intervals = 0;
  };

  [[nodiscard]] std::optional<Cut> test(SplitBox& box);
  /// Returns a cut of a box that passes, if the box is too large for a box of `finer`.
  [[nodiscard]] std::optional<Cut> further_cut(const SplitBox& box) const;
  void find_crossings(const SplitBox& box);
  void find_passes(const SplitBox& box);
  /// Finds the components of the solid in a face.
  /// @return  the first hole that was found in the face.
  [[nodiscard]] std::optional<Hole> connect_face(const SplitBox& box, std::size_t face);
  /// Returns the position and slant of a hole in a face.
  /// @param edges  edges of the mesh that pass through the border of the hole.
  [[nodiscard]] Hole hole_between(const SplitBox& box, std::size_t face, std::span<const std::uint32_t> edges) const;
  void connect_edges(const SplitBox& box);
  [[nodiscard]] Cut cut_beside(const SplitBox& box, std::size_t face, const Hole& hole) const;
  [[nodiscard]] Cut cut_through_middle(const SplitBox& box, ModelObstacle obstacle) const;
  [[nodiscard]] bool can_cut(const SplitBox& box, const Cut& cut) const;
  [[nodiscard]] std::array<SplitBox, 2> halves(SplitBox&& box, const Cut& cut) const;

  const SurfaceMesh& mesh_;
  double spacing_;
  int most_splits_;
  std::span<const Box3> finer_;
  std::array<Side, 12> sides_;
  std::vector<std::uint32_t> edges_;                             ///< of the mesh, ascending
  std::vector<std::uint8_t> passes_;                             ///< by edge; bit f: set if it passes face f
  std::vector<std::uint16_t> crossed_;                           ///< by triangle; bit s: set if it crosses side s
  std::vector<std::array<std::uint8_t, 3>> passes_of_triangle_;  ///< by triangle: passes_ of its edges
  // Data of the current face:
  std::vector<std::uint32_t> triangles_;                     ///< triangles with an arc in the face
  std::vector<std::array<std::uint32_t, 2>> ends_of_loops_;  ///< for each arc: the mesh edges that contain its ends
  std::vector<std::uint32_t> loop_edges_;
  std::array<std::uint32_t, 7> first_part_{};
  std::array<std::vector<std::uint32_t>, 6> interval_part_;
  std::vector<BoxPieces::ArcPart> arcs_;
  std::vector<std::uint32_t> passing_;
  SquareComponents square_;
  CubeComponents cube_;
  BoxPieces pieces_;
};

}  // namespace blum::detail
