"""Renders frames on two Dask workers, of which one is killed again and again; tests/cluster/run.sh compares the files."""

import os
import sys
import threading
import time

from dask.distributed import Client, LocalCluster

from pinhole import farm


def main() -> None:
    frames, out = int(sys.argv[1]), sys.argv[2]
    os.mkdir(out)
    flags = {"backend": "cpu", "size": os.environ["PINHOLE_SIZE"], "samples": int(os.environ["PINHOLE_SAMPLES"])}
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True) as cluster, Client(cluster) as client:
        client.wait_for_workers(2)
        stop, killed = threading.Event(), []

        def kill() -> None:
            # The nanny starts another worker, as a cluster does.
            while not stop.wait(2.0) and len(killed) < 5:
                pids = list(client.run(os.getpid).values())
                os.kill(pids[0], 9)
                killed.append(pids[0])

        killer = threading.Thread(target=kill)
        killer.start()
        began = time.monotonic()
        # A task that was on a lost worker counts as suspicious; more than the default may be lost here.
        try:
            layers = {"depth": f"{out}/d%03d.npy"}
            farm.render("a.xyz", f"{out}/f%03d.png", client=client, tiles=(2, 2), layers=layers, retries=9, **flags)
            farm.movie(f"{out}/m.apng", "a.xyz", client=client, tiles=(2, 2), retries=9, **flags)
        finally:
            stop.set()
            killer.join()
        print(f"{frames} frames twice in {time.monotonic() - began:.1f} s; {len(killed)} workers were killed")


if __name__ == "__main__":
    main()
