// Blum: certificates of many axes of one solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "blum/certificate/certificate.hpp"
#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum {

/// Certifies many axes of one solid, and reads the solid only once. The verifier stores the shells, crossings, Betti
/// numbers and search trees of the solid. The verifier also stores the balls from random points that reveal missing
/// parts of an axis (MedialCheck). Data of the solid are computed when an axis first needs them. The certificates equal
/// those of certify() and certify_topology(), byte for byte. The order of the axes does not change a certificate.
///
/// Many threads may use one verifier at the same time. If several threads need the same data, one thread computes them
/// and the others wait.
/// Memory: about 400 bytes per triangle of the mesh, or per block of 4 x 4 x 4 voxels at the boundary. The verifier
/// also needs up to 30 MB for other data.
class AxisVerifier {
 public:
  /// Constructs a verifier for the solid of a mesh.
  /// @param mesh  its vertices and triangles must stay unchanged while the verifier exists.
  /// @throws InvalidMesh if validate() rejects the mesh.
  explicit AxisVerifier(const MeshView& mesh);

  /// Constructs a verifier for the closed union of voxels. The verifier owns the voxels.
  /// @param grid  grid whose nodes are the centres of the voxels.
  /// @param surface  mesh whose solid the voxels represent; nullptr for an image. The mesh must stay unchanged while
  /// the verifier exists.
  /// @throws InvalidGrid; InvalidMesh; InvalidOption if the sizes of the grid and the voxels differ, or no voxel
  /// exists.
  AxisVerifier(VoxelSet voxels, const GridSpec& grid, const MeshView* surface);

  AxisVerifier(AxisVerifier&&) noexcept;
  AxisVerifier& operator=(AxisVerifier&&) noexcept;
  ~AxisVerifier();

  /// Returns the rule of the solid. For a mesh, the result equals solid_rule(mesh); certify() throws if the rule is not
  /// SolidRule::polyhedron. For voxels, the arguments of the constructor decide the rule, and the reason is empty.
  /// @throws Cancelled.
  [[nodiscard]] MeshSolidRule rule(const Context& context = {}) const;

  /// Certifies an axis against the solid; see certify().
  /// @throws as certify() of a mesh or of voxels.
  [[nodiscard]] Certificate certify(const Complex& axis, const CertificateOptions& options = {},
                                    const Context& context = {}) const;

  /// Certifies the topology of a complex against the solid; see certify_topology().
  /// @throws as certify_topology() of a mesh or of voxels.
  [[nodiscard]] Certificate certify_topology(const Complex& complex, const Context& context = {}) const;

 private:
  class Reading;
  class MeshReading;
  class VoxelReading;
  std::unique_ptr<const Reading> reading_;
};

}  // namespace blum
