#!/usr/bin/env python3
"""An editor debugs Debian's vkcube, whose shaders name no lines: breakpoint, steps, variables, back, to its end.

usage: debug_cube_test.py VITRINE

Exit status 77: vkcube or Xvfb is not installed."""
import re
import shutil
import subprocess
import sys

from debug_adapter_test import Client

FRAMES = 5
MOST_STOPS = 100  # until a fragment comes


def at(client, thread):
    frame = client.ask("stackTrace", threadId=thread)["stackFrames"][0]
    return frame["line"], frame["id"]


def move(client, command, thread):
    client.ask(command, threadId=thread)
    return client.wait("stopped")


def variables(client, frame):
    scopes = client.ask("scopes", frameId=frame)["scopes"]
    return [client.ask("variables", variablesReference=scope["variablesReference"])["variables"] for scope in scopes]


def walk(client, stop):
    """Some lines forward and back: the same lines, and the same values of the results that have been computed."""
    thread, seen = stop["threadId"], []
    for _ in range(4):
        line, frame = at(client, thread)
        seen.append((line, variables(client, frame)))
        move(client, "next", thread)
    for line, values in reversed(seen):
        move(client, "stepBack", thread)
        again, frame = at(client, thread)
        assert again == line, (again, line)
        kept = [[(row["name"], row["value"]) for row in scope] for scope in values]
        assert kept == [[(row["name"], row["value"]) for row in scope] for scope in variables(client, frame)], line
    assert any(rows for rows in seen[-1][1]), "no variables"
    return thread


def debug(client):
    assert client.ask("initialize", adapterID="vitrine")["supportsStepBack"]
    client.wait("initialized")
    client.ask("setFunctionBreakpoints", breakpoints=[{"name": "main"}])
    client.ask("launch")
    client.ask("configurationDone")
    stop = client.wait("stopped")
    assert stop["reason"] == "function breakpoint" or stop["reason"] == "breakpoint", stop
    assert "vertex" in stop["text"], stop
    thread = walk(client, stop)
    for _ in range(MOST_STOPS):
        stop = move(client, "continue", thread)
        thread = stop["threadId"]
        if "pixel (" in stop["text"]:
            break
    assert "pixel (" in stop["text"], stop
    thread = walk(client, stop)
    client.ask("setFunctionBreakpoints", breakpoints=[])
    client.ask("continue", threadId=thread)
    assert client.wait("exited")["exitCode"] == 0
    client.wait("terminated")


def main(vitrine):
    if not all(shutil.which(name) for name in ("xvfb-run", "vkcube")):
        print("xvfb-run or vkcube is not installed")
        return 77
    with subprocess.Popen(["xvfb-run", "-a", vitrine, "debug", "--dap", "0", "--", "vkcube", "--c", str(FRAMES)],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as server:
        try:
            port = int(re.search(r":(\d+)$", server.stdout.readline().strip())[1])
            debug(Client(port))
            return server.wait(timeout=120)
        finally:
            if server.poll() is None:
                server.terminate()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
