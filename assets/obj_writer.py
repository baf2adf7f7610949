"""Writes an asset: a folder NAME with an OBJ for each keyframe, their common material NAME.mtl and its texture NAME.png.

The number in NAME_000010.obj is the keyframe's frame. All files have the same faces, so that any two keyframes blend.
"""
import os

from png_writer import png


def write_asset(folder, name, mesh, keyframes, texture):
    """Rewrites the folder. `keyframes` is {frame: positions}, `texture` as `png` takes it."""
    os.makedirs(folder, exist_ok=True)
    for old in os.listdir(folder):
        os.remove(os.path.join(folder, old))
    for file_name, content in asset_files(name, mesh, keyframes, texture).items():
        with open(os.path.join(folder, file_name), "wb") as out:
            out.write(content)


def asset_files(name, mesh, keyframes, texture):
    """{file name: bytes} of the whole folder."""
    files = {f"{name}_{frame:06d}.obj": obj(name, mesh, positions).encode("ascii") for frame, positions in keyframes.items()}
    files[f"{name}.mtl"] = mtl(name).encode("ascii")
    files[f"{name}.png"] = png(texture)
    return files


def obj(name, mesh, positions):
    lines = [f"# A keyframe of tweend's demo asset {name}, made by make_{name}.py", f"mtllib {name}.mtl", f"o {name}"]
    lines += ["v " + " ".join(map(number, p)) for p in positions]
    lines += [f"vt {number(u)} {number(v)}" for u, v in mesh.texcoords]
    lines += ["vn " + " ".join(number(x, 4) for x in n) for n in mesh.normals(positions)]
    lines += [f"usemtl {name}", "s off"]
    lines += ["f " + " ".join(f"{v + 1}/{vt + 1}/{vn + 1}" for v, vt, vn in face) for face in mesh.faces]
    return "\n".join(lines) + "\n"


def mtl(name):
    return f"newmtl {name}\nKd 1 1 1\nmap_Kd {name}.png\n"


def number(x, decimals=5):
    """Short, without exponents, and the same on every machine: what differs in a last bit of a sine is rounded away."""
    text = f"{x:.{decimals}f}".rstrip("0").rstrip(".")
    return "0" if text in ("", "-0") else text
