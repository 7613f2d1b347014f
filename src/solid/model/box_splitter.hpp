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

/// A box, and what is known of the surface in it.
struct SplitBox {
  BoxCell box;
  std::vector<std::uint32_t> triangles;        ///< all that meet it, and perhaps others
  std::uint8_t inside = 0;                     ///< bit k: whether corner k (bits x, y, z: high) is inside the solid
  int splits = 0;                              ///< that it comes from
  std::optional<ModelObstacle> obstacle = {};  ///< why it does not pass, where it cannot be split further
  double cuts_left = 0;                        ///< ModelObstacle::slanted_needle: what it takes to open that
};

/// Splits boxes that fail. A box passes by itself: none of its six sides has a hole, and each component in it is
/// bounded by a sphere. So does every rectangle that it has in common with a box beside it, and the box with sides that
/// are cut into these.
class BoxSplitter {
 public:
  /// @param finer  boxes that pass are split, too, where these are: see body_cells(). It must stay.
  BoxSplitter(const SurfaceMesh& mesh, double spacing, int most_splits, std::span<const Box3> finer)
      : mesh_(mesh), spacing_(spacing), most_splits_(most_splits), finer_(finer) {}

  /// The parts of a box, which pass or name their obstacle. Stops where the caller asks to.
  /// @param most_boxes  that it is split into.
  [[nodiscard]] std::vector<SplitBox> split(SplitBox box, std::size_t most_boxes, const Context& context);

 private:
  /// Where a box is to be cut.
  struct Cut {
    std::size_t axis = 0;
    double at = 0;
    ModelObstacle obstacle = ModelObstacle::handle;
    double along_hole = 0;  ///< how many it takes to open a hole that slants
  };
  /// Of a face.
  struct Hole {
    Vec3d middle;
    double cuts = 0;  ///< that it takes to open it: how often its width goes into how far it slants
  };
  /// An edge of the box.
  struct Side {
    std::size_t axis = 0;
    std::size_t corner = 0;  ///< its lower end
    std::vector<std::uint32_t> crossings;
    std::uint32_t intervals = 0;
  };

  [[nodiscard]] std::optional<Cut> test(SplitBox& box);
  /// A cut of a box that passes, where it shall be finer.
  [[nodiscard]] std::optional<Cut> further_cut(const SplitBox& box) const;
  void find_crossings(const SplitBox& box);
  void find_passes(const SplitBox& box);
  /// Joins what belongs together in a face. @return  the first hole in it.
  [[nodiscard]] std::optional<Hole> connect_face(const SplitBox& box, std::size_t face);
  /// @param edges  of the mesh, that lead through a face around a hole.
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
  std::vector<std::uint32_t> edges_;                             ///< of the mesh, rising
  std::vector<std::uint8_t> passes_;                             ///< bit f: whether an edge passes face f
  std::vector<std::uint16_t> crossed_;                           ///< bit s: whether a triangle crosses side s
  std::vector<std::array<std::uint8_t, 3>> passes_of_triangle_;  ///< passes_ of the edges of each
  // Of the face that is looked at:
  std::vector<std::uint32_t> triangles_;                     ///< with an arc in it
  std::vector<std::array<std::uint32_t, 2>> ends_of_loops_;  ///< edges of the mesh, of arcs with both ends on some
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
