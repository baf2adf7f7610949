#include "server/assets/obj_scanner.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tweend::assets {
namespace {

// A corner of a face takes two bytes at least.
constexpr std::size_t kMaxTextBytes = std::size_t{1} << 31U;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool is_blank(char c) noexcept { return c == ' ' || c == '\t'; }

}  // namespace

Status check_text(std::string_view text, std::string_view name) {
  if (text.size() > kMaxTextBytes) {
    return fail(ErrorCode::Limit, fmt::format("{}: expected at most {} bytes, found {}", name, kMaxTextBytes, text.size()));
  }
  const std::size_t nul = text.find('\0');
  if (nul == std::string_view::npos) return {};
  const std::string_view before = text.substr(0, nul);
  return fail(ErrorCode::BadAsset, fmt::format("{}:{}: expected text, found a NUL byte: this is a binary file", name,
                                               std::count(before.begin(), before.end(), '\n') + 1));
}

ObjScanner::ObjScanner(std::string_view text) noexcept : text_(text) {
  if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
}

std::size_t ObjScanner::line_end(std::size_t position) const noexcept {
  if (position == text_.size()) return 0;
  if (text_[position] == '\n') return 1;
  if (text_[position] != '\r') return 0;
  return position + 1 < text_.size() && text_[position + 1] == '\n' ? 2 : 1;
}

/// Bytes of the backslash and line end at `position`, or 0.
std::size_t ObjScanner::continuation(std::size_t position) const noexcept {
  if (text_[position] != '\\') return 0;
  const std::size_t bytes = line_end(position + 1);
  return bytes == 0 ? 0 : bytes + 1;
}

/// Moves to a token, a line's end or the text's end.
void ObjScanner::skip_blanks() noexcept {
  while (!at_end()) {
    const char c = text_[position_];
    if (is_blank(c)) {
      ++position_;
    } else if (const std::size_t bytes = continuation(position_); bytes != 0) {
      position_ += bytes;
      ++line_;
    } else if (c == '#') {
      position_ = std::min(text_.find_first_of("\r\n", position_), text_.size());
    } else {
      return;
    }
  }
}

bool ObjScanner::next_statement() noexcept {
  while (in_statement_ && !next_token().empty()) {
  }
  for (;;) {
    skip_blanks();
    const std::size_t bytes = line_end(position_);
    if (bytes == 0) {
      in_statement_ = !at_end();
      return in_statement_;
    }
    position_ += bytes;
    ++line_;
  }
}

std::string_view ObjScanner::next_token() noexcept {
  skip_blanks();
  const std::size_t begin = position_;
  while (!at_end()) {
    const char c = text_[position_];
    if (is_blank(c) || c == '\n' || c == '\r' || c == '#') break;
    if (c == '\\' && continuation(position_) != 0) break;
    ++position_;
  }
  return text_.substr(begin, position_ - begin);
}

std::string ObjScanner::rest_of_statement() {
  std::string rest;
  while (!at_end() && line_end(position_) == 0) {
    if (const std::size_t bytes = continuation(position_); bytes != 0) {
      rest += ' ';
      position_ += bytes;
      ++line_;
    } else {
      rest += text_[position_++];
    }
  }
  rest.erase(std::find_if_not(rest.rbegin(), rest.rend(), is_blank).base(), rest.end());
  rest.erase(rest.begin(), std::find_if_not(rest.begin(), rest.end(), is_blank));
  return rest;
}

}  // namespace tweend::assets
