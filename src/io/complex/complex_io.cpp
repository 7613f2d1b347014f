#include "blum/io/complex_io.hpp"

#include <algorithm>
#include <new>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/format_table.hpp"

namespace blum {
namespace {

bool is_letter_or_digit(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

void check_columns(const Columns& columns, const char* kind) {
  if (columns.size() > max_file_columns) {
    throw InvalidOption("files hold at most " + std::to_string(max_file_columns) + " columns of " + kind);
  }
  for (const Column& column : columns) {
    const bool is_name = std::all_of(column.name.begin(), column.name.end(),
                                     [](char c) { return is_letter_or_digit(c) || c == '_' || c == '-' || c == '.'; });
    if (!is_name) {
      throw InvalidOption("column '" + column.name + "' of " + kind +
                          " cannot be written: names in files are made of letters, digits, '_', '-' and '.'");
    }
    if (column.name.size() > max_file_name) {
      throw InvalidOption("a column of " + std::string(kind) + " has a name of " + std::to_string(column.name.size()) +
                          " characters; files hold at most " + std::to_string(max_file_name));
    }
    if (column.components > max_file_columns) {
      throw InvalidOption("column '" + column.name + "' of " + kind + " has more than " +
                          std::to_string(max_file_columns) + " components, which no file holds");
    }
  }
}

/// @param holds_columns  true if the format can store columns.
void check_complex(const Complex& complex, bool holds_columns) {
  if (holds_columns) {
    check_columns(complex.vertex_columns, "vertices");
    check_columns(complex.edge_columns, "edges");
    check_columns(complex.triangle_columns, "triangles");
  }
  std::string problem = problem_of(complex);
  if (problem.empty() && complex.positions.size() > max_id_count) problem = "there are more than 2^31 - 1 vertices";
  if (!problem.empty()) throw InvalidMesh("the complex cannot be written: " + problem);
}

void check_metadata(const FileMetadata& metadata) {
  std::set<std::string_view> keys;
  for (const auto& [key, text] : metadata) {
    if (key.empty()) throw InvalidOption("metadata need a key for each text");
    if (!keys.insert(key).second) throw InvalidOption("the key '" + key + "' is in the metadata twice");
  }
}

void check_further(const std::filesystem::path& path, ComplexFormat format,
                   const std::vector<NamedComplexRef>& further) {
  if (further.empty()) return;
  if (!formats::code_of(format).holds_further) {
    throw InvalidOption("'" + path.string() + "': " + format.name() +
                        " files do not hold several complexes; .npz files do");
  }
  std::set<std::string_view> names;
  for (const NamedComplexRef& f : further) {
    const bool is_name = !f.name.empty() && std::all_of(f.name.begin(), f.name.end(), is_letter_or_digit) &&
                         f.name.size() <= max_file_name && f.name != "vertex" && f.name != "edge" &&
                         f.name != "triangle";
    if (!is_name) {
      throw InvalidOption("'" + f.name +
                          "' cannot be the name of a complex in a file: names have up to 256 letters and digits, and "
                          "are not 'vertex', 'edge' or 'triangle'");
    }
    if (!names.insert(f.name).second) throw InvalidOption("two complexes have the name '" + f.name + "'");
    if (f.complex == nullptr) throw InvalidOption("there is no complex for the name '" + f.name + "'");
    check_complex(*f.complex, true);
  }
}

std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Calls a reader, and then validates the whole result.
template <class Read>
ComplexFile checked(const std::string& name, Read read) {
  try {
    ComplexFile file = read();
    if (const std::string problem = problem_of(file.complex); !problem.empty()) {
      throw FormatError(name + ": " + problem);
    }
    for (const NamedComplex& further : file.further) {
      if (const std::string problem = problem_of(further.complex); !problem.empty()) {
        throw FormatError(name + ": in the complex '" + further.name + "', " + problem);
      }
    }
    return file;
  } catch (const std::bad_alloc&) {
    throw OutOfMemory("not enough memory to read '" + name + "'");
  }
}

}  // namespace

void write_complex(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
                   const ComplexWriteOptions& options, const Context& context) {
  const ComplexFormat format = ComplexFormat::of(path, FileAccess::write);
  check_complex(complex, formats::code_of(format).holds_columns);
  check_metadata(metadata);
  check_further(path, format, options.further);
  throw_if_cancelled(context);
  formats::code_of(format).write(path, complex, metadata, options, context);
}

ComplexFile read_complex(const std::filesystem::path& path) {
  std::optional<ComplexFormat> format = formats::format_of_file<ComplexFormat>(path);
  if (!format) format = ComplexFormat::of(path);  // before the file is opened, for its error
  const formats::ComplexCode& code = formats::code_of(*format);
  return checked(path.string(), [&] {
    if (code.read != nullptr) return code.read(volume_io::FileSource(path));
    const FileBytes content = read_whole_file(path);
    return code.read_text(as_text(content.span()), path.string());
  });
}

bool may_hold_columns(const std::filesystem::path& path) {
  const auto format = formats::format_of_file<ComplexFormat>(path);
  return format && formats::code_of(*format).holds_columns;
}

bool may_hold_further(const std::filesystem::path& path) {
  const auto format = ComplexFormat::by_name(path);
  return format && formats::code_of(*format).holds_further;
}

ComplexFile read_complex(std::span<const std::byte> bytes, ComplexFormat format, const std::string& name) {
  const formats::ComplexCode& code = formats::code_of(format);
  if (code.read == nullptr && code.read_text == nullptr) {
    throw InvalidOption(format.name() + " files are written, but not read");
  }
  return checked(name, [&] {
    if (code.read != nullptr) return code.read(volume_io::MemorySource(bytes, name));
    return code.read_text(as_text(bytes), name);
  });
}

}  // namespace blum
