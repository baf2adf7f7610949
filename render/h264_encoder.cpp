#include "render/h264_encoder.hpp"

#include <fmt/format.h>
#include <libyuv/convert.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "render/ffmpeg.hpp"
#include "render/h264_level.hpp"

namespace tweend::render {
namespace {

using ffmpeg::Owned;

/// Steps of x264's scale of quality, on which six more halve the bits: what a stream may lose unseen, and a file less.
constexpr const char* kLiveQuality = "23";
constexpr const char* kFileQuality = "19";
/// Of the bits a second may take this part flows evenly; the rest is how far a picture, a key one above all, may run ahead. So
/// the two together are what any second takes at most.
constexpr double kEven = 0.8;
/// Streams are many and small: each takes one thread at a time. A file is one and wants to be done.
constexpr int kLiveThreads = 1, kFileThreads = 4;

Status check(const H264Options& o) {
  const Size size = o.size;
  if (size.width == 0 || size.height == 0 || size.width % 2 != 0 || size.height % 2 != 0) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected even sides of a picture in H.264, found {} x {} pixels; one pixel "
                            "more or less will do",
                            size.width, size.height));
  }
  if (std::max(size.width, size.height) > kH264MostPixels) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected sides of at most {} pixels in H.264, found {} x {}",
                                                      kH264MostPixels, size.width, size.height));
  }
  if (!std::isfinite(o.rate) || o.rate <= 0.0)
    return fail(ErrorCode::InvalidParams, fmt::format("expected a rate above 0, found {}", o.rate));
  if (o.bit_rate == 0) return {};
  if (const std::int64_t least = h264_least(size, o.rate).bit_rate; o.bit_rate < least) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected at least {} bits a second for {} x {} pixels, found {}; ask for smaller pictures", least,
                            size.width, size.height, o.bit_rate));
  }
  return {};
}

void set_picture(const H264Options& o, AVCodecContext& context) {
  context.width = static_cast<int>(o.size.width);
  context.height = static_cast<int>(o.size.height);
  context.pix_fmt = AV_PIX_FMT_YUV420P;
  context.framerate = av_d2q(o.rate, 1 << 16);
  context.time_base = av_inv_q(context.framerate);
  context.sample_aspect_ratio = {1, 1};
  context.color_range = AVCOL_RANGE_MPEG;
  context.colorspace = AVCOL_SPC_SMPTE170M;
  context.color_primaries = AVCOL_PRI_BT709;
  context.color_trc = AVCOL_TRC_IEC61966_2_1;
  // Where libyuv's mean of four pixels lies.
  context.chroma_sample_location = AVCHROMA_LOC_CENTER;
}

void set_bits(const H264Options& o, AVCodecContext& context) {
  // Also without a limit of the caller's there is the level's, which the bitstream says is kept.
  const H264Level& level = h264_level(o.size, o.rate);
  context.level = level.idc;
  if (o.bit_rate == 0) {
    context.rc_max_rate = level.bit_rate;
    context.rc_buffer_size = static_cast<int>(level.bit_rate);
    return;
  }
  // x264 forgets what its coarsest pictures take too much: that is set aside. The rest flows by the picture and not by the
  // clock, and a second may have one picture more than its rate. Fewer than four a second need more room than a second has.
  const double rate = h264_paced(o.rate);
  const auto shared = static_cast<double>(std::min(o.bit_rate, level.bit_rate) - h264_least(o.size, o.rate).bits_s);
  context.framerate = av_d2q(rate, 1 << 16);
  context.time_base = av_inv_q(context.framerate);
  context.rc_max_rate = std::llround(kEven * shared * rate / (rate + 1.0));
  context.rc_buffer_size = static_cast<int>(std::llround(shared - kEven * shared));
}

int set_coding(const H264Options& o, AVCodecContext& context) {
  context.gop_size = std::numeric_limits<int>::max();  // keys are asked for
  context.max_b_frames = 0;
  context.thread_count = o.live ? kLiveThreads : kFileThreads;
  context.flags = static_cast<int>(AV_CODEC_FLAG_CLOSED_GOP) | (o.live ? 0 : static_cast<int>(AV_CODEC_FLAG_GLOBAL_HEADER));
  int error = 0;
  const auto set = [&](const char* name, const char* value) {
    if (error >= 0) error = av_opt_set(context.priv_data, name, value, 0);
  };
  set("preset", o.live ? "ultrafast" : "veryfast");
  set("tune", "zerolatency");  // a picture in, its unit out
  set("profile", o.live ? "baseline" : "high");
  set("crf", o.live ? kLiveQuality : kFileQuality);
  set("forced-idr", "1");
  set("sc_threshold", "0");
  return error;
}

}  // namespace

struct H264Encoder::Impl {
  Size size;
  Owned<AVCodecContext> context;
  Owned<AVFrame> frame;
  Owned<AVPacket> packet;
};

bool has_h264() noexcept { return true; }

Result<H264Encoder> H264Encoder::open(const H264Options& options) {
  TWEEND_TRY(check(options));
  ffmpeg::be_quiet();
  const auto unavailable = [&](const std::string& reason) {
    return fail(ErrorCode::Unavailable, fmt::format("expected an H.264 encoder for {} x {} pixels, found: {}",
                                                    options.size.width, options.size.height, reason));
  };
  const AVCodec* codec = avcodec_find_encoder_by_name("libx264");
  if (codec == nullptr) return unavailable("FFmpeg's libavcodec is there without libx264; install one with it");
  auto impl = std::make_unique<Impl>();
  impl->size = options.size;
  impl->context.reset(avcodec_alloc_context3(codec));
  impl->frame.reset(av_frame_alloc());
  impl->packet.reset(av_packet_alloc());
  if (!impl->context || !impl->frame || !impl->packet) return unavailable("no memory");
  AVCodecContext& context = *impl->context;
  set_picture(options, context);
  set_bits(options, context);
  int error = set_coding(options, context);
  if (error >= 0) error = avcodec_open2(&context, codec, nullptr);
  if (error < 0) return unavailable(ffmpeg::reason(error));
  impl->frame->width = context.width;
  impl->frame->height = context.height;
  impl->frame->format = context.pix_fmt;
  impl->frame->pts = -1;
  if (error = av_frame_get_buffer(impl->frame.get(), 0); error < 0) return unavailable(ffmpeg::reason(error));
  return H264Encoder(std::move(impl));
}

H264Encoder::H264Encoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
H264Encoder::~H264Encoder() = default;
H264Encoder::H264Encoder(H264Encoder&&) noexcept = default;
H264Encoder& H264Encoder::operator=(H264Encoder&&) noexcept = default;

Result<H264Encoder::Unit> H264Encoder::encode(const ImageView& image, bool key) {
  if (image.size != impl_->size) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected a picture of {} x {} pixels, found {} x {}", impl_->size.width,
                                                      impl_->size.height, image.size.width, image.size.height));
  }
  AVFrame& frame = *impl_->frame;
  AVPacket& packet = *impl_->packet;
  const auto failed = [](int error) {
    return fail(ErrorCode::Internal, fmt::format("expected a picture in H.264, found: {}", ffmpeg::reason(error)));
  };
  if (const int error = av_frame_make_writable(&frame); error < 0) return failed(error);
  // Its name is that of the word, ours that of the bytes; a negative height reads from the last row up.
  const int converted = libyuv::ABGRToI420(reinterpret_cast<const std::uint8_t*>(image.bytes.data()),
                                           static_cast<int>(image.row_bytes()), frame.data[0], frame.linesize[0], frame.data[1],
                                           frame.linesize[1], frame.data[2], frame.linesize[2], frame.width, -frame.height);
  if (converted != 0) return failed(AVERROR(EINVAL));
  ++frame.pts;
  frame.pict_type = key ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
  if (const int error = avcodec_send_frame(impl_->context.get(), &frame); error < 0) return failed(error);
  if (const int error = avcodec_receive_packet(impl_->context.get(), &packet); error < 0) return failed(error);
  return Unit{std::as_bytes(std::span(packet.data, static_cast<std::size_t>(packet.size))),
              (packet.flags & AV_PKT_FLAG_KEY) != 0};
}

std::span<const std::byte> H264Encoder::parameter_sets() const noexcept {
  const AVCodecContext& context = *impl_->context;
  return std::as_bytes(std::span(context.extradata, static_cast<std::size_t>(context.extradata_size)));
}

}  // namespace tweend::render
