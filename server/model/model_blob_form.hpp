#pragma once

#include <cstddef>
#include <cstdint>

// What the writer and the reader of model blobs have to agree on, beside the order of things.

namespace tweend::model {

inline constexpr std::uint32_t kBlobMagic = 0x424D5754;  ///< "TWMB"
inline constexpr std::uint32_t kBlobVersion = 1;
inline constexpr std::uint32_t kNoNumber = UINT32_MAX;  ///< of an image or vertices: there are none
inline constexpr std::uint8_t kNoInterpolation = UINT8_MAX;

}  // namespace tweend::model
