#include "server/assets/glb_writer.hpp"

#include <fmt/format.h>

#include <new>
#include <optional>

#include "server/assets/export_clip.hpp"
#include "server/assets/export_targets.hpp"
#include "server/assets/glb_animation.hpp"
#include "server/assets/glb_document.hpp"
#include "server/assets/glb_mesh.hpp"
#include "server/assets/glb_rig.hpp"

namespace tweend::assets {
namespace {

Error too_large(const model::Actor& actor, std::size_t most_bytes) {
  return fail(ErrorCode::Limit,
              fmt::format("expected a file of at most {} bytes, found that \"{}\" takes more", most_bytes, actor.name));
}

Result<std::string> write(const model::Actor& actor, std::size_t most_bytes) {
  GlbDocument document;
  const std::size_t mesh_node = add_rig(actor, document);
  std::optional<ExportTargets> targets;
  if (actor.model->mesh) {
    targets.emplace(actor);
    const bool skinned = document.nodes[mesh_node].skin.has_value();
    TWEEND_ASSIGN(document.nodes[mesh_node].mesh, add_mesh(actor, *targets, skinned, most_bytes, document));
  }
  for (const model::ClipPtr& clip : actor.clips) {
    if (document.buffer.size() > most_bytes) return too_large(actor, most_bytes);
    const std::size_t most_values = (most_bytes - document.buffer.size()) / sizeof(float);
    TWEEND_ASSIGN(const ClipSamples samples, clip_samples(actor, *clip, targets ? &*targets : nullptr, most_values));
    add_animation(clip->name, samples, mesh_node, document);
  }
  return write_document(document, most_bytes);
}

}  // namespace

Result<std::string> write_glb(const model::Actor& actor, const Limits& limits) {
  try {
    return write(actor, limits.asset_bytes);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::Unavailable, fmt::format("there is not enough memory to export \"{}\"", actor.name));
  }
}

}  // namespace tweend::assets
