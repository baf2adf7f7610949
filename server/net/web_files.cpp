#include "server/net/web_files.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <fstream>
#include <system_error>

namespace tweend::net {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kTypes{{
    {".html", "text/html; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".mjs", "text/javascript; charset=utf-8"},
    {".json", "application/json"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".ico", "image/x-icon"},
    {".woff2", "font/woff2"},
}};

/// The page brings all it needs, and nobody puts it into a frame of theirs.
constexpr std::string_view kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

std::string_view type_of(const fs::path& file) {
  const std::string extension = file.extension().string();
  for (const auto& [known, type] : kTypes) {
    if (extension == known) return type;
  }
  return {};
}

Error bad(const fs::path& folder, std::string_view expected, std::string_view found) {
  return fail(ErrorCode::Unavailable,
              fmt::format("expected {} in the page's folder {}, found {}; choose another with --web DIR", expected,
                          folder.string(), found));
}

/// Every name that begins with a dot stays out: editors and version control leave such things behind.
bool hidden(const fs::path& relative) {
  for (const fs::path& part : relative) {
    if (part.native().starts_with('.')) return true;
  }
  return false;
}

Result<WebFile> read(const fs::path& folder, const fs::path& path, std::string_view type) {
  std::string bytes(WebFiles::kFileBytes + 1, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (in.bad() || !(in || in.eof())) return bad(folder, "files that can be read", path.string());
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (bytes.size() > WebFiles::kFileBytes) {
    return bad(folder, fmt::format("files of at most {} bytes", WebFiles::kFileBytes), path.string());
  }
  bytes.shrink_to_fit();
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return WebFile{std::move(bytes), type, fmt::format("\"{:016x}{:016x}\"", hash.high64, hash.low64)};
}

/// Whether an If-None-Match names this tag; a weak one of the same content is as good here (RFC 9110, 13.1.2).
bool names(std::string_view if_none_match, std::string_view etag) {
  while (!if_none_match.empty()) {
    const std::size_t comma = if_none_match.find(',');  // our tags have none
    std::string_view one = if_none_match.substr(0, comma);
    if_none_match.remove_prefix(comma == std::string_view::npos ? if_none_match.size() : comma + 1);
    while (one.starts_with(' ') || one.starts_with('\t')) one.remove_prefix(1);
    while (one.ends_with(' ') || one.ends_with('\t')) one.remove_suffix(1);
    if (one.starts_with("W/")) one.remove_prefix(2);
    if (one == etag || one == "*") return true;
  }
  return false;
}

}  // namespace

Result<WebFiles> WebFiles::load(const fs::path& folder) {
  WebFiles all;
  std::size_t total = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const fs::path relative = at->path().lexically_relative(folder);
    const std::string_view type = type_of(relative);
    std::error_code gone;
    if (type.empty() || hidden(relative) || !at->is_regular_file(gone)) continue;
    TWEEND_ASSIGN(WebFile file, read(folder, at->path(), type));
    total += file.bytes.size();
    if (total > kAllBytes) return bad(folder, fmt::format("at most {} bytes", kAllBytes), "more");
    if (all.files_.size() == kFiles) return bad(folder, fmt::format("at most {} files", kFiles), "more");
    all.files_.emplace("/" + relative.generic_string(), std::move(file));
  }
  if (error) return bad(folder, "files that can be read", error.message());
  if (all.find("/") == nullptr) return bad(folder, "index.html", "none");
  return all;
}

const WebFile* WebFiles::find(std::string_view path) const noexcept {
  const auto at = files_.find(path == "/" ? std::string_view("/index.html") : path);
  return at == files_.end() ? nullptr : &at->second;
}

WebAnswer answer_web(const WebFile& file, std::string_view if_none_match) noexcept {
  WebAnswer answer;
  answer.headers = {{{"ETag", file.etag},
                     {"Cache-Control", "no-cache"},  // kept, but asked for each time: a new server has a new page
                     {"Content-Security-Policy", kPolicy},
                     {"Referrer-Policy", "no-referrer"}}};
  if (names(if_none_match, file.etag)) {
    answer.status = 304;
    return answer;
  }
  answer.body = file.bytes;
  answer.content_type = file.content_type;
  return answer;
}

}  // namespace tweend::net
