#pragma once

namespace tweend::cli {

class CommandSet;

// Each family of commands stands in a file of its own, NAME_commands.cpp.
void add_server_commands(CommandSet& commands);      ///< ping, info, stats, assets
void add_scene_commands(CommandSet& commands);       ///< scenes, scene …, actors, clips
void add_actor_commands(CommandSet& commands);       ///< add, remove, actor …
void add_keyframe_commands(CommandSet& commands);    ///< keyframe …
void add_clip_commands(CommandSet& commands);        ///< clip …
void add_edit_commands(CommandSet& commands);        ///< undo, redo, apply
void add_playback_commands(CommandSet& commands);    ///< play, pause, stop, seek, step, set, status
void add_view_commands(CommandSet& commands);        ///< camera, light
void add_sample_commands(CommandSet& commands);      ///< vertices
void add_frame_commands(CommandSet& commands);       ///< frame
void add_export_commands(CommandSet& commands);      ///< export
void add_event_commands(CommandSet& commands);       ///< events, wait …
void add_watch_commands(CommandSet& commands);       ///< watch …
void add_raw_commands(CommandSet& commands);         ///< call, methods
void add_completion_commands(CommandSet& commands);  ///< completion …

}  // namespace tweend::cli
