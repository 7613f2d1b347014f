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

/// What a column may hold.
template <class T>
concept ColumnNumber =
    std::same_as<T, double> || std::same_as<T, float> || std::same_as<T, std::int64_t> || std::same_as<T, std::int32_t>;

/// A named attribute: the same count of numbers, of one type, for each row.
struct Column {
  using Values =
      std::variant<std::vector<double>, std::vector<float>, std::vector<std::int64_t>, std::vector<std::int32_t>>;

  std::string name;
  std::size_t components = 1;  ///< numbers per row, at least 1
  Values values;               ///< row after row, the components of a row beside each other

  [[nodiscard]] std::size_t rows() const;
  /// "float64", "float32", "int64" or "int32".
  [[nodiscard]] std::string_view type_name() const;
  [[nodiscard]] friend bool operator==(const Column&, const Column&) = default;
};

/// Columns over the same rows, in the order in which they were added, each with a name of its own.
class Columns {
 public:
  Columns() = default;
  explicit Columns(std::size_t rows) : rows_(rows) {}

  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] bool empty() const { return columns_.empty(); }
  [[nodiscard]] std::size_t size() const { return columns_.size(); }
  [[nodiscard]] auto begin() const { return columns_.begin(); }
  [[nodiscard]] auto end() const { return columns_.end(); }

  /// Adds a column. @throws InvalidOption for a name that is empty or in use, no components, or another count of rows.
  Column& add(Column column);
  /// Adds a column whose numbers are all `fill`. @throws InvalidOption as above.
  template <ColumnNumber T>
  std::span<T> add(std::string name, std::size_t components = 1, T fill = T{}) {
    return std::get<std::vector<T>>(
        add({std::move(name), components, std::vector<T>(rows_ * components, fill)}).values);
  }
  /// Whether there was one.
  bool erase(std::string_view name);

  /// nullptr where there is none.
  [[nodiscard]] const Column* find(std::string_view name) const;
  /// The numbers of a column, row after row. @throws InvalidOption where there is no such column, or where it is of
  /// another type or has another count of components.
  template <ColumnNumber T>
  [[nodiscard]] std::span<const T> get(std::string_view name, std::size_t components = 1) const {
    return std::get<std::vector<T>>(columns_[place_of(name, components, type_of<T>)].values);
  }
  /// The same to write to.
  template <ColumnNumber T>
  [[nodiscard]] std::span<T> edit(std::string_view name, std::size_t components = 1) {
    return std::get<std::vector<T>>(columns_[place_of(name, components, type_of<T>)].values);
  }

  /// Drops rows from the end, or adds rows of zeros there.
  void resize(std::size_t rows);
  /// These rows, in this order; a row may be picked more than once. @throws InvalidOption for a row that is none.
  [[nodiscard]] Columns pick(std::span<const std::uint32_t> rows) const;
  /// Adds rows behind these. @throws InvalidOption unless both have the same columns in the same order.
  void append(const Columns& other);

  [[nodiscard]] friend bool operator==(const Columns&, const Columns&) = default;

 private:
  template <ColumnNumber T>
  static constexpr std::size_t type_of = std::same_as<T, double>         ? 0
                                         : std::same_as<T, float>        ? 1
                                         : std::same_as<T, std::int64_t> ? 2
                                                                         : 3;

  /// @throws InvalidOption as get().
  [[nodiscard]] std::size_t place_of(std::string_view name, std::size_t components, std::size_t type) const;

  std::size_t rows_ = 0;
  std::vector<Column> columns_;
};

}  // namespace blum
