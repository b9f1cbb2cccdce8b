# SPDX-License-Identifier: Apache-2.0
"""What is drawn of an environment's lights and materials: how light and of which colour a floor is then, by the inverse
square law and what the manifest says was drawn, and that it is what a scene file with these values gives."""
import json
import math

from harness import IMAGES, main
from lit_floor import LitFloorCase, from_point

LAMP = (0.3, -0.4, 0.9)
VARY = """
[environments.vary]
"floor/lamp.gain" = { choice = [2, 4, 7] }
"floor/floor.kd" = { hsv = [[0, 1], [0.2, 0.9], [0.4, 0.9]] }
"""
SETTINGS = ["--set", 'outputs.planes=["mask", "position", "geometry_normal", "albedo", "direct_diffuse"]', "--set",
            "engine.spp=16", "--set", "engine.filter_width=1"]


class EnvironmentVaryTest(LitFloorCase):
    def setUp(self):
        super().setUp()
        self.edit("environments/floor/environment.scn", "scene.lights.sky.color = 1.0 1.0 1.0",
                  "scene.lights.sky.color = 0 0 0\nscene.lights.lamp.type = point\n"
                  "scene.lights.lamp.position = {} {} {}\nscene.lights.lamp.gain = 3 3 3".format(*LAMP))
        self.plain = self.recipe.read_text()
        self.recipe.write_text(self.plain + VARY)

    def test_a_floor_is_as_light_and_of_the_colour_that_was_drawn(self):
        self.build(*SETTINGS, "--set", 'environments.files=["tiny/environments/floor"]', "--set", "engine.width=96",
                   "--set", "engine.height=96")
        for record in self.records():
            gain, kd = (record["draws"]["environments.vary.floor/" + name] for name in ("lamp.gain", "floor.kd"))
            light, albedo = self.plane(record, "direct_diffuse"), self.plane(record, "albedo")
            shares = [[], [], []]
            for i, position, normal in self.floor(record):
                falls = from_point(LAMP, gain, position, normal)
                if falls is None:
                    continue
                for channel in range(3):
                    self.assertAlmostEqual(albedo[i][channel], kd[channel], delta=1e-6)
                    shares[channel].append(light[i][channel] / (kd[channel] / math.pi * falls))
                    # The light is a point: what differs is where in the pixel samples fall.
                    self.assertAlmostEqual(shares[channel][-1], 1, delta=0.05, msg=(record["id"], i))
            for of_channel in shares:
                self.assertGreater(len(of_channel), 300)
                self.assertAlmostEqual(sum(of_channel) / len(of_channel), 1, delta=0.001, msg=record["id"])
        gains = {record["draws"]["environments.vary.floor/lamp.gain"] for record in self.records()}
        self.assertGreater(len(gains), 1)

    def test_an_albedo_of_8_bits_is_the_colour_that_was_drawn(self):
        self.build("--set", 'environments.files=["tiny/environments/floor"]', "--set",
                   'outputs.planes=["mask", "position", "geometry_normal", "albedo:png8"]')
        for record in self.records():
            kd, albedo, seen = record["draws"]["environments.vary.floor/floor.kd"], self.plane(record, "albedo"), 0
            for i, _, _ in self.floor(record):
                seen += 1
                for channel in range(3):
                    self.assertAlmostEqual(albedo[3 * i + channel] / 255, kd[channel], delta=1 / 255)
            self.assertGreater(seen, 20, record["id"])

    def test_it_is_what_a_file_with_these_values_gives(self):
        constants = ["--set", 'environments.vary={"floor/lamp.gain"=6,"floor/floor.kd"=[0.2,0.4,0.6]}']
        self.build(*constants)
        varied, self.out = self.contents(), self.folder / "edited"
        self.recipe.write_text(self.plain)
        self.build(out=self.folder / "before")
        scene = "environments/floor/environment.scn"
        self.edit(scene, "gain = 3 3 3", "gain = 6 6 6")
        self.edit(scene, "kd = 0.5 0.5 0.5", "kd = 0.2 0.4 0.6")
        self.build()
        edited, before = self.contents(), self.contents(self.folder / "before")
        images = [path for path in edited if path.endswith(".png")]
        self.assertEqual(len(images), 2 * IMAGES)
        environments = {record["id"]: record["environment"] for record in self.records()}
        for path in images:
            self.assertEqual(varied[path], edited[path], path)
            of = path.removeprefix("images/").removesuffix(".png").removesuffix(".mask")
            same = environments[of] == "plain" or path.endswith(".mask.png")
            self.assertEqual(varied[path] == before[path], same, path)

    def test_plan_explain_help_and_schema_tell_them(self):
        self.build()
        run = self.run_it("plan", self.recipe, "-o", self.out, "--draws")
        self.assertIn("environments.vary.floor/lamp.gain", run.out, run)
        self.assert_counts(self.build(), built=0, reused=IMAGES)
        # What is drawn of one environment is no business of another's images.
        self.recipe.write_text(self.plain + VARY + '"plain/sky.gain" = { uniform = [1.5, 2] }\n')
        self.assert_counts(self.build(), built=IMAGES // 2, reused=IMAGES // 2)
        run = self.run_it("explain", self.recipe, "box.off/0", "-o", self.out)
        self.assertIn("environments.vary.", run.out, run)
        self.assertIn("ENVIRONMENT/NAME.PROPERTY", self.run_it("help", "recipe", "environments").out)
        schema = json.loads(self.run_it("schema", "recipe").out)
        self.assertIn("vary", schema["properties"]["environments"]["properties"])

    def test_a_slip_is_one_error_with_its_place(self):
        self.recipe.write_text(self.plain + VARY.replace("lamp.gain", "lamp.gian"))
        run = self.run_it("build", self.recipe, "-o", self.out)
        self.assertEqual(run.code, 2, run)
        self.assertRegex(run.err, r'recipe\.toml:\d+:\d+: environments\.vary "floor/lamp\.gian" must name a property')
        self.assertIn("did you mean lamp.gain?", run.err, run)
        self.assertEqual(run.err.count("gian"), 1, run)

    def test_a_distribution_without_effect_is_said_once_and_counted(self):
        # Watts without lumens a watt: the lamp's gain counts.
        self.recipe.write_text(self.plain + VARY + '"floor/lamp.power" = { uniform = [1, 2] }\n')
        run = self.run_it("build", self.recipe, "-o", self.out, "--json")
        self.assertEqual(run.code, 0, run)
        self.assertEqual(run.json["concerns"]["draws_idle"], 1)
        self.assertEqual(run.err.count("1 of 3 distributions has no effect on any image: environments.vary.floor/lamp.power"), 1, run)
        told = json.loads((self.out / "manifest/dataset.json").read_text())["concerns"]["draws_idle"]
        self.assertEqual((told["count"], told["of"]), (1, 3))


if __name__ == "__main__":
    main()
