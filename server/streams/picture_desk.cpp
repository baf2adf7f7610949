#include "server/streams/picture_desk.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

#include "server/streams/scene_look.hpp"

namespace tweend::streams {

/// One picture on its way, for all that have ordered it. Filled on the strand, handed on from thread to thread, never at two at
/// once; free when it has no moment.
class SharedDrawing final : public render::FrameJob, public std::enable_shared_from_this<SharedDrawing> {
 public:
  explicit SharedDrawing(PictureDesk& desk) : desk_(desk) {}

  /// On a worker, once the moment is composed.
  void submit() {
    picture_.light = moment->picture.light;
    picture_.background = moment->picture.background;
    picture_.grid = moment->picture.grid;
    picture_.items = moment->picture.items;
    picture_.bones = moment->picture.bones;
    picture_.bones_over = moment->picture.bones_over;
    look_.look(moment->show.scene, camera, size, picture_);
    desk_.renderer_.submit(shared_from_this(), deadline_us);
  }

  [[nodiscard]] const render::Picture& picture() const noexcept override { return picture_; }

  void drawn(Result<render::PixelsPtr> done) noexcept override {
    pixels = std::move(done);
    boost::asio::post(desk_.strand_, [this] { desk_.finished(*this); });
  }

  MomentPtr moment;
  std::optional<model::CameraRequest> camera;
  render::Size size;
  ClockUs deadline_us = 0;
  bool submitted = false;  ///< or about to be; else it waits for its moment to be composed
  std::vector<std::shared_ptr<PictureUser>> users;
  Result<render::PixelsPtr> pixels{render::PixelsPtr()};

 private:
  PictureDesk& desk_;
  SceneLook look_;
  render::Picture picture_;
};

PictureDesk::PictureDesk(boost::asio::io_context& strand, WorkerPool& workers, render::RenderThread& renderer)
    : strand_(strand), workers_(workers), renderer_(renderer) {}

PictureDesk::~PictureDesk() = default;

MomentPtr PictureDesk::moment(const stage::SceneViewPtr& view, ClockUs at_us) {
  // Only the strand takes and lets go of moments, so that their counts are true.
  MomentPtr* free = nullptr;
  for (MomentPtr& moment : moments_) {
    if (moment.use_count() > 1) {
      if (moment->view == view && moment->at_us == at_us) return moment;
    } else if (free == nullptr || moment->show.scene == view->scene) {
      free = &moment;  // best one that has evaluated this scene before
    }
  }
  if (free == nullptr) free = &moments_.emplace_back(std::make_shared<SceneMoment>());
  SceneMoment& moment = **free;
  moment.view = view;
  moment.at_us = at_us;
  moment.state = SceneMoment::State::Read;
  stage::show_at(*view, at_us, moment.show);
  return *free;
}

void PictureDesk::draw(const MomentPtr& moment, const std::optional<model::CameraRequest>& camera, render::Size size,
                       ClockUs deadline_us, std::shared_ptr<PictureUser> user) {
  SharedDrawing* free = nullptr;
  for (const auto& drawing : drawings_) {
    if (!drawing->moment) {
      free = drawing.get();
    } else if (drawing->moment == moment && drawing->size == size && drawing->camera == camera) {
      drawing->users.push_back(std::move(user));
      return;
    }
  }
  if (free == nullptr) free = drawings_.emplace_back(std::make_shared<SharedDrawing>(*this)).get();
  free->moment = moment;
  free->camera = camera;
  free->size = size;
  free->deadline_us = deadline_us;
  free->users.push_back(std::move(user));
  free->submitted = moment->state != SceneMoment::State::Composing;  // else composed() does
  if (moment->state == SceneMoment::State::Composed) {
    workers_.post([free] { free->submit(); });
  } else if (moment->state == SceneMoment::State::Read) {
    moment->state = SceneMoment::State::Composing;
    workers_.post([this, free] { compose_and_submit(*free); });
  }
}

void PictureDesk::compose_and_submit(SharedDrawing& drawing) {
  SceneMoment& moment = *drawing.moment;
  moment.composer.compose(moment.show, moment.picture);
  // Before the picture can be done, and the moment be another one.
  boost::asio::post(strand_, [this, &drawing] { composed(drawing.moment); });
  drawing.submit();
}

void PictureDesk::composed(const MomentPtr& moment) {
  moment->state = SceneMoment::State::Composed;
  std::vector<std::shared_ptr<SharedDrawing>> not_made;  // users may order others, or have drawings trimmed, as they are told
  for (const auto& drawing : drawings_) {
    if (drawing->moment != moment || std::exchange(drawing->submitted, true)) continue;
    if (stopping_) {
      not_made.push_back(drawing);
    } else {
      workers_.post([&drawing = *drawing] { drawing.submit(); });
    }
  }
  for (const auto& drawing : not_made) {
    drawing->pixels = fail(ErrorCode::Unavailable, "the server stops");
    finished(*drawing);
  }
}

void PictureDesk::finished(SharedDrawing& drawing) {
  const Result<render::PixelsPtr> pixels = std::exchange(drawing.pixels, render::PixelsPtr());
  drawing.moment.reset();
  told_.swap(drawing.users);  // whoever is told may order the next one, and be given this drawing for it
  for (const auto& user : told_) user->drawn(pixels);
  told_.clear();
}

void PictureDesk::trim() {
  std::erase_if(moments_, [](const MomentPtr& moment) { return moment.use_count() == 1; });
  std::erase_if(drawings_, [](const auto& drawing) { return !drawing->moment; });
}

}  // namespace tweend::streams
