#include "common/common_options.hpp"

namespace blum::cli {

void add_text_option(const Command& command, const char* name, std::optional<std::string>& value, const char* type,
                     const std::string& help) {
  command.add_option(name, value, help).type_name(type);
}

void add_label_option(const Command& command, std::vector<std::string>& labels, const char* help) {
  command.add_option("--label", labels, help).type_name("L").one_value_each();
}

void add_weld_option(const Command& command, std::optional<std::string>& weld, const char* help) {
  add_text_option(command, "--weld", weld, "[TOL]", help);
}

void add_threads_option(const Command& command, std::optional<std::string>& threads) {
  add_text_option(command, "--threads", threads, "T", "Number of threads, 0 to 1024 (default 0: one per core)");
}

void add_device_option(const Command& command, std::optional<std::string>& device) {
  add_text_option(command, "--device", device, "DEV",
                  "Device that computes distances: cpu, auto, cuda, or cuda:K for device number K (default cpu)");
}

void add_report_options(const Command& command, ReportOptions& report, const char* json_help) {
  add_text_option(command, "--json", report.json, "FILE", json_help);
  command.add_flag("--quiet", report.quiet, "Print errors only");
  command.add_flag("--verbose", report.verbose, "Print all details of the summary");
}

}  // namespace blum::cli
