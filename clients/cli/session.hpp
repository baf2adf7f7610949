#pragma once

#include <cstddef>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "clients/cli/json.hpp"
#include "clients/cli/socket.hpp"

namespace tweend::cli {

class Connection;
struct Message;

/// Where a run reads and writes: the process's own streams, or a test's strings.
struct Io {
  std::istream& in;
  std::ostream& out;
  std::ostream& err;
  std::size_t err_columns = 0;   ///< of the terminal that `err` is; 0: it is none, and nobody watches it
  bool out_is_terminal = false;  ///< which bytes that are no text would garble
};

/// What holds for every command.
struct Options {
  std::string server = "127.0.0.1:8933";
  std::optional<std::string> scene;  ///< empty: not named, the server takes `main`
  bool json = false;                 ///< print for programs
  double timeout_s = 10.0;           ///< for the connection and for each answer
};

/// One run's server and output. Connects at the first call, so that a wrong command line never needs a server.
class Session {
 public:
  Session(const Options& options, const Io& io);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Waits for the answer as long as --timeout says. Throws Refusal or NoServer.
  [[nodiscard]] Json call(std::string_view method, const Json& params);
  /// The same, waiting for the answer however long it takes.
  [[nodiscard]] Json call_patiently(std::string_view method, const Json& params);
  /// The next event or packet. Throws NoServer or TimedOut.
  [[nodiscard]] Message next(Deadline deadline);

  [[nodiscard]] const Options& options() const noexcept { return options_; }
  [[nodiscard]] std::ostream& out() const noexcept { return io_.out; }
  [[nodiscard]] std::ostream& err() const noexcept { return io_.err; }
  /// Of the terminal on standard error; 0: it is none.
  [[nodiscard]] std::size_t err_columns() const noexcept { return io_.err_columns; }
  /// Throws Usage where standard output is a terminal.
  /// @param what  is to be written there, `a picture`
  void expect_no_terminal(std::string_view what) const;
  /// `{scene}` where one was named, else `{}`.
  [[nodiscard]] Json scene_params() const;
  /// Writes a line and lets it out at once: others may read the events as they come.
  /// @return false once nobody reads the output any more
  [[nodiscard]] bool print_line(std::string_view line) const;

 private:
  [[nodiscard]] Connection& connection();

  Options options_;
  Io io_;
  std::unique_ptr<Connection> connection_;
};

}  // namespace tweend::cli
