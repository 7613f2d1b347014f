#include "blum/io/field_io.hpp"

#include <algorithm>
#include <cctype>
#include <string>

#include "blum/core/error.hpp"
#include "blum/io/formats.hpp"
#include "io/field_files.hpp"

namespace blum {
namespace {

FieldFormat format_of(const std::filesystem::path& path) {
  if (const auto place = format_by_name(FileContent::field, path)) return static_cast<FieldFormat>(*place);
  throw InvalidOption("'" + path.string() +
                      "': fields are kept in .nrrd, .npz and .vti files; use one of these extensions");
}

void check_sizes(const Field& field) {
  validate(field.grid);
  const std::size_t nodes = field.grid.node_count();
  if (field.distance.size() != nodes || (!field.site.empty() && field.site.size() != nodes)) {
    throw InvalidGrid("the field has " + std::to_string(field.distance.size()) + " distances and " +
                      std::to_string(field.site.size()) + " sites, but its grid has " + std::to_string(nodes) +
                      " nodes");
  }
}

Field read(const volume_io::ByteSource& source, FieldFormat format, const std::filesystem::path& path) {
  Field field = format == FieldFormat::nrrd  ? volume_io::read_field_nrrd(source, path)
                : format == FieldFormat::npz ? volume_io::read_field_npz(source)
                                             : volume_io::read_field_vti(source);
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
  const FieldFormat format = format_of(path);
  check_sizes(field);
  switch (format) {
    case FieldFormat::nrrd:
      return volume_io::write_field_nrrd(path, field, info, context);
    case FieldFormat::npz:
      return volume_io::write_field_npz(path, field, info, context);
    case FieldFormat::vti:
      return volume_io::write_field_vti(path, field, info, context);
  }
}

Field read_field(const std::filesystem::path& path) {
  const FieldFormat format = format_of(path);
  return read(volume_io::FileSource(path), format, path);
}

Field read_field(std::span<const std::byte> bytes, FieldFormat format, const std::string& name) {
  return read(volume_io::MemorySource(bytes, name), format, {});
}

}  // namespace blum
