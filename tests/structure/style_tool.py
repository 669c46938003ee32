"""Where Debian 12's clang-format and clang-tidy are: other versions have other opinions of the same source."""
import re
import shutil
import subprocess

VERSION = "14"


def find(name):
    """The command, or None where that version is missing; then it is told how to get it."""
    for command in (f"{name}-{VERSION}", name):
        if shutil.which(command):
            version = subprocess.run([command, "--version"], capture_output=True, text=True, check=True).stdout
            if re.search(rf"version {VERSION}\.", version):
                return command
    print(f"{name} {VERSION} is missing (Debian 12: apt-get install {name})")
    return None
