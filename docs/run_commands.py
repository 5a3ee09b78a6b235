"""Runs every command that the book and the README print, and renews the book's pictures.

    cargo build --release -p slackside
    python3 docs/run_commands.py [--program target/release/slackside] [--keep-pictures] [PAGE…]

A command is a line `$ slackside …` in a fenced block. A fenced block with a title is a file that the reader writes. A
comment `<!-- exit N -->` before a block says with which status its commands end (0 without it). A picture followed by
`<!-- from out/… -->` is copied from there unless --keep-pictures is given. Pages are run in a fresh folder each.
"""

import argparse
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BLOCK = re.compile(r"(?:<!-- exit (\d+) -->\s*\n)?^```([^\n]*)\n(.*?)^```", re.MULTILINE | re.DOTALL)
TITLE = re.compile(r'title="([^"]+)"')
PICTURE = re.compile(r"!\[[^\]]*\]\(([^)]+)\)(?:\{[^}]*\})?\s*<!-- from (\S+) -->")


def run_page(page: pathlib.Path, program: pathlib.Path, keep_pictures: bool) -> int:
    """Number of failures on the page."""
    text = page.read_text(encoding="utf-8")
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        (work / "examples").symlink_to(ROOT / "examples")
        for block in BLOCK.finditer(text):
            status, info, body = int(block[1] or 0), block[2], block[3]
            if title := TITLE.search(info):
                (work / title[1]).write_text(body, encoding="utf-8")
            for line in body.replace("\\\n", " ").splitlines():
                if not line.startswith("$ slackside "):
                    continue
                # What follows a pipe only shortens what the reader sees.
                words = shlex.split(line[2:].split(" | ")[0])[1:]
                start = time.monotonic()
                done = subprocess.run([program, *words], cwd=work, capture_output=True, text=True, check=False)
                fine = done.returncode == status
                failures += not fine
                print(f"{'ok  ' if fine else 'FAIL'} {time.monotonic() - start:6.1f} s  {line[2:]}", flush=True)
                if not fine:
                    print(f"     status {done.returncode}, expected {status}\n{done.stderr}", file=sys.stderr)
        for picture, source in PICTURE.findall(text):
            if not (work / source).is_file():
                failures += 1
                print(f"FAIL {page.name}: no picture {source}", file=sys.stderr)
            elif not keep_pictures:
                target = page.parent / picture
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(work / source, target)
    return failures


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "target/release/slackside")
    parser.add_argument("--keep-pictures", action="store_true")
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    pages = options.pages or [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    program = options.program.resolve()
    failures = sum(run_page(page.resolve(), program, options.keep_pictures) for page in pages)
    print(f"{failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
