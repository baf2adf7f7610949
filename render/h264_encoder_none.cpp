// In place of h264_encoder.cpp where H.264 was left out (CMake option TWEEND_H264).
#include <memory>
#include <utility>

#include "render/h264_encoder.hpp"

namespace tweend::render {

struct H264Encoder::Impl {};

bool has_h264() noexcept { return false; }

Result<H264Encoder> H264Encoder::open(const H264Options&) {
  return fail(ErrorCode::Unavailable,
              "expected a build with H.264, found one without; build tweend with -DTWEEND_H264=ON for it");
}

H264Encoder::H264Encoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
H264Encoder::~H264Encoder() = default;
H264Encoder::H264Encoder(H264Encoder&&) noexcept = default;
H264Encoder& H264Encoder::operator=(H264Encoder&&) noexcept = default;

Result<H264Encoder::Unit> H264Encoder::encode(const ImageView&, bool) {
  return fail(ErrorCode::Unavailable, "expected a build with H.264, found one without");
}

std::span<const std::byte> H264Encoder::parameter_sets() const noexcept { return {}; }

}  // namespace tweend::render
