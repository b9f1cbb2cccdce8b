# SPDX-License-Identifier: Apache-2.0
"""Mesh formats and models' names, from folder to files: one body in each format gives the same pixels."""
import json
import struct

from harness import TinyCase, main

# tests/data/tiny's box, from 0.
PLACES = [(-1, -1, -2), (1, -1, -2), (1, 1, -2), (-1, 1, -2), (-1, -1, 2), (1, -1, 2), (1, 1, 2), (-1, 1, 2)]
FACES = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
TRIANGLES = [(f[0], f[i], f[i + 1]) for f in FACES for i in (1, 2)]
PLANES = ["--set", 'outputs.planes=["depth", "shading_normal", "object_id"]', "--set", "outputs.image=false"]


def lines(rows, first):
    return "".join(f"{first}{' '.join(map(str, row))}\n" for row in rows)


def ply():
    head = ("ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 6\nproperty list uchar int vertex_indices\nend_header\n")
    return (head + lines(PLACES, "") + lines(FACES, "4 ")).encode()


def obj(more=""):
    return (more + lines(PLACES, "v ") + lines([[v + 1 for v in face] for face in FACES], "f ")).encode()


def stl(header=b"solid box"):
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *(c for v in t for c in PLACES[v]), 0) for t in TRIANGLES)
    return header.ljust(80) + struct.pack("<I", len(TRIANGLES)) + body


class FormatsTest(TinyCase):
    def put(self, name, data):
        path = self.tiny / "models" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)

    def files(self, model, out=None):
        folder = (out or self.out) / "images" / model
        return {path.name: path.read_bytes() for path in sorted(folder.iterdir()) if path.is_file()}

    def test_one_body_is_the_same_pixels_in_every_format(self):
        (self.tiny / "models/tetra.ply").unlink()
        for name, data in (("box.ply", ply()), ("box.obj", obj()), ("box.STL", stl())):
            self.put(name, data)
        # In one place: which is a model's is chosen by its name.
        self.build(*PLANES, "--set", f'environments.files=["{self.tiny}/environments/floor"]')
        wanted = self.files("box.off")
        self.assertEqual(len(wanted), 4 * 4)
        for name in ("box.ply", "box.obj", "box.STL"):
            self.assertEqual(self.files(name), wanted, name)
        table = self.run_it("models", self.recipe).out
        for name, faces in (("box.obj", 6), ("box.STL", 12)):
            self.assertRegex(table, rf"(?m)^{name} +8 +{faces} +12")

    def test_materials_of_a_file_are_said_once_and_no_concern(self):
        self.put("a.obj", obj("mtllib not_there.mtl\nusemtl red\n"))
        self.put("b.obj", obj("usemtl red\nusemtl blue\n"))
        run = self.run_it("build", self.recipe, "-o", self.out, "--strict", *PLANES)
        self.assertEqual(run.code, 0, run)
        self.assertEqual(run.err.count("2 of 4 models (a.obj, b.obj): some of their parts have materials in their "
                                       "files, which are not read"), 1, run)
        found = {m["model"]: m for m in self.run_it("models", self.recipe, "--json").json["models"]}
        self.assertEqual([found[name]["unused_materials"] for name in ("a.obj", "b.obj", "box.off")], [1, 2, 0])

    def test_models_named_by_their_paths(self):
        for place in ("chair/1", "chair/2", "mug/1"):
            self.put(f"{place}/model.obj", obj(f"# {place}\n"))
        recursive = ["--set", "models.recursive=true", *PLANES]
        run = self.run_it("build", self.recipe, "-o", self.out, *recursive)
        self.assertEqual(run.code, 2, run)
        self.assertIn('models.names = "path" tells them apart', run.err)
        named = [*recursive, "--set", 'models.names="path"']
        self.assertEqual(self.build(*named)["built"], 5 * 4)
        wanted = self.files("chair/2/model.obj")
        self.assertEqual(len(wanted), 4 * 4)
        records = [json.loads(line) for line in (self.out / "manifest/images.jsonl").read_text().splitlines()]
        self.assertIn("chair/2/model.obj", {record["model"] for record in records})
        self.assertIn("chair/2/model.obj/1",
                      self.run_it("explain", self.out / "images/chair/2/model.obj/1.mask.png").out)
        for meant in ("chair/2/model/1", "images/chair/2/model.obj/1", "x/chair/2/model.obj/1.png"):
            self.assertIn("did you mean chair/2/model.obj/1?", self.run_it("explain", self.out, meant).err)
        self.assertEqual(self.run_it("verify", self.out).code, 0)
        # Without its neighbours, of which none has its file name any more, it keeps name and files.
        for place in ("chair/1", "mug/1"):
            (self.tiny / "models" / place / "model.obj").unlink()
        self.assertEqual(self.build(*named)["built"], 0)
        self.assertEqual(self.files("chair/2/model.obj"), wanted)
        self.assertEqual(sorted(path.name for path in (self.out / "images").iterdir()),
                         ["box.off", "chair", "tetra.ply"])
        self.assertEqual([path.name for path in (self.out / "images/chair").iterdir()], ["2"])


if __name__ == "__main__":
    main()
