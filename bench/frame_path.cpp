// A picture from its scene to its JPEG file, 640 x 360 and 1280 x 720 pixels, of about 1,000 and 100,000 triangles: the time
// of each step alone, beside the same step of a bare EGL loop; and pictures a second of a stream with one viewer, its steps
// overlapped on the threads that the server has, beside the bare loop, which takes them one after the other.

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/support/bare_loop.hpp"
#include "bench/support/ratio.hpp"
#include "bench/support/saturated_stream.hpp"
#include "bench/support/server_process.hpp"
#include "bench/support/sphere_scene.hpp"
#include "render/image_encoder.hpp"
#include "render/readback.hpp"
#include "render/render_target.hpp"
#include "render/renderer.hpp"
#include "server/streams/frame_composer.hpp"

namespace {

using namespace tweend;
using bench::BareLoop, bench::BareTimes, bench::SaturatedStream;

constexpr std::size_t kRounds = 15;
constexpr double kBatchSeconds = 0.15;
constexpr std::size_t kStepPictures = 15;
constexpr int kQuality = 80;

struct Case {
  const char* name;
  render::Size size;
  bench::SphereGrid sphere;
};

constexpr Case kCases[] = {{"360p/1k", {640, 360}, {16}},
                           {"360p/100k", {640, 360}, {158}},
                           {"720p/1k", {1280, 720}, {16}},
                           {"720p/100k", {1280, 720}, {158}}};

float linear(float srgb) { return srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F); }
glm::vec3 linear(const glm::vec3& c) { return {linear(c.x), linear(c.y), linear(c.z)}; }

/// The same picture in the bare loop's words.
bench::BareScene bare_scene(const stage::SceneView& view, render::Size size) {
  const model::SceneSettings& settings = view.scene->settings;
  const model::Actor& actor = *view.scene->actors.front();
  const auto& keyframes = actor.clips.front()->keyframes;
  const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
  const model::Light& light = settings.light;
  return {static_cast<int>(size.width),
          static_cast<int>(size.height),
          actor.model->mesh->indices(),
          {keyframes[0].vertices->block(), keyframes[1].vertices->block()},
          model::clip_from_view(settings.camera, aspect) * model::view_from_world(settings.camera),
          settings.camera.eye,
          light.position,
          {light.ambient, light.diffuse, light.specular, light.shininess},
          linear(settings.background),
          linear(model::kDefaultBaseColor)};
}

/// Where between its two keyframes picture `index` stands: there and back in two seconds.
float between(std::size_t index) {
  const double phase = std::fmod(static_cast<double>(SaturatedStream::reading_us(index)) * 1e-6, 2.0);
  return static_cast<float>(phase <= 1.0 ? phase : 2.0 - phase);
}

/// The bare loop's pictures and the stream's are the same but for rounding, or there is nothing to compare.
void require_same_pictures(bench::PictureThreads& threads, const stage::SceneViewPtr& view, const Case& c, BareLoop& bare) {
  SaturatedStream stream(threads, view, {{}, streams::FrameEncoding::Rgba, c.size, kQuality, {}});
  for (const std::size_t index : {7U, 33U, 90U}) {
    const auto top_down = stream.make(index);
    bare.picture(between(index));
    const auto bottom_up = bare.pixels();
    if (top_down.size() != bottom_up.size()) bench::give_up("the pictures differ in size");
    const std::size_t row = std::size_t{4} * c.size.width;
    int most = 0;
    std::size_t covered = 0;
    for (std::size_t i = 0; i < bottom_up.size(); ++i) {
      const std::size_t flipped = bottom_up.size() - (i / row + 1) * row + i % row;
      most = std::max(most, std::abs(static_cast<int>(bottom_up[i]) - static_cast<int>(top_down[flipped])));
      if (bottom_up[i] > 64 && i % 4 == 0) ++covered;
    }
    if (most > 2) bench::give_up(fmt::format("{}: picture {} differs from the bare loop's by {}", c.name, index, most));
    if (covered * 20 < bottom_up.size() / 4) bench::give_up(fmt::format("{}: picture {} shows hardly anything", c.name, index));
  }
}

/// Times of one step, one for each picture.
class Step {
 public:
  template <class Work>
  void time(Work work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    ms_.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  void add(double ms) { ms_.push_back(ms); }
  [[nodiscard]] double ms() const { return bench::median(ms_); }

 private:
  std::vector<double> ms_;
};

template <class T>
T must(Result<T> result) {
  if (!result) bench::give_up(result.error().message);
  return std::move(*result);
}

struct OurSteps {
  Step compose, draw, read, jpeg, png;
};

/// Each step of ours by itself, nothing beside it, on a context of its own.
OurSteps time_our_steps(const stage::SceneViewPtr& view, const Case& c) {
  const auto context = must(render::EglContext::open());
  const auto renderer = must(render::Renderer::make(std::size_t{1} << 30U));
  const auto target = must(render::RenderTarget::make(c.size, 1));
  render::ReadbackPool pool;
  render::JpegEncoder encoder;
  std::vector<std::byte> file(render::JpegEncoder::most_bytes(c.size));
  streams::FrameComposer composer;
  stage::Show show;
  render::Picture picture;
  OurSteps steps;
  for (std::size_t i = 0; i < kStepPictures + 3; ++i) {
    if (i == 3) steps = {};  // by now everything is uploaded and compiled
    steps.compose.time([&] {
      stage::show_at(*view, SaturatedStream::reading_us(i + 1), show);
      composer.compose(show, {}, c.size, picture);
    });
    steps.draw.time([&] {
      renderer->draw(picture, *target);
      glFinish();
    });
    const render::PixelsPtr pixels = pool.take(c.size);
    steps.read.time([&] {
      target->read_into(pixels->buffer());
      glFinish();
    });
    steps.jpeg.time([&] { static_cast<void>(must(encoder.encode(pixels->view(), kQuality, file))); });
  }
  // Not in turn with the others: it takes so long that the device's threads fall asleep.
  const render::PixelsPtr pixels = pool.take(c.size);
  target->read_into(pixels->buffer());
  glFinish();
  for (int i = 0; i < 5; ++i) steps.png.time([&] { static_cast<void>(must(render::encode_png(pixels->view()))); });
  return steps;
}

struct BareSteps {
  Step draw, read, jpeg;
};

BareSteps time_bare_steps(BareLoop& bare) {
  BareSteps steps;
  for (std::size_t i = 0; i < kStepPictures + 3; ++i) {
    const BareTimes times = bare.picture(between(i + 1));
    if (i < 3) continue;
    steps.draw.add(times.draw_ms);
    steps.read.add(times.read_ms);
    steps.jpeg.add(times.encode_ms);
  }
  return steps;
}

double run_bare(BareLoop& bare, std::size_t pictures) {
  bare.picture(between(1));  // wakes what slept while the other was at it
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < pictures; ++i) bare.picture(between(i + 2));
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / static_cast<double>(pictures);
}

/// Nanoseconds a picture: 0 the stream, 1 the bare loop, batches in turn.
bench::Race race(SaturatedStream& stream, BareLoop& bare) {
  static_cast<void>(stream.run(3));
  const auto pictures = static_cast<std::size_t>(std::clamp(kBatchSeconds / run_bare(bare, 3), 5.0, 60.0));
  bench::Race race{{{}, {}}};
  for (std::size_t round = 0; round < kRounds; ++round) {
    race.ns_per_item[0].push_back(1e9 * stream.run(pictures));
    race.ns_per_item[1].push_back(1e9 * run_bare(bare, pictures));
  }
  return race;
}

struct Outcome {
  OurSteps ours;
  BareSteps bare;
  bench::Race race;
};

Outcome measure(bench::PictureThreads& threads, const Case& c) {
  const stage::SceneViewPtr view = bench::playing_sphere(c.sphere);
  OurSteps ours = time_our_steps(view, c);
  BareLoop bare(bare_scene(*view, c.size));
  require_same_pictures(threads, view, c, bare);
  BareSteps bare_steps = time_bare_steps(bare);
  SaturatedStream stream(threads, view, {{}, streams::FrameEncoding::Jpeg, c.size, kQuality, {}});
  return {std::move(ours), std::move(bare_steps), race(stream, bare)};
}

}  // namespace

/// Usage: bench_frame_path [CASE]
int main(int count, char** arguments) {
  bench::PictureThreads threads;
  std::printf("%s\nsteps alone, medians, ms (in brackets the bare loop's), and pictures a second\n",
              threads.renderer.device()->c_str());
  std::printf("%-10s %9s %9s %15s %15s %15s %7s | %8s %8s\n", "", "triangles", "compose", "draw", "read back", "jpeg", "png",
              "stream/s", "bare/s");
  std::vector<bench::Claim> claims;
  for (const Case& c : kCases) {
    if (count > 1 && std::string_view(arguments[1]) != c.name) continue;
    const Outcome o = measure(threads, c);
    std::printf("%-10s %9zu %9.3f %6.2f (%6.2f) %6.2f (%6.2f) %6.2f (%6.2f) %7.2f | %8.1f %8.1f\n", c.name,
                c.sphere.triangle_count(), o.ours.compose.ms(), o.ours.draw.ms(), o.bare.draw.ms(), o.ours.read.ms(),
                o.bare.read.ms(), o.ours.jpeg.ms(), o.bare.jpeg.ms(), o.ours.png.ms(), 1e9 / o.race.ns(0), 1e9 / o.race.ns(1));
    std::fflush(stdout);
    claims.push_back({fmt::format("frame_path/{}", c.name), o.race.ratio(0, 1), 1.1});
  }
  return bench::report(claims) ? 0 : 1;
}
