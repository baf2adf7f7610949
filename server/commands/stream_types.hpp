#pragma once

#include "server/commands/frame_types.hpp"

namespace tweend::commands {

enum class StreamKind : std::uint8_t { Pose, Vertices, Frames };
enum class StreamEncoding : std::uint8_t { F32, Q16, Meshopt, Jpeg, Png, H264, Rgba };
enum class StreamDelivery : std::uint8_t { Latest, Every };

}  // namespace tweend::commands

namespace tweend::protocol {

template <>
struct EnumNames<commands::StreamKind> {
  static constexpr std::array<std::string_view, 3> kNames{"pose", "vertices", "frames"};
};
template <>
struct EnumNames<commands::StreamEncoding> {
  static constexpr std::array<std::string_view, 7> kNames{"f32", "q16", "meshopt", "jpeg", "png", "h264", "rgba"};
};
template <>
struct EnumNames<commands::StreamDelivery> {
  static constexpr std::array<std::string_view, 2> kNames{"latest", "every"};
};

}  // namespace tweend::protocol

namespace tweend::commands {

inline constexpr protocol::Range kRate{.min = 0.0, .max = 240.0, .min_excluded = true};
inline constexpr protocol::Range kBitRate{.min = 10'000.0, .max = 1e9};

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
  std::optional<std::int64_t> bitrate;
  std::optional<bool> adaptive;
  std::optional<OwnCamera> camera;
  static void describe(FieldList<StreamOpenParams>& f) {
    using T = StreamOpenParams;
    f.add<&T::kind>("kind", "What to send.");
    add_scene_field(f);
    f.add<&T::actor>(
        "actor", "Whose pose or vertices; may be left out where the scene has one. Of frames: whose media time they carry.");
    f.add<&T::rate>("rate", "Packets a second; if left out, 60 of a pose and 30 of all else.", kRate);
    f.add<&T::delivery>(
        "delivery",
        "latest (if left out): a slow reader skips; every: none is skipped, and who falls too far behind is disconnected.");
    f.add<&T::encoding>(
        "encoding",
        "How a packet is written: of a pose f32 (if left out) or q16; of vertices f32 (if left out), q16 or meshopt; of frames "
        "jpeg (if left out), png, h264 or rgba.");
    f.add<&T::width>("width", "Of frames, pixels; 1280 if left out.", kPixels);
    f.add<&T::height>("height", "Of frames, pixels; 720 if left out.", kPixels);
    f.add<&T::quality>("quality", "Of jpeg frames; 80 if left out.", kQuality);
    f.add<&T::bitrate>("bitrate", "Of h264 frames: bits a second that are not exceeded; if left out, as many as it takes.",
                       kBitRate);
    f.add<&T::adaptive>(
        "adaptive",
        "Of jpeg frames delivered as latest: whether a reader that can't take them is sent smaller ones; true if "
        "left out.");
    f.add<&T::camera>("camera", "Of frames: where to look from; the scene's camera if left out.");
  }
  [[nodiscard]] Status check() const;
  [[nodiscard]] StreamPolicy policy() const noexcept;
};

/// What tells the stream's producer apart, with everything it names found to be there.
/// @return the errors of the parameters; NotFound; Unavailable for frames where nothing draws
[[nodiscard]] Result<streams::StreamKey> stream_key(const StreamOpenParams& p, const stage::StageView& view,
                                                    const Services& services);

/// Opens a stream for a conversation: what `stream.open` does. Network thread only.
void open_stream(const StreamOpenParams& p, const std::shared_ptr<Conversation>& conversation, const ConnectionDone& done);

}  // namespace tweend::commands
