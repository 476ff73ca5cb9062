"""A notebook that is executed by a kernel of its own, and its pictures."""

from __future__ import annotations

import base64
import json
import os
import sys

import pytest
from conftest import cloud

import pinhole as ph

CELLS = [
    """
import numpy as np, pinhole as ph
positions = np.random.default_rng(1).normal(size=(200, 3))
spheres = ph.Spheres(positions, 0.2, color="teal", columns={"energy": np.arange(200.0)})
spheres
""",
    """
view = spheres.view((160, 120), style="studio", samples=4, camera="iso", backend="cpu")
picked = []
view.on_pick(picked.append)
_ = view.wait(60)
""",
    "view",
    # Before this, the messages of a page arrive. It lets the kernel deal with what was picked.
    """
import asyncio
_ = view.wait(60)
await asyncio.sleep(0.5)
""",
    "spheres.render((160, 120), style='studio', samples=4, camera=view.camera, backend='cpu')",
    "view",
    "print(view.picked, picked == [view.picked])",
]


#: What the page sends before a cell.
SENT = {
    3: [
        {"kind": "move", "turn": [0.2, 0.1], "pan": [0, 0], "zoom": 30, "roll": 0},
        {"kind": "still"},
        {"kind": "pick", "at": [0.5, 0.5]},
    ]
}


@pytest.mark.filterwarnings("ignore")
def test_a_notebook_shows_pictures_and_views(tmp_path, monkeypatch):
    for name in ("nbformat", "nbclient", "ipykernel", "anywidget"):
        pytest.importorskip(name, reason=f"{name}, which executes notebooks or shows views, is missing")
    import nbclient
    import nbformat

    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    monkeypatch.setenv("JUPYTER_DATA_DIR", str(tmp_path / "jupyter"))
    # The kernel is that of this interpreter, whatever other kernels are installed.
    kernel = tmp_path / "jupyter" / "kernels" / "pinhole-tests"
    kernel.mkdir(parents=True)
    command = [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
    said = {"argv": command, "display_name": "tests", "language": "python"}
    (kernel / "kernel.json").write_text(json.dumps(said))
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell.strip()) for cell in CELLS])
    client = nbclient.NotebookClient(notebook, timeout=100, kernel_name="pinhole-tests", cwd=os.fspath(tmp_path))
    with client.setup_kernel():
        for index, cell in enumerate(notebook.cells):
            for content in SENT.get(index, []):
                widget = data_of(notebook.cells[2])["application/vnd.jupyter.widget-view+json"]["model_id"]
                content = {"comm_id": widget, "data": {"method": "custom", "content": content}}
                client.kc.shell_channel.send(client.kc.session.msg("comm_msg", content))
            client.execute_cell(cell, index)
        client.set_widgets_metadata()

    shown = [data_of(cell) for cell in notebook.cells]
    spheres = ph.Spheres(cloud(200), 0.2, color="teal")
    assert png(shown[0]) == spheres._repr_png_()
    keys = {"style": "studio", "samples": 4, "backend": "cpu"}
    assert png(shown[2]) == spheres.render((160, 120), camera="iso", **keys)._repr_png_()
    assert "application/vnd.jupyter.widget-view+json" in shown[2]
    assert png(shown[5]) == png(shown[4]) != png(shown[2])
    texts = [output["text"] for cell in notebook.cells for output in cell.outputs if output.output_type == "stream"]
    index, is_told = texts[-1].split()
    assert 0 <= int(index) < 200 and is_told == "True"
    # What the page would show: the state of the widget that came over the wire.
    models = notebook.metadata.widgets["application/vnd.jupyter.widget-state+json"]["state"].values()
    (view,) = (model["state"] for model in models if "_esm" in model["state"])
    assert view["picked"] == int(index) and view["_label"].startswith(f"sphere {index}, energy ")
    (buffer,) = (
        of for model in models if "_esm" in model["state"] for of in model["buffers"] if of["path"] == ["_picture"]
    )
    assert base64.b64decode(buffer["data"]) == png(shown[5])


def data_of(cell):
    """What a cell shows."""
    found = [output["data"] for output in cell.outputs if "data" in output]
    return found[-1] if found else {}


def png(data):
    return base64.b64decode(data["image/png"])
