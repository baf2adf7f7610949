#include "clients/cli/command.hpp"
#include "clients/cli/common_options.hpp"
#include "clients/cli/families.hpp"

namespace tweend::cli {

void add_layer_commands(CommandSet& commands) {
  commands.group("layer", "Blend clips over the one that plays.");
  with_actor(with_edit_options(commands.add("layer set", "Blend a clip over the player's, or change how.")))
      .argument("NAME", "layer", text("NAME"), "the layer's name; layers lie over each other in the order of their names")
      .argument("CLIP", "clip", text("CLIP"), "what it plays")
      .option("--weight", "weight", number(), "0 to 1 (default 1)")
      .flag("--additive", "additive", "add what differs from the rest pose, rather than replace")
      .option("--mask", "mask", texts("JOINT,JOINT,…"), "touch these joints only")
      .option("--fade", "fade", seconds(), "get there in this time")
      .requests("layer.set", "layer {layer} plays {clip}");
  with_actor(with_edit_options(commands.add("layer remove", "Remove a layer.")))
      .argument("NAME", "layer", text("NAME"), "the layer's name")
      .option("--fade", "fade", seconds(), "let it go in this time")
      .requests("layer.remove", "layer {layer} removed");
}

}  // namespace tweend::cli
