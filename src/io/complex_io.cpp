#include "blum/io/complex_io.hpp"

#include <algorithm>
#include <new>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "io/complex_files.hpp"
#include "io/text_scan.hpp"
#include "io/whole_file.hpp"

namespace blum {
namespace {

ComplexFormat format_of(const std::filesystem::path& path) {
  const std::string extension = volume_io::lower_case(path.extension().string());
  if (extension == ".vtp") return ComplexFormat::vtp;
  if (extension == ".ply") return ComplexFormat::ply;
  if (extension == ".obj") return ComplexFormat::obj;
  if (extension == ".npz") return ComplexFormat::npz;
  throw InvalidOption("'" + path.string() +
                      "': complexes are kept in .vtp, .ply, .obj and .npz files; use one of these extensions");
}

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
    if (column.components > max_file_columns) {
      throw InvalidOption("column '" + column.name + "' of " + kind + " has more than " +
                          std::to_string(max_file_columns) + " components, which no file holds");
    }
  }
}

void check_complex(const Complex& complex) {
  check_columns(complex.vertex_columns, "vertices");
  check_columns(complex.edge_columns, "edges");
  check_columns(complex.triangle_columns, "triangles");
  std::string problem = problem_of(complex);
  if (problem.empty() && complex.positions.size() > max_id_count) problem = "there are more than 2^31 - 1 vertices";
  if (!problem.empty()) throw InvalidMesh("a complex that cannot be written: " + problem);
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
  if (format != ComplexFormat::npz) {
    throw InvalidOption("'" + path.string() + "': only .npz files hold several complexes");
  }
  std::set<std::string_view> names;
  for (const NamedComplexRef& f : further) {
    const bool is_name = !f.name.empty() && std::all_of(f.name.begin(), f.name.end(), is_letter_or_digit) &&
                         f.name != "vertex" && f.name != "edge" && f.name != "triangle";
    if (!is_name) {
      throw InvalidOption("'" + f.name +
                          "' cannot be the name of a complex in a file: letters and digits can, but not "
                          "'vertex', 'edge' and 'triangle'");
    }
    if (!names.insert(f.name).second) throw InvalidOption("two complexes have the name '" + f.name + "'");
    if (f.complex == nullptr) throw InvalidOption("there is no complex for the name '" + f.name + "'");
    check_complex(*f.complex);
  }
}

std::string names_of(const Columns& columns) {
  std::string names;
  for (const Column& column : columns) names += (names.empty() ? "" : ", ") + column.name;
  return names;
}

void check_obj_loses_nothing(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata) {
  std::string lost;
  const auto lose = [&](const std::string& what) { lost += (lost.empty() ? "" : "; ") + what; };
  if (!complex.vertex_columns.empty()) lose("columns of vertices (" + names_of(complex.vertex_columns) + ")");
  if (!complex.edge_columns.empty()) lose("columns of edges (" + names_of(complex.edge_columns) + ")");
  if (!complex.triangle_columns.empty()) lose("columns of triangles (" + names_of(complex.triangle_columns) + ")");
  if (!metadata.empty()) lose("metadata");
  if (lost.empty()) return;
  throw InvalidOption("'" + path.string() + "': .obj files hold positions, edges and triangles only, so that these " +
                      "would be lost: " + lost + "; write .vtp, .ply or .npz, or allow the loss");
}

/// Formats whose arrays are read one by one, from where they are.
bool is_read_in_parts(ComplexFormat format) {
  return format == ComplexFormat::vtp || format == ComplexFormat::npz;
}

ComplexFile read_by_format(const volume_io::ByteSource& source, ComplexFormat format) {
  return format == ComplexFormat::vtp ? complex_files::read_vtp(source) : complex_files::read_npz(source);
}

ComplexFile read_by_format(std::span<const std::byte> bytes, ComplexFormat format, const std::string& name) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return format == ComplexFormat::ply ? complex_files::read_ply(text, name) : complex_files::read_obj(text, name);
}

/// Reads, and looks at the result as a whole.
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
  const ComplexFormat format = format_of(path);
  check_complex(complex);
  check_metadata(metadata);
  check_further(path, format, options.further);
  throw_if_cancelled(context);
  switch (format) {
    case ComplexFormat::vtp:
      return complex_files::write_vtp(path, complex, metadata, context);
    case ComplexFormat::ply:
      return complex_files::write_ply(path, complex, metadata, context);
    case ComplexFormat::obj:
      if (!options.allow_loss) check_obj_loses_nothing(path, complex, metadata);
      return complex_files::write_obj(path, complex, context);
    case ComplexFormat::npz:
      return complex_files::write_npz(path, complex, metadata, options, context);
  }
}

ComplexFile read_complex(const std::filesystem::path& path) {
  const ComplexFormat format = format_of(path);
  return checked(path.string(), [&] {
    if (is_read_in_parts(format)) return read_by_format(volume_io::FileSource(path), format);
    return read_by_format(read_whole_file(path).span(), format, path.string());
  });
}

ComplexFile read_complex(std::span<const std::byte> bytes, ComplexFormat format, const std::string& name) {
  return checked(name, [&] {
    if (is_read_in_parts(format)) return read_by_format(volume_io::MemorySource(bytes, name), format);
    return read_by_format(bytes, format, name);
  });
}

}  // namespace blum
