#include "blum/axis/label_patch_sheets.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/union_find.hpp"

namespace blum {

void label_patch_sheets(Complex& axis, const Context& context) {
  validate(axis);
  const auto patch_a = axis.triangle_columns.get<std::int32_t>(medial_columns::patches[0]);
  const auto patch_b = axis.triangle_columns.get<std::int32_t>(medial_columns::patches[1]);
  const auto count = static_cast<std::uint32_t>(axis.triangles.size());
  const Incidence incidence(ComplexView{axis.positions.size(), {}, axis.triangles}, context);
  detail::UnionFind joined(count);
  std::vector<std::uint32_t> at;
  for (std::size_t e = 0; e < incidence.edges().size(); ++e) {
    at.clear();
    for (const std::uint32_t t : incidence.triangles_of_edge()[e]) {
      if (patch_a[t] != patch_b[t]) at.push_back(t);
    }
    if (at.size() != 2) continue;
    if (patch_a[at[0]] == patch_a[at[1]] && patch_b[at[0]] == patch_b[at[1]]) joined.join(at[0], at[1]);
  }
  std::vector<std::int32_t> sheet(count, -1);
  std::int32_t sheets = 0;
  for (std::uint32_t t = 0; t < count; ++t) {
    if (patch_a[t] == patch_b[t]) continue;
    const std::uint32_t first = joined.find(t);  // the smallest triangle of the sheet
    sheet[t] = first == t ? sheets++ : sheet[first];
  }
  axis.triangle_columns.erase(medial_columns::patch_sheet);
  axis.triangle_columns.add({std::string(medial_columns::patch_sheet), 1, std::move(sheet)});
}

}  // namespace blum
