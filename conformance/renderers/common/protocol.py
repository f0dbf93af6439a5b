"""The renderer's side of lightmeter.protocol/1: JSON lines on standard input and output, answered a batch at a time."""
import json
import sys
import traceback
from fnmatch import fnmatchcase
from pathlib import Path
from types import SimpleNamespace

import numpy as np

NAMED = {"NaN": float("nan"), "Inf": float("inf"), "-Inf": float("-inf")}


class Skip(Exception):
    """The renderer cannot do this; the text says why."""


class Cases:
    """Cases of one formula: `cases.name` holds an input of all of them, f32, a row a case where it is a vector; how many
    they are is `cases.total`."""

    def __init__(self, formula, inputs):
        self.formula, self.total = formula, len(inputs)
        for name in inputs[0]:
            rows = np.array([[NAMED.get(x, x) for x in np.ravel(case[name]).tolist()] for case in inputs], np.float32)
            self.__dict__[name.replace("-", "_")] = rows if isinstance(inputs[0][name], list) else rows[:, 0]

    def case(self, k):
        """One of them, its inputs as fields."""
        return SimpleNamespace(**{name: x[k] for name, x in vars(self).items() if isinstance(x, np.ndarray)})


def numbers(values):
    """JSON's numbers, with names for those that it lacks."""
    return [x if np.isfinite(x) else "NaN" if np.isnan(x) else "Inf" if x > 0 else "-Inf" for x in map(float, values)]


def answer(identity, value):
    if isinstance(value, Skip):
        return {"id": identity, "skip": str(value)}
    return {"id": identity, "value": numbers(np.ravel(value))}


def answer_formula(functions, formula, requests):
    """The answers to cases of one formula: `functions` maps globs to functions of `Cases` that return a value a case."""
    identities = [request["id"] for request in requests]
    function = next(f for pattern, f in functions.items() if fnmatchcase(formula, pattern))
    try:
        values = function(Cases(formula, [request["inputs"] for request in requests]))
    except Skip as skip:
        values = [skip] * len(requests)
    return [answer(*pair) for pair in zip(identities, values, strict=True)]


def answer_scene(draw, folder, request):
    """The answer to a scene: `draw(scene)` returns its image, f32 or u8, rows from the top."""
    try:
        image = draw(json.loads(Path(request["scene"]).read_text()))
    except Skip as skip:
        return answer(request["id"], skip)
    name = request["id"].replace("/", "-") + ".npy"
    np.save(Path(folder, name), image)
    return {"id": request["id"], "image": name}


def serve(hello, functions, draw):
    """Answers until standard input ends. `hello` is what the renderer says of itself."""
    folder, waiting = ".", []

    def flush():
        groups = {}
        for request in waiting:
            groups.setdefault(request.get("formula", ""), []).append(request)
        for formula, requests in groups.items():
            for reply in answers(formula, requests):
                print(json.dumps(reply))
        sys.stdout.flush()
        waiting.clear()

    def answers(formula, requests):
        try:
            if formula:
                return answer_formula(functions, formula, requests)
            return [answer_scene(draw, folder, request) for request in requests]
        except Exception as error:
            traceback.print_exc()
            return [{"id": request["id"], "error": repr(error)} for request in requests]

    for line in sys.stdin:
        request = json.loads(line)
        if "hello" in request:
            folder = request["folder"]
            print(json.dumps({"hello": "lightmeter.protocol/1", "formulas": list(functions), **hello}), flush=True)
        elif "batch" in request:
            flush()
        else:
            waiting.append(request)
    flush()
