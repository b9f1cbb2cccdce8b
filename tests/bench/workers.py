# SPDX-License-Identifier: Apache-2.0
"""Renderers as processes that answer requests (protocol: render_bench.cc), one a renderer and scene. Idle ones wait."""
import json
import os
import pathlib
import select
import subprocess
import time
from typing import NamedTuple, Optional

ANSWER_TIMEOUT_SECONDS = 1800


class Failed(Exception):
    """A renderer ended or hung; the message says where its own words are."""


class Answer(NamedTuple):
    seconds: float
    cpu_seconds: float
    samples: float
    film: pathlib.Path

    def msamples_per_second(self) -> float:
        return 1e-6 * self.samples / self.seconds

    def msamples_per_cpu_second(self) -> float:
        return 1e-6 * self.samples / max(self.cpu_seconds, 1e-9)


class Worker:
    def __init__(self, label: str, command: list, log: pathlib.Path, environment: Optional[dict] = None):
        self.label, self.log = label, log
        self.log_file = open(log, "wb")
        self.process = subprocess.Popen([str(c) for c in command], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=self.log_file, env=os.environ | (environment or {}))
        self.pending = b""
        self.name = self.read_answer()["name"]

    def read_answer(self) -> dict:
        deadline = time.monotonic() + ANSWER_TIMEOUT_SECONDS
        while b"\n" not in self.pending:
            ready, _, _ = select.select([self.process.stdout], [], [], max(0.0, deadline - time.monotonic()))
            chunk = os.read(self.process.stdout.fileno(), 65536) if ready else b""
            if not chunk:
                self.close()
                why = "ended" if ready else f"gave no answer in {ANSWER_TIMEOUT_SECONDS} s"
                raise Failed(f"{self.label} {why}, see {self.log}")
            self.pending += chunk
        line, self.pending = self.pending.split(b"\n", 1)
        return json.loads(line)

    def trace(self, size: int, spp: int, seed: int, film: pathlib.Path) -> Answer:
        try:
            self.process.stdin.write(f"{size} {size} {spp} {seed} {film}\n".encode())
            self.process.stdin.flush()
        except BrokenPipeError as error:
            raise Failed(f"{self.label} ended, see {self.log}") from error
        answer = self.read_answer()
        return Answer(answer["seconds"], answer["cpu_seconds"], answer["samples"], film)

    def close(self) -> None:
        """Ends the process: by the end of its input, else by force (of this process alone)."""
        try:
            self.process.stdin.close()
        except BrokenPipeError:
            pass
        try:
            self.process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.log_file.close()
