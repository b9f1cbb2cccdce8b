# SPDX-License-Identifier: Apache-2.0
"""Lights of a recipe: what they shed on a floor, by the inverse square law and what the manifest says was drawn."""
import json
import math
import shutil

from harness import IMAGES, main
from lit_floor import LitFloorCase, dot, from_point, passes_model, scaled

LIGHTS = """
[[lights]]
type = "point"
count = { integer = [1, 2] }
position_m = { shell = [0.4, 0.8], elevation_deg = [30, 80] }
gain = { log_uniform = [1, 20] }
color = { hsv = [[0, 1], [0.2, 0.9], [0.5, 1]] }

[[lights]]
type = "sharpdistant"
name = "sun"
from = { sphere = 2, elevation_deg = [20, 70] }
gain = { uniform = [0.5, 1] }
"""
SETTINGS = ["--set", 'outputs.planes=["mask", "position", "geometry_normal", "direct_diffuse"]', "--set", "engine.spp=16",
            "--set", "engine.filter_width=1"]
KD = 0.5  # of the floor


class LightsTest(LitFloorCase):
    def setUp(self):
        super().setUp()
        self.edit("environments/floor/environment.scn", "scene.lights.sky.color = 1.0 1.0 1.0",
                  "scene.lights.sky.color = 0 0 0")
        text = self.recipe.read_text().replace('dir = "environments"', 'files = ["environments/floor"]')
        self.recipe.write_text(text + LIGHTS)

    def irradiance(self, draws, point, normal):
        """Of the point by each channel; None where the model may stand before a light."""
        found = [0.0, 0.0, 0.0]
        for name in ["lights[0]", "lights[0][1]"][:draws["lights[0].count"]]:
            share = from_point(draws[f"{name}.position_m"], draws[f"{name}.gain"], point, normal)
            if share is None:
                return None
            found = [f + share * c for f, c in zip(found, draws[f"{name}.color"])]
        way = scaled(draws["lights[sun].from"], 0.5)
        self.assertAlmostEqual(dot(way, way), 1, places=6)
        if not passes_model(point, way, 1e3):
            return None
        return [f + draws["lights[sun].gain"] * max(dot(way, normal), 0) for f in found]

    def test_a_floor_is_as_light_as_what_was_drawn_makes_it(self):
        self.build(*SETTINGS, "--set", "engine.width=96", "--set", "engine.height=96")
        for record in self.records():
            light, shares = self.plane(record, "direct_diffuse"), [[], [], []]
            for i, position, normal in self.floor(record):
                falls = self.irradiance(record["draws"], position, normal)
                if falls is None:
                    continue
                for channel in range(3):
                    right = KD / math.pi * falls[channel]
                    shares[channel].append(light[i][channel] / right)
                    # Each sample asks one of the lights, by chance.
                    self.assertAlmostEqual(shares[channel][-1], 1, delta=0.5, msg=(record["id"], i))
            for of_channel in shares:
                self.assertGreater(len(of_channel), 300)
                self.assertAlmostEqual(sum(of_channel) / len(of_channel), 1, delta=0.01, msg=record["id"])

    def test_what_is_drawn_is_in_manifest_plan_and_explain_and_moves_nothing_else(self):
        self.build(*SETTINGS)
        told = json.loads((self.out / "manifest/dataset.json").read_text())
        self.assertEqual(told["draws"]["lights[0].gain"]["distribution"], "{log_uniform = [1.0, 20.0]}")
        self.assertEqual(told["draws"]["lights[sun].gain"]["count"], IMAGES)
        self.assertIn('name = "sun"', told["recipe"])
        run = self.run_it("plan", self.recipe, "-o", self.out, "--draws", *SETTINGS)
        self.assertIn("lights[0].position_m", run.out, run)
        # One more that stands nowhere yet, before the others' end: nothing to do but the manifest.
        self.recipe.write_text(self.recipe.read_text() + '\n[[lights]]\ntype = "point"\nposition_m = [0, 0, 1]\ncount = 0\n')
        self.assert_counts(self.build(*SETTINGS), built=0, reused=IMAGES)
        self.recipe.write_text(self.recipe.read_text().replace("count = 0", "count = { choice = [0, 1] }"))
        shown = sum(record["draws"]["lights[2].count"] for record in self.records_of_plan())
        self.assertTrue(0 < shown < IMAGES, shown)
        run = self.run_it("build", "-n", self.recipe, "-o", self.out, *SETTINGS)
        self.assertIn("lights changed: lights[2].type: added", run.out, run)
        counts = self.build(*SETTINGS)
        self.assert_counts(counts, built=shown, reused=IMAGES - shown)

    def records_of_plan(self):
        """Lines of a dataset elsewhere, of this recipe as it is now."""
        out, self.out = self.out, self.folder / "other"
        try:
            self.build(*SETTINGS)
            return self.records()
        finally:
            self.out = out

    def test_a_sun_below_the_horizon_is_an_error_of_its_image(self):
        text = self.recipe.read_text()
        self.recipe.write_text(text[:text.index("\n[[lights]]")] +
                               '\n[[lights]]\ntype = "sun"\ngain = 1e-5\nfrom = { choice = [[0, 1, 1], [0, 1, -1]] }\n')
        run = self.run_it("build", self.recipe, "-o", self.out, "-k", "--json")
        self.assertEqual(run.code, 1, run)
        self.assertIn("lights[0].dir: wanted a sun above the horizon", run.err)
        self.assertTrue(0 < run.json["failed"] < IMAGES, run)
        self.assertEqual(run.json["failed"] + run.json["built"], IMAGES)

    def test_a_dark_environment_is_no_fault_beside_lights(self):
        shutil.copytree(self.tiny / "environments/floor", self.tiny / "environments/dark")
        floor = (self.tiny / "environments/floor/environment.scn").read_text()
        lines = [line for line in floor.splitlines() if not line.startswith("scene.lights.") and ".emission" not in line]
        (self.tiny / "environments/dark/environment.scn").write_text("\n".join(lines) + "\n")
        dark = ["--set", f'environments.files=["{self.tiny / "environments/dark"}"]']
        for verb in (["plan"], ["build"]):
            run = self.run_it(*verb, self.recipe, "-o", self.out, "--json", *dark)
            self.assertNotIn("gives light", run.err)
            self.assertEqual((run.code, run.json["concerns"]["assets_unlikely"]), (0, 0), run)
            run = self.run_it(*verb, self.recipe, "-o", self.folder / "black", "--json", *dark, "--set", "lights=[]")
            self.assertEqual(run.err.count("environments/dark: nothing in it gives light"), 1, run)
            self.assertEqual(run.json["concerns"]["assets_unlikely"], 1, run)

    def test_help_and_schema_know_them(self):
        text = self.run_it("help", "recipe", "lights").out
        for word in ("position_m", "temperature_k", "coneangle", "theta", "(point, spot)"):
            self.assertIn(word, text)
        schema = json.loads(self.run_it("schema", "recipe").out)
        kinds = [one["properties"]["type"]["const"] for one in schema["properties"]["lights"]["items"]["anyOf"]]
        self.assertIn("spot", kinds)
        self.assertNotIn("infinite", kinds)


if __name__ == "__main__":
    main()
