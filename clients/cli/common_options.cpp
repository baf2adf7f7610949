#include "clients/cli/common_options.hpp"

namespace tweend::cli {

Command& with_actor(Command& command) {
  return command.option("--actor", "actor", text("ACTOR"), "which actor; may be left out where the scene has one");
}

Command& with_clip(Command& command) {
  return command.option("--clip", "clip", text("CLIP"), "which clip; left out: the player's");
}

Command& with_edit_options(Command& command) {
  return command.in_scene()
      .option("--base-revision", "base_revision", count(), "refuse if the scene has gone past this revision")
      .option("--retry-key", "retry_key", text("KEY"), "carry it out once, however often it is asked with this key");
}

Command& with_transform(Command& command) {
  return command.option("--translation", "transform/translation", numbers("X,Y,Z", {3}), "metres")
      .option("--rotation", "transform/rotation", numbers("X,Y,Z,W", {4}), "a quaternion")
      .option("--rotate-y", "transform/rotation", turn_y(), "the same, as an angle about +Y")
      .option("--scale", "transform/scale", scale(), "per axis, or one number for all")
      .exclusive({"--rotation", "--rotate-y"});
}

Command& with_interpolation(Command& command, bool clearable) {
  ValueKind kind = word("step|linear|catmull_rom|cubic");
  return command.option("--interpolation", "interpolation", clearable ? or_none(kind) : kind, "how keyframes are blended");
}

Command& with_keyframe_content(Command& command, std::istream& in, bool clearable) {
  ValueKind easing = numbers("X1,Y1,X2,Y2", {4});
  return with_interpolation(command, clearable)
      .option("--easing", "easing", clearable ? or_none(easing) : easing, "a CSS cubic-bezier for the way to the next keyframe")
      .flag("--capture", "capture", "hold what the actor shows at this moment")
      .option("--vertices", "vertices", json_file(in), "hold these: JSON {positions, normals?}, - for standard input")
      .option("--pose", "pose", json_or_file(in), "hold this: JSON {joint: {rotation?, translation?, scale?}, ...}")
      .option("--weights", "weights", any_numbers("W,W,…"), "of all morph targets, in their order")
      .flag("--sparse", "sparse", "key only what is named, not every joint")
      .exclusive({"--capture", "--vertices", "--pose"})
      .exclusive({"--vertices", "--weights"});
}

}  // namespace tweend::cli
