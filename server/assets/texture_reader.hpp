#pragma once

#include <string_view>

#include "server/base/limits.hpp"
#include "server/base/result.hpp"
#include "server/model/material.hpp"

namespace tweend::assets {

/// Decodes a PNG or JPEG file, told apart by its first bytes; colours are taken as sRGB, whatever profile it carries.
/// Pure; safe from any thread. Its size is judged from the header, before memory is taken for the pixels.
/// @param bytes  of the whole file
/// @param name   as messages call it
/// @return BadAsset with what the library said of a file that is damaged or cut short, or names the first bytes of
///         one that is neither; Limit for more than Limits::texture_pixels, or a side past 16384 pixels
[[nodiscard]] Result<model::ImagePtr> read_texture(std::string_view bytes, std::string_view name, const Limits& limits);

}  // namespace tweend::assets
