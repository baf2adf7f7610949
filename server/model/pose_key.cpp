#include "server/model/pose_key.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace tweend::model {
namespace {

bool before(const KeyedValue& a, const KeyedValue& b) noexcept { return a.channel < b.channel; }

/// Of the numbers that mean something, not of the padding between them.
ContentHash hash_of(std::span<const KeyedValue> values, std::span<const KeyedTangents> tangents) {
  std::vector<float> numbers;
  std::vector<std::uint32_t> channels;
  for (const KeyedValue& v : values) {
    channels.insert(channels.end(), {v.channel.target, static_cast<std::uint32_t>(v.channel.property)});
    numbers.insert(numbers.end(), {v.value.x, v.value.y, v.value.z, v.value.w});
  }
  for (const KeyedTangents& t : tangents) {
    numbers.insert(numbers.end(), {t.in.x, t.in.y, t.in.z, t.in.w, t.out.x, t.out.y, t.out.z, t.out.w});
  }
  const ContentHash a = hash_bytes(std::as_bytes(std::span(channels)));
  const ContentHash b = hash_bytes(std::as_bytes(std::span(numbers)));
  const std::array words{a.high, a.low, b.high, b.low};
  return hash_bytes(std::as_bytes(std::span(words)));
}

}  // namespace

PoseKey::PoseKey(std::vector<KeyedValue> values, std::vector<KeyedTangents> tangents) {
  if (std::is_sorted(values.begin(), values.end(), before)) {
    values_ = std::move(values);
    tangents_ = std::move(tangents);
  } else {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return before(values[a], values[b]); });
    for (const std::size_t i : order) {
      values_.push_back(values[i]);
      if (!tangents.empty()) tangents_.push_back(tangents[i]);
    }
  }
  hash_ = hash_of(values_, tangents_);
}

const KeyedValue* PoseKey::find(const animation::Channel& channel) const noexcept {
  const auto at = std::lower_bound(values_.begin(), values_.end(), KeyedValue{channel, {}}, before);
  return at != values_.end() && at->channel == channel ? &*at : nullptr;
}

}  // namespace tweend::model
