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

/// Certifies axes of one solid, which it reads once. It keeps the shells, crossings, Betti numbers and searches of the
/// solid, and the balls from random points that show missing parts of an axis. Each is computed when an axis first
/// needs it. The certificates are those of certify() and certify_topology(), byte for byte, in any order of axes.
///
/// Many threads may use one verifier at once: one of them computes what is needed, and the others wait.
/// Memory: about 400 bytes per triangle, or per 4 x 4 x 4 voxels at the boundary, and up to 30 MB.
class AxisVerifier {
 public:
  /// Constructs a verifier for the solid of a mesh.
  /// @param mesh  its vertices and triangles must stay unchanged while the verifier exists.
  /// @throws InvalidMesh if validate() rejects the mesh.
  explicit AxisVerifier(const MeshView& mesh);

  /// Constructs a verifier for the closed union of voxels, which it keeps.
  /// @param grid  of the voxels' centres.
  /// @param surface  mesh whose inside the voxels are, which must stay unchanged; nullptr for an image.
  /// @throws InvalidGrid; InvalidMesh; InvalidOption if the sizes of the grid and the voxels differ, or no voxel
  /// exists.
  AxisVerifier(VoxelSet voxels, const GridSpec& grid, const MeshView* surface);

  AxisVerifier(AxisVerifier&&) noexcept;
  AxisVerifier& operator=(AxisVerifier&&) noexcept;
  ~AxisVerifier();

  /// Returns the rule of the solid. For a mesh it is that of solid_rule(mesh); certify() throws if it is not a
  /// polyhedron. For voxels it follows from the constructor, and the reason is empty.
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
