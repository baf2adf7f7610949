#include "server/net/data_lane.hpp"

#include <algorithm>
#include <utility>

#include "server/streams/rungs.hpp"

namespace tweend::net {
namespace {

using protocol::PacketHeader;

/// What has waited for less was replaced within one turn of the network thread.
constexpr std::int64_t kNoticeableUs = 2'000;

bool has(std::uint8_t flags, std::uint8_t flag) noexcept { return (flags & flag) != 0; }

std::uint8_t with(std::uint8_t flags, std::uint8_t more) noexcept { return static_cast<std::uint8_t>(flags | more); }

std::size_t cost(const streams::Packet& packet) noexcept {
  return std::max(packet.payload.bytes().size(), DataLane::kLeastBytes);
}

/// Whether each packet of such a stream is a key: then any of them may be left out.
bool stands_alone(const PacketHeader& header) noexcept {
  switch (header.kind) {
    case protocol::PacketKind::Pose:
      return header.encoding == protocol::kPoseF32;
    case protocol::PacketKind::Vertices:
      return header.encoding != protocol::kVerticesMeshopt;
    case protocol::PacketKind::Frame:
      return header.encoding != protocol::kFrameH264;
  }
  return false;
}

void add_to(streams::StreamMeter* meter, streams::StreamMeter::Value streams::StreamMeter::*value, std::int64_t n) noexcept {
  if (meter != nullptr) (meter->*value).fetch_add(n, std::memory_order_relaxed);
}

void count(DataLane::Entry& entry) noexcept {
  entry.counted = true;
  if (entry.packet) add_to(entry.packet->meter(), &streams::StreamMeter::queued, 1);
}

void uncount(const DataLane::Entry& entry) noexcept {
  if (entry.counted && entry.packet) add_to(entry.packet->meter(), &streams::StreamMeter::queued, -1);
}

}  // namespace

DataLane::Streams::const_iterator DataLane::find(std::uint32_t stream) const noexcept {
  const auto at = std::lower_bound(streams_.begin(), streams_.end(), stream,
                                   [](const Stream& s, std::uint32_t number) { return s.number < number; });
  return at != streams_.end() && at->number == stream ? at : streams_.end();
}

DataLane::Stream* DataLane::find(std::uint32_t stream) noexcept {
  const auto at = std::as_const(*this).find(stream);
  return at == streams_.cend() ? nullptr : &streams_[static_cast<std::size_t>(at - streams_.cbegin())];
}

void DataLane::expect(std::uint32_t stream, commands::StreamPolicy policy) {
  Stream* s = find(stream);
  if (s == nullptr) {
    const auto at = std::upper_bound(streams_.begin(), streams_.end(), stream,
                                     [](std::uint32_t number, const Stream& other) { return number < other.number; });
    s = &*streams_.emplace(at);
    s->number = stream;
  }
  s->policy = policy;
  if (!policy.adaptive) return;
  s->rungs = std::make_unique<RungController>(streams::kRungs.size());
  adaptive_ = true;
}

/// Gives the packet its number. False: the client has had it, or something that shows as much.
bool DataLane::number(Stream& s, const streams::Packet& packet) {
  const PacketHeader& header = packet.header;
  if (s.heard && packet.source == s.source) {
    // Who leaves a producer and comes back is given its latest packet, which it may have had. The difference, not the numbers:
    // they start again from 0 after 2^32 packets.
    if (static_cast<std::int32_t>(header.sequence + s.base - s.offered) <= 0) return false;
  } else {
    // Another producer's picture of a moment that has been shown is no news; but of the last moment it is the better one.
    const bool had = s.heard && header.server_us <= s.server_us;
    if (had && stands_alone(header) && !has(header.flags, protocol::kFlagLast)) return false;
    s.base = s.heard ? s.offered + 1 - header.sequence : 0;
    s.source = packet.source;
    s.heard = true;
    s.needs_key = true;
    if (s.rungs) s.rungs->settle();
  }
  s.needs_key = s.needs_key || header.sequence + s.base != s.offered + 1;
  s.offered = header.sequence + s.base;
  s.server_us = header.server_us;
  return true;
}

void DataLane::offer(std::uint32_t stream, const streams::PacketPtr& packet, std::int64_t now_us) {
  Stream* known = find(stream);
  if (known == nullptr) {
    expect(stream, {});
    known = find(stream);
  }
  Stream& s = *known;
  if (!number(s, *packet)) return;
  if (has(packet->header.flags, protocol::kFlagKey)) {
    s.needs_key = false;
    if (s.waiting > 0 && !s.policy.every) return replace(s, packet, now_us);
  } else if (s.needs_key) {
    return skip(s, *packet);
  } else if (s.waiting > 0 && !s.policy.every &&
             (s.waiting == kChainPackets || s.waiting_bytes + cost(*packet) > kChainBytes)) {
    drop_chain(s, now_us);
    s.needs_key = true;
    return skip(s, *packet);
  }
  append(s, make_place(entries_.end()), packet, now_us);
}

DataLane::Place DataLane::make_place(Place before) {
  if (spare_.empty()) spare_.emplace_back();
  const Place place = spare_.begin();
  entries_.splice(before, spare_, place);
  return place;
}

void DataLane::append(Stream& s, Place place, const streams::PacketPtr& packet, std::int64_t now_us) {
  const std::uint8_t flags = with(packet->header.flags, std::exchange(s.flags, std::uint8_t{0}));
  *place = {packet, {}, now_us, s.number, s.offered, flags, s.policy.every, false};
  s.taken = true;
  if (s.policy.every) {
    every_bytes_ += cost(*packet);
  } else {
    s.chain[s.waiting] = place;
  }
  s.waiting += 1;
  s.waiting_bytes += cost(*packet);
}

/// The packet never leaves. What came before the first that a client was sent is not missed by it.
void DataLane::skip(Stream& s, const streams::Packet& packet) {
  if (!s.taken) return;
  s.flags = with(s.flags, packet.header.flags & protocol::kFlagDiscontinuity);
  add(metrics_.packets_skipped_total);
  add_to(packet.meter(), &streams::StreamMeter::skipped, 1);
}

/// Skips all that waits of a stream.
void DataLane::drop_chain(Stream& s, std::int64_t now_us) {
  for (std::size_t i = 0; i < s.waiting; ++i) {
    const Entry& entry = *s.chain[i];
    s.flags = with(s.flags, entry.flags & protocol::kFlagDiscontinuity);
    skip(s, *entry.packet);
    // Packets that came at the same moment say that this thread was busy, not that the reader is slow.
    if (s.judged(entry) && now_us - entry.offered_us >= kNoticeableUs) s.rungs->replaced(now_us);
    take_out(s.chain[i]);
  }
  s.waiting = 0;
  s.waiting_bytes = 0;
  if (s.rungs) notice_rung(s);
}

/// A key instead of all that waits, in the place of the first of it: a stream that is slow keeps its turn.
void DataLane::replace(Stream& s, const streams::PacketPtr& packet, std::int64_t now_us) {
  const bool counted = s.chain[0]->counted;  // what is counted stands before what is not
  const Place place = make_place(s.chain[0]);
  drop_chain(s, now_us);
  append(s, place, packet, now_us);
  if (counted) count(*place);
}

void DataLane::push_word(std::shared_ptr<const std::string> word) {
  Entry entry;
  entry.word = std::move(word);
  *make_place(entries_.end()) = std::move(entry);
}

void DataLane::end(std::uint32_t stream) {
  const auto at = std::as_const(*this).find(stream);
  if (at != streams_.cend()) streams_.erase(at);
}

void DataLane::forget(std::uint32_t stream) {
  for (Place at = first_waiting(); at != entries_.end();) {
    const bool its = at->packet && at->stream == stream;
    if (its && at->every) every_bytes_ -= cost(*at->packet);
    at = its ? take_out(at) : std::next(at);
  }
  end(stream);
}

std::vector<std::shared_ptr<const std::string>> DataLane::drop_waiting() {
  std::vector<std::shared_ptr<const std::string>> words;
  for (Place at = first_waiting(); at != entries_.end(); at = take_out(at)) {
    if (at->word) words.push_back(std::move(at->word));
  }
  for (Stream& s : streams_) s.waiting = s.waiting_bytes = 0;
  every_bytes_ = 0;
  return words;
}

DataLane::~DataLane() {
  for (const Entry& entry : entries_) uncount(entry);
}

/// @return the place after it
DataLane::Place DataLane::take_out(Place place) noexcept {
  uncount(*place);
  place->packet.reset();
  place->word.reset();
  const Place next = std::next(place);
  spare_.splice(spare_.begin(), entries_, place);
  return next;
}

void DataLane::settle_in() noexcept {
  // Whatever has taken another's place is counted already: the others are the last.
  for (auto entry = entries_.rbegin(); entry != entries_.rend() && !entry->counted; ++entry) count(*entry);
}

/// The first entry of its stream is not among those any more that something may take the place of.
void DataLane::waits_no_more(const Entry& entry) noexcept {
  const std::size_t bytes = cost(*entry.packet);
  if (entry.every) every_bytes_ -= bytes;
  Stream* const s = find(entry.stream);
  if (s == nullptr) return;
  s->waiting -= 1;
  s->waiting_bytes -= bytes;
  if (!entry.every) std::copy_n(s->chain.begin() + 1, s->waiting, s->chain.begin());
}

void DataLane::begin_front() noexcept {
  if (front_begun_) return;
  front_begun_ = true;
  if (front().packet) waits_no_more(front());
}

void DataLane::pop_front(std::int64_t now_us) {
  begin_front();
  const Entry& entry = front();
  if (entry.packet) {
    add_to(entry.packet->meter(), &streams::StreamMeter::sent, 1);
    if (adaptive_) {
      Stream* const s = find(entry.stream);
      if (s != nullptr && s->judged(entry) && s->source == entry.packet->source) {
        s->rungs->written(now_us, now_us - entry.offered_us);
        notice_rung(*s);
      }
    }
  }
  front_begun_ = false;
  take_out(entries_.begin());
}

std::optional<std::uint32_t> DataLane::behind() const noexcept {
  if (every_bytes_ <= kEveryBytes) return std::nullopt;
  const Stream* most = nullptr;
  for (const Stream& s : streams_) {
    if (s.policy.every && s.waiting > 0 && (most == nullptr || s.waiting_bytes > most->waiting_bytes)) most = &s;
  }
  return most == nullptr ? std::optional<std::uint32_t>() : most->number;
}

std::optional<DataLane::RungMove> DataLane::next_move() {
  if (!moves_) return std::nullopt;
  for (Stream& s : streams_) {
    if (!s.rungs || s.rungs->rung() == s.rung) continue;
    s.rung = s.rungs->rung();
    return RungMove{s.number, s.rung};
  }
  moves_ = false;
  return std::nullopt;
}

}  // namespace tweend::net
