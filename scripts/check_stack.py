#!/usr/bin/env python3
"""Stack of the deepest chain of calls below each entry of the library.

Reads the call graphs that gcc -fcallgraph-info=su leaves beside the objects. Fails on recursion, on a frame whose size the
compiler does not know, and on a chain above the ceiling. Functions outside the library (libc, libm, LAPACKE) are named, their
own stack is not known and not counted.

A call through a pointer may reach every function whose address is taken: those in a table (a relocation from data names them)
and the static ones that are in the object although nothing calls them directly. The library's tables give each member a
function of the member's own name, or one that ends in _ and that name, so a call written p->member(...) is taken to reach
those only; when there are none, it may reach all. A frame that gcc calls "dynamic,bounded" has a known size.
"""
import argparse
import collections
import pathlib
import re
import subprocess
import sys

NODE = re.compile(r'node: \{ title: "([^"]+)" label: "([^"]*)"')
EDGE = re.compile(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"(?: label: "([^"]*)")?')
FRAME = re.compile(r"(\d+) bytes \(([a-z,]+)\)")
RELOCATION_SECTION = re.compile(r"RELOCATION RECORDS FOR \[(.*)\]")
MEMBER_CALL = re.compile(r"(?:[\w\]]+(?:->|\.))+(\w+)\s*\(")
INDIRECT = "__indirect_call"


def short(function):
    """The name without the file that gcc puts before a static function."""
    return function.rsplit(":", 1)[-1]


def members_called(place):
    """Names of the struct members called in the statement at "file:line:column"; gcc names where it starts, or the call in it."""
    file, line, column = place.rsplit(":", 2)
    lines = pathlib.Path(file).read_text().splitlines(keepends=True)[int(line) - 1:]
    statement = "".join(lines)[int(column) - 1:].split(";", 1)[0]
    return MEMBER_CALL.findall(statement)


def read_call_graph(objects):
    """Frame of every function ({name: bytes}), who calls whom, the places of calls through pointers by caller, the functions with
    frames of unknown size."""
    frames, calls, indirect, unknown = {}, collections.defaultdict(set), collections.defaultdict(set), []
    for path in objects:
        text = path.with_suffix(".ci").read_text()
        for name, label in NODE.findall(text):
            frame = FRAME.search(label)
            if frame:
                frames[name] = int(frame.group(1))
                if frame.group(2) not in ("static", "dynamic,bounded"):
                    unknown.append(name)
        for caller, callee, place in EDGE.findall(text):
            if callee == INDIRECT:
                indirect[caller].add(place)
            else:
                calls[caller].add(callee)
    return frames, calls, indirect, unknown


def functions_in_tables(objects, objdump):
    """The functions whose address stands in initialised data."""
    functions = set()
    for path in objects:
        dump = subprocess.run([objdump, "-r", path], check=True, capture_output=True, text=True).stdout
        statics = {short(name): name for name, _ in NODE.findall(path.with_suffix(".ci").read_text()) if ":" in name}
        in_data = False
        for line in dump.splitlines():
            header = RELOCATION_SECTION.match(line)
            if header:
                in_data = re.match(r"\.(data|rodata)", header.group(1)) is not None
            elif in_data and len(line.split()) == 3:
                name = re.sub(r"^\.text\.(unlikely\.|hot\.)?", "", line.split()[2])
                functions.add(statics.get(name, name))
    return functions


def deepest_chains(frames, calls):
    """{function: chain of functions that takes the most stack}; raises RecursionError with the cycle."""
    chains, path = {}, []

    def visit(function):
        if function in path:
            raise RecursionError(" -> ".join(short(f) for f in path[path.index(function):] + [function]))
        if function not in chains:
            path.append(function)
            below = [visit(callee) for callee in sorted(calls[function]) if callee in frames]
            path.pop()
            chains[function] = [function] + max(below, key=lambda chain: sum(frames[f] for f in chain), default=[])
        return chains[function]

    for function in sorted(frames):
        visit(function)
    return chains


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("objects", nargs="+", type=pathlib.Path, metavar="OBJECT")
    parser.add_argument("--ceiling", type=int, required=True, help="most bytes that a chain may take")
    parser.add_argument("--objdump", default="objdump")
    options = parser.parse_args()

    frames, calls, indirect, unknown = read_call_graph(options.objects)
    called = {callee for callees in calls.values() for callee in callees}
    in_tables = functions_in_tables(options.objects, options.objdump)
    targets = {f for f in frames if f in in_tables or (":" in f and f not in called)}
    for caller, places in indirect.items():
        for place in places:
            named = [{f for f in targets if f"_{short(f)}".endswith(f"_{member}")} for member in members_called(place)]
            calls[caller] |= set.union(*named) if named and all(named) else targets
    try:
        chains = deepest_chains(frames, calls)
    except RecursionError as cycle:
        sys.exit(f"recursion: {cycle}")

    def bytes_below(function):
        return sum(frames[f] for f in chains[function])

    print("largest frames:")
    for function in sorted(frames, key=frames.get, reverse=True)[:5]:
        print(f"  {frames[function]:6d}  {short(function)}")
    reached = set().union(*calls.values())
    entries = [f for f in frames if f not in reached]
    print("deepest chains, by entry:")
    for function in sorted(entries, key=bytes_below, reverse=True)[:8]:
        print(f"  {bytes_below(function):6d}  " + " > ".join(short(f) for f in chains[function]))
    outside = reached - set(frames)
    print("called outside the library, not counted: " + ", ".join(sorted(short(f) for f in outside)))

    if unknown:
        sys.exit("frames of unknown size: " + ", ".join(sorted(short(f) for f in unknown)))
    worst = max(entries, key=bytes_below)
    if bytes_below(worst) > options.ceiling:
        sys.exit(f"{short(worst)} takes {bytes_below(worst)} bytes of stack, above the ceiling of {options.ceiling}")
    print(f"worst: {bytes_below(worst)} bytes, ceiling {options.ceiling}; no recursion, every frame of known size")


if __name__ == "__main__":
    main()
