#include "blum/io/medial_io.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <new>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "io/medial_edges.hpp"
#include "io/medial_files.hpp"
#include "io/whole_file.hpp"

namespace blum {
namespace medial_files {
namespace {

std::string place(const char* what, std::size_t index) {
  return std::string(what) + " " + std::to_string(index) + " (counted from 0)";
}

bool is_site(SiteId site) {
  return !site.has_value() || site.value <= max_id_count;
}

/// What is wrong with one vertex; null where nothing is.
const char* vertex_problem(const MedialVertex& v) {
  if (!is_finite(v.position)) return "has a coordinate that is not finite";
  if (!std::isfinite(v.radius) || v.radius < 0) return "has a radius that is negative or not finite";
  if (!is_finite(v.footprints[0]) || !is_finite(v.footprints[1])) return "has a footprint that is not finite";
  if (!std::isfinite(v.separation_angle)) return "has an angle that is not finite";
  if (!is_site(v.sites[0]) || !is_site(v.sites[1])) return "has a site that is too large for a file";
  return nullptr;
}

/// The same for an edge or a triangle of a complex of `count` vertices.
template <class Cell>
std::string cell_problem(const Cell& cell, std::size_t count) {
  for (std::size_t i = 0; i < cell.vertices.size(); ++i) {
    const std::uint32_t v = cell.vertices[i];
    if (v >= count) return "names vertex " + std::to_string(v) + ", but there are only " + std::to_string(count);
    if (v == cell.vertices[(i + 1) % cell.vertices.size()]) return "names vertex " + std::to_string(v) + " twice";
  }
  return std::isfinite(cell.separation_angle) ? "" : "has an angle that is not finite";
}

template <class Cell>
std::string problem_of_cells(const std::vector<Cell>& cells, const char* what, std::size_t count) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string problem = cell_problem(cells[i], count);
    if (!problem.empty()) return place(what, i) + " " + problem;
  }
  return {};
}

/// Every sheet has a triangle, so that a file cannot make anyone count to more sheets than it has triangles.
std::string problem_of_sheets(const MedialComplex& complex) {
  if (complex.sheet_count > complex.triangles.size()) {
    return "there are " + std::to_string(complex.sheet_count) + " sheets, but only " +
           std::to_string(complex.triangles.size()) + " triangles";
  }
  for (std::size_t i = 0; i < complex.triangles.size(); ++i) {
    if (complex.triangles[i].sheet < complex.sheet_count) continue;
    return place("triangle", i) + " is on sheet " + std::to_string(complex.triangles[i].sheet) +
           ", but there are only " + std::to_string(complex.sheet_count);
  }
  return {};
}

}  // namespace

std::string problem_of(const MedialComplex& complex) {
  const std::size_t count = complex.vertices.size();
  if (count > max_id_count) return "there are more than 2^31 - 1 vertices";
  for (std::size_t i = 0; i < count; ++i) {
    if (const char* problem = vertex_problem(complex.vertices[i])) return place("vertex", i) + " " + problem;
  }
  std::string problem = problem_of_cells(complex.edges, "edge", count);
  if (problem.empty()) problem = problem_of_cells(complex.triangles, "triangle", count);
  return problem.empty() ? problem_of_sheets(complex) : problem;
}

std::string problem_of(const NestedComplex& nested) {
  const std::size_t count = nested.vertices.size();
  if (count > max_id_count) return "there are more than 2^31 - 1 vertices";
  if (!(nested.least_theta >= 0 && nested.least_theta <= 180)) return "the least theta is not between 0 and 180";
  if (nested.vertex_until.size() != count) return "not every vertex has an angle";
  for (std::size_t i = 0; i < count; ++i) {
    if (const char* problem = vertex_problem(nested.vertices[i])) return place("vertex", i) + " " + problem;
    if (std::isnan(nested.vertex_until[i])) return place("vertex", i) + " has an angle that is not a number";
  }
  std::string problem = problem_of_cells(nested.edges, "edge", count);
  if (problem.empty()) problem = problem_of_cells(nested.triangles, "triangle", count);
  if (!problem.empty()) return problem;
  for (std::size_t i = 0; i < nested.edges.size(); ++i) {
    const NestedEdge& edge = nested.edges[i];
    if (std::isnan(edge.from) || std::isnan(edge.until)) return place("edge", i) + " has an angle that is not a number";
    const bool is_line =
        edge.role == MedialRole::curve || edge.role == MedialRole::rim || edge.role == MedialRole::seam;
    if (!is_line) return place("edge", i) + " is neither curve nor rim nor seam";
  }
  for (std::size_t i = 0; i < nested.triangles.size(); ++i) {
    if (std::isnan(nested.triangles[i].until)) return place("triangle", i) + " has an angle that is not a number";
  }
  return nested.sheet_count > nested.triangles.size() ? "there are more sheets than triangles" : "";
}

std::uint32_t sheet_count(const MedialComplex& complex) {
  std::uint32_t count = 0;
  for (const MedialTriangle& t : complex.triangles) count = std::max(count, t.sheet + 1);
  return count;
}

void keep_curves_only(MedialComplex& complex) {
  if (!complex.triangles.empty()) {
    const EdgeSet sides(complex, EdgeSet::Of::triangles);
    std::erase_if(complex.edges, [&](const MedialEdge& edge) { return sides.contains(edge.vertices); });
  }
  for (MedialEdge& edge : complex.edges) edge.role = MedialRole::curve;
}

}  // namespace medial_files

namespace {

MedialFormat format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".vtp") return MedialFormat::vtp;
  if (extension == ".ply") return MedialFormat::ply;
  if (extension == ".obj") return MedialFormat::obj;
  if (extension == ".ma") return MedialFormat::ma;
  if (extension == ".npz") return MedialFormat::npz;
  throw InvalidOption("'" + path.string() +
                      "': medial axes are kept in .vtp, .ply, .obj, .ma and .npz files; use one of these extensions");
}

void check_metadata(const MedialMetadata& metadata) {
  for (const auto& [name, value] : {std::pair{"theta", metadata.theta}, std::pair{"lambda", metadata.lambda},
                                    std::pair{"spacing", metadata.spacing}, std::pair{"threshold", metadata.threshold},
                                    std::pair{"weld", metadata.weld}}) {
    if (value && !std::isfinite(*value)) {
      throw InvalidOption(std::string(name) + " of the metadata is not finite: " + exact_text(*value));
    }
  }
  if (metadata.weld && *metadata.weld < 0) {
    throw InvalidOption("weld of the metadata is negative: " + exact_text(*metadata.weld));
  }
  if (metadata.label && metadata.threshold) {
    throw InvalidOption("the metadata have a label and a threshold; a solid is selected by one of them");
  }
  if (metadata.grid) validate(*metadata.grid);
}

MedialFile read_by_format(const volume_io::ByteSource& source, MedialFormat format) {
  return format == MedialFormat::vtp ? medial_files::read_vtp(source) : medial_files::read_npz(source);
}

MedialFile read_by_format(std::string_view bytes, MedialFormat format, const std::string& name) {
  return format == MedialFormat::ply   ? medial_files::read_ply(bytes, name)
         : format == MedialFormat::obj ? medial_files::read_obj(bytes, name)
                                       : medial_files::read_ma(bytes, name);
}

/// Formats whose arrays are read one by one, from where they are.
bool is_read_in_parts(MedialFormat format) {
  return format == MedialFormat::vtp || format == MedialFormat::npz;
}

/// Reads, and looks at the result as a whole.
template <class Read>
MedialFile checked(const std::string& name, Read read) {
  try {
    MedialFile file = read();
    file.complex.sheet_count = medial_files::sheet_count(file.complex);
    std::string problem = medial_files::problem_of(file.complex);
    if (problem.empty() && file.nested) problem = medial_files::problem_of(*file.nested);
    if (!problem.empty()) throw FormatError(name + ": " + problem);
    return file;
  } catch (const std::bad_alloc&) {
    throw OutOfMemory("not enough memory to read '" + name + "'");
  }
}

}  // namespace

namespace {

void write(const std::filesystem::path& path, const MedialComplex& complex, const NestedComplex* nested,
           const MedialMetadata& metadata, const Context& context) {
  const MedialFormat format = format_of(path);
  check_metadata(metadata);
  if (nested != nullptr && format != MedialFormat::npz) {
    throw InvalidOption("'" + path.string() + "': axes of all angles are kept in .npz files only");
  }
  std::string problem = medial_files::problem_of(complex);
  if (problem.empty() && nested != nullptr) problem = medial_files::problem_of(*nested);
  if (!problem.empty()) throw InvalidMesh("a medial axis that cannot be written: " + problem);
  throw_if_cancelled(context);
  switch (format) {
    case MedialFormat::vtp:
      return medial_files::write_vtp(path, complex, metadata, context);
    case MedialFormat::ply:
      return medial_files::write_ply(path, complex, metadata, context);
    case MedialFormat::obj:
      return medial_files::write_obj(path, complex, context);
    case MedialFormat::ma:
      return medial_files::write_ma(path, complex, context);
    case MedialFormat::npz:
      return medial_files::write_npz(path, complex, nested, metadata, context);
  }
}

}  // namespace

void write_medial(const std::filesystem::path& path, const MedialComplex& complex, const MedialMetadata& metadata,
                  const Context& context) {
  write(path, complex, nullptr, metadata, context);
}

void write_medial(const std::filesystem::path& path, const MedialComplex& complex, const NestedComplex& nested,
                  const MedialMetadata& metadata, const Context& context) {
  write(path, complex, &nested, metadata, context);
}

MedialFile read_medial(const std::filesystem::path& path) {
  const MedialFormat format = format_of(path);
  return checked(path.string(), [&] {
    if (is_read_in_parts(format)) return read_by_format(volume_io::FileSource(path), format);
    const FileBytes content = read_whole_file(path);
    const auto bytes = content.span();
    return read_by_format({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, format, path.string());
  });
}

MedialFile read_medial(std::span<const std::byte> bytes, MedialFormat format, const std::string& name) {
  return checked(name, [&] {
    if (is_read_in_parts(format)) return read_by_format(volume_io::MemorySource(bytes, name), format);
    return read_by_format({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, format, name);
  });
}

}  // namespace blum
