#include <fmt/format.h>

#include <memory>
#include <utility>

#include "server/assets/asset_name.hpp"
#include "server/commands/command_table.hpp"
#include "server/commands/export_commands.hpp"
#include "server/commands/frame_types.hpp"
#include "server/commands/recording_file.hpp"
#include "server/commands/stream_types.hpp"

namespace tweend::commands {

enum class RecordFormat : std::uint8_t { Mp4, PngSequence };

}  // namespace tweend::commands

template <>
struct tweend::protocol::EnumNames<tweend::commands::RecordFormat> {
  static constexpr std::array<std::string_view, 2> kNames{"mp4", "png_sequence"};
};
template <>
struct tweend::protocol::EnumNames<tweend::streams::RecordingState> {
  static constexpr std::array<std::string_view, 4> kNames{"running", "ending", "done", "failed"};
};

namespace tweend::commands {
namespace {

constexpr const char* kNamePath = "params.name";
constexpr double kDefaultFps = 30.0;

struct RecordStartParams {
  static constexpr std::string_view kName = "RecordStartParams";
  std::optional<std::string> scene;
  std::string name;
  std::optional<std::uint64_t> width, height;
  std::optional<double> fps;
  std::optional<RecordFormat> format;
  std::optional<OwnCamera> camera;
  static void describe(FieldList<RecordStartParams>& f) {
    using T = RecordStartParams;
    add_scene_field(f);
    f.add<&T::name>("name", "Of the new file NAME.mp4 under the first assets folder, or of the pictures' folder.");
    f.add<&T::width>("width", "Pixels; 1280 if left out. Of mp4 even.", kPixels);
    f.add<&T::height>("height", "Pixels; 720 if left out. Of mp4 even.", kPixels);
    f.add<&T::fps>("fps", "Pictures a second; 30 if left out.", kFilmRate);
    f.add<&T::format>("format", "mp4 (if left out), or png_sequence: a folder of frame_000000.png, frame_000001.png, …");
    f.add<&T::camera>("camera", "Where to look from; the scene's camera if left out.");
  }
};

struct RecordStartResult {
  static constexpr std::string_view kName = "RecordStart";
  std::int64_t record = 0;
  std::int64_t start_us = 0;
  static void describe(FieldList<RecordStartResult>& f) {
    f.add<&RecordStartResult::record>("record", "The id that record.stop takes.");
    f.add<&RecordStartResult::start_us>("start_us", "The reading that the first picture shows.");
  }
};

struct RecordStopParams {
  static constexpr std::string_view kName = "RecordStopParams";
  std::int64_t record = 0;
  static void describe(FieldList<RecordStopParams>& f) {
    f.add<&RecordStopParams::record>("record", "The id that its start told.");
  }
};

struct RecordStopResult {
  static constexpr std::string_view kName = "RecordStop";
  std::string name;
  std::uint64_t frames = 0;
  std::uint64_t bytes = 0;
  static void describe(FieldList<RecordStopResult>& f) {
    using T = RecordStopResult;
    f.add<&T::name>("name", "Of the file, or of the pictures' folder.");
    f.add<&T::frames>("frames", "Pictures.");
    f.add<&T::bytes>("bytes", "Of the file, or of all pictures.");
  }
};

Error bad_name(const std::string& name, std::string_view expected) {
  return fail(ErrorCode::InvalidParams, fmt::format("expected {}, found {}", expected, assets::quoted_name(name)), kNamePath);
}

Status check_name(const std::string& name, RecordFormat format) {
  TWEEND_TRY(check_new_name(name));
  const auto ends = [&](std::string_view extension) { return assets::has_extension(name, extension); };
  if (format == RecordFormat::Mp4 && !name.ends_with(".mp4")) return bad_name(name, "a name that ends with .mp4");
  if (format == RecordFormat::PngSequence && (ends(".mp4") || ends(".png") || ends(".obj") || ends(".glb") || ends(".gltf"))) {
    return bad_name(name, "the name of a folder, without a file's ending");
  }
  return {};
}

struct RecordListParams {
  static constexpr std::string_view kName = "RecordListParams";
  static void describe(FieldList<RecordListParams>&) {}
};

struct RecordingInfo {
  static constexpr std::string_view kName = "Recording";
  std::int64_t recording = 0;
  std::string scene, name;
  double fps = 0.0;
  std::uint64_t frames = 0;
  std::int64_t start_us = 0;
  streams::RecordingState state = streams::RecordingState::Running;
  static void describe(FieldList<RecordingInfo>& f) {
    using T = RecordingInfo;
    f.add<&T::recording>("recording", "The id that record.stop takes.");
    f.add<&T::scene>("scene", "What it shows.");
    f.add<&T::name>("name", "Of the file, or of the pictures' folder.");
    f.add<&T::fps>("fps", "Pictures a second.");
    f.add<&T::frames>("frames", "Pictures made by now; 0 of one that has failed.");
    f.add<&T::start_us>("start_us", "The reading that the first picture shows.");
    f.add<&T::state>("state",
                     "running, ending (its last pictures are made), or, until record.stop is told of it, done or failed.");
  }
};

struct RecordListResult {
  static constexpr std::string_view kName = "RecordList";
  std::vector<RecordingInfo> recordings;
  static void describe(FieldList<RecordListResult>& f) {
    f.add<&RecordListResult::recordings>("recordings", "In the order they began.");
  }
};

/// All but where it goes.
Result<streams::RecordingRequest> recording_request(const RecordStartParams& p, const QueryContext& context) {
  const RecordFormat format = p.format.value_or(RecordFormat::Mp4);
  TWEEND_TRY(check_name(p.name, format));
  streams::RecordingRequest request;
  request.scene = scene_or_main(p.scene);
  request.name = p.name;
  request.fps = p.fps.value_or(kDefaultFps);
  const stage::SceneViewPtr view = context.view->find(request.scene);
  if (!view) return no_such_scene(request.scene);
  TWEEND_ASSIGN(request.size, frame_size(p.width, p.height, context.services));
  if (format == RecordFormat::Mp4) TWEEND_TRY(check_even(request.size));
  if (p.camera) {
    TWEEND_TRY(check_own_camera(*p.camera, *view->scene));
    request.camera = p.camera->request();
  }
  return request;
}

/// On a worker: makes a file and an encoder.
Result<std::unique_ptr<streams::PictureSink>> open_sink(RecordFormat format, const streams::RecordingRequest& request,
                                                        const assets::AssetLibrary& library) {
  TWEEND_ASSIGN(const assets::AssetRoot* const folder, library.first_folder());
  auto sink = format == RecordFormat::Mp4 ? record_mp4(*folder, request.name, request.size, request.fps)
                                          : record_pngs(*folder, request.name);
  if (sink) return sink;
  Error error = sink.error();
  // An error of a name or a place: it is `name` that is to be changed.
  if (error.path.empty() && error.code != ErrorCode::Unavailable) error.path = kNamePath;
  return error;
}

void start(const RecordStartParams& p, const QueryContext& context, const AsyncDone<RecordStartResult>& done) {
  Result<streams::RecordingRequest> checked = recording_request(p, context);
  if (!checked) return done(checked.error());
  const RecordFormat format = p.format.value_or(RecordFormat::Mp4);
  // The place first: no more sinks are made than may be.
  context.services.stage.post([request = std::move(*checked), format, services = context.services, done] {
    const auto id = services.recorder.reserve(request);
    if (!id) return done(id.error());
    services.workers.post([request, format, services, done, id = *id] {
      // Shared, since what is posted has to be copyable and a sink is not.
      const auto sink =
          std::make_shared<Result<std::unique_ptr<streams::PictureSink>>>(open_sink(format, request, services.assets));
      services.stage.post([sink, &recorder = services.recorder, done, id] {
        if (!*sink) {
          recorder.release(id);
          return done(sink->error());
        }
        const auto started = recorder.start(id, std::move(**sink));
        if (!started) return done(started.error());
        done(RecordStartResult{started->id, started->start_us});
      });
    });
  });
}

void stop(const RecordStopParams& p, const QueryContext& context, const AsyncDone<RecordStopResult>& done) {
  context.services.stage.post([id = p.record, &recorder = context.services.recorder, done] {
    recorder.stop(id, [done](const Result<streams::Recorded>& recorded) {
      if (!recorded) return done(recorded.error());
      done(RecordStopResult{recorded->name, recorded->pictures, recorded->bytes});
    });
  });
}

void list(const RecordListParams&, const QueryContext& context, const AsyncDone<RecordListResult>& done) {
  context.services.stage.post([&recorder = context.services.recorder, done] {
    RecordListResult result;
    for (const streams::RecordingNow& r : recorder.list()) {
      result.recordings.push_back({r.id, r.scene, r.name, r.fps, r.pictures, r.start_us, r.state});
    }
    done(std::move(result));
  });
}

}  // namespace

void add_record_commands(std::vector<Command>& t) {
  t.push_back(async_query_command<RecordStartResult, RecordStartParams, &start>("record.start", Role::Admin,
                                                                                "Record what a scene shows, to a file."));
  t.push_back(async_query_command<RecordStopResult, RecordStopParams, &stop>(
      "record.stop", Role::Admin, "End a recording; answers once its file is whole."));
  t.push_back(async_query_command<RecordListResult, RecordListParams, &list>(
      "record.list", Role::Admin, "The recordings that run or are ending, and those whose end nobody was told of."));
}

}  // namespace tweend::commands
