#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "blum/io/formats.hpp"
#include "commands.hpp"
#include "common_options.hpp"
#include "summary.hpp"

namespace blum::cli {
namespace {

constexpr const char* examples = R"(Examples:
  blum formats
  blum formats --json -                  the same for programs)";

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  return out;
}

/// "read and written", "read", or which of the extensions are written.
std::string access_text(const FileFormat& format) {
  if (format.written.empty()) return "read";
  if (format.written.size() == format.extensions.size()) return "read, written";
  return "read; " + joined(format.written) + " written";
}

Json to_json(const FileFormat& format) {
  return {{"content", to_string(format.content)},
          {"name", format.name},
          {"extensions", format.extensions},
          {"written", format.written},
          {"holds", format.holds},
          {"opens_in", format.opens_in}};
}

std::string table_text() {
  std::string text;
  for (const FileContent content : {FileContent::mesh, FileContent::image, FileContent::field, FileContent::complex}) {
    text += std::string(text.empty() ? "" : "\n") + std::string(to_string(content)) + "\n";
    TextTable table;
    for (const FileFormat& format : file_formats()) {
      if (format.content != content) continue;
      table.add("  " + joined(format.extensions),
                access_text(format) + ": " + format.holds + " (" + format.opens_in + ")");
    }
    text += table.text();
  }
  return text;
}

void run(const ReportOptions& options) {
  Json formats = Json::array();
  for (const FileFormat& format : file_formats()) formats.push_back(to_json(format));
  report(options, {{"blum_version", BLUM_VERSION}, {"command", "formats"}, {"formats", formats}}, table_text());
}

}  // namespace

void add_formats_command(const CommandLine& line) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = line.app.add_subcommand("formats", "The file formats that are read and written");
  add_report_options(*command, *options);
  command->footer(examples);
  command->callback([options] { run(*options); });
}

}  // namespace blum::cli
