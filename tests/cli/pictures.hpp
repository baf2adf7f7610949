#pragma once

#include <string>
#include <string_view>

#include "tests/cli/fake_server.hpp"

namespace tweend::cli::test {

/// A grey pixel as a PNG file.
inline constexpr std::string_view kPngBase64 =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGOoBwAAgQCAxhA/EAAAAABJRU5ErkJggg==";

/// The same, decoded.
[[nodiscard]] std::string png();
/// What begins as a JPEG file does; nothing here looks further.
[[nodiscard]] std::string jpeg();

/// A packet with a picture, in encoding 0 jpeg or 1 png, as on the wire.
[[nodiscard]] std::string frame_packet(std::uint32_t sequence, std::uint8_t encoding, const std::string& picture);

/// The script of a stream of frames with these further parameters: the clock is asked four times, then the stream is opened.
[[nodiscard]] std::vector<Reaction> frame_stream(Json params, const std::string& packets, bool closes = false);

/// A folder of its own that is removed with all that is in it.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string path(const std::string& name) const;
  /// The content of a file; empty where there is none.
  [[nodiscard]] std::string read(const std::string& name) const;
  /// The names of all that is there, hidden ones too, in order and with a comma after each.
  [[nodiscard]] std::string list(const std::string& name = ".") const;

 private:
  std::string root_;
};

}  // namespace tweend::cli::test
