#include <algorithm>

#include "server/commands/command_table.hpp"
#include "server/model/evaluate.hpp"

namespace tweend::commands {
namespace {

struct SampleParams {
  static constexpr std::string_view kName = "VerticesSampleParams";
  std::optional<std::string> scene;
  std::optional<std::string> actor;
  std::optional<std::string> clip;
  std::optional<double> time;
  bool indices = false;
  static void describe(FieldList<SampleParams>& f) {
    using T = SampleParams;
    add_scene_field(f);
    add_actor_field(f);
    add_clip_field(f);
    f.add<&T::time>("time", "Of the clip, seconds, clamped to it; what is shown now if left out.");
    f.add_default<&T::indices>("indices", "Whether the triangles come along.");
  }
};

struct SampleResult {
  static constexpr std::string_view kName = "VerticesSample";
  double time = 0.0;
  std::uint64_t count = 0;
  std::vector<float> positions;
  std::vector<float> normals;
  std::optional<std::vector<std::uint32_t>> indices;
  static void describe(FieldList<SampleResult>& f) {
    using T = SampleResult;
    f.add<&T::time>("time", "Of the clip, seconds.");
    f.add<&T::count>("count", "Vertices.");
    f.add<&T::positions>("positions", "x, y, z of each, model space, metres.");
    f.add<&T::normals>("normals", "x, y, z of each, unit length.");
    f.add<&T::indices>("indices", "Three a triangle, in the file's face order.");
  }
};

Result<SampleResult> sample(const SampleParams& p, const QueryContext& context) {
  const stage::SceneViewPtr view = context.view->find(scene_or_main(p.scene));
  if (!view) return no_such_scene(scene_or_main(p.scene));
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(*view->scene, p.actor));
  if (!actor->model->mesh) return no_mesh(*actor);
  TWEEND_ASSIGN(const Moment moment, moment_of(actor, p.clip, p.time, view, context.now_us));
  const std::size_t count = actor->model->vertex_count();
  SampleResult result{moment.time_s, count, std::vector<float>(3 * count), std::vector<float>(3 * count), {}};
  TWEEND_TRY(model::Evaluator().vertices(*actor, moment.shown, {result.positions, result.normals, {}}));
  if (p.indices)
    result.indices = std::vector<std::uint32_t>(actor->model->mesh->indices().begin(), actor->model->mesh->indices().end());
  return result;
}

}  // namespace

void add_vertices_commands(std::vector<Command>& t) {
  t.push_back(
      query_command<&sample>("vertices.sample", Role::View, "Vertices at a time, or as shown now.", Shape::WorkerQuery));
}

}  // namespace tweend::commands
