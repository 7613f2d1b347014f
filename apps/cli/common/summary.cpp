#include "common/summary.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/io/atomic_file.hpp"
#include "common/options.hpp"

namespace blum::cli {

std::string bytes_text(double bytes) {
  constexpr std::array<std::string_view, 7> units = {"bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  std::size_t unit = 0;
  while (bytes >= 1024 && unit + 1 < units.size()) {
    bytes /= 1024;
    ++unit;
  }
  std::array<char, 32> text{};
  const auto result =
      std::to_chars(text.data(), text.data() + text.size(), bytes, std::chars_format::fixed, unit == 0 ? 0 : 1);
  return std::string(text.data(), result.ptr) + " " + std::string(units[unit]);
}

std::string vector_text(const Vec3d& v) {
  return "(" + rounded_text(v.x) + ", " + rounded_text(v.y) + ", " + rounded_text(v.z) + ")";
}

std::string size_text(const GridSpec& grid) {
  return std::to_string(grid.size[0]) + " x " + std::to_string(grid.size[1]) + " x " + std::to_string(grid.size[2]);
}

std::string percentiles_text(std::span<const double> percents, std::span<const double> values) {
  std::string out;
  for (std::size_t k = 0; k < values.size(); ++k) {
    out += (k == 0 ? "" : ", ") + rounded_text(percents[k]) + " % below " + rounded_text(values[k]);
  }
  return out;
}

std::string TextTable::text(bool verbose) const {
  const auto is_shown = [&](const Row& row) { return verbose || !row.is_detail; };
  std::size_t width = 0;
  for (const Row& row : rows_) {
    if (is_shown(row)) width = std::max(width, row.label.size());
  }
  std::string text;
  for (const Row& row : rows_) {
    if (is_shown(row)) text += row.label + std::string(width - row.label.size() + 2, ' ') + row.content + "\n";
  }
  return text;
}

void PhaseSummary::add_to(TextTable& table) const {
  table.add("time", text + ", peak memory " + bytes_text(static_cast<double>(peak_memory())));
  if (!phases.empty()) table.detail("phases", phases + " (seconds)");
}

std::uint64_t peak_memory() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::vector<std::filesystem::path> ReportOptions::files() const {
  if (!json || json_to_stdout()) return {};
  if (json->empty()) throw UsageError("--json needs a file name, or - for standard output");
  return {*json};
}

Json answer_json(std::string_view command, const Json& facts) {
  Json json = {{"blum_version", BLUM_VERSION}, {"command", command}};
  json.update(facts);
  return json;
}

void add_run_facts(Json& answer, const PhaseSummary& spent, const Context& context,
                   const std::vector<Warning>& warnings, const Json& outputs) {
  answer["seconds"] = spent.seconds;
  answer["total_seconds"] = spent.total;
  answer["peak_memory_bytes"] = peak_memory();
  answer["threads"] = thread_count(context);
  answer["warnings"] = to_json(warnings);
  answer["outputs"] = outputs;
}

void report(const ReportOptions& options, const Json& json, const std::string& text) {
  if (options.json) {
    // File names may contain invalid UTF-8, which dump() replaces.
    const std::string dump = json.dump(2) + "\n";
    if (options.json_to_stdout()) {
      print(dump);
    } else {
      AtomicFile file(*options.json);
      file.write(dump);
      file.commit();
    }
  }
  if (!options.quiet && !options.json_to_stdout()) print(text);
}

void report(const ReportOptions& options, const Json& json, const TextTable& table) {
  report(options, json, table.text(options.verbose));
}

void warn(const std::vector<Warning>& warnings) {
  for (const Warning& warning : warnings) warn_of(warning.text);
}

void warn_of(const std::string& text) {
  std::fflush(stdout);
  std::fprintf(stderr, "blum: warning: %s\n", text.c_str());
}

void print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw FileError("standard output cannot be written");
  }
}

PhaseSummary summarize(const std::vector<PhaseTime>& phases) {
  PhaseSummary out;
  out.seconds = to_json(phases);
  for (const PhaseTime& phase : phases) out.total += phase.seconds;
  const auto rounded = [](double seconds) { return rounded_text(std::round(seconds * 1e3) / 1e3); };
  for (const auto& [phase, seconds] : out.seconds.members()) {
    out.phases += (out.phases.empty() ? "" : ", ") + phase + " " + rounded(seconds.number());
  }
  out.text = rounded(out.total) + " s";
  return out;
}

std::string node_range_text(double smallest, double largest, bool is_signed) {
  return rounded_text(smallest) + " to " + rounded_text(largest) + " at the nodes" +
         (is_signed ? ", negative inside" : "");
}

std::string sign_text(SignRule rule, const std::string& reason) {
  const auto with_reason = [&](const char* name, const char* link) {
    return reason.empty() ? std::string(name) : name + (link + reason);
  };
  switch (rule) {
    case SignRule::none:
      return with_reason("none", ", because ");
    case SignRule::normals:
      return with_reason("by normals", ", because ");
    case SignRule::winding:
      return with_reason("by winding numbers", ", because ");
    // For these rules, the reason is a definition of the inside.
    case SignRule::label:
      return with_reason("by voxel values", ": ");
    case SignRule::balls:
      return with_reason("by balls", ": ");
  }
  return reason;
}

std::string point_text(const Vec3d& point, double size) {
  constexpr double rounding = 1e-14;
  Vec3d shown;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    shown[axis] = std::abs(point[axis]) <= rounding * size ? 0 : point[axis];
  }
  return vector_text(shown);
}

std::string share_text(double length, double size, std::string_view unit) {
  constexpr double least_share = 0.001;
  const double share = length / size;
  std::string text = rounded_text(length) + std::string(unit);
  if (!(share >= least_share && std::isfinite(share))) return text;
  const double percent = 100 * share;
  const double shown = percent < 10 ? std::round(percent * 10) / 10 : std::round(percent);
  return text + " (" + rounded_text(shown) + " % of the size)";
}

}  // namespace blum::cli
