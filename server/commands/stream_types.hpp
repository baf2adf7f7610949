#pragma once

#include "server/commands/frame_types.hpp"

namespace tweend::commands {

enum class StreamKind : std::uint8_t { Pose, Vertices, Frames };
enum class StreamEncoding : std::uint8_t { F32, Jpeg, Png, Rgba };
enum class StreamDelivery : std::uint8_t { Latest };

}  // namespace tweend::commands

namespace tweend::protocol {

template <>
struct EnumNames<commands::StreamKind> {
  static constexpr std::array<std::string_view, 3> kNames{"pose", "vertices", "frames"};
};
template <>
struct EnumNames<commands::StreamEncoding> {
  static constexpr std::array<std::string_view, 4> kNames{"f32", "jpeg", "png", "rgba"};
};
template <>
struct EnumNames<commands::StreamDelivery> {
  static constexpr std::array<std::string_view, 1> kNames{"latest"};
};

}  // namespace tweend::protocol

namespace tweend::commands {

inline constexpr protocol::Range kRate{.min = 0.0, .max = 240.0, .min_excluded = true};

/// `stream.open`, and GET /scenes/{scene}/stream.mjpg.
struct StreamOpenParams {
  static constexpr std::string_view kName = "StreamOpenParams";
  StreamKind kind = StreamKind::Vertices;
  std::optional<std::string> scene;
  std::optional<std::string> actor;
  std::optional<double> rate;
  std::optional<StreamDelivery> delivery;
  std::optional<StreamEncoding> encoding;
  std::optional<std::uint64_t> width, height;
  std::optional<std::int64_t> quality;
  std::optional<OwnCamera> camera;
  static void describe(FieldList<StreamOpenParams>& f) {
    using T = StreamOpenParams;
    f.add<&T::kind>("kind", "What to send.");
    add_scene_field(f);
    f.add<&T::actor>(
        "actor", "Whose pose or vertices; may be left out where the scene has one. Of frames: whose media time they carry.");
    f.add<&T::rate>("rate", "Packets a second; if left out, 60 of a pose and 30 of all else.", kRate);
    f.add<&T::delivery>("delivery", "latest: a slow reader skips.");
    f.add<&T::encoding>("encoding",
                        "How a packet is written: of pose and vertices f32; of frames jpeg (if left out), png or rgba.");
    f.add<&T::width>("width", "Of frames, pixels; 1280 if left out.", kPixels);
    f.add<&T::height>("height", "Of frames, pixels; 720 if left out.", kPixels);
    f.add<&T::quality>("quality", "Of jpeg frames; 80 if left out.", kQuality);
    f.add<&T::camera>("camera", "Of frames: where to look from; the scene's camera if left out.");
  }
  [[nodiscard]] Status check() const;
};

/// What tells the stream's producer apart, with everything it names found to be there.
/// @return the errors of the parameters; NotFound; Unavailable for frames where nothing draws
[[nodiscard]] Result<streams::StreamKey> stream_key(const StreamOpenParams& p, const stage::StageView& view,
                                                    const Services& services);

/// Opens a stream for a conversation: what `stream.open` does. Network thread only.
void open_stream(const StreamOpenParams& p, const std::shared_ptr<Conversation>& conversation, const ConnectionDone& done);

}  // namespace tweend::commands
