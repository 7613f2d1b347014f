// Blum: the shells of a closed mesh and their nesting, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {

/// A closed, connected part of the surface.
struct ClosedShell {
  std::int64_t genus = 0;
  double volume = 0;        ///< enclosed volume, > 0 for either orientation
  std::uint32_t depth = 0;  ///< number of shells around the shell: at even depth it bounds a body, at odd depth a void
  std::uint32_t body = 0;   ///< index of the body; a void has the index of the body around it
};

struct ClosedShells {
  std::vector<ClosedShell> shells;
  std::vector<std::uint32_t> of_triangle;  ///< shell of each triangle; no_group for a triangle with a vertex twice
  std::vector<std::int8_t> outwards;       ///< 1 if a triangle's normal points out of its shell, -1 if in, 0 if unknown
  std::vector<std::uint32_t> beside;       ///< for each side (3 * triangle + k): the triangle on its other side
  std::uint32_t bodies = 0;
};

/// Thrown for a mesh that bounds no polyhedron.
class NoPolyhedron : public InvalidMesh {
 public:
  explicit NoPolyhedron(const std::string& reason) : InvalidMesh(reason), reason_(reason) {}
  /// Returns the reason as one sentence.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// Splits a mesh into its shells. Their nesting is not yet known.
/// @throws NoPolyhedron unless every edge has two triangles, the triangles at every vertex form one fan, and the
/// surface is two-sided; Cancelled.
[[nodiscard]] ClosedShells cut_into_shells(const MeshView& mesh, const Context& context);

/// Computes depths and bodies from lines through each shell. Shells may touch, but not cross.
/// @param search  the triangles, with their shells as groups.
/// @throws NoPolyhedron if a shell encloses no volume, or exactly the volume of another shell; Cancelled.
void nest(ClosedShells& shells, const MeshView& mesh, const TriangleSearch& search, const Context& context);

/// Returns the Betti numbers of each body of the solid that nested shells bound.
[[nodiscard]] std::vector<BettiNumbers> betti_numbers(const ClosedShells& shells);

}  // namespace blum::verifier
