# Shared by ./demo and ./test: installs what is missing, configures and builds. To be sourced, from any directory.
# Logs lie in build/: apt.log, configure.log, build.log; the tail of one is shown where its step fails.

loopwright_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$loopwright_root"
mkdir -p build

# show_tail LOG: the end of a log, where the error usually is.
show_tail() {
  echo "--- the last lines of $1 ---" >&2
  tail -n 40 "$1" >&2
}

# missing_packages LIST...: package names of the lists that dpkg does not know as installed.
missing_packages() {
  local wanted installed
  wanted=$(grep -hv '^#' "$@" | sort)
  # dpkg-query fails where it does not know one of the names, and lists the others all the same
  installed=$(xargs dpkg-query -W -f='${Package} ${db:Status-Status}\n' <<< "$wanted" 2> /dev/null |
    sed -n 's/ installed$//p' | sort -u) || true
  grep -vxF "${installed:-none}" <<< "$wanted" || true
}

# install_packages [LIST...]: those of tools/packages.txt and of further lists.
install_packages() {
  local names missing=() as_root=()
  names=$(missing_packages tools/packages.txt "$@")
  [[ -z $names ]] && return
  mapfile -t missing <<< "$names"
  if [[ $(id -u) != 0 ]]; then
    if ! command -v sudo > /dev/null; then
      echo "These Debian packages are missing, and installing them needs root or sudo:" >&2
      echo "  apt-get install ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing ${#missing[@]} Debian packages ..."
  as_root+=(env DEBIAN_FRONTEND=noninteractive)
  if ! { "${as_root[@]}" apt-get update &&
         "${as_root[@]}" apt-get install -y --no-install-recommends "${missing[@]}"; } \
       < /dev/null > build/apt.log 2>&1; then
    show_tail build/apt.log
    return 1
  fi
}

# Reads ninja's output, keeps it in build/build.log and shows the percentage: in place on a terminal, in quarters
# otherwise.
show_progress() {
  local line percent shown=-1
  while IFS= read -r line; do
    printf '%s\n' "$line" >> build/build.log
    [[ $line =~ ^\[\ *([0-9]+)%\] ]] || continue
    percent=${BASH_REMATCH[1]}
    if [[ -t 1 ]]; then
      printf '\rBuilding %3d %%' "$percent"
    elif ((percent / 25 > shown)); then
      shown=$((percent / 25))
      echo "Building $percent %"
    fi
  done
  if [[ -t 1 ]]; then printf '\r\033[K'; fi
}

# build_all [TARGET...]: everything, or the named targets, into build/.
build_all() {
  if ! cmake --preset release > build/configure.log 2>&1; then
    show_tail build/configure.log
    return 1
  fi
  : > build/build.log
  if ! NINJA_STATUS='[%p] ' cmake --build build --target "${@:-all}" 2>&1 | show_progress; then
    show_tail build/build.log
    return 1
  fi
}
