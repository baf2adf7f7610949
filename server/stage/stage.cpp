#include "server/stage/stage.hpp"

#include <boost/asio/post.hpp>
#include <future>
#include <utility>

namespace tweend::stage {

Stage::Stage(store::DocumentStore& store, const Limits& limits, Metrics& metrics)
    : limits_(limits), metrics_(metrics), store_(store) {}

Stage::~Stage() { stop(); }

Status Stage::start(StageListener& listener) {
  listener_ = &listener;
  TWEEND_ASSIGN(const std::vector<model::ScenePtr> scenes, store_.load());
  for (const model::ScenePtr& scene : scenes) {
    documents_[scene->name] = Document{{scene, {}, {}}, nullptr, {scene, {}, {}}, false};
  }
  if (!documents_.contains("main")) {
    model::Scene main;
    main.name = "main";
    const auto scene = std::make_shared<const model::Scene>(std::move(main));
    documents_["main"] = Document{{scene, {}, {}}, nullptr, {scene, {}, {}}, false};
  }
  publish_head_map();
  for (auto& [name, document] : documents_) {
    const auto players = players_for(*document.durable.scene, nullptr, steady_now_us(), {});
    publish(name, std::make_shared<const SceneView>(SceneView{document.durable.scene, players, next_serial_++}));
  }
  // The writer thread reports; the strand acts on it.
  queue_ = std::make_unique<store::CommitQueue>(store_, [this](store::CommitQueue::Group group) {
    boost::asio::post(io_, [this, group = std::move(group)] { committed(group); });
  });
  thread_ = std::thread([this] { io_.run(); });
  return {};
}

void Stage::stop() {
  if (!thread_.joinable()) return;
  // What has been posted is planned first, then committed, then answered: three queues drained in the order of their flow.
  std::promise<void> planned;
  boost::asio::post(io_, [&planned] { planned.set_value(); });
  planned.get_future().wait();
  queue_->stop();
  boost::asio::post(io_, [this] {
    timer_.cancel();
    work_.reset();
    io_.stop();
  });
  thread_.join();
}

model::ScenePtr Stage::head(std::string_view scene) const {
  const auto heads = heads_.load();
  const auto at = heads->find(scene);
  return at == heads->end() ? nullptr : at->second;
}

void Stage::post(Task task) { boost::asio::post(io_, std::move(task)); }

}  // namespace tweend::stage
