#include "server/commands/edit_helpers.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tweend::commands {
namespace {

// A closed clip needs time to blend back to its first keyframe.
bool ends_before(const model::Clip& clip, double last_s) noexcept {
  return clip.settings.closed ? *clip.settings.duration_s <= last_s : *clip.settings.duration_s < last_s;
}

}  // namespace

Status check_duration(const model::Clip& clip, const std::string& path) {
  if (!clip.settings.duration_s || clip.times_s.empty() || !ends_before(clip, clip.times_s.back())) return {};
  return fail(ErrorCode::InvalidParams,
              fmt::format("expected a duration beyond the last keyframe at {} s, found {} s", clip.times_s.back(),
                          *clip.settings.duration_s),
              path);
}

Status check_keyframe_time(const model::Clip& clip, double time_s, model::KeyframeId except) {
  // 1 µs as a decimal is not exact: two times written 1 µs apart shall count as within it.
  constexpr double kWithin = model::kSameTimeSeconds * (1.0 + 1e-6);
  const std::size_t place = clip.place_of(time_s);
  for (std::size_t i = place < 2 ? 0 : place - 2; i < clip.times_s.size() && i <= place + 1; ++i) {
    if (clip.keyframes[i].id == except || std::abs(clip.times_s[i] - time_s) > kWithin) continue;
    return fail(ErrorCode::Conflict,
                fmt::format("expected a time more than 1 µs from other keyframes, found {} s: keyframe {} is at {} s", time_s,
                            clip.keyframes[i].id, clip.times_s[i]),
                "params.time");
  }
  if (clip.settings.duration_s && ends_before(clip, time_s)) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected a time before the clip's end at {} s, found {} s; clip.update changes its duration",
                            *clip.settings.duration_s, time_s),
                "params.time");
  }
  return {};
}

}  // namespace tweend::commands
