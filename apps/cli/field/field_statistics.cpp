#include "field/field_statistics.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"

namespace blum::cli {
namespace {

constexpr std::size_t grain = std::size_t{1} << 18;

/// Set of ids. Several threads may add ids at the same time.
class IdSet {
 public:
  explicit IdSet(std::size_t size) : words_((size + 63) / 64) {}
  void add(std::size_t id) {
    const std::atomic_ref<std::uint64_t> word(words_[id / 64]);
    const std::uint64_t bit = std::uint64_t{1} << (id % 64);
    if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t count(std::size_t begin, std::size_t end) const {
    std::uint64_t total = 0;
    for (std::size_t id = begin; id < end; ++id) {
      if (id % 64 == 0 && id + 64 <= end) {
        total += static_cast<std::uint64_t>(std::popcount(words_[id / 64]));
        id += 63;
      } else {
        total += words_[id / 64] >> (id % 64) & 1;
      }
    }
    return total;
  }

 private:
  std::vector<std::uint64_t> words_;
};

struct Partial {
  float minimum = std::numeric_limits<float>::infinity();
  float maximum = -std::numeric_limits<float>::infinity();
  std::uint64_t inside = 0;
  std::uint64_t siteless = 0;
  std::array<std::uint64_t, 3> kinds{};
};

/// Borders between kinds of site ids: ids below `edges` are vertices, ids from `edges` to below `faces` are edges,
/// others are faces.
struct Borders {
  std::size_t edges = std::numeric_limits<std::size_t>::max();
  std::size_t faces = std::numeric_limits<std::size_t>::max();
};

std::size_t id_limit(const Field& field, const Context& context) {
  std::vector<std::uint32_t> largest(static_cast<std::size_t>(thread_count(context)), 0);
  parallel_for(context, field.site.size(), grain, "", [&](const WorkRange& range) {
    std::uint32_t top = largest[static_cast<std::size_t>(range.worker)];
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const SiteId id = field.site[i];
      if (id.has_value()) top = std::max(top, id.value + 1);
    }
    largest[static_cast<std::size_t>(range.worker)] = top;
  });
  return *std::max_element(largest.begin(), largest.end());
}

void add_range(const Field& field, const WorkRange& range, const Borders& borders, IdSet& seen, Partial& partial) {
  const std::size_t sites_end = std::min(range.end, field.site.size());
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const float distance = field.distance[i];
    partial.minimum = std::min(partial.minimum, distance);
    partial.maximum = std::max(partial.maximum, distance);
    partial.inside += distance < 0 ? 1 : 0;
  }
  SiteId last = SiteId::none();
  for (std::size_t i = range.begin; i < sites_end; ++i) {
    const SiteId id = field.site[i];
    if (!id.has_value()) {
      ++partial.siteless;
      continue;
    }
    ++partial.kinds[(id.value >= borders.edges ? 1U : 0U) + (id.value >= borders.faces ? 1U : 0U)];
    if (id != last) seen.add(id.value);
    last = id;
  }
}

/// Returns true if a node has a second site. If the field has no sites, the node's distance decides.
bool has_second(const Field& field, std::size_t node) {
  if (!field.site2.empty()) return field.site2[node].has_value();
  return field.distance2[node] < (field.band ? static_cast<float>(*field.band) : HUGE_VALF);
}

SecondStatistics second_statistics(const Field& field, const Context& context) {
  std::vector<SecondStatistics> partials(static_cast<std::size_t>(thread_count(context)));
  const auto add = [](SecondStatistics& to, float minimum, float maximum) {
    to.minimum = std::min(to.minimum.value_or(minimum), minimum);
    to.maximum = std::max(to.maximum.value_or(maximum), maximum);
  };
  parallel_for(context, field.distance2.size(), grain, "", [&](const WorkRange& range) {
    SecondStatistics& partial = partials[static_cast<std::size_t>(range.worker)];
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (has_second(field, i)) {
        add(partial, field.distance2[i], field.distance2[i]);
      } else {
        ++partial.nodes_without;
      }
    }
  });
  SecondStatistics all;
  for (const SecondStatistics& partial : partials) {
    if (partial.minimum) add(all, *partial.minimum, *partial.maximum);
    all.nodes_without += partial.nodes_without;
  }
  return all;
}

}  // namespace

FieldStatistics field_statistics(const Field& field, const SiteTable* sites, const Context& context) {
  Context silent = context;
  silent.progress = {};
  Borders borders;
  if (sites != nullptr) {
    borders = {sites->vertex_count(), sites->vertex_count() + sites->edge_count()};
  }
  const std::size_t limit = std::max<std::size_t>(id_limit(field, silent), sites != nullptr ? sites->size() : 0);
  IdSet seen(limit);
  std::vector<Partial> partials(static_cast<std::size_t>(thread_count(silent)));
  parallel_for(silent, field.distance.size(), grain, "", [&](const WorkRange& range) {
    add_range(field, range, borders, seen, partials[static_cast<std::size_t>(range.worker)]);
  });

  FieldStatistics result;
  result.minimum = std::numeric_limits<float>::infinity();
  result.maximum = -std::numeric_limits<float>::infinity();
  for (const Partial& partial : partials) {
    result.minimum = std::min(result.minimum, partial.minimum);
    result.maximum = std::max(result.maximum, partial.maximum);
    result.inside_nodes += partial.inside;
    result.siteless_nodes += partial.siteless;
    for (std::size_t kind = 0; kind < 3; ++kind) result.kinds[kind].nodes += partial.kinds[kind];
  }
  for (const KindCount& kind : result.kinds) result.all.nodes += kind.nodes;
  result.all.sites = seen.count(0, limit);
  if (sites != nullptr) {
    result.kinds[0].sites = seen.count(0, borders.edges);
    result.kinds[1].sites = seen.count(borders.edges, borders.faces);
    result.kinds[2].sites = seen.count(borders.faces, sites->size());
  }
  if (field.order() == 2) result.second = second_statistics(field, silent);
  return result;
}

}  // namespace blum::cli
