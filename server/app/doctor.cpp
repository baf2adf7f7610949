#include "server/app/doctor.hpp"

#include <fmt/format.h>

#include <iostream>

#include "render/render_thread.hpp"
#include "server/app/page.hpp"

namespace tweend::app {

int doctor() {
  const render::RenderThread renderer;
  std::cout << "tweend " TWEEND_VERSION "\n\nPictures\n";
  for (const render::DeviceAttempt& attempt : renderer.attempts()) {
    std::cout << fmt::format("  {:<9}  {}: {}\n", attempt.taken ? "taken" : "not taken", attempt.name, attempt.outcome);
  }
  if (!renderer.attempts().empty() && renderer.attempts().back().taken) {
    std::cout << "  not tried  whatever comes after the one that was taken\n";
  }
  const bool draws = renderer.device().has_value();
  std::cout << (draws ? fmt::format("  drawing with {}\n", *renderer.device()) : "  nothing draws: frames will be refused\n");
  const auto page = load_page({});
  std::cout << "\nPage\n  "
            << (page ? page->find("/") == nullptr ? "not found beside this program: / answers in plain text" : "found"
                     : page.error().message)
            << '\n';
  return draws ? 0 : 1;
}

}  // namespace tweend::app
