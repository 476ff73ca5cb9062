"""Runs the examples of docs/how-to/from-ovito-and-fresnel.md whose libraries are installed."""

from __future__ import annotations

import ast
import importlib.util
import re
from pathlib import Path

import pytest


PAGE = Path(__file__).resolve().parents[2] / "docs" / "how-to" / "from-ovito-and-fresnel.md"
BLOCKS = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)

DUMP = """ITEM: TIMESTEP
0
ITEM: NUMBER OF ATOMS
2
ITEM: BOX BOUNDS pp pp pp
0 4
0 4
0 4
ITEM: ATOMS id type x y z
1 1 1 1 1
2 1 2 3 3
"""


def libraries(block: str) -> set[str]:
    """The names of the modules that an example needs."""
    found = set()
    for node in ast.walk(ast.parse(block)):
        if isinstance(node, ast.Import):
            found |= {name.name.split(".")[0] for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            found.add(str(node.module).split(".")[0])
    return found


def test_the_page_has_examples():
    # Three of them are those of other programs.
    assert len(BLOCKS) == 12
    assert sum(libraries(block) <= {"numpy", "pinhole"} for block in BLOCKS) == 2


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("number", range(len(BLOCKS)))
def test_an_example(number, tmp_path, monkeypatch):
    block = BLOCKS[number]
    missing = sorted(name for name in libraries(block) if importlib.util.find_spec(name) is None)
    if missing:
        pytest.skip(f"{', '.join(missing)} not installed")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "run.dump").write_text(DUMP)
    names = re.findall(r'"([\w%]+\.(?:png|pdf))"', block)
    exec(compile(block, f"{PAGE.name}, example {number}", "exec"), {"__name__": "example"})
    for name in names:
        assert list(tmp_path.glob(name.replace("%03d", "*")))
