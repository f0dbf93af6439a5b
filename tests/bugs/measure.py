#!/usr/bin/env python3
"""Puts the bugs of `bugs.toml` into copies of the files one at a time, and prints what the suite says of each:

    tests/bugs/measure.py [--set second.toml] [ID…]

It needs the binary, `target/debug/lightmeter` or `$LIGHTMETER`, and for the bugs of the numpy renderer a Python with numpy, which
`conformance/renderers/numpy/gate` installs.
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
LIGHTMETER = os.environ.get("LIGHTMETER", str(ROOT / "target/debug/lightmeter"))
PYTHON = ROOT / "conformance/renderers/.build/python/bin/python3"
SIDES = {"wgsl": ROOT / "gpu/src/shaders", "numpy": ROOT / "conformance/renderers/numpy"}


def report(bug: dict[str, Any], copy: Path) -> dict[str, Any]:
    """The suite's result for the formulas of a bug, with the edit made in a copy of its folder."""
    shutil.copytree(SIDES[bug["side"]], copy)
    file = copy / bug["file"]
    text = file.read_text()
    assert text.count(bug["find"]) == 1, bug["id"]
    file.write_text(text.replace(bug["find"], bug["replace"]))
    result = copy.parent / "result.json"
    subject = {
        "wgsl": ["run", "--shaders", str(copy)],
        "numpy": ["gate", "--exec", f"'{PYTHON}' '{copy / 'renderer.py'}'"],
    }[bug["side"]]
    options = ["--cases", "256", "--format", "json", "--out", str(result)]
    # The copy of a renderer does not lie beside the client that it imports.
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "clients/python")}
    subprocess.run([LIGHTMETER, *subject, *bug["filter"], *options], capture_output=True, check=False, env=environment)
    return json.loads(result.read_text())


def explanations(result: dict[str, Any]) -> list[str]:
    """What is said of each formula, once where its stages agree."""
    said = {}
    for group in result["groups"]:
        words = sentence(group.get("diagnosis") or {}) or "; ".join(one["says"] for one in group.get("problems", []))
        if words:
            said[f"{group['id']}: {words}"] = None
    return list(said)


def sentence(diagnosis: dict[str, Any]) -> str:
    """What the first explanation says, of each output by itself where there is none of whole answers."""
    if best := next(iter(diagnosis.get("explanations", [])), None):
        names = " and ".join(best.get("mistakes", []))
        told = f"{best['explained']} of {diagnosis['looked_at']} failing cases are explained by: {best['says']}"
        return f"{told} ({names})" if names else told
    if parts := diagnosis.get("parts", []):
        return "; ".join(f"{part['name']}: {sentence({**part, 'looked_at': part['failing']})}" for part in parts)
    common = ", ".join(diagnosis.get("in_common", []))
    return f"nothing in the catalogue explains the failing cases{': ' if common else ''}{common}" if diagnosis else ""


def main() -> None:
    arguments = sys.argv[1:]
    name = "bugs.toml"
    if arguments[:1] == ["--set"]:
        name, arguments = arguments[1], arguments[2:]
    wanted = set(arguments)
    for bug in tomllib.loads((ROOT / "tests/bugs" / name).read_text())["bug"]:
        if wanted and bug["id"] not in wanted:
            continue
        kind = " (a pair)" if bug.get("pair") else " (unusual)" if bug.get("unusual") else ""
        print(f"{bug['id']}, {bug['side']}{kind}\n    {bug['says']}", flush=True)
        with tempfile.TemporaryDirectory() as folder:
            for line in explanations(report(bug, Path(folder) / "copy")):
                print(f"  → {line}", flush=True)


if __name__ == "__main__":
    main()
