#!/usr/bin/python3
"""Keeps the source tree in the shape that docs/ARCHITECTURE.md draws.

    check_layers.py [ROOT]      check the tree (default: the checkout this file lies in)
    check_layers.py --self-test check the checker: each rule on a small tree that breaks it

Rules: a layer includes only layers below it; third-party headers stay where they belong; `animation` is pure; nothing
below `stage` reads a clock; every error code is used; no file is too long. Each finding is one line, FILE:LINE: what
was found and why it is wrong; the last line is the count, and the exit code 1 if there was any.
"""
import re
import sys
from pathlib import Path
from typing import Callable, Iterator, NamedTuple

sys.dont_write_bytecode = True
import cases  # noqa: E402  beside this file: what the self-test expects of each rule

# ----------------------------------------------------------------------------------------------------------- the table
# Layer -> the layers it may include. Arrows point down only.
LAYERS: dict[str, tuple[str, ...]] = {
    "base": (),
    "animation": ("base",),
    "model": ("animation", "base"),
    "protocol": ("base",),
    "assets": ("model", "animation", "base"),
    "store": ("model", "base"),
    "render": ("base",),
    "stage": ("store", "model", "animation", "base"),
    "streams": ("render", "stage", "protocol", "model", "animation", "base"),
    "commands": ("streams", "render", "stage", "store", "assets", "protocol", "model", "animation", "base"),
    "net": ("commands", "streams", "render", "protocol", "base"),
    "app": ("net", "commands", "streams", "stage", "store", "assets", "render", "protocol", "model", "animation", "base"),
    "cli": ("protocol", "base"),
}
OUTSIDE_SERVER = {"protocol": "protocol", "render": "render", "clients/cli": "cli"}
SOURCE_ROOTS = ("server", "protocol", "render", "clients")
ALL_ROOTS = SOURCE_ROOTS + ("tests", "bench")
SUFFIXES = (".hpp", ".cpp", ".h", ".inl", ".ipp", ".def")

LONG, TOO_LONG = 400, 450  # lines: from here a warning, from here an error


class Include(NamedTuple):
    file: str  # path under the root, with /
    line: int
    target: str  # what stands between the quotes or brackets
    quoted: bool

    @property
    def layer(self) -> str | None:
        return layer_of(self.file)

    @property
    def in_header(self) -> bool:
        return not self.file.endswith(".cpp")


class Finding(NamedTuple):
    file: str
    line: int
    text: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.text}"


def layer_of(path: str) -> str | None:
    """The layer a path under the root (or an include's target) belongs to; None: it is in no layer."""
    for folder, layer in OUTSIDE_SERVER.items():
        if path.startswith(folder + "/"):
            return layer
    parts = path.split("/")
    if len(parts) > 2 and parts[0] == "server":
        return parts[1]
    return None


# ------------------------------------------------------------------------------------------- rules for single includes
# Each answers why the include is wrong, or None.

def known_path(inc: Include) -> str | None:
    ours = inc.target.startswith(tuple(r + "/" for r in ALL_ROOTS))
    if inc.quoted and not ours:
        return "a quoted include is a path from the root of the checkout"
    if not inc.quoted and ours:
        return "our own headers are included in quotes"
    return None


def arrows_down(inc: Include) -> str | None:
    if not inc.quoted:
        return None
    if inc.target.startswith(("tests/", "bench/")):
        return "what is shipped does not see tests or benchmarks"
    source, target = inc.layer, layer_of(inc.target)
    if source is None or target is None or source == target or target in LAYERS.get(source, ()):
        return None
    if target not in LAYERS:
        return f"no layer is called '{target}'; tests/layering has the table"
    below = ", ".join(LAYERS.get(source, ())) or "nothing of ours"
    return f"'{source}' does not see '{target}'; it may include {below}"


JSON_PRIVATE_HEADER = "protocol/json_node.hpp"
JSON_IN_SOURCES = ("protocol", "assets")  # the wire, and files that are JSON


def json_stays_in_protocol(inc: Include) -> str | None:
    if inc.target == JSON_PRIVATE_HEADER and (inc.layer != "protocol" or inc.in_header):
        return "it is the protocol layer's private header: for its .cpp files only"
    if not inc.target.startswith("nlohmann/"):
        return None
    if inc.layer == "cli" or inc.file == JSON_PRIVATE_HEADER or (inc.layer in JSON_IN_SOURCES and not inc.in_header):
        return None
    return "JSON stays in the .cpp files of protocol/ and server/assets, and in clients/cli; pass structs"


ASIO_NEVER = ("animation", "model", "protocol", "assets")
ASIO_IN_HEADERS = ("net", "streams", "stage")
BEAST_ALLOWED = ("net", "cli")
BEAST_IN_HEADERS = ("net",)


def sockets_stay_in_net(inc: Include) -> str | None:
    for prefix, never, headers in (
        ("boost/asio", lambda layer: layer in ASIO_NEVER, ASIO_IN_HEADERS),
        ("boost/beast", lambda layer: layer not in BEAST_ALLOWED, BEAST_IN_HEADERS),
    ):
        if not inc.target.startswith(prefix):
            continue
        name = {"boost/asio": "Asio", "boost/beast": "Beast"}[prefix]
        if never(inc.layer):
            return f"'{inc.layer}' does not see {name}"
        if inc.in_header and inc.layer not in headers:
            return f"{name} stays in .cpp files here; in headers only of {', '.join(headers)}"
    return None


def gl_stays_in_render(inc: Include) -> str | None:
    if inc.layer != "render" and re.match(r"(GL|GLES\d?|EGL|KHR|epoxy|GLFW|glad)/|gbm\.h$", inc.target):
        return "only render/ speaks to the GPU; pass spans and matrices"
    return None


ANIMATION_STD_FORBIDDEN = {
    "a clock": ("chrono", "ctime"),
    "a thread or lock": ("thread", "mutex", "shared_mutex", "condition_variable", "future", "semaphore", "latch", "barrier",
                         "stop_token"),
    "a file or stream": ("fstream", "filesystem", "iostream", "istream", "ostream", "cstdio", "print"),
}
ANIMATION_BASE_FORBIDDEN = {
    "a clock": ("clock.hpp",),
    "a thread or lock": ("published.hpp",),
    "a log": ("log.hpp",),
}


def animation_is_pure(inc: Include) -> str | None:
    if inc.layer != "animation":
        return None
    table, name = ANIMATION_STD_FORBIDDEN, inc.target
    if inc.quoted:
        table, name = ANIMATION_BASE_FORBIDDEN, inc.target.removeprefix("server/base/")
    for what, names in table.items():
        if name in names:
            return f"animation is pure mathematics: it sees no {what.removeprefix('a ')}"
    standard = re.fullmatch(r"[a-z_0-9]+", inc.target)
    if inc.quoted or standard or inc.target.startswith(("glm/", "hwy/")):
        return None
    return "animation sees the standard library, GLM, Highway and base only"


INCLUDE_RULES: tuple[Callable[[Include], str | None], ...] = (
    known_path, arrows_down, json_stays_in_protocol, sockets_stay_in_net, gl_stays_in_render, animation_is_pure)

# --------------------------------------------------------------------------------------------------- rules for the text
CLOCKLESS = ("animation", "model", "protocol", "assets", "render")
CLOCK_READING = re.compile(r"\b(steady_now_us\s*\(|\w*[Cc]lock::now\s*\(|clock_gettime\s*\(|gettimeofday\s*\()")


def reads_no_clock(file: str, lines: list[str]) -> Iterator[Finding]:
    if layer_of(file) not in CLOCKLESS:
        return
    for number, line in enumerate(lines, 1):
        if found := CLOCK_READING.search(line.split("//")[0]):
            yield Finding(file, number, f"{found[1].rstrip('( ')}: nothing below stage reads a clock; pass the time")


def length(file: str, lines: list[str]) -> Iterator[Finding]:
    if file.endswith((".cpp", ".hpp")) and len(lines) > TOO_LONG:
        yield Finding(file, TOO_LONG + 1, f"{len(lines)} lines; past {TOO_LONG} a file says too many things: split it")


# ------------------------------------------------------------------------------------------------------ the whole tree

def files_below(root: Path) -> Iterator[tuple[str, list[str]]]:
    for top in ALL_ROOTS:
        for path in sorted((root / top).rglob("*")):
            if path.suffix in SUFFIXES and path.is_file():
                yield path.relative_to(root).as_posix(), path.read_text(encoding="utf-8").splitlines()


INCLUDE_LINE = re.compile(r'\s*#\s*include\s*(["<])([^">]+)[">]')


def includes(file: str, lines: list[str]) -> Iterator[Include]:
    for number, line in enumerate(lines, 1):
        if found := INCLUDE_LINE.match(line):
            yield Include(file, number, found[2], found[1] == '"')


ERROR_CODES = "server/base/error_codes.def"


def unused_error_codes(tree: dict[str, list[str]]) -> Iterator[Finding]:
    shipped = "\n".join("\n".join(lines) for file, lines in tree.items() if file.startswith(SOURCE_ROOTS))
    used = set(re.findall(r"\bErrorCode::(\w+)", shipped))
    for number, line in enumerate(tree.get(ERROR_CODES, []), 1):
        if (found := re.match(r"TWEEND_ERROR\((\w+)", line)) and found[1] not in used:
            yield Finding(ERROR_CODES, number, f"ErrorCode::{found[1]} is used nowhere; remove it or use it")


def check(root: Path) -> list[Finding]:
    tree = dict(files_below(root))
    findings: list[Finding] = []
    for file, lines in tree.items():
        findings += length(file, lines)
        if not file.startswith(SOURCE_ROOTS):
            continue
        layer = layer_of(file)
        if layer is not None and layer not in LAYERS:
            findings.append(Finding(file, 1, f"no layer is called '{layer}'; add it to the table in tests/layering"))
        findings += reads_no_clock(file, lines)
        for inc in includes(file, lines):
            findings += (Finding(inc.file, inc.line, f"{inc.target}: {why}") for rule in INCLUDE_RULES if (why := rule(inc)))
    findings += unused_error_codes(tree)
    return findings


def warn_of_long_files(root: Path) -> None:
    for file, lines in files_below(root):
        if file.endswith((".cpp", ".hpp")) and LONG < len(lines) <= TOO_LONG:
            print(f"warning: {file}: {len(lines)} lines; {TOO_LONG} is the limit")


def main(arguments: list[str]) -> int:
    if arguments == ["--self-test"]:
        return cases.run(sys.modules[__name__])
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parents[2]
    if not any((root / top).is_dir() for top in SOURCE_ROOTS):
        sys.exit(f"{root}: expected a checkout of tweend, found none of {', '.join(SOURCE_ROOTS)}")
    warn_of_long_files(root)
    findings = check(root)
    for finding in findings:
        print(finding)
    print(f"{len(findings)} layering finding(s)")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
