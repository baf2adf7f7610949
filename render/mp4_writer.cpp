#include "render/mp4_writer.hpp"

extern "C" {
#include <libavformat/avformat.h>
}

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "render/ffmpeg.hpp"
#include "render/h264_encoder.hpp"

namespace tweend::render {
namespace {

constexpr double kKeyEveryS = 2.0;
constexpr int kBufferBytes = 64 << 10;
/// Finer than any rate that is meant: what lies between two such is taken for the simpler one.
constexpr int kFinest = 1'000'000;

Status check(const Mp4Options& o) {
  // NaN, too.
  if (!(o.fps >= 1.0 / kFinest && o.fps <= kFinest)) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected {} to {} pictures a second, found {}", 1.0 / kFinest, kFinest, o.fps));
  }
  if (o.pictures.value_or(0) <= Mp4Writer::kMostPictures) return {};
  return fail(ErrorCode::Limit,
              fmt::format("expected a film of at most {} pictures, found {}", Mp4Writer::kMostPictures, *o.pictures));
}

/// The place in the file where FFmpeg writes next, and what went wrong there.
struct Place {
  FileSink& file;
  std::int64_t at = 0;
  std::int64_t end = 0;
  Status status;
};

int write_piece(void* opaque, std::uint8_t* bytes, int size) {
  Place& place = *static_cast<Place*>(opaque);
  if (!place.status) return AVERROR(EIO);
  place.status = place.file.write_at(static_cast<std::uint64_t>(place.at),
                                     std::as_bytes(std::span(bytes, static_cast<std::size_t>(size))));
  if (!place.status) return AVERROR(EIO);
  place.at += size;
  place.end = std::max(place.end, place.at);
  return size;
}

std::int64_t seek(void* opaque, std::int64_t offset, int whence) {
  Place& place = *static_cast<Place*>(opaque);
  if ((whence & AVSEEK_SIZE) != 0) return place.end;
  const std::int64_t base = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? place.at : place.end;
  if (base + offset < 0) return AVERROR(EINVAL);
  return place.at = base + offset;
}

struct FormatDeleter {
  void operator()(AVFormatContext* format) const { avformat_free_context(format); }
  void operator()(AVIOContext* io) const {
    av_freep(static_cast<void*>(&io->buffer));
    avio_context_free(&io);
  }
};

void describe(AVCodecParameters& codec, Size size) {
  codec.codec_type = AVMEDIA_TYPE_VIDEO;
  codec.codec_id = AV_CODEC_ID_H264;
  codec.width = static_cast<int>(size.width);
  codec.height = static_cast<int>(size.height);
  codec.format = AV_PIX_FMT_YUV420P;
  codec.sample_aspect_ratio = {1, 1};
  // As H264Encoder says in its bitstream: here for players that look no deeper.
  codec.color_range = AVCOL_RANGE_MPEG;
  codec.color_space = AVCOL_SPC_SMPTE170M;
  codec.color_primaries = AVCOL_PRI_BT709;
  codec.color_trc = AVCOL_TRC_IEC61966_2_1;
}

}  // namespace

struct Mp4Writer::Impl {
  Impl(H264Encoder opened, FileSink& file) : encoder(std::move(opened)), place{file, 0, 0, {}} {}

  H264Encoder encoder;
  Place place;
  std::unique_ptr<AVIOContext, FormatDeleter> io;
  std::unique_ptr<AVFormatContext, FormatDeleter> format;  // before `io`, which it writes to
  ffmpeg::Owned<AVPacket> packet;
  AVRational fps{30, 1};
  std::size_t pictures = 0;
  std::size_t key_every = 1;

  int prepare(const Mp4Options& options);
  [[nodiscard]] Error failed(int error) const {
    if (!place.status) return place.status.error();
    return fail(ErrorCode::Internal, fmt::format("expected an MP4 file, found: {}", ffmpeg::reason(error)));
  }
};

int Mp4Writer::Impl::prepare(const Mp4Options& options) {
  packet.reset(av_packet_alloc());
  auto* buffer = static_cast<unsigned char*>(av_malloc(kBufferBytes));
  if (buffer != nullptr) io.reset(avio_alloc_context(buffer, kBufferBytes, 1, &place, nullptr, write_piece, seek));
  if (buffer != nullptr && !io) av_free(buffer);
  AVFormatContext* made = nullptr;
  if (const int error = avformat_alloc_output_context2(&made, nullptr, "mp4", nullptr); error < 0) return error;
  format.reset(made);
  AVStream* stream = avformat_new_stream(made, nullptr);
  if (!packet || !io || stream == nullptr) return AVERROR(ENOMEM);
  made->pb = io.get();
  made->flags |= AVFMT_FLAG_BITEXACT;
  describe(*stream->codecpar, options.size);
  const auto sets = encoder.parameter_sets();
  stream->codecpar->extradata = static_cast<std::uint8_t*>(av_mallocz(sets.size() + AV_INPUT_BUFFER_PADDING_SIZE));
  if (stream->codecpar->extradata == nullptr) return AVERROR(ENOMEM);
  std::memcpy(stream->codecpar->extradata, sets.data(), sets.size());
  stream->codecpar->extradata_size = static_cast<int>(sets.size());
  stream->time_base = {1, fps.num};
  stream->avg_frame_rate = fps;
  if (options.pictures) {
    const auto reserved = static_cast<std::int64_t>(kIndexBytes + kIndexBytesEach * *options.pictures);
    if (const int error = av_opt_set_int(made->priv_data, "moov_size", reserved, 0); error < 0) return error;
  }
  return avformat_write_header(made, nullptr);
}

Result<Mp4Writer> Mp4Writer::open(const Mp4Options& options, FileSink& file) {
  TWEEND_TRY(check(options));
  TWEEND_ASSIGN(H264Encoder encoder, H264Encoder::open({.size = options.size, .rate = options.fps, .live = false}));
  auto impl = std::make_unique<Impl>(std::move(encoder), file);
  impl->fps = av_d2q(options.fps, kFinest);
  impl->key_every = static_cast<std::size_t>(std::max(1.0, std::round(kKeyEveryS * options.fps)));
  if (const int error = impl->prepare(options); error < 0) return impl->failed(error);
  return Mp4Writer(std::move(impl));
}

Mp4Writer::Mp4Writer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Mp4Writer::~Mp4Writer() = default;
Mp4Writer::Mp4Writer(Mp4Writer&&) noexcept = default;
Mp4Writer& Mp4Writer::operator=(Mp4Writer&&) noexcept = default;

Status Mp4Writer::add(const ImageView& image) {
  Impl& own = *impl_;
  TWEEND_ASSIGN(const H264Encoder::Unit unit, own.encoder.encode(image, own.pictures % own.key_every == 0));
  AVPacket& packet = *own.packet;
  // Its bytes are the encoder's: the muxer makes its own of them.
  packet.data = reinterpret_cast<std::uint8_t*>(const_cast<std::byte*>(unit.bytes.data()));
  packet.size = static_cast<int>(unit.bytes.size());
  packet.flags = unit.key ? AV_PKT_FLAG_KEY : 0;
  const AVStream& stream = *own.format->streams[0];
  packet.stream_index = 0;
  packet.pts = packet.dts = static_cast<std::int64_t>(own.pictures) * own.fps.den;
  packet.duration = own.fps.den;
  av_packet_rescale_ts(&packet, {1, own.fps.num}, stream.time_base);
  const int error = av_write_frame(own.format.get(), &packet);
  av_packet_unref(&packet);
  if (error < 0 || !own.place.status) return own.failed(error);
  ++own.pictures;
  return {};
}

Status Mp4Writer::finish() {
  Impl& own = *impl_;
  if (own.pictures == 0) return fail(ErrorCode::InvalidParams, "expected a film of at least one picture, found none");
  const int error = av_write_trailer(own.format.get());
  avio_flush(own.io.get());
  if (error < 0 || !own.place.status) return own.failed(error);
  return {};
}

std::size_t Mp4Writer::pictures() const noexcept { return impl_->pictures; }
std::uint64_t Mp4Writer::bytes() const noexcept { return static_cast<std::uint64_t>(impl_->place.end); }

}  // namespace tweend::render
