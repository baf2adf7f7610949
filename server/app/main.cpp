#include <csignal>
#include <variant>

#include "server/app/doctor.hpp"
#include "server/app/inspect.hpp"
#include "server/app/options.hpp"
#include "server/app/serve.hpp"

namespace {

using namespace tweend::app;

struct Run {
  int operator()(int exit_code) const { return exit_code; }
  int operator()(const ServeOptions& options) const { return serve(options); }
  int operator()(const OfflineOptions& options) const { return render_offline(options); }
  int operator()(const InspectOptions& options) const { return inspect(options); }
  int operator()(const DoctorOptions&) const { return doctor(); }
};

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that gets too long tells by its error
  return std::visit(Run(), parse_command_line(argc, argv));
}
