#!/usr/bin/env bash
# Runs clang-tidy (checks in .clang-tidy) over the sources of stages, apps and the Python module, or over the files given.
# Needs the compile commands of a configured build folder: build/, which ./test makes, or LOOPWRIGHT_BUILD.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
if (($# == 0)); then
  mapfile -t files < <(find src apps python -name '*.cpp' | sort)
  set -- "${files[@]}"
fi
printf '%s\n' "$@" | xargs -P 2 -n 1 clang-tidy-14 -p "${LOOPWRIGHT_BUILD:-build}" --quiet \
  --extra-arg=-Wno-unknown-warning-option --warnings-as-errors='*'
