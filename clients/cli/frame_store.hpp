#pragma once

#include <fstream>
#include <iosfwd>
#include <string>

#include "clients/cli/connection.hpp"

namespace tweend::cli {

/// Where the packets of a stream of frames are put.
class FrameStore {
 public:
  FrameStore() = default;
  virtual ~FrameStore() = default;
  FrameStore(const FrameStore&) = delete;
  FrameStore& operator=(const FrameStore&) = delete;
  /// @return the file that it lies in now
  /// Throws NoServer where the packet is not of this kind, Failure where it can't be written.
  virtual std::string store(const Packet& packet) = 0;
};

/// A file for each picture, `frame_SEQUENCE.jpg` or `.png`.
class PictureFolder : public FrameStore {
 public:
  /// Makes the folder unless it is there. Throws Usage.
  explicit PictureFolder(std::string folder);
  std::string store(const Packet& packet) override;

 private:
  std::string folder_;
};

/// All payloads one after the other: for h264 what players call a raw stream, for rgba raw video.
class PayloadFile : public FrameStore {
 public:
  /// Opens the file; what an earlier one holds is kept until the first packet has come. Throws Usage.
  /// @param path  `-`: `out`
  PayloadFile(std::string path, std::ostream& out);
  /// A file that this has made and stored nothing in is removed.
  ~PayloadFile() override;
  std::string store(const Packet& packet) override;

 private:
  std::string path_;
  std::ostream& out_;
  std::ofstream file_;
  bool is_new_ = false;     ///< there was none before
  bool has_begun_ = false;  ///< with the first packet
};

}  // namespace tweend::cli
