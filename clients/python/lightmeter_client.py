"""A renderer's side of lightmeter.protocol/1, in one file that is copied beside a renderer. It needs numpy alone.

    import numpy as np
    from lightmeter_client import Renderer

    renderer = Renderer("my-renderer", "1.0")

    @renderer.formula("fog/exp")
    def exponential_fog(p, density, fog, shaded):
        f = np.clip(np.exp(-density * np.abs(p[2])), 0, 1)
        return f, fog * (1 - f) + shaded * f

    renderer.serve()

    lightmeter gate --exec 'python3 my-renderer.py' fog/exp

A function is given all cases of a batch at once, its inputs by their names: f32, a number of a case each, or the components of a
vector one after the other, each with a number a case. It returns the outputs in their order, in the same shape. `lightmeter list
--formulas` names inputs and outputs, and what each means; a hyphen in a name is an underscore here, and a name that is a word of
Python has an underscore behind it (`lambda_`).
"""
import fnmatch
import hashlib
import json
import keyword
import os
import re
import shutil
import sys
import sysconfig
import traceback
from pathlib import Path
from types import SimpleNamespace

import numpy as np

PROTOCOL = "lightmeter.protocol/1"
# What packs of columns are written as.
PACK = "lightmeter.pack/1"
NAMED = {"NaN": float("nan"), "Inf": float("inf"), "-Inf": float("-inf")}


# Rows of columns that a line skips at most.
ROWS = 1 << 14
SIZES = {"scalar": 1, "vec2": 2, "vec3": 3, "vec4": 4, "mat3": 9, "mat4": 16}


class Skip(Exception):
    """The renderer cannot do this; the text says why. Raised, or given in the place of a case's value."""


class Cases:
    """Cases of one formula: `cases.name` holds an input of all of them, f32, a row a case where it is a vector; how many
    they are is `cases.total`, and their ids are `cases.ids`."""

    def __init__(self, formula, requests):
        self.formula, self.total = formula, len(requests)
        self.ids = [request["id"] for request in requests]
        inputs = [request["inputs"] for request in requests]
        for name, first in inputs[0].items():
            setattr(self, parameter(name), column([case[name] for case in inputs], isinstance(first, list)))

    @classmethod
    def of_columns(cls, formula, columns):
        """The same of arrays by the names of the inputs. Cases of columns have no ids."""
        cases = cls.__new__(cls)
        cases.formula, cases.ids = formula, None
        cases.total = len(next(iter(columns.values())))
        for name, values in columns.items():
            setattr(cases, parameter(name), values)
        return cases

    def inputs(self):
        """All inputs by their names."""
        return {name: x for name, x in vars(self).items() if isinstance(x, np.ndarray)}

    def case(self, k):
        """One of them, its inputs as fields."""
        return SimpleNamespace(**{name: x[k] for name, x in self.inputs().items()})


def matches(pattern, formula):
    """Whether a filter matches an id or what stands above it: `*` is any characters of a part, `**` any number of parts, `{a,b}` either."""
    choice = re.search(r"\{([^{}]*)\}", pattern)
    if choice:
        before, after = pattern[: choice.start()], pattern[choice.end() :]
        return any(matches(before + one + after, formula) for one in choice[1].split(","))
    return parts_match(pattern.split("/"), formula.split("/"))


def parts_match(patterns, parts):
    if not patterns:
        return True
    if patterns[0] == "**":
        return any(parts_match(patterns[1:], parts[k:]) for k in range(len(parts) + 1))
    return bool(parts) and fnmatch.fnmatchcase(parts[0], patterns[0]) and parts_match(patterns[1:], parts[1:])


def parameter(name):
    """The name of an input as Python can have it."""
    name = name.replace("-", "_")
    return f"{name}_" if keyword.iskeyword(name) else name


def column(values, is_vector):
    """One input of all cases, a row a case where it is a vector."""
    try:
        rows = np.array(values, np.float32)
    except ValueError:  # The words for what JSON has no number for.
        rows = np.array([[NAMED.get(x, x) for x in np.ravel(np.array(value, object))] for value in values], np.float32)
    rows = rows.reshape(len(values), -1)
    return rows if is_vector else rows[:, 0]


def numbers(values):
    """JSON's numbers, with names for those that it lacks."""
    values = np.ravel(values).astype(np.float64)
    if np.isfinite(values).all():
        return values.tolist()
    return [x if np.isfinite(x) else "NaN" if np.isnan(x) else "Inf" if x > 0 else "-Inf" for x in values.tolist()]


def answer(identity, value):
    if isinstance(value, Skip):
        return {"id": identity, "skip": str(value)}
    return {"id": identity, "value": numbers(value)}


def computed(function, cases, dtype):
    """The outputs of all cases, a row a case."""
    inputs = {name: np.ascontiguousarray(x.T.astype(dtype)) for name, x in cases.inputs().items()}
    with np.errstate(all="ignore"):
        outputs = function(**inputs)
        parts = [np.atleast_2d(part) for part in (outputs if isinstance(outputs, tuple) else (outputs,))]
        for part in parts:
            if part.dtype.kind not in "biuf":
                raise TypeError(f"{cases.formula}: an output of {part.dtype}; expected {np.dtype(dtype)}")
            if part.dtype.kind == "f" and part.dtype != dtype:
                raise TypeError(f"{cases.formula}: an output of {part.dtype}: it was not computed in {np.dtype(dtype)}")
            if part.ndim != 2 or part.shape[1] not in (1, cases.total):
                raise ValueError(f"{cases.formula}: an output of the shape {part.shape}; expected ({cases.total},) of numbers and (3, {cases.total}) of vectors: a row a component")
        parts = [np.broadcast_to(part, (len(part), cases.total)) for part in parts]
        return np.concatenate(parts).astype(np.float32).T


def apart(values, sizes):
    """The outputs of all cases, of so many numbers each, as an array for each output."""
    values = np.asarray(values, np.float32)
    if values.ndim != 2 or values.shape[1] != sum(sizes):
        raise ValueError(f"outputs of shape {values.shape}; expected {sum(sizes)} numbers a case")
    ends = np.cumsum(sizes)
    parts = [np.ascontiguousarray(values[:, end - size : end]) for size, end in zip(sizes, ends)]
    return [part[:, 0] if size == 1 else part for size, part in zip(sizes, parts)]


def skipped_rows(values, size):
    """The values of all cases with NaN in the place of each `Skip`, and the rows of these by their reasons."""
    if not isinstance(values, (list, tuple)) or not any(isinstance(value, Skip) for value in values):
        return values, {}
    rows = {}
    for row, value in enumerate(values):
        if isinstance(value, Skip):
            rows.setdefault(str(value), []).append(row)
    return [np.full(size, np.nan) if isinstance(value, Skip) else np.ravel(value) for value in values], rows


def source(pattern, function):
    """Where a function stands: an entry of the hello's `sources`, its file as it is called from the working directory; nothing of a
    function that stands elsewhere, or that was not written in Python."""
    code = getattr(function, "__code__", None)
    if code is None:
        return []
    try:
        file = os.path.relpath(code.co_filename)
    except ValueError:  # Another drive of Windows.
        return []
    if file.startswith(os.pardir) or not os.path.isfile(file):
        return []
    return [{"id": pattern, "file": file.replace(os.sep, "/"), "line": code.co_firstlineno}]


def digest(*files):
    """What tells this program's code from other code of the same version: a hash of its main file, of all modules that were imported by now
    and are not installed, and of further files, such as shaders, named from the main file's folder."""
    main = getattr(sys.modules["__main__"], "__file__", None)
    folder = Path(main).resolve().parent if main else Path.cwd()
    library = {Path(sysconfig.get_path(kind)) for kind in ("stdlib", "platstdlib")}
    library |= {path.resolve() for path in library}

    def is_own(path):
        # A file of the library may be a link that leads out of it.
        paths = {path.absolute(), path.resolve()}
        installed = any({"site-packages", "dist-packages"} & set(path.parts) or library & set(path.parents) for path in paths)
        return path.is_file() and not installed

    # By the names of modules, which do not depend on where the program lies.
    modules = [(name, getattr(module, "__file__", None)) for name, module in list(sys.modules.items())]
    own = [(name, Path(file)) for name, file in modules if file and is_own(Path(file))]
    code = hashlib.sha256()
    for name, file in sorted(own) + [(file, folder / file) for file in files]:
        text = file.read_bytes()
        code.update(f"{name} {len(text)}\n".encode() + text)
    return code.hexdigest()[:16]


class Renderer:
    """What a renderer can do. `declares` is said in its hello as it is: `profile`, `formats`, `effects`, `skips`, `excludes`, `sources` and
    others of docs/protocol.md. Without `build` it is `digest()`, so that shards of changed code are not merged. Without `sources`, the functions of `formula` and `scene` are named with their lines, for reports. With `describe=True` the gate describes each formula before its first case: `described`, by id."""

    def __init__(self, name, version="", **declares):
        self.hello = {"hello": PROTOCOL, "renderer": name, "version": version, **declares}
        self.functions, self.scenes, self.draw = {}, [], None
        self.described, self.sources = {}, []
        self.columns = True

    def formula(self, formula, dtype=np.float32):
        """Makes a function that of a formula. It computes in `dtype`, into which the inputs, f32, go exactly; what it returns is
        rounded to f32."""

        def given(function):
            self.formulas(formula, lambda _: function, dtype)
            self.sources += source(formula, function)
            return function

        return given

    def formulas(self, pattern, of, dtype=np.float32):
        """The same of all formulas that a filter matches: `of` gives the function of each, by its id."""
        self.functions[pattern] = lambda cases: computed(of(cases.formula), cases, dtype)

    def batches(self, functions):
        """Functions by filters that take `Cases` and return a value a case, each of which may be a `Skip`. Cases are then asked by
        lines, which have ids."""
        self.columns = False
        self.functions.update(functions)

    def scene(self, pattern):
        """Makes a function that which draws scenes: given the scene (docs/protocol.md has its fields), it returns the image, f32 or
        u8, rows from the top."""

        def given(function):
            self.scenes.append(pattern)
            self.draw = function
            self.sources += source(pattern, function)
            return function

        return given

    def answer_pack(self, pack, answers):
        """Answers a pack of columns, `lightmeter pack DIR --columns`, by files in another folder, of which
        `lightmeter gate DIR ANSWERS` judges all. A function that raises `Skip` skips its formula, and a `Skip` in the place of a case's
        value that case. Memory holds one formula at a time."""
        pack, answers = Path(pack), Path(answers)
        manifest = json.loads((pack / "manifest.json").read_text())
        if not manifest.get("columns"):
            sys.exit(f"{pack} has no columns; expected a pack of `lightmeter pack {pack} --columns`")
        if manifest.get("schema") != PACK:
            sys.exit(f"{pack} is a {manifest.get('schema')}, and this client reads {PACK}")
        # Until all is answered nothing is: a gate would take what an earlier call left for answers of this one.
        (answers / "answers.jsonl").unlink(missing_ok=True)
        lines = [{"formulas": list(self.functions), "sources": self.sources, "build": digest(), **self.hello, "pack": manifest["pack"]}]
        for formula in manifest["formulas"]:
            name = formula["id"]
            function = next((f for pattern, f in self.functions.items() if matches(pattern, name)), None)
            if function is None:
                continue
            inputs = {x["name"]: np.load(pack / "columns" / name / f"{x['name']}.npy") for x in formula["inputs"]}
            sizes = [SIZES[output["shape"]] for output in formula["outputs"]]
            folder = answers / "columns" / name
            # What an earlier call left of the formula answers nothing now.
            shutil.rmtree(folder, ignore_errors=True)
            try:
                values, skipped = skipped_rows(function(Cases.of_columns(name, inputs)), sum(sizes))
            except Skip as skip:
                lines.append({"id": name, "skip": str(skip)})
                continue
            parts = apart(values, sizes)
            for reason, rows in skipped.items():
                # A line of the gate is 1 MiB at most.
                pieces = [rows[first : first + ROWS] for first in range(0, len(rows), ROWS)]
                lines += [{"id": name, "skip": reason, "rows": piece} for piece in pieces]
            folder.mkdir(parents=True)
            for output, part in zip(formula["outputs"], parts):
                np.save(folder / f"{output['name']}.npy", part)
        answers.mkdir(parents=True, exist_ok=True)
        (answers / "answers.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))

    def serve(self):
        """Answers until standard input ends."""
        folder, waiting = ".", []
        for line in iter(sys.stdin.buffer.readline, b""):
            request = json.loads(line)
            if "hello" in request:
                if request["hello"] != PROTOCOL:
                    sys.exit(f"the gate speaks {request['hello']}, and this client {PROTOCOL}")
                folder = request["folder"]
                declared = {"formulas": list(self.functions), "scenes": self.scenes, "columns": self.columns}
                declared |= {"sources": self.sources, "build": digest()}
                print(json.dumps({**declared, **self.hello}), flush=True)
            elif "describe" in request:
                self.described[request["describe"]["id"]] = request["describe"]
            elif "columns" in request:
                self._columns(request, sys.stdin.buffer.read(request["bytes"]))
            elif "batch" in request:
                self._flush(folder, waiting)
                waiting = []
            else:
                waiting.append(request)
        self._flush(folder, waiting)

    def _columns(self, request, data):
        """Answers a batch in columns: a line, and an array for each output behind it."""
        head = {"columns": request["columns"], "batch": request["batch"]}
        columns, start = {}, 0
        for column in request["inputs"]:
            end = start + request["count"] * column["components"]
            values = np.frombuffer(data[4 * start : 4 * end], np.dtype("<f4"))
            is_vector = column["components"] > 1
            columns[column["name"]] = values.reshape(request["count"], -1) if is_vector else values
            start = end
        try:
            name = request["columns"]
            function = next(f for pattern, f in self.functions.items() if matches(pattern, name))
            sizes = [output["components"] for output in request["outputs"]]
            parts = apart(function(Cases.of_columns(name, columns)), sizes)
            data = b"".join(part.astype("<f4").tobytes() for part in parts)
        except Skip as skip:
            data, head = b"", {**head, "skip": str(skip)}
        except Exception as error:
            traceback.print_exc()
            data, head = b"", {**head, "error": repr(error)}
        else:
            head["bytes"] = len(data)
        sys.stdout.buffer.write(json.dumps(head).encode() + b"\n" + data)
        sys.stdout.buffer.flush()

    def _flush(self, folder, waiting):
        groups = {}
        for request in waiting:
            groups.setdefault(request.get("formula", ""), []).append(request)
        for formula, requests in groups.items():
            for reply in self._answers(folder, formula, requests):
                print(json.dumps(reply))
        sys.stdout.flush()

    def _answers(self, folder, formula, requests):
        try:
            if formula:
                return self._values(formula, requests)
            return [self._image(folder, request) for request in requests]
        except Exception as error:
            traceback.print_exc()
            return [{"id": request["id"], "error": repr(error)} for request in requests]

    def _values(self, formula, requests):
        function = next(f for pattern, f in self.functions.items() if matches(pattern, formula))
        cases = Cases(formula, requests)
        try:
            values = function(cases)
        except Skip as skip:
            values = [skip] * cases.total
        return [answer(*pair) for pair in zip(cases.ids, values, strict=True)]

    def _image(self, folder, request):
        try:
            image = self.draw(json.loads(Path(request["scene"]).read_text()))
        except Skip as skip:
            return answer(request["id"], skip)
        name = request["id"].replace("/", "-") + ".npy"
        np.save(Path(folder, name), image)
        return {"id": request["id"], "image": name}
