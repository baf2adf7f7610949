"""The self-test of check_layers.py: a tree that breaks nothing, and for each rule a file that breaks it alone."""
import tempfile
from pathlib import Path

# (file, line to put in it, part of the finding expected). An empty expectation: it must pass.
CASES = [
    # Paths
    ("server/stage/a.cpp", '#include "player.hpp"', "a path from the root"),
    ("server/stage/a.cpp", '#include "../model/scene.hpp"', "a path from the root"),
    ("server/stage/a.cpp", "#include <server/model/scene.hpp>", "in quotes"),
    ("server/stage/a.cpp", '  #  include "server/net/outbox.hpp"', "'stage' does not see 'net'"),
    ("server/stage/a.cpp", '#include "server/attic/old.hpp"', "no layer is called 'attic'"),
    ("server/attic/a.cpp", "", "no layer is called 'attic'"),
    ("server/net/a.cpp", '#include "tests/support/meshes.hpp"', "does not see tests"),
    ("server/net/a.cpp", '#include "bench/clips.hpp"', "does not see tests"),
    ("server/net/a.cpp", '// #include "server/app/options.hpp"', ""),
    # JSON
    ("server/commands/a.cpp", "#include <nlohmann/json.hpp>", "JSON stays"),
    ("server/base/a.hpp", "#include <nlohmann/json_fwd.hpp>", "JSON stays"),
    ("protocol/a.hpp", "#include <nlohmann/json.hpp>", "JSON stays"),
    ("protocol/a.cpp", "#include <nlohmann/json.hpp>", ""),
    ("server/assets/a.cpp", "#include <nlohmann/json.hpp>", ""),
    ("server/assets/a.hpp", "#include <nlohmann/json.hpp>", "JSON stays"),
    ("protocol/json_node.hpp", "#include <nlohmann/json.hpp>", ""),
    ("server/commands/a.hpp", '#include "protocol/json_value.hpp"', ""),
    ("clients/cli/a.hpp", "#include <nlohmann/json.hpp>", ""),
    ("protocol/a.cpp", '#include "protocol/json_node.hpp"', ""),
    ("protocol/a.hpp", '#include "protocol/json_node.hpp"', "private header"),
    ("server/commands/a.cpp", '#include "protocol/json_node.hpp"', "private header"),
    # Sockets
    ("server/animation/a.cpp", "#include <boost/asio/post.hpp>", "does not see Asio"),
    ("server/base/a.cpp", "#include <boost/asio/thread_pool.hpp>", ""),
    ("server/base/a.hpp", "#include <boost/asio/thread_pool.hpp>", "Asio stays in .cpp files"),
    ("server/model/a.cpp", "#include <boost/asio.hpp>", "does not see Asio"),
    ("server/assets/a.cpp", "#include <boost/asio/post.hpp>", "does not see Asio"),
    ("protocol/a.cpp", "#include <boost/asio/buffer.hpp>", "does not see Asio"),
    ("server/commands/a.hpp", "#include <boost/asio/post.hpp>", "Asio stays in .cpp files"),
    ("server/commands/a.cpp", "#include <boost/asio/post.hpp>", ""),
    ("server/stage/a.hpp", "#include <boost/asio/strand.hpp>", ""),
    ("server/streams/a.hpp", "#include <boost/asio/strand.hpp>", ""),
    ("server/net/a.hpp", "#include <boost/asio/awaitable.hpp>", ""),
    ("server/stage/a.cpp", "#include <boost/beast/core.hpp>", "does not see Beast"),
    ("server/streams/a.hpp", "#include <boost/beast/core.hpp>", "does not see Beast"),
    ("server/net/a.hpp", "#include <boost/beast/core.hpp>", ""),
    ("clients/cli/a.cpp", "#include <boost/beast/websocket.hpp>", ""),
    ("clients/cli/a.hpp", "#include <boost/beast/websocket.hpp>", "Beast stays in .cpp files"),
    # GL
    ("server/app/a.cpp", "#include <epoxy/gl.h>", "only render/ speaks to the GPU"),
    ("server/streams/a.cpp", "#include <EGL/egl.h>", "only render/ speaks to the GPU"),
    ("server/streams/a.cpp", "#include <GL/gl.h>", "only render/ speaks to the GPU"),
    # Pure animation
    ("server/animation/a.cpp", "#include <algorithm>", ""),
    ("server/animation/a.cpp", "#include <glm/vec3.hpp>", ""),
    ("server/animation/a.cpp", "#include <hwy/highway.h>", ""),
    ("server/animation/a.cpp", '#include "server/base/result.hpp"', ""),
    ("server/animation/a.cpp", "#include <chrono>", "sees no clock"),
    ("server/animation/a.cpp", '#include "server/base/clock.hpp"', "sees no clock"),
    ("server/animation/a.hpp", "#include <thread>", "sees no thread or lock"),
    ("server/animation/a.hpp", "#include <mutex>", "sees no thread or lock"),
    ("server/animation/a.cpp", '#include "server/base/published.hpp"', "sees no thread or lock"),
    ("server/animation/a.cpp", "#include <fstream>", "sees no file or stream"),
    ("server/animation/a.cpp", '#include "server/base/log.hpp"', "sees no log"),
    ("server/animation/a.cpp", "#include <fmt/format.h>", "animation sees the standard library"),
    ("server/animation/a.cpp", "#include <sys/socket.h>", "animation sees the standard library"),
    # Clocks
    ("server/model/a.cpp", "const auto now = steady_now_us();", "nothing below stage reads a clock"),
    ("protocol/a.cpp", "const auto now = std::chrono::steady_clock::now();", "nothing below stage reads a clock"),
    ("server/assets/a.cpp", "// steady_now_us() is the caller's", ""),
    ("server/stage/a.cpp", "const auto now = steady_now_us();", ""),
    # Size
    ("server/stage/a.cpp", "\n" * 451, "451 lines"),
    ("tests/stage/a.cpp", "\n" * 451, "451 lines"),
    ("server/stage/a.cpp", "\n" * 450, ""),
    # Error codes
    ("server/base/error_codes.def", 'TWEEND_ERROR(Unused, "unused", -32001, "never")', "ErrorCode::Unused is used nowhere"),
    ("server/base/error_codes.def", 'TWEEND_ERROR(Used, "used", -32001, "by the clean tree")', ""),
]


def layer_cases(layers: dict, outside: dict):
    """Every pair of layers: allowed ones pass, all others are found."""
    folders = {layer: f"server/{layer}" for layer in layers} | {layer: folder for folder, layer in outside.items()}
    for source, below in layers.items():
        for target in layers:
            allowed = target == source or target in below
            expected = "" if allowed else f"'{source}' does not see '{target}'"
            yield f"{folders[source]}/a.cpp", f'#include "{folders[target]}/thing.hpp"', expected


def run_case(checker, file: str, text: str, expected: str) -> str | None:
    """What went wrong, or None."""
    with tempfile.TemporaryDirectory(prefix="tweend_layers_") as folder:
        root = Path(folder)
        clean = {"server/base/used.cpp": "auto code = ErrorCode::Used;\n", file: text + "\n" if text[-1:] != "\n" else text}
        for name, content in clean.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(content, encoding="utf-8")
        found = checker.check(root)
    if not expected:
        return f"expected no finding, found: {'; '.join(map(str, found))}" if found else None
    if any(expected in str(f) and str(f).startswith(file + ":") for f in found):
        return None
    return f"expected a finding with '{expected}', found: {'; '.join(map(str, found)) or 'none'}"


def no_cycles(layers: dict) -> list[str]:
    """The table itself: whoever stands below a layer must not see it."""
    return [f"{a} and {b} see each other" for a in layers for b in layers[a] if a in layers[b]] + [
        f"'{a}' names '{b}', which is no layer" for a in layers for b in layers[a] if b not in layers]


def run(checker) -> int:
    cases = CASES + list(layer_cases(checker.LAYERS, checker.OUTSIDE_SERVER))
    failed = no_cycles(checker.LAYERS)
    for file, text, expected in cases:
        if wrong := run_case(checker, file, text, expected):
            failed.append(f"{file} with {text.splitlines()[0] if text.strip() else 'its length'!r}: {wrong}")
    for line in failed:
        print(line)
    print(f"{len(cases)} cases, {len(failed)} failed")
    return 1 if failed else 0
