#include "server/commands/command_table.hpp"

namespace tweend::commands {
namespace {

struct ScheduleListParams {
  static constexpr std::string_view kName = "ScheduleListParams";
  std::optional<std::string> scene;
  static void describe(FieldList<ScheduleListParams>& f) { add_scene_field(f); }
};

struct ScheduledState {
  static constexpr std::string_view kName = "Scheduled";
  std::int64_t scheduled = 0;
  std::int64_t at_us = 0;
  std::string method;
  static void describe(FieldList<ScheduledState>& f) {
    using T = ScheduledState;
    f.add<&T::scheduled>("scheduled", "Its id.");
    f.add<&T::at_us>("at_us", "The reading as of which it will be carried out.");
    f.add<&T::method>("method", "The command.");
  }
};

struct ScheduleListResult {
  static constexpr std::string_view kName = "ScheduleList";
  std::vector<ScheduledState> scheduled;
  static void describe(FieldList<ScheduleListResult>& f) {
    f.add<&ScheduleListResult::scheduled>("scheduled", "In the order they will be carried out.");
  }
};

struct ScheduleCancelParams {
  static constexpr std::string_view kName = "ScheduleCancelParams";
  std::int64_t scheduled = 0;
  static void describe(FieldList<ScheduleCancelParams>& f) {
    f.add<&ScheduleCancelParams::scheduled>("scheduled", "The id that its answer told.");
  }
};

void list(const ScheduleListParams& p, const QueryContext& context, const AsyncDone<ScheduleListResult>& done) {
  context.services.stage.list_scheduled(scene_or_main(p.scene), [done](const Result<std::vector<stage::Scheduled>>& waiting) {
    if (!waiting) return done(waiting.error());
    ScheduleListResult result;
    for (const stage::Scheduled& s : *waiting) result.scheduled.push_back({s.id, s.at_us, s.method});
    done(std::move(result));
  });
}

void cancel(const ScheduleCancelParams& p, const QueryContext& context, const AsyncDone<EmptyResult>& done) {
  context.services.stage.cancel(p.scheduled, [done](const Status& status) {
    if (!status) return done(status.error());
    done(EmptyResult{});
  });
}

}  // namespace

void add_schedule_commands(std::vector<Command>& t) {
  t.push_back(async_query_command<ScheduleListResult, ScheduleListParams, &list>("schedule.list", Role::View,
                                                                                 "The commands that wait for their reading."));
  t.push_back(async_query_command<EmptyResult, ScheduleCancelParams, &cancel>("schedule.cancel", Role::Control,
                                                                              "Take back a command that waits."));
}

}  // namespace tweend::commands
