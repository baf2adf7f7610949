#include "protocol/pose_q16.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "protocol/bitmap.hpp"
#include "protocol/little_endian.hpp"

namespace tweend::protocol {
namespace {

// Sections of a packet, and the bits of its first byte that say which are there.
constexpr std::size_t kTranslationSection = 0;
constexpr std::size_t kRotationSection = 1;
constexpr std::size_t kScaleSection = 2;
constexpr std::size_t kWeightSection = 3;
constexpr std::size_t kSections = 4;

constexpr std::size_t kRotationBytes = 6;
constexpr std::size_t kRotationAt = 3;  ///< in a joint's ten floats
constexpr std::size_t kScaleAt = 7;

/// The first joint's scale, where there is a joint.
template <class Float>
Float* scales_of(std::span<Float> joints) {
  return joints.empty() ? nullptr : &joints[kScaleAt];
}

// -------------------------------------------------------------------------------------------------------------- writing

std::size_t write_rotations(std::span<const float> joints, bool key, std::vector<SmallestThree>& known, std::byte* out) {
  BitmapWriter changed(out, known.size());
  std::byte* at = out + bitmap_bytes(known.size());
  for (std::size_t j = 0; j < known.size(); ++j) {
    const SmallestThree rotation = smallest_three::pack(&joints[j * kFloatsPerJoint + kRotationAt]);
    const bool differs = rotation != (key ? smallest_three::kIdentity : known[j]);
    known[j] = rotation;
    if (!differs) continue;
    changed.set(j);
    for (const std::uint16_t word : rotation) {
      put(at, word);
      at += 2;
    }
  }
  return changed.any() ? static_cast<std::size_t>(at - out) : 0;
}

// -------------------------------------------------------------------------------------------------------------- reading

/// A packet taken apart: nothing here is copied.
struct Section {
  std::span<const std::byte> bitmap;
  std::span<const std::byte> records;
};
using Sections = std::array<Section, kSections>;

std::size_t record_bytes(std::size_t section, bool key) {
  if (section == kRotationSection) return kRotationBytes;
  const RangedKind& kind = section == kTranslationSection ? kTranslations : section == kScaleSection ? kScales : kWeights;
  return key ? kind.key_bytes() : kind.delta_bytes();
}

Result<Sections> take_apart(std::span<const std::byte> payload, bool key, std::size_t joints, std::size_t weights) {
  if (payload.empty()) return fail(ErrorCode::Parse, "expected a pose as q16 of a byte or more, found none");
  const auto present = std::to_integer<unsigned>(payload[0]);
  if (present >= 1U << kSections) return fail(ErrorCode::Parse, fmt::format("expected sections below 16, found {}", present));
  Sections sections;
  auto rest = payload.subspan(1);
  for (std::size_t s = 0; s < kSections; ++s) {
    if ((present >> s & 1U) == 0) continue;
    const std::size_t elements = s == kWeightSection ? weights : joints;
    const auto cut = [&](std::size_t bytes, std::span<const std::byte>& part) -> Status {
      if (rest.size() < bytes) {
        return fail(ErrorCode::Parse,
                    fmt::format("expected {} bytes of section {} of a pose as q16, found {}", bytes, s, rest.size()));
      }
      part = rest.first(bytes);
      rest = rest.subspan(bytes);
      return {};
    };
    TWEEND_TRY(cut(bitmap_bytes(elements), sections[s].bitmap));
    if (elements % 8 != 0 && std::to_integer<unsigned>(sections[s].bitmap.back()) >> (elements % 8) != 0) {
      return fail(ErrorCode::Parse, fmt::format("expected a bitmap of {} elements, found bits beyond", elements));
    }
    TWEEND_TRY(cut(bits_set(sections[s].bitmap) * record_bytes(s, key), sections[s].records));
  }
  if (!rest.empty())
    return fail(ErrorCode::Parse, fmt::format("expected the end of a pose as q16, found {} bytes", rest.size()));
  return sections;
}

SmallestThree rotation_at(const std::byte* at) {
  return {get<std::uint16_t>(at), get<std::uint16_t>(at + 2), get<std::uint16_t>(at + 4)};
}

Status check_rotations(const Section& section) {
  for (std::size_t at = 0; at < section.records.size(); at += kRotationBytes) {
    if (!smallest_three::is_rotation(rotation_at(&section.records[at]))) {
      return fail(ErrorCode::Parse, fmt::format("expected a rotation, found none at record {}", at / kRotationBytes));
    }
  }
  return {};
}

/// The bases and exponents of a key.
Status check_bases(const Section& section, const RangedKind& kind) {
  for (std::size_t at = 0; at < section.records.size(); at += kind.key_bytes()) {
    const std::byte* const record = &section.records[at];
    for (std::size_t k = 0; k < kind.components; ++k) {
      if (const float base = get_float(record + 4 * k); !std::isfinite(base)) {
        return fail(ErrorCode::Parse,
                    fmt::format("expected a finite base, found {} in record {}", base, at / kind.key_bytes()));
      }
    }
    const int exponent = std::to_integer<std::int8_t>(record[4 * kind.components]);
    if (exponent < kLeastExponent || exponent > kMostExponent) {
      return fail(ErrorCode::Parse, fmt::format("expected an exponent from {} to {}, found {} in record {}", kLeastExponent,
                                                kMostExponent, exponent, at / kind.key_bytes()));
    }
  }
  return {};
}

void read_ranged(const Section& section, bool key, RangedState& state, float* values, std::size_t stride) {
  const RangedKind& kind = state.kind;
  const std::byte* at = section.records.data();
  for (std::size_t e = 0; e < state.elements() && !section.bitmap.empty(); ++e) {
    if (!bit_of(section.bitmap, e)) continue;
    const double step = state.step(e);
    for (std::size_t k = 0; k < kind.components; ++k) {
      float& base = state.base[e * kind.components + k];
      if (key) base = get_float(at + 4 * k);
      const double steps = key ? 0.0 : static_cast<std::int16_t>(get<std::uint16_t>(at + 2 * k));
      values[e * stride + k] = static_cast<float>(double{base} + steps * step);
    }
    if (key) state.exponent[e] = std::to_integer<std::int8_t>(at[4 * kind.components]);
    at += key ? kind.key_bytes() : kind.delta_bytes();
  }
}

void read_rotations(const Section& section, std::span<float> joints) {
  const std::byte* at = section.records.data();
  for (std::size_t j = 0; j < joints.size() / kFloatsPerJoint && !section.bitmap.empty(); ++j) {
    if (!bit_of(section.bitmap, j)) continue;
    smallest_three::unpack(rotation_at(at), &joints[j * kFloatsPerJoint + kRotationAt]);
    at += kRotationBytes;
  }
}

constexpr std::array<float, kFloatsPerJoint> kRest{0, 0, 0, 0, 0, 0, 1, 1, 1, 1};

}  // namespace

std::size_t PoseQ16Encoder::most_bytes(std::size_t joints, std::size_t weights) noexcept {
  return 1 + RangedWriter::most_bytes(kTranslations, joints) + RangedWriter::most_bytes(kScales, joints) +
         RangedWriter::most_bytes(kWeights, weights) + bitmap_bytes(joints) + joints * kRotationBytes;
}

Encoded PoseQ16Encoder::encode(std::span<const float> joints, std::span<const float> weights, bool key,
                               std::span<std::byte> out, bool jumped) {
  const std::size_t count = joints.size() / kFloatsPerJoint;
  bool left = false;
  if (!is_known_ || count != rotations_.size() || weights.size() != weight_count_) {
    reset(count, weights.size());
    key = true;
  } else if (jumped) {
    key = true;
  } else {
    // All three, also after one that is out of reach: exponents are chosen by what was observed.
    const bool translations_reach = translations_.observe(joints.data(), kFloatsPerJoint);
    const bool scales_reach = scales_.observe(scales_of(joints), kFloatsPerJoint);
    const bool weights_reach = weights_.observe(weights.data(), 1);
    left = !(translations_reach && scales_reach && weights_reach);
    key = key || left;
  }
  unsigned present = 0;
  std::size_t at = 1;
  const auto add = [&](std::size_t section, std::size_t bytes) {
    if (bytes > 0) present |= 1U << section;
    at += bytes;
  };
  const auto add_ranged = [&](std::size_t section, RangedWriter& writer, const float* values, std::size_t stride) {
    std::byte* const to = out.data() + at;
    add(section, key ? writer.write_key(values, stride, left, to) : writer.write_delta(values, stride, to));
  };
  add_ranged(kTranslationSection, translations_, joints.data(), kFloatsPerJoint);
  add(kRotationSection, write_rotations(joints, key, rotations_, out.data() + at));
  add_ranged(kScaleSection, scales_, scales_of(joints), kFloatsPerJoint);
  add_ranged(kWeightSection, weights_, weights.data(), 1);
  out[0] = static_cast<std::byte>(present);
  return {at, key};
}

void PoseQ16Encoder::reset(std::size_t joints, std::size_t weights) {
  translations_.reset(joints);
  scales_.reset(joints);
  weights_.reset(weights);
  rotations_.resize(joints);
  weight_count_ = weights;
  is_known_ = true;
}

Status PoseQ16Decoder::decode(std::span<const std::byte> payload, bool key, std::span<float> joints, std::span<float> weights) {
  const std::size_t count = joints.size() / kFloatsPerJoint;
  const bool is_same = is_known_ && count == translations_.elements() && weights.size() == weights_.elements();
  if (!key && !is_same) {
    return fail(ErrorCode::Parse, fmt::format("expected a key of {} joints and {} weights first, found a packet that needs one",
                                              count, weights.size()));
  }
  TWEEND_ASSIGN(const Sections sections, take_apart(payload, key, count, weights.size()));
  TWEEND_TRY(check_rotations(sections[kRotationSection]));
  if (key) {
    TWEEND_TRY(check_bases(sections[kTranslationSection], kTranslations));
    TWEEND_TRY(check_bases(sections[kScaleSection], kScales));
    TWEEND_TRY(check_bases(sections[kWeightSection], kWeights));
    rest(count, weights.size());
  }
  const auto known_joints = std::span(pose_).first(joints.size());
  const auto known_weights = std::span(pose_).last(weights.size());
  read_ranged(sections[kTranslationSection], key, translations_, known_joints.data(), kFloatsPerJoint);
  read_rotations(sections[kRotationSection], known_joints);
  read_ranged(sections[kScaleSection], key, scales_, scales_of(known_joints), kFloatsPerJoint);
  read_ranged(sections[kWeightSection], key, weights_, known_weights.data(), 1);
  std::ranges::copy(known_joints, joints.begin());
  std::ranges::copy(known_weights, weights.begin());
  return {};
}

void PoseQ16Decoder::rest(std::size_t joints, std::size_t weights) {
  translations_.reset(joints);
  scales_.reset(joints);
  weights_.reset(weights);
  pose_.assign(joints * kFloatsPerJoint + weights, kWeights.rest);
  for (std::size_t j = 0; j < joints; ++j) std::ranges::copy(kRest, &pose_[j * kFloatsPerJoint]);
  is_known_ = true;
}

}  // namespace tweend::protocol
