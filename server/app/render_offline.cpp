#include "server/app/render_offline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <future>
#include <iostream>
#include <iterator>
#include <optional>
#include <utility>

#include "render/image_encoder.hpp"
#include "server/app/asset_path.hpp"
#include "server/app/contact_sheet.hpp"
#include "server/app/numbered_name.hpp"
#include "server/app/offline_scene.hpp"
#include "server/app/render_film.hpp"
#include "server/app/report.hpp"
#include "server/streams/still.hpp"

namespace tweend::app {
namespace {

namespace fs = std::filesystem;

enum class FileKind { Png, Jpeg };

Result<FileKind> kind_of(const std::string& name) {
  std::string extension = fs::path(name).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".png") return FileKind::Png;
  if (extension == ".jpg" || extension == ".jpeg") return FileKind::Jpeg;
  return fail(ErrorCode::InvalidParams,
              fmt::format("expected a name that ends with .png, .jpg or .jpeg after --output, found \"{}\"", name));
}

Status write_file(const std::string& name, const std::vector<std::byte>& bytes) {
  std::ofstream file(name, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (file) return {};
  return fail(ErrorCode::Unavailable, fmt::format("expected a file that can be written at {}, found: {}", name,
                                                  std::error_code(errno, std::generic_category()).message()));
}

Result<streams::DrawnStill> draw(const OfflineScene& scene, double time_s, render::Size size) {
  const commands::Services& services = scene.services();
  streams::StillRequest request;
  request.view = scene.view();
  request.time_s = time_s;
  request.size = size;
  request.camera = scene.camera();
  std::promise<Result<streams::DrawnStill>> promise;
  streams::draw_still(std::move(request), services.workers, services.renderer,
                      [&promise](Result<streams::DrawnStill> drawn) { promise.set_value(std::move(drawn)); });
  return promise.get_future().get();
}

Status write(const std::string& name, const render::ImageView& image, int quality) {
  TWEEND_ASSIGN(const FileKind kind, kind_of(name));
  TWEEND_ASSIGN(const std::vector<std::byte> file,
                kind == FileKind::Jpeg ? render::encode_jpeg(image, quality) : render::encode_png(image));
  TWEEND_TRY(write_file(name, file));
  std::cout << fmt::format("{}: {} x {}, {:.1f} kB\n", name, image.size.width, image.size.height,
                           static_cast<double>(file.size()) / 1000.0);
  return {};
}

Status draw_pictures(const OfflineOptions& o, const OfflineScene& scene) {
  std::optional<ContactSheet> sheet;
  if (o.sheet) {
    TWEEND_TRY(ContactSheet::check(o.size, o.times_s.size()));
    sheet.emplace(o.size, o.times_s.size());
  }
  Report report(o.times_s.size());
  for (std::size_t i = 0; i < o.times_s.size(); ++i) {
    TWEEND_ASSIGN(const streams::DrawnStill drawn, draw(scene, o.times_s[i], o.size));
    if (sheet) {
      sheet->put(i, drawn.pixels->view());
    } else {
      TWEEND_ASSIGN(const std::string name, numbered_name(o.output, i, o.times_s.size() > 1));
      TWEEND_TRY(write(name, drawn.pixels->view(), o.quality));
    }
    report.done(i + 1);
  }
  if (!sheet) return {};
  TWEEND_ASSIGN(const std::string name, numbered_name(o.output, 0, false));
  return write(name, sheet->view(), o.quality);
}

Status check_output(const OfflineOptions& o) {
  if (!o.mp4.empty()) return check_film(o);
  TWEEND_TRY(numbered_name(o.output, 0, !o.sheet && o.times_s.size() > 1));
  TWEEND_TRY(kind_of(o.output));
  return {};
}

Status draw_all(const OfflineOptions& o, const OfflineScene& scene) {
  TWEEND_TRY(scene.check_camera());
  return o.mp4.empty() ? draw_pictures(o, scene) : render_film(o, scene);
}

/// What is wrong in a file of edits, which it is told as the parameters of `edit.apply`.
Error in_file(const std::string& path, Error error) {
  constexpr std::string_view kParams = "params.";
  const std::string_view at = std::string_view(error.path).starts_with(kParams)
                                  ? std::string_view(error.path).substr(kParams.size())
                                  : std::string_view(error.path);
  error.path = at.empty() ? path : fmt::format("{}: {}", path, at);
  return error;
}

/// A file of edits: its assets are those of its folder, or of the one that was named.
Status run_scene(const OfflineOptions& options) {
  const std::string& path = options.assets.front();
  if (!options.interpolation.empty() || options.closed || options.duration_s > 0.0) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected {} to say how its clips are, found --interpolation, --closed or "
                            "--duration beside it",
                            path));
  }
  TWEEND_ASSIGN(const AssetPath source, locate_asset(path));
  std::ifstream file(path, std::ios::binary);
  const std::string json{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) return fail(ErrorCode::NotFound, fmt::format("expected a file of edits that can be read at {}, found none", path));
  TWEEND_ASSIGN(std::vector<assets::AssetRoot> roots,
                open_roots({options.assets_folder.empty() ? source.folder : options.assets_folder}));
  OfflineScene scene(options, std::move(roots));
  TWEEND_TRY(scene.start());
  if (const Status shown = scene.show_edits(json); !shown) return in_file(path, shown.error());
  return draw_all(options, scene);
}

Status run(const OfflineOptions& options) {
  TWEEND_TRY(check_output(options));
  if (options.is_scene()) return run_scene(options);
  for (const std::string& path : options.assets) {
    if (path.ends_with(".json")) {
      return fail(ErrorCode::InvalidParams,
                  fmt::format("expected a file of edits alone, found {} among {} assets; let it name the others", path,
                              options.assets.size()));
    }
  }
  if (options.interpolation.size() > options.assets.size()) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected at most one --interpolation for each of {} asset{}, found {}", options.assets.size(),
                            options.assets.size() == 1 ? "" : "s", options.interpolation.size()));
  }
  std::vector<AssetPath> sources;
  std::vector<std::string> folders;
  for (const std::string& path : options.assets) {
    TWEEND_ASSIGN(AssetPath source, locate_asset(path));
    for (const AssetPath& other : sources) {
      if (other.name == source.name && other.folder != source.folder) {
        return fail(ErrorCode::InvalidParams,
                    fmt::format("expected assets of different names, found {0}/{2} and {1}/{2}; rename one", other.folder,
                                source.folder, source.name));
      }
    }
    if (std::find(folders.begin(), folders.end(), source.folder) == folders.end()) folders.push_back(source.folder);
    sources.push_back(std::move(source));
  }
  TWEEND_ASSIGN(std::vector<assets::AssetRoot> roots, open_roots(folders));
  OfflineScene scene(options, std::move(roots));
  TWEEND_TRY(scene.start());
  TWEEND_TRY(scene.show(sources));
  return draw_all(options, scene);
}

}  // namespace

int render_offline(const OfflineOptions& options) {
  const Status status = run(options);
  if (status) return 0;
  const Error& error = status.error();
  std::cerr << "tweend: " << error.path << (error.path.empty() ? "" : ": ") << error.message << '\n';
  return 1;
}

}  // namespace tweend::app
