#pragma once

#include <algorithm>
#include <memory>
#include <thread>
#include <vector>

#include "server/assets/asset_library.hpp"
#include "server/commands/event_hub.hpp"
#include "server/commands/services.hpp"
#include "server/store/memory_store.hpp"

namespace tweend::app {

/// Opens the assets folders. @return NotFound naming the one that can't be
[[nodiscard]] Result<std::vector<assets::AssetRoot>> open_roots(const std::vector<std::string>& folders);

/// Everything that runs but the network, from the bottom up; taken down the other way round.
class Engine {
 public:
  /// @param deliver  posts to the thread on which packets and events are handed over
  Engine(const Limits& limits, std::vector<assets::AssetRoot> roots, const render::RenderOptions& render, Metrics& metrics,
         const Post& deliver);
  ~Engine();  ///< stop()
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  [[nodiscard]] Status start();
  /// Answers who awaits a film that there will be none. Nobody is kept from asking: they are told the same.
  void end_films() { films_->stop(); }
  /// Commits what was accepted, makes files of what has been recorded, stops every thread. Nobody may ask for anything any
  /// more.
  void stop();

  [[nodiscard]] const commands::Services& services() const noexcept { return services_; }
  [[nodiscard]] const render::RenderThread& renderer() const noexcept { return renderer_; }

 private:
  static constexpr std::size_t kFilmThreads = 2;

  const Limits limits_;
  bool running_ = false;
  Metrics& metrics_;
  assets::AssetLibrary library_;
  store::MemoryStore store_;
  WorkerPool workers_{std::max(2U, std::thread::hardware_concurrency())};
  WorkerPool film_workers_{kFilmThreads};  ///< apart: films have time, streams and commands have none
  render::RenderThread renderer_;
  streams::StillQueue stills_;
  stage::Stage stage_;
  streams::Hub hub_;
  streams::Recorder recorder_;
  const std::shared_ptr<streams::FilmQueue> films_;
  commands::EventHub events_;
  commands::Services services_;
};

}  // namespace tweend::app
