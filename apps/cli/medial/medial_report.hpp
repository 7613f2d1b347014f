// Blum: reports on medial axes and their certificates. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "blum/certificate/certificate.hpp"
#include "blum/certified/certified_axis.hpp"
#include "blum/certified/verify_axis.hpp"
#include "blum/io/medial_io.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "common/solid_input.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// Reads the axis of a file, and adds the columns of MedialView that it lacks (see MedialFile::has_radii and so on).
[[nodiscard]] MedialFile read_axis(const std::filesystem::path& path);

/// Content of a file with a medial axis, or with walls of a Voronoi diagram.
struct ShownAxis {
  MedialFile file;      ///< in diagrams, walls between the same two sites are one sheet
  std::string content;  ///< name in metadata: "medial axis", "Voronoi diagram"
  bool is_axis = true;
  std::optional<bool> is_certified;  ///< only for diagrams whose file records it
  std::string certified;             ///< certificate as text; empty if the file has none
};
/// Reads a medial axis as read_axis(), or walls that `blum voronoi` wrote.
[[nodiscard]] ShownAxis read_axis_or_walls(const std::filesystem::path& path);

/// Returns the counts of the walls as text.
[[nodiscard]] std::string walls_text(const ShownAxis& shown);

/// Certifies axes as stored in files against one solid, which is prepared once.
class SolidVerifier {
 public:
  /// @param input  must outlive this object unchanged. @throws InvalidMesh.
  explicit SolidVerifier(const SolidInput& input);

  /// @param selection  selects the voxels of images.
  /// @throws InvalidMesh if the solid is defined by voxels only, and the file does not record them.
  [[nodiscard]] Certificate certificate_of(const MedialFile& file, const LabelSelection& selection,
                                           const Context& context) const;

  /// Certifies an axis that was just written, as its file stores it.
  /// @param metadata  of the axis, because .obj and .ma store none.
  [[nodiscard]] Certificate certificate_of(const std::filesystem::path& written, const MedialMetadata& metadata,
                                           const LabelSelection& selection, const Context& context) const;

 private:
  std::optional<MeshAxisVerifier> mesh_;
  std::optional<ImageAxisVerifier> image_;
};

/// Returns the checks of a certificate as JSON. Bodies are only counted: all, and those with wrong numbers.
/// @param has_nested  true if the file also contains axes of other angles, which are not checked.
[[nodiscard]] Json certificate_json(const Certificate& certificate, bool has_nested);
/// Returns counts as JSON. Without labels in the file, counts that need them are null, and edges are those without
/// triangles.
[[nodiscard]] Json counts_json(const MedialCounts& counts, bool has_labels);
/// Returns for example "1 component, 5 tunnels, 0 voids".
[[nodiscard]] std::string betti_text(const BettiNumbers& betti);
/// Returns counts as text, without those that need missing labels.
[[nodiscard]] std::string counts_text(const MedialCounts& counts, bool has_labels);
/// Returns the angles of the axes in a file with the axes of all angles.
[[nodiscard]] std::string angles_text(double least_theta);
/// Returns the distances between the solid and the union of the balls.
[[nodiscard]] std::string balls_text(const BallUnionCheck& balls);

/// Adds the number of vertices before decimation and the largest move, if the axis was decimated.
void add_decimated(TextTable& table, const CertifiedAxis& made);
/// Adds the counts of an axis; those of edges only for --verbose.
/// @param before  text before the counts, for example the name of the file.
void add_axis_counts(TextTable& table, const std::string& before, const MedialCounts& counts, bool has_labels);
/// Adds the result of a certificate, its solid and its errors. The message of NotCertified gives reasons for failure.
/// @param of  text after "yes" or "NO", for example " at theta 60".
void add_certificate(TextTable& table, const std::string& of, const Certificate& certificate, bool has_nested);

}  // namespace blum::cli
