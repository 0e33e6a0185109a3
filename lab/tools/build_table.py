"""Bytes of machine code and of the whole library for each crate of the workspace in the release build: a table of docs/build.md.

    python lab/tools/build_table.py [--target target]

After `cargo build --release`. Needs `size` of binutils. A library of generic code is small here; what is made of it is counted where it is
instantiated.
"""

import argparse
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]


def text(library: pathlib.Path) -> int:
    """Bytes of machine code and constants of all objects in a library."""
    output = subprocess.run(["size", "-t", library], check=True, capture_output=True, text=True).stdout
    return int(output.strip().splitlines()[-1].split()[0])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--target", default=ROOT / "target", type=pathlib.Path)
    deps = parser.parse_args().target / "release/deps"
    newest: dict[str, pathlib.Path] = {}
    for library in sorted(deps.glob("liblie_*.rlib"), key=lambda path: path.stat().st_mtime):
        newest[re.sub(r"^lib|-[0-9a-f]+$", "", library.stem)] = library
    rows = sorted(((text(library), library.stat().st_size, name) for name, library in newest.items()), reverse=True)
    print("| crate | machine code, kB | library, kB |\n|---|---|---|")
    for code, whole, name in rows:
        print(f"| `{name.replace('_', '-')}` | {code // 1000:,} | {whole // 1000:,} |")
    print(f"| sum | {sum(row[0] for row in rows) // 1000:,} | {sum(row[1] for row in rows) // 1000:,} |")


if __name__ == "__main__":
    main()
