#include "clients/cli/session.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <ostream>

#include "clients/cli/connection.hpp"
#include "clients/cli/failure.hpp"

namespace tweend::cli {

Session::Session(const Options& options, const Io& io) : options_(options), io_(io) {}
Session::~Session() = default;

Json Session::call(std::string_view method, const Json& params) {
  Connection& server = connection();
  return server.call(method, params, deadline_in(options_.timeout_s));
}

Json Session::call_patiently(std::string_view method, const Json& params) { return connection().call(method, params, {}); }

Message Session::next(Deadline deadline) { return connection().next(deadline); }

void Session::expect_no_terminal(std::string_view what) const {
  if (!io_.out_is_terminal) return;
  throw Usage(
      fmt::format("expected standard output to be a file or a pipe for {}, found a terminal: name a file, or add "
                  "`> FILE` or `| PROGRAM`",
                  what));
}

Json Session::scene_params() const { return options_.scene ? Json{{"scene", *options_.scene}} : Json::object(); }

bool Session::print_line(std::string_view line) const {
  io_.out << line << '\n' << std::flush;
  return io_.out.good();
}

Connection& Session::connection() {
  if (!connection_) {
    connection_ = std::make_unique<Connection>(parse_endpoint(options_.server), deadline_in(options_.timeout_s));
  }
  return *connection_;
}

}  // namespace tweend::cli
