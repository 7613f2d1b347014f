// Blum: verification of medial axes and the claims of their files. SPDX-License-Identifier: Apache-2.0
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

/// Claims of a file, or of its author, about an axis. Each member `has_...` is true if the file contains these data.
struct MedialClaims {
  MedialMetadata metadata;
  bool has_radii = true;
  bool has_footprints = true;
  bool has_sites = true;
  bool has_angles = true;
  bool has_labels = true;
};

/// Error if a mesh does not bound a polyhedron, and the file of the axis does not give a grid. The solid of such a mesh
/// consists of voxels, and their grid is unknown.
class UnknownVoxels : public InvalidMesh {
 public:
  explicit UnknownVoxels(const std::string& reason)
      : InvalidMesh("the mesh bounds no polyhedron (" + reason +
                    "), so its axis is that of voxels: give the grid of their centres"),
        reason_(reason) {}
  /// Returns one sentence with the reason why the mesh does not bound a polyhedron.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// Returns one sentence for each false claim. A claim is false if the rule in the file differs from `found`. A claim is
/// false if the sides of voxels in the file differ from those of the image. For the voxels of a mesh, the spacing in
/// the file must equal the steps of the grid in the file. If a file states that Blum wrote it, it must contain all data
/// that Blum always writes, and sites of the solid's kind.
/// @param found  actual rule of the solid.
/// @param image_grid  grid of the voxels' centres for an image, else nullptr.
[[nodiscard]] std::vector<std::string> false_claims(const MedialClaims& claims, SolidRule found,
                                                    const GridSpec* image_grid);

/// Certifies axes of a mesh, and checks the claims of their files. The verifier reads the mesh only once
/// (AxisVerifier). If the mesh does not bound a polyhedron, its solid consists of voxels. The voxels are computed once
/// for consecutive axes with the same grid. Many threads may use one object at the same time.
class MeshAxisVerifier {
 public:
  /// @param mesh  must stay unchanged while the verifier exists.
  /// @throws InvalidMesh if validate() rejects the mesh.
  explicit MeshAxisVerifier(const MeshView& mesh);
  MeshAxisVerifier(const MeshAxisVerifier&) = delete;
  MeshAxisVerifier& operator=(const MeshAxisVerifier&) = delete;

  /// Certifies an axis against the solid of the mesh (AxisVerifier::certify()), and adds false claims to the
  /// mismatches.
  ///
  /// The solid is the polyhedron that the mesh bounds. If the mesh does not bound a polyhedron (solid_rule()), the
  /// solid consists of the voxels inside the mesh, on the grid in the claims. Data that the file lacks are not checked.
  /// Sites are not checked if they belong to a solid of another kind. If Blum wrote the file, no vertex may lack a
  /// site.
  /// @param available_memory  bytes; a grid that needs more is rejected.
  /// @throws UnknownVoxels if a grid is needed and the claims contain none. InvalidGrid if the grid has fewer than 8
  /// steps along the longest side of the mesh. InvalidMesh if no voxel of the grid lies inside the mesh. OutOfMemory.
  /// The function also throws the exceptions of certify() and voxels_inside().
  [[nodiscard]] Certificate verify(const Complex& axis, const MedialClaims& claims,
                                   const CertificateOptions& options = {}, double available_memory = 1e300,
                                   const Context& context = {}) const;

  /// Returns the verifier of the polyhedron, for certificates without claims.
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
  mutable std::shared_ptr<const Voxels> voxels_;  ///< Voxels of the last grid that was used.
};

/// Certifies axes of an image, and checks the claims of their files. The solid is the union of the selected, closed
/// voxels. If MedialMetadata::smooth is set in the claims, the smooth surface of these voxels bounds the solid instead.
/// The solid of the last selection is stored for the next axis.
class ImageAxisVerifier {
 public:
  /// @param image  must stay unchanged while the verifier exists.
  explicit ImageAxisVerifier(VoxelImageView image) : image_(std::move(image)) {}
  ImageAxisVerifier(const ImageAxisVerifier&) = delete;
  ImageAxisVerifier& operator=(const ImageAxisVerifier&) = delete;

  /// Certifies an axis against the selected solid, and adds false claims to the mismatches.
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
  mutable std::shared_ptr<const Selected> selected_;  ///< Solid of the last selection.
};

/// Verifies one axis with a MeshAxisVerifier.
/// @throws as MeshAxisVerifier::verify().
[[nodiscard]] Certificate verify(const Complex& axis, const MedialClaims& claims, const MeshView& mesh,
                                 const CertificateOptions& options = {}, double available_memory = 1e300,
                                 const Context& context = {});

/// Verifies one axis with an ImageAxisVerifier.
/// @throws as ImageAxisVerifier::verify().
[[nodiscard]] Certificate verify(const Complex& axis, const MedialClaims& claims, const VoxelImageView& image,
                                 const LabelSelection& selection, const CertificateOptions& options = {},
                                 const Context& context = {});

}  // namespace blum
