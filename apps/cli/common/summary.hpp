// Blum: summaries of commands, as text and as JSON. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/plural.hpp"
#include "blum/core/vec3.hpp"
#include "blum/core/warning.hpp"
#include "blum/field/field.hpp"
#include "blum/grid/grid_spec.hpp"
#include "common/described.hpp"

namespace blum::cli {

/// Measures seconds since its construction or the last lap().
class Stopwatch {
 public:
  [[nodiscard]] double lap() {
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - std::exchange(last_, now)).count();
    return seconds;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

/// Returns a number of bytes as text, for example "1.5 GiB".
[[nodiscard]] std::string bytes_text(double bytes);
[[nodiscard]] std::string vector_text(const Vec3d& v);
/// Returns a point as text. `size` is the size of the scene in mesh units. Coordinates within its rounding error are
/// printed as 0.
[[nodiscard]] std::string point_text(const Vec3d& point, double size);
/// Returns a length as text. From a thousandth of the size of a shape on, adds the share: "23 (7.5 % of the size)".
/// @param size  diagonal of the shape's box, in the unit of the length; 0 if it is unknown.
/// @param unit  text that follows the length.
[[nodiscard]] std::string share_text(double length, double size, std::string_view unit = {});
/// Returns the range of the distances in a field as text.
[[nodiscard]] std::string node_range_text(double smallest, double largest, bool is_signed);
/// Returns a text like "by normals, because the mesh is closed". `reason` may be empty.
[[nodiscard]] std::string sign_text(SignRule rule, const std::string& reason);
[[nodiscard]] std::string size_text(const GridSpec& grid);
/// Returns a text like "1 % below 0.2, 5 % below 0.3".
[[nodiscard]] std::string percentiles_text(std::span<const double> percents, std::span<const double> values);

/// Text with two columns, label and content. Rows added as details are shown only with --verbose.
class TextTable {
 public:
  void add(std::string label, std::string content) { rows_.push_back({std::move(label), std::move(content), false}); }
  void detail(std::string label, std::string content) { rows_.push_back({std::move(label), std::move(content), true}); }
  void add(const TextTable& other) { rows_.insert(rows_.end(), other.rows_.begin(), other.rows_.end()); }
  [[nodiscard]] std::string text(bool verbose = false) const;

 private:
  struct Row {
    std::string label, content;
    bool is_detail = false;
  };
  std::vector<Row> rows_;
};

/// Durations of the phases of a run. Durations of phases with the same name are added.
struct PhaseSummary {
  Json seconds = Json::object();  ///< seconds of each phase
  double total = 0;
  std::string text;    ///< total, for example "1.5 s"
  std::string phases;  ///< seconds of each phase, for example "read 0.5, write 1"

  /// Adds a row with the total duration and the peak memory, and the phases as a detail.
  void add_to(TextTable& table) const;
};
[[nodiscard]] PhaseSummary summarize(const std::vector<PhaseTime>& phases);

/// Returns the peak memory of the process, in bytes.
[[nodiscard]] std::uint64_t peak_memory();

/// Returns the JSON of a command's result: the version of Blum, the command, and the given facts.
[[nodiscard]] Json answer_json(std::string_view command, const Json& facts);

/// Adds the last members of the JSON: durations, peak memory, threads, warnings and written files.
void add_run_facts(Json& answer, const PhaseSummary& spent, const Context& context,
                   const std::vector<Warning>& warnings, const Json& outputs);

/// Destinations of a command's summary.
struct ReportOptions {
  std::optional<std::string> json;  ///< path of a file, or "-" for stdout
  bool quiet = false;
  bool verbose = false;  ///< if true, the details of the summary are printed, too
  [[nodiscard]] bool json_to_stdout() const { return json && *json == "-"; }
  /// Returns the path of the JSON file, so that it is checked like other outputs. Returns none if no JSON file is
  /// written.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;
};

/// Writes the JSON if it is requested. Prints the text to stdout, unless `quiet` is set or the JSON is written to
/// stdout.
/// @throws FileError.
void report(const ReportOptions& options, const Json& json, const std::string& text);
void report(const ReportOptions& options, const Json& json, const TextTable& table);

/// Writes each warning to stderr, as a line "blum: warning: ...".
void warn(const std::vector<Warning>& warnings);
/// Writes a warning that is not stored with a result.
void warn_of(const std::string& text);

/// @throws FileError if writing to stdout fails.
void print(std::string_view text);

}  // namespace blum::cli
