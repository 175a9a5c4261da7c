#!/usr/bin/env python3
"""Holds the manual against the source: what its pages name must be there.

  - relative links lead to files, and their anchors to headings
  - every page of docs is linked from docs/README.md
  - files of the source that are named in back quotes exist
  - tests that are named (`Suite.Name`) exist
  - options after a subcommand's name (`relax --modes`) are in its help; every option of the help is told of somewhere
  - every energy of src/mechanics/energies has a page in docs/energies
  - the defaults that a page of an energy states are those of the source

Usage: check_pages.py COMMAND PAGE...
"""
import re
import subprocess
import sys
from functools import lru_cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COMMAND = sys.argv[1]
SUFFIXES = "hpp|cpp|py|md|cmake|verm|yarn|svg|sh"


def without_blocks(text):
    return re.sub(r"^```.*?^```[ \t]*$", "", text, flags=re.MULTILINE | re.DOTALL)


@lru_cache(None)
def anchors(page):
    """Anchors of a page's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.*)$", without_blocks(page.read_text()), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-") for heading in headings}


def link_faults(page, text):
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if "://" in target:
            continue
        name, _, anchor = target.partition("#")
        file = (page.parent / name).resolve() if name else page
        if not file.exists():
            yield f"link to {target}: no such file"
        elif anchor and file.suffix == ".md" and anchor not in anchors(file):
            yield f"link to {target}: no such heading"


@lru_cache(None)
def source_files():
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-co", "--exclude-standard"], text=True, capture_output=True)
    names = listed.stdout.split("\n") if listed.returncode == 0 else [
        str(file.relative_to(ROOT)) for file in ROOT.rglob("*") if file.is_file()]
    return ["/" + name for name in names]


def file_faults(text):
    """`stage/file.hpp`, wherever it lies; a name without a folder may be one of the reader's own."""
    for name in re.findall(rf"`([\w./-]+/[\w.-]+\.(?:{SUFFIXES}))`", text):
        if not any(known.endswith("/" + name.removeprefix("./")) for known in source_files()) and "/PREFIX" not in name:
            yield f"`{name}`: no such file in the source"


@lru_cache(None)
def test_names():
    pattern = re.compile(r"TEST(?:_F|_P)?\((\w+),\s*(\w+)\)")
    return {f"{suite}.{name}" for file in (ROOT / "tests").rglob("*.cpp")
            for suite, name in pattern.findall(file.read_text())}


def test_faults(text):
    suites = {name.split(".")[0] for name in test_names()}
    for suite, name in re.findall(r"`([A-Z]\w+)\.([A-Za-z]\w+)`", text):
        if suite in suites and f"{suite}.{name}" not in test_names():
            yield f"`{suite}.{name}`: no such test"


@lru_cache(None)
def subcommands():
    overview = subprocess.run([COMMAND, "--help"], text=True, capture_output=True, check=True).stdout
    return re.findall(r"^  ([a-z]+) ", overview, re.MULTILINE)


@lru_cache(None)
def known_options(subcommand):
    """None: not a subcommand."""
    if subcommand not in subcommands():
        return None
    done = subprocess.run([COMMAND, subcommand, "--help"], text=True, capture_output=True, check=True)
    return set(re.findall(r"--[a-z][\w-]*", done.stdout))


def option_faults(text):
    for line in text.splitlines():
        for subcommand, rest in re.findall(r"(?:loopwright |`)([a-z]+) ([^`|]*--[^`]*)", line):
            known = known_options(subcommand)
            if known is None:
                continue
            for option in re.findall(r"(?<![\w-])--[a-z][\w-]*", re.split(r"&&|;|\|", rest)[0]):
                if option not in known:
                    yield f"loopwright {subcommand} knows no {option}"


def default_faults(text):
    """Rows | `Struct::field` | ... | default | of the tables of an energy's page."""
    tables = re.findall(r"^\| parameter .*\| default \|\n(?:\|.*\n)+", text, re.MULTILINE)
    for struct, field, stated in re.findall(r"^\| `(\w+)::(\w+)` \|.*\| ([^|]+) \|$", "".join(tables), re.MULTILINE):
        body = next((match.group(1) for file in (ROOT / "src").rglob("*.hpp")
                     if (match := re.search(rf"^struct {struct} \{{(.*?)^\}};", file.read_text(),
                                            re.MULTILINE | re.DOTALL))), "")
        # in a list of fields, `double width = 0, height = 0`, too
        found = re.search(rf"\b{field}\s*=\s*([^,;]+)[,;]", re.sub(r"//[^\n]*", "", body))
        if not found:
            yield f"{struct}::{field} has no default in the source"
        elif re.sub(r"\s", "", found.group(1)) != stated.strip().strip("`"):
            yield f"{struct}::{field}: the page says {stated.strip()}, the source {found.group(1)}"


def untold_options():
    told = set(re.findall(r"--[a-z][\w-]*", "".join(page.read_text() for page in (ROOT / "docs").rglob("*.md"))))
    for subcommand in subcommands():
        for option in sorted(known_options(subcommand) - told - {"--help"}):
            yield f"no page of docs tells of {subcommand} {option}"


def manual_faults():
    yield from untold_options()
    listed = set(re.findall(r"\]\(([\w/]+\.md)", (ROOT / "docs/README.md").read_text()))
    for page in sorted((ROOT / "docs").rglob("*.md")):
        name = str(page.relative_to(ROOT / "docs"))
        if name != "README.md" and name not in listed:
            yield f"docs/README.md does not list {name}"
    for energy in sorted((ROOT / "src/mechanics/energies").glob("*.hpp")):
        if energy.stem not in ("all", "energy", "lanes", "segment_term") and not (ROOT / f"docs/energies/{energy.stem}.md").exists():
            yield f"{energy.relative_to(ROOT)} has no page docs/energies/{energy.stem}.md"


def main():
    faults = list(manual_faults())
    pages = [Path(name).resolve() for name in sys.argv[2:]]
    for page in pages:
        text = page.read_text()
        prose = without_blocks(text)
        found = [*link_faults(page, prose), *file_faults(prose), *test_faults(prose), *option_faults(text)]
        if page.parent.name == "energies":
            found += default_faults(prose)
        faults += [f"{page.relative_to(ROOT)}: {fault}" for fault in found]
    for fault in faults:
        print(fault)
    print(f"{len(pages)} pages, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
