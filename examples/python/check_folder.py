# %% [markdown]
# # Checking a folder of programmes
#
# Every knitout and fabric file of a folder is read and knitted on the virtual machine; what is wrong is listed with line and
# remedy. The exit status is 1 if anything is.

# %%
import argparse
import csv
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import loopwright

parser = argparse.ArgumentParser()
parser.add_argument("folder", nargs="?", type=Path,
                    default=Path(__file__).parents[1] if "__file__" in globals() else Path("examples"))
parser.add_argument("--machine", choices=["shima", "kniterate"], help="ask the rules of this make as well")
parser.add_argument("--csv", type=Path, help="all that was said, a line each")
arguments, _ = parser.parse_known_args()

# %%
files = sorted(file for file in arguments.folder.rglob("*") if file.suffix in (".k", ".knitout", ".verm"))
with ThreadPoolExecutor() as workers:  # checking lets the rest of Python run
    found = list(workers.map(lambda file: loopwright.check(file, arguments.machine), files))

# %%
for file, findings in zip(files, found):
    verdict = "good" if findings else f"{findings.errors} errors"
    notes = ", ".join(f"{count} {what}" for count, what in ((findings.warnings, "warnings"), (findings.advice, "advice"))
                      if count)
    print(f"{verdict:>10}  {file.relative_to(arguments.folder)}: {findings.loops} loops" + (f" ({notes})" if notes else ""))
    for said in (d for d in findings.diagnostics if d.severity == "error"):
        print(f"{'':>10}  line {said.line}, column {said.column}: {said.message}")
good = sum(map(bool, found))
print(f"{good} of {len(files)} programmes are good")

# %%
if arguments.csv:
    with arguments.csv.open("w", newline="") as out:
        table = csv.writer(out)
        table.writerow(["file", "line", "column", "severity", "message", "remedy"])
        table.writerows([d.file, d.line, d.column, d.severity, d.message, d.remedy]
                        for findings in found for d in findings.diagnostics)
if "__file__" in globals():
    sys.exit(0 if good == len(files) else 1)
