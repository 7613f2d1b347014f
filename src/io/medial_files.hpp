// Blum: the formats of medial axes, one by one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "blum/io/medial_io.hpp"
#include "io/byte_source.hpp"
#include "io/field_metadata.hpp"

namespace blum::medial_files {

// The writers get a complex without problems (problem_of), and metadata without problems.
void write_vtp(const std::filesystem::path& path, const MedialComplex& complex, const MedialMetadata& metadata,
               const Context& context);
void write_ply(const std::filesystem::path& path, const MedialComplex& complex, const MedialMetadata& metadata,
               const Context& context);
void write_obj(const std::filesystem::path& path, const MedialComplex& complex, const Context& context);
void write_ma(const std::filesystem::path& path, const MedialComplex& complex, const Context& context);
/// @param nested  may be null.
void write_npz(const std::filesystem::path& path, const MedialComplex& complex, const NestedComplex* nested,
               const MedialMetadata& metadata, const Context& context);

// The readers check whatever they need to be safe; problem_of is asked afterwards. All throw FormatError.
[[nodiscard]] MedialFile read_vtp(const volume_io::ByteSource& source);
[[nodiscard]] MedialFile read_npz(const volume_io::ByteSource& source);
[[nodiscard]] MedialFile read_ply(std::string_view bytes, std::string_view name);
[[nodiscard]] MedialFile read_obj(std::string_view text, std::string_view name);
[[nodiscard]] MedialFile read_ma(std::string_view text, std::string_view name);

/// What is wrong with a complex, for messages; empty when nothing is: all vertices that are named exist, edges and
/// triangles name each only once, all numbers are finite, no radius is negative, sheets are numbered from 0 and no more
/// than there are triangles, and sites are none or fit a file.
[[nodiscard]] std::string problem_of(const MedialComplex& complex);

/// The same of a nested complex, whose edges are curves, rims and seams, and whose angles `from` and `until` are
/// numbers.
[[nodiscard]] std::string problem_of(const NestedComplex& nested);

/// One more than the largest sheet; 0 without triangles.
[[nodiscard]] std::uint32_t sheet_count(const MedialComplex& complex);

/// For files that do not say what their edges are: those that are sides of triangles go, as the triangles imply them;
/// those that stay are curves. Indices must be in range.
void keep_curves_only(MedialComplex& complex);

/// The number that files hold for a role is that of the enumerator.
/// @param fail  called with a message for another number; must throw.
template <class Fail>
[[nodiscard]] MedialRole role_from_file(std::int64_t number, const Fail& fail) {
  if (number < 0 || number > static_cast<std::int64_t>(MedialRole::junction)) {
    fail("role " + std::to_string(number) + " is not known; 0 to 4 are");
  }
  return static_cast<MedialRole>(number);
}
template <class Fail>
[[nodiscard]] SiteId site_from_file(std::int64_t number, const Fail& fail) {
  if (number < -1 || number > static_cast<std::int64_t>(max_id_count)) {
    fail("site " + std::to_string(number) + " is neither an index nor -1");
  }
  return number < 0 ? SiteId::none() : SiteId(static_cast<std::uint32_t>(number));
}
template <class Fail>
[[nodiscard]] std::uint32_t sheet_from_file(std::int64_t number, const Fail& fail) {
  if (number < 0 || number >= static_cast<std::int64_t>(max_id_count)) {
    fail("sheet " + std::to_string(number) + " is out of range");
  }
  return static_cast<std::uint32_t>(number);
}
/// Not finite when the number is too large; problem_of finds it.
[[nodiscard]] inline float angle_from_file(double number) {
  constexpr double most = std::numeric_limits<float>::max();
  return std::abs(number) > most ? std::numeric_limits<float>::infinity() : static_cast<float>(number);
}

[[nodiscard]] volume_io::Metadata to_pairs(const MedialMetadata& metadata);
/// Unknown keys are left alone. @throws FormatError with `name` when a known key has a value that it cannot have.
[[nodiscard]] MedialMetadata from_pairs(const volume_io::Metadata& pairs, const std::string& name);

}  // namespace blum::medial_files
