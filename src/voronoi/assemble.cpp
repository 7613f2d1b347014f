#include "voronoi/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/parallel.hpp"
#include "voronoi/settle.hpp"

namespace blum::voronoi {
namespace {

constexpr std::size_t grain = 64;
constexpr std::uint32_t no_vertex = UINT32_MAX;

/// What a vertex stands for.
struct Place {
  Vec3d start;  ///< relative to the centre of the labels
  std::uint32_t parts = 0;
  PlacedBox box;
  std::vector<LabelIndex> labels;   ///< one of each site
  std::vector<LabelIndex> surface;  ///< those of them whose own face is part of it
};

class Assembly {
 public:
  Assembly(const Subdivision& cells, const CubeTest& test, const LabelGeometry& labels, const Context& context)
      : cells_(cells), tree_(cells.tree), test_(test), labels_(labels), context_(context) {}

  Complex run() {
    analyse_cubes();
    place_events();
    for (std::size_t k = 0; k < cubes_.size(); ++k) add_cube(k);
    settle_all();
    return finish();
  }

 private:
  void analyse_cubes() {
    cubes_.resize(cells_.leaves.size());
    parallel_for(context_, cubes_.size(), grain, "components", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        const GridCube& cube = tree_.cubes[cells_.leaves[k]];
        if (cube.state == CubeState::passed) cubes_[k] = test_.run(cube);
      }
    });
  }

  void place_events() {
    at_event_.resize(tree_.events.size());
    for (const GridEdge& edge : tree_.edges) {
      if (edge.children != no_cell) continue;
      const Vec3d low = tree_.lattice.at(edge.low);
      for (std::uint32_t k = edge.first_event; k < edge.last_event; ++k) {
        at_event_[k] = low;
        at_event_[k][edge.axis] = tree_.events[k].at;
        at_event_[k] -= labels_.centre();
      }
    }
    vertex_of_event_.assign(tree_.events.size(), no_vertex);
    vertex_of_square_.assign(tree_.squares.size(), no_vertex);
  }

  void add_label(std::vector<LabelIndex>& list, LabelIndex label) const {
    const bool is_known = std::any_of(list.begin(), list.end(),
                                      [&](LabelIndex known) { return labels_[known].site == labels_[label].site; });
    if (!is_known) list.push_back(label);
  }

  void add_labels(Place& place, const LineEvent& event) const {
    for (const LabelIndex label : {event.before, event.after}) {
      if (label != outside) add_label(place.labels, label);
    }
    if (const std::optional<LabelIndex> triangle = event.crossed()) add_label(place.surface, *triangle);
  }

  std::uint32_t vertex_of_event(std::uint32_t event) {
    std::uint32_t& vertex = vertex_of_event_[event];
    if (vertex != no_vertex) return vertex;
    vertex = static_cast<std::uint32_t>(places_.size());
    Place place;
    place.start = at_event_[event];
    place.parts = 1;
    place.box = {place.start, place.start};
    add_labels(place, tree_.events[event]);
    places_.push_back(std::move(place));
    return vertex;
  }

  [[nodiscard]] PlacedBox box_of(const Node& low, const Node& high) const {
    return {tree_.lattice.at(low) - labels_.centre(), tree_.lattice.at(high) - labels_.centre()};
  }

  /// The first vertex of a square's components.
  std::uint32_t vertex_of_square(const CubeCells::Square& cells) {
    std::uint32_t& first = vertex_of_square_[cells.square];
    if (first != no_vertex) return first;
    first = static_cast<std::uint32_t>(places_.size());
    const GridSquare& square = tree_.squares[cells.square];
    Place place;
    place.box = box_of(square.low, square.high());
    places_.insert(places_.end(), cells.component.size(), place);
    for (std::size_t k = 0; k < cells.events.size(); ++k) {
      if (cells.component_of_event[k] == outside) continue;
      Place& of_component = places_[first + cells.component_of_event[k]];
      const LineEvent& event = tree_.events[cells.events[k]];
      of_component.start += at_event_[cells.events[k]];
      ++of_component.parts;
      add_labels(of_component, event);
    }
    for (std::uint32_t k = 0; k < cells.component.size(); ++k) {
      places_[first + k].start *= 1.0 / places_[first + k].parts;
    }
    return first;
  }

  void add_cube(std::size_t number) {
    const CubeCells& cells = cubes_[number];
    if (cells.component_count == 0) return;
    const GridCube& cube = tree_.cubes[cells_.leaves[number]];
    const auto first = static_cast<std::uint32_t>(places_.size());
    Place place;
    place.box = box_of(cube.low, cube.high());
    places_.insert(places_.end(), cells.component_count, place);
    for (const CubeCells::Square& square : cells.squares) {
      if (square.component.empty()) continue;
      const std::uint32_t first_of_square = vertex_of_square(square);
      for (std::uint32_t k = 0; k < square.component.size(); ++k) {
        Place& of_component = places_[first + square.component[k]];
        const Place& part = places_[first_of_square + k];
        of_component.start += part.start;
        ++of_component.parts;
        for (const LabelIndex label : part.labels) add_label(of_component.labels, label);
        for (const LabelIndex label : part.surface) add_label(of_component.surface, label);
      }
      for (std::size_t k = 0; k < square.events.size(); ++k) {
        const std::uint32_t component = square.component_of_event[k];
        if (component == outside) continue;
        triangles_.push_back(
            {vertex_of_event(square.events[k]), first_of_square + component, first + square.component[component]});
        add_sites(tree_.events[square.events[k]]);
      }
    }
    for (std::uint32_t k = 0; k < cells.component_count; ++k) {
      places_[first + k].start *= 1.0 / places_[first + k].parts;
    }
  }

  void add_sites(const LineEvent& event) {
    const auto site = [&](LabelIndex label) {
      return label == outside ? -1 : static_cast<std::int32_t>(labels_[label].site);
    };
    const auto [low, high] = std::minmax({site(event.before), site(event.after)});
    site_a_.push_back(low);
    site_b_.push_back(high);
  }

  void settle_all() {
    radius_.resize(places_.size());
    parallel_for(context_, places_.size(), grain, "vertices", [&](const WorkRange& range) {
      for (std::size_t k = range.begin; k < range.end; ++k) {
        const bool is_settled = settle_one(places_[k]);
        const Place& place = places_[k];
        double least = !place.surface.empty() && is_settled ? 0 : labels_.size() * labels_.size();
        for (const LabelIndex label : place.labels) {
          least = std::min(least, squared_length(labels_.closest_point(label, place.start) - place.start));
        }
        radius_[k] = std::sqrt(least);
      }
    });
  }

  /// Moves a vertex to the surface where it has a part in it, else to where all its labels are equally close, or two.
  bool settle_one(Place& place) const {
    if (place.box.low == place.box.high) return true;
    const bool on_surface = !place.surface.empty();
    std::span<const LabelIndex> which = on_surface ? place.surface : place.labels;
    auto settled = settle(labels_, which, on_surface, place.start, place.box);
    const std::size_t few = on_surface ? 1 : 2;
    if (!settled && which.size() > few) settled = settle(labels_, which.first(few), on_surface, place.start, place.box);
    if (settled) place.start = *settled;
    return settled.has_value();
  }

  Complex finish() {
    Complex out;
    out.positions.reserve(places_.size());
    for (const Place& place : places_) out.positions.push_back(place.start + labels_.centre());
    out.triangles = std::move(triangles_);
    out.vertex_columns = Columns(out.positions.size());
    out.triangle_columns = Columns(out.triangles.size());
    out.vertex_columns.add({"radius", 1, std::move(radius_)});
    out.triangle_columns.add({"site_a", 1, std::move(site_a_)});
    out.triangle_columns.add({"site_b", 1, std::move(site_b_)});
    return out;
  }

  const Subdivision& cells_;
  const CellTree& tree_;
  const CubeTest& test_;
  const LabelGeometry& labels_;
  const Context& context_;
  std::vector<CubeCells> cubes_;
  std::vector<Vec3d> at_event_;
  std::vector<std::uint32_t> vertex_of_event_, vertex_of_square_;
  std::vector<Place> places_;
  std::vector<double> radius_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::int32_t> site_a_, site_b_;
};

}  // namespace

Complex assemble(const Subdivision& cells, const CubeTest& test, const LabelGeometry& labels, const Context& context) {
  return Assembly(cells, test, labels, context).run();
}

}  // namespace blum::voronoi
