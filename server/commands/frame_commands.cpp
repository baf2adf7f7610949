#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "protocol/base64.hpp"
#include "server/commands/command_table.hpp"
#include "server/commands/frame_types.hpp"

namespace tweend::commands {
namespace {

struct FrameResult {
  static constexpr std::string_view kName = "Frame";
  double time = 0.0;
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  streams::ImageFormat format = streams::ImageFormat::Png;
  std::string base64;
  static void describe(FieldList<FrameResult>& f) {
    using T = FrameResult;
    f.add<&T::time>("time", "Media seconds of the scene's first actor.");
    f.add<&T::width>("width", "Pixels.");
    f.add<&T::height>("height", "Pixels.");
    f.add<&T::format>("format", "png or jpeg.");
    f.add<&T::base64>("base64", "The file.");
  }
};

void render_frame(const FrameParams& p, const QueryContext& context, const AsyncDone<FrameResult>& done) {
  Result<streams::StillRequest> request = still_request(p, context);
  if (!request) return done(request.error());
  FrameResult result{0.0, request->size.width, request->size.height, request->format, {}};
  const Status taken = context.services.stills.render(std::move(*request),
                                                      [result = std::move(result), done](Result<streams::Still> still) mutable {
                                                        if (!still) return done(still.error());
                                                        result.time = still->time_s;
                                                        protocol::append_base64(still->file, result.base64);
                                                        done(std::move(result));
                                                      });
  if (!taken) done(taken.error());
}

Result<std::uint32_t> side(std::string_view name, std::uint64_t pixels, std::size_t most) {
  if (pixels <= most) return static_cast<std::uint32_t>(pixels);
  return fail(ErrorCode::Limit, fmt::format("expected at most {} pixels, found {}", most, pixels),
              fmt::format("params.{}", name));
}

Status check_even(std::string_view side, std::uint32_t pixels) {
  if (pixels % 2 == 0) return {};
  return fail(ErrorCode::InvalidParams, fmt::format("expected an even number of pixels for mp4, found {}", pixels),
              fmt::format("params.{}", side));
}

}  // namespace

Status check_even(render::Size size) {
  TWEEND_TRY(check_even("width", size.width));
  return check_even("height", size.height);
}

Result<render::Size> frame_size(const std::optional<std::uint64_t>& width, const std::optional<std::uint64_t>& height,
                                const Services& services) {
  if (const auto& device = services.renderer.device(); !device) return device.error();
  const std::size_t most = std::min<std::size_t>(services.limits.frame_side, services.renderer.largest_side());
  render::Size size;
  TWEEND_ASSIGN(size.width, side("width", width.value_or(kDefaultWidth), most));
  TWEEND_ASSIGN(size.height, side("height", height.value_or(kDefaultHeight), most));
  return size;
}

Result<streams::StillRequest> still_request(const FrameParams& p, const QueryContext& context) {
  const std::string scene = scene_or_main(p.scene);
  streams::StillRequest request;
  request.view = context.view->find(scene);
  if (!request.view) return no_such_scene(scene);
  TWEEND_ASSIGN(request.size, frame_size(p.width, p.height, context.services));
  request.time_s = p.time;
  request.now_us = context.now_us;
  request.format = p.format.value_or(streams::ImageFormat::Png);
  request.quality = static_cast<int>(p.quality.value_or(kDefaultQuality));
  if (p.camera) {
    TWEEND_TRY(check_own_camera(*p.camera, *request.view->scene));
    request.camera = p.camera->request();
  }
  return request;
}

void add_frame_commands(std::vector<Command>& t) {
  t.push_back(async_query_command<FrameResult, FrameParams, &render_frame>("frame.render", Role::View,
                                                                           "A picture of what a scene shows."));
}

}  // namespace tweend::commands
