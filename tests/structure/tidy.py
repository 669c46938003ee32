#!/usr/bin/env python3
"""Runs clang-tidy over what the build compiles: the checks of .clang-tidy, every finding an error.

usage: tidy.py SOURCE_FOLDER BUILD_FOLDER [--jobs N] [PATH...]     PATH: only files below it
A file that passed is remembered by the content of all that it includes (as the build noted it), its command, the checks
and clang-tidy's version (Debian 12's, style_tool.py), in $XDG_CACHE_HOME/vitrine/clang-tidy: only what changed is run again, in any clone.
Exit status 1 and clang-tidy's messages if there are findings; 77 if clang-tidy is missing.
"""
import argparse
import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

import style_tool

KEPT_DAYS = 30  # how long a result that nobody asks for stays in the cache
FINDING = re.compile(r"^(?P<where>\S+:\d+:\d+): (?:warning|error|fatal error): ")


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("paths", nargs="*")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parsed = parser.parse_intermixed_args()
    parsed.source, parsed.build = parsed.source.resolve(), parsed.build.resolve()
    return parsed


def database(build):
    """The build's commands without what only GCC knows, which clang-tidy takes for an error."""
    return json.loads(re.sub(r" -mmem(?:cpy|set)-strategy=[^ ]+", "", (build / "compile_commands.json").read_text()))


def commands(args):
    """{file: compile command} of our own sources; a file that two targets compile is checked once."""
    wanted = [args.source / p for p in args.paths] or [args.source]
    result = {}
    for entry in args.database:
        path = pathlib.Path(entry["file"])
        if args.build not in path.parents and any(w == path or w in path.parents for w in wanted):
            result.setdefault(path, entry["command"])
    return result


def dependencies(build):
    """{object as ninja names it: the files its last compilation read}."""
    text = subprocess.run(["ninja", "-C", build, "-t", "deps"], capture_output=True, text=True, check=True).stdout
    result = {}
    for block in text.split("\n\n"):
        head, *files = block.strip().splitlines() or [""]
        if "(VALID)" in head:
            result[head.split(":")[0]] = [file.strip() for file in files]
    return result


@functools.cache
def content(path):
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return "missing"


class Cache:
    """Keys of files without findings, as empty files of those names."""

    def __init__(self, args):
        home = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache")
        self.folder = home / "vitrine/clang-tidy"
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError:
            self.folder = args.build / "clang-tidy"
            self.folder.mkdir(exist_ok=True)
        self.args = args
        self.read = dependencies(args.build)
        version = subprocess.run([args.tidy, "--version"], capture_output=True, text=True, check=True).stdout
        self.common = version + (args.source / ".clang-tidy").read_text()
        for entry in self.folder.iterdir():
            if time.time() - entry.stat().st_mtime > KEPT_DAYS * 86400:
                entry.unlink(missing_ok=True)

    def key(self, command):
        """None for a file that has not been built: what it includes is not known."""
        output = re.search(r" -o (\S+)", command)
        files = self.read.get(output.group(1)) if output else None
        if files is None:
            return None
        parts = [self.common, command.replace(str(self.args.source), ".")]
        parts += sorted(content((self.args.build / file).resolve()) for file in files)
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()

    def has(self, key):
        if key is None or not (self.folder / key).exists():
            return False
        (self.folder / key).touch()
        return True

    def add(self, key):
        if key is not None:
            (self.folder / key).touch()


def findings(args, path):
    """What clang-tidy says of one file: [(place, message with its lines of context)]; clang's own warnings are no findings."""
    run = subprocess.run([args.tidy, "-p", args.commands, "--quiet", "--extra-arg=-Wno-error", path], capture_output=True, text=True)
    messages = []
    for line in run.stdout.splitlines():
        match = FINDING.match(line)
        if match:
            messages.append((match.group("where"), [line]))
        elif messages:
            messages[-1][1].append(line)
    if run.returncode and not messages:
        messages.append((str(path), [f"{path}: clang-tidy failed:", run.stderr.strip()]))
    return messages


def main():
    args = arguments()
    args.tidy = style_tool.find("clang-tidy")
    if not args.tidy:
        return 77
    args.database = database(args.build)
    cache = Cache(args)
    keys = {path: cache.key(command) for path, command in commands(args).items()}
    todo = sorted(path for path, key in keys.items() if not cache.has(key))
    print(f"clang-tidy: {len(keys)} files, {len(keys) - len(todo)} of them unchanged since they passed", flush=True)
    printed = set()  # a finding in a header comes up in every file that includes it
    with tempfile.TemporaryDirectory() as args.commands, concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        (pathlib.Path(args.commands) / "compile_commands.json").write_text(json.dumps(args.database))
        for path, messages in zip(todo, pool.map(lambda path: findings(args, path), todo)):
            if not messages:
                cache.add(keys[path])
            for where, lines in messages:
                if where not in printed:
                    printed.add(where)
                    print("\n".join(lines), flush=True)
    print(f"clang-tidy: {len(printed)} findings" if printed else "clang-tidy: no findings")
    return 1 if printed else 0


if __name__ == "__main__":
    sys.exit(main())
