#include "blum/solid/solid_warnings.hpp"

#include <utility>

#include "blum/core/plural.hpp"

namespace blum {
namespace {

const char* were_reversed(std::size_t count) {
  return count == 1 ? "was reversed" : "were reversed";
}

}  // namespace

std::vector<Warning> reversal_warnings(std::size_t triangles, std::size_t shells) {
  std::vector<Warning> out;
  if (triangles > 0) {
    out.emplace_back(WarningCode::reversed_shells, plural(triangles, "triangle faces", "triangles face") +
                                                       " another way than neighbouring triangles and " +
                                                       were_reversed(triangles));
  }
  if (shells > 0) {
    out.emplace_back(WarningCode::reversed_shells,
                     plural(shells, "shell faces", "shells face") + " the wrong way and " + were_reversed(shells));
  }
  return out;
}

std::vector<Warning> crossing_warnings(const Solid& solid) {
  if (!solid.resolved()) return {};
  return {{WarningCode::crossings_removed, solid.reason() + "; sites are those of its surface without the crossings"}};
}

std::vector<Warning> solid_warnings(const Solid& solid) {
  std::vector<Warning> out = reversal_warnings(solid.reversed_triangles(), solid.reversed_shells());
  for (Warning& warning : crossing_warnings(solid)) out.push_back(std::move(warning));
  return out;
}

}  // namespace blum
