#include "server/streams/frame_content.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cstring>
#include <utility>

namespace tweend::streams {
namespace {

std::uint8_t encoding_number(FrameEncoding encoding) noexcept {
  switch (encoding) {
    case FrameEncoding::Jpeg:
      return protocol::kFrameJpeg;
    case FrameEncoding::Png:
      return protocol::kFramePng;
    case FrameEncoding::Rgba:
      return protocol::kFrameRgba;
  }
  return protocol::kFrameJpeg;
}

}  // namespace

bool FrameContent::follow(const stage::SceneViewPtr& view) {
  view_ = view;
  return spec_.actor.empty() || view->find_player(spec_.actor) != nullptr;
}

bool FrameContent::shows_the_same(const stage::SceneView& next) const noexcept {
  return next.scene == view_->scene && *next.players == *view_->players;
}

ClockUs FrameContent::earliest_us() const noexcept {
  ClockUs earliest = 0;
  for (const stage::Player& player : *view_->players) earliest = std::max(earliest, player.anchor_us);
  return earliest;
}

ContentReading FrameContent::read(ClockUs at_us) {
  stage::show_at(*view_, at_us, show_);
  ContentReading reading;
  for (const stage::ActorShow& actor : show_.actors) {
    if (!actor.actor->settings.visible) continue;
    reading.moving = reading.moving || actor.moving || actor.turning;
    // Mixed, not summed: one player's wrap forwards and another's backwards are two jumps and not none.
    constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15U;
    reading.continuity = (reading.continuity ^ actor.continuity) * kOdd;
  }
  const auto named = std::find_if(show_.actors.begin(), show_.actors.end(),
                                  [this](const stage::ActorShow& a) { return a.actor->name == spec_.actor; });
  if (named != show_.actors.end()) {
    reading.time_s = named->time_s;
  } else if (!show_.actors.empty()) {
    reading.time_s = show_.actors.front().time_s;
  }
  return reading;
}

void FrameContent::begin(NewPacketPtr packet, ClockUs deadline_us) {
  drawing_packet_ = std::move(packet);
  drawing_packet_->header.kind = protocol::PacketKind::Frame;
  drawing_packet_->header.encoding = encoding_number(spec_.encoding);
  camera_ = spec_.camera;
  deadline_us_ = deadline_us;
  workers_.post([this] { compose(); });
}

void FrameContent::compose() {
  composer_.compose(show_, camera_, spec_.size, picture_);
  renderer_.submit(shared_from_this(), deadline_us_);
}

void FrameContent::drawn(Result<render::PixelsPtr> pixels) noexcept {
  pixels_ = std::move(pixels);
  boost::asio::post(strand_, [this] { drawn_on_strand(); });
}

void FrameContent::drawn_on_strand() {
  waiting_ = true;
  if (!encoding_) encode_next();
}

void FrameContent::encode_next() {
  waiting_ = false;
  encoding_packet_ = std::move(drawing_packet_);
  encoding_pixels_ = std::move(pixels_);
  owner_.ready();
  if (encoding_pixels_) {
    encoding_ = true;
    workers_.post([this] { encode(); });
  } else {
    outcome_ = encoding_pixels_.error();
    encoded();
  }
}

void FrameContent::encode() {
  outcome_ = write((*encoding_pixels_)->view(), encoding_packet_->payload);
  encoding_pixels_ = render::PixelsPtr();
  boost::asio::post(strand_, [this] { encoded(); });
}

Status FrameContent::write(const render::ImageView& image, Payload& payload) {
  if (spec_.encoding == FrameEncoding::Jpeg) {
    TWEEND_ASSIGN(const std::size_t bytes,
                  jpeg_.encode(image, spec_.quality, payload.resize(render::JpegEncoder::most_bytes(image.size))));
    payload.truncate(bytes);
  } else if (spec_.encoding == FrameEncoding::Png) {
    TWEEND_ASSIGN(const std::vector<std::byte> file, render::encode_png(image));
    std::memcpy(payload.resize(file.size()).data(), file.data(), file.size());
  } else {
    std::byte* to = payload.resize(image.bytes.size()).data();
    for (std::size_t y = 0; y < image.size.height; ++y) {
      std::memcpy(to + y * image.row_bytes(), image.row(y).data(), image.row_bytes());
    }
  }
  return {};
}

void FrameContent::encoded() {
  encoding_ = false;
  NewPacketPtr packet = std::move(encoding_packet_);
  // Once nothing is in the making any more, made() may be the last to hold this.
  const bool another = waiting_;
  if (outcome_) {
    owner_.made(std::move(packet));
  } else {
    owner_.made(outcome_.error());
  }
  if (another) encode_next();
}

std::string FrameContent::what_is_gone() const {
  return "the actor \"" + spec_.actor + "\" of the scene \"" + view_->scene->name + "\" was removed";
}

}  // namespace tweend::streams
