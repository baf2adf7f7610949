#include "server/commands/timed_act.hpp"

#include <memory>

namespace tweend::commands {
namespace {

stage::TimedAct players_act(const Command& command, const Params& params, const Services& services) {
  return [&command, params, &stage = services.stage](ClockUs as_of_us, const stage::EditDone& done) {
    const auto change = [&](const stage::PlayersTurn& turn) { return command.players(params.get(), turn); };
    stage.carry_out(command.players_scene(params.get()), change, as_of_us, [&](const Result<stage::PlayersAnswer>& answer) {
      if (!answer) return done(answer.error());
      done(command.players_answer(*answer));
    });
  };
}

stage::TimedAct edit_act(const Command& command, const Params& params, const Services& services) {
  return [&command, params, services](ClockUs as_of_us, const stage::EditDone& done) {
    const std::string scene = timed_scene(command, params);
    const stage::EditPlan plan = [&](stage::Transaction& transaction) {
      EditScratch scratch;
      EditContext context{services, transaction, scratch, "", services.stage.view()->find(scene), as_of_us};
      return command.edit(params.get(), context);
    };
    services.stage.plan({scene, std::string(command.name), {}, {}}, plan, done);
  };
}

}  // namespace

std::string timed_scene(const Command& command, const Params& params) {
  return command.players != nullptr ? command.players_scene(params.get()) : scene_or_main(command.target(params.get()).scene);
}

Result<stage::TimedAct> timed_act(const Command& command, const Params& params, const Services& services) {
  if (command.players != nullptr) return players_act(command, params, services);
  const EditTarget& target = command.target(params.get());
  if (target.base_revision || target.retry_key) {
    return fail(
        ErrorCode::InvalidParams,
        target.base_revision ? "expected at_us or base_revision, found both" : "expected at_us or retry_key, found both",
        "params.at_us");
  }
  return edit_act(command, params, services);
}

}  // namespace tweend::commands
