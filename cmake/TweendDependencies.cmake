# Everything comes from Debian 12's packages; `./dev setup` holds the list of their names.
find_package(Threads REQUIRED)
find_package(Boost 1.81 REQUIRED)            # Asio and Beast, header-only
find_package(spdlog REQUIRED)
find_package(hwy REQUIRED)
find_package(meshoptimizer REQUIRED)           # EXT_meshopt_compression, streams of vertices
find_package(PkgConfig REQUIRED)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)          # EGL and OpenGL, found at run time
pkg_check_modules(SPNG REQUIRED IMPORTED_TARGET spng)
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
if(TWEEND_H264)
  pkg_check_modules(FFMPEG REQUIRED IMPORTED_TARGET libavcodec libavformat libavutil)   # H.264, MP4
  find_path(TWEEND_YUV_DIR libyuv.h REQUIRED)                      # from RGB to what H.264 is made of
  find_library(TWEEND_YUV_LIBRARY yuv REQUIRED)
endif()
find_path(TWEEND_GLM_DIR glm/glm.hpp REQUIRED)
find_path(TWEEND_JSON_DIR nlohmann/json.hpp REQUIRED)
find_path(TWEEND_CLI11_DIR CLI/CLI.hpp REQUIRED)
if(TWEEND_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()

# Use ccache where it is installed: a second build from nothing then takes seconds.
find_program(TWEEND_CCACHE ccache)
if(TWEEND_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${TWEEND_CCACHE}")
endif()
