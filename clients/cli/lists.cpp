#include "clients/cli/lists.hpp"

#include <nlohmann/json.hpp>
#include <ostream>

#include "clients/cli/arguments.hpp"
#include "clients/cli/format.hpp"
#include "clients/cli/session.hpp"

namespace tweend::cli {

void lists(Command& command, const char* method, Pick pick, const char* name, const char* when_empty) {
  command.flag("--names", own("names"), "only the names, one a line");
  command.runs([=](Session& session, const Arguments& arguments) {
    const Json result = session.call(method, arguments.params);
    if (arguments.has("names")) {
      print_names(session.out(), pick(result), name);
    } else if (session.options().json) {
      session.out() << to_line(result) << '\n';
    } else {
      print_rows(session.out(), pick(result), when_empty);
    }
    return ExitCode::Done;
  });
}

}  // namespace tweend::cli
