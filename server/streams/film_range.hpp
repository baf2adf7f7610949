#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "server/base/result.hpp"
#include "server/streams/clip_film.hpp"

namespace tweend::streams {

/// What is to be filmed of a clip, media seconds.
struct FilmRange {
  double from_s = 0.0;
  std::optional<double> to_s;  ///< empty: the clip's end
  double fps = 30.0;
};

/// How many pictures the film has: as film_pictures(), once it is known that there are not too many to count.
/// @param clip_s  where the clip ends
/// @param prefix  what "from" and "to" are called where they were said, e.g. "params."
/// @return InvalidParams where it ends before it begins, Limit for more than `most`
[[nodiscard]] inline Result<std::size_t> pictures_of(const FilmRange& range, double clip_s, std::size_t most,
                                                     std::string_view prefix) {
  const double to_s = range.to_s.value_or(clip_s);
  if (to_s < range.from_s && range.to_s) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected a time from {} on, where the film begins, found {}", range.from_s, to_s),
                fmt::format("{}to", prefix));
  }
  if (to_s < range.from_s) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected a time up to {}, where the clip ends, found {}; say also where the film ends, to go on",
                            clip_s, range.from_s),
                fmt::format("{}from", prefix));
  }
  if (const double pictures = (to_s - range.from_s) * range.fps; pictures >= static_cast<double>(most) + 0.5) {
    return fail(ErrorCode::Limit,
                fmt::format("expected a film of at most {} pictures, found {:.6g}; ask for part of it, or for "
                            "fewer a second",
                            most, pictures));
  }
  return film_pictures(range.from_s, to_s, range.fps);
}

}  // namespace tweend::streams
