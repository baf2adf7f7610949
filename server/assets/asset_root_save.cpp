#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "server/assets/asset_name.hpp"
#include "server/assets/asset_root.hpp"
#include "server/assets/save_beneath.hpp"

namespace tweend::assets {
namespace {

Error not_saved(std::string_view name, int error) {
  const std::string quoted = quoted_name(name);
  switch (error) {
    case EEXIST:
    case ENOTEMPTY:
      return fail(ErrorCode::Conflict, fmt::format("expected a new name under the assets folder, found that there is a {} "
                                                   "already: choose another, or remove that one",
                                                   quoted));
    case ENAMETOOLONG:
      return fail(ErrorCode::InvalidParams, fmt::format("expected a name that the disk can hold, found {}", quoted));
    default:
      return fail(ErrorCode::Unavailable,
                  fmt::format("{} can't be saved: {}; nothing of it is left", quoted, std::generic_category().message(error)));
  }
}

std::string_view last_component(std::string_view name) { return name.substr(name.rfind('/') + 1); }

}  // namespace

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

}  // namespace tweend::assets
