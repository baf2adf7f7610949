#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "server/assets/obj_reader.hpp"

namespace tweend::assets {

/// Groups the corners of faces into vertices: two corners are one vertex while no attribute they were split by tells
/// them apart. At first all are one. Attributes are taken one at a time, so a vertex may depend on any number of them.
class VertexClasses {
 public:
  explicit VertexClasses(std::size_t corner_count) : classes_(corner_count, 0), count_(corner_count == 0 ? 0 : 1) {}

  /// Splits vertices whose corners differ in `attribute` (an index or -1).
  /// Linear in the corners and the largest index, whatever the indices are: it sorts by counting and hashes nothing.
  /// @param corners  shape [corner_count], in the same order at each call
  void split_by(std::span<const ObjCorner> corners, std::int32_t ObjCorner::*attribute);

  /// Shape [corner_count]: each corner's vertex, numbered in order of first use.
  [[nodiscard]] std::span<const std::uint32_t> vertex_of_corner() const noexcept { return classes_; }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }

 private:
  std::vector<std::uint32_t> classes_;
  std::size_t count_;
};

}  // namespace tweend::assets
