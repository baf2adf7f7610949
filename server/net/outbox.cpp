#include "server/net/outbox.hpp"

#include <cstring>
#include <utility>

namespace tweend::net {

void Gathered::begin_message(bool data, std::size_t skipped) noexcept {
  all_[message_count_++] = {0, data};
  skip_ = skipped;
}

void Gathered::add(const void* bytes, std::size_t size) noexcept {
  if (size <= skip_) {
    skip_ -= size;
    return;
  }
  // sendmsg() does not write to it.
  buffers_[buffer_count_++] = {const_cast<char*>(static_cast<const char*>(bytes)) + skip_, size - skip_};
  all_[message_count_ - 1].bytes += size - skip_;
  bytes_ += size - skip_;
  skip_ = 0;
}

void Outbox::push_control(Control item) {
  if (last_said_) return;
  control_bytes_ += item.cost();
  if (item.shared) event_bytes_ += item.body().size();
  control_.push_back(std::move(item));
}

void Outbox::push_text(std::string text) {
  if (framing_ != Framing::Multipart) push_control({std::move(text), {}, false});
}

void Outbox::push_shared(std::shared_ptr<const std::string> text) {
  if (framing_ != Framing::Multipart) push_control({{}, std::move(text), false});
}

void Outbox::push_after_packets(std::shared_ptr<const std::string> text) {
  if (framing_ == Framing::Multipart || last_said_) return;
  if (data_.size() == 0) return push_shared(std::move(text));
  control_bytes_ += text->size();
  event_bytes_ += text->size();
  data_.push_word(std::move(text));
}

void Outbox::push_raw(std::string bytes) { push_control({std::move(bytes), {}, true}); }

void Outbox::push_last(std::string bytes) {
  if (last_said_) return;
  drop_data();
  if (!bytes.empty()) push_raw(std::move(bytes));
  last_said_ = true;
}

void Outbox::drop_data() {
  // Words are counted in both lanes alike.
  for (auto& word : data_.drop_waiting()) control_.push_back({{}, std::move(word), false});
}

void Outbox::gather_text(const std::string& body, bool raw, Gathered& out) const noexcept {
  if (!raw) {
    char* const prefix = out.prefixes_[out.message_count_ - 1].data();
    out.add(prefix, write_text_prefix(framing_, body.size(), prefix));
  }
  out.add(body.data(), body.size());
  if (!raw) out.add(text_suffix(framing_).data(), text_suffix(framing_).size());
}

void Outbox::gather_control(const Control& item, Gathered& out) const noexcept {
  out.begin_message(false, begun_ == Begun::Control && &item == &control_.front() ? begun_bytes_ : 0);
  gather_text(item.body(), item.raw, out);
}

void Outbox::gather_data(const DataLane::Entry& entry, bool alone, Gathered& out) const noexcept {
  out.begin_message(true, begun_ == Begun::Data && &entry == &data_.front() ? begun_bytes_ : 0);
  if (!entry.packet) return gather_text(*entry.word, false, out);
  protocol::PacketHeader header = entry.packet->header;
  header.stream = entry.stream;
  header.sequence = entry.sequence;
  header.flags = entry.flags;
  char* const prefix = out.prefixes_[out.message_count_ - 1].data();
  const std::size_t prefix_size = write_packet_prefix(framing_, header, prefix);
  const auto payload = entry.packet->payload.bytes();
  if (const auto room = entry.packet->payload.headroom(); alone && room.size() >= prefix_size) {
    // One piece costs the kernel less than two. The next reader's framing will stand in the same place.
    std::byte* const begin = room.data() + room.size() - prefix_size;
    std::memcpy(begin, prefix, prefix_size);
    out.add(begin, prefix_size + payload.size());
  } else {
    out.add(prefix, prefix_size);
    out.add(payload.data(), payload.size());
  }
  out.add(packet_suffix(framing_).data(), packet_suffix(framing_).size());
}

void Outbox::gather(Gathered& out) const noexcept {
  // A packet of two streams has one headroom, and so has one that is gathered twice.
  const bool alone = data_.size() == 1;
  auto entry = data_.entries().begin();
  if (begun_ == Begun::Data) gather_data(*entry++, alone, out);
  for (auto item = control_.begin(); item != control_.end() && !out.full(); ++item) gather_control(*item, out);
  for (; entry != data_.entries().end() && !out.full(); ++entry) gather_data(*entry, alone, out);
}

void Outbox::pop_control() {
  const Control& item = control_.front();
  control_bytes_ -= item.cost();
  if (item.shared) event_bytes_ -= item.body().size();
  control_.pop_front();
}

void Outbox::pop_data(std::int64_t now_us) {
  if (const DataLane::Entry& entry = data_.front(); !entry.packet) {
    control_bytes_ -= entry.word->size();
    event_bytes_ -= entry.word->size();
  }
  data_.pop_front(now_us);
}

void Outbox::wrote(const Gathered& gathered, std::size_t bytes, std::int64_t now_us) {
  std::int64_t packets = 0;
  for (std::size_t i = 0; i < gathered.message_count_ && bytes > 0; ++i) {
    const Gathered::Message& message = gathered.all_[i];
    if (bytes < message.bytes) {
      // The first message may have begun in an earlier write; any other begins now.
      begun_bytes_ = (i == 0 && begun_ != Begun::None ? begun_bytes_ : 0) + bytes;
      begun_ = message.data ? Begun::Data : Begun::Control;
      if (message.data) data_.begin_front();
      break;
    }
    bytes -= message.bytes;
    if (!message.data) {
      pop_control();
    } else {
      packets += data_.front().packet ? 1 : 0;
      pop_data(now_us);
    }
    if (i == 0) begun_ = Begun::None;
    begun_bytes_ = 0;
  }
  if (packets > 0) add(metrics_.packets_sent_total, packets);
}

}  // namespace tweend::net
