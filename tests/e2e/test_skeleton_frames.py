"""Pictures of skeletons (section 5): bones where there is no mesh, live poses at once, what a stream of vertices refuses."""
import math

import harness
import pictures

LIMB = [{"name": "shoulder"},
        {"name": "elbow", "parent": "shoulder", "translation": [0, 1, 0]},
        {"name": "wrist", "parent": "elbow", "translation": [0, 1, 0]}]
BESIDE = {"camera": {"eye": [0, 1, 6], "target": [0, 1, 0]}}


class Bones(pictures.PictureCase):
    def limb(self, **kw):
        return self.c.call("actor.add", actor="limb", skeleton={"joints": LIMB}, **kw)

    def test_an_actor_without_a_mesh_is_drawn_as_its_bones(self):
        self.limb()
        picture = self.picture(**BESIDE)
        left, top, right, bottom = picture.extent()
        self.assertGreater(bottom - top, 3 * (right - left), "it stands upright")
        self.c.call("actor.update", visible=False)
        self.assertEqual(self.picture(**BESIDE).shown(), set())

    def test_bones_follow_a_live_pose(self):
        self.limb()
        quarter = [0, 0, math.sin(math.pi / 4), math.cos(math.pi / 4)]
        self.c.call("pose.set", pose={"shoulder": {"rotation": quarter}})
        left, top, right, bottom = self.picture(**BESIDE).extent()
        self.assertGreater(right - left, 3 * (bottom - top), "it lies on its side")
        self.c.call("pose.clear")
        left, top, right, bottom = self.picture(**BESIDE).extent()
        self.assertGreater(bottom - top, 3 * (right - left))

    def test_one_joint_at_the_origin_still_shows(self):
        self.c.call("actor.add", actor="point", skeleton={"joints": [{"name": "only"}]})
        self.assertGreater(len(self.picture().shown()), 0)
        fitted = self.picture(camera={"fit": True})
        self.assertGreater(len(fitted.shown()), 0)
        self.assertTrue(fitted.edge_is_clear())

    def test_fit_brings_all_bones_into_view(self):
        self.limb(transform={"translation": [100, 0, 0], "scale": [7, 7, 7]})
        picture = self.picture(camera={"fit": True})
        self.assertTrue(picture.edge_is_clear())
        left, top, right, bottom = picture.extent()
        self.assertGreater(bottom - top, picture.height / 2)

    def test_a_mesh_without_a_skeleton_has_none_to_show(self):
        self.add_quad()
        before = self.picture()
        self.c.call("actor.update", show_skeleton=True)
        self.assertTrue(self.c.call("scene.describe")["actors"][0]["show_skeleton"])
        self.assertEqual(self.picture(), before)

    def test_a_stream_of_vertices_needs_a_mesh(self):
        self.limb()
        self.refused(-32602, "stream.open", kind="vertices", actor="limb")
        self.refused(-32602, "vertices.sample", actor="limb")


if __name__ == "__main__":
    harness.main()
