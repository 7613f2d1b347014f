// Blum: named columns of numbers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "blum/core/error.hpp"

namespace blum {

/// Types of numbers in a column.
template <class T>
concept ColumnNumber =
    std::same_as<T, double> || std::same_as<T, float> || std::same_as<T, std::int64_t> || std::same_as<T, std::int32_t>;

/// Named attribute: each row has `components` numbers, all of one type.
struct Column {
  using Values =
      std::variant<std::vector<double>, std::vector<float>, std::vector<std::int64_t>, std::vector<std::int32_t>>;

  std::string name;
  std::size_t components = 1;  ///< Numbers per row, at least 1.
  Values values;               ///< All rows, one after the other; the components of a row are adjacent.

  [[nodiscard]] std::size_t rows() const;
  /// Returns "float64", "float32", "int64" or "int32".
  [[nodiscard]] std::string_view type_name() const;
  [[nodiscard]] friend bool operator==(const Column&, const Column&) = default;
};

/// Columns with the same number of rows, in the order in which they were added. No two columns have the same name.
class Columns {
 public:
  Columns() = default;
  explicit Columns(std::size_t rows) : rows_(rows) {}

  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] bool empty() const { return columns_.empty(); }
  [[nodiscard]] std::size_t size() const { return columns_.size(); }
  [[nodiscard]] auto begin() const { return columns_.begin(); }
  [[nodiscard]] auto end() const { return columns_.end(); }

  /// Adds a column.
  /// @throws InvalidOption if the name is empty or in use, the column has no components, or its number of rows is not
  /// rows().
  Column& add(Column column);
  /// Adds a column whose numbers are all `fill`.
  /// @throws InvalidOption under the same conditions as add(Column).
  template <ColumnNumber T>
  std::span<T> add(std::string name, std::size_t components = 1, T fill = T{}) {
    return std::get<std::vector<T>>(
        add({std::move(name), components, std::vector<T>(rows_ * components, fill)}).values);
  }
  /// Removes a column. Returns true if it existed.
  bool erase(std::string_view name);

  /// Returns the column with the given name; nullptr if it does not exist.
  [[nodiscard]] const Column* find(std::string_view name) const;
  /// Returns the numbers of a column, row after row.
  /// @throws InvalidOption if no column has this name, if the column's type is not T, or if it does not have
  /// `components` numbers per row.
  template <ColumnNumber T>
  [[nodiscard]] std::span<const T> get(std::string_view name, std::size_t components = 1) const {
    return std::get<std::vector<T>>(columns_[place_of(name, components, type_of<T>)].values);
  }
  /// Does the same as get(), but returns numbers that the caller can change.
  template <ColumnNumber T>
  [[nodiscard]] std::span<T> edit(std::string_view name, std::size_t components = 1) {
    return std::get<std::vector<T>>(columns_[place_of(name, components, type_of<T>)].values);
  }

  /// Removes rows from the end, or appends rows of zeros.
  void resize(std::size_t rows);
  /// Returns the rows with the given indices, in the given order. An index may occur more than once.
  /// @throws InvalidOption if a row does not exist.
  [[nodiscard]] Columns pick(std::span<const std::uint32_t> rows) const;
  /// Appends the rows of other columns.
  /// @throws InvalidOption if `other` does not have the same columns in the same order.
  void append(const Columns& other);

  [[nodiscard]] friend bool operator==(const Columns&, const Columns&) = default;

 private:
  template <ColumnNumber T>
  static constexpr std::size_t type_of = std::same_as<T, double>         ? 0
                                         : std::same_as<T, float>        ? 1
                                         : std::same_as<T, std::int64_t> ? 2
                                                                         : 3;

  /// Returns the index of a column.
  /// @throws InvalidOption under the same conditions as get().
  [[nodiscard]] std::size_t place_of(std::string_view name, std::size_t components, std::size_t type) const;

  std::size_t rows_ = 0;
  std::vector<Column> columns_;
};

}  // namespace blum
