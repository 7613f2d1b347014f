#include "blum/complex/columns.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace blum {
namespace {

constexpr std::array<std::string_view, std::variant_size_v<Column::Values>> type_names{"float64", "float32", "int64",
                                                                                       "int32"};

std::string quoted(std::string_view name) {
  return "'" + std::string(name) + "'";
}

std::size_t number_count(const Column& column) {
  return std::visit([](const auto& values) { return values.size(); }, column.values);
}

}  // namespace

std::size_t Column::rows() const {
  return components == 0 ? 0 : number_count(*this) / components;
}

std::string_view Column::type_name() const {
  return type_names[values.index()];
}

Column& Columns::add(Column column) {
  if (column.name.empty()) throw InvalidOption("a column needs a name");
  if (find(column.name) != nullptr) throw InvalidOption("a column " + quoted(column.name) + " exists already");
  if (column.components == 0) throw InvalidOption("column " + quoted(column.name) + " has no components");
  const std::size_t count = number_count(column);
  if (count % column.components != 0 || count / column.components != rows_) {
    throw InvalidOption("column " + quoted(column.name) + " has " + std::to_string(count) + " numbers, but " +
                        std::to_string(rows_) + " rows of " + std::to_string(column.components) +
                        " numbers are needed");
  }
  return columns_.emplace_back(std::move(column));
}

bool Columns::erase(std::string_view name) {
  return std::erase_if(columns_, [&](const Column& column) { return column.name == name; }) > 0;
}

const Column* Columns::find(std::string_view name) const {
  const auto found =
      std::find_if(columns_.begin(), columns_.end(), [&](const Column& column) { return column.name == name; });
  return found == columns_.end() ? nullptr : &*found;
}

std::size_t Columns::place_of(std::string_view name, std::size_t components, std::size_t type) const {
  const Column* column = find(name);
  if (column == nullptr) {
    std::string known;
    for (const Column& other : columns_) known += (known.empty() ? "" : ", ") + other.name;
    throw InvalidOption("there is no column " + quoted(name) +
                        "; the columns are: " + (known.empty() ? "none" : known));
  }
  if (column->values.index() != type || column->components != components) {
    throw InvalidOption("column " + quoted(name) + " contains " + std::to_string(column->components) + " " +
                        std::string(column->type_name()) + " per row, but " + std::to_string(components) + " " +
                        std::string(type_names[type]) + " are requested");
  }
  return static_cast<std::size_t>(column - columns_.data());
}

void Columns::resize(std::size_t rows) {
  for (Column& column : columns_) {
    std::visit([&](auto& values) { values.resize(rows * column.components); }, column.values);
  }
  rows_ = rows;
}

Columns Columns::pick(std::span<const std::uint32_t> rows) const {
  for (const std::uint32_t row : rows) {
    if (row >= rows_) {
      throw InvalidOption("row " + std::to_string(row) + " is out of range: the number of rows is " +
                          std::to_string(rows_));
    }
  }
  Columns out(rows.size());
  for (const Column& column : columns_) {
    out.columns_.push_back({column.name, column.components, {}});
    std::visit(
        [&]<class T>(const std::vector<T>& values) {
          std::vector<T> picked;
          picked.reserve(rows.size() * column.components);
          for (const std::uint32_t row : rows) {
            const auto first = values.begin() + static_cast<std::ptrdiff_t>(row * column.components);
            picked.insert(picked.end(), first, first + static_cast<std::ptrdiff_t>(column.components));
          }
          out.columns_.back().values = std::move(picked);
        },
        column.values);
  }
  return out;
}

void Columns::append(const Columns& other) {
  const bool is_alike =
      std::equal(columns_.begin(), columns_.end(), other.columns_.begin(), other.columns_.end(),
                 [](const Column& a, const Column& b) {
                   return a.name == b.name && a.components == b.components && a.values.index() == b.values.index();
                 });
  if (!is_alike)
    throw InvalidOption("rows can only be added from columns of the same names and types, in the same order");
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    std::visit(
        [&]<class T>(std::vector<T>& values) {
          // This copy is needed because `other` may be this object.
          const std::vector<T> more = std::get<std::vector<T>>(other.columns_[c].values);
          values.insert(values.end(), more.begin(), more.end());
        },
        columns_[c].values);
  }
  rows_ += other.rows_;
}

}  // namespace blum
