#include "server/model/model_blob.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

/// Bytes are a model blob or are refused; what is read can be written and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto read = tweend::model::read_model_blob({reinterpret_cast<const char*>(data), size});
  if (!read) return 0;
  const std::string written = tweend::model::write_model_blob(*read).bytes;
  if (!tweend::model::read_model_blob(written)) std::abort();
  return 0;
}
