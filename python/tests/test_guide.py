"""The blocks of README.md and docs/python.md run, one after the other, as a reader would type them."""

import os
import re

import pytest


def run_blocks(*path):
    page = os.path.join(os.environ["RELIEF_ROOT"], *path)
    with open(page, encoding="utf-8") as f:
        blocks = re.findall(r"```python\n(.*?)```", f.read(), re.S)
    names = {}
    for block in blocks:
        exec(compile(block, page, "exec"), names)
    return len(blocks)


def test_the_readme_runs(capsys):
    assert run_blocks("README.md") == 1
    assert len(capsys.readouterr().out.splitlines()) == 30


def test_every_block_of_the_page_runs(tmp_path, monkeypatch, capsys):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    assert run_blocks("docs", "python.md") >= 5
    assert (tmp_path / "surface.png").stat().st_size > 10000
    assert "begin of contact, body-1 and background" in capsys.readouterr().out
