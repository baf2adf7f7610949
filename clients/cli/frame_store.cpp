#include "clients/cli/frame_store.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <ostream>
#include <system_error>
#include <utility>

#include "clients/cli/failure.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/picture.hpp"
#include "clients/cli/write_file.hpp"

namespace tweend::cli {
namespace {

/// Of a pipe or a device nothing is left to be emptied.
void empty_file(const std::string& path) {
  std::error_code none;
  if (std::filesystem::is_regular_file(path, none)) std::filesystem::resize_file(path, 0, none);
}

}  // namespace

PictureFolder::PictureFolder(std::string folder) : folder_(std::move(folder)) { make_folder(folder_); }

std::string PictureFolder::store(const Packet& packet) {
  const PictureFormat format = picture_format(packet.header);
  check_picture(packet.payload, format, fmt::format("packet {}", packet.header.sequence));
  const std::string name = fmt::format("frame_{:06}{}", packet.header.sequence, extension_of(format));
  std::string file = (std::filesystem::path(folder_) / name).string();
  write_file(file, packet.payload);
  return file;
}

PayloadFile::PayloadFile(std::string path, std::ostream& out) : path_(std::move(path)), out_(out) {
  if (path_ == "-") return;
  std::error_code unknown;
  is_new_ = !std::filesystem::exists(path_, unknown);
  file_.open(path_, std::ios::binary | std::ios::app);
  if (file_) return;
  throw Usage(
      fmt::format("--out: expected a file that can be written, found {}: {}", path_, std::generic_category().message(errno)));
}

PayloadFile::~PayloadFile() {
  if (is_new_ && !has_begun_) std::remove(path_.c_str());
}

std::string PayloadFile::store(const Packet& packet) {
  if (packet.header.kind != protocol::PacketKind::Frame) (void)picture_format(packet.header);  // refuses it
  const bool is_output = path_ == "-";
  if (!is_output && !std::exchange(has_begun_, true)) empty_file(path_);
  std::ostream& to = is_output ? out_ : file_;
  // Whoever plays it meanwhile waits for every single one.
  to << packet.payload << std::flush;
  if (to) return path_;
  throw Failure(ExitCode::Refused,
                fmt::format("can't write {}: expected a place for {}, found: {}", is_output ? "to standard output" : path_,
                            bytes_text(packet.payload.size()), std::generic_category().message(errno)));
}

}  // namespace tweend::cli
