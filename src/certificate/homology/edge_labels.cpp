#include "certificate/homology/edge_labels.hpp"

#include <algorithm>

#include "blum/core/parallel.hpp"
#include "blum/core/random.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {
namespace {

bool meet(const Box3& a, const Box3& b) {
  return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
         a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

Box3 box_of(const Vec3d& p, const Vec3d& q) {
  return {min(p, q), max(p, q)};
}

}  // namespace

Apex::Apex(const Box3& box, std::uint32_t attempt) : size_(box.diagonal()) {
  constexpr double far = 3;
  constexpr std::uint32_t first_direction = 1000;  // differs from the directions used to locate points
  const ProbeLine line = line_through(box.center(), first_direction + attempt);
  apex_ = box.center() - line.along * (far * size_);
  along_ = line.along;
  across_ = line.across;
  up_ = line.up;
}

Vec3d Apex::seen(const Vec3d& p) const {
  const Vec3d q = p - apex_;
  const double away = dot(along_, q);
  return {dot(across_, q) / away * size_, dot(up_, q) / away * size_, away};
}

std::optional<int> Apex::crossing(const Vec3d& u, const Vec3d& v, const Vec3d& a, const Vec3d& b) const {
  return exact_crossing(apex_, u, v, a, b);
}

std::optional<int> Apex::crossing_above(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
  return exact_crossing(a, b, c, p, apex_);
}

Curtains::Curtains(const Complement& complement, const Apex& apex, const Context& context)
    : complement_(complement), apex_(apex) {
  std::vector<Box3> boxes;
  boxes.reserve(complement.segments().size());
  const double room = apex.rounding();
  for (const Complement::Segment& segment : complement.segments()) {
    const Vec3d u = apex.seen(complement.point(segment.ends[0]));
    const Vec3d v = apex.seen(complement.point(segment.ends[1]));
    Box3 box = box_of(u, v);
    box.lower = {box.lower.x - room, box.lower.y - room, 0};  // everything between the apex and the segment
    box.upper += Vec3d{room, room, room};
    boxes.push_back(box);
  }
  tree_ = BoxHierarchy(boxes, context);
  boxes_.reserve(boxes.size());
  for (const std::uint32_t place : tree_.order()) boxes_.push_back(boxes[place]);
}

void Curtains::near(const Box3& seen, std::vector<std::uint32_t>& places) const {
  places.clear();
  tree_.visit_where([&](const Box3& box) { return meet(box, seen); },
                    [&](std::uint32_t place) {
                      if (meet(boxes_[place], seen)) places.push_back(place);
                      return true;
                    });
}

bool Curtains::add(const Vec3d& a, const Vec3d& b, const Box3& seen, std::uint32_t body,
                   std::span<const std::uint32_t> places, std::vector<Label>& labels) const {
  bool is_certain = true;
  for (const std::uint32_t place : places) {
    if (!meet(boxes_[place], seen)) continue;
    const std::uint32_t s = tree_.order()[place];
    const Complement::Segment& segment = complement_.segments()[s];
    if (segment.body != body) continue;
    const auto times = apex_.crossing(complement_.point(segment.ends[0]), complement_.point(segment.ends[1]), a, b);
    if (!times) is_certain = false;
    if (times && *times != 0) labels.push_back({s, *times});
  }
  return is_certain;
}

bool Curtains::add(std::span<const Vec3d> way, std::uint32_t body, std::vector<Label>& labels) const {
  bool is_certain = true;
  std::vector<std::uint32_t> places;
  for (std::size_t k = 0; k + 1 < way.size(); ++k) {
    const Box3 seen = box_of(apex_.seen(way[k]), apex_.seen(way[k + 1]));
    near(seen, places);
    is_certain = add(way[k], way[k + 1], seen, body, places, labels) && is_certain;
  }
  return is_certain;
}

std::optional<Segment3> Curtains::first_touched(const Vec3d& a, const Vec3d& b, std::uint32_t body) const {
  const Box3 seen = box_of(apex_.seen(a), apex_.seen(b));
  std::vector<std::uint32_t> places;
  near(seen, places);
  for (const std::uint32_t place : places) {
    const Complement::Segment& segment = complement_.segments()[tree_.order()[place]];
    if (segment.body != body) continue;
    const Segment3 own{complement_.point(segment.ends[0]), complement_.point(segment.ends[1])};
    if (!apex_.crossing(own.a, own.b, a, b)) return own;
  }
  return std::nullopt;
}

EdgeLabels::EdgeLabels(const Curtains& curtains, std::span<const std::array<std::uint32_t, 2>> edges,
                       const std::vector<Vec3d>& positions, const std::vector<std::uint32_t>& body_of,
                       const Context& context)
    : parts_(edges.size() / grain + 1) {
  std::vector<Vec3d> seen(positions.size());
  constexpr std::size_t many = 4096;
  parallel_for(context, positions.size(), many, "", [&](const WorkRange& range) {
    for (std::size_t v = range.begin; v < range.end; ++v) seen[v] = curtains.apex().seen(positions[v]);
  });
  parallel_for(context, parts_.size(), many / grain, "linking numbers", [&](const WorkRange& range) {
    std::vector<std::uint32_t> places;
    for (std::size_t p = range.begin; p < range.end; ++p) {
      Part& part = parts_[p];
      const std::size_t end = std::min(edges.size(), (p + 1) * grain);
      Box3 all;
      for (std::size_t e = p * grain; e < end; ++e) {
        for (const std::uint32_t v : edges[e]) all.extend(seen[v]);
      }
      curtains.near(all, places);
      if (places.empty()) continue;
      part.ends.resize(grain);
      for (std::size_t e = p * grain; e < end; ++e) {
        const auto [a, b] = edges[e];
        if (!curtains.add(positions[a], positions[b], box_of(seen[a], seen[b]), body_of[a], places, part.labels)) {
          part.doubtful.push_back(static_cast<std::uint32_t>(e));
        }
        part.ends[e % grain] = static_cast<std::uint32_t>(part.labels.size());
      }
      if (part.labels.empty()) part.ends.clear();
    }
  });
  for (const Part& part : parts_) doubtful_.insert(doubtful_.end(), part.doubtful.begin(), part.doubtful.end());
}

}  // namespace blum::verifier
