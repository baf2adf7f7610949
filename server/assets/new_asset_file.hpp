#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "server/assets/open_beneath.hpp"
#include "server/base/file_sink.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {

// What is saved piece by piece (AssetRoot::new_file, new_folder): hidden until it is committed; let go of before, nothing of it
// is left. Where the process is killed meanwhile, something hidden stays that no listing shows. One thread at a time; they
// block on the disk.

class NewAssetFile final : public FileSink {
 public:
  /// @param name  as it is to be called from the assets folder on
  /// @return Unavailable with the system's reason
  [[nodiscard]] static Result<std::unique_ptr<NewAssetFile>> open(Descriptor folder, std::string name);
  ~NewAssetFile() override;
  NewAssetFile(const NewAssetFile&) = delete;
  NewAssetFile& operator=(const NewAssetFile&) = delete;

  [[nodiscard]] Status write_at(std::uint64_t offset, std::span<const std::byte> bytes) override;
  /// Gives it its name, once the disk has it. Once, and the last.
  /// @return Conflict where that was taken meanwhile, Unavailable; then nothing of it will be left
  [[nodiscard]] Status commit();

 private:
  NewAssetFile(Descriptor folder, Descriptor file, std::string name, std::string hidden);
  Descriptor folder_, file_;
  const std::string name_;
  std::string hidden_;  ///< empty once it is committed
};

class NewAssetFolder {
 public:
  [[nodiscard]] static Result<std::unique_ptr<NewAssetFolder>> open(Descriptor parent, std::string name);
  ~NewAssetFolder();
  NewAssetFolder(const NewAssetFolder&) = delete;
  NewAssetFolder& operator=(const NewAssetFolder&) = delete;

  /// @param file  without '/', none twice
  [[nodiscard]] Status add(const std::string& file, std::span<const std::byte> bytes);
  [[nodiscard]] Status commit();

 private:
  NewAssetFolder(Descriptor parent, Descriptor folder, std::string name, std::string hidden);
  Descriptor parent_, folder_;
  const std::string name_;
  std::string hidden_;
  std::vector<std::string> files_;
};

}  // namespace tweend::assets
