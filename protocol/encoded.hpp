#pragma once

#include <cstddef>

namespace tweend::protocol {

/// What an encoder that leaves out what has not changed has written.
struct Encoded {
  std::size_t bytes = 0;
  bool key = false;  ///< it decodes on its own: what was asked for, or what had to be
};

}  // namespace tweend::protocol
