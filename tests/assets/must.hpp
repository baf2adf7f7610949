#pragma once

#include <stdexcept>
#include <utility>

#include "server/base/result.hpp"

namespace tweend::assets {

/// The value that a test takes for granted; without it the test fails with the error's message.
template <class T>
[[nodiscard]] T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

}  // namespace tweend::assets
