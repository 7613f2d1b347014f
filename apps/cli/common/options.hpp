// Blum: command-line values, read strictly. SPDX-License-Identifier: Apache-2.0
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

/// The command line asks for something that makes no sense: exit status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Numbers are read with a point as decimal mark whatever the locale, and must fill the whole text. `name` is what
/// messages call the option. All functions throw UsageError for text that is no number, is not finite or is out of
/// range.
[[nodiscard]] double parse_number(std::string_view name, std::string_view text);
/// > 0.
[[nodiscard]] double parse_positive(std::string_view name, std::string_view text);
/// >= 0.
[[nodiscard]] double parse_non_negative(std::string_view name, std::string_view text);
/// The same for angles: 0 to 180 degrees.
[[nodiscard]] double parse_angle(std::string_view name, std::string_view text);
[[nodiscard]] std::int64_t parse_integer(std::string_view name, std::string_view text, std::int64_t minimum,
                                         std::int64_t maximum);
/// Whether a text reads as a number of any kind, "nan" and "-1e999" included.
[[nodiscard]] bool looks_like_number(std::string_view text);

/// `x0,y0,z0,x1,y1,z1` with x0 <= x1 and so on; not a single point.
[[nodiscard]] Box3 parse_bounds(std::string_view name, std::string_view text);

/// Each entry is a whole number or several, separated by commas. No label may appear twice.
[[nodiscard]] std::vector<std::int64_t> parse_labels(std::string_view name, const std::vector<std::string>& texts);

/// `--weld` may stand without a value: gives it the value `exact` unless a number or `exact` follows.
void prepare_weld(std::vector<std::string>& arguments);
/// The value of --weld: unset when the option is not there, 0 for `exact`.
[[nodiscard]] std::optional<double> parse_weld(const std::optional<std::string>& text);

/// Threads: 0 (one per core) when unset.
[[nodiscard]] int parse_threads(const std::optional<std::string>& text);

/// The candidates that are closest to a misspelt word, best first: those within about a third of its length in edits.
[[nodiscard]] std::vector<std::string> similar_words(std::string_view word, const std::vector<std::string>& candidates);

/// " (did you mean a or b?)", or nothing where there are no words.
[[nodiscard]] std::string hint(const std::vector<std::string>& words);

/// "a, b and c"; "or" by `last`.
[[nodiscard]] std::string join_words(const std::vector<std::string>& words, std::string_view last = "and");

/// @throws UsageError where a box takes more than 2^40 steps of --spacing.
void check_spacing(double spacing, const Box3& box);

/// @throws UsageError for an option that is given but does not apply to this kind of input.
void refuse_given(const std::vector<std::pair<bool, const char*>>& given, const std::filesystem::path& input,
                  const char* kind, const char* applies_to);

}  // namespace blum::cli
