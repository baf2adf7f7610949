#include "server/streams/stream_key.hpp"

#include <fmt/format.h>

#include <array>

namespace tweend::streams {
namespace {

template <class Enum, std::size_t kCount>
const char* name_of(Enum value, const std::array<const char*, kCount>& names) noexcept {
  return names[static_cast<std::size_t>(value)];
}

std::string labels_of(const PoseSpec& pose) {
  return fmt::format(R"(kind="pose",actor="{}",encoding="{}")", pose.actor, name_of(pose.encoding, std::array{"f32", "q16"}));
}

std::string labels_of(const VerticesSpec& vertices) {
  return fmt::format(R"(kind="vertices",actor="{}",encoding="{}")", vertices.actor,
                     name_of(vertices.encoding, std::array{"f32", "q16", "meshopt"}));
}

std::string labels_of(const FramesSpec& frames) {
  return fmt::format(R"(kind="frames",actor="{}",encoding="{}",width="{}",height="{}",quality="{}",bitrate="{}",rung="{}")",
                     frames.actor, name_of(frames.encoding, std::array{"jpeg", "png", "h264", "rgba"}), frames.size.width,
                     frames.size.height, frames.quality, frames.bit_rate, frames.rung);
}

}  // namespace

std::string labels_of(const StreamKey& key) {
  // Names have no characters that would have to be escaped (docs/PROTOCOL.md, section 3).
  return fmt::format(R"(scene="{}",{},rate="{}")", key.scene,
                     std::visit([](const auto& what) { return labels_of(what); }, key.what), key.rate);
}

bool same_but_view(const StreamKey& a, const StreamKey& b) {
  StreamKey c = b;
  auto* frames = std::get_if<FramesSpec>(&c.what);
  if (const auto* other = std::get_if<FramesSpec>(&a.what); frames != nullptr && other != nullptr)
    frames->camera = other->camera;
  // How many bits a picture may take follows from how many there are.
  if (frames == nullptr || frames->encoding != FrameEncoding::H264) c.rate = a.rate;
  return a == c;
}

}  // namespace tweend::streams
