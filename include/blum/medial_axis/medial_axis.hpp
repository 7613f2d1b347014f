// Blum: medial axes with the topology of the solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/medial_axis/medial_complex.hpp"
#include "blum/medial_axis/nested_complex.hpp"

namespace blum {

/// Components, tunnels and voids.
using BettiNumbers = std::array<std::int64_t, 3>;

struct MedialAxisOptions {
  /// Meshes: voxels along the longest side of the box around the mesh, 8 to 800.
  int resolution = 256;
  /// Meshes: side of a voxel, > 0, mesh units; instead of `resolution`.
  std::optional<double> spacing = {};
  /// Meshes: a body whose topology its voxels cannot take is done again with voxels of half the side, as long as at
  /// most this many lie along its own longest side. Less than `resolution` says: never.
  int max_resolution = 512;
  /// Pieces of the axis whose two footprints are closer than this count for nothing (the lambda-medial axis of Chazal
  /// and Lieutier 2005), >= 0, mesh units.
  double lambda = 0;
  /// The smallest theta that will be asked for, 0 to 180 degrees: what is seen at less is not looked at closely, which
  /// saves time where much is. What joins the rest may then run elsewhere.
  double least_theta = 0;
  /// Images: which voxels are the solid.
  LabelSelection selection = {};
};

/// What a solid is, and so what a certificate is worth.
enum class SolidRule : std::uint8_t {
  polyhedron,  ///< what the closed shells of a mesh bound: tunnels and voids are known exactly
  winding,     ///< the voxels whose centre has a winding number above 1/2: the mesh is open, crosses itself or is not
               ///< manifold, and only the topology of these voxels is kept
  voxels       ///< the union of the selected, closed voxels of an image
};
[[nodiscard]] std::string_view to_string(SolidRule rule);

/// How one body (a connected part of the solid) was voxelised.
struct BodyReport {
  BettiNumbers solid{};   ///< of the body
  BettiNumbers voxels{};  ///< of the voxels that stand for it
  bool is_right = false;  ///< whether they are equal
  double spacing = 0;     ///< smallest side of a voxel, mesh units
  std::size_t voxel_count = 0;
  std::size_t left_out = 0;  ///< voxels whose centre is inside, but that are left out
  std::size_t taken_in = 0;  ///< voxels whose centre is outside, but that are taken in
  double deviation = 0;      ///< how far from the surface the centre of such a voxel lies at most, mesh units
};

struct MedialAxisReport {
  SolidRule rule = SolidRule::polyhedron;
  std::string reason;             ///< one sentence: why this rule
  std::size_t turned_shells = 0;  ///< shells that faced the solid and were turned
  BettiNumbers solid{};           ///< of the whole solid: the sum of the bodies'
  BettiNumbers voxels{};          ///< the axis has these, at every theta
  bool is_right = false;          ///< whether they are equal
  GridSpec grid;                  ///< voxel centres: of the first body, or of the image
  std::vector<BodyReport> bodies;
  std::vector<PhaseTime> phases;  ///< seconds
};

/// The medial axis of a solid for all angles theta at once: a complex of squares, edges and vertices that the solid's
/// voxels collapse to, and the order in which it collapses further.
class MedialAxis {
 public:
  MedialAxis(MedialAxis&&) noexcept;
  MedialAxis& operator=(MedialAxis&&) noexcept;
  ~MedialAxis();

  /// The part where two footprints are seen at more than theta apart, and what homotopy needs to join it: a complex
  /// with the Betti numbers report().voxels. What a larger theta gives is part of what a smaller one gives.
  /// @param theta  degrees, MedialAxisOptions::least_theta to 180.
  /// @throws InvalidOption. Cost: linear in the result.
  [[nodiscard]] MedialComplex extract(double theta) const;

  /// What extract() gives for all angles from MedialAxisOptions::least_theta on, in one complex.
  /// Cost: near-linear in the axis at the least angle.
  [[nodiscard]] NestedComplex nested() const;

  [[nodiscard]] const MedialAxisReport& report() const;

 private:
  friend class MedialAxisBuilder;
  struct Data;
  explicit MedialAxis(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

/// The medial axis of the solid that a mesh bounds.
///
/// Closed, manifold meshes that do not cross themselves are taken as polyhedra, shell by shell: each outer shell and
/// the voids in it are one body, and bodies may touch. Triangles that face another way than their neighbours are
/// turned, and so are shells that face the solid. For other meshes the solid is where the winding number is above 1/2
/// (SolidRule::winding).
///
/// Vertices lie on the bisector of two parts of the surface where there are two, within 0.7 voxels of a corner of the
/// voxel lattice; their radius is the exact distance to the surface (1e-9 of the extent).
///
/// @param mesh  must pass validate(mesh); segments and points are ignored.
/// @return      report().is_right says whether the axis has the topology of the solid: look at it. Sites are those of
///              SiteTable(mesh). The same bytes for any number of threads.
/// @throws InvalidMesh (also for a mesh without triangles, or without any interior), InvalidOption, OutOfMemory,
/// Cancelled.
/// Cost: near-linear in the voxels of the solid; about 10 bytes for each voxel of the box.
/// Method: docs/theory/medial-axis.md (Sud 2006, ch. 5; Liu, Chambers, Letscher, Ju 2010; Chaussard, Couprie 2009).
[[nodiscard]] MedialAxis medial_axis(const MeshView& mesh, const MedialAxisOptions& options = {},
                                     const Context& context = {});

/// The medial axis of the selected voxels of an image: of the union of these closed voxels (components that touch in a
/// corner are one). Distances are to the faces of the voxels; sites are voxels that are not selected, or that lie just
/// outside of the image, where the id is that of the image's voxel next to them.
/// @throws InvalidImage (also when no voxel is selected), InvalidOption, OutOfMemory, Cancelled.
[[nodiscard]] MedialAxis medial_axis(const VoxelImageView& image, const MedialAxisOptions& options = {},
                                     const Context& context = {});

}  // namespace blum
