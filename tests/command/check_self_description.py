#!/usr/bin/env python3
"""Manual page and shell completions against the command's own help: each names all subcommands and options, and no others.

The page is read as man shows it. Completions are asked of a real bash, and of zsh and fish where they are installed; zsh,
whose completion wants a terminal, is read.

Usage: check_self_description.py COMMAND
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COMMAND = Path(sys.argv[1]).resolve()
faults = []


def expect(truth, what):
    if not truth:
        faults.append(what)


def expect_same(found, wanted, what):
    missing, extra = sorted(set(wanted) - set(found)), sorted(set(found) - set(wanted))
    expect(not missing and not extra, f"{what}: missing {missing}, not in the help {extra}")


def output(*command, **more):
    return subprocess.run([str(word) for word in command], text=True, check=True, stdout=subprocess.PIPE, **more).stdout


# Help.

def help_of(*subcommand):
    """Options of a help page with the words that each allows, and the subcommands that it lists."""
    options, subcommands = {}, []
    for line in output(COMMAND, *subcommand, "--help").splitlines():
        if match := re.match(r"  (-[-,\w]+)( .*)?", line):
            choices = re.search(r"\{([^}]*)\}", match.group(2) or "")
            for name in match.group(1).split(","):
                options[name] = choices.group(1).split(",") if choices else []
        elif match := re.match(r"  ([a-z]+) ", line):
            subcommands.append(match.group(1))
    return options, subcommands


# Manual page.

def sections(text, heading):
    """Text of each section, by its heading."""
    parts = re.split(heading, text, flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2]))


def option_names(text):
    """Names in the lines that begin with one."""
    return {name for line in text.splitlines() if re.match(r"\s+-", line)
            for name in re.findall(r"(?<![\w-])--?[a-z][\w-]*", line.split("Excludes:")[0].split("Needs:")[0])}


def check_page(all_options, top):
    with tempfile.NamedTemporaryFile("w", suffix=".1") as page:
        page.write(output(COMMAND, "manual"))
        page.flush()
        environment = dict(os.environ, MANWIDTH="400", LC_ALL="C.UTF-8", MANPAGER="cat", PAGER="cat")
        done = subprocess.run(["man", "--warnings", "--no-hyphenation", "-l", page.name], text=True, env=environment,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    expect(done.returncode == 0 and not done.stderr, f"man says of the page: {done.stderr}")
    text = re.sub(r"\x1b\[[\d;]*m|.\x08", "", done.stdout)
    chapters = sections(text, r"^([A-Z][A-Z ]+)$")
    expect_same(option_names(chapters["OPTIONS"]), top, "manual page, options before a subcommand")
    described = sections(chapters["COMMANDS"], r"^   loopwright ([a-z]+)$")
    expect_same(described, all_options, "manual page, subcommands")
    for name, options in all_options.items():
        expect_same(option_names(described.get(name, "")), options, f"manual page, options of {name}")
        for words in options.values():
            expect(all(word in described.get(name, "") for word in words), f"manual page, {name}: not all of {words}")
    # its examples are of README.md, whose commands a test runs
    readme = (ROOT / "README.md").read_text().splitlines()
    examples = [line.strip() for line in chapters["EXAMPLES"].splitlines() if line.strip()]
    expect(len(examples) >= 3 and all(line in readme for line in examples), f"examples that README.md lacks: {examples}")


# Completions.

def completed_by_bash(script, *words):
    """What bash offers for the last of the words."""
    ask = (f"source {script}; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _loopwright; "
           "printf '%s\\n' \"${COMPREPLY[@]}\"")
    return output("bash", "--norc", "-euo", "pipefail", "-c", ask, "bash", "loopwright", *words).split()


def check_bash(folder, all_options, top):
    script = folder / "loopwright.bash"
    output(COMMAND, "completion", "bash", "-o", script)
    expect_same(completed_by_bash(script, ""), [*all_options, *top], "bash, the first word")
    expect_same(completed_by_bash(script, "re"), [name for name in all_options if name.startswith("re")], "bash, re")
    for name, options in all_options.items():
        expect_same(completed_by_bash(script, name, "-"), options, f"bash, options of {name}")
        for option, words in options.items():
            if option not in ("-h", "--help"):
                expect_same(completed_by_bash(script, name, option, ""), words, f"bash, {name} {option}")
    expect_same(completed_by_bash(script, "completion", ""), ["bash", "zsh", "fish"], "bash, a word told by its place")


def check_zsh(folder, all_options, top):
    script = folder / "_loopwright"
    output(COMMAND, "completion", "zsh", "-o", script)
    arms = sections(script.read_text(), r"^        ([a-z]+)\)$")
    expect_same(arms, all_options, "zsh, subcommands")
    for name, options in all_options.items():
        specs = re.findall(r"^ +'(-[\w-]+)\[.*?(?:\(([^()]*)\))?'(?: \\)?$", arms.get(name, ""), re.MULTILINE)
        expect_same([spec for spec, _ in specs], options, f"zsh, options of {name}")
        for option, words in options.items():
            expect(dict(specs).get(option, "").split() == words or not words, f"zsh, {name} {option}: not {words}")
    if shutil.which("zsh"):
        subprocess.run(["zsh", "-n", script], check=True)


def check_fish(folder, all_options, top):
    script = folder / "loopwright.fish"
    output(COMMAND, "completion", "fish", "-o", script)
    if not shutil.which("fish"):
        print("fish is not installed: its completions were printed, not asked")
        return

    def offered(line):
        ask = f"source {script}; complete -C '{line}'"
        home = dict(os.environ, HOME=str(folder), PATH=f"{COMMAND.parent}:{os.environ['PATH']}")
        return [word.split("\t")[0] for word in output("fish", "--no-config", "-c", ask, env=home).splitlines()]

    expect_same(offered("loopwright "), all_options, "fish, the first word")
    for name, options in all_options.items():
        long_ones = [option for option in options if option.startswith("--")]
        expect_same(offered(f"loopwright {name} --"), long_ones, f"fish, options of {name}")
        for option in long_ones:
            if options[option]:
                expect_same(offered(f"loopwright {name} {option} "), options[option], f"fish, {name} {option}")


def check_version():
    facts = json.loads(output(COMMAND, "version", "--json", "-"))
    said = output(COMMAND, "--version")
    expect(said.startswith(f"loopwright {facts['version']}\n"), "--version and version --json differ")
    if (ROOT / ".git").exists():
        expect(re.fullmatch(r"[0-9a-f]{12}( with changes)?", facts["commit"]), f"commit {facts['commit']}")
    else:  # a plain copy, or an archive that git filled its commit into
        expect(re.fullmatch(r"unknown|[0-9a-f]{7,40}", facts["commit"]), f"commit {facts['commit']} without a repository")


def main():
    top, subcommands = help_of()
    all_options = {name: help_of(name)[0] for name in subcommands}
    count = sum(map(len, all_options.values()))
    expect(len(subcommands) >= 15 and count >= 130, f"only {count} options of {subcommands} found in the help")
    check_version()
    if shutil.which("man"):
        check_page(all_options, top)
    else:
        print("man is not installed: the manual page was not looked at")
    with tempfile.TemporaryDirectory() as folder:
        for check in (check_bash, check_zsh, check_fish):
            check(Path(folder), all_options, top)
    for fault in faults:
        print(fault)
    print(f"{len(subcommands)} subcommands, {count} options: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
