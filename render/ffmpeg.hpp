#pragma once

// What files that call FFmpeg share; for render's .cpp files only.

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/log.h>
#include <libavutil/opt.h>
}

#include <array>
#include <memory>
#include <string>

namespace tweend::render::ffmpeg {

struct Deleter {
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
template <class T>
using Owned = std::unique_ptr<T, Deleter>;

/// FFmpeg's words for what one of its functions returned.
[[nodiscard]] inline std::string reason(int error) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(error, text.data(), text.size());
  return text.data();
}

/// What it has to say is returned as an error, or of no interest: nothing is printed past the log.
inline void be_quiet() noexcept { av_log_set_level(AV_LOG_QUIET); }

}  // namespace tweend::render::ffmpeg
