#include "blum/core/describe.hpp"

namespace blum {

std::string join_words(std::span<const std::string_view> words, std::string_view last, std::string_view quote) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " " + std::string(last) + " " : std::string(", ");
    text.append(quote).append(words[i]).append(quote);
  }
  return text;
}

void exclude(bool has_first, std::string_view first, bool has_second, std::string_view second,
             std::string_view reason) {
  if (!has_first || !has_second) return;
  throw InvalidOption(std::string(first) + " and " + std::string(second) +
                      " exclude each other: " + std::string(reason));
}

namespace detail {

void refuse_choice(std::string_view what, std::string_view text, std::span<const std::string_view> names) {
  throw InvalidOption(std::string(what) + " is '" + std::string(text) + "', but must be " +
                      join_words(names, "or", "'"));
}

}  // namespace detail
}  // namespace blum
