#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "protocol/encoded.hpp"
#include "protocol/packet.hpp"
#include "protocol/ranged_values.hpp"
#include "protocol/smallest_three.hpp"
#include "server/base/result.hpp"

namespace tweend::protocol {

/// Writes poses as `q16` (docs/PROTOCOL.md, section 6.2): joints that changed, rotations by their smallest three. Keeps what
/// the reader knows. Allocates only where the skeleton is larger than any before. One thread at a time.
class PoseQ16Encoder {
 public:
  /// Bytes that a packet may take at most.
  [[nodiscard]] static std::size_t most_bytes(std::size_t joints, std::size_t weights) noexcept;

  /// What is not finite is sent as the largest float of its sign, NaN as at rest; a rotation that is not of unit length as
  /// none.
  /// @param joints   shape [joints × 10]: translation xyz, rotation xyzw, scale xyz; local space
  /// @param weights  of the morph targets
  /// @param key      whether it has to decode on its own; without it, it still may
  /// @param out      room for most_bytes()
  /// @param jumped   whether no movement has led here: then it is a key, and the way says nothing of how far things move
  [[nodiscard]] Encoded encode(std::span<const float> joints, std::span<const float> weights, bool key,
                               std::span<std::byte> out, bool jumped = false);

 private:
  void reset(std::size_t joints, std::size_t weights);

  RangedWriter translations_{kTranslations};
  RangedWriter scales_{kScales};
  RangedWriter weights_{kWeights};
  std::vector<SmallestThree> rotations_;  ///< what the reader knows
  std::size_t weight_count_ = 0;
  bool is_known_ = false;
};

/// Reads them. Keeps what the packets before have said. One thread at a time.
class PoseQ16Decoder {
 public:
  /// @param key      the packet's flag
  /// @param joints   shape [joints × 10], is given the whole pose
  /// @param weights  likewise
  /// @return Parse naming what was expected and found where the bytes are not such a packet, or lack their predecessor; the
  ///         spans are untouched then, and the next packet may follow the one before this
  [[nodiscard]] Status decode(std::span<const std::byte> payload, bool key, std::span<float> joints, std::span<float> weights);

 private:
  void rest(std::size_t joints, std::size_t weights);

  RangedState translations_{kTranslations};
  RangedState scales_{kScales};
  RangedState weights_{kWeights};
  std::vector<float> pose_;  ///< as packets have said: the joints, then the weights
  bool is_known_ = false;
};

}  // namespace tweend::protocol
