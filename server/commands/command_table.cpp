#include "server/commands/command_table.hpp"

#include <unordered_map>

#include "protocol/openrpc.hpp"

namespace tweend::commands {

const std::vector<Command>& command_table() {
  static const std::vector<Command> table = [] {
    std::vector<Command> t;
    add_server_commands(t);
    add_asset_commands(t);
    add_scene_commands(t);
    add_actor_commands(t);
    add_keyframe_commands(t);
    add_clip_commands(t);
    add_edit_commands(t);
    add_playback_commands(t);
    add_queue_commands(t);
    add_schedule_commands(t);
    add_marker_commands(t);
    add_layer_commands(t);
    add_view_commands(t);
    add_vertices_commands(t);
    add_pose_commands(t);
    add_frame_commands(t);
    add_export_commands(t);
    add_record_commands(t);
    add_stream_commands(t);
    add_event_commands(t);
    return t;
  }();
  return table;
}

const Command* find_command(std::string_view name) noexcept {
  static const std::unordered_map<std::string_view, const Command*> by_name = [] {
    std::unordered_map<std::string_view, const Command*> map;
    for (const Command& c : command_table()) map.emplace(c.name, &c);
    return map;
  }();
  const auto at = by_name.find(name);
  return at == by_name.end() ? nullptr : at->second;
}

const std::shared_ptr<const std::string>& openrpc_document() {
  static const auto document = [] {
    std::vector<protocol::MethodInfo> methods;
    for (const Command& c : command_table()) methods.push_back({c.name, role_name(c.role), c.summary, c.params, c.result});
    return std::make_shared<const std::string>(protocol::openrpc_json(methods, TWEEND_VERSION));
  }();
  return document;
}

}  // namespace tweend::commands
