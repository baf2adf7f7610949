#pragma once

#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "clients/cli/json.hpp"

namespace tweend::cli {

/// Compact JSON on one line. Bytes that are not UTF-8 are replaced: arguments may hold any.
[[nodiscard]] std::string to_line(const Json& value);

/// A number as people write it: six digits at most, no -0.
[[nodiscard]] std::string number_text(double value);

/// A number of bytes as people read it: `812 B`, `23.4 kB`, `1.9 MB`.
[[nodiscard]] std::string bytes_text(std::uint64_t bytes);

/// The text on one line, without control characters: names in files may hold what would steer a terminal.
[[nodiscard]] std::string printable(std::string_view text);

/// Any value in few words: `1, 2, 3` for an array, `x 1, y 2` for an object, `-` for null.
[[nodiscard]] std::string brief(const Json& value);

/// brief() of a member; `-` where there is none.
[[nodiscard]] std::string brief_member(const Json& object, std::string_view member);

/// Fills the {names} of `pattern` from the result, else from the params, and adds the new revision where there is one.
[[nodiscard]] std::string sentence(std::string_view pattern, const Json& params, const Json& result);

/// Aligned columns: numbers to the right, the rest to the left.
class Table {
 public:
  explicit Table(std::vector<std::string> titles) : rows_{std::move(titles)} {}

  void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  /// A row of brief() members, in the order of `members`.
  void row_of(const Json& object, std::initializer_list<std::string_view> members);
  [[nodiscard]] bool empty() const noexcept { return rows_.size() == 1; }
  /// Writes the titles and the rows.
  void print(std::ostream& out) const;

 private:
  std::vector<std::vector<std::string>> rows_;  ///< the first are the titles
};

/// A table of what an array holds, whatever that is: a column for each member of its objects.
void print_rows(std::ostream& out, const Json& array, std::string_view empty);

/// Names, one a line: the array's strings, or this member of its objects.
void print_names(std::ostream& out, const Json& array, std::string_view member);

}  // namespace tweend::cli
