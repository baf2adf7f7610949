#include "server/streams/frame_content.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cstring>
#include <utility>

#include "server/streams/rungs.hpp"

namespace tweend::streams {
namespace {

std::uint8_t encoding_number(FrameEncoding encoding) noexcept {
  switch (encoding) {
    case FrameEncoding::Jpeg:
      return protocol::kFrameJpeg;
    case FrameEncoding::Png:
      return protocol::kFramePng;
    case FrameEncoding::H264:
      return protocol::kFrameH264;
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
  moment_ = desk_.moment(view_, at_us);
  const auto& actors = moment_->show.actors;
  ContentReading reading;
  for (const stage::ActorShow& actor : actors) {
    if (!actor.actor->settings.visible) continue;
    reading.moving = reading.moving || actor.moving || actor.turning;
    // Mixed, not summed: one player's wrap forwards and another's backwards are two jumps and not none.
    constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15U;
    reading.continuity = (reading.continuity ^ actor.continuity) * kOdd;
  }
  const auto named =
      std::find_if(actors.begin(), actors.end(), [this](const stage::ActorShow& a) { return a.actor->name == spec_.actor; });
  if (named != actors.end()) {
    reading.time_s = named->time_s;
  } else if (!actors.empty()) {
    reading.time_s = actors.front().time_s;
  }
  return reading;
}

void FrameContent::begin(NewPacketPtr packet, ClockUs deadline_us) {
  const std::size_t rung = refined_ ? 0 : spec_.rung;
  drawing_ = {std::move(packet), quality_on_rung(spec_.quality, rung)};
  drawing_.packet->header.kind = protocol::PacketKind::Frame;
  drawing_.packet->header.encoding = encoding_number(spec_.encoding);
  desk_.draw(std::exchange(moment_, nullptr), spec_.camera, size_on_rung(spec_.size, rung), deadline_us, shared_from_this());
}

void FrameContent::drawn(const Result<render::PixelsPtr>& pixels) {
  pixels_ = pixels;
  waiting_ = true;
  if (!encoding_) encode_next();
}

void FrameContent::encode_next() {
  waiting_ = false;
  encoded_ = std::move(drawing_);
  encoding_pixels_ = std::exchange(pixels_, render::PixelsPtr());
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
  outcome_ = write((*encoding_pixels_)->view(), *encoded_.packet);
  encoding_pixels_ = render::PixelsPtr();
  boost::asio::post(strand_, [this] { encoded(); });
}

Status FrameContent::write(const render::ImageView& image, Packet& packet) {
  Payload& payload = packet.payload;
  if (spec_.encoding == FrameEncoding::H264) return write_h264(image, packet);
  if (spec_.encoding == FrameEncoding::Jpeg) {
    TWEEND_ASSIGN(const std::size_t bytes,
                  jpeg_.encode(image, encoded_.quality, draft_.resize(render::JpegEncoder::most_bytes(image.size))));
    payload.assign(draft_.bytes().first(bytes));
  } else if (spec_.encoding == FrameEncoding::Png) {
    TWEEND_ASSIGN(const std::vector<std::byte> file, render::encode_png(image));
    payload.assign(file);
  } else {
    std::byte* to = payload.resize(image.bytes.size()).data();
    for (std::size_t y = 0; y < image.size.height; ++y) {
      std::memcpy(to + y * image.row_bytes(), image.row(y).data(), image.row_bytes());
    }
  }
  return {};
}

Status FrameContent::write_h264(const render::ImageView& image, Packet& packet) {
  if (!h264_) {
    TWEEND_ASSIGN(render::H264Encoder encoder,
                  render::H264Encoder::open({.size = image.size, .rate = rate_, .bit_rate = spec_.bit_rate, .live = true}));
    h264_ = std::move(encoder);
  }
  TWEEND_ASSIGN(const render::H264Encoder::Unit unit, h264_->encode(image, (packet.header.flags & protocol::kFlagKey) != 0));
  packet.payload.assign(unit.bytes);
  if (unit.key) packet.header.flags = static_cast<std::uint8_t>(packet.header.flags | protocol::kFlagKey);
  return {};
}

void FrameContent::encoded() {
  encoding_ = false;
  NewPacketPtr packet = std::move(encoded_.packet);
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
