#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "server/base/result.hpp"

namespace tweend::assets {

/// Whether `text` may be scanned at all.
/// @return Limit past 2 GiB, which keeps every count of its parts within 32 bits; BadAsset where it holds a NUL byte
[[nodiscard]] Status check_text(std::string_view text, std::string_view name);

/// Parts an OBJ or MTL text into statements and their tokens, and counts lines. Lines end in LF, CRLF or CR; a backslash at
/// a line's end continues the statement; '#' begins a comment, which no backslash continues; a UTF-8 byte order mark
/// is skipped. The text must outlive the scanner and its tokens.
class ObjScanner {
 public:
  explicit ObjScanner(std::string_view text) noexcept;

  /// Skips the rest of this statement and moves to the next that has a token. @return false at the text's end
  [[nodiscard]] bool next_statement() noexcept;

  /// The next token of this statement; empty at its end.
  [[nodiscard]] std::string_view next_token() noexcept;

  /// All that is left of this statement, without the blanks around it; empty if that's nothing. For names: they may hold
  /// blanks, and a '#' is part of them ("Material #25"). Where the statement continues on a next line stands a space.
  [[nodiscard]] std::string rest_of_statement();

  /// The line, from 1, of the last token; after the empty one the line on which the statement ends.
  [[nodiscard]] std::uint32_t line() const noexcept { return line_; }

 private:
  [[nodiscard]] bool at_end() const noexcept { return position_ == text_.size(); }
  /// Bytes of the line end at `position`: 0, 1 or 2.
  [[nodiscard]] std::size_t line_end(std::size_t position) const noexcept;
  [[nodiscard]] std::size_t continuation(std::size_t position) const noexcept;
  void skip_blanks() noexcept;

  std::string_view text_;
  std::size_t position_ = 0;
  std::uint32_t line_ = 1;
  bool in_statement_ = false;
};

}  // namespace tweend::assets
