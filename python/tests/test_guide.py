"""The blocks of README.md and docs/python.md run as a reader would type them; the tour is its page."""

import os
import re
import subprocess
import sys

import pytest

ROOT = os.environ["RELIEF_ROOT"]


def run_blocks(*path):
    page = os.path.join(ROOT, *path)
    with open(page, encoding="utf-8") as f:
        blocks = re.findall(r"```python\n(.*?)```", f.read(), re.S)
    names = {}
    for block in blocks:
        exec(compile(block, page, "exec"), names)
    return len(blocks)


def test_the_readme_runs(capsys):
    assert run_blocks("README.md") == 1
    assert len(capsys.readouterr().out.splitlines()) == 30


@pytest.mark.parametrize("page", ["python.md", "coming-from.md", "camera-to-cube.md"])
def test_every_block_of_a_page_runs(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    os.symlink(os.path.join(ROOT, "scenes"), tmp_path / "scenes")
    assert run_blocks("docs", page) >= 1


def test_the_tour_is_what_its_script_gives(tmp_path):
    pytest.importorskip("matplotlib")
    script = os.path.join(ROOT, "python", "examples", "page.py")
    subprocess.run([sys.executable, script, str(tmp_path)], check=True, cwd=tmp_path)
    made = (tmp_path / "python_tour.md").read_text(encoding="utf-8")
    with open(os.path.join(ROOT, "docs", "python_tour.md"), encoding="utf-8") as file:
        assert made == file.read(), "make it again: python3 python/examples/page.py"
    picture = (tmp_path / "pictures" / "python_tour.png").read_bytes()
    assert picture[:4] == b"\x89PNG" and len(picture) > 20000
