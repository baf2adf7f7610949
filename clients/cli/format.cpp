#include "clients/cli/format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <ostream>

namespace tweend::cli {
namespace {

std::string join(const Json& container, bool named) {
  std::string text;
  for (const auto& [name, value] : container.items()) {
    if (!text.empty()) text += ", ";
    if (named) text += printable(name) + " ";
    text += value.is_structured() ? fmt::format("({})", brief(value)) : brief(value);
  }
  return text.empty() ? "-" : text;
}

/// Code points, which is what most terminals give one column each.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

bool is_number(std::string_view text) {
  return text == "-" || (text.find_first_of("0123456789") != std::string_view::npos &&
                         text.find_first_not_of("0123456789+-.e") == std::string_view::npos);
}

}  // namespace

std::string to_line(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string number_text(double value) { return fmt::format("{:.6g}", value == 0.0 ? 0.0 : value); }

std::string bytes_text(std::uint64_t bytes) {
  if (bytes < 1000) return fmt::format("{} B", bytes);
  double value = static_cast<double>(bytes) * 1e-3;
  const char* unit = "kB";
  for (const char* next : {"MB", "GB", "TB"}) {
    if (value < 999.95) break;  // or it would read 1000.0
    value *= 1e-3;
    unit = next;
  }
  return fmt::format("{:.1f} {}", value, unit);
}

std::string printable(std::string_view text) {
  std::string line(text);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; }, ' ');
  return line;
}

std::string brief(const Json& value) {
  if (value.is_string()) return printable(value.get_ref<const std::string&>());
  if (value.is_number_float()) return number_text(value.get<double>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_null()) return "-";
  if (value.is_structured()) return join(value, value.is_object());
  return to_line(value);
}

std::string brief_member(const Json& object, std::string_view member) {
  const auto found = object.find(std::string(member));
  return found == object.end() ? "-" : brief(*found);
}

std::string sentence(std::string_view pattern, const Json& params, const Json& result) {
  std::string text;
  for (std::size_t at = 0; at < pattern.size();) {
    const std::size_t open = std::min(pattern.find('{', at), pattern.size());
    text += pattern.substr(at, open - at);
    if (open == pattern.size()) break;
    const std::size_t close = pattern.find('}', open);
    const std::string name(pattern.substr(open + 1, close - open - 1));
    text += brief_member(result.contains(name) ? result : params, name);
    at = close + 1;
  }
  if (result.contains("revision")) text += fmt::format(" (revision {})", brief_member(result, "revision"));
  return text;
}

void Table::row_of(const Json& object, std::initializer_list<std::string_view> members) {
  std::vector<std::string> cells;
  for (const auto member : members) cells.push_back(brief_member(object, member));
  row(std::move(cells));
}

void Table::print(std::ostream& out) const {
  std::vector<std::size_t> widths(rows_.front().size(), 0);
  std::vector<bool> numeric(rows_.front().size(), !empty());
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    for (std::size_t c = 0; c < widths.size(); ++c) {
      widths[c] = std::max(widths[c], width(rows_[r][c]));
      if (r > 0 && !is_number(rows_[r][c])) numeric[c] = false;
    }
  }
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t c = 0; c < widths.size(); ++c) {
      const std::string gap(widths[c] - width(row[c]), ' ');
      if (c > 0) line += "  ";
      line += numeric[c] ? gap + row[c] : row[c] + gap;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out << line << '\n';
  }
}

void print_rows(std::ostream& out, const Json& array, std::string_view empty) {
  std::vector<std::string> members;
  for (const Json& element : array) {
    if (!element.is_object()) continue;
    for (const auto& [member, value] : element.items()) {
      if (std::find(members.begin(), members.end(), member) == members.end()) members.push_back(member);
    }
  }
  if (array.empty()) {
    out << empty << '\n';
  } else if (members.empty()) {
    print_names(out, array, "");
  } else {
    Table table(members);
    for (const Json& element : array) {
      std::vector<std::string> cells;
      for (const auto& member : members) cells.push_back(brief_member(element, member));
      table.row(std::move(cells));
    }
    table.print(out);
  }
}

void print_names(std::ostream& out, const Json& array, std::string_view member) {
  for (const Json& element : array) out << (element.is_object() ? brief_member(element, member) : brief(element)) << '\n';
}

}  // namespace tweend::cli
