#!/usr/bin/env bash
# Formats all C++ files with clang-format 14: format.sh [--check]. With --check it changes nothing, and fails if a file
# is not formatted or if a line of a script or a Markdown file is longer than 120 columns. Markdown tables, code blocks
# and lines without a space (one long link) may be longer.
set -euo pipefail
cd "$(dirname "$0")/.."

clang_format=$(command -v clang-format-14 || command -v clang-format || true)
if [[ -z $clang_format || $("$clang_format" --version) != *"version 14."* ]]; then
  echo "format.sh: needs clang-format 14 (Debian 12 has it); install it with tools/install-dependencies.sh --tests" >&2
  exit 2
fi

# Prints the names of the files of the repository that fit the patterns, also new ones that are not committed yet.
files() { git ls-files -z --cached --others --exclude-standard "$@"; }

case "$*" in
  "") files '*.cpp' '*.h' | xargs -0 "$clang_format" -i; exit ;;
  --check) ;;
  *) echo "format.sh: unknown argument $*; usage: tools/format.sh [--check]" >&2; exit 2 ;;
esac

files '*.cpp' '*.h' | xargs -0 "$clang_format" --dry-run --Werror
files '*.md' '*.sh' '*.py' '*.cmake' '*CMakeLists.txt' '.ci/run' | xargs -0 python3 -c '
import sys
bad = 0
for name in sys.argv[1:]:
    in_code = False
    for number, line in enumerate(open(name, encoding="utf-8"), 1):
        line = line.rstrip("\n")
        in_code ^= line.lstrip().startswith("```")
        exempt = name.endswith(".md") and (in_code or line.lstrip().startswith("|") or " " not in line)
        if len(line) > 120 and not exempt:
            print(f"{name}:{number}: {len(line)} columns, at most 120 are allowed")
            bad = 1
sys.exit(bad)'
