# tweend_flags: what every target of ours is compiled with.
add_library(tweend_flags INTERFACE)
target_compile_features(tweend_flags INTERFACE cxx_std_20)
target_include_directories(tweend_flags INTERFACE "${PROJECT_SOURCE_DIR}")
target_include_directories(tweend_flags SYSTEM INTERFACE "${TWEEND_GLM_DIR}" "${TWEEND_JSON_DIR}")
target_compile_options(tweend_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor
  -Woverloaded-virtual -Wcast-align
  # GCC 12 sees overlaps in string concatenation that are not there (its bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  $<$<BOOL:${TWEEND_WERROR}>:-Werror>)
# Boost.Asio: no handlers through exceptions-as-strings; GLM: column-major, no implicit defaults.
target_compile_definitions(tweend_flags INTERFACE
  BOOST_ASIO_NO_DEPRECATED GLM_FORCE_XYZW_ONLY TWEEND_VERSION="${PROJECT_VERSION}")
if(TWEEND_SANITIZE)
  target_compile_options(tweend_flags INTERFACE -fsanitize=${TWEEND_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(tweend_flags INTERFACE -fsanitize=${TWEEND_SANITIZE})
  # GCC reports false positives of these under sanitizers.
  target_compile_options(tweend_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized -Wno-stringop-overflow -Wno-tsan>)
endif()

# tweend_layer(NAME SOURCES ... DEPENDS lower layers ... SYSTEM third-party targets ...)
# One static library a layer, alias tweend::NAME. A layer that is not named in DEPENDS can't be linked,
# and tests/layering rejects its headers.
function(tweend_layer name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS;SYSTEM" ${ARGN})
  add_library(tweend_${name} STATIC ${arg_SOURCES})
  add_library(tweend::${name} ALIAS tweend_${name})
  target_link_libraries(tweend_${name} PUBLIC tweend_flags)
  foreach(layer IN LISTS arg_DEPENDS)
    target_link_libraries(tweend_${name} PUBLIC tweend::${layer})
  endforeach()
  target_link_libraries(tweend_${name} PUBLIC ${arg_SYSTEM})
endfunction()

# What the tsan run builds: the tests with the label `concurrent`, and the programs that end-to-end tests start.
add_custom_target(concurrent_tests)

# tweend_test(NAME SOURCES ... LIBS ... [CONCURRENT])
# One GoogleTest program; CONCURRENT ones carry the CTest label that the tsan run selects.
function(tweend_test name)
  cmake_parse_arguments(arg "CONCURRENT" "" "SOURCES;LIBS" ${ARGN})
  add_executable(test_${name} ${arg_SOURCES})
  target_link_libraries(test_${name} PRIVATE tweend_flags ${arg_LIBS} GTest::gtest_main GTest::gmock)
  set(labels "")
  if(arg_CONCURRENT)
    set(labels LABELS concurrent)
    add_dependencies(concurrent_tests test_${name})
  endif()
  gtest_discover_tests(test_${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 300 ${labels})
endfunction()
