#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tweend::bench {

/// A connection of line JSON with one stream of pictures on it: counts them, and keeps what it is told to keep.
class PictureViewer {
 public:
  /// Asks for the stream and waits for the answer.
  /// @param params  of `stream.open`
  PictureViewer(std::uint16_t port, const std::string& params);
  ~PictureViewer();
  PictureViewer(const PictureViewer&) = delete;
  PictureViewer& operator=(const PictureViewer&) = delete;

  [[nodiscard]] int socket() const noexcept { return socket_; }
  /// Takes what has come; does not wait.
  void drain();

  [[nodiscard]] std::size_t pictures() const noexcept { return pictures_; }
  /// From now on the pictures' bytes are kept, by sequence.
  void keep_pictures() noexcept { keeping_ = true; }
  [[nodiscard]] const std::map<std::uint32_t, std::string>& kept() const noexcept { return kept_; }

 private:
  /// @return how much of `text` was whole: a line, or a packet with the line that announces it
  std::size_t take(std::string_view text);
  void take_packet(std::string_view packet);

  int socket_ = -1;
  bool open_ = false;
  bool keeping_ = false;
  std::size_t pictures_ = 0;
  std::string received_;
  std::map<std::uint32_t, std::string> kept_;
};

using Viewers = std::vector<std::unique_ptr<PictureViewer>>;

/// Reads for all of them on this thread for so long.
void watch(const Viewers& viewers, double seconds);

}  // namespace tweend::bench
