#!/usr/bin/env python3
"""A second reading of knitout 2, written from its published rules and not from this project's machine.

    knitout_check.py [--history] FILE...

prints a JSON list with one object per file:

    file            the path as given
    accepted        true when there is no error
    errors          [[line, message], ...] in the order found; a carrier that is left in is told at the line that
                    brought it in
    warnings        the same shape; they never make a file rejected
    loops_at_end    {needle: [[carrier, line of the operation that made the loop], ...]} in stack order
    stack_heights   {needle: loops on it at the end}; empty needles are left out
    most_stack      the highest stack that any needle held after any operation
    carriers        {carrier: {"position": needle and side or null, "active": bool, "last_used_at": ...}}
                    last_used_at: its position just after its last use, before transfers took it along
    counts          operations by meaning: knit, tuck, xfer, split, drop, miss
    loops_made      loops formed, one for each yarn of each knit, tuck or split

and, with --history, what a programme that binds off and takes its carriers out no longer shows at the end:

    loops           one line of words for each loop, in the order formed: its carrier and line; every needle it
                    came onto, with the line, as f3@40; the word `through` and the places in this list of the
                    loops it was drawn through, in stack order, if there were any; and its end, cast_off@60 (by
                    a knit), dropped@60 or held
    uses            one line of words for each carrier of each knit, tuck, split and miss: the line, the carrier,
                    the needle it was beside just before (`in` on the first use after it was brought in) and its
                    position after

Conventions
-----------
Needle       `f`, `b` (hooks) or `fs`, `bs` (sliders) and a whole number. A hook and the slider over it are
             two separate places; `f` and `fs` belong to the front bed, `b` and `bs` to the back bed.
Racking      R = F - B: back needle B lies opposite front needle B + R; R > 0 is the back bed moved right.
             A transfer or split needs opposite beds and F = B + R exactly, so a whole R, also when the
             needle it comes from is empty.
Position     a needle and a side, "f3+" (just right of f3) or "f3-" (just left of it). It is the logical
             position: racking leaves it alone, however far its needle moves, and a drop does too.
Set rule     after knit, tuck, split or miss `D N CS` each carrier of CS is at N on the side D.
Motion rule  after split or xfer N N2 a carrier outside CS that was at N (either side) is at N2 on that side,
             whether or not N held loops.
Side         taken over unchanged by the motion rule, also from one bed to the other.
Loops        one for each yarn of a stitch, in the order the carriers are written. A stack is listed from the
             oldest to the newest: a stitch or a tuck is added at the end, a transfer adds the moved stack
             reversed after what its target already held.
No carriers  knit, tuck and split without carriers are drop, amiss and xfer, and are counted so.
Empty needle knit makes a loop there, drop and xfer do nothing, split makes its loop.
A carrier    is out, waiting (after `in` or `inhook`, until its first use) or active. Its first use is a
             knit, tuck, split or miss and must name the whole set it was brought in with, in any order.
             A carrier that was taken out keeps its last position in the report, with active false;
             one that has not been used since the start of the file has position null.
The hook     is busy from `inhook` until `releasehook` of the same set, which needs a use in between.
At the end   a carrier that is not out, waiting ones included, is an error; loops on needles are not.
Carriers     a missing header is a warning, and then every name is allowed; a name that a present header
             lacks is an error.
After an error the rules say nothing. Here an operation with a malformed word, on a slider, or between needles
             that do not face each other is not carried out; a carrier that was not in counts as in from there.
"""

import json
import math
import re
import sys
from functools import lru_cache

MAGIC = re.compile(r"^;!knitout-([0-9]+)$")
HEADER = re.compile(r"^;;([^:]*): (.*)$")
NEEDLE = re.compile(r"^([fb]s?)(-?[0-9]+)$")
NUMBER = re.compile(r"^[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?$")
KNOWN_HEADERS = {"Carriers", "Machine", "Gauge", "Position", "Width", "Presser"}
NEWEST_VERSION = 2


class Refused(Exception):
    """An operation that breaks a rule and is not carried out."""


class Machine:
    """The state of one machine, and what happened on it. Needles are (bed, number), positions (needle, side)."""

    def __init__(self):
        self.line = 0
        self.errors = []
        self.warnings = []
        self.declared = None  # names of the Carriers header, None when it is missing
        self.racking = 0.0
        self.stacks = {}  # needle -> places in `loops`, only needles that hold something
        self.loops = []  # [carrier, line, words of its path, words of its parents, end]
        self.uses = []
        self.waiting = {}  # carrier -> the set it was brought in with
        self.active = set()
        self.brought_at = {}  # carrier -> line of the `in` or `inhook`, or of a first use without one
        self.positions = {}  # carrier -> (needle, side), kept after `out`
        self.last_used_at = {}  # the same, as it was just after its last use
        self.hook = None  # the set that the yarn inserting hook holds
        self.hook_used = False
        self.most_stack = 0
        self.counts = dict.fromkeys(("knit", "tuck", "xfer", "split", "drop", "miss"), 0)

    # --- reports ---------------------------------------------------------------------------------------------
    def error(self, message):
        self.errors.append([self.line, message])

    def warning(self, message):
        self.warnings.append([self.line, message])

    # --- words -----------------------------------------------------------------------------------------------
    @staticmethod
    def direction(word):
        if word not in ("+", "-"):
            raise Refused(f"'{word}' is not a direction")
        return word

    @staticmethod
    @lru_cache(maxsize=None)
    def needle(word):
        match = NEEDLE.match(word)
        if not match:
            raise Refused(f"'{word}' is not a needle")
        return match.group(1), int(match.group(2))

    @staticmethod
    @lru_cache(maxsize=None)
    def number(word):
        if not NUMBER.match(word) or not math.isfinite(float(word)):
            raise Refused(f"'{word}' is not a number")
        return float(word)

    def carriers(self, words):
        for word in words:
            if "," in word:
                raise Refused(f"'{word}' is not a carrier")
            if self.declared is not None and word not in self.declared:
                self.error(f"carrier {word} is not in the Carriers header")
        if len(set(words)) != len(words):
            raise Refused("a carrier is named twice in one set")
        return words

    # --- state changes ---------------------------------------------------------------------------------------
    def put(self, needle, loops):
        if loops:
            stack = self.stacks.setdefault(needle, [])
            stack.extend(loops)
            self.most_stack = max(self.most_stack, len(stack))

    def use(self, carriers):
        """Carriers that are about to work: what was waiting comes in."""
        for carrier in carriers:
            if carrier in self.waiting:
                brought = self.waiting[carrier]
                if set(brought) != set(carriers):
                    self.error(f"the first use of {' '.join(brought)} must name exactly these carriers")
                if self.hook is not None and carrier in self.hook:
                    self.hook_used = True
            elif carrier not in self.active:
                self.error(f"carrier {carrier} is not in")
                self.brought_at[carrier] = self.line
        self.beside = [place(self.positions[c])[:-1] if c in self.active else "in" for c in carriers]
        for carrier in carriers:
            self.waiting.pop(carrier, None)
            self.active.add(carrier)

    def set_positions(self, carriers, needle, side):
        for carrier, beside in zip(carriers, self.beside):
            self.positions[carrier] = self.last_used_at[carrier] = (needle, side)
            self.uses.append(f"{self.line} {carrier} {beside} {name(needle)}{side}")

    def make_loops(self, needle, carriers, parents):
        first = len(self.loops)
        path = f"{name(needle)}@{self.line}"
        through = f" through {' '.join(map(str, parents))}" if parents else ""
        for carrier in carriers:
            self.loops.append([carrier, self.line, path, through, "held"])
        self.put(needle, list(range(first, len(self.loops))))

    def end(self, loops, fate):
        for loop in loops:
            self.loops[loop][4] = f"{fate}@{self.line}"

    def require_hook_needle(self, needle):
        if needle[0].endswith("s"):
            raise Refused("no loop can be made on a slider")

    def pass_over(self, source, target, carriers):
        """The loops of `source` and the carriers beside it, other than `carriers`, go to `target`."""
        loops = self.stacks.pop(source, [])
        for loop in loops:
            self.loops[loop][2] += f" {name(target)}@{self.line}"
        self.put(target, loops[::-1])
        for carrier in self.active:
            if carrier not in carriers and self.positions[carrier][0] == source:
                self.positions[carrier] = (target, self.positions[carrier][1])

    def require_facing(self, source, target):
        if source[0][0] == target[0][0]:
            raise Refused(f"{name(source)} and {name(target)} are on the same bed")
        if source[0].endswith("s") and target[0].endswith("s"):
            raise Refused("a slider cannot pass loops to a slider")
        front, back = (source, target) if source[0][0] == "f" else (target, source)
        if front[1] != back[1] + self.racking:
            raise Refused(f"{name(source)} and {name(target)} are not opposite at racking {self.racking:g}")

    # --- operations ------------------------------------------------------------------------------------------
    def knit(self, words):
        side, needle, carriers = self.direction(words[0]), self.needle(words[1]), self.carriers(words[2:])
        if not carriers:
            return self.let_go(needle)
        self.require_hook_needle(needle)
        self.use(carriers)
        through = self.stacks.pop(needle, [])
        self.end(through, "cast_off")
        self.make_loops(needle, carriers, through)
        self.set_positions(carriers, needle, side)
        self.counts["knit"] += 1

    def tuck(self, words):
        side, needle, carriers = self.direction(words[0]), self.needle(words[1]), self.carriers(words[2:])
        if not carriers:
            return  # amiss
        self.require_hook_needle(needle)
        self.use(carriers)
        self.make_loops(needle, carriers, [])
        self.set_positions(carriers, needle, side)
        self.counts["tuck"] += 1

    def split(self, words):
        side, source, target = self.direction(words[0]), self.needle(words[1]), self.needle(words[2])
        carriers = self.carriers(words[3:])
        if not carriers:
            return self.transfer(source, target)
        self.require_facing(source, target)
        self.require_hook_needle(source)
        self.use(carriers)
        through = self.stacks.get(source, [])
        self.pass_over(source, target, carriers)
        self.make_loops(source, carriers, through)
        self.set_positions(carriers, source, side)
        self.counts["split"] += 1

    def miss(self, words):
        side, needle, carriers = self.direction(words[0]), self.needle(words[1]), self.carriers(words[2:])
        if not carriers:
            raise Refused("a miss without carriers makes no sense")
        self.use(carriers)
        self.set_positions(carriers, needle, side)
        self.counts["miss"] += 1

    def let_go(self, needle):
        self.end(self.stacks.pop(needle, []), "dropped")
        self.counts["drop"] += 1

    def transfer(self, source, target):
        self.require_facing(source, target)
        self.pass_over(source, target, ())
        self.counts["xfer"] += 1

    def bring_in(self, words, with_hook):
        carriers = self.carriers(words)
        if not carriers:
            raise Refused("names no carrier")
        if with_hook and self.hook is not None:
            self.error(f"the hook still holds {' '.join(self.hook)}")
        elif with_hook:
            self.hook, self.hook_used = list(carriers), False
        for carrier in carriers:
            if carrier in self.active or carrier in self.waiting:
                self.error(f"carrier {carrier} is in already")
            else:
                self.waiting[carrier] = list(carriers)
                self.brought_at[carrier] = self.line

    def take_out(self, words, with_hook):
        carriers = self.carriers(words)
        if not carriers:
            raise Refused("names no carrier")
        held = self.hook is not None and any(carrier in self.hook for carrier in carriers)
        if self.hook is not None and (with_hook or held):
            self.error(f"the hook still holds {' '.join(self.hook)}")
        for carrier in carriers:
            if carrier in self.waiting:
                self.error(f"carrier {carrier} has not been used")
            elif carrier not in self.active:
                self.error(f"carrier {carrier} is not in")
            self.waiting.pop(carrier, None)
            self.active.discard(carrier)
        if held:
            self.hook = None

    def release(self, words):
        carriers = self.carriers(words)
        if self.hook is None:
            raise Refused("the hook holds nothing")
        if set(carriers) != set(self.hook):
            raise Refused(f"the hook holds {' '.join(self.hook)}")
        if not self.hook_used:
            self.error("nothing was made with these carriers since the hook took them")
        self.hook = None

    def operation(self, words):
        op, words = words[0], words[1:]
        if op not in OPERATIONS:
            if op.startswith("x-"):
                self.warning(f"extension {op} is ignored")
                return
            raise Refused(f"'{op}' is not an operation")
        least, most, action = OPERATIONS[op]
        if not least <= len(words) <= most:
            raise Refused(f"'{op}' does not take {len(words)} words")
        action(self, words)

    def rack(self, words):
        self.racking = self.number(words[0])

    def stitch(self, words):
        self.number(words[0]), self.number(words[1])

    # --- the file --------------------------------------------------------------------------------------------
    def headers(self, lines):
        """Reads the first line and the header; the index of the first line after them."""
        index, seen = 0, set()
        self.line = 1
        match = MAGIC.match(lines[0]) if lines else None
        if match:
            index = 1
            if int(match.group(1)) > NEWEST_VERSION:
                self.warning(f"version {match.group(1)} is newer than {NEWEST_VERSION}")
        else:
            self.error("the first line is not ';!knitout-2'")
        while index < len(lines):
            match = HEADER.match(lines[index])
            if not match:
                break
            self.line = index + 1
            key, value = match.groups()
            if key in seen:
                self.warning(f"header {key} is given again; the last one counts")
            seen.add(key)
            if key == "Carriers":
                self.declared = {word for word in re.split(r"[ \t,;]+", value) if word}
            elif key not in KNOWN_HEADERS and not key.startswith(("X-", "Yarn-")):
                self.warning(f"header {key} is not known")
            index += 1
        if self.declared is None:
            self.warning("the Carriers header is missing")
        return index

    def run(self, data):
        try:
            text = data.decode("utf-8")
        except UnicodeDecodeError as fault:
            self.error(f"not UTF-8: {fault.reason}")
            text = data.decode("utf-8", errors="replace")
        lines = text.split("\n")
        if any(line.endswith("\r") for line in lines):
            self.warning("lines end in CR LF")
            lines = [line[:-1] if line.endswith("\r") else line for line in lines]
        for index in range(self.headers(lines), len(lines)):
            words = words_of(lines[index])
            if not words:
                continue
            self.line = index + 1
            try:
                self.operation(words)
            except Refused as refusal:
                self.error(str(refusal))
        for carrier in sorted(self.active | set(self.waiting)):
            self.line = self.brought_at[carrier]
            self.error(f"carrier {carrier} is still in at the end")

    def report(self, path, history):
        ordered = sorted(self.stacks)
        names = (self.declared or set()) | set(self.positions) | set(self.waiting)
        result = {
            "file": path,
            "accepted": not self.errors,
            "errors": self.errors,
            "warnings": self.warnings,
            "loops_at_end": {name(n): [self.loops[loop][:2] for loop in self.stacks[n]] for n in ordered},
            "stack_heights": {name(n): len(self.stacks[n]) for n in ordered},
            "most_stack": self.most_stack,
            "carriers": {
                c: {
                    "position": place(self.positions.get(c)),
                    "last_used_at": place(self.last_used_at.get(c)),
                    "active": c in self.active,
                }
                for c in sorted(names)
            },
            "counts": self.counts,
            "loops_made": len(self.loops),
        }
        if history:
            result["loops"] = [f"{loop[0]} {loop[1]} {loop[2]}{loop[3]} {loop[4]}" for loop in self.loops]
            result["uses"] = self.uses
        return result


@lru_cache(maxsize=None)
def words_of(line):
    """What stands before the first `;`, cut at blanks, which are space and tab and nothing else."""
    return [word for word in line.split(";", 1)[0].replace("\t", " ").split(" ") if word]


ANY = math.inf
# The least and the most words after each operation, and what it does with them.
OPERATIONS = {
    "in": (0, ANY, lambda machine, words: machine.bring_in(words, with_hook=False)),
    "inhook": (0, ANY, lambda machine, words: machine.bring_in(words, with_hook=True)),
    "releasehook": (0, ANY, Machine.release),
    "out": (0, ANY, lambda machine, words: machine.take_out(words, with_hook=False)),
    "outhook": (0, ANY, lambda machine, words: machine.take_out(words, with_hook=True)),
    "stitch": (2, 2, Machine.stitch),
    "rack": (1, 1, Machine.rack),
    "pause": (0, 0, lambda machine, words: None),
    "knit": (2, ANY, Machine.knit),
    "tuck": (2, ANY, Machine.tuck),
    "split": (3, ANY, Machine.split),
    "miss": (2, ANY, Machine.miss),
    "drop": (1, 1, lambda machine, words: machine.let_go(machine.needle(words[0]))),
    "amiss": (1, 1, lambda machine, words: machine.needle(words[0])),
    "xfer": (2, 2, lambda machine, words: machine.transfer(machine.needle(words[0]), machine.needle(words[1]))),
}


@lru_cache(maxsize=None)
def name(needle):
    return f"{needle[0]}{needle[1]}"


def place(position):
    return f"{name(position[0])}{position[1]}" if position else None


def check(path, history=False):
    """The report of one file as a dict of the shape given above. Raises OSError when it cannot be read."""
    machine = Machine()
    with open(path, "rb") as file:
        machine.run(file.read())
    return machine.report(path, history)


def main(arguments):
    history = "--history" in arguments
    paths = [argument for argument in arguments if argument != "--history"]
    if not paths:
        print("usage: knitout_check.py [--history] FILE...", file=sys.stderr)
        return 2
    reports = [check(path, history) for path in paths]
    json.dump(reports, sys.stdout, indent=1)
    print()
    return 0 if all(report["accepted"] for report in reports) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
