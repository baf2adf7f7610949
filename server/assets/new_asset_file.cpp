#include "server/assets/new_asset_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "server/assets/save_beneath.hpp"

namespace tweend::assets {
namespace {

int synced(int fd) { return ::fsync(fd) == 0 ? 0 : errno; }

}  // namespace

Result<std::unique_ptr<NewAssetFile>> NewAssetFile::open(Descriptor folder, std::string name) {
  std::string hidden = hidden_name();
  Opened file = create_in(folder.get(), hidden);
  if (!file.descriptor.is_open()) return not_saved(name, file.error == EEXIST ? EAGAIN : file.error);
  return std::unique_ptr<NewAssetFile>(
      new NewAssetFile(std::move(folder), std::move(file.descriptor), std::move(name), std::move(hidden)));
}

NewAssetFile::NewAssetFile(Descriptor folder, Descriptor file, std::string name, std::string hidden)
    : folder_(std::move(folder)), file_(std::move(file)), name_(std::move(name)), hidden_(std::move(hidden)) {}

NewAssetFile::~NewAssetFile() {
  if (!hidden_.empty()) static_cast<void>(::unlinkat(folder_.get(), hidden_.c_str(), 0));
}

Status NewAssetFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  const int error = write_all_at(file_.get(), offset, bytes);
  if (error != 0) return not_saved(name_, error);
  return {};
}

Status NewAssetFile::commit() {
  int error = synced(file_.get());
  if (error == 0) error = rename_new(folder_.get(), hidden_, std::string(last_component(name_)), false);
  if (error != 0) return not_saved(name_, error);  // the destructor removes it
  hidden_.clear();
  sync_folder(folder_.get());
  return {};
}

Result<std::unique_ptr<NewAssetFolder>> NewAssetFolder::open(Descriptor parent, std::string name) {
  std::string hidden = hidden_name();
  Opened folder = create_folder_in(parent.get(), hidden);
  if (!folder.descriptor.is_open()) return not_saved(name, folder.error == EEXIST ? EAGAIN : folder.error);
  return std::unique_ptr<NewAssetFolder>(
      new NewAssetFolder(std::move(parent), std::move(folder.descriptor), std::move(name), std::move(hidden)));
}

NewAssetFolder::NewAssetFolder(Descriptor parent, Descriptor folder, std::string name, std::string hidden)
    : parent_(std::move(parent)), folder_(std::move(folder)), name_(std::move(name)), hidden_(std::move(hidden)) {}

NewAssetFolder::~NewAssetFolder() {
  if (hidden_.empty()) return;
  for (const std::string& file : files_) static_cast<void>(::unlinkat(folder_.get(), file.c_str(), 0));
  static_cast<void>(::unlinkat(parent_.get(), hidden_.c_str(), AT_REMOVEDIR));
}

Status NewAssetFolder::add(const std::string& file, std::span<const std::byte> bytes) {
  const Opened made = create_in(folder_.get(), file);
  int error = made.error;
  if (error == 0) {
    files_.push_back(file);
    error = write_all_at(made.descriptor.get(), 0, bytes);
  }
  if (error == 0) error = synced(made.descriptor.get());
  if (error != 0) return not_saved(name_, error);
  return {};
}

Status NewAssetFolder::commit() {
  int error = synced(folder_.get());
  if (error == 0) error = rename_new(parent_.get(), hidden_, std::string(last_component(name_)), true);
  if (error != 0) return not_saved(name_, error);  // the destructor removes it
  hidden_.clear();
  sync_folder(parent_.get());
  return {};
}

}  // namespace tweend::assets
