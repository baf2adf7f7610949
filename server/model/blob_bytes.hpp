#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

// How numbers, texts and runs of numbers lie in a model blob: little-endian, without gaps, each run behind its length.

namespace tweend::model {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

/// Puts values behind each other.
class BlobWriter {
 public:
  template <class T>
  void put(T value) {
    static_assert(std::is_arithmetic_v<T>);
    const auto* const from = reinterpret_cast<const char*>(&value);
    bytes_.insert(bytes_.end(), from, from + sizeof value);
  }
  template <class T>
  void put_run(std::span<const T> values) {
    static_assert(std::is_arithmetic_v<T>);
    put<std::uint64_t>(values.size());
    const auto* const from = reinterpret_cast<const char*>(values.data());
    bytes_.insert(bytes_.end(), from, from + values.size_bytes());
  }
  template <class T>
  void put_run(const std::vector<T>& values) {
    put_run(std::span<const T>(values));
  }
  void put_text(std::string_view text) { put_run(std::span<const char>(text.data(), text.size())); }
  void put_count(std::size_t count) { put<std::uint32_t>(static_cast<std::uint32_t>(count)); }

  [[nodiscard]] std::size_t size() const noexcept { return bytes_.size(); }
  /// Replaces what was put at `at`. Precondition: it was put there.
  template <class T>
  void put_at(std::size_t at, T value) {
    std::memcpy(&bytes_[at], &value, sizeof value);
  }

  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Takes values out again, in one pass. What isn't there reads as 0 or as nothing and is remembered: whoever reads may go on
/// to a good place to look at ok(), since no run is longer than what is left.
class BlobReader {
 public:
  explicit BlobReader(std::string_view bytes) noexcept : rest_(bytes) {}

  [[nodiscard]] bool ok() const noexcept { return ok_; }
  [[nodiscard]] std::size_t left() const noexcept { return rest_.size(); }
  void spoil() noexcept {
    ok_ = false;
    rest_ = {};
  }

  template <class T>
  T take() noexcept {
    static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool>);
    T value{};
    if (rest_.size() < sizeof value) {
      spoil();
      return value;
    }
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }
  template <class T>
  std::vector<T> take_run() {
    const auto count = take<std::uint64_t>();
    if (count > rest_.size() / sizeof(T)) {
      spoil();
      return {};
    }
    std::vector<T> values(static_cast<std::size_t>(count));
    if (!values.empty()) std::memcpy(values.data(), rest_.data(), values.size() * sizeof(T));
    rest_.remove_prefix(values.size() * sizeof(T));
    return values;
  }
  std::string take_text() {
    const std::vector<char> text = take_run<char>();
    return {text.begin(), text.end()};
  }
  bool take_bool() noexcept { return take_below<std::uint8_t>(2) != 0; }
  /// A number of which only those below `end` mean something.
  template <class T>
  T take_below(T end) noexcept {
    const T value = take<T>();
    if (value < end) return value;
    spoil();
    return T{};
  }
  /// How many things follow, each of which takes `least_bytes` or more.
  std::size_t take_count(std::size_t least_bytes) noexcept {
    const std::size_t count = take<std::uint32_t>();
    if (count <= rest_.size() / least_bytes) return count;
    spoil();
    return 0;
  }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace tweend::model
