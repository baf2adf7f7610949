#include "server/commands/command_table.hpp"
#include "server/commands/conversation.hpp"

namespace tweend::commands {
namespace {

struct EventsParams {
  static constexpr std::string_view kName = "EventsParams";
  std::optional<std::string> scene;
  static void describe(FieldList<EventsParams>& f) { add_scene_field(f); }
};

void tell_of_audience(const Services& services) {
  if (const auto heard = services.events.audience_change()) services.stage.set_audience(*heard);
}

void subscribe(const EventsParams& p, const std::shared_ptr<Conversation>& conversation, const ConnectionDone& done) {
  const std::string scene = scene_or_main(p.scene);
  const Services& services = conversation->services();
  if (!services.stage.view()->find(scene)) return done({no_such_scene(scene), {}});
  services.events.subscribe(scene, conversation->peer());
  tell_of_audience(services);
  done({protocol::encode(EmptyResult{}), {}});
}

void unsubscribe(const EventsParams& p, const std::shared_ptr<Conversation>& conversation, const ConnectionDone& done) {
  // A scene that is gone took its subscriptions along: nothing to refuse.
  conversation->services().events.unsubscribe(scene_or_main(p.scene), conversation->peer().get());
  tell_of_audience(conversation->services());
  done({protocol::encode(EmptyResult{}), {}});
}

}  // namespace

void add_event_commands(std::vector<Command>& t) {
  t.push_back(connection_command<EmptyResult, EventsParams, &subscribe>(
      "events.subscribe",
      "Be told of playback.changed, playback.ended, marker.crossed, schedule.failed and scene.changed of a scene."));
  t.push_back(connection_command<EmptyResult, EventsParams, &unsubscribe>("events.unsubscribe", "Be told no more."));
}

}  // namespace tweend::commands
