"""Display servers for tests: a virtual X display, a Wayland compositor without a screen."""
import contextlib
import os
import pathlib
import subprocess
import time


@contextlib.contextmanager
def _server(command, **settings):
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **settings)
    try:
        yield process
    finally:
        process.kill()
        process.wait()


@contextlib.contextmanager
def x_server(size="640x480"):
    """Xvfb's process, and the variables for its clients. Lives on without clients."""
    ready, told = os.pipe()
    with _server(["Xvfb", "-displayfd", str(told), "-noreset", "-screen", "0", f"{size}x24"], pass_fds=[told]) as process:
        os.close(told)
        with os.fdopen(ready) as number:
            yield process, {"DISPLAY": ":" + number.readline().strip()}


@contextlib.contextmanager
def wayland_server(folder):
    """Weston's process, and the variables for its clients. `folder`: for its socket, not shared."""
    variables = {"XDG_RUNTIME_DIR": str(folder), "WAYLAND_DISPLAY": "of-test"}
    with _server(["weston", "--backend=headless-backend.so", "--socket=of-test", "--idle-time=0"],
                 env=dict(os.environ, XDG_RUNTIME_DIR=str(folder))) as process:
        while not (pathlib.Path(folder) / "of-test").exists():
            if process.poll() is not None:
                raise RuntimeError("weston does not start")
            time.sleep(0.05)
        yield process, variables
