#!/usr/bin/env bash
# Runs clang-tidy (checks in .clang-tidy) over the sources of stages and apps, or over the files given.
# Needs a configured build/ for the compile commands: ./test makes one.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
if (($# == 0)); then
  mapfile -t files < <(find src apps -name '*.cpp' | sort)
  set -- "${files[@]}"
fi
printf '%s\n' "$@" | xargs -P 2 -n 1 clang-tidy-14 -p build --quiet --warnings-as-errors='*'
