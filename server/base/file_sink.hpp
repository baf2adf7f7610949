#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>

#include "server/base/result.hpp"

namespace tweend {

/// A file that is being written, in pieces: one after another, and again where something is known only later. One thread at a
/// time.
class FileSink {
 public:
  virtual ~FileSink() = default;
  /// @return Unavailable with the system's reason; Limit where it would get too long
  [[nodiscard]] virtual Status write_at(std::uint64_t offset, std::span<const std::byte> bytes) = 0;
};

/// A file in memory, of so many bytes at most.
class MemoryFile final : public FileSink {
 public:
  explicit MemoryFile(std::size_t most = std::numeric_limits<std::size_t>::max()) : most_(most) {}

  [[nodiscard]] Status write_at(std::uint64_t offset, std::span<const std::byte> piece) override {
    if (offset > most_ || piece.size() > most_ - offset) {
      return fail(ErrorCode::Limit, fmt::format("expected a file of at most {} bytes, found a longer one", most_));
    }
    if (bytes.size() < offset + piece.size()) bytes.resize(offset + piece.size());
    if (!piece.empty()) std::memcpy(bytes.data() + offset, piece.data(), piece.size());
    return {};
  }
  std::string bytes;

 private:
  const std::size_t most_;
};

}  // namespace tweend
