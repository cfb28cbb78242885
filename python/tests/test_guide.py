"""The blocks of docs/python.md run, one after the other, as a reader would type them."""

import os
import re

import pytest


def test_every_block_of_the_page_runs(tmp_path, monkeypatch, capsys):
    pytest.importorskip("matplotlib")
    page = os.path.join(os.environ["RELIEF_ROOT"], "docs", "python.md")
    with open(page, encoding="utf-8") as f:
        blocks = re.findall(r"```python\n(.*?)```", f.read(), re.S)
    assert len(blocks) >= 5
    monkeypatch.chdir(tmp_path)
    names = {}
    for block in blocks:
        exec(compile(block, page, "exec"), names)
    assert (tmp_path / "surface.png").stat().st_size > 10000
    assert "begin of contact, body-1 and background" in capsys.readouterr().out
