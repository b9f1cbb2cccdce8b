# SPDX-License-Identifier: Apache-2.0
"""A build as a process: signals, terminals, and standard streams that nobody reads."""
import fcntl
import json
import os
import pty
import re
import resource
import shutil
import signal
import struct
import subprocess
import termios
import time

from harness import IMAGES, TinyCase, main

# What users, terminals and batch systems end a process by.
STOPS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGXCPU, signal.SIGUSR1, signal.SIGUSR2)
SLOW = ["--set", "engine.spp=2000"]  # an image takes a second, long enough to be interrupted


class ProcessCase(TinyCase):
    def setUp(self):
        super().setUp()
        self.build("--set", "engine.spp=2", out=self.folder / "warm")  # compiles the programs

    def pictures(self):
        return sorted(self.out.glob("images/*/*.png"))

    def wait_for_picture(self):
        end = time.monotonic() + 120
        while not self.pictures():
            self.assertLess(time.monotonic(), end, "no picture in time")
            time.sleep(0.005)

    def manifest(self):
        path = self.out / "manifest/images.jsonl"
        return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []

    def assert_whole(self):
        self.assertEqual(len(self.manifest()), IMAGES)
        self.assertEqual(self.run_it("verify", self.out).code, 0)


class SignalTest(ProcessCase):
    def interrupt(self, number, ignored):
        prepare = (lambda: signal.signal(number, signal.SIG_IGN)) if ignored else None
        process = self.start("build", self.recipe, "-o", self.out, *SLOW, preexec_fn=prepare)
        self.wait_for_picture()
        process.send_signal(number)
        out, err = process.communicate(timeout=120)
        return process.returncode, out, err

    def test_it_dies_of_the_signal_and_keeps_what_is_finished(self):
        for number in STOPS:
            code, out, err = self.interrupt(number, False)
            self.assertEqual(code, -number, err)
            self.assertIn("not reached", out)
            self.assertIn("what is finished is recorded", err)
            listed = {file["path"] for line in self.manifest() for file in line["files"]}
            self.assertEqual(listed, {path.relative_to(self.out).as_posix() for path in self.pictures()})
            self.assertTrue(0 < len(listed) < 2 * IMAGES, listed)
            self.tearDownOut()

    def tearDownOut(self):
        subprocess.run(["rm", "-rf", str(self.out)], check=True)

    def test_ignored_at_the_start_stays_ignored(self):
        for number in STOPS:
            code, _, err = self.interrupt(number, True)
            self.assertEqual(code, 0, err)
            self.assert_whole()
            self.tearDownOut()

    def test_a_limit_of_processor_time_ends_it_cleanly(self):
        # The kernel tells it at the soft limit, and again every second.
        process = self.start("build", self.recipe, "-o", self.out, "--set", "engine.spp=20000",
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (3, 100)))
        out, err = process.communicate(timeout=300)
        self.assertEqual(process.returncode, -signal.SIGXCPU, err)
        self.assertIn("not reached", out)
        self.assertIn("what is finished is recorded", err)

    def test_before_anything_is_traced_it_ends_at_once(self):
        # Waiting for another build, which makes something else.
        other = self.start("build", self.recipe, "-o", self.out, *SLOW)
        self.wait_for_picture()
        for number in STOPS:
            process = self.start("build", self.recipe, "-o", self.out, "--device", "pthread")
            self.assertIn("waiting for another build", process.stderr.readline())
            process.send_signal(number)
            process.communicate(timeout=20)
            self.assertEqual(process.returncode, -number)
        self.assertIsNone(other.poll(), "it builds on")
        other.kill()
        other.communicate()

    def start_long_image(self):
        # One image of minutes: the second signal comes while the first is being heeded.
        process = self.start("build", self.recipe, "-o", self.out, "--set", "engine.spp=20000", "--set",
                             "engine.width=256", "--set", "engine.height=256", "--store", self.folder / "store")
        time.sleep(1.0)
        self.assertIsNone(process.poll())
        return process

    def test_verbs_that_read_end_by_their_signal_and_leave_nothing(self):
        self.build()
        before, store = self.contents(), self.out / ".dsbuild"
        to = self.folder / "to"
        for words in (("verify", self.out), ("verify", self.out, "--rerender", "8"), ("store", "verify", store),
                      ("store", "gather", store, to), ("diff", self.out, self.out),
                      ("export", self.out, "--format", "csv", "-o", to), ("gallery", self.out, "-o", to)):
            for stop in (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1):
                # Stopped at once, so that it cannot have ended before the signal comes.
                process = self.start(*words)
                self.addCleanup(process.kill)
                time.sleep(0.02)
                process.send_signal(signal.SIGSTOP)
                process.send_signal(stop)
                process.send_signal(signal.SIGCONT)
                process.communicate(timeout=60)
                self.assertIn(process.returncode, (0, -stop), words)
                if words[0] in ("export", "gallery") and process.returncode != 0:
                    self.assertFalse(to.exists())
                shutil.rmtree(to, ignore_errors=True)
        self.assertEqual(self.contents(), before)
        self.assertEqual(self.run_it("store", "verify", store).code, 0)

    def test_two_at_once_are_one_wish(self):
        # A terminal that goes away and timeout(1) both tell it twice.
        for number in (signal.SIGHUP, signal.SIGTERM):
            process = self.start_long_image()
            process.send_signal(number)
            time.sleep(0.03)
            process.send_signal(number)
            _, err = process.communicate(timeout=120)
            self.assertEqual(process.returncode, -number, err)
            self.assertIn("what is finished is recorded", err)


class StreamsTest(ProcessCase):
    def build_with(self, *arguments, **options):
        self.out = self.folder / f"out-{len(list(self.folder.iterdir()))}"
        options = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, **options}
        return subprocess.run(self.command("build", self.recipe, "-o", self.out, *arguments), cwd=self.folder,
                              check=False, timeout=300, **options)

    def test_full_streams_end_no_build(self):
        with open("/dev/full", "w") as full:
            for options in ({"stdout": full}, {"stderr": full}, {"stdout": full, "stderr": full}):
                for arguments in ([], ["--explain"]):
                    self.assertEqual(self.build_with(*arguments, **options).returncode, 0, (arguments, options))
                    self.assert_whole()

    def test_closed_streams_end_no_build_and_lead_into_no_file(self):
        def close(descriptors):
            return lambda: [os.close(descriptor) for descriptor in descriptors]

        for closed in ([0], [1], [2], [0, 1, 2]):
            self.assertEqual(self.build_with(preexec_fn=close(closed)).returncode, 0, closed)
            self.assert_whole()
            for path in (self.out / ".dsbuild").rglob("*"):
                if path.is_file():
                    self.assertNotIn(b"manifest: ", path.read_bytes(), path)

    def test_readers_who_go_away_end_no_build(self):
        for stream in ("stdout", "stderr"):
            reading, writing = os.pipe()
            os.close(reading)
            run = self.build_with(**{stream: writing})
            os.close(writing)
            self.assertEqual(run.returncode, 0)
            self.assert_whole()

    def test_a_result_that_cannot_be_written_is_a_failure(self):
        self.build()
        commands = [["status", self.recipe], ["status", self.recipe, "--json"], ["plan", self.recipe],
                    ["verify", self.out], ["build", "-n", self.recipe], ["log", self.out], ["models", self.recipe],
                    ["explain", self.out, "box.off/0"], ["--help"], ["build", "--help"], ["--version"],
                    ["build", self.recipe, "-o", self.out, "--json"]]
        with open("/dev/full", "w") as full:
            for command in commands:
                run = subprocess.run(self.command(*command), cwd=self.folder, stdout=full, stderr=subprocess.PIPE,
                                     text=True, check=False)
                self.assertEqual(run.returncode, 1, (command, run.stderr))
                self.assertIn("standard output: cannot write: No space left on device", run.stderr)
        run = subprocess.run(self.command("status", self.recipe), cwd=self.folder, stderr=subprocess.PIPE, text=True,
                             check=False, preexec_fn=lambda: os.close(1))
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertIn("standard output: cannot write: Bad file descriptor", run.stderr)

    def test_a_reader_who_has_enough_is_no_failure(self):
        # As every tool: `dsbuild plan ... | head -1` ends it quietly.
        run = subprocess.run(["bash", "-c", '"$@" | head -c 0; exit ${PIPESTATUS[0]}', "bash",
                              *self.command("plan", self.recipe)],
                             cwd=self.folder, capture_output=True, text=True, check=False,
                             preexec_fn=lambda: signal.signal(signal.SIGPIPE, signal.SIG_DFL))
        self.assertIn(run.returncode, (0, 128 + signal.SIGPIPE))
        self.assertEqual(run.stderr, "")


class TerminalTest(ProcessCase):
    def on_terminal(self, *arguments, columns=80, during=None, term="xterm"):
        ours, theirs = pty.openpty()
        self.resize(theirs, columns)
        process = subprocess.Popen(self.command("build", self.recipe, "-o", self.out, *arguments), cwd=self.folder,
                                   stdin=subprocess.DEVNULL, stdout=theirs, stderr=theirs, start_new_session=True,
                                   env={**os.environ, "TERM": term})
        written = b""
        if during:
            during(ours, theirs)
        os.close(theirs)
        while True:
            try:
                part = os.read(ours, 4096)
            except OSError:
                part = b""
            if not part:
                break
            written += part
        try:
            os.close(ours)
        except OSError:
            pass  # `during` has closed it
        return written.decode(errors="replace"), process.wait(120)

    @staticmethod
    def resize(terminal, columns):
        fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))

    def progress(self, written):
        return [piece for piece in re.split(r"\r\x1b\[K|\r\n", written) if re.match(r"\[\d+/\d+\]", piece)]

    def test_a_terminal_that_goes_away_ends_no_build(self):
        def close(ours, theirs):
            self.wait_for_picture()
            os.close(ours)

        _, code = self.on_terminal(*SLOW, during=close)
        self.assertEqual(code, 0)
        self.assert_whole()

    def test_lines_fit_and_follow_the_width(self):
        long_name = "\u6905\u5b50-" * 20 + ".off"
        (self.tiny / "models/box.off").rename(self.tiny / "models" / long_name)
        for columns in (200, 80, 40, 12, 1):
            written, code = self.on_terminal(columns=columns)
            self.assertEqual(code, 0, written)
            lines = self.progress(written)
            wide = [line for line in lines if len(line) + sum("\u2e80" <= c < "\ua000" for c in line) > columns]
            self.assertEqual(wide, [], columns)
            self.assertTrue(columns < 10 or lines, written)
            self.assertEqual(columns >= 80, any("Msamples/s  ETA" in line for line in lines) and columns >= 80, lines)
            subprocess.run(["rm", "-rf", str(self.out)], check=True)

    def test_a_window_that_shrinks(self):
        def shrink(ours, theirs):
            self.wait_for_picture()
            self.resize(theirs, 30)
            os.write(theirs, b"\r\nNARROW\r\n")

        written, code = self.on_terminal(*SLOW, columns=120, during=shrink)
        self.assertEqual(code, 0)
        lines = self.progress(written.partition("NARROW")[2])
        # One line may have been on its way already.
        self.assertLessEqual(max(map(len, lines[1:])), 30)

    def test_warnings_stand_on_lines_of_their_own_and_once(self):
        (self.tiny / "models/third.off").write_text((self.tiny / "models/box.off").read_text())
        self.edit_damaged_image()
        written, code = self.on_terminal()
        self.assertEqual(code, 0, written)
        pieces = re.split(r"\r\x1b\[K|\r\n", written)
        warnings = [piece for piece in pieces if "dsbuild: warning:" in piece]
        self.assertEqual(len([line for line in warnings if "negative values" in line]), 1, written)
        for line in warnings:
            self.assertTrue(line.startswith("dsbuild: warning:"), line)
        self.assertTrue(self.progress(written))

    def edit_damaged_image(self):
        """A material with a texture that has a negative value: a PFM of two pixels."""
        pixels = struct.pack("<6f", -1, 0.5, 0.5, 0.5, 0.5, 0.5)
        (self.tiny / "materials/t.pfm").write_bytes(b"PF\n2 1\n-1.0\n" + pixels)
        for path in (self.tiny / "materials").glob("*.mat"):
            path.write_text("scene.textures.t.type = imagemap\nscene.textures.t.file = t.pfm\n"
                            "scene.textures.t.gamma = 1\nscene.textures.t.mapping.type = uvmapping2d\n"
                            f"scene.materials.{path.stem}.type = matte\nscene.materials.{path.stem}.kd = t\n")

    def test_a_dumb_terminal_gets_lines(self):
        written, code = self.on_terminal(term="dumb")
        self.assertEqual(code, 0)
        self.assertNotIn("\x1b", written)
        self.assertEqual(len(self.progress(written)), IMAGES)


if __name__ == "__main__":
    main()
