# SPDX-License-Identifier: Apache-2.0
"""The recipes for each task, built small, exported as they say and checked."""
import json
import re

from harness import TinyCase, main

SMALL = ["--set", "engine.error=false", "--set", "engine.spp=1", "--set", "engine.width=16", "--set", "engine.height=16"]
# What of each is built: the rest is more of the same.
TASKS = {
    "classification": ["--set", "camera.views=[1]"],
    "detection": ["--set", "camera.count=2", "--set", "models.files=[{models}]"],
    "segmentation": ["--set", "camera.views=[0, 5]", "--set", "models.files=[{models}]"],
    "pose": ["--set", "camera.count=4"],
    "nerf": ["--set", "camera.count=8"],
}


class RecipesTest(TinyCase):
    def test_each_builds_exports_and_has_no_leak(self):
        models = ", ".join(f'"{self.source}/assets/models/{name}.ply"' for name in ("mug-1", "mug-2", "car-1"))
        for task, more in TASKS.items():
            with self.subTest(task):
                recipe, out = self.source / f"recipes/{task}.toml", self.folder / task
                more = [word.replace("{models}", models) for word in more]
                run = self.run_it("build", recipe, "-o", out, "--json", *SMALL, *more)
                self.assertEqual(run.code, 0, run)
                # As its first lines say.
                [format] = re.findall(r"dsbuild export \S+ --format (\w+)", recipe.read_text())
                run = self.run_it("export", out, "--format", format, "-o", self.folder / f"{task}-export")
                self.assertEqual(run.code, 0, run)
                records = [json.loads(line) for line in (out / "manifest/images.jsonl").read_text().splitlines()]
                self.assertEqual({record["split"] for record in records}, {"train", "test"})
                findings = self.run_it("check", out, "--json", "--only", "leaks").json["findings"]
                self.assertEqual([f for f in findings if f["level"] != "note"], [], findings)


if __name__ == "__main__":
    main()
