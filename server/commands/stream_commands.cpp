#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "render/h264_encoder.hpp"
#include "render/h264_level.hpp"
#include "server/commands/command_table.hpp"
#include "server/commands/conversation.hpp"
#include "server/commands/stream_types.hpp"
#include "server/model/actor_bounds.hpp"

namespace tweend::commands {
namespace {

constexpr double kDefaultRate = 30.0;
constexpr double kDefaultPoseRate = 60.0;

struct BoundsState {
  static constexpr std::string_view kName = "Bounds";
  glm::vec3 min{};
  glm::vec3 max{};
  static void describe(FieldList<BoundsState>& f) {
    f.add<&BoundsState::min>("min", "Model space, metres.");
    f.add<&BoundsState::max>("max", "Model space, metres.");
  }
};

/// What a packet's bytes mean: the first three of a pose, the next four of vertices, the others of frames.
struct StreamLayout {
  static constexpr std::string_view kName = "StreamLayout";
  std::optional<std::vector<JointState>> joints;
  std::optional<std::vector<std::string>> weights;
  std::optional<std::uint64_t> stride;
  std::optional<std::uint64_t> vertices;
  std::optional<protocol::Base64Indices> indices;
  std::optional<protocol::Base64Floats> uvs;
  std::optional<BoundsState> bounds;
  std::optional<std::uint64_t> width, height;
  std::optional<std::string> codec;
  static void describe(FieldList<StreamLayout>& f) {
    using T = StreamLayout;
    f.add<&T::joints>("joints", "In the order of the payload.");
    f.add<&T::weights>("weights", "Names of the morph targets, in the order of the payload.");
    f.add<&T::stride>("stride", "Bytes from one joint to the next, as f32.");
    f.add<&T::vertices>("vertices", "How many.");
    f.add<&T::indices>("indices_base64", "Little-endian uint32, three a triangle.");
    f.add<&T::uvs>("uvs_base64", "Little-endian float32, u and v of each vertex.");
    f.add<&T::bounds>("bounds", "Of what the player's clip shows.");
    f.add<&T::width>("width", "Pixels.");
    f.add<&T::height>("height", "Pixels.");
    f.add<&T::codec>("codec", "jpeg, png or rgba; of h264 what WebCodecs calls it.");
  }
};

struct OpenResult {
  static constexpr std::string_view kName = "StreamOpened";
  std::uint64_t stream = 0;
  StreamLayout layout;
  static void describe(FieldList<OpenResult>& f) {
    f.add<&OpenResult::stream>("stream", "Its number on this connection.");
    f.add<&OpenResult::layout>("layout", "What a packet's bytes mean.");
  }
};

struct UpdateParams {
  static constexpr std::string_view kName = "StreamUpdateParams";
  std::uint64_t stream = 0;
  std::optional<double> rate;
  Nullable<OwnCamera> camera;
  static void describe(FieldList<UpdateParams>& f) {
    f.add<&UpdateParams::stream>("stream", "Its number.");
    f.add<&UpdateParams::rate>("rate", "Packets a second.", kRate);
    f.add<&UpdateParams::camera>("camera",
                                 "Of frames: where to look from, in place of what was said before; null: the scene's.");
  }
};

/// Of what needs no more than the stream.
struct StreamParams {
  static constexpr std::string_view kName = "StreamParams";
  std::uint64_t stream = 0;
  static void describe(FieldList<StreamParams>& f) { f.add<&StreamParams::stream>("stream", "Its number."); }
};

StreamLayout vertices_layout(const model::Actor& actor, const model::ClipPtr& clip) {
  const model::Mesh& mesh = *actor.model->mesh;
  StreamLayout layout;
  layout.vertices = mesh.vertex_count();
  layout.indices = protocol::Base64Indices{{mesh.indices().begin(), mesh.indices().end()}};
  if (!mesh.texcoords().empty()) layout.uvs = protocol::Base64Floats{{mesh.texcoords().begin(), mesh.texcoords().end()}};
  const model::Bounds bounds = model::clip_bounds(actor, clip);
  layout.bounds = BoundsState{bounds.min, bounds.max};
  return layout;
}

StreamLayout pose_layout(const model::Model& model) {
  StreamLayout layout;
  layout.joints = joint_states(model);
  layout.weights = weight_names(model);
  layout.stride = protocol::kFloatsPerJoint * sizeof(float);
  return layout;
}

StreamLayout frames_layout(const streams::FramesSpec& spec, double rate) {
  constexpr std::array<const char*, 4> kCodecs{"jpeg", "png", "h264", "rgba"};
  StreamLayout layout;
  layout.width = spec.size.width;
  layout.height = spec.size.height;
  layout.codec = spec.encoding == streams::FrameEncoding::H264 ? render::H264Encoder::codec(spec.size, rate)
                                                               : kCodecs[static_cast<std::size_t>(spec.encoding)];
  return layout;
}

/// For a worker: a large mesh's indices take a while to print.
std::string open_result(std::uint32_t stream, const streams::StreamKey& key, const stage::SceneView& view) {
  if (const auto* frames = std::get_if<streams::FramesSpec>(&key.what)) {
    return protocol::encode(OpenResult{stream, frames_layout(*frames, key.rate)});
  }
  if (const auto* pose = std::get_if<streams::PoseSpec>(&key.what)) {
    return protocol::encode(OpenResult{stream, pose_layout(*view.scene->find_actor(pose->actor)->model)});
  }
  const model::ActorPtr actor = view.scene->find_actor(std::get<streams::VerticesSpec>(key.what).actor);
  return protocol::encode(OpenResult{stream, vertices_layout(*actor, stage::clip_of(*actor, *view.find_player(actor->name)))});
}

void subscribe_later(const std::shared_ptr<Conversation>& conversation, std::uint32_t stream) {
  const Services& services = conversation->services();
  Conversation::OpenStream& open = conversation->streams().at(stream);
  open.subscribed = true;
  const streams::StreamKey key = open.key;
  services.stage.post([&hub = services.hub, key, sink = std::weak_ptr<streams::PacketSink>(conversation->peer()), stream] {
    hub.subscribe(key, {sink, stream});
  });
}

Error no_such_stream(std::uint64_t stream) {
  return fail(ErrorCode::NotFound, fmt::format("expected the number of an open stream of this connection, found {}", stream),
              "params.stream");
}

/// @param path  what would have to be asked for otherwise
Status check_bit_rate(const streams::FramesSpec& frames, double rate, const char* path) {
  const std::int64_t least = render::h264_least(frames.size, rate).bit_rate;
  if (frames.bit_rate == 0 || frames.bit_rate >= least) return {};
  return fail(
      ErrorCode::InvalidParams,
      fmt::format("expected a bitrate of at least {} for {} x {} pixels {} times a second, found {}; ask for smaller or "
                  "fewer pictures, or for more bits",
                  least, frames.size.width, frames.size.height, rate, frames.bit_rate),
      path);
}

/// What the stream's key becomes.
Result<streams::StreamKey> updated_key(const UpdateParams& p, streams::StreamKey key, const Services& services) {
  key.rate = p.rate.value_or(key.rate);
  if (const auto* frames = std::get_if<streams::FramesSpec>(&key.what))
    TWEEND_TRY(check_bit_rate(*frames, key.rate, "params.rate"));
  if (!p.camera) return key;
  auto* frames = std::get_if<streams::FramesSpec>(&key.what);
  if (frames == nullptr) {
    return fail(ErrorCode::InvalidParams, "expected camera with a stream of frames, found it with another", "params.camera");
  }
  frames->camera.reset();
  if (!*p.camera) return key;
  const stage::SceneViewPtr view = services.stage.view()->find(key.scene);
  if (!view) return no_such_scene(key.scene);
  TWEEND_TRY(check_own_camera(**p.camera, *view->scene));
  frames->camera = (*p.camera)->request();
  return key;
}

void update_stream(const UpdateParams& p, const std::shared_ptr<Conversation>& conversation, const ConnectionDone& done) {
  const auto stream = static_cast<std::uint32_t>(p.stream);
  const auto at = conversation->streams().find(stream);
  if (at == conversation->streams().end() || p.stream != stream) return done({no_such_stream(p.stream), {}});
  const Services& services = conversation->services();
  Conversation::OpenStream& open = at->second;
  const Result<streams::StreamKey> key = updated_key(p, open.key, services);
  if (!key) return done({key.error(), {}});
  if (*key != open.key && open.subscribed) {
    const std::weak_ptr<streams::PacketSink> sink(conversation->peer());
    services.stage.post([&hub = services.hub, from = open.key, to = *key, sink, stream] {
      hub.retune(from, to, {sink, stream});
    });
  }
  open.key = *key;
  done({protocol::encode(EmptyResult{}), {}});
}

void request_key(const StreamParams& p, const std::shared_ptr<Conversation>& conversation, const ConnectionDone& done) {
  const auto stream = static_cast<std::uint32_t>(p.stream);
  const auto at = conversation->streams().find(stream);
  if (at == conversation->streams().end() || p.stream != stream) return done({no_such_stream(p.stream), {}});
  const Services& services = conversation->services();
  services.stage.post([&hub = services.hub, key = at->second.key] { hub.request_key(key); });
  done({protocol::encode(EmptyResult{}), {}});
}

void close_stream(const StreamParams& p, const std::shared_ptr<Conversation>& conversation, const ConnectionDone& done) {
  const auto stream = static_cast<std::uint32_t>(p.stream);
  const auto at = conversation->streams().find(stream);
  if (at == conversation->streams().end() || p.stream != stream) return done({no_such_stream(p.stream), {}});
  conversation->unsubscribe_later(stream, at->second.key);
  conversation->streams().erase(at);
  conversation->peer()->forget_stream(stream);
  add(conversation->services().metrics.streams, -1);
  done({protocol::encode(EmptyResult{}), {}});
}

/// Each stream's latest picture stays in memory.
Status check_pixels(const streams::StreamKey& key, Conversation& conversation) {
  const auto pixels = [](const streams::StreamKey& k) {
    const auto* frames = std::get_if<streams::FramesSpec>(&k.what);
    return frames == nullptr ? std::size_t{0} : std::size_t{frames->size.width} * frames->size.height;
  };
  std::size_t sum = pixels(key);
  for (const auto& [stream, open] : conversation.streams()) sum += pixels(open.key);
  const std::size_t most = conversation.services().limits.stream_pixels;
  if (sum <= most || pixels(key) == 0) return {};
  return fail(ErrorCode::Limit,
              fmt::format("expected streams of frames of at most {} pixels together on a connection, found {}; "
                          "close one, or ask for smaller ones",
                          most, sum));
}

Status only_of_frames(bool given, std::string_view name) {
  if (!given) return {};
  return fail(ErrorCode::InvalidParams, fmt::format("expected {} with a stream of frames, found it with another", name),
              std::string(name));
}

/// An encoding's name, and what has it.
struct EncodingOf {
  StreamKind kind;
  StreamEncoding encoding;
};

bool fits(StreamKind kind, StreamEncoding encoding) noexcept {
  constexpr std::array<EncodingOf, 9> kFitting{{{StreamKind::Pose, StreamEncoding::F32},
                                                {StreamKind::Pose, StreamEncoding::Q16},
                                                {StreamKind::Vertices, StreamEncoding::F32},
                                                {StreamKind::Vertices, StreamEncoding::Q16},
                                                {StreamKind::Vertices, StreamEncoding::Meshopt},
                                                {StreamKind::Frames, StreamEncoding::Jpeg},
                                                {StreamKind::Frames, StreamEncoding::Png},
                                                {StreamKind::Frames, StreamEncoding::H264},
                                                {StreamKind::Frames, StreamEncoding::Rgba}}};
  return std::any_of(kFitting.begin(), kFitting.end(),
                     [&](const EncodingOf& e) { return e.kind == kind && e.encoding == encoding; });
}

streams::VerticesEncoding vertices_encoding(StreamEncoding encoding) noexcept {
  return encoding == StreamEncoding::Q16       ? streams::VerticesEncoding::Q16
         : encoding == StreamEncoding::Meshopt ? streams::VerticesEncoding::Meshopt
                                               : streams::VerticesEncoding::F32;
}

streams::FrameEncoding frame_encoding(StreamEncoding encoding) noexcept {
  return encoding == StreamEncoding::Png    ? streams::FrameEncoding::Png
         : encoding == StreamEncoding::H264 ? streams::FrameEncoding::H264
         : encoding == StreamEncoding::Rgba ? streams::FrameEncoding::Rgba
                                            : streams::FrameEncoding::Jpeg;
}

/// Half a pixel of colour can't be written.
Status check_h264(render::Size size) {
  if (!render::has_h264()) {
    return fail(ErrorCode::Unavailable,
                "expected a server that was built with H.264, found one without (CMake option TWEEND_H264); ask for jpeg");
  }
  const auto even = [](std::uint32_t side, const char* name) -> Status {
    if (side % 2 == 0) return {};
    return fail(ErrorCode::InvalidParams, fmt::format("expected an even number of pixels with h264, found {}", side),
                std::string("params.") + name);
  };
  TWEEND_TRY(even(size.width, "width"));
  return even(size.height, "height");
}

}  // namespace

Status StreamOpenParams::check() const {
  if (encoding && !fits(kind, *encoding)) {
    constexpr std::array<const char*, 3> kExpected{"f32 or q16 with a stream of a pose",
                                                   "f32, q16 or meshopt with a stream of vertices",
                                                   "jpeg, png, h264 or rgba with a stream of frames"};
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected {}, found {}", kExpected[static_cast<std::size_t>(kind)],
                            protocol::EnumNames<StreamEncoding>::kNames[static_cast<std::size_t>(*encoding)]),
                "encoding");
  }
  if (bitrate && encoding != StreamEncoding::H264) {
    return fail(ErrorCode::InvalidParams, "expected bitrate with h264 frames, found it with another encoding", "bitrate");
  }
  if (adaptive.value_or(false) && (encoding.value_or(StreamEncoding::Jpeg) != StreamEncoding::Jpeg ||
                                   delivery.value_or(StreamDelivery::Latest) != StreamDelivery::Latest)) {
    return fail(ErrorCode::InvalidParams, "expected adaptive with jpeg frames delivered as latest, found it with others",
                "adaptive");
  }
  if (kind == StreamKind::Frames) return {};
  TWEEND_TRY(only_of_frames(width.has_value(), "width"));
  TWEEND_TRY(only_of_frames(height.has_value(), "height"));
  TWEEND_TRY(only_of_frames(quality.has_value(), "quality"));
  TWEEND_TRY(only_of_frames(adaptive.value_or(false), "adaptive"));
  return only_of_frames(camera.has_value(), "camera");
}

StreamPolicy StreamOpenParams::policy() const noexcept {
  const bool every = delivery.value_or(StreamDelivery::Latest) == StreamDelivery::Every;
  const bool jpeg = kind == StreamKind::Frames && encoding.value_or(StreamEncoding::Jpeg) == StreamEncoding::Jpeg;
  return {.every = every, .adaptive = jpeg && !every && adaptive.value_or(true)};
}

Result<streams::StreamKey> stream_key(const StreamOpenParams& p, const stage::StageView& view, const Services& services) {
  const double usual_rate = p.kind == StreamKind::Pose ? kDefaultPoseRate : kDefaultRate;
  streams::StreamKey key{scene_or_main(p.scene), p.rate.value_or(usual_rate), {}};
  const stage::SceneViewPtr scene = view.find(key.scene);
  if (!scene) return no_such_scene(key.scene);
  if (p.kind == StreamKind::Vertices) {
    TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(*scene->scene, p.actor));
    if (!actor->model->mesh) return no_mesh(*actor);
    key.what = streams::VerticesSpec{actor->name, vertices_encoding(p.encoding.value_or(StreamEncoding::F32))};
    return key;
  }
  if (p.kind == StreamKind::Pose) {
    TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(*scene->scene, p.actor));
    if (!actor->model->skeleton) return no_skeleton(*actor);
    key.what = streams::PoseSpec{actor->name,
                                 p.encoding == StreamEncoding::Q16 ? streams::PoseEncoding::Q16 : streams::PoseEncoding::F32};
    return key;
  }
  streams::FramesSpec frames;
  if (p.actor) {
    TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(*scene->scene, p.actor));
    frames.actor = actor->name;
  }
  TWEEND_ASSIGN(frames.size, frame_size(p.width, p.height, services));
  frames.encoding = frame_encoding(p.encoding.value_or(StreamEncoding::Jpeg));
  // Only of a JPEG is there a quality to tell producers apart by.
  if (frames.encoding == streams::FrameEncoding::Jpeg) frames.quality = static_cast<int>(p.quality.value_or(kDefaultQuality));
  if (frames.encoding == streams::FrameEncoding::H264) TWEEND_TRY(check_h264(frames.size));
  frames.bit_rate = p.bitrate.value_or(0);
  TWEEND_TRY(check_bit_rate(frames, key.rate, "params.bitrate"));
  if (p.camera) {
    TWEEND_TRY(check_own_camera(*p.camera, *scene->scene));
    frames.camera = p.camera->request();
  }
  key.what = std::move(frames);
  return key;
}

void open_stream(const StreamOpenParams& p, const std::shared_ptr<Conversation>& conversation, const ConnectionDone& done) {
  const Services& services = conversation->services();
  if (const std::size_t most = services.limits.streams_per_connection; conversation->streams().size() >= most) {
    return done(
        {fail(ErrorCode::Limit, fmt::format("expected at most {} streams a connection, found as many; close one first", most)),
         {}});
  }
  const stage::StageViewPtr view = services.stage.view();
  const Result<streams::StreamKey> key = stream_key(p, *view, services);
  if (!key) return done({key.error(), {}});
  if (const Status fits = check_pixels(*key, *conversation); !fits) return done({fits.error(), {}});
  const std::uint32_t stream = conversation->next_stream();
  conversation->streams()[stream] = {*key, false};
  conversation->peer()->expect_stream(stream, p.policy());
  add(services.metrics.streams);
  services.workers.post([conversation, stream, key = *key, view = view->find(key->scene), done] {
    conversation->to_network()([conversation, stream, text = open_result(stream, key, *view), done] {
      if (conversation->closed()) return;
      // The producer hears of the reader when the answer is on its way: the first packet then comes right after it.
      done({text, [conversation, stream] {
              if (conversation->streams().contains(stream)) subscribe_later(conversation, stream);
            }});
    });
  });
}

void add_stream_commands(std::vector<Command>& t) {
  t.push_back(connection_command<OpenResult, StreamOpenParams, &open_stream>("stream.open",
                                                                             "Be sent what is shown, packet by packet."));
  t.push_back(
      connection_command<EmptyResult, UpdateParams, &update_stream>("stream.update", "Change a stream's rate or camera."));
  t.push_back(connection_command<EmptyResult, StreamParams, &request_key>("stream.request_key",
                                                                          "Be sent a packet soon that decodes on its own."));
  t.push_back(connection_command<EmptyResult, StreamParams, &close_stream>("stream.close", "End a stream."));
}

}  // namespace tweend::commands
