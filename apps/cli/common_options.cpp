#include "common_options.hpp"

namespace blum::cli {

void add_text_option(CLI::App& command, const char* name, std::optional<std::string>& value, const char* type,
                     const char* help) {
  command.add_option(name, value, help)->type_name(type);
}

void add_label_option(CLI::App& command, std::vector<std::string>& labels, const char* help) {
  command.add_option("--label", labels, help)->type_name("L")->allow_extra_args(false);
}

void add_weld_option(CLI::App& command, std::optional<std::string>& weld, const char* help) {
  add_text_option(command, "--weld", weld, "[TOL]", help);
}

void add_threads_option(CLI::App& command, std::optional<std::string>& threads) {
  add_text_option(command, "--threads", threads, "T", "Number of threads; 0, the default: one per core");
}

void add_device_option(CLI::App& command, std::optional<std::string>& device) {
  add_text_option(command, "--device", device, "DEV",
                  "Where distances are computed: cpu, auto, cuda or cuda:K (default cpu)");
}

void add_report_options(CLI::App& command, ReportOptions& report, const char* json_help) {
  add_text_option(command, "--json", report.json, "FILE", json_help);
  command.add_flag("--quiet", report.quiet, "Say nothing but errors");
}

}  // namespace blum::cli
