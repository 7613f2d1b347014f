#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "io/axis/medial_files.hpp"
#include "io/field/field_metadata.hpp"
#include "io/text/text_scan.hpp"

namespace blum::medial_files {
namespace {

using Metadata = FileMetadata;

constexpr const char* axis_content = "medial axis";

/// Footprints lie on the border of the solid, so that voxels that are not selected name them.
std::string site_sentence(SiteIds ids) {
  if (ids != SiteIds::voxels) return volume_io::site_sentence(ids);
  return "site ids: the linear index x + nx * (y + ny * z) of the voxel beside the solid whose face the footprint lies "
         "on: one that is not selected, or, outside of the image, the image's voxel next to it; -1 none";
}

std::string numbers_text(const Vec3d& v) {
  return exact_text(v.x) + " " + exact_text(v.y) + " " + exact_text(v.z);
}

void add_grid(Metadata& pairs, const GridSpec& grid) {
  pairs.emplace_back("grid_origin", numbers_text(grid.origin));
  pairs.emplace_back("grid_spacing", numbers_text(grid.spacing));
  pairs.emplace_back("grid_size", std::to_string(grid.size[0]) + " " + std::to_string(grid.size[1]) + " " +
                                      std::to_string(grid.size[2]));
  std::string rows;
  for (std::size_t row = 0; row < 3; ++row) {
    const auto& c = grid.direction.columns;
    rows += (row == 0 ? "" : " ") + numbers_text({c[0][row], c[1][row], c[2][row]});
  }
  pairs.emplace_back("grid_direction", rows);
}

/// Looks up the values of known keys and makes numbers of them.
class PairReader {
 public:
  PairReader(const Metadata& pairs, const std::string& name) : pairs_(pairs), name_(name) {}

  [[nodiscard]] std::string text(std::string_view key) const { return std::string(find_value(pairs_, key)); }

  template <class T, std::size_t n>
  [[nodiscard]] std::optional<std::array<T, n>> numbers(std::string_view key) const {
    const std::string_view text = find_value(pairs_, key);
    if (text.empty()) return std::nullopt;
    const auto words = volume_io::split_words(text);
    std::array<T, n> out{};
    for (std::size_t i = 0; i < n; ++i) {
      const auto value = words.size() == n ? volume_io::parse_number<T>(words[i]) : std::nullopt;
      if (!value || !std::isfinite(static_cast<double>(*value))) {
        fail(key, n == 1 ? "it must be a finite number" : "it must be " + std::to_string(n) + " finite numbers");
      }
      out[i] = *value;
    }
    return out;
  }
  template <class T = double>
  [[nodiscard]] std::optional<T> number(std::string_view key) const {
    const auto value = numbers<T, 1>(key);
    return value ? std::optional((*value)[0]) : std::nullopt;
  }
  [[nodiscard]] std::optional<double> not_negative(std::string_view key) const {
    const auto value = number(key);
    if (value && *value < 0) fail(key, "it must not be negative");
    return value;
  }

  [[nodiscard]] SiteIds site_ids() const {
    const std::string_view text = find_value(pairs_, "site_ids");
    if (text.empty()) return SiteIds::features;
    for (const SiteIds ids : {SiteIds::features, SiteIds::triangles, SiteIds::voxels}) {
      if (to_string(ids) == text) return ids;
    }
    fail("site_ids", "which is not known");
  }

  [[nodiscard]] std::optional<GridSpec> grid() const {
    const auto origin = numbers<double, 3>("grid_origin");
    const auto spacing = numbers<double, 3>("grid_spacing");
    const auto size = numbers<std::int64_t, 3>("grid_size");
    const auto rows = numbers<double, 9>("grid_direction");
    if (!origin && !spacing && !size && !rows) return std::nullopt;
    if (!origin || !spacing || !size || !rows) {
      throw FormatError(name_ + ": the metadata tell only a part of the grid's origin, spacing, size and direction");
    }
    GridSpec grid;
    grid.origin = {(*origin)[0], (*origin)[1], (*origin)[2]};
    grid.spacing = {(*spacing)[0], (*spacing)[1], (*spacing)[2]};
    grid.size = *size;
    for (std::size_t c = 0; c < 3; ++c) grid.direction.columns[c] = {(*rows)[c], (*rows)[3 + c], (*rows)[6 + c]};
    try {
      validate(grid);
    } catch (const InvalidGrid& error) {
      throw FormatError(name_ + ": the grid of the metadata: " + error.what());
    }
    return grid;
  }

 private:
  [[noreturn]] void fail(std::string_view key, const std::string& reason) const {
    throw FormatError(name_ + ": the metadata say " + std::string(key) + " '" + text(key) + "', but " + reason);
  }

  const Metadata& pairs_;
  const std::string& name_;
};

}  // namespace

FileMetadata to_pairs(const MedialMetadata& metadata) {
  Metadata pairs;
  pairs.emplace_back("content", axis_content);
  if (!metadata.version.empty()) pairs.emplace_back("blum_version", metadata.version);
  if (!metadata.source.empty()) pairs.emplace_back("source", metadata.source);
  pairs.emplace_back("site_ids", to_string(metadata.site_ids));
  pairs.emplace_back("sites", site_sentence(metadata.site_ids));
  pairs.emplace_back("roles", "0 sheet, 1 rim, 2 seam, 3 curve, 4 junction");
  if (metadata.theta) pairs.emplace_back("theta", exact_text(*metadata.theta));
  if (metadata.lambda) pairs.emplace_back("lambda", exact_text(*metadata.lambda));
  if (metadata.spacing) pairs.emplace_back("spacing", exact_text(*metadata.spacing));
  if (metadata.deviation) pairs.emplace_back("deviation", exact_text(*metadata.deviation));
  if (!metadata.solid_rule.empty()) pairs.emplace_back("solid_rule", metadata.solid_rule);
  if (metadata.grid) add_grid(pairs, *metadata.grid);
  if (metadata.label) pairs.emplace_back("label", std::to_string(*metadata.label));
  if (metadata.threshold) pairs.emplace_back("threshold", exact_text(*metadata.threshold));
  if (metadata.weld) pairs.emplace_back("weld", exact_text(*metadata.weld));
  if (metadata.smooth) pairs.emplace_back("smooth", std::to_string(*metadata.smooth));
  return pairs;
}

MedialMetadata from_pairs(const FileMetadata& pairs, const std::string& name) {
  const PairReader reader(pairs, name);
  if (const std::string content = reader.text("content"); !content.empty() && content != axis_content) {
    throw FormatError(name + ": the metadata call it '" + content + "', not a medial axis");
  }
  MedialMetadata metadata;
  metadata.source = reader.text("source");
  metadata.version = reader.text("blum_version");
  metadata.site_ids = reader.site_ids();
  metadata.theta = reader.number("theta");
  metadata.lambda = reader.number("lambda");
  metadata.spacing = reader.number("spacing");
  metadata.deviation = reader.not_negative("deviation");
  metadata.solid_rule = reader.text("solid_rule");
  metadata.grid = reader.grid();
  metadata.label = reader.number<std::int64_t>("label");
  metadata.threshold = reader.number("threshold");
  if (metadata.label && metadata.threshold) {
    throw FormatError(name + ": the metadata say a label and a threshold, but the solid can only be by one of them");
  }
  metadata.weld = reader.not_negative("weld");
  metadata.smooth = reader.number<int>("smooth");
  if (metadata.smooth && (*metadata.smooth < 0 || *metadata.smooth > most_smoothing)) {
    throw FormatError(name + ": the metadata say smooth '" + std::to_string(*metadata.smooth) +
                      "', but it must be 0 to " + std::to_string(most_smoothing));
  }
  return metadata;
}

}  // namespace blum::medial_files
