#!/usr/bin/env python3
"""Writes the page that holds the extensions of this device against those of the other Vulkan devices in software.

usage: extensions_page.py ROOT [--check]

The rows come from manifest/extensions (the claims) and manifest/peers (what the others offer, and why this device lacks
what it lacks). --check: fails if manifest/extensions.md is not what would be written, or a row has no reason.
"""
import pathlib
import sys

HEAD = """# Extensions

Written by `manifest/extensions_page.py` from `manifest/extensions` and `manifest/peers`; a test keeps it current. Of the
{union} extensions that lavapipe 22.3.6 (Debian 12's), lavapipe of 2026 and SwiftShader list between them, {lacking} are missing here,
and this device offers {own} that none of them has. *Planned*: it fits, and nobody has built it yet. What headers of 1.3.239 do
not know is offered with newer ones alone ([requirements](../docs/requirements.md), Vulkan 1.4).

| extension | here | lavapipe 22.3.6 | lavapipe 2026 | SwiftShader |
|---|---|---|---|---|
"""


def rows(path):
    for line in path.read_text().splitlines():
        if line and not line.startswith("#"):
            yield [field.strip() for field in line.split(";")]


def page(root):
    claimed = {row[0] for row in rows(root / "manifest/extensions")}
    peers = {row[0]: (row[1].split(), row[2] if len(row) > 2 else "") for row in rows(root / "manifest/peers")}
    lacking = sorted(set(peers) - claimed)
    unexplained = [name for name in lacking if not peers[name][1]]
    needless = [name for name in sorted(set(peers) & claimed) if peers[name][1]]
    if unexplained or needless:
        sys.exit(f"manifest/peers: no reason for {unexplained}; a reason, but it is there: {needless}")
    text = HEAD.format(union=len(peers), lacking=len(lacking), own=len(claimed - set(peers)))
    for name in sorted(claimed | set(peers)):
        who, why = peers.get(name, ([], ""))
        marks = " | ".join("yes" if peer in who else "" for peer in ("22", "26", "S"))
        text += f"| {name} | {'yes' if name in claimed else why} | {marks} |\n"
    return text


def main():
    root = pathlib.Path(sys.argv[1])
    target = root / "manifest/extensions.md"
    text = page(root)
    if "--check" in sys.argv:
        if not target.exists() or target.read_text() != text:
            sys.exit("manifest/extensions.md is out of date: run manifest/extensions_page.py .")
    else:
        target.write_text(text)


if __name__ == "__main__":
    main()
