#!/usr/bin/env bash
# Makes the Debian packages, unpacks a fresh Debian 12 (mmdebstrap or debootstrap; root and a network are needed), installs
# the packages there with apt and uses them as a user would: command, manual page, completion, kinds of files, a C++
# program, removal. Not part of the daily run:
#   ctest --test-dir build -C packages -L packages --output-on-failure
#
# Usage: clean_root.sh SOURCE BUILD [MIRROR]    BUILD: a folder for the package build; exit status 77 if this cannot run here
set -euo pipefail
source_folder=$(realpath "$1") build=$2 mirror=${3:-http://deb.debian.org/debian}
if [[ $(id -u) != 0 ]]; then
  echo "Needs root, for chroot and apt."
  exit 77
fi

cmake -S "$source_folder" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr \
  -DBUILD_SHARED_LIBS=ON -DLOOPWRIGHT_TESTS=OFF > "$build.configure.log"
nice cmake --build "$build" > "$build.build.log" || { tail -n 40 "$build.build.log"; exit 1; }
rm -rf "$build/packages"
(cd "$build" && cpack) > "$build.cpack.log" || { cat "$build.cpack.log"; exit 1; }

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
root=$scratch/root
if command -v mmdebstrap > /dev/null; then
  mmdebstrap --quiet --variant=minbase bookworm "$root" "$mirror"
elif command -v debootstrap > /dev/null; then
  debootstrap --variant=minbase bookworm "$root" "$mirror" > "$build.debootstrap.log"
else
  echo "Needs mmdebstrap or debootstrap."
  exit 77
fi
cp /etc/resolv.conf "$root/etc/resolv.conf"
mkdir "$root/packages"
cp "$build"/packages/*.deb "$root/packages/"
cp -r "$source_folder/tests/packages/page_project.py" "$source_folder/tests/pages/page_blocks.py" \
  "$source_folder/docs/library.md" "$root/packages/"

# inside TEXT: a script in the clean Debian, which stops at the first fault.
inside() {
  echo "--- $1"
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    bash -euo pipefail -c "$2"
}

# what apt takes from the packages that were made
install='apt-get install -y --no-install-recommends'
inside "the command alone" "
  apt-get update > /tmp/apt.log
  $install /packages/libloopwright[0-9]*.deb /packages/loopwright_*.deb > /tmp/apt.log 2>&1 || { cat /tmp/apt.log; exit 1; }
  dpkg -l | grep loopwright"
inside "a picture without the recommended packages: an error, not a crash" '
  cd /usr/share/doc/loopwright/examples
  status=0
  loopwright render structures/rib.verm --periodic -o /tmp/rib.png 2> /tmp/said || status=$?
  cat /tmp/said
  test $status = 1
  grep -q "install the Debian packages" /tmp/said
  test ! -e /tmp/rib.png'
inside "the recommended packages" '
  recommended=$(dpkg-query -W -f="\${Recommends}" loopwright | tr -d ,)
  apt-get install -y --no-install-recommends $recommended > /tmp/apt.log 2>&1 || { cat /tmp/apt.log; exit 1; }'
inside "everything but headers" "
  ls /packages/*.deb | grep -v -- -dev_ | xargs $install > /tmp/apt.log 2>&1 || { cat /tmp/apt.log; exit 1; }
  dpkg -l | grep loopwright"
inside "the command" '
  loopwright --version
  cd /tmp && cp -r /usr/share/doc/loopwright/examples .
  loopwright check examples/structures/*.verm examples/swatch.k > check.txt
  loopwright relax examples/structures/rib.verm --periodic -o rib.h5 --json rib.json --render rib.png
  loopwright measure rib.h5 > /dev/null
  grep -q "\"converged\": true" rib.json
  grep -q "\"pass_throughs\": 0" rib.json
  test "$(head -c 8 rib.png | od -An -tx1 | tr -d " ")" = 89504e470d0a1a0a'
inside "manual page, completion, kinds of files" '
  apt-get install -y --no-install-recommends man-db bash-completion shared-mime-info libglib2.0-bin > /tmp/apt.log 2>&1
  man loopwright | grep -q "loopwright relax"
  source /usr/share/bash-completion/bash_completion
  _completion_loader loopwright || test $? = 124
  COMP_WORDS=(loopwright rel) COMP_CWORD=1
  _loopwright
  test "${COMPREPLY[*]}" = relax
  kind_of() { gio info -a standard::content-type "$1" | sed -n "s/.*content-type: //p"; }
  test "$(kind_of /tmp/examples/swatch.k)" = text/x-knitout
  test "$(kind_of /tmp/examples/structures/rib.verm)" = text/x-vermiculation'
if ls "$root"/packages/python3-loopwright_* > /dev/null 2>&1; then
  inside "the Python module" '
    cd /tmp/examples/structures
    python3 -c "
import loopwright
cloth = loopwright.relax(\"rib.verm\", periodic=True)
print(loopwright.__file__, cloth.interlacings_kept)
assert cloth.interlacings_kept == (2, 2)"'
fi
if ls "$root"/packages/loopwright-view_* > /dev/null 2>&1; then
  inside "the desktop application" '
    apt-get install -y --no-install-recommends desktop-file-utils > /tmp/apt.log 2>&1
    desktop-file-validate /usr/share/applications/loopwright-view.desktop
    QT_QPA_PLATFORM=offscreen loopwright-view --version'
fi
inside "a C++ program" '
  apt-get install -y --no-install-recommends /packages/libloopwright-dev_*.deb g++ cmake make python3-minimal \
    > /tmp/apt.log 2>&1 || { cat /tmp/apt.log; exit 1; }
  cd /packages
  PYTHONDONTWRITEBYTECODE=1 python3 page_project.py library.md /tmp/cell
  cmake -S /tmp/cell -B /tmp/cell/build -DCMAKE_BUILD_TYPE=Release > /dev/null
  cmake --build /tmp/cell/build > /dev/null
  /tmp/cell/build/cell /tmp/examples/structures/rib.verm > /tmp/cell.json
  # the same numbers as the command: all lines but those of the run
  for file in cell rib; do grep -v "wall_s\|peak_memory" /tmp/$file.json | tr -d , > /tmp/$file.lines; done
  diff /tmp/cell.lines /tmp/rib.lines'
inside "removal" '
  dpkg -l | sed -n "s/^ii  \(\S*loopwright\S*\) .*/\1/p" | cut -d: -f1 | xargs apt-get purge -y > /tmp/apt.log 2>&1
  rm -rf /tmp/* /packages
  left=$(find / -xdev -name "*loopwright*" -not -path "/proc/*" -not -path "/var/*")
  test -z "$left" || { echo "left behind: $left"; exit 1; }'
echo "Packages install, work and go in a clean Debian 12."
