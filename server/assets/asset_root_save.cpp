#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <utility>

#include "server/assets/asset_name.hpp"
#include "server/assets/asset_root.hpp"
#include "server/assets/save_beneath.hpp"

namespace tweend::assets {
Result<Descriptor> AssetRoot::open_place(std::string_view name) const {
  if (!is_clean_name(name)) {
    return fail(ErrorCode::NotFound, fmt::format("expected a name under the assets folder, found {}", quoted_name(name)));
  }
  const std::size_t slash = name.rfind('/');
  const std::string folder(slash == std::string_view::npos ? "." : name.substr(0, slash));
  Opened opened = open_beneath(root_.get(), folder, O_PATH | O_DIRECTORY);
  if (opened.descriptor.is_open()) return std::move(opened.descriptor);
  if (opened.error == EACCES || folder == ".") return not_saved(name, opened.error);
  return fail(ErrorCode::NotFound, fmt::format("expected a folder {} under the assets folder to save in, found none: make it "
                                               "first, or choose a name without it",
                                               quoted_name(folder)));
}

Result<Descriptor> AssetRoot::open_new_place(std::string_view name) const {
  TWEEND_ASSIGN(Descriptor place, open_place(name));
  struct stat there {};
  const std::string last(last_component(name));
  if (::fstatat(place.get(), last.c_str(), &there, AT_SYMLINK_NOFOLLOW) == 0) return not_saved(name, EEXIST);
  return place;
}

Status AssetRoot::save_file(std::string_view name, std::string_view bytes) const {
  TWEEND_ASSIGN(const Descriptor place, open_place(name));
  const int error = save_file_in(place.get(), std::string(last_component(name)), bytes);
  if (error != 0) return not_saved(name, error);
  return {};
}

Status AssetRoot::save_folder(std::string_view name, std::span<const NewFile> files) const {
  TWEEND_ASSIGN(const Descriptor place, open_place(name));
  const int error = save_folder_in(place.get(), std::string(last_component(name)), files);
  if (error != 0) return not_saved(name, error);
  return {};
}

Result<std::unique_ptr<NewAssetFile>> AssetRoot::new_file(std::string_view name) const {
  TWEEND_ASSIGN(Descriptor place, open_new_place(name));
  return NewAssetFile::open(std::move(place), std::string(name));
}

Result<std::unique_ptr<NewAssetFolder>> AssetRoot::new_folder(std::string_view name) const {
  TWEEND_ASSIGN(Descriptor place, open_new_place(name));
  return NewAssetFolder::open(std::move(place), std::string(name));
}

}  // namespace tweend::assets
