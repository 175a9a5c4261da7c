#!/usr/bin/env bash
# Formats every source file (no argument), or only names those that differ (--check, exit status 1).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
sources=$(find src apps python tests bench fuzz -name '*.hpp' -o -name '*.cpp' | sort)
if [[ ${1:-} != --check ]]; then
  xargs clang-format-14 -i <<< "$sources"
  exit
fi
faults=$( (xargs clang-format-14 --dry-run -Werror <<< "$sources" 2>&1 || true) | sed -n 's/^\([^: ]*\):[0-9]*:[0-9]*: error: .*/\1/p' | sort -u)
[[ -z $faults ]] && exit
echo "not formatted (tools/format.sh does it):"
echo "$faults"
exit 1
