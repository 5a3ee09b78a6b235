"""Writes the gallery page from the recipes of the figures and what the program measures for them.

    cargo build --release -p slackside
    python3 docs/make_gallery.py [--program target/release/slackside]

Its pictures are renewed by docs/run_commands.py, like those of every page.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
LARGEST_SVG = 150_000  # bytes; larger ones are slow to draw, PNG stands in for them
HEAD = """# Gallery

The figures of the dissertation, redrawn for the models of this repository. Each section says what the figure means for
somebody who designs a drive, what was measured, and the command that makes it. The same figure of your own drive is one
edit away: print the recipe, put your file in place of the model, and make it.

```console
$ slackside figure
```

`slackside figure 2.5 --recipe > mine.toml`, then `slackside figure mine.toml`: see [verbs](reference/verbs.md#figure).
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "target/release/slackside")
    program = parser.parse_args().program.resolve()
    page = [HEAD]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "figure", "all", "--quiet"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        known = subprocess.run([program, "figure", "--json"], check=True, capture_output=True, text=True)
        for entry in json.loads(known.stdout)["known"]:
            made = pathlib.Path(folder) / "out" / f"figure_{entry['id']}"
            result = json.loads((made / "result.json").read_text(encoding="utf-8"))
            recipe = tomllib.loads((made / "recipe.toml").read_text(encoding="utf-8"))
            page.append(f"## {entry['id']} {result['title']}\n\n{result['meaning']}\n")
            page.append(f"*To see:* {result['phenomenon']}. *Measured:* {result['finding']}.\n")
            page.append(f"```console\n$ slackside figure {entry['id']} --out out\n```\n")
            names = [show.get("name") or "_".join(filter(None, [show.get("command"), show["figure"]]))
                     for show in recipe.get("show", []) if "figure" in show]
            names += [plot["name"] for plot in recipe.get("plot", [])]
            for name in names:
                small = (made / f"{name}.svg").stat().st_size <= LARGEST_SVG
                file = f"{name}.{'svg' if small else 'png'}"
                alt = f"Figure {entry['id']}, {name.replace('_', ' ')}"
                page.append(f"![{alt}](images/figure_{entry['id']}_{file})<!-- from out/figure_{entry['id']}/{file} -->")
            page.append(f"\nRecipe: `{result['recipe']}`\n")
    (ROOT / "docs/gallery.md").write_text("\n".join(page), encoding="utf-8")


if __name__ == "__main__":
    main()
