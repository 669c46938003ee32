#!/usr/bin/env python3
"""Runs programs of others on this device and on the reference, and compares what they draw.

    tests/clients/clients.py [--driver MANIFEST] [--reference MANIFEST] [--keep DIR] [NAME...]

Prints a line per client: `equal`, `drawn` (the reference cannot run it, or the program draws no frame twice: a picture
with many colours came), `DIFFERS`, `FAILS`, or `absent` where the program is not installed. What a row needs stands at
its function; Debian 12 has all but Deno and Dawn (packages `deno` and `webgpu` of npm, looked for where NODE_PATH says).
Exit status: 0, or 1 if a client fails or differs. The tests of ./check do not need any of them."""

import argparse
import contextlib
import functools
import hashlib
import http.server
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
CLIENTS = {}


class Failed(Exception):
    pass


def client(needs, frames=True, colours=50, as_on=None):
    """A function of a Device that returns bytes or the text that stands for them. `needs`: programs; `frames`: whether
    its picture is the same each time; `colours`: that the screen shows at least; `as_on`: the client whose result on
    the reference stands in for its own."""
    def note(function):
        function.needs, function.frames, function.colours, function.as_on = needs, frames, colours, as_on
        CLIENTS[function.__name__.replace("_", "-")] = function
        return function
    return note


class Device:
    """A driver and a folder for what programs write while they run on it."""

    def __init__(self, manifest, folder, reference=None):
        self.folder, self.reference = folder, reference
        folder.mkdir(parents=True, exist_ok=True)
        self.environment = dict(os.environ, VK_DRIVER_FILES=str(manifest), VK_ICD_FILENAMES=str(manifest),
                                LP_PERF="no_rast_linear", VITRINE_DEVICE_TYPE="discrete", HOME=str(folder),
                                XDG_RUNTIME_DIR=str(folder), XDG_CACHE_HOME=str(folder), NO_AT_BRIDGE="1")

    def run(self, *command, seconds=120, **environment):
        done = subprocess.run([str(c) for c in command], env=self.environment | environment, cwd=self.folder,
                              capture_output=True, timeout=seconds, stdin=subprocess.DEVNULL)
        if done.returncode:
            raise Failed(f"exit status {done.returncode}: {last_line(done.stderr or done.stdout)}")
        return done.stdout

    def file(self, name):
        path = self.folder / name
        if not path.is_file():
            raise Failed(f"no {name} was written")
        return path

    def window(self, *command, seconds=6, **environment):
        """What the screen shows once it has stood still, or after so many seconds."""
        with Screen("640x480") as display, self.running(command, display, environment) as program:
            return self._still(program, display, seconds)

    def file_of(self, name, *command, seconds=300, **environment):
        """A file that a program writes, which does not end by itself."""
        path, end = self.folder / name, time.monotonic() + seconds
        path.unlink(missing_ok=True)
        with Screen() as display, self.running(command, display, environment) as program:
            size = 0
            while program.poll() is None and time.monotonic() < end and (size == 0 or path.stat().st_size > size):
                size = path.stat().st_size if path.is_file() else 0
                time.sleep(5)
        return self.file(name)

    @contextlib.contextmanager
    def running(self, command, display, environment):
        log = open(self.folder / "window.log", "wb")
        program = subprocess.Popen([str(c) for c in command], env=self.environment | environment | {
            "DISPLAY": display}, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
            start_new_session=True)
        try:
            yield program
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(program.pid, signal.SIGKILL)
            program.wait()

    def _still(self, program, display, seconds):
        """Three pictures alike: on a busy machine windows stand half drawn for a while."""
        last, alike, end = b"", 0, time.monotonic() + 10 * seconds
        while time.monotonic() < end:
            time.sleep(seconds / 3)
            if program.poll() is not None:
                raise Failed(f"ended by itself: {last_line((self.folder / 'window.log').read_bytes())}")
            now = subprocess.run(["import", "-display", display, "-window", "root", "-depth", "8", "rgb:-"],
                                 check=True, capture_output=True).stdout
            alike = alike + 1 if now == last else 0
            if alike == 2 and colours(now) > 2:
                return now
            last = now
        return last


class Screen:
    """A virtual one."""

    def __init__(self, size="1280x1024"):
        self.size = size

    def __enter__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", f"{self.size}x24", "-nocursor"],
                                       pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        return f":{os.read(read, 16).decode().strip()}"

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()


def last_line(text):
    lines = text.decode(errors="replace").strip().splitlines()
    return lines[-1] if lines else "it said nothing"


def colours(texels):
    return len({texels[i:i + 3] for i in range(0, len(texels), 3)})


# Filters and videos ---------------------------------------------------------------------------------------------------

FFMPEG_FILTERS = ["gblur_vulkan", "chromaber_vulkan=dist_x=5:dist_y=3", "hflip_vulkan", "transpose_vulkan",
                  "scale_vulkan=w=321:h=181", "libplacebo=w=480:h=300:upscaler=ewa_lanczos:format=rgba"]


@client(["ffmpeg"])
def ffmpeg(device):
    source = ["-f", "lavfi", "-i", "testsrc2=size=640x360:rate=5:duration=0.6"]
    return b"".join(device.run(
        "ffmpeg", "-v", "error", "-init_hw_device", "vulkan=vk:0", "-filter_hw_device", "vk", *source, "-vf",
        f"format=rgba,hwupload,{f},hwdownload,format=rgba", "-f", "framehash", "-") for f in FFMPEG_FILTERS)


@client(["gst-launch-1.0"])
def gstreamer(device):
    device.run("gst-launch-1.0", "-q", "videotestsrc", "num-buffers=3", "!",
               "video/x-raw,width=320,height=240,format=RGBA", "!", "vulkanupload", "!", "vulkancolorconvert", "!",
               "video/x-raw(memory:VulkanImage),format=BGRA", "!", "vulkandownload", "!", "filesink",
               "location=frames.raw")
    return device.file("frames.raw").read_bytes()


def mpv(device, *options, **environment):
    return device.window("mpv", "--no-config", "--no-audio", "--osc=no", "--pause", "--fullscreen", "--vo=gpu", "--gpu-sw",
                         "--scale=ewa_lanczos", *options, "av://lavfi:testsrc2=size=320x240:rate=5", **environment)


@client(["mpv", "Xvfb", "import"])
def mpv_vulkan(device):
    return mpv(device, "--gpu-api=vulkan")


ZINK = {"VITRINE_DEVICE_TYPE": "", "MESA_LOADER_DRIVER_OVERRIDE": "zink", "GALLIUM_DRIVER": "zink", "LIBGL_ALWAYS_SOFTWARE": "1"}


@client(["mpv", "Xvfb", "import"])
def mpv_zink(device):
    return mpv(device, "--gpu-api=opengl", **ZINK)


# Toolkits and engines -------------------------------------------------------------------------------------------------

@client(["/usr/lib/qt6/bin/qml", "Xvfb", "import"])
def qt_quick(device):
    """The seed of Qt's hash tables decides where in its texture a glyph lies, and so of the last bits of its edge."""
    return device.window("/usr/lib/qt6/bin/qml", HERE / "scene.qml", QSG_RHI_BACKEND="vulkan", QT_QPA_PLATFORM="xcb",
                         QSG_RENDER_LOOP="basic", QT_HASH_SEED="0")


@functools.cache
def recorded_race(manifest, folder):
    """Some frames of a race, recorded by gfxreconstruct on the device that offers less."""
    device = Device(manifest, folder)
    return device.file_of("race_frames_60_through_64.gfxr", "/usr/games/supertuxkart", "--render-driver=vulkan",
                          "--no-sound", "--windowed", "--screensize=640x480", "-N", "--track=lighthouse",
                          "--numkarts=4", "--profile-laps=1", GFXRECON_CAPTURE_FRAMES="60-64",
                          **recording(device, "race.gfxr"))


@client(["/usr/games/supertuxkart", "gfxrecon-replay", "Xvfb"])
def supertuxkart(device):
    return replayed(device, recorded_race(device.reference, device.folder.parent.parent / "race"), 5)


@client(["retroarch", "Xvfb", "import"], colours=6)
def retroarch(device):
    (device.folder / "retroarch.cfg").write_text('video_driver = "vulkan"\nmenu_driver = "rgui"\n')
    return device.window("retroarch", "--menu", "--config", device.folder / "retroarch.cfg", seconds=10)


# Other interfaces on Vulkan ------------------------------------------------------------------------------------------

@client(["vkd3d-triangle", "Xvfb", "import"])
def vkd3d_triangle(device):
    return device.window("vkd3d-triangle")


@client(["vkd3d-gears", "Xvfb", "import"], frames=False)
def vkd3d_gears(device):
    return device.window("vkd3d-gears")


@client(["glmark2", "Xvfb"])
def zink_glmark2(device):
    """Of each scene: whether its pixels are those that the program expects."""
    with Screen() as display:
        said = device.run("glmark2", "--validate", "--size", "200x200", DISPLAY=display, seconds=600, **ZINK).decode()
    return "\n".join(re.findall(r"^\[.*Validation: .*$", said, re.MULTILINE))


def module_of_node(name):
    for folder in os.environ.get("NODE_PATH", "").split(":"):
        if folder and (pathlib.Path(folder) / name).is_dir():
            return pathlib.Path(folder) / name
    return None


@client(["deno"])
def deno(device):
    """wgpu, as Deno has it."""
    program = device.folder / "program.mjs"
    program.write_text(f"import {{ picture }} from '{HERE}/webgpu.mjs';\nconsole.log(await picture(navigator.gpu));\n")
    return told_picture(device.run("deno", "run", "-A", "--unstable-webgpu", program).decode())


@client(["node", "npm:webgpu"], as_on="deno")
def dawn(device):
    program = device.folder / "program.mjs"
    entry = module_of_node("webgpu") / "index.js"
    program.write_text(f"import {{ create, globals }} from '{entry}';\nimport {{ picture }} from '{HERE}/webgpu.mjs';\n"
                       "Object.assign(globalThis, globals);\n"
                       "console.log(await picture(create(['backend=vulkan'])));\nprocess.exit(0);\n")
    return told_picture(device.run("node", program).decode())


class Pages(http.server.SimpleHTTPRequestHandler):
    """Browsers have WebGPU for pages of this machine only if a server brings them."""
    extensions_map = http.server.SimpleHTTPRequestHandler.extensions_map | {".mjs": "text/javascript"}

    def log_message(self, *_):
        pass


def chromium(device, page):
    server = http.server.ThreadingHTTPServer(("localhost", 0), functools.partial(Pages, directory=str(HERE)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        for _ in range(5):  # virtual time does not wait for what the device does: on a busy machine it can be over too soon
            shown = device.run(
                "chromium", "--no-sandbox", "--headless=new", "--use-gl=angle", "--use-angle=vulkan",
                "--use-vulkan=native", "--enable-features=Vulkan", "--ignore-gpu-blocklist", "--enable-unsafe-webgpu",
                "--enable-webgpu-developer-features", f"--user-data-dir={device.folder}/profile",
                "--virtual-time-budget=20000", "--dump-dom", f"http://localhost:{server.server_port}/{page}").decode()
            if ">nothing<" not in shown:
                break
    finally:
        server.shutdown()
    found = re.search(r'<pre id="result">(.*?)</pre>', shown)
    return told_picture(found[1] if found else "no page")


@client(["chromium"], as_on="deno")
def chromium_webgpu(device):
    return chromium(device, "webgpu.html")


@client(["chromium"])
def chromium_webgl(device):
    return chromium(device, "webgl.html")


def told_picture(line):
    """Of "hash colours device"."""
    words = line.split()
    if len(words) < 3 or not re.fullmatch("[0-9a-f]{64}", words[0]) or int(words[1]) < 50:
        raise Failed(line.strip() or "it said nothing")
    if "SwiftShader" in line:
        raise Failed(f"it took another device: {line.strip()}")
    return words[0]


# Tools ----------------------------------------------------------------------------------------------------------------

def recording(device, name):
    return {"VK_INSTANCE_LAYERS": "VK_LAYER_LUNARG_gfxreconstruct", "GFXRECON_CAPTURE_FILE": f"{device.folder}/{name}",
            "GFXRECON_CAPTURE_FILE_TIMESTAMP": "false"}


def replayed(device, file, frames):
    """The pictures of a recording. Images of another device's recording need memory as this device counts it
    (`-m rebind`)."""
    with Screen() as display:
        device.run("gfxrecon-replay", "-m", "rebind", "--screenshot-all", "--screenshot-dir", device.folder, file,
                   DISPLAY=display)
    pictures = sorted(device.folder.glob("screenshot_frame_*.bmp"))
    if len(pictures) != frames:
        raise Failed(f"{len(pictures)} pictures of {frames}")
    return b"".join(p.read_bytes() for p in pictures)


@client(["gfxrecon-replay", "vkcube", "Xvfb"])
def gfxreconstruct(device):
    """Records vkcube and shows what is recorded again."""
    with Screen() as display:
        device.run("vkcube", "--c", "8", DISPLAY=display, **recording(device, "cube.gfxr"))
    return replayed(device, device.file("cube.gfxr"), 8)


@client(["/usr/share/doc/python3-renderdoc", "vkcube", "Xvfb"])
def renderdoc(device):
    """Captures a frame of vkcube and replays it: the texels that the last draw leaves."""
    with Screen() as display:
        python = ("/usr/bin/python3", HERE / "renderdoc_frame.py")
        device.run(*python, "capture", device.folder / "cube", DISPLAY=display)
        captures = sorted(device.folder.glob("cube*.rdc"))
        if not captures:
            raise Failed("no capture")
        return device.run(*python, "texels", captures[0], DISPLAY=display)


@client(["vkcube", "Xvfb", "import", "/usr/share/vulkan/implicit_layer.d/vkBasalt.json"], frames=False)
def vkbasalt(device):
    return device.window("vkcube", ENABLE_VKBASALT="1")


# ----------------------------------------------------------------------------------------------------------------------

def is_there(need):
    return module_of_node(need[4:]) is not None if need.startswith("npm:") else shutil.which(need) is not None or \
        os.path.exists(need)


def result_on(manifest, folder, reference, name):
    """(bytes or text, or None; why there is none)."""
    absent = [need for need in CLIENTS[name].needs if not is_there(need)]
    if absent:
        return None, f"{name} needs {', '.join(absent)}"
    try:
        return CLIENTS[name](Device(manifest, folder / name, reference)), ""
    except Failed as failure:
        return None, str(failure)
    except subprocess.TimeoutExpired as late:
        return None, f"still running after {late.timeout:.0f} seconds"


def verdict(name, ours, theirs):
    result, why = ours(name)
    if result is None:
        return ("FAILS" if all(map(is_there, CLIENTS[name].needs)) else "absent"), why
    row = CLIENTS[name]
    if isinstance(result, bytes) and len(result) == 640 * 480 * 3 and colours(result) < row.colours:
        return "FAILS", f"{colours(result)} colours on the screen"
    if not row.frames:
        return "drawn", "no two pictures are of the same moment"
    other, reason = theirs(name)
    if other is None and row.as_on:
        other, reason = theirs(row.as_on)
        reason = reason or f"as {row.as_on} on the reference"
    if other is None:
        return "drawn", f"not on the reference: {reason}"
    digest = hashlib.sha256(result if isinstance(result, bytes) else result.encode()).hexdigest()[:16]
    return ("equal" if result == other else "DIFFERS"), f"{digest} {reason}".strip()


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--driver", default=ROOT / "build/release/icd/vitrine_icd.x86_64.json")
    arguments.add_argument("--reference", default="/usr/share/vulkan/icd.d/lvp_icd.x86_64.json")
    arguments.add_argument("--keep", type=pathlib.Path, help="folder for what the programs write")
    arguments.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(CLIENTS)}")
    asked = arguments.parse_args()
    unknown = set(asked.names) - set(CLIENTS)
    if unknown:
        arguments.error(f"no such client: {', '.join(sorted(unknown))}")
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        kept = asked.keep or pathlib.Path(folder)
        kept, reference = kept.absolute(), os.path.abspath(asked.reference)
        ours = functools.partial(result_on, os.path.abspath(asked.driver), kept / "ours", reference)
        theirs = functools.cache(functools.partial(result_on, reference, kept / "reference", reference))
        for name in asked.names or CLIENTS:
            word, why = verdict(name, ours, theirs)
            print(f"{name:16} {word:8} {why}", flush=True)
            bad += word in ("FAILS", "DIFFERS")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
