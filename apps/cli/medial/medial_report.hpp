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

/// Reads the axis of a file. Columns that MedialView requires and the file lacks are added (see MedialFile::has_radii
/// and so on).
[[nodiscard]] MedialFile read_axis(const std::filesystem::path& path);

/// Returns a share (1 is everything) as text, for example "12.5 %".
[[nodiscard]] std::string percent(double share);

/// Content of a file with a medial axis, with walls of a Voronoi diagram, or with centrelines.
struct ShownAxis {
  MedialFile file;      ///< for diagrams, walls between the same two sites form one sheet
  std::string content;  ///< name of the content in the metadata: "medial axis", "Voronoi diagram", "points", ...
  bool is_axis = true;
  bool is_plain = false;             ///< the content is only cells: points, witnesses or a surface map
  std::optional<bool> is_certified;  ///< set only for diagrams whose file records it
  std::string certified;             ///< certificate as text; empty if the file records none
};
/// Reads a medial axis as read_axis() does, an axis extended by `blum medial --extend`, walls written by `blum
/// voronoi`, curves written by `blum centreline`. Also reads points, witnesses and surface maps, without columns.
[[nodiscard]] ShownAxis read_axis_or_curves(const std::filesystem::path& path);

/// Returns the label of cells_text(): "axis", "walls", "curves" or "cells".
[[nodiscard]] const char* cells_label(const ShownAxis& shown);
/// Returns the counts of the cells as text.
[[nodiscard]] std::string cells_text(const ShownAxis& shown);

/// Certifies axes, as their files store them, against one solid. The solid is prepared once.
class SolidVerifier {
 public:
  /// @param input  the solid. It must outlive this object and must not change. @throws InvalidMesh.
  explicit SolidVerifier(const SolidInput& input);

  /// @param selection  for images: selects the voxels of the solid.
  /// @throws InvalidMesh if the solid is defined only by voxels, and the axis's file does not record these.
  [[nodiscard]] Certificate certificate_of(const MedialFile& file, const LabelSelection& selection,
                                           const Context& context) const;

  /// Certifies an axis that was just written. Reads it from its file.
  /// @param metadata  metadata of the axis; given because .obj and .ma files store none.
  [[nodiscard]] Certificate certificate_of(const std::filesystem::path& written, const MedialMetadata& metadata,
                                           const LabelSelection& selection, const Context& context) const;

 private:
  std::optional<MeshAxisVerifier> mesh_;
  std::optional<ImageAxisVerifier> image_;
};

/// Returns the checks of a certificate as JSON. For bodies it contains only two counts: all bodies, and those with
/// wrong Betti numbers.
/// @param has_nested  true if the file also contains axes for other angles. These are not checked.
[[nodiscard]] Json certificate_json(const Certificate& certificate, bool has_nested);
/// Returns counts as JSON. If the file has no labels (roles and sheets), counts that need them are null, and `edges`
/// counts edges without triangles.
[[nodiscard]] Json counts_json(const MedialCounts& counts, bool has_labels);
/// Returns a text like "1 component, 5 tunnels, 0 voids".
[[nodiscard]] std::string betti_text(const BettiNumbers& betti);
/// Returns counts as text. If the file has no labels, counts that need them are left out.
[[nodiscard]] std::string counts_text(const MedialCounts& counts, bool has_labels);
/// For a file with the axes of all angles, returns their range of angles as text.
[[nodiscard]] std::string angles_text(double least_theta);
/// Returns, as text, the distances between the surface of the solid and that of the union of the balls.
/// @param size  see share_text().
[[nodiscard]] std::string balls_text(const BallUnionCheck& balls, double size);

/// If the axis was decimated, adds the number of vertices before decimation and the largest distance moved.
void add_decimated(TextTable& table, const CertifiedAxis& made, double size);
/// Adds the counts of an axis. Counts of edges are details (shown with --verbose).
/// @param before  text before the counts, for example the name of the file.
void add_axis_counts(TextTable& table, const std::string& before, const MedialCounts& counts, bool has_labels);
/// Adds the result of a certificate, the solid and the errors. If it failed, the message of NotCertified gives the
/// reasons.
/// @param of  text after "yes" or "NO", for example " at theta 60".
/// @param size  see share_text().
void add_certificate(TextTable& table, const std::string& of, const Certificate& certificate, bool has_nested,
                     double size);

}  // namespace blum::cli
