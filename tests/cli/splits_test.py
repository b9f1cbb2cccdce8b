# SPDX-License-Identifier: Apache-2.0
"""Three splits of a dataset, against shares worked out here."""
import csv
import itertools
import json
from fractions import Fraction

from harness import TinyCase, main

SIZES = {"car": 40, "chair": 33, "cup": 20, "lamp": 7, "sofa": 3, "rug": 2, "one": 1}


def half_up(value):
    return int(value + Fraction(1, 2))


def shares_of(size, test, val):
    """Models of test, val and train of a class: test rounded, both together rounded; one at least where there are enough."""
    tests = half_up(test * size)
    if size > 1:
        tests = max(tests, 1)
    both = max(half_up((test + val) * size), tests + (1 if size > 2 else 0))
    return {"test": tests, "val": both - tests, "train": size - both}


class SplitsTest(TinyCase):
    def setUp(self):
        super().setUp()
        box = (self.tiny / "models/box.off").read_text()
        for file in (self.tiny / "models").iterdir():
            file.unlink()
        self.names = {kind: [f"{kind}{i:02}.off" for i in range(size)] for kind, size in SIZES.items()}
        for name in itertools.chain(*self.names.values()):
            (self.tiny / "models" / name).write_text(box)
        self.list(self.names)
        self.edit("recipe.toml", "[materials]", '[classes]\nfrom = "all.csv"\n\n[materials]')

    def list(self, names):
        with (self.tiny / "all.csv").open("w") as file:
            csv.writer(file).writerows([["name", "class"], *((name, kind) for kind in names for name in names[kind])])

    def splits(self, *sets):
        run = self.run_it("classes", self.recipe, "--json", *(word for one in sets for word in ("--set", one)))
        self.assertEqual(run.code, 0, run)
        return {entry["path"]: {split: count["models"] for split, count in entry["splits"].items()} for entry in run.json["classes"]}

    def test_seventy_fifteen_fifteen(self):
        split = "classes.split={train=0.7, val=0.15, test=0.15, stratified=true}"
        told = self.splits(split)
        for kind, size in SIZES.items():
            wanted = shares_of(size, Fraction(15, 100), Fraction(15, 100))
            self.assertEqual(told[kind], {name: count for name, count in wanted.items() if count}, kind)
        # The whole is near its shares too: half a model a class at most, and the ones of small classes.
        all = {name: sum(of.get(name, 0) for of in told.values()) for name in ("train", "val", "test")}
        for name, share in (("train", 0.7), ("val", 0.15), ("test", 0.15)):
            self.assertAlmostEqual(all[name], share * sum(SIZES.values()), delta=len(SIZES))
        # As today's two: val is taken of train alone.
        two = self.splits("classes.split={test=0.15, stratified=true}")
        self.assertEqual({kind: of.get("test", 0) for kind, of in two.items()}, {kind: of.get("test", 0) for kind, of in told.items()})

    def test_whole_classes(self):
        told = self.splits('classes.split={by="class", test=0.3, val=0.3}')
        for kind, of in told.items():
            self.assertEqual(len(of), 1, kind)
        self.assertEqual({split for of in told.values() for split in of}, {"train", "val", "test"})
        named = self.splits('classes.split={by="class", held_out=["cup"], held_out_val=["sofa", "rug"]}')
        self.assertEqual({kind: [*of] for kind, of in named.items()},
                         {kind: [{"cup": "test", "sofa": "val", "rug": "val"}.get(kind, "train")] for kind in SIZES})

    def manifest(self, *sets):
        self.build(*(word for one in sets for word in ("--set", one)))
        return {record["model"]: record["split"] for record in map(json.loads, (self.out / "manifest/images.jsonl").read_text().splitlines())}

    def test_one_model_more_moves_few(self):
        small = ("camera.views=[0]", "engine.width=8", "engine.height=8", "engine.spp=1", f'environments.files=["{self.tiny / "environments/plain"}"]')
        by_hash = (*small, "classes.split={val=0.2, test=0.2}")
        before = self.manifest(*by_hash)
        self.assertEqual(set(before.values()), {"train", "val", "test"})
        (self.tiny / "models/new.off").write_text((self.tiny / "models/car00.off").read_text())
        self.list({**self.names, "cup": [*self.names["cup"], "new.off"]})
        after = self.manifest(*by_hash)
        self.assertEqual({name: split for name, split in after.items() if name != "new.off"}, before)


if __name__ == "__main__":
    main()
