#include "blum/io/field_io.hpp"

#include <algorithm>
#include <cctype>
#include <string>

#include "blum/core/error.hpp"
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
  const FieldFormat format = FieldFormat::of(path);
  return read(volume_io::FileSource(path), format, path);
}

Field read_field(std::span<const std::byte> bytes, FieldFormat format, const std::string& name) {
  return read(volume_io::MemorySource(bytes, name), format, {});
}

}  // namespace blum
