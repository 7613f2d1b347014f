#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <system_error>

#include "blum/core/error.hpp"
#include "blum/io/collision_io.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/text/text_cursor.hpp"
#include "io/text/text_scan.hpp"

namespace blum {
namespace {

constexpr std::size_t rows_per_query = 8;

class QueryReader {
 public:
  QueryReader(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (text_.starts_with(byte_order_mark)) text_.remove_prefix(byte_order_mark.size());
  }

  ImpactQueries read() {
    ImpactQueries out;
    FourMovingPoints points;
    std::optional<bool> truth;
    std::size_t row = 0;
    while (next_line()) {
      const Row own = read_row();
      (row < 4 ? points.start[row] : points.end[row - 4]) = own.point;
      if (row > 0 && own.truth != truth) fail("the answer is not that of the row before, of the same question");
      truth = own.truth;
      if (++row < rows_per_query) continue;
      row = 0;
      out.points.push_back(points);
      out.truth.push_back(truth);
    }
    if (row != 0) fail("the file ends within a question: each has eight rows");
    return out;
  }

 private:
  struct Row {
    Vec3d point;
    std::optional<bool> truth;
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw FormatError(name_ + ", line " + std::to_string(line_) + ": " + what);
  }

  /// Goes to the next line that holds something.
  bool next_line() {
    while (!text_.empty()) {
      const std::size_t end = text_.find('\n');
      row_ = volume_io::trim(text_.substr(0, end));
      text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
      ++line_;
      if (!row_.empty()) return true;
    }
    return false;
  }

  Row read_row() {
    constexpr std::size_t most_columns = 7;
    std::array<std::string_view, most_columns> columns;
    std::size_t count = 0;
    for (std::string_view rest = row_;; ++count) {
      if (count == most_columns) fail("more than seven columns");
      const std::size_t comma = rest.find(',');
      columns[count] = volume_io::trim(rest.substr(0, comma));
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
    ++count;
    if (count < 6) fail("a row has six or seven columns, parted by commas, but this one has " + std::to_string(count));
    Row row;
    for (std::size_t axis = 0; axis < 3; ++axis) row.point[axis] = quotient(columns[2 * axis], columns[2 * axis + 1]);
    if (count == most_columns) {
      if (columns[6] != "0" && columns[6] != "1")
        fail("the answer is " + in_quotes(columns[6]) + ", but must be 0 or 1");
      row.truth = columns[6] == "1";
    }
    return row;
  }

  [[nodiscard]] double quotient(std::string_view numerator, std::string_view denominator) const {
    const double above = integer(numerator);
    const double below = integer(denominator);
    int exponent = 0;
    if (!(below > 0) || std::frexp(below, &exponent) != 0.5) {
      fail("the denominator " + in_quotes(denominator) + " is no power of two, so that the coordinate is no double");
    }
    const double value = std::ldexp(above, 1 - exponent);
    if (std::ldexp(value, exponent - 1) != above) fail("a coordinate is too small for a double");
    return value;
  }

  /// A whole number that is exactly a double.
  [[nodiscard]] double integer(std::string_view text) const {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::size_t sign = text.starts_with('-') ? 1 : 0;
    const bool is_whole = text.size() > sign && text.find_first_not_of("0123456789", sign) == std::string_view::npos;
    if (!is_whole || end != text.data() + text.size()) fail(in_quotes(text) + " is not a whole number");
    constexpr std::size_t always_exact = 15;  // digits
    if (error == std::errc{} && text.size() - sign <= always_exact) return value;
    std::string_view rest = text.substr(sign);
    rest.remove_prefix(std::min(rest.find_first_not_of('0'), rest.size() - 1));
    const std::string shortest = (value < 0 ? "-" : "") + std::string(rest);
    std::array<char, 400> digits{};
    std::snprintf(digits.data(), digits.size(), "%.0f", value);
    if (error != std::errc{} || shortest != digits.data()) fail(in_quotes(text) + " is not exactly a double");
    return value;
  }

  std::string_view text_;
  std::string name_;
  std::string_view row_;
  std::size_t line_ = 0;
};

}  // namespace

ImpactQueries read_impact_queries(std::span<const std::byte> data, std::string_view name) {
  return QueryReader({reinterpret_cast<const char*>(data.data()), data.size()}, std::string(name)).read();
}

ImpactQueries read_impact_queries(const std::filesystem::path& path) {
  const volume_io::FileSource file(path);
  std::vector<std::byte> bytes(static_cast<std::size_t>(file.size()));
  file.read(0, bytes);
  return read_impact_queries(bytes, "'" + path.string() + "'");
}

}  // namespace blum
