#pragma once

#include <memory>
#include <string>

#include "server/assets/asset_root.hpp"
#include "server/streams/film.hpp"

namespace tweend::commands {

// Where recordings go: new files and folders under an assets folder, that are there once they are finished. Opening blocks on
// the disk.

/// An MP4 file.
/// @return as AssetRoot::new_file and Mp4Writer::open
[[nodiscard]] Result<std::unique_ptr<streams::PictureSink>> record_mp4(const assets::AssetRoot& folder, const std::string& name,
                                                                       render::Size size, double fps);
/// A folder of frame_000000.png, frame_000001.png, …
/// @return as AssetRoot::new_folder
[[nodiscard]] Result<std::unique_ptr<streams::PictureSink>> record_pngs(const assets::AssetRoot& folder,
                                                                        const std::string& name);

}  // namespace tweend::commands
