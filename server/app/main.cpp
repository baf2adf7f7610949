#include "server/app/options.hpp"
#include "server/app/serve.hpp"

int main(int argc, char** argv) {
  const tweend::app::CommandLine line = tweend::app::parse_command_line(argc, argv);
  return line.serve ? tweend::app::serve(line.options) : line.exit_code;
}
