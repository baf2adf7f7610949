"""What pictures show: colours, light, transforms, what hides what, materials, keyframes, and the whole of a loop."""
import math
import os

import harness
import pictures
from pictures import BASE, QUAD, STRAIGHT, Picture

RED, GREEN, BLUE, YELLOW, GREY = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0), (100, 150, 200)
# Not its own mirror image in any direction.
FLAG = {"positions": [-2, -1, 0, 1, -1, 0, 0, 3, 0], "indices": [0, 1, 2]}


def srgb(linear):
    """As a byte of a picture holds it; not for what is nearly black."""
    return 255 * (1.055 * linear ** (1 / 2.4) - 0.055)


class Light(pictures.PictureCase):
    def setUp(self):
        super().setUp()
        self.add_quad(transform={"scale": [4, 4, 4]})
        self.straight()

    def lit(self, **terms):
        self.c.call("light.set", **terms)
        return self.picture()

    def test_what_faces_the_camera_in_even_light_has_its_own_colour(self):
        picture = self.picture()
        self.spans(picture, (10, 10, 90, 90))
        for x, y in ((50, 50), (20, 20), (80, 20), (20, 80), (80, 80)):
            self.coloured(picture, x, y, BASE)

    def test_each_term_makes_it_brighter(self):
        for name in ("ambient", "diffuse", "specular"):
            self.c.call("light.set", ambient=0.1, diffuse=0.1, specular=0.1, shininess=2, position=[0, 0, 5])
            levels = [self.lit(**{name: value}).brightness() for value in (0, 0.2, 0.5, 0.9)]
            self.assertEqual(levels, sorted(set(levels)), name)

    def test_without_any_light_it_is_black(self):
        self.coloured(self.lit(ambient=0, diffuse=0, specular=0), 50, 50, (0, 0, 0))

    def test_ambient_light_is_linear_and_the_picture_srgb(self):
        """Half the light is 188 of 255, not 128."""
        self.coloured(self.lit(ambient=0.5), 50, 50, (93, 93, 188))

    def test_more_comes_from_above_than_from_below(self):
        self.c.call("light.set", ambient=0.5)
        for up, factor in ((1, 1.3), (-1, 0.7)):
            lying = {"rotation": [-up * math.sqrt(0.5), 0, 0, math.sqrt(0.5)], "scale": [4, 4, 4]}
            self.c.call("actor.update", transform=lying)
            picture = self.picture(camera={"eye": [0, up * 10, 0], "up": [0, 0, 1]})
            self.assertAlmostEqual(picture.at(50, 50)[2], srgb(0.5 * factor), delta=1.5)

    def test_the_side_towards_the_light_is_brighter(self):
        left = self.lit(ambient=0, diffuse=1, position=[-4, 0, 1])
        self.assertGreater(left.at(15, 50)[2], left.at(85, 50)[2] + 50)
        right = self.lit(position=[4, 0, 1])
        self.assertGreater(right.at(85, 50)[2], right.at(15, 50)[2] + 50)
        above = self.lit(position=[0, 4, 1])
        self.assertGreater(above.at(50, 15)[2], above.at(50, 85)[2] + 50)

    def test_both_sides_are_lit(self):
        front = self.lit(ambient=0, diffuse=1, position=[0, 0, 3]).at(50, 50)
        behind = self.picture(camera=STRAIGHT | {"eye": [0, 0, -10]}).at(50, 50)
        self.assertEqual(behind, (0, 0, 0), "the light is on the other side")
        self.c.call("light.set", position=[0, 0, -3])
        self.coloured(self.picture(camera=STRAIGHT | {"eye": [0, 0, -10]}), 50, 50, front)
        self.assertEqual(self.picture().at(50, 50), (0, 0, 0))

    def test_a_shinier_surface_has_a_smaller_highlight(self):
        sizes = []
        for shininess in (4, 32, 256):
            picture = self.lit(ambient=0, diffuse=0, specular=1, position=[0, 0, 10], shininess=shininess)
            self.coloured(picture, 50, 50, (255, 255, 255), 2)
            sizes.append(sum(p[0] > 128 for p in picture.pixels()))
        self.assertGreater(sizes[0], sizes[1])
        self.assertGreater(sizes[1], sizes[2])


class Stage(pictures.PictureCase):
    def setUp(self):
        super().setUp()
        self.straight()

    def test_the_background(self):
        for colour, want in (((1, 0, 0.5), (255, 0, 128)), ((0, 0, 0), (0, 0, 0)), ((1, 1, 1), (255, 255, 255)), ((0.2, 0.4, 0.6), (51, 102, 153))):
            self.c.call("scene.update", background=list(colour))
            picture = self.picture()
            self.coloured(picture, 50, 50, want)
            self.assertEqual(picture.shown(), set(), "it is uniform")

    def test_the_grid(self):
        self.c.call("camera.set", eye=[3, 4, 5], target=[0, 0, 0])
        without = self.file()
        self.c.call("scene.update", grid=True)
        self.assertGreater(self.picture().differing(Picture.of_png(without), by=4), 0.01)
        self.c.call("scene.update", grid=False)
        self.assertEqual(self.file(), without)
        self.c.call("edit.undo")
        self.assertNotEqual(self.file(), without)

    def test_hidden_actors(self):
        empty = self.file()
        self.add_quad()
        shown = self.file()
        self.assertNotEqual(shown, empty)
        self.c.call("actor.update", visible=False)
        self.assertEqual(self.file(), empty)
        self.c.call("actor.update", visible=True)
        self.assertEqual(self.file(), shown)
        self.c.call("actor.remove", actor="quad")
        self.assertEqual(self.file(), empty)
        self.c.call("edit.undo")
        self.assertEqual(self.file(), shown)

    def test_what_is_nearer_hides_what_is_behind(self):
        """Whatever the order they came in."""
        self.c.call("light.set", ambient=0, diffuse=1, position=[0, 0, 30])
        for near, far in (("a", "b"), ("b", "a")):
            for actor in ("a", "b"):
                self.add_quad(actor, transform={"translation": [0, 0, 3 if actor == near else -3], "scale": [2, 2, 1]})
            both = self.picture()
            self.c.call("actor.update", actor=far, visible=False)
            self.assertEqual(self.picture(), both)
            for actor in ("a", "b"):
                self.c.call("actor.remove", actor=actor)

    def test_scenes_are_apart(self):
        self.add_quad()
        self.c.call("scene.create", scene="other")
        self.assertTrue(self.picture().shown())
        self.assertEqual(self.picture(scene="other").shown(), set())
        self.c.call("actor.add", scene="other", actor="x", mesh=QUAD)
        self.c.call("actor.remove", actor="quad")
        self.assertEqual(self.picture().shown(), set())
        self.assertTrue(self.picture(scene="other").shown())

    def test_transforms(self):
        self.add_quad()
        for transform, want in (({}, (40, 40, 60, 60)), ({"translation": [2, 1, 0]}, (60, 30, 80, 50)), ({"scale": [3, 0.5, 1]}, (20, 45, 80, 55)),
                                ({"translation": [-1, 0, 0], "scale": [2, 2, 2]}, (20, 30, 60, 70)),
                                ({"rotation": [0, 0, math.sin(math.pi / 8), math.cos(math.pi / 8)]}, (36, 36, 64, 64)),
                                ({"translation": [0, 0, 5]}, (30, 30, 70, 70))):
            whole = {"translation": [0, 0, 0], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]}
            self.c.call("actor.update", transform=whole | transform)
            self.spans(self.picture(), want)
            self.coloured(self.picture(), (want[0] + want[2]) // 2, (want[1] + want[3]) // 2, BASE)

    def test_a_negative_scale_is_a_mirror(self):
        self.c.call("actor.add", actor="flag", mesh=FLAG)
        self.c.call("light.set", ambient=0.1, diffuse=0.8, specular=0.3, shininess=20, position=[0, 0, 5])
        plain = self.picture()
        rows = [plain.row(y) for y in range(plain.height)]
        for scale, want in (([-1, 1, 1], [row[::-1] for row in rows]), ([1, -1, 1], rows[::-1]),
                            ([-1, -1, 1], [row[::-1] for row in rows[::-1]]), ([1, 1, -1], rows)):
            self.c.call("actor.update", transform={"scale": scale})
            mirrored = Picture(plain.width, plain.height, bytes(c for row in want for pixel in row for c in pixel))
            self.assertLess(self.picture().differing(mirrored, by=2), 0.01, f"scaled by {scale}")
            self.assertTrue(self.picture().shown())

    def test_uneven_scales_keep_the_light_straight(self):
        """A slope that is stretched along x is lit as the gentler slope it becomes."""
        self.c.call("light.set", ambient=0, diffuse=1, position=[0, 0, 1000])
        slope = {"positions": [-1, -1, 1, 1, -1, -1, 1, 1, -1, -1, 1, 1], "indices": QUAD["indices"]}
        self.c.call("actor.add", actor="slope", mesh=slope, transform={"scale": [3, 1, 1]})
        linear = 3 / math.sqrt(10)  # of the normal (1, 0, 3)
        self.assertAlmostEqual(self.picture().at(50, 50)[2], srgb(linear), delta=2)


class Materials(pictures.PictureCase):
    def show(self, mtl, textures, actor="board", **kw):
        """Two quads side by side: the left one of material `left`, the right one with texture coordinates of `right`."""
        folder = self.folder()
        obj = "mtllib board.mtl\n" + "".join(f"v {x} {y} 0\n" for x in (-4, 0, 4) for y in (-2, 2))
        obj += "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl left\nf 1 3 4 2\nusemtl right\nf 3/1 5/2 6/3 4/4\n"
        for name, content in [("board.obj", obj.encode()), ("board.mtl", mtl.encode()), *textures]:
            with open(os.path.join(folder, name), "wb") as f:
                f.write(content)
        self.server = self.serve(assets=[folder], render=True)
        self.c = self.server.line()
        self.c.call("actor.add", actor=actor, asset="board.obj")
        self.straight()
        return self.picture()

    def test_colours_and_textures(self):
        texture = pictures.png_of([[RED] * 8 + [GREEN] * 8] * 8 + [[GREY] * 8 + [YELLOW] * 8] * 8)
        picture = self.show("newmtl left\nKd 0 1 0\nnewmtl right\nmap_Kd four.png\n", [("four.png", texture)])
        self.spans(picture, (10, 30, 90, 70))
        self.coloured(picture, 30, 50, GREEN)
        for x, y, want in ((60, 40, RED), (80, 40, GREEN), (60, 60, GREY), (80, 60, YELLOW)):  # v goes up
            self.coloured(picture, x, y, want)

    def test_a_texture_is_srgb(self):
        picture = self.show("newmtl right\nKd 1 1 1\nmap_Kd grey.png\n", [("grey.png", pictures.png_of([[GREY] * 4] * 4))])
        self.coloured(picture, 70, 50, GREY)
        self.coloured(picture, 30, 50, BASE)

    def test_a_colour_is_srgb(self):
        picture = self.show("newmtl left\nKd 0.2 0.4 0.6\nnewmtl right\nKd 1 0 0\n", [])
        self.coloured(picture, 30, 50, (51, 102, 153))
        self.coloured(picture, 70, 50, RED)

    def test_a_jpeg_texture(self):
        self.c.call("scene.update", background=[1, 0.5, 0])
        jpeg = self.file(width=16, height=16, format="jpeg", quality=100)
        picture = self.show("newmtl right\nmap_Kd orange.jpg\n", [("orange.jpg", jpeg)])
        self.coloured(picture, 70, 50, (255, 128, 0), 4)

    def test_what_is_absent_shows_the_default_material(self):
        picture = self.show("newmtl left\nmap_Kd nowhere.png\n", [])
        self.coloured(picture, 30, 50, BASE)
        self.coloured(picture, 70, 50, BASE)

    def test_materials_stay_through_keyframes_and_undo(self):
        before = self.show("newmtl left\nKd 1 0 0\nnewmtl right\nKd 0 1 0\n", [])
        positions = self.c.call("vertices.sample")["positions"]
        self.c.call("keyframe.add", time=1, vertices={"positions": [p / 2 for p in positions]})
        self.coloured(self.picture(time=1), 45, 50, RED)
        self.coloured(self.picture(time=1), 55, 50, GREEN)
        self.c.call("actor.remove", actor="board")
        self.c.call("edit.undo")
        self.assertEqual(self.picture(time=0), before)


class Keyframes(pictures.PictureCase):
    def setUp(self):
        super().setUp()
        self.add_growing(keys=((0, 1), (1, 3), (1.5, 2), (3, 4)))
        self.straight()

    def agrees(self, time, **kw):
        """The picture's extent is that of the vertices."""
        positions = self.c.call("vertices.sample", time=time, **kw)["positions"]
        half = max(positions[0::3])
        self.spans(self.picture(time=time), (50 - 10 * half, 50 - 10 * half, 50 + 10 * half, 50 + 10 * half))
        return half

    def test_pictures_agree_with_vertices_sample(self):
        for mode in ("step", "linear", "catmull_rom"):
            self.c.call("actor.update", interpolation=mode)
            for time in (0, 0.3, 0.5, 0.9, 1, 1.2, 1.4, 2, 2.6, 3):
                self.agrees(time)

    def test_eased_and_closed_too(self):
        self.c.call("keyframe.update", keyframe=1, easing=[0.9, 0, 1, 0.2])
        self.c.call("clip.update", clip="default", closed=True, duration=4)
        for time in (0.3, 0.6, 0.9, 3.2, 3.5, 3.9):
            self.agrees(time)
        self.assertLess(self.agrees(0.5), 1.5, "it begins slowly")

    def test_edits_show_at_once(self):
        self.spans(self.picture(time=1), (20, 20, 80, 80))
        self.c.call("keyframe.update", keyframe=2, vertices={"positions": [0.5 * p for p in QUAD["positions"]]})
        self.spans(self.picture(time=1), (45, 45, 55, 55))
        self.c.call("edit.undo")
        self.spans(self.picture(time=1), (20, 20, 80, 80))
        self.c.call("keyframe.move", keyframe=2, time=0.5)
        self.spans(self.picture(time=0.5), (20, 20, 80, 80))
        self.c.call("keyframe.remove", keyframe=2)
        self.agrees(0.5)

    def test_a_clip_of_many_keyframes(self):
        """More than a graphics card may want to hold at once is no difference."""
        self.c.call("clip.create", clip="many")
        for i in range(200):
            self.c.call("keyframe.add", clip="many", time=i / 10, vertices={"positions": [(1 + i % 4) * p for p in QUAD["positions"]]})
        self.c.call("playback.play", clip="many")
        self.c.call("playback.pause")
        for i in (0, 199, 7, 101, 198, 42.5, 6.25):
            self.agrees(i / 10)


class Whole(pictures.PictureCase):
    """camera.set {fit} and a viewer's {fit} show all of the loop at any time."""

    def setUp(self):
        super().setUp()
        for actor, shift in (("a", [0, 0, 0]), ("b", [7, -2, 3])):
            self.add_growing(actor=actor, keys=((0, 1), (1, 3), (1.2, 0.2), (3, 4)), transform={"translation": shift})
            self.c.call("clip.update", actor=actor, clip="default", closed=True)
            self.c.call("actor.update", actor=actor, interpolation="catmull_rom")

    def whole(self, **kw):
        duration = self.c.call("playback.get")["players"][0]["duration"]
        for i in range(8):
            picture = self.picture(time=duration * i / 8, **kw)
            self.assertTrue(picture.edge_is_clear(), f"at {duration * i / 8}")
            self.assertTrue(picture.shown())
        return self.picture(time=3, **kw)

    def test_the_scene_s_camera(self):
        for eye in ([0, 2, 10], [7, 1, 6], [-3, 8, -3]):
            self.c.call("camera.set", eye=eye, target=[0, 0, 0])
            self.c.call("camera.set", fit=True)
            left, top, right, bottom = self.whole(width=160, height=100).extent()
            self.assertGreater(max((right - left) / 160, (bottom - top) / 100), 0.3, "and not from too far away")

    def test_a_viewer_s_camera_in_pictures_of_any_shape(self):
        for width, height in ((160, 90), (90, 160), (200, 600), (600, 60), (100, 100)):
            self.whole(width=width, height=height, camera={"fit": True})
        left, _, right, _ = self.whole(width=200, height=600, camera={"fit": True}).extent()
        self.assertGreater(right - left, 60, "a tall picture shows it as wide as it can")

    def test_while_it_spins(self):
        self.c.call("actor.update", actor="a", spin=40)
        self.c.call("actor.update", actor="b", spin=-70)
        self.c.call("playback.play")
        for _ in range(16):
            self.assertTrue(self.picture(camera={"fit": True}, width=60, height=60).edge_is_clear())

    def test_hidden_actors_do_not_count(self):
        self.c.call("camera.set", fit=True)
        self.c.call("actor.update", actor="b", visible=False)
        far, near = self.picture(time=3).extent(), self.whole(camera={"fit": True}).extent()
        self.assertGreater(near[2] - near[0], far[2] - far[0] + 5)


if __name__ == "__main__":
    harness.main()
