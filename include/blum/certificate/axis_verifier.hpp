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

/// Certifies axes of one solid, which it reads once: its shells, crossings, Betti numbers, searches, and the balls from
/// random points that show what an axis misses. Each is made when the first axis asks for it. The certificates are
/// those of certify() and certify_topology(), byte for byte, in whatever order axes come.
///
/// Many threads may use one verifier at once: what they need of the solid one of them makes, and the others wait.
/// Memory: about 400 bytes for each triangle, or for each 4 x 4 x 4 voxels at the boundary, and up to 30 MB.
class AxisVerifier {
 public:
  /// The solid that a mesh bounds. @param mesh  its vertices and triangles must stay as they are while this lives.
  /// @throws InvalidMesh for what validate() refuses.
  explicit AxisVerifier(const MeshView& mesh);

  /// The closed union of voxels, which are the verifier's own.
  /// @param grid  of the voxels' centres.  @param surface  the mesh whose inside they are, which must stay; nullptr for
  /// an image.
  /// @throws InvalidGrid, InvalidMesh; InvalidOption for a grid of another size than the voxels, and where there are no
  /// voxels.
  AxisVerifier(VoxelSet voxels, const GridSpec& grid, const MeshView* surface);

  AxisVerifier(AxisVerifier&&) noexcept;
  AxisVerifier& operator=(AxisVerifier&&) noexcept;
  ~AxisVerifier();

  /// What the solid is. Of a mesh the same as solid_rule(mesh): certify() throws where it is not a polyhedron. Voxels
  /// are what they were given as, and need no reason. @throws Cancelled.
  [[nodiscard]] MeshSolidRule rule(const Context& context = {}) const;

  /// @throws as certify() of a mesh or of voxels.
  [[nodiscard]] Certificate certify(const Complex& axis, const CertificateOptions& options = {},
                                    const Context& context = {}) const;

  /// @throws as certify_topology() of a mesh or of voxels.
  [[nodiscard]] Certificate certify_topology(const Complex& complex, const Context& context = {}) const;

 private:
  class Reading;
  class MeshReading;
  class VoxelReading;
  std::unique_ptr<const Reading> reading_;
};

}  // namespace blum
