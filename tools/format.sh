#!/usr/bin/env bash
# Formats every source file (no argument), or only says what differs (--check, exit status 1).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mode=(-i)
[[ ${1:-} == --check ]] && mode=(--dry-run -Werror)
find src apps tests bench fuzz -name '*.hpp' -o -name '*.cpp' | sort | xargs clang-format-14 "${mode[@]}"
