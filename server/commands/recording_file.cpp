#include "server/commands/recording_file.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "render/image_encoder.hpp"
#include "render/mp4_writer.hpp"

namespace tweend::commands {
namespace {

class Mp4File final : public streams::PictureSink {
 public:
  Mp4File(std::unique_ptr<assets::NewAssetFile> file, render::Mp4Writer writer)
      : file_(std::move(file)), writer_(std::move(writer)) {}

  Status add(const render::ImageView& image) override { return writer_.add(image); }
  Result<std::uint64_t> finish() override {
    TWEEND_TRY(writer_.finish());
    TWEEND_TRY(file_->commit());
    return writer_.bytes();
  }

 private:
  const std::unique_ptr<assets::NewAssetFile> file_;  // before the writer, which writes to it
  render::Mp4Writer writer_;
};

class PngFolder final : public streams::PictureSink {
 public:
  explicit PngFolder(std::unique_ptr<assets::NewAssetFolder> folder) : folder_(std::move(folder)) {}

  Status add(const render::ImageView& image) override {
    TWEEND_ASSIGN(const std::vector<std::byte> file, render::encode_png(image));
    TWEEND_TRY(folder_->add(fmt::format("frame_{:06}.png", pictures_), file));
    ++pictures_;
    bytes_ += file.size();
    return {};
  }
  Result<std::uint64_t> finish() override {
    TWEEND_TRY(folder_->commit());
    return bytes_;
  }

 private:
  const std::unique_ptr<assets::NewAssetFolder> folder_;
  std::size_t pictures_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace

Result<std::unique_ptr<streams::PictureSink>> record_mp4(const assets::AssetRoot& folder, const std::string& name,
                                                         render::Size size, double fps) {
  TWEEND_ASSIGN(std::unique_ptr<assets::NewAssetFile> file, folder.new_file(name));
  TWEEND_ASSIGN(render::Mp4Writer writer, render::Mp4Writer::open({size, fps}, *file));
  return std::make_unique<Mp4File>(std::move(file), std::move(writer));
}

Result<std::unique_ptr<streams::PictureSink>> record_pngs(const assets::AssetRoot& folder, const std::string& name) {
  TWEEND_ASSIGN(std::unique_ptr<assets::NewAssetFolder> made, folder.new_folder(name));
  return std::make_unique<PngFolder>(std::move(made));
}

}  // namespace tweend::commands
