"""What became of every test between two revisions, by the lists of their names.

    pytest --collect-only > before.txt    # at one revision, after.txt at the other
    python -m tests.names before.txt after.txt

The first two lines count the names that were kept, that are gone and that are new. Under each file follow the functions
whose names changed: ``~`` has other cases, ``>`` stands in another file, ``-`` is gone, ``+`` is new in this file.
"""

import sys
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path


def names_of(lines: Iterable[str]) -> Counter[str]:
    """Names of tests among the lines that pytest prints."""
    return Counter(line.strip() for line in lines if "::" in line)


def changes(before: Counter[str], after: Counter[str]) -> Iterator[str]:
    """Lines that say what became of the tests."""
    gone, new = before - after, after - before
    yield f"{before.total()} before, {after.total()} after"
    yield f"{(before & after).total()} kept, {gone.total()} gone, {new.total()} new"
    was, now = by_file(before), by_file(after)
    lost, added = by_file(gone), by_file(new)
    for file in sorted({*lost, *added}):
        yield f"{file}: {lost[file].total()} gone, {added[file].total()} new"
        for function in sorted(lost[file]):
            others = [other for other in now if function in now[other] and function not in was[other]]
            if function in now[file]:
                yield f"  ~ {function}: {was[file][function]} cases, now {now[file][function]}"
            elif others:
                yield f"  > {function} ({lost[file][function]}): now in {', '.join(sorted(others))}"
            else:
                yield f"  - {function} ({lost[file][function]})"
        for function in sorted({*added[file]} - {*lost[file]}):
            kind = "~" if function in was[file] else "+"
            yield f"  {kind} {function} ({added[file][function]})"


def by_file(names: Counter[str]) -> dict[str, Counter[str]]:
    """Numbers of cases, by file and by function."""
    files: dict[str, Counter[str]] = defaultdict(Counter)
    for name, count in names.items():
        file, _, test = name.partition("::")
        files[file][test.partition("[")[0]] += count
    return files


if __name__ == "__main__":
    lists = (names_of(Path(name).read_text(encoding="utf-8").splitlines()) for name in sys.argv[1:3])
    sys.stdout.write("\n".join(changes(*lists)) + "\n")
