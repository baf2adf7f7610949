#pragma once

#include <string>

#include "server/base/result.hpp"
#include "server/model/material.hpp"

namespace tweend::assets {

/// The image as a PNG file, with an alpha channel where it has any transparency; read_texture gives back the same pixels.
/// Pure; takes tens of milliseconds a megapixel. Safe from any thread.
/// @return Unavailable if memory runs out
[[nodiscard]] Result<std::string> write_png(const model::Image& image);

}  // namespace tweend::assets
