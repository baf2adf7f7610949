#include "tests/streams/picturing.hpp"

#include <spng.h>
#include <turbojpeg.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "server/streams/still.hpp"

namespace tweend::test {
namespace {

const unsigned char* bytes_of(std::span<const std::byte> file) { return reinterpret_cast<const unsigned char*>(file.data()); }

}  // namespace

Decoded decode_jpeg(std::span<const std::byte> file) {
  Decoded out;
  int width = 0, height = 0, subsampling = 0, colors = 0;
  const std::unique_ptr<void, int (*)(void*)> reader(tjInitDecompress(), tjDestroy);
  EXPECT_EQ(tjDecompressHeader3(reader.get(), bytes_of(file), file.size(), &width, &height, &subsampling, &colors), 0);
  out.size = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
  out.rgba.resize(std::size_t{4} * out.size.width * out.size.height);
  EXPECT_EQ(tjDecompress2(reader.get(), bytes_of(file), file.size(), out.rgba.data(), width, 0, height, TJPF_RGBA, 0), 0);
  return out;
}

Decoded decode_png(std::span<const std::byte> file) {
  Decoded out;
  const std::unique_ptr<spng_ctx, void (*)(spng_ctx*)> reader(spng_ctx_new(0), spng_ctx_free);
  EXPECT_EQ(spng_set_png_buffer(reader.get(), file.data(), file.size()), 0);
  spng_ihdr header{};
  EXPECT_EQ(spng_get_ihdr(reader.get(), &header), 0);
  out.size = {header.width, header.height};
  out.rgba.resize(std::size_t{4} * out.size.width * out.size.height);
  EXPECT_EQ(spng_decode_image(reader.get(), out.rgba.data(), out.rgba.size(), SPNG_FMT_RGBA8, 0), 0);
  return out;
}

Decoded decode_rgba(std::span<const std::byte> bytes, render::Size size) {
  Decoded out{size, std::vector<std::uint8_t>(bytes.size())};
  EXPECT_EQ(bytes.size(), std::size_t{4} * size.width * size.height);
  if (!bytes.empty()) std::memcpy(out.rgba.data(), bytes.data(), bytes.size());
  return out;
}

Decoded decoded(const render::ImageView& image) {
  Decoded out{image.size, {}};
  for (std::size_t y = 0; y < image.size.height; ++y) {
    for (const std::byte byte : image.row(y)) out.rgba.push_back(static_cast<std::uint8_t>(byte));
  }
  return out;
}

Decoded decoded(const streams::Packet& packet, render::Size size) {
  const auto payload = packet.payload.bytes();
  switch (packet.header.encoding) {
    case protocol::kFrameJpeg:
      return decode_jpeg(payload);
    case protocol::kFramePng:
      return decode_png(payload);
    default:
      return decode_rgba(payload, size);
  }
}

double mean_difference(const Decoded& a, const Decoded& b) {
  if (a.size != b.size || a.rgba.size() != b.rgba.size() || a.rgba.empty()) return 255.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
  return sum / static_cast<double>(a.rgba.size());
}

std::size_t covered(const Decoded& picture) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    count += std::equal(&picture.rgba[i], &picture.rgba[i] + 4, picture.rgba.data()) ? 0U : 1U;
  }
  return count;
}

model::CameraRequest from_above(float height) {
  model::CameraRequest camera;
  camera.eye = glm::vec3(0.5F, height, 3.0F);
  camera.target = glm::vec3(0.5F, 0.0F, 0.5F);
  return camera;
}

streams::StreamKey frames_of(std::string scene, streams::FrameEncoding encoding, double rate) {
  return {std::move(scene), rate, streams::FramesSpec{"", encoding, kSmall, 95, from_above(), 0, 0}};
}

streams::StreamKey seen_by(streams::StreamKey key, model::CameraRequest camera) {
  std::get<streams::FramesSpec>(key.what).camera = std::move(camera);
  return key;
}

Decoded picture_of(Streaming& s, const streams::StreamKey& key, const stage::SceneViewPtr& view, ClockUs at_us) {
  const auto& spec = std::get<streams::FramesSpec>(key.what);
  streams::StillRequest request;
  request.view = view;
  request.now_us = at_us;
  request.size = spec.size;
  request.camera = spec.camera;
  std::promise<Result<streams::DrawnStill>> promise;
  streams::draw_still(std::move(request), s.workers, s.renderer,
                      [&promise](Result<streams::DrawnStill> drawn) { promise.set_value(std::move(drawn)); });
  const Result<streams::DrawnStill> drawn = promise.get_future().get();
  EXPECT_TRUE(drawn) << "nothing draws";
  return drawn ? decoded(drawn->pixels->view()) : Decoded{};
}

}  // namespace tweend::test
