# SPDX-License-Identifier: Apache-2.0
"""A device that crashes, hangs or ends the process (device_shim.c) costs one image, and the rest is made."""
import fcntl
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

from harness import IMAGES, SAMPLES, TinyCase, main

VIEWS = 4
STALL = 5  # seconds: compiling a program on a machine with other work may take more than one or two
BYTES = 1 << 20  # more than any buffer of the tiny scenes, less than the triangles of the model below


class SupervisorTest(TinyCase):
    shim = ""

    def setUp(self):
        super().setUp()
        # A strip of 40,000 triangles, as a model that no other scene is as large as.
        count = 20000
        points = [f"{i * 1e-3} {side} {side * 0.2}" for i in range(count + 1) for side in (0, 1)]
        faces = [f"3 {2 * i} {2 * i + 1} {2 * i + 2}\n3 {2 * i + 1} {2 * i + 3} {2 * i + 2}" for i in range(count)]
        (self.tiny / "models/large.off").write_text(f"OFF\n{len(points)} {2 * count} 0\n" + "\n".join(points + faces) + "\n")

    def environment(self, how, once=False):
        variables = {**os.environ, "LD_PRELOAD": self.shim, "DS_SHIM": how, "DS_SHIM_BYTES": str(BYTES)}
        if once:
            variables["DS_SHIM_ONCE"] = str(self.folder / "once")
        return variables

    def device(self):
        """What a build traces on where nobody says."""
        devices = self.run_it("devices", "--json").json["devices"]
        return next(device["name"] for device in devices if device["default"])

    def listed(self):
        lines = (self.out / "manifest/images.jsonl").read_text().splitlines()
        return sorted(json.loads(line)["id"] for line in lines)

    def test_an_image_that_crashes_fails_and_the_rest_goes_on(self):
        for how, told in (("segv", "died of signal 11 (Segmentation fault)"), ("abort", "died of signal 6 (Aborted)"),
                          ("exit", "ended with exit code 7 in the middle of its work"),
                          ("kill", "died of signal 9 (Killed)")):
            run = self.run_it("build", self.recipe, "-o", self.out, "-k", "--json", env=self.environment(how))
            self.assertEqual(run.code, 1, run)
            counts = run.json
            # Each of its images is tried twice.
            self.assert_counts(counts, images=IMAGES + VIEWS, built=IMAGES, reused=0, failed=VIEWS, not_reached=0,
                               deaths=2 * VIEWS)
            # What was kept as the process died counts too, once.
            self.assert_counts(counts, traced=IMAGES, developed=IMAGES, traced_samples=IMAGES * SAMPLES)
            self.assertNotEqual(counts["device"], "")
            self.assertIn(f"large.off/0: the process that made it {told}; it is tried once more", run.err)
            self.assertIn(f"large.off/0: the process that made it {told}, again", run.err)
            self.assertEqual(len(counts["failures"]), 1, counts)
            self.assertEqual(counts["failures"][0]["why"], f"the process that made it {told}, 2 times")
            self.assertEqual([id for id in self.listed() if id.startswith("large")], [])
            self.assertEqual(len(self.listed()), IMAGES)
            self.assertEqual(run.err.count("large.off/0"), 3, run)
            # What was made is whole, and a device that is well makes the rest.
            self.assertIn(f"{IMAGES} images, {2 * IMAGES} files: {VIEWS} differences", self.run_it("verify", self.out).out)
            self.assert_counts(self.build(), built=VIEWS, reused=IMAGES, deaths=0)
            subprocess.run(["rm", "-rf", str(self.out)], check=True)

    def test_without_keep_going_it_ends_as_at_any_failure(self):
        run = self.run_it("build", self.recipe, "-o", self.out, "--json", env=self.environment("segv"))
        self.assertEqual(run.code, 1, run)
        self.assert_counts(run.json, failed=1, deaths=2, traced=run.json["built"])
        # The last process came to trace nothing.
        self.assertEqual(run.json["device"], self.device())

    def test_once_is_no_failure_and_gives_the_same_bytes(self):
        whole = self.folder / "whole"
        self.build(out=whole)
        for how in ("segv", "hang"):
            begin = time.monotonic()
            run = self.run_it("build", self.recipe, "-o", self.out, "--stall", str(STALL), "--json",
                              env=self.environment(how, once=True))
            self.assertEqual(run.code, 0, run)
            self.assert_counts(run.json, built=IMAGES + VIEWS, reused=0, failed=0, deaths=1, traced=IMAGES + VIEWS)
            # Both processes are at one build.
            told = [tuple(map(int, found)) for found in re.findall(r"^\[(\d+)/(\d+)\]", run.err, re.MULTILINE)]
            self.assertEqual({total for _, total in told}, {IMAGES + VIEWS}, run)
            self.assertEqual([done for done, _ in told], sorted({done for done, _ in told}), run)
            self.assertEqual(told[-1][0], IMAGES + VIEWS)
            # Of both processes.
            seconds = self.run_it("log", self.out, "--json").json["builds"][0]["seconds"]
            self.assertAlmostEqual(run.json["seconds"], seconds, places=3)
            self.assertGreaterEqual(seconds, STALL if how == "hang" else 0)
            self.assertLessEqual(seconds, time.monotonic() - begin)
            self.assertEqual(self.contents(), self.contents(whole))
            subprocess.run(["rm", "-rf", str(self.out), str(self.folder / "once")], check=True)

    def test_an_image_that_hangs_is_ended(self):
        run = self.run_it("build", self.recipe, "-o", self.out, "-k", "--stall", str(STALL), "--json", "--set", "camera.views=[0]",
                          env=self.environment("hang"))
        self.assertEqual(run.code, 1, run)
        self.assert_counts(run.json, built=2, failed=1, deaths=2)
        self.assertEqual(run.json["failures"][0]["why"],
                         f"the process that made it showed no sign of life for {STALL} s, 2 times")
        self.assertEqual(self.run_it("build", self.recipe, "--stall", "-1").code, 2)

    def test_less_than_healthy_images_take_is_refused(self):
        for seconds in ("0.01", "4.9"):
            run = self.run_it("build", self.recipe, "-o", self.out, "--stall", seconds)
            self.assertEqual((run.code, len(run.err.splitlines())), (2, 1), run)
            self.assertIn(f"build --stall: wanted at least 5 seconds, or 0 for never, got {seconds}: ", run.err)
        self.assertFalse(self.out.exists())
        self.assertEqual(self.run_it("build", self.recipe, "-o", self.out, "--stall", "0", "-n").code, 0)

    def stop_builders(self, process, times, by=signal.SIGSTOP):
        """Stops, one after another, the processes that build before their first image; how many came to be."""
        state, seen = self.out / ".dsbuild/dsbuild.sqlite", set()
        end = time.monotonic() + 120
        while process.poll() is None and time.monotonic() < end:
            children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
            for child in map(int, children):
                if child not in seen and len(seen) < times and state.exists():
                    os.kill(child, by)
                    seen.add(child)
            time.sleep(0.001)
        return len(seen)

    def test_a_process_that_stops_before_its_first_image_is_ended(self):
        (self.tiny / "models/large.off").unlink()
        process = self.start("build", self.recipe, "-o", self.out, "--stall", str(STALL), "--json")
        self.addCleanup(process.kill)
        self.assertEqual(self.stop_builders(process, 1), 1)
        out, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, err)
        self.assert_counts(json.loads(out), built=IMAGES, reused=0, failed=0, deaths=1)
        self.assertIn(f"the process that builds showed no sign of life for {STALL} s before its first image; another one goes on",
                      err)
        self.assertEqual(self.run_it("verify", self.out).code, 0)

    def test_a_process_that_is_killed_before_its_first_image_is_begun_again_once(self):
        (self.tiny / "models/large.off").unlink()
        told = "the process that builds died of signal 9 (Killed) before its first image"
        process = self.start("build", self.recipe, "-o", self.out, "--json")
        self.addCleanup(process.kill)
        self.assertEqual(self.stop_builders(process, 1, signal.SIGKILL), 1)
        out, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, err)
        self.assert_counts(json.loads(out), built=IMAGES, reused=0, failed=0, deaths=1)
        self.assertIn(f"dsbuild: warning: {told}; another one goes on\n", err)
        self.assertEqual(self.run_it("verify", self.out).code, 0)
        process = self.start("build", self.recipe, "-o", self.out, "--force")
        self.addCleanup(process.kill)
        self.assertEqual(self.stop_builders(process, 2, signal.SIGKILL), 2)
        err = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 1, err)
        self.assertIn(f"dsbuild: error: {told}, again; ", err)

    def test_a_process_that_always_stops_before_its_first_image_is_given_up(self):
        process = self.start("build", self.recipe, "-o", self.out, "--stall", str(STALL))
        self.addCleanup(process.kill)
        # The second is stopped as soon as it is there, before it can say what --stall was.
        state = self.out / ".dsbuild/dsbuild.sqlite"
        self.stop_builders(process, 2)
        _, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1, err)
        self.assertTrue(state.exists())
        self.assertIn(f"error: the process that builds showed no sign of life for {STALL} s before its first image, again", err)

    def test_waiting_for_others_is_no_hang(self):
        state = self.out / ".dsbuild"
        state.mkdir(parents=True)
        with open(state / "lock", "w", encoding="utf-8") as lock:  # as store gc holds it
            fcntl.lockf(lock, fcntl.LOCK_EX, 1)
            process = self.start("build", self.recipe, "-o", self.out, "--stall", str(STALL))
            self.addCleanup(process.kill)
            time.sleep(2)
            waiting = sorted(self.others())
            time.sleep(STALL + 3)
            self.assertEqual(sorted(self.others()), waiting)
            self.assertIsNone(process.poll())
            process.send_signal(signal.SIGTERM)
            err = process.communicate(timeout=60)[1]
        self.assertNotIn("no sign of life", err)

    def test_a_stopped_process_can_be_told_to_stop(self):
        process = self.start("build", self.recipe, "-o", self.out)
        self.addCleanup(process.kill)
        while not (self.out / ".dsbuild/dsbuild.sqlite").exists():
            time.sleep(0.001)
        child = int(pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text())
        os.kill(child, signal.SIGSTOP)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=30)
        self.assertEqual(process.returncode, -signal.SIGTERM)
        self.assertEqual(self.others(), [])

    def test_a_device_that_crashes_at_everything_is_given_up(self):
        environment = {**self.environment("segv"), "DS_SHIM_BYTES": "1"}
        run = self.run_it("build", self.recipe, "-o", self.out, "-k", env=environment)
        self.assertEqual(run.code, 1, run)
        self.assertIn("10 processes in a row died with no image made", run.err)
        run = self.run_it("build", self.recipe, "-o", self.out, "-k", "--json", env=environment)
        self.assert_counts(run.json, kind="device", exit_code=1, built=0, traced=0, deaths=10)

    def behind(self, file, once):
        """An environment in which a process is killed as it gives a finished file its name."""
        environment = self.environment("kill", once)
        del environment["DS_SHIM_BYTES"]
        return {**environment, "DS_SHIM_FILE": file}

    def test_a_process_that_is_killed_behind_its_last_image_is_begun_again_once(self):
        all_made = {"built": IMAGES + VIEWS, "traced": IMAGES + VIEWS, "developed": IMAGES + VIEWS,
                    "traced_samples": (IMAGES + VIEWS) * SAMPLES, "device": self.device()}
        told = "the process that builds died of signal 9 (Killed) behind its last image, as the manifest is written"
        for file in ("manifest/images.jsonl", "manifest/dataset.json"):
            for more in ((), ("--force",)):
                run = self.run_it("build", self.recipe, "-o", self.out, "--json", *more, env=self.behind(file, once=True))
                self.assertEqual(run.code, 0, run)
                self.assert_counts(run.json, deaths=1, reused=0, failed=0, **all_made)
                self.assertIn(f"dsbuild: warning: {told}; another one goes on\n", run.err)
                self.assertEqual(self.run_it("verify", self.out).code, 0)
                subprocess.run(["rm", "-rf", str(self.out), str(self.folder / "once")], check=True)
        run = self.run_it("build", self.recipe, "-o", self.out, "--json", env=self.behind(file, once=False))
        self.assertEqual(run.code, 1, run)
        self.assert_counts(run.json, deaths=2, kind="internal", exit_code=1, **all_made)
        self.assertEqual(run.json["failures"][0]["why"], run.json["error"])
        self.assertEqual(run.err.count("dsbuild: error: "), 1, run)
        self.assertIn(f"dsbuild: error: {told}, again; ", run.err)
        self.assert_counts(self.build(), built=0, reused=IMAGES + VIEWS)

    def test_what_is_traced_and_not_in_place_yet_counts_once(self):
        (self.tiny / "models/large.off").unlink()
        run = self.run_it("build", self.recipe, "-o", self.out, "--json", env=self.behind("0.png", once=True))
        self.assertEqual(run.code, 0, run)
        self.assert_counts(run.json, built=IMAGES, traced=IMAGES, developed=IMAGES, traced_samples=IMAGES * SAMPLES, deaths=1)

    def test_one_that_dies_when_all_is_done_has_done_all(self):
        for how in ("segv", "kill"):
            environment = {**self.environment(how), "DS_SHIM_EXIT": "1"}
            del environment["DS_SHIM_BYTES"]
            run = self.run_it("build", self.recipe, "-o", self.out, "--json", env=environment)
            self.assertEqual((run.code, len(run.out.splitlines())), (0, 1), run)
            self.assert_counts(run.json, deaths=0)
            self.assertIn("when all was done\n", run.err)

    def test_to_stop_a_process_that_hangs_ends_both(self):
        process = self.start("build", self.recipe, "-o", self.out, env=self.environment("hang"))
        time.sleep(1)
        process.send_signal(signal.SIGTERM)
        time.sleep(0.5)
        process.send_signal(signal.SIGTERM)  # the second wish does not wait for what is under way
        process.communicate(timeout=20)
        self.assertEqual(process.returncode, -signal.SIGTERM)
        self.assertEqual(self.others(), [])

    def test_killed_it_leaves_no_process(self):
        process = self.start("build", self.recipe, "-o", self.out, env=self.environment("hang"))
        time.sleep(1)
        process.kill()
        process.communicate(timeout=20)
        end = time.monotonic() + 20
        while self.others() and time.monotonic() < end:
            time.sleep(0.05)
        self.assertEqual(self.others(), [])
        counts = self.build()
        self.assert_counts(counts, built=IMAGES + VIEWS - counts["reused"], failed=0)

    def others(self):
        """Processes that make this dataset and have not ended."""
        found = []
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                command, status = (process / "cmdline").read_bytes(), (process / "stat").read_text()
            except OSError:  # it has ended meanwhile
                continue
            if str(self.out).encode() in command and status.rpartition(")")[2].split()[0] not in "ZX":
                found.append(int(process.name))
        return found


if __name__ == "__main__":
    SupervisorTest.shim = os.path.abspath(sys.argv.pop())
    main()
