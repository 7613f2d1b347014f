// Blum: what the commands say, as text and as JSON. SPDX-License-Identifier: Apache-2.0
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

/// Seconds since it was made or last asked.
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

/// "1.5 GiB".
[[nodiscard]] std::string bytes_text(double bytes);
[[nodiscard]] std::string vector_text(const Vec3d& v);
[[nodiscard]] std::string size_text(const GridSpec& grid);
/// "1 % below 0.2, 5 % below 0.3, ...".
[[nodiscard]] std::string percentiles_text(std::span<const double> percents, std::span<const double> values);

/// How long the phases of a run took; those of one name are added.
struct PhaseSummary {
  Json seconds = Json::object();  ///< by phase
  double total = 0;
  std::string text;  ///< "1.5 s (read 0.5, write 1)"
};
[[nodiscard]] PhaseSummary summarize(const std::vector<PhaseTime>& phases);

/// Lines of text in two columns, label and content.
class TextTable {
 public:
  void add(std::string label, std::string content) { rows_.emplace_back(std::move(label), std::move(content)); }
  void add(const TextTable& other) { rows_.insert(rows_.end(), other.rows_.begin(), other.rows_.end()); }
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::pair<std::string, std::string>> rows_;
};

/// Peak memory of the process in bytes.
[[nodiscard]] std::uint64_t peak_memory();

/// What a command answers as JSON: Blum's version, the command, then these facts.
[[nodiscard]] Json answer_json(std::string_view command, const Json& facts);

/// Adds what answers end with: how long the run took, its memory and threads, warnings, and the files written.
void add_run_facts(Json& answer, const PhaseSummary& spent, const Context& context,
                   const std::vector<Warning>& warnings, const Json& outputs);

/// Where a command's summary goes.
struct ReportOptions {
  std::optional<std::string> json;  ///< a file, or "-" for stdout
  bool quiet = false;
  [[nodiscard]] bool json_to_stdout() const { return json && *json == "-"; }
  /// The JSON file among the outputs, for checks; empty or one path.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;
};

/// Writes the JSON where it was asked for, and the text to stdout unless quiet or JSON goes there.
/// @throws FileError.
void report(const ReportOptions& options, const Json& json, const std::string& text);

/// Writes the text of each as a line "blum: warning: ..." to stderr.
void warn(const std::vector<Warning>& warnings);
/// Likewise what is no fact of a result.
void warn_of(const std::string& text);

/// @throws FileError when stdout does not take what is written to it.
void print(std::string_view text);

}  // namespace blum::cli
