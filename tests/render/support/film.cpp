#include "tests/render/support/film.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>

namespace tweend::render::test {
namespace {

std::vector<std::string>* complaints = nullptr;

void hear(void*, int level, const char* format, va_list arguments) {
  if (level > AV_LOG_WARNING || complaints == nullptr) return;
  std::array<char, 512> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  complaints->emplace_back(text.data());
}

/// While it lives, what FFmpeg complains about is kept.
struct Hearing {
  explicit Hearing(Film& film) {
    complaints = &film.complaints;
    av_log_set_callback(hear);
  }
  ~Hearing() {
    av_log_set_callback(av_log_default_callback);
    complaints = nullptr;
  }
};

struct Decoder {
  AVCodecContext* context = avcodec_alloc_context3(avcodec_find_decoder(AV_CODEC_ID_H264));
  AVFrame* frame = av_frame_alloc();
  AVPacket* packet = av_packet_alloc();
  Decoder() { context->thread_count = 1; }
  ~Decoder() {
    av_packet_free(&packet);
    av_frame_free(&frame);
    avcodec_free_context(&context);
  }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
};

/// The equations of ITU-R BT.601 in limited range, one chroma sample for each four pixels.
Image rgb_of(const AVFrame& f) {
  EXPECT_EQ(f.format, AV_PIX_FMT_YUV420P);
  EXPECT_EQ(f.colorspace, AVCOL_SPC_SMPTE170M);
  EXPECT_EQ(f.color_range, AVCOL_RANGE_MPEG);
  EXPECT_EQ(f.color_primaries, AVCOL_PRI_BT709);
  EXPECT_EQ(f.color_trc, AVCOL_TRC_IEC61966_2_1);
  Image image(Size{static_cast<std::uint32_t>(f.width), static_cast<std::uint32_t>(f.height)});
  for (std::size_t y = 0; y < image.size.height; ++y) {
    for (std::size_t x = 0; x < image.size.width; ++x) {
      const auto sample = [&](std::size_t plane, std::size_t column, std::size_t row) {
        return static_cast<double>(f.data[plane][row * static_cast<std::size_t>(f.linesize[plane]) + column]);
      };
      const double luma = (sample(0, x, y) - 16.0) / 219.0;
      const double blue = (sample(1, x / 2, y / 2) - 128.0) / 224.0;
      const double red = (sample(2, x / 2, y / 2) - 128.0) / 224.0;
      const auto code = [](double v) { return static_cast<int>(std::lround(255.0 * std::clamp(v, 0.0, 1.0))); };
      const double r = luma + 1.402 * red, b = luma + 1.772 * blue;
      image.set(x, y, {code(r), code((luma - 0.299 * r - 0.114 * b) / 0.587), code(b)});
    }
  }
  return image;
}

/// Hands a packet (null: the end) to the decoder and keeps what comes.
void decode(Decoder& decoder, const AVPacket* packet, Film& film) {
  EXPECT_EQ(avcodec_send_packet(decoder.context, packet), 0);
  while (avcodec_receive_frame(decoder.context, decoder.frame) == 0) {
    film.pictures.push_back({rgb_of(*decoder.frame), decoder.frame->pts, decoder.frame->key_frame != 0});
    film.profile = decoder.context->profile;
    film.level = decoder.context->level;
  }
}

}  // namespace

Film decode_h264(const std::vector<std::vector<std::byte>>& units) {
  Film film;
  const Hearing hearing(film);
  Decoder decoder;
  EXPECT_EQ(avcodec_open2(decoder.context, nullptr, nullptr), 0);
  for (std::size_t k = 0; k < units.size(); ++k) {
    EXPECT_EQ(av_new_packet(decoder.packet, static_cast<int>(units[k].size())), 0);
    std::memcpy(decoder.packet->data, units[k].data(), units[k].size());
    decoder.packet->pts = static_cast<std::int64_t>(k);
    decode(decoder, decoder.packet, film);
    av_packet_unref(decoder.packet);
  }
  decode(decoder, nullptr, film);
  return film;
}

Film decode_mp4(const std::string& path) {
  Film film;
  const Hearing hearing(film);
  AVFormatContext* opened = nullptr;
  if (avformat_open_input(&opened, path.c_str(), nullptr, nullptr) != 0) {
    ADD_FAILURE() << path << " can't be opened";
    return film;
  }
  const auto close = [](AVFormatContext* f) { avformat_close_input(&f); };
  const std::unique_ptr<AVFormatContext, decltype(close)> file(opened, close);
  EXPECT_GE(avformat_find_stream_info(file.get(), nullptr), 0);
  EXPECT_EQ(file->nb_streams, 1U);
  const AVStream& stream = *file->streams[0];
  film.time_base_s = av_q2d(stream.time_base);
  film.duration_s = static_cast<double>(stream.duration) * film.time_base_s;
  Decoder decoder;
  EXPECT_EQ(avcodec_parameters_to_context(decoder.context, stream.codecpar), 0);
  EXPECT_EQ(avcodec_open2(decoder.context, nullptr, nullptr), 0);
  while (av_read_frame(file.get(), decoder.packet) >= 0) {
    decode(decoder, decoder.packet, film);
    av_packet_unref(decoder.packet);
  }
  decode(decoder, nullptr, film);
  return film;
}

double psnr_db(const Image& a, const Image& b) {
  EXPECT_EQ(a.size, b.size);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::pow(int{a.rgb[i]} - int{b.rgb[i]}, 2);
  return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(a.rgb.size()) / std::max(sum, 1e-9));
}

Image moving_picture(Size size, std::size_t k) {
  Image image(size);
  for (std::size_t y = 0; y < size.height; ++y) {
    for (std::size_t x = 0; x < size.width; ++x) {
      const bool inside = x >= 2 * k && x < 2 * k + 16 && y >= 8 && y < 24;
      const auto slope = [](std::size_t part, std::size_t whole) { return static_cast<int>(40 + 160 * part / whole); };
      image.set(x, y, inside ? Rgb{250, 240, 60} : Rgb{slope(x, size.width), slope(y, size.height), 90});
    }
  }
  return image;
}

}  // namespace tweend::render::test
