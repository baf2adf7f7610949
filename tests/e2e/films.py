"""Films in tests: what FFmpeg's programs read from them. `read` fails at the first word of complaint."""
import json
import subprocess
from fractions import Fraction

from client import ProtocolError
from pictures import Picture


def run(*command, stdin=b""):
    done = subprocess.run([*map(str, command)], input=stdin, capture_output=True, timeout=60)
    if done.returncode or done.stderr:
        raise ProtocolError(f"{command[0]} says: {done.returncode} {done.stderr.decode(errors='replace')[:2000]}")
    return done.stdout


def decoded(width, height, *source, stdin=b""):
    """The pictures that FFmpeg reads from a source."""
    data = run("ffmpeg", "-v", "warning", *source, "-f", "rawvideo", "-pix_fmt", "rgb24", "-fps_mode", "passthrough", "-", stdin=stdin)
    size = width * height * 3
    return [Picture(width, height, data[i:i + size]) for i in range(0, len(data), size)]


def decode_h264(stream, width, height):
    """The pictures of a raw stream of H.264, of which each decodes."""
    return decoded(width, height, "-f", "h264", "-i", "-", stdin=stream)


class Film:
    """Times are exact seconds; pictures are decoded as they are asked for."""

    def __init__(self, path):
        self.path = path
        probed = json.loads(run("ffprobe", "-v", "warning", "-of", "json", "-show_entries",
                                "stream=time_base,width,height,codec_name,pix_fmt,color_space,color_range,duration_ts,nb_frames:"
                                "packet=pts,flags", path))
        (self.stream,) = probed["streams"]
        base = Fraction(self.stream["time_base"])
        self.times = [p["pts"] * base for p in probed["packets"]]
        self.keys = [i for i, p in enumerate(probed["packets"]) if "K" in p["flags"]]
        self.duration = self.stream["duration_ts"] * base
        self.size = self.stream["width"], self.stream["height"]
        assert int(self.stream["nb_frames"]) == len(self.times), self.stream
        assert (self.stream["codec_name"], self.stream["pix_fmt"]) == ("h264", "yuv420p"), self.stream
        assert (self.stream["color_space"], self.stream["color_range"]) == ("smpte170m", "tv"), self.stream

    def pictures(self):
        """All of them, decoded: as many as there are times."""
        shown = decoded(*self.size, "-i", self.path)
        assert len(shown) == len(self.times), (len(shown), len(self.times))
        return shown


def distance(a, b):
    """The mean difference of two pictures' channels, 0 to 255."""
    assert (a.width, a.height) == (b.width, b.height)
    return sum(abs(x - y) for x, y in zip(a.rgb, b.rgb)) / len(a.rgb)
