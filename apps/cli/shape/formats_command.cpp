#include <memory>
#include <string>
#include <vector>

#include "blum/io/formats.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/described.hpp"
#include "common/summary.hpp"

namespace blum::cli {
namespace {

constexpr const char* examples = R"(Examples:
  blum formats
  blum formats --json -                  the same as JSON)";

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  return out;
}

/// Returns "read, written", "read" or "written". If only some extensions are written, returns for example "read; .ply
/// written".
std::string access_text(const FileFormat& format) {
  if (format.written.empty()) return "read";
  if (format.extensions.empty()) return "written";
  if (format.written.size() == format.extensions.size()) return "read, written";
  return "read; " + joined(format.written) + " written";
}

std::string table_text() {
  std::string text;
  for (const auto& content : Description<FileContent>::values) {
    text += (text.empty() ? "" : "\n") + std::string(content.name) + "\n";
    TextTable table;
    for (const FileFormat& format : file_formats()) {
      if (format.content != content.value) continue;
      table.add("  " + joined(format.extensions.empty() ? format.written : format.extensions),
                access_text(format) + ": " + format.holds + " (" + format.opens_in + ")");
    }
    text += table.text();
  }
  return text;
}

void run(const ReportOptions& options) {
  report(options, answer_json("formats", {{"formats", to_json(file_formats())}}), table_text());
}

}  // namespace

void add_formats_command(const CommandLine& line) {
  auto options = std::make_shared<ReportOptions>();
  const Command command = line.app.add_subcommand("formats", "List the file formats that Blum reads and writes");
  add_report_options(command, *options);
  command.footer(examples);
  command.callback([options] { run(*options); });
}

}  // namespace blum::cli
