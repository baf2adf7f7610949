#pragma once

#include "server/commands/command.hpp"
#include "server/commands/view_types.hpp"
#include "server/streams/film.hpp"
#include "server/streams/still.hpp"

namespace tweend::protocol {

template <>
struct EnumNames<streams::ImageFormat> {
  static constexpr std::array<std::string_view, 2> kNames{"png", "jpeg"};
};

}  // namespace tweend::protocol

namespace tweend::commands {

inline constexpr std::uint64_t kDefaultWidth = 1280;
inline constexpr std::uint64_t kDefaultHeight = 720;
inline constexpr int kDefaultQuality = 80;
inline constexpr protocol::Range kPixels{.min = 1.0};
inline constexpr protocol::Range kQuality{.min = 1.0, .max = 100.0};
/// Pictures a second of a film.
inline constexpr protocol::Range kFilmRate{.min = streams::kSlowestFilm, .max = 240.0};

/// One picture: `frame.render`, and GET /scenes/{scene}/frame.png.
struct FrameParams {
  static constexpr std::string_view kName = "FrameParams";
  std::optional<std::string> scene;
  std::optional<double> time;
  std::optional<std::uint64_t> width, height;
  std::optional<streams::ImageFormat> format;
  std::optional<std::int64_t> quality;
  std::optional<OwnCamera> camera;
  static void describe(FieldList<FrameParams>& f) {
    using T = FrameParams;
    add_scene_field(f);
    f.add<&T::time>("time", "Of each actor's current clip, seconds, clamped to it; what is shown now if left out.");
    f.add<&T::width>("width", "Pixels; 1280 if left out.", kPixels);
    f.add<&T::height>("height", "Pixels; 720 if left out.", kPixels);
    f.add<&T::format>("format", "png if left out.");
    f.add<&T::quality>("quality", "Of a jpeg; 80 if left out.", kQuality);
    f.add<&T::camera>("camera", "Where to look from; the scene's camera if left out.");
  }
};

/// The size asked for, within the server's limits and those of its device.
/// @return Limit naming the parameter and both numbers
[[nodiscard]] Result<render::Size> frame_size(const std::optional<std::uint64_t>& width,
                                              const std::optional<std::uint64_t>& height, const Services& services);

/// Whether an MP4 file can have that size. @return InvalidParams naming the first side that is odd
[[nodiscard]] Status check_even(render::Size size);

/// What the parameters come to. @return the errors of the parameters; Unavailable where nothing draws
[[nodiscard]] Result<streams::StillRequest> still_request(const FrameParams& p, const QueryContext& context);

}  // namespace tweend::commands
