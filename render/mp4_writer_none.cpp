// In place of mp4_writer.cpp where H.264 was left out (CMake option TWEEND_H264).
#include <utility>

#include "render/h264_encoder.hpp"
#include "render/mp4_writer.hpp"

namespace tweend::render {

struct Mp4Writer::Impl {};

Result<Mp4Writer> Mp4Writer::open(const Mp4Options& options, FileSink&) {
  return H264Encoder::open({.size = options.size, .rate = options.fps, .live = false}).error();
}

Mp4Writer::Mp4Writer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Mp4Writer::~Mp4Writer() = default;
Mp4Writer::Mp4Writer(Mp4Writer&&) noexcept = default;
Mp4Writer& Mp4Writer::operator=(Mp4Writer&&) noexcept = default;

// Without an encoder there is no writer that any of these could be asked of.
Status Mp4Writer::add(const ImageView&) {
  return fail(ErrorCode::Unavailable, "expected a build with H.264, found one without");
}
Status Mp4Writer::finish() { return fail(ErrorCode::Unavailable, "expected a build with H.264, found one without"); }
std::size_t Mp4Writer::pictures() const noexcept { return 0; }
std::uint64_t Mp4Writer::bytes() const noexcept { return 0; }

}  // namespace tweend::render
