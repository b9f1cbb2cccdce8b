# SPDX-License-Identifier: Apache-2.0
"""Models in the materials of their own files: what pictures and planes show, what is in whose key, what is said."""
import base64
import json
import struct
import zlib

import image_reader
from harness import TinyCase, main

SIZE = 4  # pixels and texels a side
HALF = 0.08  # metres: half of the square, which fills the picture
# Seen straight on, disney's diffuse part with roughness 0 sends on 1 - 1/42 of white light: the integral of
# 2 c (1 - (1 - c)^5 / 2) over the cosine c (Burley 2012, equation 4, F_D90 = 1/2).
STRAIGHT_ON = 41 / 42
# The plane's albedo is a sum over eight directions: up to 0.0034 off that. Any two of TEXELS are further apart.
ALBEDO_ERROR = 0.004

RECIPE = """
[dataset]
name = "own"
licence = "CC0-1.0"
[models]
dir = "models"
up = "z"
size_m = 0
ground_z_m = false
centre = "none"
normals = "flat"
[materials]
assign = "own"
[environments]
files = ["environments/plain"]
[camera]
set = "list"
positions = [[1, 0, 0]]
type = "orthographic"
extent_m = 0.16
[engine]
width = 4
height = 4
spp = 16
filter_width = 0
[outputs]
planes = ["albedo:exr", "material_id"]
"""


def png(rows):
    """8 bit RGB."""
    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))
    raw = b"".join(b"\0" + bytes(value for pixel in row for value in pixel) for row in rows)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


def linear(byte):
    """sRGB's, IEC 61966-2-1."""
    share = byte / 255
    return share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4


# No two texels alike, and no row or column a mirror of another.
TEXELS = [[(16 * (4 * y + x), 250 - 40 * x - 7 * y, 30 + 50 * y) for x in range(SIZE)] for y in range(SIZE)]
# The square, seen from +x with z up: y runs to the right.
SQUARE = [(0, -HALF, -HALF), (0, HALF, -HALF), (0, HALF, HALF), (0, -HALF, HALF)]
LEFT_BOTTOM = [(0, 0), (1, 0), (1, 1), (0, 1)]  # how far right and up the image's corners are


def obj(faces, uvs=True):
    """`faces`: lines; corners of the square by V/VT."""
    lines = [f"v {x} {y} {z}" for x, y, z in SQUARE]
    if uvs:
        lines += [f"vt {u} {v}" for u, v in LEFT_BOTTOM]
    return "\n".join([*lines, *faces, ""])


def gltf(materials, triangles=((0, 1, 2), (0, 2, 3)), image=None, own=(0, 0), glb=False):
    """The square, a primitive a triangle, `own` their materials; `image`: bytes, or a uri."""
    data = b"".join(struct.pack("<3f", *place) for place in SQUARE)
    data += b"".join(struct.pack("<2f", u, 1 - v) for u, v in LEFT_BOTTOM)  # the format's v runs down
    views = [(0, 48), (48, 32)]
    accessors = [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4},
                 {"bufferView": 1, "componentType": 5126, "type": "VEC2", "count": 4}]
    primitives = []
    for triangle, material in zip(triangles, own):
        accessors.append({"bufferView": len(views), "componentType": 5125, "type": "SCALAR", "count": 3})
        views.append((len(data), 12))
        data += struct.pack("<3I", *triangle)
        primitive = {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": len(accessors) - 1}
        if material is not None:
            primitive["material"] = material
        primitives.append(primitive)
    text = {"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"primitives": primitives}],
            "accessors": accessors, "materials": materials}
    if image is not None:
        text["textures"] = [{"source": 0}]
        if isinstance(image, str):
            text["images"] = [{"uri": image}]
        else:
            text["images"] = [{"bufferView": len(views), "mimeType": "image/png"}]
            views.append((len(data), len(image)))
            data += image
    text["bufferViews"] = [{"buffer": 0, "byteOffset": at, "byteLength": size} for at, size in views]
    text["buffers"] = [{"byteLength": len(data)}]
    if not glb:
        text["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        return json.dumps(text).encode()
    packed = json.dumps(text).encode()
    packed += b" " * (-len(packed) % 4)
    data += b"\0" * (-len(data) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(packed) + len(data))
            + struct.pack("<I4s", len(packed), b"JSON") + packed + struct.pack("<I4s", len(data), b"BIN\0") + data)


class OwnMaterialsTest(TinyCase):
    def setUp(self):
        super().setUp()
        self.recipe.write_text(RECIPE)
        self.edit("environments/plain/environment.scn", "0.8 0.9 1.0", "1 1 1")
        for model in (self.tiny / "models").iterdir():
            model.unlink()

    def put(self, name, content):
        path = self.tiny / "models" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)

    def record(self, model, out=None):
        lines = (out or self.out).joinpath("manifest/images.jsonl").read_text().splitlines()
        return next(record for record in map(json.loads, lines) if record["model"] == model)

    def file(self, model, kind, out=None):
        files = self.record(model, out)["files"]
        return (out or self.out) / next(file["path"] for file in files if file["kind"] == kind)

    def albedo(self, model):
        """Rows of pixels."""
        width, height, channels = image_reader.read_exr(self.file(model, "albedo"))
        pixels = list(zip(*(channels[name] for name in "RGB")))
        return [pixels[y * width:(y + 1) * width] for y in range(height)]

    def ids(self, model):
        width, height, channels, _, samples = image_reader.read_png(self.file(model, "material_id"))
        self.assertEqual(channels, 1)
        return [list(samples[y * width:(y + 1) * width]) for y in range(height)]

    def picture(self, model):
        return image_reader.read_png(self.file(model, "image"))

    def assert_texels(self, model, factor=(1, 1, 1)):
        for row, texels in zip(self.albedo(model), TEXELS):
            for pixel, texel in zip(row, texels):
                for found, byte, f in zip(pixel, texel, factor):
                    self.assertAlmostEqual(found, linear(byte) * f * STRAIGHT_ON, delta=ALBEDO_ERROR, msg=model)

    def test_a_texture_stands_as_each_format_has_it(self):
        rough = {"metallicFactor": 0, "roughnessFactor": 0}
        textured = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, **rough}}
        self.put("a.obj", obj(["mtllib a b.mtl", "usemtl red wood", "f 1/1 2/2 3/3 4/4"]))
        self.put("a b.mtl", "newmtl red wood\r\nKd 1 1 1\r\nPr 0\r\nKs 0\r\nmap_Kd tex tures\\one.png\r\n")
        self.put("half.obj", obj(["mtllib half.mtl", "usemtl m", "f 1/1 2/2 3/3 4/4"]))
        self.put("half.mtl", "newmtl m\nKd 0.5 0.25 1\nPr 0\nKs 0\nmap_Kd tex tures/one.png\n")
        self.put("tex tures/one.png", png(TEXELS))
        self.put("uri.gltf", gltf([textured], image="tex%20tures/one.png"))
        self.put("data.gltf", gltf([textured], image="data:image/png;base64," + base64.b64encode(png(TEXELS)).decode()))
        self.put("held.glb", gltf([textured], image=png(TEXELS), glb=True))
        self.build()
        for model in ("a.obj", "uri.gltf", "data.gltf", "held.glb"):
            if model == "a.obj":
                self.assert_texels(model)
            self.assertEqual(self.record(model)["material"], "own")
        self.assert_texels("half.obj", (0.5, 0.25, 1))
        # glTF's surface has a highlight of 4 % that MTL's, asked so, has not: texels tell it, row for row.
        for model in ("data.gltf", "held.glb"):
            self.assertEqual(self.albedo(model), self.albedo("uri.gltf"), model)
        described = json.loads((self.out / "manifest/dataset.json").read_text())
        self.assertEqual(described["own_materials"]["a.obj"], ["red wood"])
        self.assertEqual(described["concerns"]["own_materials_partial"]["count"], 0)

    def test_a_file_of_either_format_gives_one_picture(self):
        # A format is told by what the file holds; one name for both gives one seed.
        self.recipe.write_text(RECIPE.replace('dir = "models"', 'files = ["models/m.dat"]'))
        factors = {"metallicFactor": 0.25, "roughnessFactor": 0.75, "baseColorTexture": {"index": 0}}
        self.put("m.dat", gltf([{"pbrMetallicRoughness": factors}], image=png(TEXELS), glb=True))
        self.build()
        one, colours = self.picture("m.dat"), self.albedo("m.dat")
        self.put("m.dat", obj(["mtllib a.mtl", "usemtl m", "f 1/1 2/2 3/3", "f 1/1 3/3 4/4"]))
        self.put("a.mtl", "newmtl m\nPm 0.25\nPr 0.75\nmap_Kd a.png\n")
        self.put("a.png", png(TEXELS))
        self.assert_counts(self.build(), built=1)
        for found, right in zip(self.picture("m.dat")[4], one[4]):
            self.assertLessEqual(abs(found - right), 1)  # 1 - v rounds otherwise than v
        for row, right in zip(self.albedo("m.dat"), colours):
            for found, pixel in zip(row, right):
                for x, y in zip(found, pixel):
                    self.assertAlmostEqual(x, y, delta=1e-6)
        self.assertEqual(len({pixel for row in colours for pixel in row}), SIZE * SIZE)

    def test_a_number_of_a_file_is_the_same_bits_as_in_a_material_of_the_recipe(self):
        self.put("a.obj", obj(["mtllib a.mtl", "usemtl m", "f 1 2 3 4"], uvs=False))
        self.put("a.mtl", "newmtl m\nKd 0.3 0.5 0.7\nPr 0.4\nPm 0.1\n")
        self.build()
        (self.tiny / "same.mat").write_text(
            "scene.materials.m.type = disney\nscene.materials.m.basecolor = 0.3 0.5 0.7\n"
            "scene.materials.m.roughness = 0.4\nscene.materials.m.metallic = 0.1\n"
            "scene.materials.m.specular = 0.5\n")
        self.recipe.write_text(RECIPE.replace('assign = "own"', 'files = ["same.mat"]'))
        other = self.folder / "other"
        self.build(out=other)
        for kind in ("image", "albedo"):
            self.assertEqual(self.file("a.obj", kind).read_bytes(), self.file("a.obj", kind, other).read_bytes(), kind)

    def test_in_even_light_a_surface_shines_as_its_formula_says(self):
        self.put("a.obj", obj(["mtllib a.mtl", "usemtl m", "f 1 2 3 4"], uvs=False))
        self.put("a.mtl", "newmtl m\nKd 0.3 0.5 0.7\nPr 0\nKs 0\n")
        self.build("--set", "engine.spp=4096")
        _, _, _, _, samples = self.picture("a.obj")
        for i, sample in enumerate(samples):  # developed with scale 1 and gamma 2.2
            self.assertAlmostEqual((sample / 255) ** 2.2, (0.3, 0.5, 0.7)[i % 3] * STRAIGHT_ON, delta=0.006)

    def test_each_face_has_its_own(self):
        # Below the diagonal from the left bottom one material, above it another.
        self.put("a.obj", obj(["mtllib a.mtl c.mtl", "usemtl below", "f 1 2 3", "usemtl above", "f 1 3 4"], uvs=False))
        self.put("a.mtl", "newmtl above\nKd 0.25 0.5 0.75\nPr 0\nKs 0\n")
        self.put("c.mtl", "newmtl below\nKd 0.75 0.25 0.5\nPr 0\nKs 0\n")
        flat = {"metallicFactor": 0, "roughnessFactor": 0}
        self.put("b.gltf", gltf([{"name": "above", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1], **flat}},
                                 {"name": "below", "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 1, 1], **flat}}],
                                own=(1, 0)))
        self.build()
        colours = {1: (0.75, 0.25, 0.5), 2: (0.25, 0.5, 0.75)}
        seen = set()
        for y in range(SIZE):
            for x in range(SIZE):
                if x == SIZE - 1 - y:
                    continue  # the diagonal goes through its middle
                number = 1 if x > SIZE - 1 - y else 2
                seen.add(number)
                for model in ("a.obj", "b.gltf"):
                    self.assertEqual(self.ids(model)[y][x], number, (model, x, y))
                for found, right in zip(self.albedo("a.obj")[y][x], colours[number]):
                    self.assertAlmostEqual(found, right * STRAIGHT_ON, delta=ALBEDO_ERROR)
                red, _, blue = self.albedo("b.gltf")[y][x]
                self.assertEqual(red > blue, number == 2)
        self.assertEqual(seen, {1, 2})
        described = json.loads((self.out / "manifest/dataset.json").read_text())
        self.assertEqual(described["own_materials"], {"a.obj": ["below", "above"], "b.gltf": ["below", "above"]})
        # They are one model: its mask is the whole square, and it is placed as without them.
        mask = image_reader.read_png(self.file("a.obj", "mask"))[4]
        self.assertEqual(set(mask), {255})
        self.put("plain.obj", obj(["f 1 2 3", "f 1 3 4"], uvs=False))
        self.build()
        for field in ("model_to_world", "model_box", "box_m"):
            self.assertEqual(self.record("plain.obj")[field], self.record("a.obj")[field])
        self.assertEqual(self.record("plain.obj")["parts"]["model"], self.record("a.obj")["parts"]["model"])

    def test_what_is_changed_makes_its_own_model_stale(self):
        self.put("a.obj", obj(["mtllib a.mtl", "usemtl m", "f 1/1 2/2 3/3 4/4"]))
        self.put("a.mtl", "newmtl m\nmap_Kd a.png\n")
        self.put("a.png", png(TEXELS))
        self.put("b.obj", obj(["mtllib b.mtl", "usemtl m", "f 1/1 2/2 3/3 4/4"]))
        self.put("b.mtl", "newmtl m\nKd 0.5\n")
        self.put("c.glb", gltf([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], image=png(TEXELS),
                               glb=True))
        self.put("d.gltf", gltf([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], image="d.png"))
        self.put("d.png", png(TEXELS))
        self.assert_counts(self.build(), built=4, reused=0)
        self.assert_counts(self.build(), built=0, reused=4)
        other = png(TEXELS[::-1])

        def expect(stale, reason):
            planned = self.run_it("plan", self.recipe, "-o", self.out, "--json")
            self.assert_counts(self.build(), built=len(stale), reused=4 - len(stale))
            for name in stale:
                self.assertIn(name, planned.out, reason)

        self.put("a.png", other)
        expect(["a.obj"], "a texture's bytes")
        self.put("b.mtl", "newmtl m\nKd 0.25\n")
        expect(["b.obj"], "a colour")
        self.put("c.glb", gltf([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], image=other, glb=True))
        expect(["c.glb"], "an image in the file")
        self.put("d.png", other)
        expect(["d.gltf"], "an image beside it")
        self.put("b.mtl", "# said anew\nnewmtl m\nKd 0.25 0.25 0.25\nKa 1 1 1\n")
        expect([], "what says the same")
        self.put("b.mtl", "newmtl renamed\nKd 0.25\n")
        self.put("b.obj", obj(["mtllib b.mtl", "usemtl renamed", "f 1/1 2/2 3/3 4/4"]))
        expect([], "another name")
        self.put("b.obj", obj(["mtllib b.mtl", "f 1/1 2/2 3/3 4/4", "usemtl renamed"]))
        expect(["b.obj"], "which face has it")
        self.assertEqual(self.run_it("verify", self.out).code, 0)
        run = self.run_it("verify", self.recipe, "-o", self.out, "--rerender=4")
        self.assertEqual(run.code, 0, run)

    def test_what_is_missing_fails_its_own_model(self):
        self.put("a.obj", obj(["mtllib gone.mtl", "usemtl m", "f 1 2 3 4"], uvs=False))
        self.put("b.obj", obj(["mtllib b.mtl", "usemtl m", "f 1/1 2/2 3/3 4/4"]))
        self.put("b.mtl", "newmtl m\nmap_Kd gone.png\n")
        self.put("c.obj", obj(["mtllib c.mtl", "usemtl m", "f 1 2 3 4"], uvs=False))
        self.put("c.mtl", "newmtl m\nKd 0.5\n")
        run = self.run_it("build", self.recipe, "-o", self.out, "--json", "-k")
        self.assertEqual(run.code, 1, run)
        self.assert_counts(run.json, built=1, failed=2)
        self.assertIn("gone.mtl: wanted the file that a model's own materials are in (mtllib), found none", run.err)
        self.assertIn('gone.png: wanted an image that the material "m" shows, found no file', run.err)
        self.put("gone.mtl", "newmtl m\nKd 0.5\n")
        self.put("gone.png", png(TEXELS))
        self.assert_counts(self.build(), built=2, reused=1, failed=0)

    def test_what_is_not_shown_is_said_once_and_counted(self):
        self.put("a.obj", obj(["mtllib a.mtl", "f 1 2 3", "usemtl none", "f 1 3 4"], uvs=False))
        self.put("a.mtl", "newmtl m\nd 0.5\n")
        self.put("b.obj", obj(["mtllib b.mtl", "usemtl m", "f 1 2 3 4"], uvs=False))
        self.put("b.mtl", "newmtl m\nKe 1 1 1\nmap_Bump b.png\nd 0.5\n")
        self.put("c.obj", obj(["mtllib b.mtl", "usemtl m", "f 1 2 3 4"], uvs=False))
        self.put("d.gltf", gltf([{"pbrMetallicRoughness": {}}]))
        for _ in range(2):  # what is kept of the first says the same
            run = self.run_it("build", self.recipe, "-o", self.out, "--json")
            self.assertEqual(run.code, 0, run)
            self.assertEqual(run.json["concerns"]["own_materials_partial"], 3)
            for text in ("1 of 4 models (a.obj): some of their own materials are none",
                         "1 of 4 models (a.obj): some of their own materials are defined in no .mtl file",
                         "2 of 4 models (b.obj, c.obj): some of their own materials shine, which is not shown",
                         "2 of 4 models (b.obj, c.obj): some of their own materials are transparent",
                         "2 of 4 models (b.obj, c.obj): some of their own materials have normal"):
                self.assertEqual(run.err.count(text), 1, run)
            self.assertNotIn("are not read: what the recipe gives them", run.err)
        self.assertEqual(set(value for row in self.ids("a.obj") for value in row), {0, 1})
        grey = [pixel for row in self.albedo("a.obj") for pixel in row]
        self.assertEqual(len(set(grey)), 1)  # both faces show light grey

    def test_files_without_any_are_said_and_counted(self):
        """STL knows no materials: such models are light grey, and so are distractors from another folder."""
        def stl(height):
            corners = ["0 0 0", "1 0 0", "0 1 0", f"0 0 {height}"]
            facets = "".join("facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {corners[i]}\n" for i in face) +
                             "endloop\nendfacet\n" for face in ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)))
            return f"solid x\n{facets}endsolid x\n"

        self.put("a.stl", stl(1))
        self.put("d.gltf", gltf([{"pbrMetallicRoughness": {}}]))
        (self.folder / "others").mkdir()
        (self.folder / "others/b.stl").write_text(stl(2))
        more = [f'distractors.dir="{self.folder / "others"}"', "distractors.count=1", "distractors.place_m={disc=[0.3,0.5]}"]
        for verb in ("plan", "build"):
            run = self.run_it(verb, self.recipe, "-o", self.out, "--json", *(word for one in more for word in ("--set", one)))
            self.assertEqual((run.code, run.json["concerns"]["own_materials_partial"]), (0, 2), run)
            self.assertEqual(run.err.count("2 of 3 models (a.stl, b.stl): some of their own materials are none: these faces show light grey"),
                             1, run)

    def test_the_recipe_gives_no_other_materials_beside_them(self):
        self.put("a.obj", obj(["f 1 2 3 4"], uvs=False))
        for line in ('dir = "materials"', 'files = ["materials/red.mat"]', 'vary = { "*.kd" = 0.5 }', 'per = "view"'):
            self.recipe.write_text(RECIPE.replace('assign = "own"', 'assign = "own"\n' + line))
            run = self.run_it("plan", self.recipe, "-o", self.out)
            self.assertEqual(run.code, 2, run)
            self.assertIn("materials." + line.split()[0], run.err)


if __name__ == "__main__":
    main()
