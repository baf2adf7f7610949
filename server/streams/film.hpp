#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "render/image_view.hpp"
#include "render/render_thread.hpp"
#include "server/base/worker_pool.hpp"
#include "server/model/camera.hpp"
#include "server/stage/show.hpp"
#include "server/streams/frame_composer.hpp"

namespace tweend::streams {

/// Pictures a second that a film has at least: far from where readings of the clock would overflow.
inline constexpr double kSlowestFilm = 0.001;

/// What the pictures of a film show, one after another. Asked on workers, never by two at once.
class FilmSource {
 public:
  virtual ~FilmSource() = default;
  enum class Next : std::uint8_t {
    Picture,  ///< it is in `out`
    Later,    ///< it is not known yet: FilmMaker::go_on() asks again
    End,      ///< there is no other
  };
  /// @param out  keeps its memory from picture to picture
  [[nodiscard]] virtual Next next(stage::Show& out) = 0;
};

/// Where the pictures of a film go. Called on workers, never by two at once; one that is let go of before it is finished leaves
/// nothing behind.
class PictureSink {
 public:
  virtual ~PictureSink() = default;
  [[nodiscard]] virtual Status add(const render::ImageView& image) = 0;
  /// Makes the file whole. @return its bytes
  [[nodiscard]] virtual Result<std::uint64_t> finish() = 0;
};

struct Film {
  std::size_t pictures = 0;
  std::uint64_t bytes = 0;
};
/// On a worker.
using FilmDone = std::function<void(Result<Film>)>;

/// Makes a film, every picture of it, however long that takes: the next one is drawn while one is encoded, behind those of
/// streams. Kept alive by what is under way; whoever may still say go_on() keeps it, too.
class FilmMaker final : public render::FrameJob, public std::enable_shared_from_this<FilmMaker> {
 public:
  struct Parts {
    std::shared_ptr<FilmSource> source;
    std::unique_ptr<PictureSink> sink;
    render::Size size;
    std::optional<model::CameraRequest> camera;  ///< empty: the scene's
  };
  /// @param done  once, with the error that ended it or what it came to; the sink is gone by then
  FilmMaker(Parts parts, WorkerPool& workers, render::RenderThread& renderer, FilmDone done);

  /// Begins; again once a source that said Later has more. Any thread.
  void go_on();
  /// Ends it with an error, once what is under way is over. Any thread.
  void give_up(const Error& error);
  /// How many pictures the sink has taken. Any thread.
  [[nodiscard]] std::size_t pictures() const;

  // render::FrameJob, on the render thread
  [[nodiscard]] const render::Picture& picture() const noexcept override { return picture_; }
  void drawn(Result<render::PixelsPtr> pixels) noexcept override;

 private:
  void compose();                               // worker
  void encode(render::PixelsPtr pixels);        // worker
  void encode_later(render::PixelsPtr pixels);  // with the lock
  void end(const Status& outcome = {});         // with the lock: there is no other picture
  [[nodiscard]] bool over() const noexcept { return ended_ && !drawing_ && !encoding_; }
  void finish();  // worker, once it is over

  const std::shared_ptr<FilmSource> source_;
  std::unique_ptr<PictureSink> sink_;
  const render::Size size_;
  const std::optional<model::CameraRequest> camera_;
  WorkerPool& workers_;
  render::RenderThread& renderer_;
  const FilmDone done_;

  // The picture that is composed and drawn; handed on from thread to thread.
  stage::Show show_;
  FrameComposer composer_;
  render::Picture picture_;

  mutable std::mutex mutex_;
  bool drawing_ = false;      ///< a picture is asked for, composed or drawn, or waits to be encoded
  bool encoding_ = false;     ///< one is being encoded
  bool asked_again_ = false;  ///< go_on() came meanwhile
  bool ended_ = false;
  render::PixelsPtr waiting_;  ///< drawn, while the one before is still being encoded
  Status outcome_;
  std::size_t pictures_ = 0;
};

}  // namespace tweend::streams
