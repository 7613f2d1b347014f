#include "blum/io/field_io.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "io/field/field_files.hpp"
#include "io/format_table.hpp"

namespace blum {
namespace {

void check_sizes(const Field& field) {
  validate(field.grid);
  const std::size_t nodes = field.grid.node_count();
  if (field.distance.size() != nodes || (!field.site.empty() && field.site.size() != nodes)) {
    throw InvalidGrid("the field has " + std::to_string(field.distance.size()) + " distances and " +
                      std::to_string(field.site.size()) + " sites, but its grid has " + std::to_string(nodes) +
                      " nodes");
  }
  if ((!field.distance2.empty() && field.distance2.size() != nodes) ||
      (!field.site2.empty() && (field.site2.size() != nodes || field.distance2.empty()))) {
    throw InvalidGrid("the field has " + std::to_string(field.distance2.size()) + " second distances and " +
                      std::to_string(field.site2.size()) + " second sites, but its grid has " + std::to_string(nodes) +
                      " nodes");
  }
}

Field read(const volume_io::ByteSource& source, FieldFormat format, const std::filesystem::path& path) {
  Field field = formats::code_of(format).read(source, path);
  try {
    check_sizes(field);
  } catch (const InvalidGrid& error) {
    throw FormatError(source.name() + ": " + error.what());
  }
  return field;
}

}  // namespace

void write_field(const std::filesystem::path& path, const Field& field, const FieldFileInfo& info,
                 const Context& context) {
  const FieldFormat format = FieldFormat::of(path, FileAccess::write);
  check_sizes(field);
  formats::code_of(format).write(path, field, info, context);
}

Field read_field(const std::filesystem::path& path) {
  std::optional<FieldFormat> format = formats::format_of_file<FieldFormat>(path);
  if (!format) format = FieldFormat::of(path);  // before the file is opened, for its error
  return read(volume_io::FileSource(path), *format, path);
}

Field read_field(std::span<const std::byte> bytes, FieldFormat format, const std::string& name) {
  return read(volume_io::MemorySource(bytes, name), format, {});
}

}  // namespace blum

namespace blum::volume_io {
namespace {

/// Returns the enumerator for which to_string returns `text`.
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
      return "site ids: [0, V) the vertices in the mesh's order. [V, V+E) the distinct edges in rising order of "
             "(smaller, larger vertex). [V+E, V+E+F) the triangles in the mesh's order; -1: none";
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

namespace {

[[noreturn]] void fail_site(const std::string& name, std::size_t index) {
  throw FormatError(name + ": the site id of node " + std::to_string(index) + " is neither an index nor -1");
}

}  // namespace

Buffer<float> read_distances(ScalarType type, std::uint64_t count, const ReadValues& read) {
  if (type == ScalarType::f32) {
    Buffer<float> out(count);
    read(std::as_writable_bytes(out.span()));
    return out;
  }
  VoxelImage::Values values = make_values(type, count);
  read(as_bytes(values));
  return to_float(values);
}

Buffer<SiteId> read_sites(ScalarType type, std::uint64_t count, const ReadValues& read, const std::string& name) {
  if (type != ScalarType::i32) {
    VoxelImage::Values values = make_values(type, count);
    read(as_bytes(values));
    return to_sites(values, name);
  }
  Buffer<SiteId> out(count);
  read(std::as_writable_bytes(out.span()));
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i].has_value() && out[i].value > max_id_count) fail_site(name, i);
  }
  return out;
}

Buffer<SiteId> to_sites(const VoxelImage::Values& values, const std::string& name) {
  Buffer<SiteId> out(std::visit([](const auto& v) { return v.size(); }, values));
  std::visit(
      [&]<class T>(const std::vector<T>& v) {
        if constexpr (std::is_floating_point_v<T>) {
          throw FormatError(name + ": site ids must be whole numbers, but these are floating-point");
        } else {
          for (std::size_t i = 0; i < v.size(); ++i) {
            if (!std::in_range<std::int32_t>(v[i]) || std::cmp_less(v[i], -1)) fail_site(name, i);
            out[i] = SiteId(static_cast<std::uint32_t>(v[i]));
          }
        }
      },
      values);
  return out;
}

}  // namespace blum::volume_io
