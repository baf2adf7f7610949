#pragma once

#include <memory>
#include <string>

#include "server/assets/open_beneath.hpp"
#include "server/base/file_sink.hpp"

namespace tweend::app {

/// A file that a program is asked to write: it takes its name, also another file's, once it is whole. Where the file system
/// can, it has none before, and nothing is left of it even if the process is killed. A link that is there stays, and the file
/// it names is written.
class OutputFile final : public FileSink {
 public:
  /// @return Unavailable naming it and the system's reason, also where something else than a regular file is there
  [[nodiscard]] static Result<std::unique_ptr<OutputFile>> open(const std::string& path);
  ~OutputFile() override;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] Status write_at(std::uint64_t offset, std::span<const std::byte> bytes) override;
  /// Once, and the last.
  [[nodiscard]] Status commit();

 private:
  OutputFile(std::string path, std::string hidden, assets::Descriptor file, bool named)
      : path_(std::move(path)), hidden_(std::move(hidden)), file_(std::move(file)), named_(named) {}

  const std::string path_;
  const std::string hidden_;  ///< beside it
  assets::Descriptor file_;
  bool named_;  ///< there is something called `hidden_`
};

}  // namespace tweend::app
