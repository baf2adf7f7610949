#pragma once

#include <string>

#include "server/base/result.hpp"
#include "server/net/web_files.hpp"

namespace tweend::app {

/// The page at `/`.
/// @param folder  `--web`; empty: share/tweend/web beside the folder of this program, and no page if that isn't there
/// @return Unavailable if there is a folder that holds no page
[[nodiscard]] Result<net::WebFiles> load_page(const std::string& folder);

}  // namespace tweend::app
