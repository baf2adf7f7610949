#include "server/app/engine.hpp"

#include <future>
#include <utility>

namespace tweend::app {
namespace {

/// Encoding a large picture takes a worker for a second: the others stay for streams and commands.
constexpr std::size_t kStillsAtOnce = 1;

}  // namespace

Result<std::vector<assets::AssetRoot>> open_roots(const std::vector<std::string>& folders) {
  std::vector<assets::AssetRoot> roots;
  for (const std::string& folder : folders) {
    TWEEND_ASSIGN(assets::AssetRoot root, assets::AssetRoot::open(folder));
    roots.push_back(std::move(root));
  }
  return roots;
}

Engine::Engine(const Limits& limits, std::vector<assets::AssetRoot> roots, const render::RenderOptions& render,
               Metrics& metrics, const Post& deliver)
    : limits_(limits),
      metrics_(metrics),
      library_(std::move(roots), limits_),
      renderer_(render),
      stills_(workers_, renderer_, kStillsAtOnce),
      stage_(store_, limits_, metrics_),
      hub_(stage_, workers_, renderer_, deliver, metrics_),
      recorder_(stage_, film_workers_, renderer_, limits_, metrics_),
      films_(std::make_shared<streams::FilmQueue>(film_workers_, renderer_, limits_)),
      events_(hub_, recorder_, deliver, metrics_),
      services_{limits_, metrics_, library_, stage_, hub_, events_, workers_, renderer_, stills_, recorder_, *films_} {}

Engine::~Engine() { stop(); }

Status Engine::start() {
  TWEEND_TRY(stage_.start(events_));
  running_ = true;
  return {};
}

void Engine::stop() {
  if (!std::exchange(running_, false)) return;
  films_->stop();
  recorder_.finish_all();
  std::promise<void> quiet;
  stage_.post([&] {
    hub_.stop();
    quiet.set_value();
  });
  quiet.get_future().wait();
  renderer_.stop();  // before the workers, which still encode what it has drawn
  film_workers_.stop();
  workers_.stop();  // before the stage, on which evaluations under way still end
  stage_.stop();
}

}  // namespace tweend::app
