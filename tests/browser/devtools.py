# SPDX-License-Identifier: Apache-2.0
"""A headless chromium and the DevTools protocol over a pipe: JSON texts that end in a zero byte, fd 3 in, fd 4 out."""
import base64
import json
import os
import pathlib
import select
import shutil
import signal
import subprocess
import tempfile
import time

TIMEOUT_S = 120


def find_browser():
    """Path of a chromium, or None."""
    return next((path for path in map(shutil.which, ("chromium", "chromium-browser", "google-chrome")) if path), None)


class Browser:
    """One page in one browser; `events` keeps whatever the page reported."""

    def __init__(self, executable, *options):
        self.events = []
        self._profile = tempfile.TemporaryDirectory(prefix="dsbuild-browser-")
        to_browser, self._out = os.pipe()
        self._in, from_browser = os.pipe()

        def take_pipes():
            # Copies first: either may already be 3 or 4.
            first, second = os.dup(to_browser), os.dup(from_browser)
            while min(first, second) < 5:
                first, second = os.dup(first), os.dup(second)
            os.dup2(first, 3)
            os.dup2(second, 4)

        self._process = subprocess.Popen(
            [executable, "--headless", "--no-sandbox", "--disable-gpu", "--disable-extensions",
             "--disable-background-networking", "--no-first-run", "--remote-debugging-pipe",
             f"--user-data-dir={self._profile.name}", *options, "about:blank"],
            preexec_fn=take_pipes, close_fds=False, start_new_session=True, stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=dict(os.environ, HOME=self._profile.name))
        os.close(to_browser)
        os.close(from_browser)
        self._buffer = b""
        self._number = 0
        self._session = None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")

    def close(self):
        os.close(self._out)
        self._process.terminate()
        self._process.wait(30)
        try:
            os.killpg(self._process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        os.close(self._in)
        # Its helpers may write into the folder until they are gone.
        for attempt in range(50):
            try:
                return self._profile.cleanup()
            except OSError:
                if attempt == 49:
                    raise
                time.sleep(0.1)

    def _read(self, deadline):
        while b"\0" not in self._buffer:
            ready, _, _ = select.select([self._in], [], [], max(0, deadline - time.monotonic()))
            data = os.read(self._in, 1 << 20) if ready else b""
            if not data:
                raise TimeoutError("the browser said nothing" if not ready else "the browser is gone")
            self._buffer += data
        text, self._buffer = self._buffer.split(b"\0", 1)
        message = json.loads(text)
        if "method" in message:
            self.events.append(message)
        return message

    def call(self, method, **parameters):
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self._out, data):]
        deadline = time.monotonic() + TIMEOUT_S
        while True:
            answer = self._read(deadline)
            if answer.get("id") == self._number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def open(self, url):
        self.events = []
        self.call("Page.navigate", url=url)
        deadline = time.monotonic() + TIMEOUT_S
        while not any(event["method"] == "Page.loadEventFired" for event in self.events):
            self._read(deadline)

    def value(self, expression):
        """Of a JavaScript expression, as JSON; of a promise what it becomes."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"])
        return answer["result"].get("value")

    def press(self, key, text=""):
        """As a person would, on what has the focus."""
        code = {"Enter": 13, "Escape": 27, "Tab": 9}.get(key, 0)
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, windowsVirtualKeyCode=code,
                      **({"text": text or key} if kind == "keyDown" and len(text or key) == 1 else {}))

    def screenshot(self, path):
        path.write_bytes(base64.b64decode(self.call("Page.captureScreenshot")["data"]))

    def renderer_bytes(self):
        """Resident memory of the process that shows the page, the largest of them."""
        parents, renderers = {}, []
        for folder in pathlib.Path("/proc").iterdir():
            try:
                # Behind the name, which may hold anything in its brackets: state, parent.
                parents[int(folder.name)] = int((folder / "stat").read_text().rsplit(")", 1)[1].split()[1])
                if b"--type=renderer" in (folder / "cmdline").read_bytes():
                    renderers.append(int(folder.name))
            except (OSError, ValueError):
                continue

        def is_own(process):
            while process > 1 and process != self._process.pid:
                process = parents.get(process, 0)
            return process == self._process.pid

        most = 0
        for process in filter(is_own, renderers):
            most = max(most, int(pathlib.Path(f"/proc/{process}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE"))
        return most

    def seen(self, *methods):
        return [event["params"] for event in self.events if event["method"] in methods]
