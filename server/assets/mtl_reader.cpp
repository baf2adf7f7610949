#include "server/assets/mtl_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <unordered_map>
#include <utility>

#include "server/assets/obj_scanner.hpp"
#include "server/assets/token.hpp"

namespace tweend::assets {
namespace {

constexpr std::string_view kBlanks = " \t";

// In lower case. Known, and not shown: other reflections, transparency, refraction, relief, physically based shading.
constexpr std::string_view kSkipped[] = {
    "ka",   "ks",    "ke",   "km",   "ns", "ni", "d",  "tr", "tf",  "illum", "sharpness", "bump",
    "disp", "decal", "refl", "norm", "pr", "pm", "ps", "pc", "pcr", "aniso", "anisor",
};
constexpr std::string_view kMapPrefix = "map_";

/// An option of a texture statement, and how many tokens follow it.
struct MapOption {
  std::string_view name;
  std::size_t least;
  std::size_t most;  ///< more than `least`: numbers, of which those after the first may be left out
};
constexpr MapOption kMapOptions[] = {
    {"-blendu", 1, 1}, {"-blendv", 1, 1}, {"-boost", 1, 1}, {"-mm", 2, 2},      {"-o", 1, 3},    {"-s", 1, 3},  {"-t", 1, 3},
    {"-texres", 1, 1}, {"-clamp", 1, 1},  {"-bm", 1, 1},    {"-imfchan", 1, 1}, {"-type", 1, 1}, {"-cc", 1, 1},
};

std::string lower(std::string_view token) {
  std::string text(token);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

std::string_view first_token(std::string_view text) { return text.substr(0, text.find_first_of(kBlanks)); }

/// What follows the first token and the blanks after it.
std::string_view after_first_token(std::string_view text) {
  text.remove_prefix(first_token(text).size());
  return text.substr(std::min(text.find_first_not_of(kBlanks), text.size()));
}

class Reader {
 public:
  Reader(std::string_view text, std::string_view name) : scanner_(text), name_(name) {}

  Result<std::vector<MtlMaterial>> read() {
    while (scanner_.next_statement()) TWEEND_TRY(read_statement());
    return std::move(materials_);
  }

 private:
  [[nodiscard]] Error fail_here(std::string_view expected, std::string_view found) const {
    return fail(ErrorCode::BadAsset, fmt::format("{}:{}: expected {}, found {}", name_, scanner_.line(), expected, found));
  }

  Status read_statement() {
    const std::string_view token = scanner_.next_token();
    const std::string keyword = lower(token);
    if (keyword == "newmtl") return read_newmtl();
    if (keyword == "kd" || keyword == "map_kd") {
      if (materials_.empty()) return fail_here("newmtl before any statement about a material", quoted_token(token));
      return keyword == "kd" ? read_diffuse() : read_diffuse_map();
    }
    if (keyword.starts_with(kMapPrefix)) return {};
    if (std::find(std::begin(kSkipped), std::end(kSkipped), keyword) != std::end(kSkipped)) return {};
    return fail_here("an MTL statement (newmtl, Kd, map_Kd, Ka, Ks, Ns, d, illum ...)", quoted_token(token));
  }

  Status read_newmtl() {
    std::string name = scanner_.rest_of_statement();
    if (name.empty()) return fail_here("a material's name after newmtl", "none");
    const auto [known, is_new] = index_of_.try_emplace(name, materials_.size());
    if (is_new) materials_.emplace_back();
    current_ = known->second;
    materials_[current_] = {std::move(name), std::nullopt, {}};
    return {};
  }

  Status read_diffuse() {
    std::array<float, 3> numbers{};
    std::size_t count = 0;
    for (std::string_view token = scanner_.next_token(); !token.empty(); token = scanner_.next_token()) {
      const std::optional<float> number = parse_number(token);
      if (!number) return fail_here("a finite number", quoted_token(token));
      if (count == numbers.size()) return fail_here("1 or 3 numbers", "more");
      numbers[count++] = *number;
    }
    if (count == 1) numbers[1] = numbers[2] = numbers[0];  // grey, as MTL has it
    if (count != 1 && count != 3) return fail_here("1 or 3 numbers", fmt::to_string(count));
    materials_[current_].diffuse = {numbers[0], numbers[1], numbers[2]};
    return {};
  }

  Status read_diffuse_map() {
    const std::string statement = scanner_.rest_of_statement();
    TWEEND_ASSIGN(const std::string_view file, skip_options(statement));
    std::string& map = materials_[current_].diffuse_map;
    map = file;
    std::replace(map.begin(), map.end(), '\\', '/');
    return {};
  }

  /// @return what follows the options: the file's name
  [[nodiscard]] Result<std::string_view> skip_options(std::string_view statement) const {
    for (;;) {
      const std::string_view token = first_token(statement);
      const auto* const option = std::find_if(std::begin(kMapOptions), std::end(kMapOptions),
                                              [&](const MapOption& known) { return known.name == token; });
      if (option == std::end(kMapOptions)) return statement;
      TWEEND_ASSIGN(statement, skip_arguments(*option, after_first_token(statement)));
    }
  }

  [[nodiscard]] Result<std::string_view> skip_arguments(const MapOption& option, std::string_view rest) const {
    const bool numbers = option.most > option.least;
    for (std::size_t i = 0; i < option.most; ++i) {
      const std::string_view token = first_token(rest);
      const bool number = parse_number(token).has_value();
      // The last token is the file, even if it looks like one more number.
      if (i >= option.least && (!number || after_first_token(rest).empty())) return rest;
      if (token.empty()) return fail_here(fmt::format("{} argument(s) of {}", option.least, option.name), fmt::to_string(i));
      if (numbers && !number) return fail_here(fmt::format("a finite number after {}", option.name), quoted_token(token));
      rest = after_first_token(rest);
    }
    return rest;
  }

  ObjScanner scanner_;
  std::string_view name_;
  std::vector<MtlMaterial> materials_;
  std::unordered_map<std::string, std::size_t> index_of_;  ///< by name
  std::size_t current_ = 0;                                ///< the material that statements are about
};

}  // namespace

Result<std::vector<MtlMaterial>> read_mtl(std::string_view text, std::string_view name) {
  TWEEND_TRY(check_text(text, name));
  return Reader(text, name).read();
}

}  // namespace tweend::assets
