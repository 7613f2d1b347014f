// Blum: strict parsing of command-line values. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/core/vec3.hpp"

namespace blum::cli {

/// The command line is invalid: exit status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads a number with a point as decimal mark, whatever the locale. The number must fill the whole text. `name` is the
/// option's name in messages. All functions throw UsageError for text that is not a finite number or is out of range.
[[nodiscard]] double parse_number(std::string_view name, std::string_view text);
/// Parses a number, which must be above 0.
[[nodiscard]] double parse_positive(std::string_view name, std::string_view text);
/// Parses a number, which must be at least 0.
[[nodiscard]] double parse_non_negative(std::string_view name, std::string_view text);
/// Parses an angle from 0 to 180 degrees.
[[nodiscard]] double parse_angle(std::string_view name, std::string_view text);
[[nodiscard]] std::int64_t parse_integer(std::string_view name, std::string_view text, std::int64_t minimum,
                                         std::int64_t maximum);
/// Returns true if a text is a number in any form, including "nan" and "-1e999".
[[nodiscard]] bool looks_like_number(std::string_view text);

/// Parses `x0,y0,z0,x1,y1,z1` with x0 <= x1 and so on. The box must not be a single point.
[[nodiscard]] Box3 parse_bounds(std::string_view name, std::string_view text);

/// Parses labels. Each text consists of one integer, or of several separated by commas. No label may occur twice.
[[nodiscard]] std::vector<std::int64_t> parse_labels(std::string_view name, const std::vector<std::string>& texts);

/// Inserts the value `exact` after each `--weld` that is not followed by a number or `exact`.
void prepare_weld(std::vector<std::string>& arguments);
/// Returns the value of --weld: none if the option is not given, 0 for `exact`.
[[nodiscard]] std::optional<double> parse_weld(const std::optional<std::string>& text);

/// Returns the number of threads: 0 (one per core) if unset.
[[nodiscard]] int parse_threads(const std::optional<std::string>& text);

/// Returns the candidates that are most similar to a misspelt word, best first. About one edit is allowed for every
/// three letters.
[[nodiscard]] std::vector<std::string> similar_words(std::string_view word, const std::vector<std::string>& candidates);

/// Returns " (did you mean a or b?)", or an empty text if there are no words.
[[nodiscard]] std::string hint(const std::vector<std::string>& words);

/// Returns "a, b and c". `last` replaces "and".
[[nodiscard]] std::string join_words(const std::vector<std::string>& words, std::string_view last = "and");

/// @throws UsageError if a grid over the box with --spacing would have more than 2^40 nodes.
void check_spacing(double spacing, const Box3& box);

/// @throws UsageError if a given option does not apply to this kind of input.
void refuse_given(const std::vector<std::pair<bool, const char*>>& given, const std::filesystem::path& input,
                  const char* kind, const char* applies_to);

}  // namespace blum::cli
