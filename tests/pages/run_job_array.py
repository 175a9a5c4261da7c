"""Runs a Slurm job array on this machine: what sbatch would do with the script, without a queue.

Honoured are the #SBATCH lines --array (a range with %limit and step), --cpus-per-task, --output (%A, %a, %x), --job-name
and --export; any other line that Slurm has no option for is a fault. Tasks run one after the other.
"""
import os
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KNOWN = {"array", "cpus-per-task", "output", "job-name", "time", "mem", "mem-per-cpu", "partition", "nodes", "ntasks",
         "account", "error", "mail-type", "export", "hint"}


def directives(text):
    """Options of the #SBATCH lines; Slurm reads them up to the first command."""
    options = {}
    for line in text.splitlines():
        if line.startswith("#SBATCH"):
            for word in line.split()[1:]:
                name, _, value = word.removeprefix("--").partition("=")
                options[name] = value
        elif line.strip() and not line.startswith("#"):
            break
    return options


def task_numbers(array):
    """"0-25", "0-25%4", "1,3,7", "0-20:5"."""
    for part in array.split("%")[0].split(","):
        bounds, _, step = part.partition(":")
        first, _, last = bounds.partition("-")
        yield from range(int(first), int(last or first) + 1, int(step or 1))


def job_array_fault(text, command):
    """None, or what is wrong: an option that Slurm does not know, or a task that fails. Runs the first task and the
    last one in a folder with examples/, the first one once more, and wants results (JSON) from each."""
    options = directives(text)
    if strange := sorted(set(options) - KNOWN):
        return f"sbatch options that are not known: {strange}"
    numbers = list(task_numbers(options["array"]))
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        shutil.copytree(ROOT / "examples", folder / "examples")
        (folder / "job.sh").write_text(text)
        for number in (numbers[0], numbers[-1], numbers[0]):
            started = time.time_ns()
            environment = dict(os.environ, PATH=f"{Path(command).parent}:{os.environ['PATH']}", SLURM_JOB_ID="1000",
                               SLURM_ARRAY_JOB_ID="1000", SLURM_ARRAY_TASK_ID=str(number),
                               SLURM_ARRAY_TASK_COUNT=str(len(numbers)), SLURM_ARRAY_TASK_MIN=str(numbers[0]),
                               SLURM_ARRAY_TASK_MAX=str(numbers[-1]), SLURM_SUBMIT_DIR=str(folder),
                               SLURM_CPUS_PER_TASK=options.get("cpus-per-task", "1"))
            done = subprocess.run(["bash", "job.sh"], cwd=folder, env=environment, text=True, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            if done.returncode:
                return f"task {number} ends with {done.returncode}:\n{done.stdout}"
            if not any(file.stat().st_mtime_ns >= started and file.stat().st_size for file in folder.rglob("*.json")):
                return f"task {number} leaves no results:\n{done.stdout}"
    return None
