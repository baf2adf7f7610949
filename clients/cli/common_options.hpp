#pragma once

#include "clients/cli/command.hpp"

namespace tweend::cli {

// Options that several families share; each returns the command it was given.

/// --actor: may be left out where the scene has one actor.
Command& with_actor(Command& command);
/// --clip: may be left out for the player's clip.
Command& with_clip(Command& command);
/// --base-revision and --retry-key, and --scene: the command is an edit.
Command& with_edit_options(Command& command);
/// --translation, --rotation, --rotate-y, --scale.
Command& with_transform(Command& command);
/// --interpolation; `clearable`: the word none gives it back to the next in line.
Command& with_interpolation(Command& command, bool clearable);
/// --capture, --vertices, --pose, --weights and --sparse, --interpolation and --easing: what a keyframe holds.
Command& with_keyframe_content(Command& command, std::istream& in, bool clearable);

}  // namespace tweend::cli
