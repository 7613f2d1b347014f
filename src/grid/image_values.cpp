#include "blum/grid/image_values.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <variant>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/plural.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/grid/voxel_topology.hpp"

namespace blum {
namespace {

constexpr std::size_t most_distinct = 100000;
constexpr double exact_integer_limit = 9007199254740992.0;  // 2^53
constexpr std::size_t most_named = 10;

/// Returns true if a value can be a label.
template <class T>
bool is_label(T value) {
  if constexpr (std::is_floating_point_v<T>) {
    return std::trunc(value) == value && std::abs(static_cast<double>(value)) <= exact_integer_limit;
  } else if constexpr (std::is_same_v<T, std::uint64_t>) {
    return value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  } else {
    return true;
  }
}

template <class T>
ImageValues counted(std::span<const T> values, const Context& context) {
  ImageValues out;
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  bool are_labels = true;
  std::unordered_map<std::int64_t, std::uint64_t> counts;
  std::size_t runs = 0;
  for (std::size_t i = 0; i < values.size();) {
    if (++runs % (std::size_t{1} << 20U) == 0) throw_if_cancelled(context);
    const T value = values[i];
    std::size_t end = i + 1;
    // In labelled images, equal values usually follow each other.
    while (end < values.size() && values[end] == value) ++end;
    const std::uint64_t run = end - i;
    i = end;
    const auto number = static_cast<double>(value);
    if (std::isnan(number)) {
      out.not_numbers += run;
      continue;
    }
    least = std::min(least, number);
    most = std::max(most, number);
    if (value != T{}) out.nonzero += run;
    are_labels = are_labels && is_label(value);
    if (!are_labels) continue;
    counts[static_cast<std::int64_t>(value)] += run;
    are_labels = counts.size() <= most_distinct;
  }
  if (least <= most) out.range = {least, most};
  if (!are_labels) return out;
  out.distinct = counts.size();
  for (const auto& [label, voxels] : counts) out.labels.push_back({label, voxels, 0, {}});
  std::sort(out.labels.begin(), out.labels.end(), [](const LabelFacts& a, const LabelFacts& b) {
    return a.voxels != b.voxels ? a.voxels > b.voxels : a.label < b.label;
  });
  return out;
}

/// Returns the shortest text that parses back to exactly this value of its type.
template <class T>
std::string value_text(T value) {
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

/// Values that are not whole numbers, by their distance from the nearest one.
template <class T>
struct Fractions {
  std::uint64_t near = 0;             ///< number of voxels within the tolerance
  T example{};                        ///< the first of them
  std::optional<T> far = {};          ///< first value beyond the tolerance, or beyond the range of labels
  std::optional<T> near_wanted = {};  ///< first value within the tolerance of a requested label
};

template <class T>
Fractions<T> fractions(std::span<const T> values, std::span<const std::int64_t> labels, const Context& context) {
  Fractions<T> out;
  std::vector<std::int64_t> wanted(labels.begin(), labels.end());
  std::sort(wanted.begin(), wanted.end());
  constexpr std::size_t piece = std::size_t{1} << 20U;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i % piece == 0) throw_if_cancelled(context);
    const T value = values[i];
    if (is_label(value) || std::isnan(value)) continue;
    const T whole = std::round(value);
    if (!is_label(whole) || std::abs(static_cast<double>(value) - static_cast<double>(whole)) > label_tolerance) {
      if (!out.far) out.far = value;
    } else {
      if (out.near++ == 0) out.example = value;
      if (out.near_wanted) continue;
      if (std::binary_search(wanted.begin(), wanted.end(), static_cast<std::int64_t>(whole))) out.near_wanted = value;
    }
  }
  return out;
}

template <class T>
std::optional<RoundedLabels> rounded(std::span<const T> values, std::span<const std::int64_t> labels,
                                     const Context& context) {
  const Fractions<T> found = fractions(values, labels, context);
  if (found.far) {
    if (!found.near_wanted) return std::nullopt;
    throw InvalidImage("the image has the value " + value_text(*found.near_wanted) + ", which is nearly the label " +
                       value_text(std::round(*found.near_wanted)) + ", but also values that are not within " +
                       exact_text(label_tolerance) + " of whole numbers, for example " + value_text(*found.far) +
                       ": round the values first, or give a threshold");
  }
  if (found.near == 0) return std::nullopt;
  std::vector<T> out(values.size());
  std::transform(values.begin(), values.end(), out.begin(), [](T value) { return std::round(value); });
  const std::string text = plural(found.near, "voxel has a label that is", "voxels have labels that are") +
                           " not quite whole, for example " + value_text(found.example) +
                           ": all labels were rounded to whole numbers, by at most " + exact_text(label_tolerance);
  return RoundedLabels{std::move(out), {WarningCode::rounded, text}};
}

/// Returns ", for example V, which is not a whole number" for the first such value, or an empty text.
std::string fraction_text(const VoxelImageView& image) {
  return std::visit(
      [&]<class T>(const std::span<const T>& values) -> std::string {
        if constexpr (std::is_floating_point_v<T>) {
          const auto is_fraction = [](T value) { return value != std::trunc(value) && !std::isnan(value); };
          const auto found = std::find_if(values.begin(), values.end(), is_fraction);
          if (found != values.end()) return ", for example " + value_text(*found) + ", which is not a whole number";
        }
        return {};
      },
      image.values);
}

ImageValues counted(const VoxelImageView& image, const Context& context) {
  return std::visit([&](const auto& values) { return counted(values, context); }, image.values);
}

}  // namespace

ImageValues image_values(const VoxelImageView& image, std::size_t most_labels, const Context& context) {
  ImageValues out = counted(image, context);
  out.labels.resize(std::min(out.labels.size(), most_labels));
  const Vec3d& side = image.grid.spacing;
  for (LabelFacts& facts : out.labels) {
    facts.volume = static_cast<double>(facts.voxels) * side.x * side.y * side.z;
    if (facts.label == 0) continue;
    facts.betti = betti_numbers(selected_voxels(image, LabelSelection::of_label(facts.label), context), context);
  }
  return out;
}

std::optional<RoundedLabels> rounded_labels(const VoxelImageView& image, std::span<const std::int64_t> labels,
                                            const Context& context) {
  return std::visit(
      [&]<class T>(const std::span<const T>& values) -> std::optional<RoundedLabels> {
        if constexpr (std::is_floating_point_v<T>) return rounded(values, labels, context);
        return std::nullopt;
      },
      image.values);
}

std::string nothing_selected_text(const VoxelImageView& image, const LabelSelection& selection) {
  const ImageValues values = counted(image, {});
  const std::string none = "no voxel of the image ";
  if (!values.range) return none + "is a number";
  if (selection.rule == LabelSelection::Rule::nonzero) return none + "is selected: none differs from 0";
  if (selection.rule == LabelSelection::Rule::threshold || !values.distinct) {
    const bool is_label = selection.rule == LabelSelection::Rule::label;
    const std::string wanted = is_label ? "has the label " + std::to_string(selection.label)
                                        : "reaches the threshold " + rounded_text(selection.threshold);
    return none + wanted + ": its values are " + rounded_text((*values.range)[0]) + " to " +
           rounded_text((*values.range)[1]) + (is_label ? fraction_text(image) : "");
  }
  std::vector<std::int64_t> labels;
  for (const LabelFacts& facts : values.labels) {
    if (facts.label != 0 && labels.size() < most_named) labels.push_back(facts.label);
  }
  std::sort(labels.begin(), labels.end());
  std::vector<std::string> texts;
  for (const std::int64_t label : labels) texts.push_back(std::to_string(label));
  std::vector<std::string_view> words(texts.begin(), texts.end());
  const std::size_t there =
      values.labels.size() - (values.nonzero < image.grid.node_count() - values.not_numbers ? 1 : 0);
  const std::string more = there > labels.size() ? std::to_string(there - labels.size()) + " more" : std::string();
  if (!more.empty()) words.emplace_back(more);
  return none + "has the label " + std::to_string(selection.label) + ": its labels are " +
         (words.empty() ? "0 only" : join_words(words));
}

}  // namespace blum
