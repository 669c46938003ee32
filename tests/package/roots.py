#!/usr/bin/env python3
"""The packages in bare roots of other systems, made by debootstrap: what a user does there, and that nothing is left
afterwards. Needs root and the packages debootstrap and xvfb, for Ubuntu ubuntu-keyring, too; a suite takes a few
minutes. Prints a table.

usage: roots.py WORK ARCHIVE DEB DEMO SUITE...    e.g. roots.py /tmp/roots build/packages/*.tar.gz … bullseye bookworm trixie jammy

WORK: folder for the roots, kept for the next time. DEMO: vitrine_demo, linked with the C library of the packages (build target
vitrine_demo of the preset portable with VITRINE_TESTS=ON), an offscreen program.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import time

DEBIAN = "http://deb.debian.org/debian"
UBUNTU = "http://archive.ubuntu.com/ubuntu", "--components=main,universe", "--keyring=/usr/share/keyrings/ubuntu-archive-keyring.gpg"
SUITES_OF_UBUNTU = ("focal", "jammy", "noble")
# Their vulkaninfo does not know --summary.
WITHOUT_SUMMARY = ("bullseye", "focal")
# What is no trace of the packages: what apt, dpkg and the loader's programs keep for themselves.
NOT_TRACES = ("proc", "sys", "dev", "tmp", "run", "var/cache", "var/log", "var/lib/apt", "var/lib/dpkg", "root/.cache")
DISPLAY = ":97"


class Root:
    def __init__(self, folder, suite):
        self.folder = folder / suite
        if not (self.folder / "usr/bin/apt-get").exists():
            mirror, *options = UBUNTU if suite in SUITES_OF_UBUNTU else (DEBIAN,)
            subprocess.run(["debootstrap", "--variant=minbase", *options, suite, self.folder, mirror], check=True, capture_output=True)
        for system in ("proc", "dev"):
            if not os.path.ismount(self.folder / system):
                subprocess.run(["mount", "--bind", f"/{system}", self.folder / system], check=True)
        # The display server's socket.
        (self.folder / "tmp/.X11-unix").mkdir(parents=True, exist_ok=True)
        if not os.path.ismount(self.folder / "tmp/.X11-unix"):
            subprocess.run(["mount", "--bind", "/tmp/.X11-unix", self.folder / "tmp/.X11-unix"], check=True)

    def run(self, command, code=0):
        """What the shell command says; seconds that it took."""
        start = time.monotonic()
        result = subprocess.run(["chroot", self.folder, "sh", "-c", command], capture_output=True, text=True, check=False,
                                env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "DISPLAY": DISPLAY, "HOME": "/root", "LC_ALL": "C.UTF-8",
                                     "DEBIAN_FRONTEND": "noninteractive"})
        if code is not None and result.returncode != code:
            raise SystemExit(f"{self.folder.name}: {command}: exit status {result.returncode}\n{result.stdout}{result.stderr}")
        return result.stdout + result.stderr, time.monotonic() - start

    def files(self):
        out = set()
        for path, folders, names in os.walk(self.folder):
            here = os.path.relpath(path, self.folder)
            folders[:] = [name for name in folders if os.path.normpath(os.path.join(here, name)) not in NOT_TRACES]
            out.update(os.path.normpath(os.path.join(here, name)) for name in names + folders)
        return out

    def leave(self):
        for system in ("tmp/.X11-unix", "proc", "dev"):
            subprocess.run(["umount", "-l", self.folder / system], check=False)


def look(root, where, prefix):
    """Programs on the device: `prefix` runs one."""
    row = {}
    summary, row["vulkaninfo"] = root.run(f"{prefix} vulkaninfo{' --summary' if root.folder.name not in WITHOUT_SUMMARY else ''}")
    if "Vitrine" not in summary:
        raise SystemExit(f"{root.folder.name}, {where}: vulkaninfo does not tell of the device\n{summary}")
    if any(word in summary for word in ("WARNING", "ERROR")):
        raise SystemExit(f"{root.folder.name}, {where}: vulkaninfo warns\n{summary}")
    said, row["vkcube"] = root.run(f"{prefix} vkcube --c 60")
    picture, row["demo"] = root.run(f"{prefix} /tmp/demo /tmp/demo.png && sha256sum /tmp/demo.png")
    row["picture"] = picture.split()[-2][:12]
    return row


def try_suite(folder, suite, archive, deb, demo):
    root = Root(folder, suite)
    try:
        root.run("apt-get update && apt-get install -y --no-install-recommends vulkan-tools libvulkan1 libpng16-16* && apt-get clean")
        for file, name in (archive, "archive.tar.gz"), (deb, "vitrine.deb"), (demo, "demo"):
            shutil.copy(file, root.folder / "tmp" / name)
        root.run("rm -rf /opt/vitrine; dpkg --purge vitrine", code=None)  # what a run that failed has left
        before = root.files()
        (root.folder / "opt/vitrine").mkdir()
        _, unpacked = root.run("tar xf /tmp/archive.tar.gz -C /opt/vitrine --strip-components=1")
        yield suite, "archive", unpacked, look(root, "archive", "/opt/vitrine/bin/vitrine run")
        root.run("rm -r /opt/vitrine")
        told = sorted(root.files() - before)
        _, installed = root.run("dpkg -i /tmp/vitrine.deb")
        yield suite, "deb", installed, look(root, "deb", "")
        root.run("dpkg --purge vitrine")
        told += sorted(root.files() - before)
        if told:
            raise SystemExit(f"{suite}: left behind: {told[:20]}")
    finally:
        root.leave()


def main():
    folder, archive, deb, demo, *suites = sys.argv[1:]
    os.makedirs("/tmp/.X11-unix", exist_ok=True)
    server = subprocess.Popen(["Xvfb", DISPLAY, "-screen", "0", "800x600x24"], stderr=subprocess.DEVNULL)
    time.sleep(2)
    pictures = set()
    try:
        print("| system | from | unpacked in | vulkaninfo | vkcube, 60 frames | demo | picture |\n|---|---|---|---|---|---|---|")
        for suite in suites:
            for name, kind, seconds, row in try_suite(pathlib.Path(folder), suite, archive, deb, demo):
                pictures.add(row["picture"])
                print(f"| {name} | {kind} | {seconds:.1f} s | {row['vulkaninfo']:.1f} s | {row['vkcube']:.1f} s | {row['demo']:.1f} s | {row['picture']} |",
                      flush=True)
    finally:
        server.terminate()
    if len(pictures) > 1:
        sys.exit("the pictures differ")


if __name__ == "__main__":
    main()
