#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "server/base/result.hpp"

namespace tweend::net {

/// A file of the page, as it goes out.
struct WebFile {
  std::string bytes;
  std::string_view content_type;
  std::string etag;  ///< a strong one, of the content, with its quotes
};

/// The page at `/`, read once: nothing but what was there at the start can be asked for, whatever a path says.
class WebFiles {
 public:
  static constexpr std::size_t kFileBytes = 8U << 20U;
  static constexpr std::size_t kAllBytes = 64U << 20U;
  static constexpr std::size_t kFiles = 1000;

  /// No page.
  WebFiles() = default;

  /// Reads a folder and those below it. Files whose names begin with a dot or whose types no browser needs are left out.
  /// @return Unavailable if it can't be read, has no index.html or is past the bounds above
  [[nodiscard]] static Result<WebFiles> load(const std::filesystem::path& folder);

  /// @param path  of a request, without its query; "/" is index.html
  /// @return null: there is no such file. Lives as long as this.
  [[nodiscard]] const WebFile* find(std::string_view path) const noexcept;

 private:
  std::map<std::string, WebFile, std::less<>> files_;  ///< by path, "/main.js"
};

/// What a request for a file is answered, apart from what every answer has. Views into the file.
struct WebAnswer {
  unsigned status = 200;  ///< 304: the client has it
  std::string_view body;
  std::string_view content_type;
  std::array<std::pair<std::string_view, std::string_view>, 4> headers;  ///< name, value
};

/// @param if_none_match  the request's header, empty if it has none
[[nodiscard]] WebAnswer answer_web(const WebFile& file, std::string_view if_none_match) noexcept;

}  // namespace tweend::net
