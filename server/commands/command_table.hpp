#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "server/commands/command.hpp"

namespace tweend::commands {

/// The one list of commands, in the order of docs/PROTOCOL.md: dispatch, validation, roles, OpenRPC and completion read it.
[[nodiscard]] const std::vector<Command>& command_table();

/// Null: there is no such method.
[[nodiscard]] const Command* find_command(std::string_view name) noexcept;

/// The OpenRPC document of the table, made once.
[[nodiscard]] const std::shared_ptr<const std::string>& openrpc_document();

// Each family adds its rows (one .cpp each).
void add_server_commands(std::vector<Command>& table);
void add_asset_commands(std::vector<Command>& table);
void add_scene_commands(std::vector<Command>& table);
void add_actor_commands(std::vector<Command>& table);
void add_keyframe_commands(std::vector<Command>& table);
void add_clip_commands(std::vector<Command>& table);
void add_edit_commands(std::vector<Command>& table);
void add_playback_commands(std::vector<Command>& table);
void add_queue_commands(std::vector<Command>& table);
void add_schedule_commands(std::vector<Command>& table);
void add_marker_commands(std::vector<Command>& table);
void add_layer_commands(std::vector<Command>& table);
void add_view_commands(std::vector<Command>& table);
void add_vertices_commands(std::vector<Command>& table);
void add_pose_commands(std::vector<Command>& table);
void add_frame_commands(std::vector<Command>& table);
void add_export_commands(std::vector<Command>& table);
void add_record_commands(std::vector<Command>& table);
void add_event_commands(std::vector<Command>& table);
void add_stream_commands(std::vector<Command>& table);

}  // namespace tweend::commands
