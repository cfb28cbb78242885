"""The stub says what the module is, and everything in it has its docstring."""

import ast
import inspect
import os
import subprocess
import sys

import pytest

import relief

STUB = os.path.join(os.path.dirname(relief.__file__), "__init__.pyi")


def names_of_stub():
    with open(STUB, encoding="utf-8") as file:
        tree = ast.parse(file.read())
    names = {}
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            inner = {n.name for n in node.body if isinstance(n, ast.FunctionDef)}
            for base in node.bases:
                inner |= names.get(getattr(base, "id", ""), set())
            names[node.name] = inner
        elif isinstance(node, ast.FunctionDef):
            names[node.name] = set()
    return names


CLASSES = {
    name: value
    for name, value in vars(relief).items()
    if inspect.isclass(value) and not issubclass(value, Exception)
}


@pytest.mark.parametrize("name", sorted(CLASSES))
def test_the_stub_has_each_member_and_no_other(name):
    stub = {n for n in names_of_stub()[name] if not n.startswith("__")}
    real = {n for n in vars(CLASSES[name]) if not n.startswith("_")}
    assert stub == real


@pytest.mark.parametrize("name", sorted(CLASSES))
def test_each_member_says_what_it_is(name):
    assert CLASSES[name].__doc__
    for member, value in vars(CLASSES[name]).items():
        if not member.startswith("_"):
            text = value.__doc__ or ""
            # pybind11 puts the signature in front of a function's own words
            own = text.split("\n\n", 1)[1] if callable(value) and "\n\n" in text else text
            assert own.strip() and not own.startswith(member + "("), f"{name}.{member}"


def test_functions_of_the_module_are_in_the_stub():
    stub = names_of_stub()
    for name, value in vars(relief).items():
        if not name.startswith("_") and callable(value):
            assert name in stub and value.__doc__, name


def test_the_stub_and_its_use_are_strictly_typed(tmp_path):
    pytest.importorskip("mypy")
    use = tmp_path / "use.py"
    use.write_text(
        "import relief\n"
        "def palms(name: str) -> list[float]:\n"
        "    out: list[float] = []\n"
        "    with relief.Pipeline(name, hands=True) as pipeline:\n"
        "        pipeline.on_contact(lambda kind, body, other: print(kind, body, other))\n"
        "        for step in pipeline:\n"
        "            for hand in step.hands or []:\n"
        "                out.append(float(hand.palm[2]))\n"
        "    return out\n"
    )
    folder = os.path.dirname(os.path.dirname(STUB))
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache"), STUB, use],
        env=dict(os.environ, MYPYPATH=folder), capture_output=True, text=True, cwd=tmp_path,
    )
    assert done.returncode == 0, done.stdout + done.stderr
