#include "common/options.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <system_error>

#include "common/summary.hpp"

namespace blum::cli {
namespace {

constexpr const char* exact_weld = "exact";

std::string quoted(std::string_view text) {
  return "'" + std::string(text) + "'";
}

[[noreturn]] void refuse(std::string_view name, std::string_view text, std::string_view reason) {
  throw UsageError(std::string(name) + " " + quoted(text) + ": " + std::string(reason));
}

std::string_view without_plus(std::string_view text) {
  return text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+' ? text.substr(1) : text;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

/// Returns the number of single-character insertions, removals and replacements between two words.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

double parse_number(std::string_view name, std::string_view text) {
  const std::string_view digits = without_plus(text);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) refuse(name, text, "the number is too large or too small");
  if (error != std::errc{} || end != digits.data() + digits.size()) refuse(name, text, "is not a number");
  if (!std::isfinite(value)) refuse(name, text, "must be a finite number");
  return value;
}

double parse_positive(std::string_view name, std::string_view text) {
  const double value = parse_number(name, text);
  if (!(value > 0)) refuse(name, text, "must be above 0");
  return value;
}

double parse_non_negative(std::string_view name, std::string_view text) {
  const double value = parse_number(name, text);
  if (!(value >= 0)) refuse(name, text, "must not be negative");
  return value;
}

double parse_angle(std::string_view name, std::string_view text) {
  const double value = parse_non_negative(name, text);
  if (value <= 180) return value;
  throw UsageError(std::string(name) + " is " + rounded_text(value) + " degrees, but must be 0 to 180");
}

namespace {

/// Parses a text like 1e6 or 2.5e3 as an integer. It must be one that a double represents exactly.
std::optional<std::int64_t> scientific_integer(std::string_view digits) {
  constexpr double largest_exact = 9007199254740992;  // 2^53
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_exponential = digits.find_first_of("eE") != std::string_view::npos;
  if (error != std::errc() || end != digits.data() + digits.size() || !is_exponential) return std::nullopt;
  if (!(std::abs(value) <= largest_exact) || value != std::trunc(value)) return std::nullopt;
  return static_cast<std::int64_t>(value);
}

}  // namespace

std::int64_t parse_integer(std::string_view name, std::string_view text, std::int64_t minimum, std::int64_t maximum) {
  const std::string_view digits = without_plus(text);
  if (const std::optional<std::int64_t> given = scientific_integer(digits)) {
    return parse_integer(name, std::to_string(*given), minimum, maximum);
  }
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size();
  if (!whole || error == std::errc::invalid_argument) refuse(name, text, "is not a whole number");
  if (error == std::errc::result_out_of_range || value < minimum || value > maximum) {
    refuse(name, text, "must be between " + std::to_string(minimum) + " and " + std::to_string(maximum));
  }
  return value;
}

bool looks_like_number(std::string_view text) {
  const std::string_view digits = without_plus(text);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return error != std::errc::invalid_argument && end == digits.data() + digits.size();
}

Box3 parse_bounds(std::string_view name, std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != 6) refuse(name, text, "needs six numbers x0,y0,z0,x1,y1,z1");
  std::array<double, 6> n{};
  for (std::size_t i = 0; i < 6; ++i) n[i] = parse_number(name, parts[i]);
  const Box3 box{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
  if (box.is_empty()) refuse(name, text, "the first corner must not lie above the second on any axis");
  if (box.lower == box.upper) refuse(name, text, "is a single point; at least one side must be longer than 0");
  return box;
}

std::vector<std::int64_t> parse_labels(std::string_view name, const std::vector<std::string>& texts) {
  std::vector<std::int64_t> labels;
  for (const std::string& text : texts) {
    for (const std::string_view part : split(text, ',')) {
      const std::int64_t label =
          parse_integer(name, part, std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max());
      if (std::find(labels.begin(), labels.end(), label) != labels.end()) refuse(name, part, "is given twice");
      labels.push_back(label);
    }
  }
  return labels;
}

void prepare_weld(std::vector<std::string>& arguments) {
  for (auto at = arguments.begin(); at != arguments.end() && *at != "--"; ++at) {
    if (*at != "--weld") continue;
    const auto next = at + 1;
    if (next == arguments.end() || !(*next == exact_weld || looks_like_number(*next))) {
      at = arguments.insert(next, exact_weld);
    }
  }
}

std::optional<double> parse_weld(const std::optional<std::string>& text) {
  if (!text) return std::nullopt;
  return *text == exact_weld ? 0.0 : parse_non_negative("--weld", *text);
}

int parse_threads(const std::optional<std::string>& text) {
  return text ? static_cast<int>(parse_integer("--threads", *text, 0, 1024)) : 0;
}

std::vector<std::string> similar_words(std::string_view word, const std::vector<std::string>& candidates) {
  std::vector<std::pair<std::size_t, std::string>> found;
  for (const std::string& candidate : candidates) {
    const bool part = word.size() >= 3 && candidate.find(word) != std::string::npos;
    const std::size_t edits = part ? 1 : edit_distance(word, candidate);
    if (edits <= (word.size() + 2) / 3) found.emplace_back(edits, candidate);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> words;
  for (auto& [edits, candidate] : found) words.push_back(std::move(candidate));
  return words;
}

std::string hint(const std::vector<std::string>& words) {
  return words.empty() ? std::string() : " (did you mean " + join_words(words, "or") + "?)";
}

std::string join_words(const std::vector<std::string>& words, std::string_view last) {
  return blum::join_words(std::vector<std::string_view>(words.begin(), words.end()), last);
}

void check_spacing(double spacing, const Box3& box) {
  constexpr double most = 1099511627776.0;
  const Vec3d size = box.size();
  const double nodes = (size.x / spacing + 1) * (size.y / spacing + 1) * (size.z / spacing + 1);
  if (box.is_empty() || nodes <= most) return;
  throw UsageError("--spacing " + rounded_text(spacing) + " is too small for a box of size " + vector_text(size) +
                   ": the grid would have more than 2^40 nodes; increase --spacing");
}

void refuse_given(const std::vector<std::pair<bool, const char*>>& given, const std::filesystem::path& input,
                  const char* kind, const char* applies_to) {
  for (const auto& [is_given, name] : given) {
    if (is_given) {
      throw UsageError(std::string(name) + " is for " + applies_to + ", but '" + input.string() + "' is " + kind);
    }
  }
}

}  // namespace blum::cli
