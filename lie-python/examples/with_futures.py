"""Shares on processes of this machine: python with_futures.py WORKERS FILE. A share whose worker died is done again."""

import sys
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool

import numpy as np
from body import SHARES, ends

if __name__ == "__main__":
    done = {}
    while missing := [share for share in SHARES if share not in done]:
        with ProcessPoolExecutor(int(sys.argv[1])) as pool:
            running = {share: pool.submit(ends, share) for share in missing}
            for share, future in running.items():
                try:
                    done[share] = future.result()
                except BrokenProcessPool:
                    print(f"share {share} is done again")
    np.save(sys.argv[2], np.concatenate([done[share] for share in SHARES]))
