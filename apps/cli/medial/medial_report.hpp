// Blum: what the commands say of medial axes and their certificates. SPDX-License-Identifier: Apache-2.0
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

/// The axis of a file with all columns of MedialView, whatever the file holds (MedialFile::has_radii and so on).
[[nodiscard]] MedialFile read_axis(const std::filesystem::path& path);

/// What is shown of a file of a medial axis, or of walls of a Voronoi diagram.
struct ShownAxis {
  MedialFile file;      ///< of a diagram, walls between the same sites have one number as sheets
  std::string content;  ///< as metadata call it: "medial axis", "Voronoi diagram"
  bool is_axis = true;
  std::optional<bool> is_certified;  ///< of a diagram, where the file says so
  std::string certified;             ///< that in words, with what the file says of it; empty where it does not
};
/// read_axis(), and the same of files that `blum voronoi` wrote.
[[nodiscard]] ShownAxis read_axis_or_walls(const std::filesystem::path& path);

/// What walls there are.
[[nodiscard]] std::string walls_text(const ShownAxis& shown);

/// Certifies axes as files hold them against one solid, which is read once.
class SolidVerifier {
 public:
  /// @param input  must stay as it is while this lives. @throws InvalidMesh.
  explicit SolidVerifier(const SolidInput& input);

  /// @param selection  of the voxels, for images.
  /// @throws InvalidMesh where the solid is known by voxels only, and the file does not say which.
  [[nodiscard]] Certificate certificate_of(const MedialFile& file, const LabelSelection& selection,
                                           const Context& context) const;

  /// The same of an axis that was just written, as its file has it. @param metadata  of it: .obj and .ma hold none.
  [[nodiscard]] Certificate certificate_of(const std::filesystem::path& written, const MedialMetadata& metadata,
                                           const LabelSelection& selection, const Context& context) const;

 private:
  std::optional<MeshAxisVerifier> mesh_;
  std::optional<ImageAxisVerifier> image_;
};

/// What was looked at, and of bodies only how many there are, and how many are wrong.
/// @param has_nested  whether the file holds axes of other angles, too, which nothing looks at.
[[nodiscard]] Json certificate_json(const Certificate& certificate, bool has_nested);
/// Where the file of an axis holds no labels, what they would say is null. Edges are then those of no triangle.
[[nodiscard]] Json counts_json(const MedialCounts& counts, bool has_labels);
/// "1 component, 5 tunnels, 0 voids".
[[nodiscard]] std::string betti_text(const BettiNumbers& betti);
/// The same as text, without what the file does not tell.
[[nodiscard]] std::string counts_text(const MedialCounts& counts, bool has_labels);
/// Which angles a file holds the axes of, where it holds those of all.
[[nodiscard]] std::string angles_text(double least_theta);
/// From how many vertices an axis was decimated and how far it moved, if it was.
/// How far the union of the balls is from the solid.
[[nodiscard]] std::string balls_text(const BallUnionCheck& balls);

void add_decimated(TextTable& table, const CertifiedAxis& made);
/// Whether it holds, against what, and how precisely. Why not is left to NotCertified.
void add_certificate(TextTable& table, const Certificate& certificate, bool has_nested);

}  // namespace blum::cli
