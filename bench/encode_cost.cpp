// What a picture of 1280 x 720 costs to encode, and what it weighs: JPEG, PNG and H.264 beside a copy of its pixels, which is
// what `rgba` sends. A sphere that grows lobes, thirty pictures a second, there and back without a jump; every encoder takes
// each picture in turn. Its cost is what processors compute, on whichever threads; how long it takes besides is told.

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <spng.h>
#include <turbojpeg.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bench/support/ratio.hpp"
#include "bench/support/server_process.hpp"
#include "bench/support/sphere_scene.hpp"
#include "render/egl_context.hpp"
#include "render/h264_encoder.hpp"
#include "render/image_encoder.hpp"
#include "render/readback.hpp"
#include "render/render_target.hpp"
#include "render/renderer.hpp"
#include "server/streams/frame_composer.hpp"

namespace {

using namespace tweend;

constexpr render::Size kSize{1280, 720};
constexpr int kQuality = 80;
constexpr double kRate = 30.0;
constexpr std::size_t kPictures = 16;  // drawn; 3.7 MB each
constexpr std::size_t kTurns = 150;
constexpr std::size_t kTurnsAPng = 15;  // it takes ten times as long as the others

using Bytes = std::vector<std::byte>;

template <class T>
T must(Result<T> result) {
  if (!result) bench::give_up(result.error().message);
  return std::move(*result);
}

/// RGBA, bottom row first, of successive moments.
std::vector<Bytes> draw_pictures() {
  const auto context = must(render::EglContext::open());
  const auto renderer = must(render::Renderer::make(std::size_t{1} << 30U));
  const auto target = must(render::RenderTarget::make(kSize, 1));
  const stage::SceneViewPtr view = bench::playing_sphere({48});
  render::ReadbackPool pool;
  streams::FrameComposer composer;
  stage::Show show;
  render::Picture picture;
  std::vector<Bytes> pictures;
  for (std::size_t i = 0; i < kPictures; ++i) {
    stage::show_at(*view, static_cast<ClockUs>(static_cast<double>(i) * 1e6 / kRate), show);
    composer.compose(show, {}, kSize, picture);
    renderer->draw(picture, *target);
    const render::PixelsPtr pixels = pool.take(kSize);
    target->read_into(pixels->buffer());
    glFinish();
    const auto bytes = pixels->view().bytes;
    pictures.emplace_back(bytes.begin(), bytes.end());
  }
  return pictures;
}

/// What all threads of this program have computed so far.
double computed_ms() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// Times and sizes of one way to encode.
struct Encoding {
  const char* name;
  std::function<std::span<const std::byte>(const render::ImageView&)> encode;  ///< the result is good until the next call
  std::size_t every = 1;                                                       ///< of so many turns it takes part in one
  std::vector<double> ms{}, cpu_ms{}, bytes{};

  void take_turn(std::size_t turn, const render::ImageView& image) {
    if (turn % every != 0) return;
    const auto start = std::chrono::steady_clock::now();
    const double cpu_before_ms = computed_ms();
    const std::size_t size = encode(image).size();
    cpu_ms.push_back(computed_ms() - cpu_before_ms);
    ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    bytes.push_back(static_cast<double>(size));
  }
};

/// What `rgba` sends: the top row first.
std::span<const std::byte> copy_rows(const render::ImageView& image, Bytes& out) {
  for (std::size_t y = 0; y < image.size.height; ++y) {
    std::memcpy(out.data() + y * image.row_bytes(), image.row(y).data(), image.row_bytes());
  }
  return out;
}

/// Of 8-bit channels, dB. @param step  bytes a pixel of `found`: RGB or RGBA, top row first
double psnr(const render::ImageView& image, std::span<const std::uint8_t> found, std::size_t step) {
  double sum = 0.0;
  const std::size_t width = image.size.width, height = image.size.height;
  if (found.size() != width * height * step) bench::give_up("a picture came back with another size");
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        const int off = std::to_integer<int>(image.row(y)[4 * x + c]) - static_cast<int>(found[(y * width + x) * step + c]);
        sum += off * off;
      }
    }
  }
  return sum == 0.0 ? INFINITY : 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(width * height * 3) / sum);
}

void require_jpeg(const render::ImageView& image, std::span<const std::byte> file) {
  std::vector<std::uint8_t> rgb(std::size_t{3} * image.size.width * image.size.height);
  const tjhandle decoder = tjInitDecompress();
  const int failed = tjDecompress2(decoder, reinterpret_cast<const unsigned char*>(file.data()), file.size(), rgb.data(),
                                   static_cast<int>(image.size.width), 0, static_cast<int>(image.size.height), TJPF_RGB, 0);
  tjDestroy(decoder);
  if (const double db = failed != 0 ? 0.0 : psnr(image, rgb, 3); db < 35.0) {
    bench::give_up(fmt::format("expected a JPEG that is 35 dB like its picture, found {:.1f}", db));
  }
}

void require_png(const render::ImageView& image, std::span<const std::byte> file) {
  std::vector<std::uint8_t> rgb(std::size_t{3} * image.size.width * image.size.height);
  const std::unique_ptr<spng_ctx, void (*)(spng_ctx*)> decoder(spng_ctx_new(0), spng_ctx_free);
  if (spng_set_png_buffer(decoder.get(), file.data(), file.size()) != 0 ||
      spng_decode_image(decoder.get(), rgb.data(), rgb.size(), SPNG_FMT_RGB8, 0) != 0 || !std::isinf(psnr(image, rgb, 3))) {
    bench::give_up("expected a PNG that is its picture");
  }
}

void print(const Encoding& encoding) {
  std::printf("%-24s %8.2f %8.2f %12.0f\n", encoding.name, bench::median(encoding.cpu_ms), bench::median(encoding.ms),
              bench::median(encoding.bytes));
}

/// The median over turns that both took.
double ratio(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
  return bench::median(std::move(ratios));
}

}  // namespace

int main() {
  const std::vector<Bytes> pictures = draw_pictures();
  const auto image = [&](std::size_t turn) {
    const std::size_t phase = turn % (2 * kPictures - 2);
    return render::ImageView{kSize, pictures[phase < kPictures ? phase : 2 * kPictures - 2 - phase]};
  };
  Bytes raw(pictures.front().size()), jpeg(render::JpegEncoder::most_bytes(kSize)), png;
  render::JpegEncoder jpeg_encoder;
  std::optional<render::H264Encoder> h264_encoder;
  if (render::has_h264()) h264_encoder = must(render::H264Encoder::open({kSize, kRate, 0, true}));

  Encoding of_copy{"rgba, a copy", [&](const render::ImageView& from) { return copy_rows(from, raw); }};
  Encoding of_jpeg{"jpeg q80", [&](const render::ImageView& from) {
                     return std::span<const std::byte>(jpeg).first(must(jpeg_encoder.encode(from, kQuality, jpeg)));
                   }};
  Encoding of_png{"png",
                  [&](const render::ImageView& from) {
                    png = must(render::encode_png(from));
                    return std::span<const std::byte>(png);
                  },
                  kTurnsAPng};
  bool key = true;
  Encoding of_h264{"h264",
                   [&](const render::ImageView& from) {
                     const auto unit = must(h264_encoder->encode(from, std::exchange(key, false)));
                     if (unit.bytes.empty()) bench::give_up("expected a unit for every picture, found none");
                     return unit.bytes;
                   },
                   h264_encoder ? 1 : SIZE_MAX};

  require_jpeg(image(5), of_jpeg.encode(image(5)));
  require_png(image(5), of_png.encode(image(5)));
  for (std::size_t turn = 1; turn <= kTurns; ++turn) {
    for (Encoding* encoding : {&of_copy, &of_jpeg, &of_h264, &of_png}) encoding->take_turn(turn, image(turn));
  }
  std::printf("a picture of %u x %u      CPU ms       ms        bytes\n", kSize.width, kSize.height);
  for (const Encoding* encoding : {&of_copy, &of_jpeg, &of_png}) print(*encoding);
  std::vector<bench::Claim> claims{{"encode_cost_jpeg_vs_copy", ratio(of_jpeg.cpu_ms, of_copy.cpu_ms), 5.0}};
  if (h264_encoder) {
    print(of_h264);
    claims.push_back({"encode_cost_h264_vs_jpeg", ratio(of_h264.cpu_ms, of_jpeg.cpu_ms), 1.8});
    claims.push_back({"encode_bytes_h264_vs_jpeg", ratio(of_h264.bytes, of_jpeg.bytes), 0.3});
  } else {
    std::printf("this build has no H.264\n");
  }
  return bench::report(claims) ? 0 : 1;
}
