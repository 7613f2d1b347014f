#include "described.hpp"

#include <cctype>
#include <cmath>

#include "blum/core/exact_text.hpp"
#include "options.hpp"

namespace blum::cli {

Json to_json(const std::vector<PhaseTime>& phases) {
  Json json = Json::object();
  for (const PhaseTime& phase : phases) {
    const double before = json.contains(phase.phase) ? json[phase.phase].get<double>() : 0.0;
    json[phase.phase] = before + phase.seconds;
  }
  return json;
}

Json to_json(const Vec3d& v) {
  return Json::array({v.x, v.y, v.z});
}

Json to_json(const Box3& box) {
  if (box.is_empty()) return nullptr;
  return {{"lower", to_json(box.lower)}, {"upper", to_json(box.upper)}};
}

Json to_json(const Mat3& columns) {
  return Json::array({to_json(columns.columns[0]), to_json(columns.columns[1]), to_json(columns.columns[2])});
}

std::string option_name(std::string_view member) {
  std::string name = "--" + std::string(member);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

std::string option_help(std::string_view prefix, std::string_view doc, std::string_view unit,
                        std::string_view fallback) {
  std::string text(doc);
  if (prefix.empty() && !text.empty()) {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  }
  text = std::string(prefix) + text;
  if (!unit.empty()) text += ", in " + std::string(unit);
  if (!fallback.empty()) text += " (" + std::string(fallback) + ")";
  return text;
}

double number_in(const std::string& option, const std::string& text, const Range& range) {
  if (range.least == 0 && range.above) return parse_positive(option, text);
  if (range.least == 0 && std::isinf(range.most)) return parse_non_negative(option, text);
  const double value = parse_number(option, text);
  if (value >= range.least && value <= range.most && !(range.above && value == range.least)) return value;
  throw UsageError(option + " '" + text + "': must be between " + rounded_text(range.least) + " and " +
                   rounded_text(range.most));
}

std::int64_t integer_in(const std::string& option, const std::string& text, const Range& range) {
  constexpr double widest = 1e9;  // where nothing else is said
  return parse_integer(option, text, static_cast<std::int64_t>(std::isfinite(range.least) ? range.least : -widest),
                       static_cast<std::int64_t>(std::isfinite(range.most) ? range.most : widest));
}

double length_in(const std::string& option, const std::string& text, const Range& range, std::optional<double> step) {
  const bool in_steps = step && !text.empty() && (text.back() == 'v' || text.back() == 'V');
  if (!in_steps) return number_in(option, text, range);
  const std::string count = text.substr(0, text.size() - 1);
  if (!looks_like_number(count)) throw UsageError(option + " '" + text + "': is not a number of voxels, such as 3v");
  return number_in(option, count, range) * *step;
}

}  // namespace blum::cli
