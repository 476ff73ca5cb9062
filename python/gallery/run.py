"""Runs every script of the gallery in a folder of its own, and fails if one of them does.

python/gallery/run.py [FOLDER]    keeps the pictures in FOLDER, which must not exist; otherwise they are removed
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path


def main() -> int:
    """Returns the exit code."""
    here = Path(__file__).resolve().parent
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(temporary, "gallery")
        folder.mkdir(parents=True)
        failed = []
        started = time.monotonic()
        for script in sorted(here.glob("*.py")):
            if script.name == "run.py":
                continue
            before = time.monotonic()
            done = subprocess.run([sys.executable, script], cwd=folder, env={**os.environ, "MPLBACKEND": "agg"})
            print(f"{script.name}: exit code {done.returncode}, {time.monotonic() - before:.1f} s", flush=True)
            failed += [script.name] * (done.returncode != 0)
        print(f"all: {time.monotonic() - started:.1f} s")
    if failed:
        print(f"failed: {', '.join(failed)}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
