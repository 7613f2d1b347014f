#include "blum/io/formats.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <sstream>

#include "blum/core/error.hpp"
#include "io/format_table.hpp"
#include "io/text/text_scan.hpp"

namespace blum {
namespace {

std::vector<std::string> words_of(std::string_view words) {
  std::istringstream stream{std::string(words)};
  return {std::istream_iterator<std::string>(stream), {}};
}

/// The first row of a content that fits.
template <class Fits>
std::optional<std::size_t> find(FileContent content, Fits fits) {
  const std::vector<FileFormat>& formats = file_formats();
  for (std::size_t row = 0; row < formats.size(); ++row) {
    if (formats[row].content == content && fits(row)) return row;
  }
  return std::nullopt;
}

bool has(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool allows(const FileFormat& format, const std::string& extension, FileAccess access) {
  return (access == FileAccess::write || has(format.extensions, extension)) &&
         (access == FileAccess::read || has(format.written, extension));
}

std::optional<std::size_t> find_extension(FileContent content, const std::string& extension, FileAccess access) {
  return find(content, [&](std::size_t row) { return allows(file_formats()[row], extension, access); });
}

std::size_t find_named(FileContent content, std::string_view name) {
  const std::string word = volume_io::lower_case(name);
  auto row = find(content, [&](std::size_t k) { return volume_io::lower_case(file_formats()[k].name) == word; });
  for (const FileAccess access : {FileAccess::read, FileAccess::write}) {
    if (!row) row = find_extension(content, word.starts_with('.') ? word : "." + word, access);
  }
  if (row) return *row;
  std::string known;
  for (const FileFormat& format : file_formats()) {
    if (format.content == content) known += (known.empty() ? "" : ", ") + format.name;
  }
  throw InvalidOption("there is no format '" + std::string(name) + "' of files of this content (" +
                      std::string(to_string(content)) + "); the formats are " + known);
}

std::optional<std::size_t> find_head(FileContent content, std::string_view head) {
  const auto fits = [&](std::size_t row) {
    const auto begins_as = formats::tells_of(row).begins;
    return begins_as != nullptr && begins_as(head);
  };
  // PLY and OFF files may have lines that look like those of OBJ.
  const auto found = find(content, [&](std::size_t row) { return file_formats()[row].name != "OBJ" && fits(row); });
  return found ? found : find(content, fits);
}

}  // namespace

const std::vector<FileFormat>& file_formats() {
  static const std::vector<FileFormat> all = [] {
    std::vector<FileFormat> out;
    for (const formats::Row& row : formats::table) {
      out.push_back({row.content, std::string(row.name), words_of(row.extensions), words_of(row.written),
                     std::string(row.holds), std::string(row.opens_in)});
    }
    return out;
  }();
  return all;
}

template <FileContent content>
FormatOf<content>::FormatOf(std::string_view name) : row_(find_named(content, name)) {}

template <FileContent content>
std::optional<FormatOf<content>> FormatOf<content>::by_name(const std::filesystem::path& path) {
  const auto row = find_extension(content, file_extension(path), FileAccess::read);
  return row ? std::optional(FormatOf(*row)) : std::nullopt;
}

template <FileContent content>
std::optional<FormatOf<content>> FormatOf<content>::by_head(std::string_view head) {
  const auto row = find_head(content, head);
  return row ? std::optional(FormatOf(*row)) : std::nullopt;
}

template <FileContent content>
FormatOf<content> FormatOf<content>::of(const std::filesystem::path& path, FileAccess access, std::string_view what) {
  if (const auto row = find_extension(content, file_extension(path), access)) return FormatOf(*row);
  constexpr std::array<std::string_view, 11> plural{
      "meshes", "images",      "fields",       "complexes, medial axes among them,",
      "points", "close pairs", "collisions",   "surface maps",
      "graphs", "centrelines", "extended axes"};
  static_assert(plural.size() == Description<FileContent>::values.size());
  if (what.empty()) what = plural[static_cast<std::size_t>(content)];
  throw InvalidOption("'" + path.string() + "': " + std::string(what) + " are " +
                      (access == FileAccess::read    ? "read from "
                       : access == FileAccess::write ? "written to "
                                                     : "written to and read from ") +
                      extension_list(content, access, ", ") + " files; use one of these extensions");
}

template class FormatOf<FileContent::mesh>;
template class FormatOf<FileContent::image>;
template class FormatOf<FileContent::field>;
template class FormatOf<FileContent::complex>;
template class FormatOf<FileContent::points>;
template class FormatOf<FileContent::pairs>;
template class FormatOf<FileContent::collisions>;
template class FormatOf<FileContent::surface_map>;
template class FormatOf<FileContent::graph>;
template class FormatOf<FileContent::centreline>;
template class FormatOf<FileContent::extended_axis>;

std::string file_extension(const std::filesystem::path& path) {
  std::string last = volume_io::lower_case(path.extension().string());
  if (last != ".gz") return last;
  const std::string inner = volume_io::lower_case(path.stem().extension().string());
  return inner == ".nii" || inner == ".hdr" || inner == ".img" ? inner + last : last;
}

std::vector<std::string> file_extensions(FileContent content, FileAccess access) {
  std::vector<std::string> out;
  for (const FileFormat& format : file_formats()) {
    if (format.content != content) continue;
    for (const std::string& extension : access == FileAccess::read ? format.extensions : format.written) {
      if (allows(format, extension, access)) out.push_back(extension);
    }
  }
  return out;
}

std::string extension_list(FileContent content, FileAccess access, std::string_view between) {
  std::string out;
  for (const std::string& extension : file_extensions(content, access)) {
    if (!out.empty()) out += between;
    out += extension;
  }
  return out;
}

}  // namespace blum
