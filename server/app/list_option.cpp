#include "server/app/list_option.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <utility>

namespace tweend::app {
namespace {

std::string refused(const ListShape& shape, std::string_view found) {
  return fmt::format("expected {}, each {}; found {}", shape.form, shape.each, found);
}

}  // namespace

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> pieces;
  for (;;) {
    const std::size_t at = text.find(separator);
    pieces.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return pieces;
    text.remove_prefix(at + 1);
  }
}

Result<std::vector<double>> number_list(std::string_view text, char separator) {
  std::vector<double> numbers;
  for (const std::string_view piece : split(text, separator)) {
    double number = 0.0;
    const auto [end, error] = std::from_chars(piece.data(), piece.data() + piece.size(), number);
    if (error != std::errc() || end != piece.data() + piece.size() || !std::isfinite(number)) {
      return fail(ErrorCode::InvalidParams, fmt::format("\"{}\"", piece));
    }
    numbers.push_back(number);
  }
  return numbers;
}

CLI::Option* add_list(CLI::App& app, const std::string& name, const ListShape& shape, const std::string& help,
                      std::function<void(const std::vector<double>&)> take) {
  const auto read = [name, shape, take = std::move(take)](const std::string& text) {
    const auto numbers = number_list(text, shape.separator);
    if (!numbers) throw CLI::ValidationError(name, refused(shape, numbers.error().message));
    bool good = numbers->size() >= shape.least && numbers->size() <= shape.most;
    for (const double number : *numbers) good = good && shape.fits(number);
    if (!good) throw CLI::ValidationError(name, refused(shape, "\"" + text + "\""));
    take(*numbers);
  };
  return app.add_option_function<std::string>(name, read, help)->type_name(shape.form);
}

CLI::Validator finite_above_zero() {
  return CLI::Validator(
      [](const std::string& text) {
        const auto number = number_list(text, ',');
        const bool good = number && number->size() == 1 && number->front() > 0.0;
        return good ? std::string() : fmt::format("expected a number above 0, found \"{}\"", text);
      },
      "");
}

}  // namespace tweend::app
