#include "common/described.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "blum/core/exact_text.hpp"
#include "common/options.hpp"

namespace blum::cli {

Json to_json(const std::vector<PhaseTime>& phases) {
  Json json = Json::object();
  for (const PhaseTime& phase : phases) {
    const double before = json.contains(phase.phase) ? json[phase.phase].number() : 0.0;
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

namespace {

/// Returns the help of an option, in the form "The doc (in unit; default x)".
std::string option_help(std::string_view prefix, std::string_view doc, std::string_view unit,
                        std::string_view fallback) {
  std::string text(doc);
  if (prefix.empty() && !text.empty()) {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  }
  text = std::string(prefix) + text;
  std::string note = unit.empty() ? std::string() : "in " + std::string(unit);
  if (!fallback.empty()) note += (note.empty() ? "" : "; ") + std::string(fallback);
  return note.empty() ? text : text + " (" + note + ")";
}

std::string type_text(std::string_view member) {
  std::string text = option_name(member).substr(2);
  for (char& letter : text) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return text;
}

/// Returns the help of a flag that turns an option off. `doc` states what the option does, often after "true: ".
std::string text_of_off(std::string_view doc) {
  constexpr std::string_view on = "true: ";
  return doc.starts_with(on) ? "turn this off: " + std::string(doc.substr(on.size())) : "without " + std::string(doc);
}

}  // namespace

void OptionTable::add_to(const Command& command, std::string_view prefix,
                         std::initializer_list<std::string_view> left_out, bool in_steps) {
  for (const OptionMember& member : members_) {
    if (std::find(left_out.begin(), left_out.end(), member.name) != left_out.end()) continue;
    const std::string name = option_name(member.name);
    const auto set = [this, key = std::string(member.name)](const std::string& text) { texts_[key] = text; };
    if (member.is_flag) {
      command.add_flag_function(
          member.is_on ? "--no-" + name.substr(2) : name, [set] { set(""); },
          option_help(prefix, member.is_on ? text_of_off(member.doc) : std::string(member.doc), member.unit, {}));
      continue;
    }
    std::string unit(member.unit);
    if (in_steps && unit == "mesh units") unit += ", or in grid steps as in 3v";
    command.add_option_function(name, set, option_help(prefix, member.doc, unit, member.fallback))
        .type_name(type_text(member.name));
  }
}

std::vector<std::string> OptionTable::given() const {
  std::vector<std::string> names;
  for (const OptionMember& member : members_) {
    if (has(member.name)) names.push_back(option_name(member.name));
  }
  return names;
}

const std::string* OptionTable::text_of(std::string_view member) const {
  const auto found = texts_.find(member);
  return found == texts_.end() ? nullptr : &found->second;
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
  constexpr double widest = 1e9;  // used if the description has no range
  return parse_integer(option, text, static_cast<std::int64_t>(std::isfinite(range.least) ? range.least : -widest),
                       static_cast<std::int64_t>(std::isfinite(range.most) ? range.most : widest));
}

double length_in(const std::string& option, const std::string& text, const Range& range, std::optional<double> step) {
  const bool in_steps = step && !text.empty() && (text.back() == 'v' || text.back() == 'V');
  if (!in_steps) return number_in(option, text, range);
  const std::string count = text.substr(0, text.size() - 1);
  if (!looks_like_number(count))
    throw UsageError(option + " '" + text + "': must be a number of grid steps followed by v, for example 3v");
  return number_in(option, count, range) * *step;
}

}  // namespace blum::cli
