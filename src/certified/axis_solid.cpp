#include "blum/certified/axis_solid.hpp"

#include "blum/core/exact_text.hpp"

namespace blum {
namespace {

/// @param value  empty for an option without a value.
std::string option_text(OptionStyle style, const std::string& name, const std::string& value) {
  if (style == OptionStyle::python) return name + "=" + value;
  return "--" + name + (value.empty() ? "" : " ") + value;
}

/// Returns the text of the option that the selection sets and that applies to this kind of input; empty if none is set.
std::string selection_text(const SolidSelection& selection, bool is_image, OptionStyle style) {
  if (is_image && selection.label) return option_text(style, "label", std::to_string(*selection.label));
  if (is_image && selection.threshold) return option_text(style, "threshold", rounded_text(*selection.threshold));
  if (is_image || !selection.weld) return {};
  const bool is_bare = *selection.weld == 0 && style == OptionStyle::command_line;
  return option_text(style, "weld", is_bare ? "" : rounded_text(*selection.weld));
}

bool is_same(const SolidSelection& a, const SolidSelection& b, bool is_image) {
  return is_image ? a.label == b.label && a.threshold == b.threshold : a.weld == b.weld;
}

}  // namespace

AxisSolid solid_of_axis(const SolidSelection& given, bool is_image, const MedialMetadata& metadata,
                        const std::string& axis, OptionStyle style) {
  const SolidSelection recorded{metadata.label, metadata.threshold, metadata.weld};
  const std::string given_text = selection_text(given, is_image, style);
  if (given_text.empty()) return {recorded, {}};
  const std::string recorded_text = selection_text(recorded, is_image, style);
  if (recorded_text.empty() || is_same(given, recorded, is_image)) return {given, {}};
  return {given,
          {{WarningCode::other_solid,
            axis + " was computed with " + recorded_text + "; " + given_text + " is used, because it was given"}}};
}

}  // namespace blum
