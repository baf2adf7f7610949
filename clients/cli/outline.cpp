#include "clients/cli/outline.hpp"

#include <CLI/App.hpp>

namespace tweend::cli {
namespace {

void add_option(Outline& to, const CLI::Option& option) {
  const bool is_flag = option.get_expected_max() == 0 || option.get_type_size_max() == 0;
  const std::string shape = is_flag ? std::string() : option.get_type_name();
  if (option.get_positional()) to.arguments.push_back({shape, option.get_expected_max() > 1});
  for (const auto& name : option.get_lnames()) to.options.push_back({"--" + name, shape});
  for (const auto& name : option.get_snames()) to.options.push_back({"-" + name, shape});
}

void add_outlines(std::vector<Outline>& all, const CLI::App& app, const std::string& path) {
  Outline outline;
  outline.path = path;
  for (const CLI::Option* option : app.get_options()) add_option(outline, *option);
  const auto within = app.get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* command : within) outline.commands.push_back(command->get_name());
  all.push_back(std::move(outline));
  for (const CLI::App* command : within)
    add_outlines(all, *command, path.empty() ? command->get_name() : path + " " + command->get_name());
}

}  // namespace

std::vector<Outline> outline(const CLI::App& root) {
  std::vector<Outline> all;
  add_outlines(all, root, "");
  return all;
}

}  // namespace tweend::cli
