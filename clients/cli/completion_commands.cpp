#include <ostream>

#include "clients/cli/command.hpp"
#include "clients/cli/completion.hpp"
#include "clients/cli/families.hpp"
#include "clients/cli/session.hpp"

namespace tweend::cli {

void add_completion_commands(CommandSet& commands) {
  commands.group("completion", "Print a completion script for a shell.");
  commands.add("completion bash", "For bash: source <(tweenctl completion bash)")
      .runs([&root = commands.root()](Session& session, const Arguments&) {
        session.out() << bash_completion(outline(root));
        return ExitCode::Done;
      });
}

}  // namespace tweend::cli
