#!/usr/bin/env bash
# Installs the packages of a folder into a bare Debian 12 root and uses them there, with times. Needs root; the bare root
# is downloaded once, into PACKAGES/bookworm.tar. Usage: try_in_root.sh PACKAGES EXAMPLES
set -euo pipefail
packages=$1 examples=$2
mirror=${PLIANT_MIRROR:-http://deb.debian.org/debian}
fail() { printf 'package test: %s\n' "$*" >&2; exit 1; }
[[ $(id -u) -eq 0 ]] || fail "a root of its own needs root; run it through sudo"
command -v debootstrap >/dev/null || fail "debootstrap is missing; install it"
root=$(mktemp -d)
trap 'umount -q "$root/proc" "$root/dev" || true; rm -rf --one-file-system "$root"' EXIT
say() { printf '== %s\n' "$*"; }
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
# timed NAME COMMAND...
timed() {
  local name=$1 begin=$EPOCHREALTIME
  shift
  "$@" >"$root/tmp/log" 2>&1 || { cat "$root/tmp/log"; fail "$name failed"; }
  printf '%-42s %6.1f s\n' "$name" "$(awk "BEGIN { print $EPOCHREALTIME - $begin }")"
}

if [[ ! -f $packages/bookworm.tar ]]; then
  say "a bare Debian 12 from $mirror"
  debootstrap --variant=minbase bookworm "$root" "$mirror" >"$packages/debootstrap.log" || fail "see $packages/debootstrap.log"
  tar -C "$root" -cf "$packages/bookworm.tar" .
else
  tar -C "$root" -xf "$packages/bookworm.tar"
fi
cp /etc/resolv.conf "$root/etc/resolv.conf"
mount -t proc proc "$root/proc"
mount --bind /dev "$root/dev"
cp "$packages"/*.deb "$root/tmp/"
cp -r "$examples" "$root/tmp/examples"
inside apt-get -qq update

say "the command"
timed "install pliant, libpliant0" inside sh -c 'apt-get -qq install --no-install-recommends -y /tmp/pliant_*.deb /tmp/libpliant0_*.deb'
timed "pliant run three_probes" inside pliant run three_probes --headless --frames 0 --out /tmp/run
inside test -s /tmp/run/forces.csv || fail "there are no forces"
inside pliant run --list | grep -q three_probes || fail "its levels are not found"
inside sh -c 'test -s /usr/share/man/man1/pliant-run.1.gz && test -s /usr/share/applications/pliant.desktop'
timed "a picture, with Mesa" inside sh -c 'apt-get -qq install --no-install-recommends -y libegl1 libgl1-mesa-dri &&
  pliant run three_probes --headless --seconds 1 --frames 1 --out /tmp/picture'
[[ -n $(find "$root/tmp/picture" -name '*.png' -size +4k | head -1) ]] || fail "there is no picture"

say "the libraries"
timed "install libpliant-dev, compilers" inside sh -c 'apt-get -qq install --no-install-recommends -y /tmp/libpliant-dev_*.deb g++ cmake make pkg-config'
timed "hello_c by pkg-config" inside sh -c 'cc -std=c11 -Wall -Wextra -Werror /tmp/examples/hello_c/main.c -o /tmp/hello_c $(pkg-config --cflags --libs pliant)'
inside /tmp/hello_c /usr/share/pliant/content/levels/minimal.gltf
timed "examples by CMake" inside sh -c 'cmake -S /tmp/examples -B /tmp/built -DCMAKE_BUILD_TYPE=Release &&
  cmake --build /tmp/built -j2 --target hello_touch hello_c headless_sweep'
inside /tmp/built/hello_touch | tail -1
inside sh -c '/tmp/built/headless_sweep /usr/share/pliant/content/levels/minimal.gltf | tail -1'

say "Python"
timed "install python3-pliant" inside sh -c 'apt-get -qq install --no-install-recommends -y /tmp/python3-pliant_*.deb'
[[ $(inside python3 -c 'import pliant as pl; print(pl.Session("minimal").run([[0, 0.001, 0], [0, -0.001, 0]]).force[1, 1])') == 0.3 ]] ||
  fail "300 N/m times 1 mm is 0.3 N"
said=$(inside python3 -c 'import pliant as pl; pl.view(pl.Session("minimal"))' 2>&1 | tail -1 || true)
[[ $said == *"there is no display"* ]] || fail "a window without a display says: $said"
# KEEP: a folder for the experiment's trials and its plot, for which matplotlib is installed.
if [[ -n ${KEEP:-} ]]; then inside apt-get -qq install --no-install-recommends -y python3-matplotlib >/dev/null 2>&1; fi
timed "the experiment" inside python3 /tmp/examples/python/discrimination.py /tmp/experiment
grep -a "JND" "$root/tmp/log"
[[ $(wc -l <"$root/tmp/experiment/trials.csv") -eq 181 ]] || fail "the experiment has 180 trials"
if [[ -n ${KEEP:-} ]]; then cp -r "$root/tmp/experiment" "$KEEP"; fi

timed "remove them" inside sh -c 'apt-get -qq purge -y pliant libpliant0 libpliant-dev python3-pliant'
left=$(cd "$root" && find usr -name '*pliant*' | head -3)
[[ -z $left ]] || fail "what is left: $left"
say "as it should be"
