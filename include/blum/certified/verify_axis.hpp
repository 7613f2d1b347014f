// Blum: medial axes and what their files claim, checked against their solids. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/certificate/axis_verifier.hpp"
#include "blum/certificate/certificate.hpp"
#include "blum/certified/medial_metadata.hpp"
#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/label_selection.hpp"
#include "blum/grid/voxel_image.hpp"

namespace blum {

/// What a file, or who made it, says of an axis.
struct MedialClaims {
  MedialMetadata metadata;
  bool has_radii = true;
  bool has_footprints = true;
  bool has_sites = true;
  bool has_angles = true;
  bool has_labels = true;
};

/// A mesh bounds no polyhedron, so that the solid of its axis is known by voxels, and the axis's file does not say
/// which.
class UntoldVoxels : public InvalidMesh {
 public:
  explicit UntoldVoxels(const std::string& reason)
      : InvalidMesh("the mesh bounds no polyhedron (" + reason +
                    "), so its axis is that of voxels: give grid, that of their centres"),
        reason_(reason) {}
  /// Why it bounds none, in one sentence.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// What a file says that is not so, one sentence each: its solid has another rule than it says; its voxels are of other
/// sides than the image's, or of a mesh's voxels its grid has other steps than its spacing; it lacks what Blum writes
/// into every file, or has sites of another kind of solid.
/// @param found  what the solid is.  @param image_grid  where it is an image: of the voxels' centres; else nullptr.
[[nodiscard]] std::vector<std::string> false_claims(const MedialClaims& claims, SolidRule found,
                                                    const GridSpec* image_grid);

/// Certifies axes of a mesh with what their files claim. What it reads of the mesh it reads once (AxisVerifier), and
/// the voxels of a mesh that bounds no polyhedron once for axes that name the same grid, one after the other. May be
/// used from many threads at once.
class MeshAxisVerifier {
 public:
  /// @param mesh  must stay as it is while this lives. @throws InvalidMesh for what validate() refuses.
  explicit MeshAxisVerifier(const MeshView& mesh);
  MeshAxisVerifier(const MeshAxisVerifier&) = delete;
  MeshAxisVerifier& operator=(const MeshAxisVerifier&) = delete;

  /// AxisVerifier::certify() against the solid of the mesh, with what is false of the claims among the mismatches: of
  /// the polyhedron, or, where the verifier finds none (solid_rule()), of the voxels inside on the grid that the claims
  /// name. What the file does not have is not checked, nor are sites that it does not have for this kind of solid.
  /// Where Blum wrote it, no vertex may lack a site.
  /// @param available_memory  bytes: a grid that takes more is refused.
  /// @throws UntoldVoxels where the claims name no grid and one is needed; InvalidGrid where that has fewer than 8
  /// steps along the longest side of the mesh; InvalidMesh where no voxel of it lies inside; OutOfMemory; as certify()
  /// and voxels_inside().
  [[nodiscard]] Certificate verify(const Complex& axis, const MedialClaims& claims,
                                   const CertificateOptions& options = {}, double available_memory = 1e300,
                                   const Context& context = {}) const;

  /// That of the polyhedron: certificates without claims.
  [[nodiscard]] const AxisVerifier& polyhedron() const { return polyhedron_; }

 private:
  struct Voxels {
    GridSpec grid;
    AxisVerifier verifier;
  };
  [[nodiscard]] std::shared_ptr<const Voxels> voxels_on(const GridSpec& grid, const std::string& reason,
                                                        double available_memory, const Context& context) const;

  MeshView mesh_;
  AxisVerifier polyhedron_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Voxels> voxels_;  ///< the last ones
};

/// The same for axes of an image: of the union of its selected, closed voxels; or, where the claims say so, of what
/// their smooth surface bounds (MedialMetadata::smooth). The solid of the last selection is kept.
class ImageAxisVerifier {
 public:
  /// @param image  must stay as it is while this lives.
  explicit ImageAxisVerifier(VoxelImageView image) : image_(std::move(image)) {}
  ImageAxisVerifier(const ImageAxisVerifier&) = delete;
  ImageAxisVerifier& operator=(const ImageAxisVerifier&) = delete;

  /// @throws as certify(), selected_voxels() and smooth_surface().
  [[nodiscard]] Certificate verify(const Complex& axis, const MedialClaims& claims, const LabelSelection& selection,
                                   const CertificateOptions& options = {}, const Context& context = {}) const;

 private:
  struct Selected;
  [[nodiscard]] std::shared_ptr<const Selected> selected(const LabelSelection& selection,
                                                         const std::optional<int>& smooth,
                                                         const Context& context) const;

  VoxelImageView image_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Selected> selected_;  ///< the last one
};

/// MeshAxisVerifier for one axis. @throws as MeshAxisVerifier::verify().
[[nodiscard]] Certificate verify(const Complex& axis, const MedialClaims& claims, const MeshView& mesh,
                                 const CertificateOptions& options = {}, double available_memory = 1e300,
                                 const Context& context = {});

/// ImageAxisVerifier for one axis. @throws as ImageAxisVerifier::verify().
[[nodiscard]] Certificate verify(const Complex& axis, const MedialClaims& claims, const VoxelImageView& image,
                                 const LabelSelection& selection, const CertificateOptions& options = {},
                                 const Context& context = {});

}  // namespace blum
