#include "server/app/page.hpp"

#include <filesystem>
#include <system_error>

namespace tweend::app {

namespace fs = std::filesystem;

Result<net::WebFiles> load_page(const std::string& folder) {
  if (!folder.empty()) return net::WebFiles::load(folder);
  std::error_code error;
  // bin/tweend finds share/tweend/web, where it is installed as where it was built.
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path beside = program.parent_path().parent_path() / "share" / "tweend" / "web";
  if (error || !fs::is_directory(beside, error)) return net::WebFiles();
  return net::WebFiles::load(beside);
}

}  // namespace tweend::app
