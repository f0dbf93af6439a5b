#!/usr/bin/env python3
"""Runs `check` on shaders of public projects, and holds what it finds against what somebody listed by reading.

    tests/public/measure.py DIR [LIST…]

DIR has the files, by any name: they are known by their hashes. Without a list, all of this folder are taken. A step counts as found where its kind
stands at its line, within three, with the right class of verdict, and of a mistake with its name. `perhaps` counts as missed.
"""
import collections, hashlib, json, os, pathlib, subprocess, sys

HERE = pathlib.Path(__file__).resolve().parent
RIGHT = {"exp", "exp-amount", "exp2-opengl", "exp2-opengl-amount", "inverse-square", "inverse", "encode", "decode", "unguarded", "right"}
FAR = {"terms", "value"}
# A ramp is listed by its form, and told by what it is for.
KINDS = {"ramp": {"ramp", "fog", "spot", "attenuation"}}


def classes(verdict):
    """The classes and names that a listed verdict allows."""
    for one in verdict.split("|"):
        word, _, name = one.partition(":")
        yield ("right", name) if word in RIGHT else (word, name)


def is_right(listed, step):
    return any(
        word == step["verdict"] and (word != "mistake" or name in ("other", step.get("name", "")))
        for word, name in classes(listed)
    )


def measured(files, path):
    lines = [line.rstrip("\n").split("\t") for line in open(path)]
    head, rows = lines[0], [dict(zip(lines[0], line)) for line in lines[1:]]
    here = [row for row in rows if row["sha256"] in files]
    print(f"{path.name}: {len(here)} of {len(rows)} files are there")
    if not here:
        return
    names = [str(files[row["sha256"]]) for row in here]
    output = subprocess.run([os.environ.get("LIGHTMETER", "./x"), "check", *names, "--format", "json"], stdout=subprocess.PIPE, check=False).stdout
    reviews = {review["file"]: review for review in json.loads(output)["shaders"]}
    count = collections.Counter()
    for row, name in zip(here, names):
        review = reviews[name]
        steps = review["steps"]
        if review.get("unread"):
            count["not read"] += 1
            print(f"  {row['number']} not read: {review['unread']}")
        used = set()
        for site in filter(None, (site.split() for site in row.get("sites", "").split(";"))):
            line, kind, listed = int(site[0]), site[1].replace("-divisor", ""), site[2]
            reach = 400 if kind in FAR else 3
            near = [
                (min(abs(own - line) for own in [step["line"], *step.get("also", [])]), k)
                for k, step in enumerate(steps)
                if step["kind"] in KINDS.get(kind, {kind})
            ]
            near = sorted((d, k) for d, k in near if d <= reach)
            good = [k for _, k in near if is_right(listed, steps[k])]
            fresh = [k for k in good if k not in used] or good
            count["sites"] += 1
            if fresh:
                used.add(fresh[0])
                count["found"] += 1
                continue
            other = [k for _, k in near if k not in used]
            if other and kind not in FAR and kind != "length" and steps[other[0]]["verdict"] != "perhaps":
                used.add(other[0])
                count["wrong"] += 1
                print(f"  {row['number']} line {line}: {kind} {listed} is told {steps[other[0]]['verdict']} {steps[other[0]].get('name', '')}")
            else:
                count["missed"] += 1
                print(f"  {row['number']} line {line}: {kind} {listed} is missed")
        for k, step in enumerate(steps):
            if k not in used and step["verdict"] == "mistake":
                count["mistakes not listed"] += 1
                print(f"  {row['number']} line {step['line']}: {step['kind']} mistake {step.get('name', '')} is not listed")
            elif k not in used:
                count["others not listed"] += 1
    share = f" ({100 * count['found'] / count['sites']:.0f} %)" if count["sites"] else ""
    print(f"  {dict(count)}{share}")


def main():
    if len(sys.argv) < 2:
        sys.exit("measure.py: which folder has the files?")
    folder = pathlib.Path(sys.argv[1]).resolve()
    os.chdir(HERE.parent.parent)
    files = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            files[hashlib.sha256(path.read_bytes()).hexdigest()] = path
    for path in [pathlib.Path(own) for own in sys.argv[2:]] or sorted(HERE.glob("*.tsv")):
        measured(files, path)


main()
