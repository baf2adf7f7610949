#pragma once

#include <cstddef>

namespace tweend::test {

/// How often the calling thread has taken memory by `new`. Programs that link allocations.cpp count.
[[nodiscard]] std::size_t allocations() noexcept;

}  // namespace tweend::test
