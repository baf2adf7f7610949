#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "clients/cli/arguments.hpp"
#include "clients/cli/command.hpp"
#include "clients/cli/failure.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/session.hpp"

namespace tweend::cli {
namespace {

Json parse_object(const std::string& text, const std::string& what) {
  Json params = Json::parse(text, nullptr, false);
  if (!params.is_object()) throw Usage(what + ": expected a JSON object");
  return params;
}

/// `-`, a JSON object, or NAME=VALUE where a value that is not JSON is a string: `actor=box time=2 range=[0,1]`.
Json call_params(const std::vector<std::string>& words, std::istream& in) {
  Json params = Json::object();
  for (const std::string& word : words) {
    const auto equals = word.find('=');
    if (word == "-") {
      params.update(parse_object(read_file(word, in), "standard input"));
    } else if (word.starts_with('{') || equals == std::string::npos || equals == 0) {
      params.update(parse_object(word, word));
    } else {
      const std::string text = word.substr(equals + 1);
      Json value = Json::parse(text, nullptr, false);
      params[word.substr(0, equals)] = value.is_discarded() ? Json(text) : std::move(value);
    }
  }
  return params;
}

ExitCode call(Session& session, const Arguments& arguments, std::istream& in) {
  Json params = session.scene_params();
  params.update(call_params(arguments.get<std::vector<std::string>>("params", {}), in));
  const Json result = session.call(arguments.get<std::string>("method", ""), params);
  session.out() << (session.options().json ? to_line(result) : result.dump(2, ' ', false, Json::error_handler_t::replace))
                << '\n';
  return ExitCode::Done;
}

/// The description of one method; throws Failure where the server has none.
Json find_method(const Json& methods, const std::string& name) {
  const auto is_it = [&](const Json& method) { return method.value("name", "") == name; };
  const auto found = std::find_if(methods.begin(), methods.end(), is_it);
  if (found == methods.end()) throw Failure(ExitCode::Refused, "the server has no method " + name);
  return *found;
}

std::string type_text(const Json& schema) {
  for (const char* member : {"type", "$ref"}) {
    if (schema.is_object() && schema.contains(member)) return brief(schema.at(member));
  }
  return "any";
}

void print_method(std::ostream& out, const Json& method) {
  out << brief_member(method, "name") << ": " << brief_member(method, "summary") << '\n';
  Table table({"parameter", "type", "required", "meaning"});
  for (const Json& parameter : method.value("params", Json::array())) {
    const Json schema = parameter.value("schema", Json::object());
    const bool describes = parameter.contains("description");
    table.row({brief_member(parameter, "name"), type_text(schema), parameter.value("required", false) ? "yes" : "no",
               brief_member(describes ? parameter : schema, "description")});
  }
  if (!table.empty()) table.print(out);
}

void print_methods(std::ostream& out, const Json& methods) {
  Table table({"method", "role", "summary"});
  for (const Json& method : methods) table.row_of(method, {"name", "x-role", "summary"});
  table.print(out);
}

ExitCode methods(Session& session, const Arguments& arguments) {
  const Json document = session.call("rpc.discover", Json::object());
  const Json& methods = document.at("methods");
  const auto name = arguments.get<std::string>("method", "");
  const Json chosen = name.empty() ? methods : find_method(methods, name);
  if (arguments.has("names")) {
    print_names(session.out(), name.empty() ? chosen : chosen.value("params", Json::array()), "name");
  } else if (session.options().json) {
    session.out() << to_line(name.empty() ? document : chosen) << '\n';
  } else {
    name.empty() ? print_methods(session.out(), chosen) : print_method(session.out(), chosen);
  }
  return ExitCode::Done;
}

}  // namespace

void add_raw_commands(CommandSet& commands) {
  commands.add("call", "Call any method and print its result.")
      .argument("METHOD", own("method"), text("METHOD"), "as `methods` says")
      .more_arguments("PARAMS", own("params"), "NAME=VALUE", "NAME=VALUE, a JSON object, or - for one on standard input")
      .runs([&in = commands.in()](Session& session, const Arguments& arguments) { return call(session, arguments, in); });
  commands.add("methods", "What the server can be asked; with a METHOD: what that takes.")
      .optional_argument("METHOD", own("method"), text("METHOD"), "only this one")
      .flag("--names", own("names"), "only the names of the methods, or of the METHOD's parameters, one a line")
      .runs(methods);
}

}  // namespace tweend::cli
