#include "render/egl_context.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <string_view>
#include <utility>

namespace tweend::render {
namespace {

constexpr int kMajor = 4;
constexpr int kMinor = 5;
constexpr EGLint kMostDevices = 16;

std::string_view text(const char* value) { return value == nullptr ? std::string_view() : value; }
std::string_view text(const GLubyte* value) { return text(reinterpret_cast<const char*>(value)); }

/// Whether a space-separated list has this word.
bool has_extension(std::string_view list, std::string_view name) {
  for (std::size_t at = list.find(name); at != std::string_view::npos; at = list.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    if ((at == 0 || list[at - 1] == ' ') && (end == list.size() || list[end] == ' ')) return true;
  }
  return false;
}

std::string_view egl_error_name(EGLint error) {
  constexpr std::array<std::pair<EGLint, std::string_view>, 8> kNames{{
      {EGL_SUCCESS, "no reason given"},
      {EGL_NOT_INITIALIZED, "not initialized"},
      {EGL_BAD_ACCESS, "bad access"},
      {EGL_BAD_ALLOC, "out of memory"},
      {EGL_BAD_ATTRIBUTE, "bad attribute"},
      {EGL_BAD_CONFIG, "bad config"},
      {EGL_BAD_MATCH, "OpenGL 4.5 core is not supported"},
      {EGL_BAD_PARAMETER, "bad parameter"},
  }};
  for (const auto& [code, name] : kNames) {
    if (code == error) return name;
  }
  return "unknown error";
}

std::string device_name(EGLDeviceEXT device, std::string_view extensions, EGLint index) {
  if (!has_extension(extensions, "EGL_EXT_device_drm")) return fmt::format("device {}", index);
  return fmt::format("device {} ({})", index, text(eglQueryDeviceStringEXT(device, EGL_DRM_DEVICE_FILE_EXT)));
}

}  // namespace

/// Goes through the ways there are and notes what comes of each.
class ContextOpener {
 public:
  std::vector<DeviceAttempt> attempts;

  std::unique_ptr<EglContext> open() {
    if (!epoxy_has_egl()) {
      attempts.push_back({"EGL", false, false, "libEGL.so.1 is not installed (Debian: libegl1, libegl-mesa0)"});
      return nullptr;
    }
    client_extensions_ = text(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS));
    if (auto context = open_device()) return context;
    return open_surfaceless();
  }

 private:
  std::unique_ptr<EglContext> open_device() {
    // libepoxy ends the process at a call that nobody provides: each is asked for before.
    if (!has_extension(client_extensions_, "EGL_EXT_platform_base") ||
        !has_extension(client_extensions_, "EGL_EXT_platform_device") ||
        !(has_extension(client_extensions_, "EGL_EXT_device_query") ||
          has_extension(client_extensions_, "EGL_EXT_device_base")) ||
        !(has_extension(client_extensions_, "EGL_EXT_device_enumeration") ||
          has_extension(client_extensions_, "EGL_EXT_device_base"))) {
      attempts.push_back({"EGL devices", false, false, "this EGL has no device platform"});
      return nullptr;
    }
    std::array<EGLDeviceEXT, kMostDevices> devices{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(kMostDevices, devices.data(), &count) == EGL_FALSE || count == 0) {
      attempts.push_back({"EGL devices", false, false, "there is none"});
      return nullptr;
    }
    for (EGLint i = 0; i < count; ++i) {
      const EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
      const std::string_view extensions = text(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS));
      DeviceAttempt attempt{
          device_name(device, extensions, i), has_extension(extensions, "EGL_MESA_device_software"), false, {}};
      if (attempt.software) {
        attempt.outcome = "draws on the processor: not a GPU";
        attempts.push_back(std::move(attempt));
        continue;
      }
      const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
      if (auto context = open_on(display, std::move(attempt))) return context;
    }
    return nullptr;
  }

  std::unique_ptr<EglContext> open_surfaceless() {
    DeviceAttempt attempt{"Mesa surfaceless", false, false, {}};
    if (!has_extension(client_extensions_, "EGL_EXT_platform_base") ||
        !has_extension(client_extensions_, "EGL_MESA_platform_surfaceless")) {
      attempt.outcome = "this EGL has no surfaceless platform (Debian: libegl-mesa0, libgl1-mesa-dri)";
      attempts.push_back(std::move(attempt));
      return nullptr;
    }
    return open_on(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr), std::move(attempt));
  }

  /// Notes the attempt, whatever comes of it.
  std::unique_ptr<EglContext> open_on(EGLDisplay display, DeviceAttempt attempt) {
    std::unique_ptr<EglContext> context(new EglContext);
    attempt.outcome = make_current(display, *context);
    attempt.taken = attempt.outcome.empty();
    if (attempt.taken) {
      const std::string_view renderer = text(glGetString(GL_RENDERER));
      // The surfaceless platform may well find a GPU by itself.
      attempt.software = attempt.software || renderer.find("llvmpipe") != std::string_view::npos ||
                         renderer.find("softpipe") != std::string_view::npos;
      attempt.outcome = std::string(renderer);
      context->software_ = attempt.software;
      context->description_ = fmt::format("{}, OpenGL {}, {}", renderer, text(glGetString(GL_VERSION)), attempt.name);
    }
    const bool taken = attempt.taken;
    attempts.push_back(std::move(attempt));
    return taken ? std::move(context) : nullptr;
  }

  /// @return why not; empty: the context is current
  static std::string make_current(EGLDisplay display, EglContext& context) {
    const auto failed = [](std::string_view what) { return fmt::format("{}: {}", what, egl_error_name(eglGetError())); };
    if (display == EGL_NO_DISPLAY) return failed("no display");
    if (eglInitialize(display, nullptr, nullptr) == EGL_FALSE) return failed("the display can't be initialized");
    context.display_ = display;
    const std::string_view extensions = text(eglQueryString(display, EGL_EXTENSIONS));
    if (!has_extension(extensions, "EGL_KHR_surfaceless_context") || !has_extension(extensions, "EGL_KHR_no_config_context")) {
      return "it has no contexts without a surface";
    }
    if (eglBindAPI(EGL_OPENGL_API) == EGL_FALSE) return failed("it has no desktop OpenGL");
    constexpr std::array<EGLint, 7> kAttributes{
        EGL_CONTEXT_MAJOR_VERSION,           kMajor,  EGL_CONTEXT_MINOR_VERSION, kMinor, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    const EGLContext made = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, kAttributes.data());
    if (made == EGL_NO_CONTEXT) return failed("no context");
    context.context_ = made;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, made) == EGL_FALSE) {
      return failed("the context can't be made current");
    }
    return {};
  }

  std::string_view client_extensions_;
};

Result<std::unique_ptr<EglContext>> EglContext::open(std::vector<DeviceAttempt>* attempts) {
  ContextOpener opener;
  std::unique_ptr<EglContext> context = opener.open();
  std::string tried;
  for (const DeviceAttempt& attempt : opener.attempts) {
    tried += fmt::format("{}{}: {}", tried.empty() ? "" : "; ", attempt.name, attempt.outcome);
  }
  if (attempts != nullptr) *attempts = std::move(opener.attempts);
  if (context) return context;
  return fail(ErrorCode::Unavailable, fmt::format("expected a device that draws with OpenGL {}.{} core, found none ({}); "
                                                  "`tweend doctor` says more",
                                                  kMajor, kMinor, tried));
}

EglContext::~EglContext() {
  if (display_ == nullptr) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (context_ != nullptr) eglDestroyContext(display_, context_);
  // The display stays initialized: it belongs to the process, and another context may be at work on it.
  eglReleaseThread();
}

}  // namespace tweend::render
