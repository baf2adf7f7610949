#include "server/animation/track.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "server/animation/lane_blocks.hpp"
#include "server/animation/loose_tracks.hpp"
#include "server/animation/sheet.hpp"

namespace tweend::animation {
namespace {

using Tracks = std::vector<const TrackSource*>;

/// A sheet may leave so many lanes of its vectors empty for each that is used: below that memory is worth less than time.
constexpr std::size_t kEmptiestSheet = 4;

bool is_constant(const TrackSource& track) {
  const auto is_zero = [](const glm::vec4& v) { return v == glm::vec4(0.0F); };
  return std::ranges::all_of(track.values, [&](const glm::vec4& v) { return v == track.values.front(); }) &&
         std::ranges::all_of(track.in_tangents, is_zero) && std::ranges::all_of(track.out_tangents, is_zero);
}

bool same_times(const TrackSource& a, const TrackSource& b) {
  if (a.times_s.data() == b.times_s.data() && a.times_s.size() == b.times_s.size()) return true;
  return std::ranges::equal(a.times_s, b.times_s);
}

bool times_less(const TrackSource& a, const TrackSource& b) {
  if (a.times_s.size() != b.times_s.size()) return a.times_s.size() < b.times_s.size();
  if (a.times_s.data() == b.times_s.data()) return false;
  return std::ranges::lexicographical_compare(a.times_s, b.times_s);
}

bool has_tangents(const TrackSource& track) { return !track.in_tangents.empty() || !track.out_tangents.empty(); }

/// Whether the same SegmentBlend holds for both at any time. Those without tangents stay apart: they would store zeros.
bool blend_alike(const TrackSource& a, const TrackSource& b) {
  return has_tangents(a) == has_tangents(b) && std::ranges::equal(a.modes, b.modes) && same_times(a, b);
}

/// Those of one row share all that blend_alike asks for; each row keeps the order of `tracks`.
std::vector<Tracks> grouped(Tracks tracks) {
  std::ranges::stable_sort(tracks, [](const auto* a, const auto* b) { return times_less(*a, *b); });
  std::vector<Tracks> groups;
  std::size_t first_of_times = 0;
  for (const TrackSource* track : tracks) {
    if (!groups.empty() && !same_times(*groups.back().front(), *track)) first_of_times = groups.size();
    const auto fits = [&](const Tracks& group) { return blend_alike(*group.front(), *track); };
    const auto group = std::find_if(groups.begin() + static_cast<std::ptrdiff_t>(first_of_times), groups.end(), fits);
    if (group == groups.end()) {
      groups.push_back({track});
    } else {
      group->push_back(track);
    }
  }
  return groups;
}

/// Puts tracks whose lanes lie beside each other side by side.
void sort_by_property(Tracks& tracks) {
  std::ranges::sort(tracks, {},
                    [](const TrackSource* track) { return std::pair(track->channel.property, track->channel.target); });
}

/// What a constant track needs: its value, at any time.
TrackSource first_key_of(const TrackSource& track) {
  return {track.channel, track.times_s.first(1), track.values.first(1), {}, {}, track.modes.first(1)};
}

}  // namespace

struct TrackSet::Packed {
  std::vector<Sheet> sheets;  ///< the first one of constants, if there are any
  LooseTracks loose;
  double duration_s = 0.0;
  bool closed = false;
};

TrackSet::TrackSet(std::span<const TrackSource> sources, double duration_s, bool closed) {
  std::vector<TrackSource> constants;
  Tracks moving;
  for (const TrackSource& source : sources) {
    if (is_constant(source)) {
      constants.push_back(first_key_of(source));
    } else {
      moving.push_back(&source);
    }
  }
  auto packed = std::make_unique<Packed>();
  packed->duration_s = duration_s;
  packed->closed = closed;
  Tracks held;
  for (const TrackSource& constant : constants) held.push_back(&constant);
  sort_by_property(held);
  if (!held.empty()) packed->sheets.emplace_back(held);
  sort_by_property(moving);
  Tracks loose;
  for (const Tracks& group : grouped(std::move(moving))) {
    if (group.size() * kEmptiestSheet >= sheet_lanes(group)) {
      packed->sheets.emplace_back(group);
    } else {
      loose.insert(loose.end(), group.begin(), group.end());
    }
  }
  sort_by_property(loose);
  packed->loose = LooseTracks(loose);
  packed_ = std::move(packed);
}

TrackSet::~TrackSet() = default;
TrackSet::TrackSet(TrackSet&&) noexcept = default;
TrackSet& TrackSet::operator=(TrackSet&&) noexcept = default;

void TrackSet::sample(double time_s, Interpolation fallback, Pose& pose) const noexcept {
  const PoseFloats out(pose);
  for (const Sheet& sheet : packed_->sheets) sheet.sample(time_s, packed_->duration_s, packed_->closed, fallback, out);
  packed_->loose.sample(time_s, packed_->duration_s, packed_->closed, fallback, out);
}

}  // namespace tweend::animation
