# SPDX-License-Identifier: Apache-2.0
"""Mesh formats and models' names, from folder to files: one body in each format gives the same pixels."""
import base64
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


def gltf(data, buffer):
    """Corners as they are, then indices; of a buffer that `buffer` tells."""
    return json.dumps({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 8},
                      {"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
        "buffers": [{"byteLength": len(data), **buffer}]}).encode()


def gltf_data(scale=1):
    return (struct.pack("<24f", *(c * scale for place in PLACES for c in place))
            + struct.pack("<36H", *(v for t in TRIANGLES for v in t)))


def glb():
    text, data = gltf(gltf_data(), {}), gltf_data()
    text = text.ljust((len(text) + 3) // 4 * 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


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
        for name, data in (("box.ply", ply()), ("box.obj", obj()), ("box.STL", stl()), ("box.glb", glb()),
                           ("box.gltf", gltf(gltf_data(), {"uri": "data:;base64,"
                                                           + base64.b64encode(gltf_data()).decode()}))):
            self.put(name, data)
        # In one place: which is a model's is chosen by its name.
        self.build(*PLANES, "--set", f'environments.files=["{self.tiny}/environments/floor"]')
        wanted = self.files("box.off")
        self.assertEqual(len(wanted), 4 * 4)
        for name in ("box.ply", "box.obj", "box.STL", "box.glb", "box.gltf"):
            self.assertEqual(self.files(name), wanted, name)
        table = self.run_it("models", self.recipe).out
        for name, faces in (("box.obj", 6), ("box.STL", 12)):
            self.assertRegex(table, rf"(?m)^{name} +8 +{faces} +12")

    def test_a_file_that_holds_a_part_of_a_model_is_an_input(self):
        self.put("box.gltf", gltf(gltf_data(), {"uri": "parts/box.bin"}))
        self.put("parts/box.bin", gltf_data())
        self.build(*PLANES)
        before = self.files("box.gltf")
        self.assert_counts(self.build(*PLANES), built=0)
        moved = struct.pack("<3f", -1.5, -1, -2) + gltf_data()[12:]
        self.put("parts/box.bin", moved)
        self.assert_counts(self.build(*PLANES), built=4)
        self.assertNotEqual(self.files("box.gltf"), before)
        run = self.run_it("import", self.tiny / "models", "-o", self.folder / "copy", "--copy")
        self.assertEqual(run.code, 0, run)
        self.assertEqual((self.folder / "copy/models/parts/box.bin").read_bytes(), moved)
        (self.tiny / "models/parts/box.bin").unlink()
        run = self.run_it("build", self.recipe, "-o", self.out, *PLANES)
        self.assertNotEqual(run.code, 0, run)
        self.assertIn("box.bin", run.err)

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
