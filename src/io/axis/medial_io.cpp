#include "blum/io/medial_io.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <string>
#include <utility>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/extended_io.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/mesh_io.hpp"
#include "io/axis/medial_files.hpp"
#include "io/format_table.hpp"
#include "io/text/text_cursor.hpp"

namespace blum {
namespace {

/// @throws InvalidOption with the metadata's value of `name`, and the reason.
[[noreturn]] void refuse(const char* name, const std::string& value, const std::string& reason) {
  throw InvalidOption("the metadata say `" + std::string(name) + "` = " + value + ", but it must " + reason);
}

void check_metadata(const MedialMetadata& metadata) {
  for (const auto& [name, value] : {std::pair{"theta", metadata.theta}, std::pair{"lambda", metadata.lambda},
                                    std::pair{"spacing", metadata.spacing}, std::pair{"threshold", metadata.threshold},
                                    std::pair{"weld", metadata.weld}, std::pair{"deviation", metadata.deviation}}) {
    if (value && !std::isfinite(*value)) refuse(name, exact_text(*value), "be finite");
  }
  for (const auto& [name, value] : {std::pair{"weld", metadata.weld}, std::pair{"deviation", metadata.deviation}}) {
    if (value && *value < 0) refuse(name, exact_text(*value), "not be negative");
  }
  if (metadata.label && metadata.threshold) {
    throw InvalidOption("the metadata have a label and a threshold; a solid is selected by one of them");
  }
  if (metadata.smooth && (*metadata.smooth < 0 || *metadata.smooth > medial_files::most_smoothing)) {
    refuse("smooth", std::to_string(*metadata.smooth), "be 0 to " + std::to_string(medial_files::most_smoothing));
  }
  if (metadata.grid) validate(*metadata.grid);
}

constexpr const char* nested_name = "nested";
constexpr const char* nested_theta = "nested_theta";

/// Converts the file of a complex to a medial axis.
MedialFile as_axis(const ComplexFile& file, const std::string& name) {
  MedialFile out;
  out.metadata = medial_files::from_pairs(file.metadata, name);
  medial_files::MedialColumns has;
  out.complex = medial_files::to_axis(file.complex, name, has);
  out.has_radii = has.radii;
  out.has_footprints = has.footprints;
  out.has_sites = has.sites;
  out.has_angles = has.angles;
  out.has_labels = has.labels;
  for (const NamedComplex& further : file.further) {
    if (further.name != nested_name) continue;
    out.nested = medial_files::to_nested(further.complex, name);
    const auto theta = volume_io::parse_number<double>(find_value(file.metadata, nested_theta));
    if (!theta)
      throw FormatError(name + ": the metadata do not contain '" + nested_theta +
                        "', the smallest angle of the nested axes");
    out.least_theta = *theta;
  }
  return out;
}

/// @param nested  may be null.
std::string problem_of_axes(const Complex& axis, const Complex* nested, double least_theta) {
  std::string problem = problem_of_medial(CompleteAxis(axis).get());
  if (!problem.empty() || nested == nullptr) return problem;
  if (!(least_theta >= 0 && least_theta <= 180)) return "the least theta is not between 0 and 180";
  return problem_of_nested(*nested);
}

/// Calls a reader, and then validates the whole result.
template <class Read>
MedialFile checked(const std::string& name, Read read) {
  try {
    MedialFile file = read();
    const std::string problem = problem_of_axes(file.complex, file.nested ? &*file.nested : nullptr, file.least_theta);
    if (!problem.empty()) throw FormatError(name + ": " + problem);
    return file;
  } catch (const std::bad_alloc&) {
    throw OutOfMemory("not enough memory to read '" + name + "'");
  }
}

}  // namespace

namespace {

/// @param nested  may be null.
void write(const std::filesystem::path& path, const Complex& axis, const Complex* nested, double least_theta,
           const MedialMetadata& metadata, const Context& context) {
  const ComplexFormat format = ComplexFormat::of(path, FileAccess::both);
  check_metadata(metadata);
  if (nested != nullptr && !formats::code_of(format).holds_further) {
    throw InvalidOption("'" + path.string() + "': only .npz files can store the axes of all angles");
  }
  const CompleteAxis all(axis);
  static_cast<void>(MedialView(all.get()));  // throws if a column has another type than MedialView requires
  if (nested != nullptr) static_cast<void>(MedialLevels(*nested));
  const std::string problem = problem_of_axes(axis, nested, least_theta);
  if (!problem.empty()) throw InvalidMesh("the medial axis cannot be written: " + problem);
  throw_if_cancelled(context);
  MedialMetadata stated = metadata;
  // Only files with all columns state a version, because verify() needs these columns.
  if (all.is_copy()) stated.version.clear();
  FileMetadata pairs = medial_files::to_pairs(stated);
  ComplexWriteOptions options;
  options.allow_loss = true;  // the table of formats documents what is lost
  if (nested != nullptr) {
    options.further.push_back({nested_name, nested});
    pairs.emplace_back(nested_theta, exact_text(least_theta));
  }
  if (format == ComplexFormat("OBJ")) {
    write_complex(path, medial_files::without_sides(axis), pairs, options, context);
  } else {
    write_complex(path, axis, pairs, options, context);
  }
}

}  // namespace

void write_medial(const std::filesystem::path& path, const Complex& complex, const MedialMetadata& metadata,
                  const Context& context) {
  write(path, complex, nullptr, 0, metadata, context);
}

void write_medial(const std::filesystem::path& path, const Complex& complex, const Complex& nested, double least_theta,
                  const MedialMetadata& metadata, const Context& context) {
  write(path, complex, &nested, least_theta, metadata, context);
}

std::vector<std::string> extensions_with_radii() {
  std::vector<std::string> out;
  for (const std::string& extension : file_extensions(FileContent::complex, FileAccess::read)) {
    if (formats::code_of(ComplexFormat(extension)).holds_radii) out.push_back(extension);
  }
  return out;
}

MedialFile read_medial(const std::filesystem::path& path) {
  return checked(path.string(), [&] { return as_axis(read_complex(path), path.string()); });
}

MedialFile read_medial(const ComplexFile& file, const std::string& name) {
  return checked(name, [&] { return as_axis(file, name); });
}

MedialFile read_medial(std::span<const std::byte> bytes, ComplexFormat format, const std::string& name) {
  return checked(name, [&] { return as_axis(read_complex(bytes, format, name), name); });
}

namespace {

FileMetadata pairs_of(const MedialMetadata& metadata) {
  FileMetadata pairs{{"content", "extended medial axis"}};
  const auto add = [&](const char* key, const std::string& text) {
    if (!text.empty()) pairs.emplace_back(key, text);
  };
  const auto add_number = [&](const char* key, const auto& number) {
    if (number) pairs.emplace_back(key, exact_text(static_cast<double>(*number)));
  };
  add("blum_version", metadata.version);
  add("source", metadata.source);
  add_number("theta", metadata.theta);
  add_number("lambda", metadata.lambda);
  add_number("spacing", metadata.spacing);
  add_number("deviation", metadata.deviation);
  add_number("smooth", metadata.smooth);
  return pairs;
}

void write_as_complex(const std::filesystem::path& path, const Complex& surface, const FileMetadata& metadata,
                      const Context& context) {
  ComplexWriteOptions options;
  options.allow_loss = true;
  write_complex(path, surface, metadata, options, context);
}

void write_stl(const std::filesystem::path& path, const Complex& surface, const FileMetadata& /*metadata*/,
               const Context& /*context*/) {
  if (surface.triangles.empty()) {
    throw InvalidOption("'" + path.string() +
                        "': .stl files hold only triangles, and the axis has none; use another extension");
  }
  write_mesh(path, MeshView{surface.positions, surface.triangles});
}

}  // namespace

void write_extended(const std::filesystem::path& path, const Complex& surface, const MedialMetadata& metadata,
                    const Context& context) {
  const auto format = ExtendedAxisFormat::of(path, FileAccess::write);
  formats::code_of(format).write(path, surface, pairs_of(metadata), context);
}

constinit const formats::ExtendedAxisCode formats::extended_as_complex{write_as_complex};
constinit const formats::ExtendedAxisCode formats::extended_stl{write_stl};

MedialClaims claims_of(const MedialFile& file) {
  return {file.metadata, file.has_radii, file.has_footprints, file.has_sites, file.has_angles, file.has_labels};
}

}  // namespace blum
