#include <fmt/format.h>

#include <algorithm>

#include "server/commands/command_table.hpp"
#include "server/commands/conversation.hpp"

namespace tweend::commands {

enum class StreamKind : std::uint8_t { Vertices };
enum class StreamEncoding : std::uint8_t { F32 };
enum class StreamDelivery : std::uint8_t { Latest };

}  // namespace tweend::commands

namespace tweend::protocol {

template <>
struct EnumNames<commands::StreamKind> {
  static constexpr std::array<std::string_view, 1> kNames{"vertices"};
};
template <>
struct EnumNames<commands::StreamEncoding> {
  static constexpr std::array<std::string_view, 1> kNames{"f32"};
};
template <>
struct EnumNames<commands::StreamDelivery> {
  static constexpr std::array<std::string_view, 1> kNames{"latest"};
};

}  // namespace tweend::protocol

namespace tweend::commands {
namespace {

constexpr protocol::Range kRate{.min = 0.0, .max = 240.0, .min_excluded = true};
constexpr double kDefaultRate = 30.0;

struct OpenParams {
  static constexpr std::string_view kName = "StreamOpenParams";
  StreamKind kind = StreamKind::Vertices;
  std::optional<std::string> scene;
  std::optional<std::string> actor;
  std::optional<double> rate;
  std::optional<StreamDelivery> delivery;
  std::optional<StreamEncoding> encoding;
  static void describe(FieldList<OpenParams>& f) {
    using T = OpenParams;
    f.add<&T::kind>("kind", "What to send.");
    add_scene_field(f);
    add_actor_field(f);
    f.add<&T::rate>("rate", "Packets a second; 30 if left out.", kRate);
    f.add<&T::delivery>("delivery", "latest: a slow reader skips.");
    f.add<&T::encoding>("encoding", "How a packet is written.");
  }
};

struct BoundsState {
  static constexpr std::string_view kName = "Bounds";
  glm::vec3 min{};
  glm::vec3 max{};
  static void describe(FieldList<BoundsState>& f) {
    f.add<&BoundsState::min>("min", "Model space, metres.");
    f.add<&BoundsState::max>("max", "Model space, metres.");
  }
};

struct VerticesLayout {
  static constexpr std::string_view kName = "VerticesLayout";
  std::uint64_t vertices = 0;
  protocol::Base64Indices indices;
  std::optional<protocol::Base64Floats> uvs;
  BoundsState bounds;
  static void describe(FieldList<VerticesLayout>& f) {
    using T = VerticesLayout;
    f.add<&T::vertices>("vertices", "How many.");
    f.add<&T::indices>("indices_base64", "Little-endian uint32, three a triangle.");
    f.add<&T::uvs>("uvs_base64", "Little-endian float32, u and v of each vertex.");
    f.add<&T::bounds>("bounds", "Of the keyframes of the player's clip.");
  }
};

struct OpenResult {
  static constexpr std::string_view kName = "StreamOpened";
  std::uint64_t stream = 0;
  VerticesLayout layout;
  static void describe(FieldList<OpenResult>& f) {
    f.add<&OpenResult::stream>("stream", "Its number on this connection.");
    f.add<&OpenResult::layout>("layout", "What a packet's numbers mean.");
  }
};

struct UpdateParams {
  static constexpr std::string_view kName = "StreamUpdateParams";
  std::uint64_t stream = 0;
  std::optional<double> rate;
  static void describe(FieldList<UpdateParams>& f) {
    f.add<&UpdateParams::stream>("stream", "Its number.");
    f.add<&UpdateParams::rate>("rate", "Packets a second.", kRate);
  }
};

struct CloseParams {
  static constexpr std::string_view kName = "StreamCloseParams";
  std::uint64_t stream = 0;
  static void describe(FieldList<CloseParams>& f) { f.add<&CloseParams::stream>("stream", "Its number."); }
};

BoundsState bounds_of(const model::Actor& actor, const model::Clip& clip) {
  model::Bounds all = clip.keyframes.empty() ? actor.rest->bounds() : clip.keyframes.front().vertices->bounds();
  for (const model::Keyframe& k : clip.keyframes) {
    const model::Bounds& b = k.vertices->bounds();
    for (int i = 0; i < 3; ++i) {
      all.min[i] = std::min(all.min[i], b.min[i]);
      all.max[i] = std::max(all.max[i], b.max[i]);
    }
  }
  return {all.min, all.max};
}

/// For a worker: a large mesh's indices take a while to print.
std::string open_result(std::uint32_t stream, const model::Actor& actor, const model::Clip& clip) {
  const model::Mesh& mesh = *actor.mesh;
  OpenResult result{stream,
                    {mesh.vertex_count(), {{mesh.indices().begin(), mesh.indices().end()}}, {}, bounds_of(actor, clip)}};
  if (!mesh.texcoords().empty()) result.layout.uvs = protocol::Base64Floats{{mesh.texcoords().begin(), mesh.texcoords().end()}};
  return protocol::encode(result);
}

void subscribe_later(const std::shared_ptr<Conversation>& conversation, std::uint32_t stream) {
  const Services& services = conversation->services();
  const streams::StreamKey key = conversation->streams().at(stream);
  services.stage.post([&hub = services.hub, key, sink = std::weak_ptr<streams::PacketSink>(conversation->peer()), stream] {
    hub.subscribe(key, {sink, stream});
  });
}

void unsubscribe_later(const std::shared_ptr<Conversation>& conversation, const streams::StreamKey& key, std::uint32_t stream) {
  const Services& services = conversation->services();
  services.stage.post(
      [&hub = services.hub, key, peer = conversation->peer(), stream] { hub.unsubscribe(key, peer.get(), stream); });
}

void open_stream(const OpenParams& p, const std::shared_ptr<Conversation>& conversation, const ConnectionDone& done) {
  const Services& services = conversation->services();
  if (const std::size_t most = services.limits.streams_per_connection; conversation->streams().size() >= most) {
    return done(
        {fail(ErrorCode::Limit, fmt::format("expected at most {} streams a connection, found as many; close one first", most)),
         {}});
  }
  const std::string scene = scene_or_main(p.scene);
  const stage::SceneViewPtr view = services.stage.view()->find(scene);
  if (!view) return done({no_such_scene(scene), {}});
  const auto actor = find_actor(*view->scene, p.actor);
  if (!actor) return done({actor.error(), {}});
  const model::ClipPtr clip = *find_clip(**actor, std::nullopt, view);

  const std::uint32_t stream = conversation->next_stream();
  conversation->streams()[stream] = {scene, (*actor)->name, p.rate.value_or(kDefaultRate)};
  add(services.metrics.streams);
  services.workers.post([conversation, stream, actor = *actor, clip, done] {
    conversation->to_network()([conversation, stream, text = open_result(stream, *actor, *clip), done] {
      if (conversation->closed()) return;
      // The producer hears of the reader when the answer is on its way: the first packet then comes right after it.
      done({text, [conversation, stream] {
              if (conversation->streams().contains(stream)) subscribe_later(conversation, stream);
            }});
    });
  });
}

Error no_such_stream(std::uint64_t stream) {
  return fail(ErrorCode::NotFound, fmt::format("expected the number of an open stream of this connection, found {}", stream),
              "params.stream");
}

void update_stream(const UpdateParams& p, const std::shared_ptr<Conversation>& conversation, const ConnectionDone& done) {
  const auto stream = static_cast<std::uint32_t>(p.stream);
  const auto at = conversation->streams().find(stream);
  if (at == conversation->streams().end() || p.stream != stream) return done({no_such_stream(p.stream), {}});
  if (!p.rate || *p.rate == at->second.rate) return done({protocol::encode(EmptyResult{}), {}});
  unsubscribe_later(conversation, at->second, stream);
  at->second.rate = *p.rate;
  done({protocol::encode(EmptyResult{}), [conversation, stream] {
          if (conversation->streams().contains(stream)) subscribe_later(conversation, stream);
        }});
}

void close_stream(const CloseParams& p, const std::shared_ptr<Conversation>& conversation, const ConnectionDone& done) {
  const auto stream = static_cast<std::uint32_t>(p.stream);
  const auto at = conversation->streams().find(stream);
  if (at == conversation->streams().end() || p.stream != stream) return done({no_such_stream(p.stream), {}});
  unsubscribe_later(conversation, at->second, stream);
  conversation->streams().erase(at);
  conversation->peer()->forget_stream(stream);
  add(conversation->services().metrics.streams, -1);
  done({protocol::encode(EmptyResult{}), {}});
}

}  // namespace

void add_stream_commands(std::vector<Command>& t) {
  t.push_back(connection_command<OpenResult, OpenParams, &open_stream>("stream.open",
                                                                       "Be sent what an actor shows, packet by packet."));
  t.push_back(connection_command<EmptyResult, UpdateParams, &update_stream>("stream.update", "Change a stream's rate."));
  t.push_back(connection_command<EmptyResult, CloseParams, &close_stream>("stream.close", "End a stream."));
}

}  // namespace tweend::commands
