#include "io/field/field_metadata.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"

namespace blum::volume_io {
namespace {

/// Finds the enumerator that to_string shows as `text`.
template <class Enum, std::size_t n>
Enum from_text(std::string_view text, const std::array<Enum, n>& all, std::string_view key, const std::string& name) {
  for (const Enum value : all) {
    if (to_string(value) == text) return value;
  }
  throw FormatError(name + ": the metadata say " + std::string(key) + " '" + std::string(text) +
                    "', which is not known");
}

}  // namespace

std::string site_sentence(SiteIds ids) {
  switch (ids) {
    case SiteIds::features:
      return "site ids: [0, V) the vertices in the mesh's order; [V, V+E) the distinct edges in rising order of "
             "(smaller, larger vertex); [V+E, V+E+F) the triangles in the mesh's order; -1 none";
    case SiteIds::triangles:
      return "site ids: the smallest triangle, in the mesh's order, that the closest site lies on; -1 none";
    case SiteIds::voxels:
      return "site ids: the linear index x + nx * (y + ny * z) of the closest voxel; -1 none";
  }
  return {};
}

Metadata field_metadata(const Field& field, const FieldFileInfo& info) {
  Metadata pairs;
  if (!info.version.empty()) pairs.emplace_back("blum_version", info.version);
  if (!info.source.empty()) pairs.emplace_back("source", info.source);
  const bool is_signed = field.sign_rule != SignRule::none;
  const std::string unit = field.site_ids == SiteIds::voxels ? "the image" : "the mesh";
  pairs.emplace_back("distance", is_signed ? "negative inside, units of " + unit : "unsigned, units of " + unit);
  pairs.emplace_back("sign_rule", to_string(field.sign_rule));
  if (!field.sign_reason.empty()) pairs.emplace_back("sign_reason", field.sign_reason);
  if (field.band) {
    pairs.emplace_back("band", exact_text(*field.band));
    pairs.emplace_back("beyond_band", field.site.empty() ? "distance +-band" : "distance +-band, site -1");
  }
  if (field.order() == 2) {
    pairs.emplace_back("distance2", std::string("to the second site, >= 0, units of ") + unit + "; " +
                                        (field.band ? "the band" : "infinity") + " where there is none");
  }
  if (field.second) pairs.emplace_back("second", to_string(*field.second));
  if (!field.site.empty()) {
    pairs.emplace_back("site_ids", to_string(field.site_ids));
    pairs.emplace_back("sites", site_sentence(field.site_ids));
  }
  if (info.sites != nullptr) {
    pairs.emplace_back("vertex_count", std::to_string(info.sites->vertex_count()));
    pairs.emplace_back("edge_count", std::to_string(info.sites->edge_count()));
    pairs.emplace_back("face_count", std::to_string(info.sites->face_count()));
  }
  if (!info.space.empty()) pairs.emplace_back("world_axes", info.space);
  pairs.emplace_back("values", "at nodes, x fastest");
  return pairs;
}

void apply_metadata(const Metadata& metadata, const std::string& name, Field& field) {
  if (const std::string_view text = find_value(metadata, "band"); !text.empty()) {
    double band = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), band);
    if (error != std::errc() || end != text.data() + text.size() || !(band > 0) || !std::isfinite(band)) {
      throw FormatError(name + ": the metadata say band '" + std::string(text) + "', but it must be a positive number");
    }
    field.band = band;
  }
  if (const std::string_view text = find_value(metadata, "sign_rule"); !text.empty()) {
    constexpr std::array all{SignRule::none, SignRule::normals, SignRule::winding, SignRule::label, SignRule::balls};
    field.sign_rule = from_text(text, all, "sign_rule", name);
  }
  if (const std::string_view text = find_value(metadata, "site_ids"); !text.empty()) {
    constexpr std::array all{SiteIds::features, SiteIds::triangles, SiteIds::voxels};
    field.site_ids = from_text(text, all, "site_ids", name);
  }
  if (const std::string_view text = find_value(metadata, "second"); !text.empty()) {
    constexpr std::array all{SecondRule::no_common_vertex, SecondRule::other_object};
    field.second = from_text(text, all, "second", name);
  }
  field.sign_reason = find_value(metadata, "sign_reason");
}

}  // namespace blum::volume_io
