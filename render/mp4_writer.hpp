#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "render/image_view.hpp"
#include "server/base/file_sink.hpp"
#include "server/base/result.hpp"

namespace tweend::render {

struct Mp4Options {
  Size size;          ///< even sides
  double fps = 30.0;  ///< picture k is shown from k / fps on, for 1 / fps: 29.97 is 2997/100 and exact
  /// How many pictures at most, where that is known: the index then comes first, and the file plays while it loads.
  std::optional<std::size_t> pictures = {};
};

/// Writes a film: pictures in H.264 (H264Encoder, a key every two seconds) in an MP4 file, by FFmpeg. Says nothing of where or
/// when it was made: the same pictures make the same file. Not for the network thread; one thread at a time.
class Mp4Writer {
 public:
  /// Of the index: what each picture takes at most (its length, place and whether it is a key), and all the rest.
  static constexpr std::size_t kIndexBytesEach = 24, kIndexBytes = 4096;
  /// So many pictures can be foretold: FFmpeg takes the index's bytes as an int.
  static constexpr std::size_t kMostPictures =
      (static_cast<std::size_t>(std::numeric_limits<int>::max()) - kIndexBytes) / kIndexBytesEach;

  /// @param file  outlives the writer; empty
  /// @return InvalidParams, Unavailable as H264Encoder::open, and for a rate that is not between a picture in a million seconds
  /// and a million a second; Limit for more pictures than kMostPictures; Unavailable as the file says
  [[nodiscard]] static Result<Mp4Writer> open(const Mp4Options& options, FileSink& file);
  ~Mp4Writer();
  Mp4Writer(Mp4Writer&&) noexcept;
  Mp4Writer& operator=(Mp4Writer&&) noexcept;

  /// The next picture. @return as H264Encoder::encode; Unavailable as the file says; the file is of no use then
  [[nodiscard]] Status add(const ImageView& image);
  /// Writes the index: the file is whole. Once, and the last. @return InvalidParams without any picture; as add
  [[nodiscard]] Status finish();

  [[nodiscard]] std::size_t pictures() const noexcept;
  [[nodiscard]] std::uint64_t bytes() const noexcept;  ///< of the file so far

 private:
  struct Impl;
  explicit Mp4Writer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tweend::render
