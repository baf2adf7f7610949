#include "render/render_thread.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/render/support/jobs.hpp"
#include "tests/render/support/shape.hpp"

namespace tweend::render {
namespace {

using test::Image;
using test::Shape;
using test::WaitingJob;
using test::WaitingJobPtr;

/// An empty picture; each `shade` from 0 to 255 has a colour of its own.
Picture plain(std::uint32_t shade = 0, Size size = {16, 16}) {
  Picture picture;
  picture.size = size;
  picture.background = glm::vec3(static_cast<float>(shade) / 255.0F);
  return picture;
}

/// What is expected of it.
bool shows(const Result<Image>& found, std::uint32_t shade, Size size) {
  if (!found || found->size != size) return false;
  return std::all_of(found->rgb.begin(), found->rgb.end(), [shade](std::uint8_t value) { return value == shade; });
}

WaitingJobPtr submit(RenderThread& thread, Picture picture, std::int64_t deadline_us = 0) {
  auto job = std::make_shared<WaitingJob>(std::move(picture));
  thread.submit(job, deadline_us);
  return job;
}

/// Keeps the render thread where it asks for a first job's picture, so that what is submitted meanwhile has to wait.
class Held {
 public:
  explicit Held(RenderThread& thread) {
    if (!thread.device()) throw std::runtime_error(thread.device().error().message);  // nobody would ask for the picture
    job_ = std::make_shared<WaitingJob>(plain(), [this] {
      asked_.set_value();
      released_.get_future().wait();
    });
    thread.submit(job_, std::numeric_limits<std::int64_t>::min());
    asked_.get_future().wait();
  }
  /// And takes the answer: the stop waits for pictures that somebody has.
  void release() {
    released_.set_value();
    EXPECT_TRUE(job_->wait());
  }
  [[nodiscard]] WaitingJob& job() { return *job_; }

 private:
  std::promise<void> asked_, released_;
  WaitingJobPtr job_;
};

TEST(RenderThread, RefusesAPictureThatIsTooLargeAndGoesOn) {
  RenderThread thread;
  for (const Size size : {Size{1U << 20U, 8}, Size{8, 1U << 20U}, Size{0, 8}}) {
    const auto refused = submit(thread, plain(0, size))->wait();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::Limit);
    EXPECT_NE(refused.error().message.find(std::to_string(size.width) + " x "), std::string::npos) << refused.error().message;
    const auto next = submit(thread, plain(200))->wait_image();
    ASSERT_TRUE(next) << next.error().message;
    EXPECT_EQ(next->at(3, 3)[0], 200);
  }
}

TEST(RenderThread, RefusesWhatComesAfterTheStop) {
  RenderThread thread;
  thread.stop();
  const auto job = submit(thread, plain());
  EXPECT_EQ(job->answers(), 1) << "at once";
  const auto refused = job->wait();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::Unavailable);
  EXPECT_NE(refused.error().message.find("stopping"), std::string::npos);
  thread.stop();  // again: nothing to do
}

/// Ends the process: 3 if every job is answered with the same reason as the device.
[[noreturn]] void ask_without_a_device() {
  setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1);
  RenderThread thread;
  if (thread.device() || thread.attempts().empty()) std::exit(4);
  std::fprintf(stderr, "refused: %s\n", thread.device().error().message.c_str());
  std::vector<WaitingJobPtr> jobs;
  for (int i = 0; i < 20; ++i) jobs.push_back(submit(thread, plain()));
  for (const WaitingJobPtr& job : jobs) {
    const auto answer = job->wait();
    if (answer || answer.error() != thread.device().error()) std::exit(5);
  }
  thread.stop();
  for (const WaitingJobPtr& job : jobs) {
    if (job->answers() != 1) std::exit(6);
  }
  std::exit(3);
}

TEST(RenderThreadWithoutADevice, AnswersEveryJobWithTheReason) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(ask_without_a_device(), testing::ExitedWithCode(3), "refused: expected a device that draws with OpenGL");
}

TEST(RenderThread, SaysWhatDrawsAndWithHowManySamples) {
  const RenderThread thread({1, 1U << 20U});
  ASSERT_TRUE(thread.device()) << thread.device().error().message;
  EXPECT_NE(thread.device()->find("OpenGL 4."), std::string::npos) << *thread.device();
  EXPECT_NE(thread.device()->find("1 sample a pixel"), std::string::npos) << *thread.device();
  EXPECT_TRUE(std::any_of(thread.attempts().begin(), thread.attempts().end(), [](const auto& a) { return a.taken; }));
  const RenderThread several({4, 1U << 20U});
  EXPECT_NE(several.device()->find("4 samples a pixel"), std::string::npos) << *several.device();
}

TEST(RenderThread, DrawsTheEarliestDeadlineFirst) {
  RenderThread thread;
  Held held(thread);
  std::vector<int> order;  // written on the render thread only, read once it is joined
  std::vector<WaitingJobPtr> jobs;
  const auto add = [&](int name, std::int64_t deadline_us) {
    jobs.push_back(std::make_shared<WaitingJob>(plain(), [&order, name] { order.push_back(name); }));
    thread.submit(jobs.back(), deadline_us);
  };
  for (const int i : {7, 2, 9, 0, 5, 3, 8, 1, 6, 4}) add(i, 1000 * i - 3000);
  add(10, 6000);  // as urgent as number 9, which came before
  held.release();
  for (const WaitingJobPtr& job : jobs) EXPECT_TRUE(job->wait());
  thread.stop();
  EXPECT_EQ(order, (std::vector{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
  for (const WaitingJobPtr& job : jobs) EXPECT_EQ(job->answers(), 1);
}

TEST(RenderThread, AnswersEveryJobOfManyThreadsOnceWithItsOwnPicture) {
  constexpr std::uint32_t kThreads = 6;
  constexpr std::uint32_t kEach = 40;
  RenderThread thread;
  std::vector<WaitingJobPtr> jobs(kThreads * kEach);
  std::vector<std::thread> submitters;
  for (std::uint32_t t = 0; t < kThreads; ++t) {
    submitters.emplace_back([&, t] {
      for (std::uint32_t i = 0; i < kEach; ++i) {
        const std::uint32_t number = t * kEach + i;
        jobs[number] = submit(thread, plain(number, {8 + 8 * t, 8}), (number * 7919) % 100);
        // Some wait for theirs, as views do; others go on.
        if (t % 2 == 0) {
          EXPECT_TRUE(shows(jobs[number]->wait_image(), number, {8 + 8 * t, 8})) << number;
        }
      }
    });
  }
  for (std::thread& t : submitters) t.join();
  for (std::uint32_t number = kEach; number < jobs.size(); ++number) {
    const std::uint32_t t = number / kEach;
    if (t % 2 == 1) {
      EXPECT_TRUE(shows(jobs[number]->wait_image(), number, {8 + 8 * t, 8})) << number;
    }
  }
  thread.stop();
  for (const WaitingJobPtr& job : jobs) EXPECT_EQ(job->answers(), 1);
}

TEST(RenderThread, TheSamePictureTwiceIsTheSameBytes) {
  const Shape ball = test::ball();
  Picture picture = plain(50, {96, 64});
  picture.grid = true;
  picture.light.ambient = 0.3F;
  picture.light.diffuse = 0.7F;
  picture.light.position = {2, 3, 4};
  picture.items = {ball.item()};
  std::vector<Image> images;
  for (int i = 0; i < 3; ++i) {
    RenderThread thread;
    std::vector<WaitingJobPtr> jobs;
    for (int k = 0; k < 4; ++k) {
      jobs.push_back(submit(thread, picture));
      static_cast<void>(submit(thread, plain(255, {96, 64})));
    }
    for (const WaitingJobPtr& job : jobs) images.push_back(*job->wait_image());
  }
  for (const Image& image : images) EXPECT_EQ(image, images[0]);
}

TEST(RenderThread, APictureStaysAsItIsWhileItIsHeld) {
  RenderThread thread;
  std::vector<PixelsPtr> held;
  for (std::uint32_t i = 0; i < 30; ++i) held.push_back(*submit(thread, plain(i))->wait());
  for (std::uint32_t i = 0; i < 30; ++i) EXPECT_EQ(Image(held[i]->view()).at(5, 5)[0], static_cast<int>(i));
}

TEST(RenderThread, MemoryOfAPictureIsUsedAgainOnceItIsBack) {
  RenderThread thread;
  const auto memory_of = [&](std::uint32_t shade) {
    const PixelsPtr pixels = *submit(thread, plain(shade))->wait();
    EXPECT_EQ(Image(pixels->view()).at(0, 0)[0], static_cast<int>(shade));
    return pixels->view().bytes.data();
  };
  const std::byte* first = memory_of(1);
  for (std::uint32_t i = 2; i < 10; ++i) EXPECT_EQ(memory_of(i), first);
}

TEST(RenderThread, TheStopDrawsWhatWaitsAndAnswersIt) {
  RenderThread thread;
  Held held(thread);
  std::vector<WaitingJobPtr> jobs;
  for (std::uint32_t i = 0; i < 10; ++i) jobs.push_back(submit(thread, plain(i)));
  std::thread stopper([&] { thread.stop(); });
  held.release();
  for (std::uint32_t i = 0; i < 10; ++i) {
    const auto image = jobs[i]->wait_image();
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_EQ(image->at(2, 2)[0], static_cast<int>(i));
  }
  stopper.join();
  EXPECT_EQ(held.job().answers(), 1);
}

TEST(RenderThread, TheStopWaitsForPicturesThatAreHeld) {
  RenderThread thread;
  PixelsPtr pixels = *submit(thread, plain(99))->wait();
  std::atomic<bool> given_back{false};
  std::thread stopper([&] {
    thread.stop();
    EXPECT_TRUE(given_back) << "its memory goes with the context";
  });
  while (submit(thread, plain())->wait()) continue;  // until the stop has begun
  EXPECT_EQ(Image(pixels->view()).at(1, 1)[0], 99);
  given_back = true;
  pixels.reset();
  stopper.join();
}

TEST(RenderThread, KeyframesOfOneMeshAreSharedByAllItsPictures) {
  Shape shape = test::square(0.5F);
  shape.blocks.push_back(shape.blocks[0]);
  for (std::size_t i = 0; i < 12; ++i) shape.blocks[1][i] *= 2.0F;
  RenderThread thread;
  std::vector<WaitingJobPtr> jobs;
  for (const float u : {0.0F, 0.5F, 1.0F}) {
    Picture picture = plain(0, {64, 64});  // without a camera clip space is the world
    picture.light.ambient = 1.0F;
    picture.items = {shape.item({0, 1}, {1.0F - u, u})};
    jobs.push_back(submit(thread, picture));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Image image = *jobs[i]->wait_image();
    const auto white = std::count(image.rgb.begin(), image.rgb.end(), 255) / 3;
    const auto side = static_cast<std::ptrdiff_t>(32 + 16 * i);
    EXPECT_EQ(white, side * side);
  }
}

}  // namespace
}  // namespace tweend::render
