#!/usr/bin/env python3
"""Writes damaged copies of files, which are the same for the same seed.

    tests/hostile/mutate.py OUT COUNT FILE_OR_FOLDER... [--seed N] [--most-bytes N]

Takes the files in turns. Of a folder, it takes those that spawnfield reads. Each copy is cut, has altered bytes, a part
that is repeated, removed or exchanged, or a number that is replaced by an extreme one.
"""
import argparse
import random
import re
from pathlib import Path

ENDINGS = "3ds 3mf asc bt dae fbx glb gltf obj off ot pgm ply png sdf stl tif urdf world yaml".split()
EXTREMES = b"-1 0 1e308 -1e308 1e-308 nan inf 4294967295 4294967296 2147483648 99999999999999999999 0x7fffffff".split()


def cut(data, rng):
    return data[: rng.randrange(len(data) + 1)]


def flip(data, rng):
    out = bytearray(data)
    for _ in range(rng.choice((1, 3, 10, 100))):
        out[rng.randrange(len(out))] = rng.choice((0, 0xFF, 0x7F, 0x80, rng.randrange(256)))
    return bytes(out)


def piece(data, rng):
    begin = rng.randrange(len(data))
    return begin, min(len(data), begin + rng.choice((1, 4, 16, 256, 4096)))


def repeat(data, rng):
    begin, end = piece(data, rng)
    return data[:begin] + data[begin:end] * rng.choice((2, 10, 100)) + data[end:]


def remove(data, rng):
    begin, end = piece(data, rng)
    return data[:begin] + data[end:]


def exchange(data, rng):
    begin, end = piece(data, rng)
    other = rng.randrange(len(data))
    return data[:begin] + data[other : other + end - begin] + data[end:]


def extreme_number(data, rng):
    numbers = list(re.finditer(rb"-?\d+(\.\d+)?", data[: 1 << 20]))
    if not numbers:  # a binary file: four bytes of a count or an offset
        at = rng.randrange(max(1, len(data) - 4))
        return data[:at] + rng.choice((b"\xff\xff\xff\xff", b"\xff\xff\xff\x7f", b"\0\0\0\0")) + data[at + 4 :]
    found = rng.choice(numbers)
    return data[: found.start()] + rng.choice(EXTREMES) + data[found.end() :]


def line_of_text(data, rng):
    """Repeats, removes or moves a line, so that the file may still be read."""
    lines = data.splitlines(keepends=True)
    at, other = rng.randrange(len(lines)), rng.randrange(len(lines))
    kind = rng.randrange(3)
    lines[at] = (lines[at] * rng.choice((2, 100)), b"", lines[other])[kind]
    return b"".join(lines)


KINDS = (cut, flip, flip, repeat, remove, exchange, extreme_number, extreme_number)
TEXT_KINDS = (*KINDS, *[extreme_number] * 8, *[line_of_text] * 6)


def sources(names, most_bytes):
    for name in map(Path, names):
        files = sorted(name.rglob("*")) if name.is_dir() else [name]
        for file in files:
            known = file.suffix.lower()[1:] in ENDINGS or not name.is_dir()
            if file.is_file() and known and 0 < file.stat().st_size <= most_bytes:
                yield file


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path)
    parser.add_argument("count", type=int)
    parser.add_argument("files", nargs="+")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--most-bytes", type=int, default=1_000_000, help="leave out larger files (default 1 MB)")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    files = list(sources(args.files, args.most_bytes))
    for number in range(args.count):
        rng = random.Random(args.seed * 1_000_003 + number)
        file = files[number % len(files)]
        data = file.read_bytes()
        for _ in range(rng.choice((1, 1, 1, 2, 4))):
            data = rng.choice(KINDS if b"\0" in data[:4096] else TEXT_KINDS)(data, rng) or b"\0"
        (args.out / f"{number:05}_{file.stem[:20]}{file.suffix}").write_bytes(data)
    print(f"{args.count} files from {len(files)} originals")


if __name__ == "__main__":
    main()
