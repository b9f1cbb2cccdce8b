# SPDX-License-Identifier: Apache-2.0
"""Films that are kept and gone on from, pictures as exact as wanted, and what is said of those that are not."""
import json

from harness import IMAGES, SAMPLES, TinyCase, main


def setting(name, value):
    return "--set", f"engine.{name}={value}"


KEEP = setting("keep_sums", "true")


class FilmTest(TinyCase):
    def images(self, out=None):
        lines = ((out or self.out) / "manifest/images.jsonl").read_text().splitlines()
        return {image["id"]: image for image in map(json.loads, lines)}

    def fresh(self, *arguments):
        """What one go into another folder and store gives."""
        folder = self.folder / "fresh"
        counts = self.build(*arguments, out=folder)
        return counts, {path: hash for path, hash in self.contents(folder).items() if path.startswith("images/")}

    def pictures(self):
        return {path: hash for path, hash in self.contents().items() if path.startswith("images/")}

    def test_more_samples_trace_the_missing_ones_only(self):
        self.assert_counts(self.build(*KEEP, *setting("spp", 16)), traced_samples=16 * IMAGES * SAMPLES)
        counts = self.build(*KEEP, *setting("spp", 64))
        self.assert_counts(counts, built=IMAGES, traced_samples=48 * IMAGES * SAMPLES)
        self.assertEqual(self.pictures(), self.fresh(*setting("spp", 64))[1])
        fresh = self.images(self.folder / "fresh")
        for name, image in self.images().items():
            self.assertEqual(image, fresh[name])
            self.assertEqual(image["film"]["samples"], 64 * SAMPLES)
            self.assertEqual((image["film"]["least_spp"], image["film"]["most_spp"]), (64, 64))
            self.assertLess(image["film"]["error_low"], image["relative_error"])
            self.assertGreater(image["film"]["error_high"], image["relative_error"])
        # Fewer are in the store from before; a number between starts anew and leaves the larger film.
        self.assert_counts(self.build(*KEEP, *setting("spp", 16)), built=IMAGES, traced_samples=0)
        self.assert_counts(self.build(*KEEP, *setting("spp", 32)), traced_samples=32 * IMAGES * SAMPLES)
        self.assert_counts(self.build(*KEEP, *setting("spp", 65)), traced_samples=IMAGES * SAMPLES)

    def test_the_plan_knows_what_is_missing(self):
        self.build(*KEEP, *setting("spp", 4))
        plan = self.run_it("plan", self.recipe, "-o", self.out, "--json", *KEEP, *setting("spp", 10)).json
        self.assertEqual(plan["samples"], 6 * IMAGES * SAMPLES)

    def test_nothing_is_kept_unless_asked_for(self):
        self.build(*setting("spp", 2))
        self.assert_counts(self.build(*KEEP, *setting("spp", 4)), traced_samples=4 * IMAGES * SAMPLES)

    def test_another_seed_or_depth_goes_on_from_nothing(self):
        self.build(*KEEP, *setting("spp", 2))
        for other in (("--set", "dataset.seed=8"), setting("depth_total", 3), setting("outlier_limit", 5)):
            counts = self.build(*KEEP, *setting("spp", 4), *other)
            self.assert_counts(counts, traced_samples=4 * IMAGES * SAMPLES)

    def test_force_traces_from_the_start(self):
        self.build(*KEEP, *setting("spp", 4))
        self.assert_counts(self.build(*KEEP, *setting("spp", 6), "--force"), traced_samples=6 * IMAGES * SAMPLES)

    def test_a_damaged_film_is_not_gone_on_from(self):
        self.build(*KEEP, *setting("spp", 4))
        damaged = 0
        for path in (self.out / ".dsbuild/objects").rglob("*"):
            if path.is_file() and path.read_bytes().startswith(b"dsbuild film 2\n"):
                data = bytearray(path.read_bytes())
                data[-40] ^= 1
                path.chmod(0o644)
                path.write_bytes(data)
                damaged += 1
        self.assertEqual(damaged, IMAGES)
        self.assert_counts(self.build(*KEEP, *setting("spp", 6)), traced_samples=6 * IMAGES * SAMPLES)
        self.assertEqual(self.pictures(), self.fresh(*setting("spp", 6))[1])

    def test_an_error_takes_the_place_of_spp(self):
        self.edit("recipe.toml", "spp = 1", "error = 0.05")
        first = self.build(*KEEP)
        self.assert_counts(first, built=IMAGES, capped=[])
        for image in self.images().values():
            film = image["film"]
            self.assertLessEqual(film["developed_high"], 0.05)
            self.assertLess(film["developed_low"], film["developed_error"])
            self.assertFalse(film["capped"])
            self.assertEqual(image["spp"], -(-film["samples"] // SAMPLES))
            self.assertLessEqual(16, film["least_spp"])
            self.assertLessEqual(film["least_spp"], film["most_spp"])
        self.assert_counts(self.build(*KEEP), built=0, traced_samples=0)
        second = self.build(*KEEP, *setting("error", 0.005))
        whole, pictures = self.fresh(*setting("error", 0.005))
        self.assertEqual(first["traced_samples"] + second["traced_samples"], whole["traced_samples"])
        self.assertGreater(second["traced_samples"], 0)
        self.assertEqual(self.pictures(), pictures)
        self.assertEqual(self.images(), self.images(self.folder / "fresh"))

    def test_verify_traces_a_picture_of_an_error_again(self):
        self.edit("recipe.toml", "spp = 1", "error = 0.05")
        self.build()
        run = self.run_it("verify", self.recipe, "-o", self.out, "--rerender", 2)
        self.assertEqual(run.code, 0, run)

    def test_capped_pictures_are_listed(self):
        self.edit("recipe.toml", "spp = 1", "error = 0.001\nmax_spp = 20")
        counts = self.build(*KEEP)
        images = self.images()
        wanted = {name for name, image in images.items() if image["film"]["capped"]}
        self.assertTrue(wanted)
        self.assertEqual({image["id"] for image in counts["capped"]}, wanted)
        for image in images.values():
            self.assertLessEqual(image["film"]["samples"], 20 * SAMPLES)
        # Those that are reused are as inexact as before.
        run = self.run_it("build", self.recipe, "-o", self.out, *KEEP)
        self.assertEqual(run.code, 0, run)
        self.assertIn(f"{len(wanted)} of {IMAGES} images did not reach engine.error = 0.001 with "
                      "engine.max_spp = 20:\n", run.out)
        for name in wanted:
            self.assertIn(f"  {name}: {images[name]['film']['developed_high']:.4f}\n", run.out)
        # With more allowed they go on.
        more = self.build(*KEEP, *setting("max_spp", 30))
        self.assertLess(more["traced_samples"], len(wanted) * 15 * SAMPLES)
        self.assertEqual(self.pictures(), self.fresh(*setting("max_spp", 30))[1])

    def test_spp_and_error_exclude_each_other(self):
        self.edit("recipe.toml", "spp = 1", "spp = 1\nerror = 0.05")
        run = self.run_it("build", self.recipe, "-o", self.out)
        self.assertEqual(run.code, 2, run)
        self.assertIn("engine.spp has no effect with engine.error = 0.05, only with engine.error = false", run.err)
        self.edit("recipe.toml", "spp = 1\nerror = 0.05", "spp = 1\nmax_spp = 20")
        run = self.run_it("build", self.recipe, "-o", self.out)
        self.assertEqual(run.code, 2, run)
        self.assertIn("engine.max_spp has no effect with engine.error = false, only with engine.error != false", run.err)
        # --set may replace the one by the other.
        self.edit("recipe.toml", "max_spp = 20\n", "")
        self.assertEqual(self.run_it("plan", self.recipe, "-o", self.out, *setting("error", 0.05)).code, 0)


if __name__ == "__main__":
    main()
