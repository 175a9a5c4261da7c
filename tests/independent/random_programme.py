"""Random knitout: programmes that keep every rule, and the same with one line spoilt."""

RACKINGS = ("0", "0", "1", "-1", "2", "-2", "+1.0", "-0", "0.25", "-0.75", "0.5", "-0.25")
BEDS = ("f", "b")
REACH = 3  # needles -3..3, few enough that loops stack and carriers meet


class Writer:
    """Writes a programme that keeps the rules, with what it must remember to keep them."""

    def __init__(self, random):
        self.random = random
        self.lines = []
        self.out = ["A", "B", "C", "D"]
        self.active = []
        self.hook = None
        self.racking = 0.0

    def add(self, *words):
        self.lines.append(" ".join(word for word in words if word))

    def number(self):
        return self.random.randint(-REACH, REACH)

    def needle(self):
        return f"{self.random.choice(BEDS)}{self.number()}"

    def side(self):
        return self.random.choice("+-")

    def some(self, least=0):
        """Some of the active carriers, in any order."""
        count = min(len(self.active), self.random.choice((1, 1, 1, 1, 2, 3)))
        if least == 0 and self.random.random() < 0.1:
            count = 0
        return self.random.sample(self.active, count)

    def facing(self, source_may_be_slider):
        """Two needles that face each other, or nothing at a racking where none do."""
        if self.racking != int(self.racking):
            return None
        number = self.number()
        front, back = ["f", number + int(self.racking)], ["b", number]
        pair = [front, back] if self.random.random() < 0.5 else [back, front]
        if self.random.random() < 0.2:
            pair[self.random.randint(0, 1) if source_may_be_slider else 1][0] += "s"
        return [f"{bed}{index}" for bed, index in pair]

    def transfer(self):
        pair = self.facing(source_may_be_slider=True)
        if pair:
            self.add("xfer", *pair)

    def bring_in(self):
        if not self.out:
            return
        brought = self.random.sample(self.out, min(len(self.out), self.random.choice((1, 1, 2))))
        with_hook = self.hook is None and self.random.random() < 0.5
        self.add("inhook" if with_hook else "in", *brought)
        for _ in range(self.random.randint(0, 2)):
            self.transfer()
        use = list(brought)
        self.random.shuffle(use)  # the first use names the whole set, in any order
        pair = self.facing(source_may_be_slider=False)
        op = self.random.choice(("knit", "tuck", "miss", "split"))
        if op == "split" and pair:
            self.add(op, self.side(), *pair, *use)
        else:
            self.add("knit" if op == "split" else op, self.side(), self.needle(), *use)
        self.out = [c for c in self.out if c not in brought]
        self.active += brought
        if with_hook:
            self.hook = brought

    def release(self):
        if self.hook:
            self.add("releasehook", *self.random.sample(self.hook, len(self.hook)))
            self.hook = None

    def take_out(self, carriers):
        if carriers:
            self.add("outhook" if self.hook is None and self.random.random() < 0.5 else "out", *carriers)
            self.active = [c for c in self.active if c not in carriers]
            self.out += carriers

    def step(self):
        op = self.random.choices(
            ("in", "release", "out", "rack", "knit", "tuck", "split", "miss", "drop", "xfer", "other"),
            (4 if self.active else 40, 2, 2, 8, 24, 10, 12, 6, 6, 26, 2),
        )[0]
        if op == "in":
            self.bring_in()
        elif op == "release":
            self.release()
        elif op == "out":
            self.take_out([c for c in self.some(1) if not (self.hook and c in self.hook)])
        elif op == "rack":
            racking = self.random.choice(RACKINGS)
            self.racking = float(racking)
            self.add("rack", racking)
        elif op in ("knit", "tuck"):
            self.add(op, self.side(), self.needle(), *self.some())
        elif op == "split":
            carriers = self.some()
            pair = self.facing(source_may_be_slider=not carriers)
            if pair:
                self.add(op, self.side(), *pair, *carriers)
        elif op == "miss" and self.active:
            self.add(op, self.side(), self.needle(), *self.some(1))
        elif op == "drop":
            self.add(op, self.needle())
        elif op == "xfer":
            self.transfer()
        elif op == "other":
            self.add(self.random.choice(("pause", "stitch 2.5 -1", "amiss f0", " ; nothing")))


def programme(random, steps):
    """The lines of a programme that keeps every rule; loops may be left on needles."""
    writer = Writer(random)
    for _ in range(steps):
        writer.step()
    writer.release()
    writer.take_out(list(writer.active))
    return [";!knitout-2", ";;Carriers: A B C D", *writer.lines]


def spoilt(random, lines):
    """The same with one line left out, doubled, moved down, or with one word changed or added."""
    lines = list(lines)
    at = random.randrange(2, len(lines) - 1)
    way = random.randrange(5)
    if way == 0:
        del lines[at]
    elif way == 1:
        lines.insert(at, lines[at])
    elif way == 2:
        lines[at], lines[at + 1] = lines[at + 1], lines[at]
    else:
        words = lines[at].split(" ")
        word = random.choice(
            ("f1", "b2", "fs1", "bs0", "f", "b-", "+", "-", "A", "B", "Z", "1", "0.5", "1e3", "knit", "xfer", "purl")
        )
        if way == 3:
            words[random.randrange(len(words))] = word
        else:
            words.append(word)
        lines[at] = " ".join(words)
    return lines
