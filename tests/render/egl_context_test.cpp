#include "render/egl_context.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "render/render_target.hpp"
#include "tests/render/support/offscreen.hpp"
#include "tests/render/support/shape.hpp"

namespace tweend::render {
namespace {

/// Opens a context and ends the process: 0 if there is one, 3 if it is refused as Unavailable. Says why on standard error.
[[noreturn]] void open_and_exit() {
  std::vector<DeviceAttempt> attempts;
  const auto context = EglContext::open(&attempts);
  if (context) std::exit(0);
  std::fprintf(stderr, "refused: %s\n", context.error().message.c_str());
  for (const DeviceAttempt& a : attempts) {
    // Whatever was tried is named in the message, too.
    const bool named = context.error().message.find(a.name + ": " + a.outcome) != std::string::npos;
    if (a.taken || a.outcome.empty() || !named) std::exit(4);
  }
  std::exit(context.error().code == ErrorCode::Unavailable && !attempts.empty() ? 3 : 5);
}

/// libEGL reads its environment once: each of these runs in a process of its own, made anew from this program.
class EglContextWithout : public testing::Test {
 protected:
  void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
  static void open_with(const char* name, const char* value) {
    setenv(name, value, 1);
    open_and_exit();
  }
};

TEST_F(EglContextWithout, AVendorIsUnavailable) {
  EXPECT_EXIT(open_with("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json"), testing::ExitedWithCode(3),
              "refused: expected a device that draws with OpenGL 4.5 core, found none .*EGL.*tweend doctor");
}

TEST_F(EglContextWithout, ADriverIsUnavailable) {
  EXPECT_EXIT(open_with("LIBGL_DRIVERS_PATH", "/nonexistent"), testing::ExitedWithCode(3),
              "refused: .*Mesa surfaceless: the display can't be initialized: not initialized");
}

TEST_F(EglContextWithout, OpenGl45IsUnavailable) {
  EXPECT_EXIT(open_with("MESA_GL_VERSION_OVERRIDE", "3.3"), testing::ExitedWithCode(3),
              "refused: .*Mesa surfaceless: no context: OpenGL 4.5 core is not supported");
}

TEST_F(EglContextWithout, AnythingMissingItIsOpened) {
  EXPECT_EXIT(open_with("TWEEND_NOTHING", "1"), testing::ExitedWithCode(0), "");
}

TEST(EglContext, SaysWhatWasTriedAndWhatWasTaken) {
  std::vector<DeviceAttempt> attempts;
  const auto context = EglContext::open(&attempts);
  ASSERT_TRUE(context) << context.error().message;
  const auto is_taken = [](const DeviceAttempt& a) { return a.taken; };
  ASSERT_EQ(std::count_if(attempts.begin(), attempts.end(), is_taken), 1);
  const DeviceAttempt& taken = *std::find_if(attempts.begin(), attempts.end(), is_taken);
  EXPECT_EQ(&taken, &attempts.back()) << "nothing is tried after that";
  for (const DeviceAttempt& a : attempts) {
    EXPECT_FALSE(a.name.empty());
    EXPECT_FALSE(a.outcome.empty()) << a.name;
  }
  const std::string& description = (*context)->description();
  EXPECT_EQ(description.find(taken.outcome), 0U) << description;
  EXPECT_NE(description.find("OpenGL 4."), std::string::npos) << description;
  EXPECT_NE(description.find(taken.name), std::string::npos) << description;
  EXPECT_EQ((*context)->software(), taken.software);
  EXPECT_TRUE((*context)->software() || description.find("llvmpipe") == std::string::npos) << description;
}

/// What a context that was just opened draws.
test::Image draw_once() {
  test::Offscreen gpu;
  const test::Shape shape = test::ball(8, 8);
  Picture picture;
  picture.size = {16, 16};
  picture.light.ambient = 1.0F;
  picture.items = {shape.item()};
  return gpu.draw(picture);
}

TEST(EglContext, OneAfterTheOtherDrawTheSame) {
  const test::Image first = draw_once();
  EXPECT_EQ(first.at(8, 8)[0], 255) << "the ball covers the picture's middle";
  EXPECT_EQ(draw_once(), first);
  test::Image on_thread;
  std::thread([&] { on_thread = draw_once(); }).join();
  EXPECT_EQ(on_thread, first);
  EXPECT_EQ(draw_once(), first) << "the other thread's end took nothing away";
}

TEST(EglContext, TwoAtOnceOnTwoThreadsDrawTheSame) {
  test::Image a, b;
  std::thread first([&] { a = draw_once(); });
  std::thread second([&] { b = draw_once(); });
  first.join();
  second.join();
  EXPECT_EQ(a, b);
}

TEST(RenderTarget, RefusesSizesThatTheDeviceDoesNotDraw) {
  const test::Offscreen gpu;
  GLint most = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
  const auto beyond = static_cast<std::uint32_t>(most) + 1;
  for (const Size size : {Size{0, 1}, Size{1, 0}, Size{0, 0}, Size{beyond, 1}, Size{1, beyond}, Size{0xFFFFFFFF, 0xFFFFFFFF}}) {
    const auto target = RenderTarget::make(size, 1);
    ASSERT_FALSE(target) << size.width << " x " << size.height;
    EXPECT_EQ(target.error().code, ErrorCode::Limit);
    EXPECT_NE(target.error().message.find(std::to_string(most) + " x " + std::to_string(most)), std::string::npos)
        << target.error().message;
    EXPECT_NE(target.error().message.find(std::to_string(size.width) + " x " + std::to_string(size.height)), std::string::npos);
  }
  EXPECT_TRUE(RenderTarget::make({1, 1}, 1)) << "and goes on afterwards";
}

TEST(RenderTarget, AnErrorOfSomebodyElseIsNotItsOwn) {
  const test::Offscreen gpu;
  glEnable(0xFFFF);  // there is no such thing: an error that nobody asks for
  const auto target = RenderTarget::make({8, 8}, 1);
  EXPECT_TRUE(target) << target.error().message;
}

TEST(RenderTargetPool, GivesATargetOfTheSizeAgainAndForgetsThoseOfLongAgo) {
  const test::Offscreen gpu;
  RenderTargetPool pool(1);
  const auto framebuffer_of = [&](Size size) {
    auto target = pool.take(size);
    EXPECT_TRUE(target);
    EXPECT_EQ((*target)->size(), size);
    const GLuint name = (*target)->framebuffer();
    pool.give_back(std::move(*target));
    return name;
  };
  const GLuint first = framebuffer_of({8, 8});
  EXPECT_EQ(framebuffer_of({8, 8}), first);
  EXPECT_NE(framebuffer_of({8, 9}), first);
  EXPECT_EQ(framebuffer_of({8, 8}), first);
  for (std::uint32_t i = 0; i < 20; ++i) static_cast<void>(framebuffer_of({16, 16 + i}));
  EXPECT_EQ(glIsFramebuffer(first), GL_FALSE) << "twenty other sizes later it is gone";
}

}  // namespace
}  // namespace tweend::render
